//! Special bits as in the data sheets of encoders, and encoders that keep their last bit on the line.

use super::run::{engine_for, Run, Settings, SYSTEM_MHZ};
use endat_hdl::protocols::ssi::asked::Parity;
use endat_hdl::protocols::ssi::cause;
use endat_hdl::protocols::ssi::specials::Special::{self, *};
use endat_hdl::protocols::ssi::specials::Specials;
use endat_hdl::protocols::SsiSpec;
use endat_sim::rng::Rng;
use endat_sim::ssi::Extra::{Crc6 as Crc, Level, Parity as Ones};
use endat_sim::ssi::{Defect, EncoderConfig, Extra};
use endat_sim::US;

const PERIOD: u64 = 20;
const RECOVERY_MAX_US: u64 = 20;
const LOW: Extra = Level(false);
const HIGH: Extra = Level(true);

fn list(specials: &[Special]) -> Specials {
    Specials::new(specials).unwrap()
}

fn asked(before: &[Special], after: &[Special]) -> SsiSpec {
    SsiSpec {
        before: list(before),
        after: list(after),
        ..SsiSpec::default()
    }
}

/// A port with this request and an encoder, with one copy or two.
fn start(asked: &SsiSpec, encoder: EncoderConfig) -> Run {
    let encoder = EncoderConfig {
        gray: asked.gray,
        parity: asked.has_parity().then_some(asked.parity == Parity::Odd),
        repeats: asked.twice,
        keeps_last: asked.holds_end,
        tm: 18 * US,
        ..encoder
    };
    let settings = Settings {
        frame: asked.frame().into(),
        period_cycles: PERIOD,
        recovery_limit_cycles: RECOVERY_MAX_US * SYSTEM_MHZ + 10,
    };
    Run::of(engine_for(asked), settings, encoder)
}

/// A trigger: returns cause, flags, shown special bits, and the position if valid.
fn frame(run: &mut Run) -> (u64, u64, u64, Option<u64>) {
    run.trigger();
    assert!(run.ends());
    let [cause, flags] = ["cause", "flags"].map(|name| run.get(name) as u64);
    (cause, flags & 0xFFF, flags >> 12, run.fresh())
}

/// A good frame; then each special bit is inverted, with its expected cause, or none with these bits shown.
fn every_bit_counts(run: &mut Run, shown: u64, bits: &[(usize, u64, u64)]) {
    let is = run.encoder.config.position;
    assert_eq!(frame(run), (0, 0, shown, Some(is)));
    for (bit, cause, shown) in bits {
        run.encoder.config.defect = Defect::Flip { copy: 0, bit: *bit };
        let taken = (*cause == 0).then_some(is);
        let expected = (*cause, cause::flag(*cause), *shown, taken);
        assert_eq!(frame(run), expected, "bit {bit}");
        run.encoder.config.defect = Defect::None;
    }
    assert_eq!(frame(run), (0, 0, shown, Some(is)));
    assert_eq!(run.encoder.violations(), []);
}

/// Beckhoff EL500x, KEB F6: 24 bits in Gray code, then a supply bit. Earlier the position read 2386092, and its lowest bit was a sum of two.
#[test]
fn port_takes_a_power_fail_bit_after_24_gray_bits() {
    let asked = SsiSpec {
        gray: true,
        ..asked(&[], &[PowerFail])
    };
    let encoder = EncoderConfig {
        position_bits: 24,
        position: 0x12_3456,
        after: vec![LOW],
        ..EncoderConfig::default()
    };
    let mut run = start(&asked, encoder);
    every_bit_counts(&mut run, 0, &[(24, cause::POWER_FAIL, 1)]);
    for position in [0, 1, 2, 3, 0xFF_FFFF, 0xAA_AAAA] {
        run.encoder.config.position = position;
        assert_eq!(frame(&mut run), (0, 0, 0, Some(position)));
    }
}

