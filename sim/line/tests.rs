use super::*;
use crate::encoder::Symbol;
use crate::{NS, US};

const IDLE: Output = Output {
    drive: Drive::Low,
    symbol: Symbol::Idle,
};
const OFF: Output = Output {
    drive: Drive::Released,
    symbol: Symbol::Listening,
};

/// Processes all arrivals up to `until` and records the clock at the encoder.
fn run(line: &mut Line, until: Time) -> Vec<(Time, bool)> {
    let mut clock = Vec::new();
    while line.next_event() <= until {
        let t = line.next_event();
        if let Some(Arrival::Clock(level)) = line.advance(t) {
            clock.push((t, level));
        }
    }
    clock
}

#[test]
fn an_edge_takes_transceivers_and_cable() {
    let mut line = Line::new(LineConfig::cable(100.0), IDLE);
    line.set_clock(1_000 * NS, false);
    line.set_clock(1_500 * NS, true);
    assert_eq!(
        run(&mut line, 10_000 * NS),
        [(1_625 * NS, false), (2_125 * NS, true)]
    );
    assert_eq!(line.config().round_trip(), 1_250 * NS);
}

#[test]
fn distortion_moves_only_falling_edges_and_swallows_short_pulses() {
    let mut config = LineConfig::cable(0.0);
    config.clock.fall_later = 10 * NS as i64;
    let mut line = Line::new(config, IDLE);
    for (t, level) in [(100, false), (150, true), (200, false), (208, true)] {
        line.set_clock(t * NS, level);
    }
    assert_eq!(
        run(&mut line, 10_000 * NS),
        [(135 * NS, false), (175 * NS, true)]
    );
}

#[test]
fn jitter_is_seeded_and_bounded() {
    let arrivals = |seed| {
        let config = LineConfig::cable(10.0)
            .jitter(Jitter::Uniform(5 * NS))
            .seed(seed);
        let mut line = Line::new(config, IDLE);
        (1..200).for_each(|i| line.set_clock(i * 100 * NS, i % 2 == 0));
        run(&mut line, 100_000 * NS)
    };
    let a = arrivals(1);
    assert_eq!(a, arrivals(1));
    assert_ne!(a, arrivals(2));
    let errors: Vec<i64> = (1..200)
        .zip(&a)
        .map(|(i, (t, _))| *t as i64 - (i * 100 + 85) * NS as i64)
        .collect();
    assert!(errors.iter().all(|e| e.abs() <= 5 * NS as i64));
    assert!(errors.iter().any(|e| e.abs() > 4 * NS as i64));
}

#[test]
fn a_line_that_nobody_drives_reads_high() {
    let mut line = Line::new(LineConfig::cable(10.0), IDLE);
    assert!(!line.data_at_receiver());
    line.set_encoder(100 * NS, OFF);
    assert!(!line.data_at_receiver(), "the cable is 60 ns long");
    run(&mut line, 184 * NS);
    assert!(!line.data_at_receiver());
    run(&mut line, 185 * NS);
    assert!(line.data_at_receiver());
    assert_eq!(line.who_at_receiver(), Who::Nobody);
    assert!(line.data_at_encoder());
    line.set_receiver(300 * NS, Drive::Low);
    assert!(!line.data_at_receiver());
    assert!(line.data_at_encoder());
    run(&mut line, 400 * NS);
    assert!(!line.data_at_encoder());
    assert_eq!(line.conflicts(400 * NS), []);
}

#[test]
fn both_drivers_on_is_a_conflict_at_both_ends() {
    let mut line = Line::new(LineConfig::cable(0.0), IDLE);
    line.set_receiver(100 * NS, Drive::High);
    run(&mut line, 500 * NS);
    line.set_receiver(500 * NS, Drive::Released);
    run(&mut line, 600 * NS);
    let got = line.conflicts(600 * NS);
    let expected = |end, from| Conflict {
        end,
        from,
        length: 400 * NS,
        opposing: true,
        both_on: true,
    };
    assert_eq!(
        got,
        [
            expected(End::Receiver, 100 * NS),
            expected(End::Encoder, 125 * NS)
        ]
    );
}

