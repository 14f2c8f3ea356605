//! Violations noted by the encoder, each with a receiver that causes it.

use super::*;
use crate::US;

/// Clocks an encoder; returns its bits, sampled at the next rising edge.
fn clocked(encoder: &mut Encoder, start: Time, clocks: usize, half: Time) -> Vec<bool> {
    let mut bits = vec![];
    for n in 0..clocks as u64 {
        let fall = start + 2 * half * n;
        encoder.clock(fall, false);
        encoder.advance(fall + half - 1);
        if n > 0 {
            bits.push(encoder.data());
        }
        encoder.clock(fall + half, true);
    }
    encoder.advance(start + 2 * half * clocks as u64 + 100 * US);
    bits
}

fn encoder(config: EncoderConfig) -> Encoder {
    Encoder::new(EncoderConfig {
        position_bits: 8,
        position: 0b1011_0010,
        ..config
    })
}

#[test]
fn a_position_comes_most_significant_bit_first_and_again() {
    let is = [true, false, true, true, false, false, true, false];
    let mut one = encoder(EncoderConfig::default());
    assert_eq!(clocked(&mut one, 0, 9, US), is);
    assert!(one.data(), "HIGH after the recovery time");
    let both = [&is[..], &[false], &is[..]].concat();
    assert_eq!(clocked(&mut one, 500 * US, 18, US), both);
    assert_eq!((one.frames(), one.violations()), (2, &[][..]));
    let mut gray = encoder(EncoderConfig {
        gray: true,
        ..EncoderConfig::default()
    });
    assert_eq!(
        clocked(&mut gray, 0, 9, US),
        [true, true, true, false, true, false, true, true]
    );
    for odd in [false, true] {
        let mut checked = encoder(EncoderConfig {
            parity: Some(odd),
            ..EncoderConfig::default()
        });
        let bits = clocked(&mut checked, 0, 10, US);
        assert_eq!(bits[..8], is);
        let ones = bits.iter().filter(|bit| **bit).count();
        assert_eq!(ones % 2 == 1, odd);
    }
}

#[test]
fn what_a_receiver_does_wrong_is_noted() {
    let usual = EncoderConfig::default;
    let noted = |config, clocks, half| {
        let mut encoder = encoder(config);
        clocked(&mut encoder, 0, clocks, half);
        assert_eq!(encoder.frames(), u64::from(clocks % 9 == 0));
        encoder.violations().to_vec()
    };
    assert_eq!(noted(usual(), 8, US), [Violation::Clocks(8)]);
    assert_eq!(noted(usual(), 10, US), [Violation::Clocks(10)]);
    assert_eq!(noted(usual(), 9, US / 10), [Violation::ShortPulse]);
    let no_repeat = EncoderConfig {
        repeats: false,
        ..usual()
    };
    assert_eq!(noted(no_repeat, 18, US), [Violation::NoRepeat]);
    assert_eq!(noted(usual(), 18, US), []);
}

/// Otherwise a receiver that waits for HIGH before it clocks would wait forever.
#[test]
fn data_is_high_after_a_low_phase_that_ended_the_frame() {
    let mut encoder = encoder(EncoderConfig::default());
    let tm = encoder.config.tm;
    encoder.clock(0, false);
    encoder.clock(tm + US, true);
    encoder.advance(tm + 100 * US);
    assert!(encoder.data());
    assert_eq!(encoder.violations(), [Violation::Clocks(0)]);
    let bits = clocked(&mut encoder, tm + 200 * US, 9, US);
    assert_eq!(bits, [true, false, true, true, false, false, true, false]);
}
