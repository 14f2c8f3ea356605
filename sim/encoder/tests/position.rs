//! Positions, defects and violations of the position commands.

use super::*;
use crate::frame::PositionAnswer;

const COMMAND: u8 = 0b111_000;

fn encoder() -> EncoderConfig {
    EncoderConfig::endat22(13).position(PositionSource::Fixed(0x1234))
}

/// A whole frame at 1 MHz: 11 pulses to the start bit, 21 bits.
fn frame(config: EncoderConfig) -> Master {
    let mut m = Master::new(config, 1_000_000);
    m.pulses(COMMAND, 500 * NS, 32);
    m.wait(40 * US);
    m
}

#[test]
fn a_frame_follows_the_drawing() {
    let mut m = Master::new(encoder(), 1_000_000);
    let begin = m.now;
    let seen = m.pulses(COMMAND, 500 * NS, 32);
    let last_rise = m.now - m.half;
    m.wait(40 * US);
    assert_eq!(m.violations(), []);
    let symbols: Vec<Symbol> = seen.iter().map(|o| o.symbol).collect();
    assert_eq!(symbols[..9], [Symbol::Listening; 9]);
    assert_eq!(
        symbols[9],
        Symbol::Lead,
        "LOW from F#10, one period after the release"
    );
    assert_eq!(symbols[10], Symbol::Bit(0), "start bit at R#11");
    assert_eq!(
        symbols[31],
        Symbol::Tail,
        "HIGH at the edge after the last bit"
    );
    let answer = PositionAnswer {
        f1: false,
        f2: Some(true),
        position: 0x1234,
        position_bits: 13,
    };
    let bits: Vec<bool> = seen[10..31]
        .iter()
        .map(|o| o.drive == Drive::High)
        .collect();
    assert_eq!(bits, answer.bits().iter().collect::<Vec<_>>());
    let released = m.outputs.iter().find(|o| o.1.drive == Drive::Released);
    assert!(released.unwrap().0 - begin <= 200 * NS);
    let fall = m.drives(Symbol::Idle);
    assert!((10 * US..=30 * US).contains(&(fall - last_rise)));
    let log = &m.encoder.frames()[0];
    assert_eq!((log.rising_edges, log.start_edge), (32, Some(11)));
    assert_eq!((log.end, log.data_fall), (FrameEnd::Complete, Some(fall)));
    assert_eq!((log.first_fall, log.last_rise), (begin, last_rise));
    assert_eq!((log.period, log.command), (US, Some(COMMAND)));
}

#[test]
fn the_start_bit_waits_for_tcal() {
    for (tcal, edge) in [
        (11_000, 12),
        (10_500, 11),
        (10_501, 12),
        (20_400, 21),
        (20_501, 22),
    ] {
        let mut config = encoder();
        config.tcal = tcal * NS;
        let mut m = Master::new(config, 1_000_000);
        m.pulses(COMMAND, 500 * NS, 21 + edge);
        assert_eq!(m.encoder.frames()[0].start_edge, Some(edge), "{tcal} ns");
        assert_eq!(m.encoder.frames()[0].end, FrameEnd::Complete);
    }
}

#[test]
fn a_21_encoder_answers_without_f2_and_refuses_22() {
    let mut m = Master::new(EncoderConfig::endat21(13), 1_000_000);
    m.pulses(0b000_111, 500 * NS, 31);
    assert_eq!(m.encoder.frames()[0].answer.len, 20);
    m.wait(50 * US);
    m.pulses(COMMAND, 500 * NS, 40);
    m.wait(50 * US);
    let seen = 40;
    assert_eq!(
        m.violations(),
        [
            Violation::UnknownCommand(COMMAND),
            Violation::StoppedBeforeAnswer { seen }
        ]
    );
    assert!(m.encoder.is_ready(m.now));
}

