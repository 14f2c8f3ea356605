//! A port set to another width than its encoder: detected and undetected cases. docs/ssi.md has the table.

use super::run::{Run, Settings, SYSTEM_MHZ};
use endat_hdl::protocols::ssi::cause;
use endat_sim::rng::Rng;
use endat_sim::ssi::{Defect, EncoderConfig};
use endat_sim::US;

const PERIOD: u64 = 20;
/// Configured width of the port.
const WIDTH: u32 = 25;

fn start(encoder_bits: u32, repeats: bool, twice: bool) -> Run {
    let encoder = EncoderConfig {
        position_bits: encoder_bits,
        repeats,
        tm: 18 * US,
        ..EncoderConfig::default()
    };
    let settings = Settings {
        frame: if twice { 6 } else { 4 },
        period_cycles: PERIOD,
        recovery_limit_cycles: 20 * SYSTEM_MHZ,
    };
    let mut run = Run::new(settings, encoder);
    run.set("position_bits", WIDTH.into());
    run
}

/// Bit of an encoder's word; the first one is sent first.
fn bit(position: u64, encoder_bits: u32, place: u32) -> bool {
    position >> (encoder_bits - 1 - place) & 1 == 1
}

/// Level of the line where DATA should be LOW after the last bit: HIGH shows the wrong width.
fn is_high_at_the_end(position: u64, encoder_bits: u32, repeats: bool) -> bool {
    match encoder_bits {
        // The next one of its bits.
        more if more > WIDTH => bit(position, encoder_bits, WIDTH),
        // A bit of the next copy, which begins after a LOW cell.
        _ if repeats => bit(position, encoder_bits, WIDTH - encoder_bits - 1),
        _ => false,
    }
}

/// Triggers with random positions; returns the number of accepted ones, and checks that exactly the undetectable ones were accepted.
fn taken(encoder_bits: u32, repeats: bool, frames: u32) -> u32 {
    let mut rng = Rng::new(u64::from(encoder_bits));
    let mut run = start(encoder_bits, repeats, false);
    let mut taken = 0;
    for _ in 0..frames {
        let position = rng.next_u64() & ((1 << encoder_bits) - 1);
        run.encoder.config.position = position;
        run.trigger();
        assert!(run.ends());
        let is_seen = is_high_at_the_end(position, encoder_bits, repeats);
        let told = match is_seen {
            true => cause::DATA_NOT_LOW_AFTER,
            false => cause::NONE,
        };
        let what = format!("{encoder_bits} bits, repeats {repeats}, {position:#x}");
        assert_eq!(run.get("cause"), u128::from(told), "{what}");
        // Expected reading: fewer bits are followed by zeros, and of more bits the upper ones are read.
        let shown = match WIDTH.checked_sub(encoder_bits) {
            None => position >> (encoder_bits - WIDTH),
            Some(fewer) if !repeats => position << fewer,
            // The second copy begins after the LOW cell.
            Some(fewer) => position << fewer | position >> (encoder_bits + 1 - fewer),
        };
        assert_eq!(run.fresh(), (!is_seen).then_some(shown), "{what}");
        taken += u32::from(!is_seen);
    }
    taken
}

/// Without `twice` only the cell after the last bit shows the width. An encoder with fewer bits that stays LOW looks like one with
/// zeros at the end; every other wrong width shows in half of the positions.
#[test]
fn wrong_width_is_seen_where_the_cell_after_the_last_bit_is_high() {
    for encoder_bits in [23, 24] {
        assert_eq!(taken(encoder_bits, false, 40), 40, "never seen");
    }
    for (encoder_bits, repeats) in [
        (26, false),
        (27, false),
        (33, false),
        (26, true),
        (24, true),
        (23, true),
    ] {
        let taken = taken(encoder_bits, repeats, 60);
        assert!(
            (15..45).contains(&taken),
            "{encoder_bits} {repeats}: {taken}"
        );
    }
}