/// maxon EPOS4: eight special bits, 16 + 17 bits of position in Gray code. Earlier their parity inverted all bits of the position.
#[test]
fn port_passes_over_eight_bits_before_a_gray_position() {
    let asked = SsiSpec {
        gray: true,
        ..asked(&[Ignored; 8], &[])
    };
    let mut rng = Rng::new(3);
    let encoder = EncoderConfig {
        position_bits: 33,
        before: vec![LOW; 8],
        ..EncoderConfig::default()
    };
    let mut run = start(&asked, encoder);
    for special in 0..=255u64 {
        let position = rng.next_u64() & ((1 << 33) - 1);
        let levels = (0..8).map(|n| Level(special >> n & 1 == 1));
        run.encoder.config.before = levels.collect();
        run.encoder.config.position = position;
        assert_eq!(frame(&mut run), (0, 0, 0, Some(position)), "{special:#x}");
    }
}

/// ams AS5045: OCF, COF, LIN, MagINC, MagDEC, even parity of all bits before it.
#[test]
fn port_takes_status_and_parity_of_an_as5045() {
    let asked = asked(&[], &[Valid, NotValid, Alarm, Shown, Shown, ParityEven]);
    let encoder = EncoderConfig {
        position_bits: 12,
        position: 0xA6C,
        after: vec![HIGH, LOW, LOW, LOW, HIGH, Ones(false)],
        ..EncoderConfig::default()
    };
    let mut run = start(&asked, encoder);
    let is = 0xA6C;
    assert_eq!(frame(&mut run), (0, 0, 0b10001, Some(is)));
    for (places, expected) in [
        (&[0][..], (cause::NOT_VALID, 0b00001)),
        (&[1], (cause::NOT_VALID, 0b11001)),
        (&[2], (cause::ALARM, 0b10101)),
        (&[0, 2], (cause::ALARM, 0b00101)),
        (&[3, 4], (0, 0b10010)),
    ] {
        let sound = run.encoder.config.after.clone();
        for place in places {
            let Level(level) = sound[*place] else {
                panic!()
            };
            run.encoder.config.after[*place] = Level(!level);
        }
        let (cause, _, shown, taken) = frame(&mut run);
        assert_eq!((cause, shown), expected, "{places:?}");
        assert_eq!(taken, (cause == 0).then_some(is));
        run.encoder.config.after = sound;
    }
    // One disturbed bit at any place.
    for bit in 0..18 {
        run.encoder.config.defect = Defect::Flip { copy: 0, bit };
        let (found, flags, _, taken) = frame(&mut run);
        assert_eq!((found, taken), (cause::PARITY, None), "{bit}");
        assert_ne!(flags & cause::flag(cause::PARITY), 0);
    }
}

/// MagnTek MT6701: four status bits and a CRC of the 18 bits before it. The CRCs were computed by long division, independent of this project.
#[test]
fn port_checks_the_crc_of_an_mt6701() {
    let asked = asked(&[], &[Ignored, Shown, Shown, Shown, Crc6]);
    for (position, status, crc) in [
        (0x1234, 0b0010, 0b01_0100),
        (0x3FFF, 0b1111, 0b00_1110),
        (0x0001, 0b0000, 0b11_0000),
        (0x2A55, 0b1001, 0b10_0101),
    ] {
        let sent = status << 6 | crc;
        let encoder = EncoderConfig {
            position_bits: 14,
            position,
            after: (0..10).rev().map(|n| Level(sent >> n & 1 == 1)).collect(),
            ..EncoderConfig::default()
        };
        let mut run = start(&asked, encoder);
        let shown = status & 7;
        assert_eq!(frame(&mut run), (0, 0, shown, Some(position)));
        // The encoder of this simulation computes the same.
        run.encoder.config.after.truncate(4);
        run.encoder.config.after.push(Crc);
        let bits: Vec<(usize, u64, u64)> = (0..24)
            .map(|bit| {
                let shown = match bit {
                    15..=17 => shown ^ 1 << (17 - bit),
                    _ => shown,
                };
                (bit, cause::CRC, shown)
            })
            .collect();
        every_bit_counts(&mut run, shown, &bits);
    }
}