#[test]
fn every_other_command_is_refused() {
    let known = |code: u8, endat22: bool| {
        let mut commands = Command::ALL.iter().take(if endat22 { 14 } else { 7 });
        commands.any(|c| c.0 == code)
    };
    let all = (0..64).flat_map(|c| [(c, false), (c, true)]);
    let refused: Vec<_> = all.filter(|(c, endat22)| !known(*c, *endat22)).collect();
    assert_eq!(refused.len(), 57 + 50);
    for (command, endat22) in refused {
        let mut config = encoder();
        config.endat22 = endat22;
        let mut m = Master::new(config, 1_000_000);
        let seen = m.pulses(command, 500 * NS, 32);
        assert_eq!(m.violations(), [Violation::UnknownCommand(command)]);
        assert!(seen[9..].iter().all(|o| o.drive == Drive::Low));
        assert_eq!(
            m.encoder.frames()[0].refused,
            Some(ErrorSource::ModeCommand)
        );
    }
}

#[test]
fn pulse_counts_must_be_exact() {
    let with = |pulses| {
        let mut m = Master::new(encoder(), 1_000_000);
        m.pulses(COMMAND, 500 * NS, pulses);
        m.wait(50 * US);
        assert!(m.encoder.is_ready(m.now));
        (m.encoder.frames()[0].end, m.violations())
    };
    let few = Violation::TooFewPulses {
        seen: 31,
        expected: 32,
    };
    assert_eq!(with(31), (FrameEnd::Stopped, vec![few]));
    assert_eq!(with(32), (FrameEnd::Complete, vec![]));
    let many = Violation::TooManyPulses { expected: 32 };
    assert_eq!(with(33), (FrameEnd::Overrun, vec![many]));
    assert_eq!(with(40), (FrameEnd::Overrun, vec![many]));
    let none = Violation::StoppedBeforeAnswer { seen: 9 };
    assert_eq!(with(9), (FrameEnd::Stopped, vec![none]));
}

#[test]
fn the_next_frame_must_wait_for_low_and_tr() {
    let after_fall = |wait| {
        let mut config = encoder();
        config.tm = 10 * US..=10 * US;
        let mut m = Master::new(config, 1_000_000);
        m.pulses(COMMAND, 500 * NS, 32);
        m.wait(9_500 * NS + wait);
        m.pulses(COMMAND, 500 * NS, 32);
        m.violations().first().copied()
    };
    let early = |after| Some(Violation::EarlyRestart { after: after * NS });
    assert_eq!(after_fall(0), early(10_000));
    assert_eq!(after_fall(499 * NS), early(10_499));
    assert_eq!(after_fall(500 * NS), None);
}

#[test]
fn clock_limits_scale_with_the_encoder() {
    let at = |hz, max| {
        let mut config = encoder();
        config.max_clock_hz = max;
        let mut m = Master::new(config, hz);
        m.pulses(COMMAND, 2 * US, 12);
        m.violations().first().copied()
    };
    assert_eq!(at(2_000_000, 2_000_000), None);
    assert_eq!(at(100_000, 2_000_000), None);
    let period = 400 * NS;
    assert_eq!(
        at(2_500_000, 2_000_000),
        Some(Violation::ClockRate { period })
    );
    let period = 12_500 * NS;
    assert_eq!(at(80_000, 2_000_000), Some(Violation::ClockRate { period }));
}

#[test]
fn a_short_pulse_is_noticed_and_a_low_pause_is_not() {
    let with = |pause: Time, high: Time| {
        let mut m = Master::new(encoder(), 1_000_000);
        m.pulses(COMMAND, 500 * NS, 12);
        m.edge(false, Drive::Released);
        m.wait(pause);
        m.edge(true, Drive::Released);
        m.wait(high);
        m.edge(false, Drive::Released);
        m.violations().first().copied()
    };
    assert_eq!(with(500 * NS, 500 * NS), None);
    assert_eq!(with(9 * US, 500 * NS), None);
    let short = |high, width| {
        Some(Violation::PulseWidth {
            high,
            width: width * NS,
            edge: 13,
        })
    };
    assert_eq!(with(500 * NS, 380 * NS), short(true, 380));
    assert_eq!(with(500 * NS, 620 * NS), short(true, 620));
    assert_eq!(with(380 * NS, 500 * NS), short(false, 380));
    assert_eq!(with(410 * NS, 590 * NS), None);
}

