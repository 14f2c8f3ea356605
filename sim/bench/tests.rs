use super::*;
use crate::US;
use crate::{
    encoder::{Defect, EncoderConfig, FrameEnd, PositionSource, Symbol},
    line::{End, LineConfig, Who},
    test_receiver::{Bug, TestReceiver, LATENCY},
    MS, NS,
};
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::ModeCommand::{self, SendPosition, SendPositionAddInfo};
use rtl_design::engine::PortId;

const SYSTEM_HZ: u64 = 128_000_000;

fn bench(
    bug: Bug,
    endat_hz: u64,
    command: ModeCommand,
    encoder: EncoderConfig,
    cable_m: f64,
) -> Bench<TestReceiver> {
    let mut settings = ChannelSettings::new(SYSTEM_HZ, endat_hz, command, encoder.position_bits);
    settings.abort_us = 500; // enough for the encoder's own time-out, and 60 times quicker
    let link = Link::new(LineConfig::cable(cable_m), encoder);
    let receiver = TestReceiver::with_bug(SYSTEM_HZ, bug);
    let mut bench = Bench::channel(receiver, SYSTEM_HZ, &settings, link);
    bench.set_sample_latency(LATENCY);
    bench
}

fn good_frame(b: &mut Bench<TestReceiver>) -> u64 {
    let result = b.frame(MS).expect("a result");
    assert!(b.run_until_done(MS, |b| b.get("busy") == 0));
    let frame = b.frames(0).last().unwrap().clone();
    assert_eq!(result.cause, cause::NONE, "{result:?} {frame:?}");
    assert_eq!(result.position, frame.position);
    assert_eq!(frame.end, FrameEnd::Complete, "{frame:?} {result:?}");
    assert_eq!(Some(frame.rising_edges), frame.expected_rising_edges());
    assert!(result.fresh);
    result.position
}

fn assert_clean(b: &Bench<TestReceiver>) {
    assert_eq!(b.violations(0), []);
    assert_eq!(b.conflicts(0), []);
}

#[test]
fn the_captured_frame_comes_back_with_66_rising_edges() {
    let mut encoder = EncoderConfig::endat22(37).position(PositionSource::Fixed(0x7_5006_84EF));
    encoder.tcal = 4_520 * NS;
    let settings = ChannelSettings::new(SYSTEM_HZ, 8_000_000, SendPositionAddInfo, 37)
        .start_time_ns(2_040, SYSTEM_HZ);
    let link = Link::new(LineConfig::cable(2.0), encoder);
    let mut b = Bench::channel(TestReceiver::new(SYSTEM_HZ), SYSTEM_HZ, &settings, link);
    b.set_sample_latency(LATENCY);
    good_frame(&mut b); // measures the delay at 200 kHz
    assert_eq!(good_frame(&mut b), 0x7_5006_84EF);
    let frame = b.frames(0)[1].clone();
    assert_eq!(frame.rising_edges, 66);
    assert_eq!(frame.start_edge, Some(21));
    assert_eq!(
        frame.answer.to_text(),
        "101111101110010000101100000000010101110011001"
    );
    assert_eq!(b.results()[1].crc_received, 0x19);
    assert!((frame.first_rise - frame.first_fall).abs_diff(2_040 * NS) < 8 * NS);
    assert!((frame.start_time - frame.first_fall).abs_diff(4_540 * NS) < 8 * NS);
    assert_clean(&b);
}

#[test]
fn every_sample_hits_its_own_bit_in_the_middle() {
    let mut b = bench(
        Bug::None,
        8_000_000,
        SendPositionAddInfo,
        EncoderConfig::endat22(25),
        100.0,
    );
    (0..3).for_each(|_| {
        good_frame(&mut b);
    });
    b.run_for(30 * US);
    let samples = b.samples(0);
    assert_eq!(samples.len(), 3 * 33);
    for (i, s) in samples.iter().enumerate() {
        assert_eq!(s.answer_bit(), Some((i % 33) as u8));
        assert!(s.is_defined(40 * NS), "{s:?}");
    }
    assert_clean(&b);
}

