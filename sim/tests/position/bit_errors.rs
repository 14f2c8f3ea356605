//! Wrong bits in an answer never become a position.

use super::rig::*;
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::ModeCommand::{self, SendPosition, SendPositionAddInfo};
use endat_sim::encoder::Defect;
use rtl_design::engine::Compiled;

/// Longest burst that a CRC5 always detects.
const BURST_BITS: u32 = 5;

/// Frames of several widths and both kinds, at the fastest clock of the 100 MHz design.
fn setups() -> Vec<Setup> {
    let rates = (100_000_000, 12_500_000);
    [
        (SendPositionAddInfo, 29),
        (SendPositionAddInfo, 1),
        (SendPositionAddInfo, 48),
        (SendPosition, 13),
        (SendPosition, 25),
    ]
    .map(|(command, bits)| Setup::new(rates, command, bits, 5.0))
    .into()
}

/// A short frame.
fn narrow(command: ModeCommand) -> Setup {
    Setup::new((100_000_000, 12_500_000), command, 3, 5.0)
}

/// All patterns of 1 to 5 bits whose first and last bit are wrong: 1, 11, 101, 111, ...
fn bursts() -> impl Iterator<Item = (u32, u128)> {
    (1..=BURST_BITS).flat_map(|span| {
        (0..1u128 << span)
            .filter(move |p| p & 1 != 0 && p >> (span - 1) & 1 != 0)
            .map(move |p| (span, p))
    })
}

/// Sends a frame with each mask, each between two good frames. `judge` receives the mask and the result.
fn with_masks(
    setup: &Setup,
    measured: &Compiled,
    masks: &[u128],
    mut judge: impl FnMut(u128, &mut Rig),
) {
    let mut setup = setup.clone();
    for (i, mask) in masks.iter().enumerate() {
        setup = setup.defect(2 * i as u64 + 1, Defect::FlipBits(*mask));
    }
    let mut rig = setup.on(measured.clone());
    good_frame(&mut rig);
    for mask in masks {
        judge(*mask, &mut rig);
        good_frame(&mut rig);
    }
    assert_eq!(rig.conflicts(0), []);
}

#[test]
fn bursts_of_all_patterns_are_sixteen() {
    assert_eq!(bursts().count(), 16);
}

fn errors_are_refused(setups: &[Setup]) {
    for setup in setups {
        let bits = setup.answer_bits();
        let places = bursts().flat_map(|(span, p)| (1..=bits - span).map(move |at| p << at));
        let masks: Vec<u128> = places.collect();
        let mut count = 0;
        with_masks(setup, &setup.measured(), &masks, |mask, rig| {
            let good = rig
                .results()
                .last()
                .cloned()
                .expect("a good frame came before");
            let result = any_frame(rig);
            let what = || format!("{mask:#b} {setup:?} {result:?}");
            assert_eq!(result.cause, cause::CRC, "{}", what());
            assert!(!result.fresh && result.position_valid, "{}", what());
            assert_eq!(result.position, good.position, "{}", what());
            assert_eq!(
                result.first_fall_timestamp,
                good.first_fall_timestamp,
                "{}",
                what()
            );
            assert_eq!(result.sequence, (good.sequence + 1) & 0xFFFF, "{}", what());
            count += 1;
        });
        assert_eq!(count, masks.len());
        assert!((1..bits).all(|bit| masks.contains(&(1 << bit))));
    }
}

#[test]
fn every_burst_in_a_narrow_position_is_refused_as_crc_error() {
    errors_are_refused(&[narrow(SendPositionAddInfo), narrow(SendPosition)]);
}

#[test]
#[ignore = "slow: every burst in positions of up to 48 bits"]
fn every_single_bit_error_and_every_burst_behind_the_start_bit_is_refused_as_crc_error() {
    errors_are_refused(&setups());
}

/// Without its start bit a frame is sampled from a later bit on, with too many pulses for the encoder, or not at all.
fn start_bit_wrong(masks: &[u128], seeds: u64, mut judge: impl FnMut(&Setup, u128, &mut Rig)) {
    for setup in setups() {
        let measured = setup.measured();
        for seed in 0..seeds {
            let mut setup = setup.clone();
            setup.encoder.seed = seed;
            with_masks(&setup, &measured, masks, |mask, rig| {
                judge(&setup, mask, rig);
                // The encoder, which received too many pulses, needs a while to be ready.
                rig.run_for(30 * endat_sim::US);
                settle(rig);
            });
        }
    }
}

#[test]
fn a_wrong_start_bit_alone_is_always_refused() {
    start_bit_wrong(&[1], 40, |setup, _, rig| {
        let good = rig
            .results()
            .last()
            .cloned()
            .expect("a good frame came before");
        let result = any_frame(rig);
        let what = || format!("{setup:?} {result:?}");
        assert_ne!(result.cause, cause::NONE, "{}", what());
        assert!(!result.fresh && result.position_valid, "{}", what());
        assert_eq!(result.position, good.position, "{}", what());
    });
}

/// The CRC does not cover the start bit, and a receiver does not know the calculation time of an encoder. So with more wrong bits after it,
/// exactly the sequences that form a right answer are accepted.
fn bursts_on_the_start_bit(seeds: u64) {
    let masks: Vec<u128> = bursts().map(|(_, p)| p).filter(|p| *p != 1).collect();
    let (mut count, mut unlucky) = (0, 0);
    start_bit_wrong(&masks, seeds, |setup, mask, rig| {
        settle(rig);
        let before = rig.samples(0).len();
        let good = rig
            .results()
            .last()
            .cloned()
            .expect("a good frame came before");
        let result = any_frame(rig);
        settle(rig);
        let levels: Vec<bool> = rig.samples(0)[before..].iter().map(|s| s.level).collect();
        let what = || format!("{mask:#b} {setup:?} {result:?}");
        assert_eq!(result.fresh, setup.believes(&levels), "{}", what());
        if !result.fresh {
            assert_ne!(result.cause, cause::NONE, "{}", what());
            assert_eq!(result.position, good.position, "{}", what());
        }
        count += 1;
        unlucky += usize::from(result.fresh);
    });
    assert!(unlucky * 20 < count, "{unlucky} of {count}");
}

#[test]
fn a_burst_on_the_start_bit_is_refused_unless_the_answer_looks_right() {
    bursts_on_the_start_bit(2);
}

#[test]
#[ignore = "slow: three times as many answers"]
fn a_burst_on_the_start_bit_is_refused_unless_it_makes_another_right_answer() {
    bursts_on_the_start_bit(6);
}