#[test]
fn a_low_clock_has_its_limit() {
    let low_for = |span| {
        let mut config = encoder();
        config.max_clock_low = 30 * US; // a linear encoder of the LC kind
        let mut m = Master::new(config, 1_000_000);
        m.pulses(COMMAND, 500 * NS, 15);
        m.edge(false, Drive::Released);
        m.wait(span);
        m.edge(true, Drive::Released);
        m.wait(15 * US);
        (m.violations().first().copied(), m.encoder.is_ready(m.now))
    };
    assert_eq!(low_for(31 * US), (Some(Violation::ClockLowTooLong), true));
    assert!(matches!(
        low_for(29 * US).0,
        Some(Violation::TooFewPulses { .. })
    ));
}

#[test]
fn a_command_that_nobody_drives_is_noticed() {
    let mut m = Master::new(encoder(), 1_000_000);
    for _ in 0..3 {
        m.edge(false, Drive::Released);
        m.wait(500 * NS);
        m.edge(true, Drive::Released);
        m.wait(500 * NS);
    }
    assert_eq!(m.violations(), [Violation::CommandNotDriven { edge: 3 }]);
}

#[test]
fn positions_come_from_their_source_and_fit_the_width() {
    let positions = |source| {
        let mut m = Master::new(encoder().position(source), 1_000_000);
        for _ in 0..3 {
            m.pulses(COMMAND, 500 * NS, 32);
            m.wait(40 * US);
        }
        let got: Vec<u64> = m.encoder.frames().iter().map(|f| f.position).collect();
        got
    };
    assert_eq!(positions(PositionSource::Fixed(0xF_FFFF)), [0x1FFF; 3]);
    let ramp = PositionSource::Ramp {
        start: 0x1FFE,
        step: 1,
    };
    assert_eq!(positions(ramp), [0x1FFE, 0x1FFF, 0]);
    let time = PositionSource::Function(std::sync::Arc::new(|n, t| n * 1000 + t / US));
    assert_eq!(positions(time), [10, 1082, 2154]);
    let random = positions(PositionSource::Random);
    assert_eq!(random, positions(PositionSource::Random));
    assert!(random.iter().all(|p| *p < 0x2000));
    assert_ne!(random[0], random[1]);
}

#[test]
fn defects_of_the_answer_do_what_they_say() {
    let good = frame(encoder()).encoder.frames()[0].answer;
    let answer = |d| frame(encoder().defect(0, d)).encoder.frames()[0].answer;
    assert_eq!(answer(Defect::FlipBits(0b101)).word, good.word ^ 0b101);
    assert_eq!(answer(Defect::CrcXor(0b1_0000)).word, good.word ^ 1 << 16);
    assert_eq!(answer(Defect::WiderBy(-2)).len, 19);
    assert_eq!(answer(Defect::WithoutF2).len, 20);
    let errors = PositionAnswer {
        f1: true,
        f2: Some(false),
        position: 0x1234,
        position_bits: 13,
    };
    let sent = Defect::ErrorBits {
        f1: true,
        f2: false,
    };
    assert_eq!(answer(sent), errors.bits());
    let untouched = frame(encoder().defect(1, Defect::FlipBits(1)));
    assert_eq!(untouched.encoder.frames()[0].answer, good);
}

