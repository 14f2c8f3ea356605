//! Continuous clock mode.

use super::*;

/// 10 pulses to the start bit, 20 bits, HIGH: `c` = 30.
const FIRST: u32 = 31;

fn master(edge: LatchEdge) -> Master {
    let config = EncoderConfig::endat22(13)
        .continuous(edge)
        .position(PositionSource::Ramp {
            start: 0x1234,
            step: 0x111,
        });
    Master::new(config, 1_000_000)
}

/// Symbols before the falling edges of the `count` pulses after the first position.
fn go_on(m: &mut Master, count: u32) -> Vec<Output> {
    m.pulses(POSITION_21, 500 * NS, FIRST);
    let pulse = |_| m.pulse(Drive::Released, 500 * NS);
    (0..count).map(pulse).collect()
}

fn position(bits: &[Output]) -> u64 {
    let high = |o: &Output| o.drive == Drive::High;
    assert!(high(&bits[0]) && !high(&bits[1]), "S, F1");
    let covered: Vec<bool> = bits[1..15].iter().map(high).collect();
    let crc: Vec<bool> = bits[15..20].iter().map(high).collect();
    assert_eq!(u32::from(crc5(covered.iter().copied())), number(&crc));
    covered[1..]
        .iter()
        .rev()
        .fold(0, |p, b| p << 1 | u64::from(*b))
}

#[test]
fn positions_follow_without_a_command() {
    for (edge, latch) in [(LatchEdge::InHigh, 1), (LatchEdge::AfterLow, 2)] {
        let mut m = master(edge);
        let first = m.now;
        let seen = go_on(&mut m, 80);
        // F(c+2) is the first falling edge after the 31 pulses.
        let latch = first + Time::from(FIRST + latch - 1) * US;
        let frames = m.encoder.frames();
        assert_eq!(frames[1].first_fall, latch, "{edge:?}");
        assert!(!frames[0].continuous && frames[1].continuous);
        assert_eq!(frames[0].end, FrameEnd::Complete);
        assert_eq!(frames[0].rising_edges, FIRST);
        assert_eq!(seen[0].drive, Drive::Low, "the HIGH cell is one clock long");
        // tcal of 5 us, then the first rising edge.
        let start = seen
            .iter()
            .position(|o| o.symbol == Symbol::Bit(0))
            .unwrap();
        assert_eq!(frames[1].start_time, latch + 5_500 * NS);
        assert!(seen[..start].iter().all(|o| o.drive == Drive::Low));
        assert_eq!(position(&seen[start..start + 20]), 0x1234 + 0x111);
        assert_eq!(seen[start + 20].drive, Drive::High);
        assert_eq!(seen[start + 21].drive, Drive::Low);
        assert_eq!(
            frames[1].expected_rising_edges(),
            Some(frames[1].rising_edges)
        );
        let next = seen[start + 20..]
            .iter()
            .position(|o| o.symbol == Symbol::Bit(0));
        let next = start + 20 + next.unwrap();
        assert_eq!(position(&seen[next..next + 20]), 0x1234 + 0x222);
        assert_eq!(m.violations(), []);
    }
}

#[test]
fn the_mode_is_left_with_the_clock_high_for_the_recovery_time() {
    for edge in [LatchEdge::InHigh, LatchEdge::AfterLow] {
        for pulses in 0..60 {
            let mut m = master(edge);
            go_on(&mut m, pulses);
            m.wait(31 * US);
            assert!(m.encoder.is_ready(m.now), "{edge:?} {pulses}");
            assert_eq!(m.encoder.output().symbol, Symbol::Idle);
            assert_ne!(m.last().end, FrameEnd::Running);
            m.position22(POSITION_22, 0, 0);
            assert_eq!(m.violations(), []);
        }
    }
}

#[test]
fn a_clock_that_comes_back_too_soon_is_noticed() {
    let mut m = master(LatchEdge::AfterLow);
    m.encoder.config.tm = 20 * US..=20 * US;
    go_on(&mut m, 1); // in the gap
    m.wait(15 * US); // longer than in the middle of a frame, and not as long as tm
    m.pulse(Drive::Released, 500 * NS);
    let high = Violation::PulseWidth {
        high: true,
        width: 15_500 * NS,
        edge: FIRST,
    };
    assert_eq!(m.violations(), [high]);
    assert!(m.last().continuous);
}

#[test]
fn the_high_cell_is_as_long_as_the_others() {
    let mut m = master(LatchEdge::InHigh);
    go_on(&mut m, 0);
    m.wait(3 * US);
    m.pulse(Drive::Released, 500 * NS);
    let high = Violation::PulseWidth {
        high: true,
        width: 3_500 * NS,
        edge: FIRST,
    };
    assert_eq!(m.violations(), [high]);
}

#[test]
fn the_clock_keeps_its_rate() {
    let mut m = master(LatchEdge::AfterLow);
    go_on(&mut m, 1);
    m.half = 300 * NS;
    m.pulse(Drive::Released, 500 * NS); // takes a position
    assert_eq!(m.violations(), []);
    m.pulse(Drive::Released, 300 * NS);
    assert!(matches!(
        m.violations()[0],
        Violation::PulseWidth { high: true, .. }
    ));
}

#[test]
fn data_is_low_for_one_cell_before_the_start_bit() {
    for (edge, start) in [(LatchEdge::InHigh, 2), (LatchEdge::AfterLow, 1)] {
        let mut m = master(edge);
        m.encoder.config.tcal = 0;
        let seen = go_on(&mut m, 4);
        assert_eq!(seen[0].drive, Drive::Low);
        assert_eq!(seen[1].symbol, Symbol::Bit(0));
        assert_eq!(m.last().start_edge, Some(start));
        assert_eq!(m.last().period, US, "known before it is measured again");
    }
}

#[test]
fn a_clock_that_stays_low_ends_the_mode_too() {
    for pulses in [0, 1, 5, 12] {
        let mut m = master(LatchEdge::AfterLow);
        m.encoder.config.max_clock_low = 30 * US;
        go_on(&mut m, pulses);
        m.edge(false, Drive::Released);
        m.wait(31 * US);
        assert_eq!(m.violations(), [Violation::ClockLowTooLong]);
    }
}

#[test]
fn only_21_positions_of_an_encoder_that_allows_it_go_on() {
    let too_many = |config: EncoderConfig, code| {
        let mut m = Master::new(config, 1_000_000);
        let f2 = u32::from(code == POSITION_22);
        m.pulses(code, 500 * NS, FIRST + f2 + 1);
        m.violations()
    };
    let allowed = || quick().continuous(LatchEdge::AfterLow);
    assert_eq!(too_many(allowed(), POSITION_21), []);
    let expected = FIRST;
    let violation = Violation::TooManyPulses { expected };
    assert_eq!(too_many(quick(), POSITION_21), [violation]);
    let expected = FIRST + 1;
    let violation = Violation::TooManyPulses { expected };
    assert_eq!(too_many(allowed(), POSITION_22), [violation]);
}