/// The widest frame, each copy with its special bits: the lists, the parity bit of the position and two copies together.
#[test]
fn port_takes_63_bits_twice_and_an_alarm_from_either_copy() {
    let asked = SsiSpec {
        gray: true,
        twice: true,
        parity: Parity::Odd,
        ..asked(
            &[NotAlarm, Ignored, Shown, PowerFail],
            &[Valid, Ignored, Ignored, Shown, Crc6],
        )
    };
    assert_eq!(asked.copy_bits(48), 63);
    let encoder = EncoderConfig {
        position_bits: 48,
        before: vec![HIGH, HIGH, LOW, LOW],
        after: vec![HIGH, LOW, HIGH, HIGH, Crc],
        ..EncoderConfig::default()
    };
    let mut run = start(&asked, encoder);
    let mut rng = Rng::new(9);
    for _ in 0..20 {
        let position = rng.next_u64() >> 16;
        run.encoder.config.position = position;
        // Eight places: the alarm with its neighbours, the position, then the rest.
        assert_eq!(frame(&mut run), (0, 0, 0b1000_1001, Some(position)));
    }
    for (copy, bit, raised) in [
        (0, 0, cause::ALARM),
        (1, 0, cause::ALARM),
        (0, 3, cause::POWER_FAIL),
        (1, 3, cause::POWER_FAIL),
        (0, 4 + 48 + 1, cause::NOT_VALID),
        (1, 4 + 48 + 1, cause::NOT_VALID),
        (0, 4 + 48, cause::PARITY),
        (1, 4 + 47, cause::PARITY),
        (0, 62, cause::CRC),
        (1, 62, cause::CRC),
    ] {
        run.encoder.config.defect = Defect::Flip { copy, bit };
        let (found, flags, _, taken) = frame(&mut run);
        assert_eq!(taken, None, "{copy} {bit}");
        assert_ne!(flags & cause::flag(raised), 0, "{copy} {bit}: {flags:#x}");
        // A disturbed bit makes the CRC wrong, too.
        assert_ne!(flags & cause::flag(cause::CRC), 0, "{copy} {bit}");
        assert_eq!(found, u64::from((flags.trailing_zeros()) + 1));
    }
    run.encoder.config.defect = Defect::None;
    assert!(run.is_good());
    assert_eq!(run.encoder.violations(), []);
}

/// A host must not read "a trigger was lost" or "the previous frame ended late", both with a good position, as the cause of a frame without
/// a position.
#[test]
fn causes_of_special_bits_come_before_a_lost_trigger_and_a_late_end() {
    for (special, bit, raised) in [
        (Alarm, 12, cause::ALARM),
        (PowerFail, 12, cause::POWER_FAIL),
        (NotValid, 12, cause::NOT_VALID),
        (Crc6, 3, cause::CRC),
    ] {
        let encoder = EncoderConfig {
            position_bits: 12,
            position: 0xA6C,
            after: vec![if special == Crc6 { Crc } else { LOW }],
            ..EncoderConfig::default()
        };
        let mut run = start(&asked(&[], &[special]), encoder);
        // The previous frame is withdrawn.
        run.encoder.config.tm = 30 * US;
        assert_eq!(frame(&mut run).0, cause::RECOVERY_TOO_LONG);
        run.cycles(15 * SYSTEM_MHZ);
        run.encoder.config.tm = 18 * US;
        run.encoder.config.defect = Defect::Flip { copy: 0, bit };
        run.trigger();
        run.cycles(30);
        run.trigger();
        assert!(run.ends());
        let all = [raised, cause::TRIGGER_OVERRUN, cause::RECOVERY_TOO_LONG];
        let flags: u64 = all.map(cause::flag).iter().sum();
        assert_eq!(run.get("cause"), u128::from(raised), "{special:?}");
        assert_eq!(run.get("flags") & 0xFFF, u128::from(flags), "{special:?}");
        assert_eq!(run.fresh(), None);
    }
}