#[test]
fn defects_of_the_line_hold_from_their_bit_to_the_end_of_the_frame() {
    let drives = |d| {
        let m = frame(encoder().defect(0, d));
        let of = |s| {
            m.outputs
                .iter()
                .rfind(|o| o.1.symbol == s)
                .map(|o| o.1.drive)
        };
        (
            of(Symbol::Bit(4)),
            of(Symbol::Bit(5)),
            of(Symbol::Tail),
            of(Symbol::Idle),
        )
    };
    // Bits 3 to 6 of the answer are the lowest of 0x1234: 0, 0, 1, 0.
    let level = false;
    let (before, at, tail, idle) = drives(Defect::StuckFrom { bit: 5, level });
    assert_eq!((before, at), (Some(Drive::Low), Some(Drive::Low)));
    assert_eq!((tail, idle), (Some(Drive::Low), Some(Drive::Low)));
    let (before, at, tail, idle) = drives(Defect::OpenFrom(5));
    assert_eq!((before, at), (Some(Drive::Low), Some(Drive::Released)));
    assert_eq!((tail, idle), (Some(Drive::Released), Some(Drive::Low)));
    assert_eq!(drives(Defect::Open).1, Some(Drive::Released));
}

#[test]
fn defects_of_time_move_their_edge() {
    let starts = |d| frame(encoder().defect(0, d)).encoder.frames()[0].start_edge;
    assert_eq!(starts(Defect::NoStartBit), None);
    assert_eq!(starts(Defect::LateStart(8 * US)), Some(14));
    assert_eq!(starts(Defect::StartAtEdge(9)), Some(9));
    let high = |d| {
        let m = frame(encoder().defect(0, d));
        let log = &m.encoder.frames()[0];
        log.data_fall.map(|t| t - log.last_rise)
    };
    let normal = high(Defect::NoStartBit);
    assert_eq!(normal, None);
    let normal = high(Defect::CrcXor(0)).unwrap();
    assert_eq!(high(Defect::LateFall(9 * US)).unwrap(), normal + 9 * US);
    let m = frame(encoder().defect(0, Defect::HighWhenIdle(3 * US)));
    let fall = m.encoder.frames()[0].data_fall.unwrap();
    let later: Vec<_> = m.outputs.iter().filter(|o| o.0 > fall).collect();
    assert_eq!(later.len(), 2);
    assert_eq!((later[0].0, later[1].0), (fall + US, fall + 4 * US));
}

#[test]
fn missed_and_doubled_edges_shift_the_answer() {
    let rises = |d| {
        let m = frame(encoder().defect(0, d));
        (m.encoder.frames()[0].rising_edges, m.violations().pop())
    };
    assert!(matches!(
        rises(Defect::MissEdge(20)),
        (31, Some(Violation::TooFewPulses { .. }))
    ));
    assert!(matches!(
        rises(Defect::DoubleEdge(20)),
        (32, Some(Violation::TooManyPulses { .. }))
    ));
}

#[test]
fn an_encoder_without_supply_does_nothing_until_it_is_back() {
    let mut config = encoder().defect(
        0,
        Defect::BrownOut {
            after: 15 * US,
            length: 30 * US,
        },
    );
    config.unplugged.push(MS..2 * MS);
    let mut m = frame(config);
    let log = m.encoder.frames()[0].clone();
    assert_eq!(log.end, FrameEnd::Lost);
    let absent = m.outputs.iter().find(|o| o.1.symbol == Symbol::Absent);
    assert_eq!(absent.unwrap().0, log.first_fall + 15 * US);
    m.wait(20 * US);
    m.pulses(COMMAND, 500 * NS, 32);
    assert_eq!(m.encoder.frames()[1].end, FrameEnd::Complete);
    m.wait(MS);
    m.pulses(COMMAND, 500 * NS, 32);
    assert_eq!(m.encoder.frames().len(), 2, "unplugged");
}

#[test]
fn a_glitch_inverts_the_driver_for_its_time() {
    let m = frame(encoder().defect(
        0,
        Defect::Glitch {
            after: 10_200 * NS,
            width: 30 * NS,
        },
    ));
    let begin = m.encoder.frames()[0].first_fall;
    let glitch: Vec<_> = m
        .outputs
        .iter()
        .filter(|o| o.1.symbol == Symbol::Lead)
        .collect();
    let times: Vec<Time> = glitch.iter().map(|o| o.0 - begin).collect();
    assert_eq!(times, [9_050 * NS, 10_200 * NS, 10_230 * NS]);
    assert_eq!(glitch[1].1.drive, Drive::High);
}