#[test]
fn an_echo_in_the_cable_is_told_from_two_drivers() {
    let mut line = Line::new(LineConfig::cable(100.0), IDLE);
    line.set_encoder(1_000 * NS, OFF);
    line.set_receiver(1_100 * NS, Drive::Low); // the release arrives at 1625 ns
    run(&mut line, 5_000 * NS);
    let got = line.conflicts(5_000 * NS);
    assert_eq!(got.len(), 1);
    assert_eq!(
        (got[0].end, got[0].length, got[0].both_on, got[0].opposing),
        (End::Receiver, 525 * NS, false, false)
    );
}

#[test]
fn a_hand_over_without_overlap_is_no_conflict() {
    let mut line = Line::new(LineConfig::cable(20.0), OFF);
    line.set_receiver(1_000 * NS, Drive::Low);
    run(&mut line, 2_000 * NS);
    line.set_receiver(2_000 * NS, Drive::Released);
    run(&mut line, 2_145 * NS); // the release has just arrived at the encoder
    line.set_encoder(2_145 * NS, IDLE);
    run(&mut line, 5_000 * NS);
    assert_eq!(line.conflicts(5_000 * NS), []);
}

#[test]
fn glitches_invert_one_wire_for_their_time() {
    let mut config = LineConfig::cable(0.0);
    let glitch = |wire, at| Glitch {
        wire,
        at: at * NS,
        width: 7 * NS,
    };
    config.glitches = vec![glitch(Wire::Data, 100), glitch(Wire::Clock, 200)];
    let mut line = Line::new(config, IDLE);
    assert_eq!(
        run(&mut line, 1_000 * NS),
        [(200 * NS, false), (207 * NS, true)]
    );
    let at = |t: Time| line.sample(t * NS);
    assert!(!at(99).level && at(100).level && at(106).level && !at(107).level);
    assert!(!at(103).is_defined(0));
    assert!(at(90).is_defined(10 * NS) && !at(91).is_defined(10 * NS));
    assert!(!at(116).is_defined(10 * NS) && at(117).is_defined(10 * NS));
}

#[test]
fn random_glitches_come_at_their_mean_rate() {
    let mut config = LineConfig::cable(0.0);
    config.random_glitches = Some(GlitchRate {
        wire: Wire::Clock,
        mean_gap: 1_000 * NS,
        shortest: 2 * NS,
        longest: 4 * NS,
    });
    let mut line = Line::new(config, IDLE);
    let edges = run(&mut line, 1_000_000 * NS).len();
    assert!((1800..2200).contains(&edges), "{edges}");
}

#[test]
fn a_stuck_line_keeps_its_level_at_the_receiver_for_its_time() {
    for level in [false, true] {
        let mut config = LineConfig::cable(10.0);
        config.stuck = Some(Stuck {
            from: 1_000 * NS,
            until: 2_000 * NS,
            level,
        });
        let mut line = Line::new(config, IDLE);
        run(&mut line, 1_100 * NS);
        line.set_receiver(1_200 * NS, Drive::High);
        run(&mut line, 1_500 * NS);
        assert_eq!(line.data_at_receiver(), level);
        line.set_receiver(1_500 * NS, Drive::Low);
        run(&mut line, 3_000 * NS);
        let at = |t: Time| line.sample(t * NS).level;
        assert!([1_000, 1_300, 1_999].into_iter().all(|t| at(t) == level));
        assert!(!at(999) && !at(2_000));
    }
}

#[test]
fn an_echo_comes_back_late_over_the_encoder() {
    let mut config = LineConfig::cable(10.0);
    config.echo_after = Some(5_000 * NS);
    let mut line = Line::new(config, IDLE);
    line.set_receiver(1_000 * NS, Drive::High);
    line.set_receiver(2_000 * NS, Drive::Released);
    run(&mut line, 9_000 * NS);
    let at = |t: Time| line.sample(t * NS).level;
    assert!(at(1_500) && !at(2_500) && !at(5_999) && at(6_000) && at(6_999) && !at(7_000));
}

#[test]
fn a_drifting_path_grows_with_time() {
    let mut config = LineConfig::cable(0.0);
    config.clock.drift = 100;
    let mut line = Line::new(config, IDLE);
    line.set_clock(1_000 * US, false);
    let late = 1_000 * US + 25 * NS + 100 * NS;
    assert_eq!(run(&mut line, 1_001 * US), [(late, false)]);
}