/// No bit was received, so no special bit is evaluated.
#[test]
fn special_bits_of_a_frame_without_bits_are_no_cause() {
    let mut run = start(&asked(&[], &[Valid]), EncoderConfig::default());
    run.encoder.config.defect = Defect::StuckLow;
    let not_high = cause::DATA_NOT_HIGH;
    assert_eq!(frame(&mut run), (not_high, cause::flag(not_high), 0, None));
}

/// A frame of a port set to 12 bits, with an encoder of this width that keeps its last bit.
fn run_held(
    asked: &SsiSpec,
    defect: Defect,
    encoder_bits: u32,
    check: impl Fn((u64, u64, u64, Option<u64>)),
) {
    let encoder = EncoderConfig {
        position_bits: encoder_bits,
        position: (1 << encoder_bits) - 1,
        ..EncoderConfig::default()
    };
    let mut run = start(asked, encoder);
    run.set("position_bits", 12);
    run.encoder.config.defect = defect;
    check(frame(&mut run));
}

/// The encoder is HIGH after an odd position: the next frame must still wait, or it would read that position again.
#[test]
fn port_waits_out_the_recovery_time_of_an_encoder_that_keeps_its_last_bit() {
    let asked = SsiSpec {
        holds_end: true,
        ..SsiSpec::default()
    };
    for position in [0x1DB_6DB7, 0x1DB_6DB6, 0, 0x1FF_FFFF] {
        let encoder = EncoderConfig {
            position_bits: 25,
            position,
            ..EncoderConfig::default()
        };
        let mut run = start(&asked, encoder);
        for next in [position, position ^ 1, 1, position] {
            run.encoder.config.position = next;
            run.trigger();
            assert!(run.ends());
            assert_eq!(run.get("cause"), 0, "{next:#x}");
            assert_eq!(run.fresh(), Some(next));
        }
        assert_eq!(
            (run.encoder.frames(), run.encoder.violations()),
            (4, &[][..])
        );
        // DATA that stays LOW withdraws the position, as for every encoder.
        run.trigger();
        run.cycles(26 * PERIOD + 40);
        run.broken = Some(false);
        assert!(run.ends());
        run.cycles(10);
        assert_eq!(run.get("position_valid"), 0);
        assert_eq!(run.get("cause"), u128::from(cause::RECOVERY_TOO_LONG));
    }
    // DATA must be HIGH before the frame.
    run_held(&asked, Defect::StuckLow, 12, |told| {
        assert_eq!((told.0, told.3), (cause::DATA_NOT_HIGH, None));
    });
    // A wrong width is not detected, for any level in the cell after the last bit.
    for bits in [10, 11, 13, 20] {
        run_held(&asked, Defect::None, bits, |told| {
            assert_eq!(told.0, 0, "{bits}");
            assert!(told.3.is_some());
        });
    }
    // Only a special bit distinguishes an open plug from a position of ones. With a LOW end it has a cause.
    let open = EncoderConfig {
        defect: Defect::Silent,
        position_bits: 12,
        ..EncoderConfig::default()
    };
    let mut run = start(&asked, open.clone());
    assert_eq!(frame(&mut run), (0, 0, 0, Some(0xFFF)));
    let with_alarm = SsiSpec {
        after: list(&[NotValid]),
        ..asked
    };
    let mut run = start(&with_alarm, open.clone());
    assert_eq!(frame(&mut run).0, cause::NOT_VALID);
    let mut run = start(&SsiSpec::default(), open);
    assert_eq!(frame(&mut run).0, cause::DATA_NOT_LOW_AFTER);
    // A port that expects LOW rejects the odd positions of such an encoder.
    let encoder = EncoderConfig {
        position: 1,
        ..EncoderConfig::default()
    };
    let mut run = start(&SsiSpec::default(), encoder);
    run.encoder.config.keeps_last = true;
    let low = cause::DATA_NOT_LOW_AFTER;
    assert_eq!(frame(&mut run), (low, cause::flag(low), 0, None));
}
