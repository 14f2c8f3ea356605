//! The header is detected at every phase of the bit, with rate error and jitter, and nothing else is taken for a header.

use super::lanes::{kind_reply, levels, Conditions, Many, Sent, BIT, LANES};
use endat_hdl::protocols::t_format::cause;

/// Frames of each run: in the slow tests, and in the quick ones.
const MANY: usize = 100_000;
const FEW: usize = 5_000;

/// Frames whose start sweeps the bit in 64 steps.
fn none_is_lost(conditions: Conditions, frames: usize) {
    let mut many = Many::new(conditions, 5);
    let mut frame = 0;
    let mut sequence = 0u8;
    while frame < frames {
        let mut expected = vec![];
        let said = many.exchange(|lane, rng| {
            let phase = (frame + lane) as u64 % 64;
            let bytes = kind_reply(rng);
            expected.push((bytes[1], bytes[2]));
            Sent {
                levels: None,
                after: 1_500_000 + phase * BIT / 64 + rng.in_range(0, BIT / 64),
                bytes,
            }
        });
        sequence = sequence.wrapping_add(1);
        for (lane, (said, (status, kind))) in said.iter().zip(expected).enumerate() {
            assert!(
                said.fresh && said.sequence == sequence,
                "{conditions:?}, frame {}: {said:?}",
                frame + lane
            );
            assert_eq!(
                (said.status, said.encoder_id),
                (status, kind),
                "{conditions:?}"
            );
        }
        frame += LANES;
    }
}

fn none_is_lost_at_20_mhz(frames: usize) {
    for (rate_error_ppm, jitter) in [(0, 0), (0, 45_000), (30_000, 15_000), (-30_000, 15_000)] {
        let conditions = Conditions {
            system_mhz: 20,
            rate_error_ppm,
            jitter,
        };
        none_is_lost(conditions, frames);
    }
}

#[test]
fn no_frame_is_lost_at_20_mhz() {
    none_is_lost_at_20_mhz(FEW);
}

#[test]
#[ignore = "slow: a hundred thousand frames"]
fn no_frame_of_a_hundred_thousand_is_lost_at_20_mhz() {
    none_is_lost_at_20_mhz(MANY);
}

fn none_is_lost_at_60_mhz(frames: usize) {
    for (rate_error_ppm, jitter) in [(0, 0), (0, 75_000), (30_000, 30_000), (-30_000, 30_000)] {
        let conditions = Conditions {
            system_mhz: 60,
            rate_error_ppm,
            jitter,
        };
        none_is_lost(conditions, frames);
    }
}

#[test]
fn no_frame_is_lost_at_60_mhz() {
    none_is_lost_at_60_mhz(FEW);
}

#[test]
#[ignore = "slow: a hundred thousand frames"]
fn no_frame_of_a_hundred_thousand_is_lost_at_60_mhz() {
    none_is_lost_at_60_mhz(MANY);
}

/// Replies whose first four cells are not 0, 0, 1, 0, and noise.
fn none_is_made_up(system_mhz: u64, frames: usize) {
    let conditions = Conditions {
        system_mhz,
        rate_error_ppm: 0,
        jitter: 20_000,
    };
    let mut many = Many::new(conditions, 6);
    let mut frame = 0;
    while frame < frames {
        let said = many.exchange(|_, rng| {
            let bytes = kind_reply(rng);
            let mut levels = levels(&bytes);
            match rng.in_range(0, 3) {
                // Another sync code; the start bit makes it a field.
                0 => {
                    let code = [0b000, 0b001, 0b011, 0b100, 0b101, 0b110, 0b111];
                    let code = code[rng.in_range(0, 6) as usize];
                    (0..3).for_each(|i| levels[1 + i] = code >> i & 1 == 1);
                }
                // No start bit, or a long one.
                1 => levels[0] = true,
                2 => levels.insert(0, false),
                // Noise of half bits.
                _ => levels = (0..80).map(|_| rng.next_u64() & 1 == 1).collect(),
            }
            Sent {
                levels: Some(levels),
                after: 1_000_000 + rng.in_range(0, BIT),
                bytes,
            }
        });
        for said in said {
            assert!(
                !said.fresh && said.cause != cause::NONE,
                "{system_mhz} MHz: {said:?}"
            );
        }
        frame += LANES;
    }
}

#[test]
fn no_frame_is_made_up_at_20_mhz() {
    none_is_made_up(20, FEW);
}

#[test]
fn no_frame_is_made_up_at_60_mhz() {
    none_is_made_up(60, FEW);
}

#[test]
#[ignore = "slow: a hundred thousand frames"]
fn no_frame_of_a_hundred_thousand_is_made_up() {
    none_is_made_up(20, MANY);
    none_is_made_up(60, MANY);
}