#[test]
fn cables_commands_and_rates_give_exact_pulses_and_no_conflict() {
    for cable_m in [0.0, 1.0, 20.0, 100.0] {
        for hz in [
            100_000, 200_000, 1_000_000, 3_200_000, 8_000_000, 16_000_000,
        ] {
            for (command, bits) in [
                (SendPosition, 1),
                (SendPosition, 25),
                (SendPositionAddInfo, 48),
            ] {
                let mut b = bench(
                    Bug::None,
                    hz,
                    command,
                    EncoderConfig::endat22(bits),
                    cable_m,
                );
                (0..3).for_each(|_| {
                    good_frame(&mut b);
                });
                assert_clean(&b);
            }
        }
    }
}

#[test]
fn one_pulse_more_or_less_is_noticed() {
    let run = |extra| {
        let mut b = bench(
            Bug::ExtraPulses(extra),
            8_000_000,
            SendPositionAddInfo,
            EncoderConfig::endat22(25),
            20.0,
        );
        good_frame(&mut b);
        b.frame(MS);
        b.run_for(20 * US);
        b.violations(0).first().map(|v| v.1)
    };
    // The start bit is launched by edge 25 (2 us + 24 T = 5 us = tcal), and 32 bits follow it.
    assert_eq!(run(1), Some(Violation::TooManyPulses { expected: 58 }));
    assert_eq!(
        run(-1),
        Some(Violation::TooFewPulses {
            seen: 57,
            expected: 58
        })
    );
    assert_eq!(run(0), None);
}

#[test]
fn a_driver_that_stays_on_is_a_conflict() {
    let mut b = bench(
        Bug::LateRelease(2),
        1_000_000,
        SendPosition,
        EncoderConfig::endat22(13),
        1.0,
    );
    b.frame(MS);
    let c = b.conflicts(0);
    assert!(
        c.iter().any(|c| c.end == End::Encoder && c.both_on),
        "{c:?}"
    );
    assert!(
        c.iter().any(|c| c.end == End::Receiver && c.both_on),
        "{c:?}"
    );
}

#[test]
fn a_receiver_that_does_not_wait_is_noticed() {
    let mut b = bench(
        Bug::NoRecovery,
        8_000_000,
        SendPositionAddInfo,
        EncoderConfig::endat22(25),
        1.0,
    );
    b.frame(MS);
    b.run_for(5 * US);
    b.trigger();
    b.run_for(100 * US);
    let got = b.violations(0)[0].1;
    assert!(
        matches!(
            got,
            Violation::EarlyRestart { after } if (5 * US..10 * US).contains(&after)
        ),
        "{got:?}"
    );
}

#[test]
fn a_sample_at_the_wrong_place_is_told_from_a_good_one() {
    let mut b = bench(
        Bug::LateSample(9),
        8_000_000,
        SendPositionAddInfo,
        EncoderConfig::endat22(25),
        1.0,
    );
    b.frame(MS);
    b.frame(MS);
    b.run_for(30 * US);
    let second = &b.samples(0)[33..];
    assert!(second
        .iter()
        .enumerate()
        .any(|(i, s)| s.answer_bit() != Some(i as u8)));
    assert!(second.iter().any(|s| s.who == Who::Encoder(Symbol::Tail)));
}

#[test]
fn a_command_that_the_encoder_does_not_know_is_not_answered() {
    let mut b = bench(
        Bug::Command(0b111_001),
        1_000_000,
        SendPositionAddInfo,
        EncoderConfig::endat22(25),
        1.0,
    );
    let result = b.frame(MS).unwrap();
    assert_eq!(result.cause, cause::NO_START_BIT);
    assert_eq!(b.violations(0)[0].1, Violation::UnknownCommand(0b111_001));
    let mut b = bench(
        Bug::None,
        1_000_000,
        SendPositionAddInfo,
        EncoderConfig::endat21(25),
        1.0,
    );
    b.frame(MS);
    assert_eq!(b.violations(0)[0].1, Violation::UnknownCommand(0b111_000));
}