/// With `twice` it shows in every frame, except for positions whose shifted copies are equal.
#[test]
fn wrong_width_is_seen_in_every_frame_with_two_copies() {
    for encoder_bits in [22, 23, 24, 26, 27, 33] {
        for repeats in [false, true] {
            let mut rng = Rng::new(u64::from(encoder_bits));
            let mut run = start(encoder_bits, repeats, true);
            for _ in 0..40 {
                run.encoder.config.position = rng.next_u64() & ((1 << encoder_bits) - 1);
                run.trigger();
                assert!(run.ends());
                let what = format!("{encoder_bits} bits, repeats {repeats}");
                assert_ne!(run.get("cause"), 0, "{what}");
                assert_eq!(run.fresh(), None, "{what}");
            }
        }
    }
}

/// The positions that `twice` does not detect: 0 alone if the encoder stays LOW; if both copies have bits, those that repeat like
/// the copies.
#[test]
fn wrong_width_is_not_seen_where_the_shifted_copies_are_the_same() {
    // Cells in clock order: the first 25 of them are compared with those from the 27th on.
    let alike = |encoder_bits: u32, repeats: bool, position: u64| {
        let bits = (0..encoder_bits).map(|place| bit(position, encoder_bits, place));
        let copy: Vec<bool> = bits.chain([false]).collect();
        let cell = |n: usize| match n {
            n if n < copy.len() => copy[n],
            _ => repeats && copy[n % copy.len()],
        };
        let width = WIDTH as usize;
        let is_low = !cell(width) && !cell(2 * width + 1);
        is_low && (0..width).all(|n| cell(n) == cell(n + width + 1))
    };
    for (encoder_bits, repeats, positions, same) in [
        (24, false, &[0u64, 1, 0x80_0000, 0x55_5555][..], 1),
        (24, true, &[0, 1, 0x80_0000, 0xFF_FFFF], 1),
        (21, true, &[0, 1, 0x15_5555, 0x0A_AAAA], 2),
        (27, true, &[0, 1, 0x555_5555, 0x2AA_AAAA], 2),
        (48, false, &[0, 1, 1 << 47, 1 << 47 | 1 << 21], 2),
    ] {
        let mut run = start(encoder_bits, repeats, true);
        let mut not_seen = 0;
        for &position in positions {
            run.encoder.config.position = position;
            run.trigger();
            assert!(run.ends());
            let is_alike = alike(encoder_bits, repeats, position);
            let what = format!("{encoder_bits} bits, repeats {repeats}, {position:#x}");
            assert_eq!(run.fresh().is_some(), is_alike, "{what}");
            not_seen += u32::from(is_alike);
            run.cycles(20 * SYSTEM_MHZ);
        }
        assert_eq!(not_seen, same, "{encoder_bits} {repeats}");
    }
}

/// A single copy without a parity bit or a CRC has no check.
#[test]
fn disturbed_bit_of_a_single_copy_is_a_wrong_position() {
    let mut run = start(WIDTH, false, false);
    for bit in [0, 7, 24] {
        run.encoder.config.position = 0x123_4567;
        run.encoder.config.defect = Defect::Flip { copy: 0, bit };
        run.trigger();
        assert!(run.ends());
        assert_eq!(run.get("cause"), 0);
        assert_eq!(run.fresh(), Some(0x123_4567 ^ 1 << (24 - bit)));
    }
}

/// DATA that is LOW at the first rising edge, before the first bit, means that the encoder has not started.
#[test]
fn data_that_falls_before_the_first_bit_is_reported() {
    let mut run = start(WIDTH, false, false);
    run.encoder.config.position = 0x155_5555;
    run.trigger();
    run.cycles(2);
    run.broken = Some(false);
    run.cycles(PERIOD);
    run.broken = None;
    assert!(run.ends());
    assert_eq!(run.get("cause"), u128::from(cause::DATA_NOT_HIGH));
    assert_eq!(run.fresh(), None);
}