#[test]
fn defects_reach_the_receiver_and_the_next_frame_is_good() {
    use Defect::*;
    let cases = [
        (NoStartBit, cause::NO_START_BIT),
        (LateStart(MS), cause::NO_START_BIT),
        (Open, cause::NO_START_BIT),
        (CrcXor(1), cause::CRC),
        (FlipBits(1 << 7), cause::CRC),
        (ErrorBits { f1: true, f2: true }, cause::F1),
        (
            ErrorBits {
                f1: false,
                f2: false,
            },
            cause::F2,
        ),
        (LateFall(MS), cause::DATA_NOT_FALLING),
        (HighWhenIdle(40 * US), cause::DATA_NOT_LOW),
    ];
    for (defect, cause) in cases {
        let encoder = EncoderConfig::endat22(29).defect(1, defect.clone());
        let mut b = bench(Bug::None, 4_000_000, SendPositionAddInfo, encoder, 20.0);
        let good = good_frame(&mut b);
        let result = b.frame(MS).expect("a result");
        b.run_for(33 * US);
        match cause {
            cause::DATA_NOT_LOW => {
                assert_eq!(result.cause, cause::NONE);
                assert_eq!(b.frame(MS).unwrap().cause, cause);
            }
            cause::DATA_NOT_FALLING => {
                b.run_for(10 * US);
                assert_eq!(b.results()[1].late_cause, Some(cause));
            }
            _ => {
                assert_eq!(result.cause, cause, "{defect:?}");
                assert!(!result.fresh);
                assert_eq!(result.position, good);
            }
        }
        b.run_until_done(2 * MS, |b| b.get("busy") == 0);
        good_frame(&mut b);
    }
}

#[test]
fn an_unplugged_encoder_is_silent_and_comes_back() {
    let mut encoder = EncoderConfig::endat22(29);
    encoder.unplugged.push(MS..10 * MS);
    let mut b = bench(Bug::None, 4_000_000, SendPositionAddInfo, encoder, 20.0);
    good_frame(&mut b);
    b.run_until(2 * MS);
    assert_eq!(b.frame(MS).unwrap().cause, cause::DATA_NOT_LOW);
    assert_eq!(b.frames(0).len(), 1);
    b.run_until(11 * MS);
    good_frame(&mut b);
    assert_eq!(b.conflicts(0), []);
}

#[test]
fn edges_of_a_clock_that_is_no_whole_number_of_picoseconds_do_not_drift() {
    let b = bench(
        Bug::None,
        1_000_000,
        SendPosition,
        EncoderConfig::endat22(25),
        0.0,
    );
    assert_eq!(b.time_of(1), 7_813); // 7812.5 ps
    assert_eq!(b.time_of(128_000_000), 1_000 * MS);
}

#[test]
fn recorded_cycles_replay_the_run() {
    let mut b = bench(
        Bug::None,
        4_000_000,
        SendPosition,
        EncoderConfig::endat22(13),
        1.0,
    );
    b.record_cycles();
    b.watch("busy");
    good_frame(&mut b);
    let cycles = b.cycles().unwrap().clone();
    let mut again = TestReceiver::new(SYSTEM_HZ);
    // The bench has reset the receiver, which here only counts cycles.
    for row in &cycles.rows {
        for (i, port) in cycles.ports.iter().enumerate() {
            if port.is_input {
                again.set(PortId(i), row[i]);
            }
        }
        for (i, port) in cycles.ports.iter().enumerate() {
            assert_eq!(again.get(PortId(i)), row[i], "{}", port.name);
        }
        again.tick();
    }
    assert_eq!(
        b.watched()[0]
            .changes()
            .iter()
            .map(|c| c.1)
            .collect::<Vec<_>>(),
        [0, 1, 0]
    );
}
