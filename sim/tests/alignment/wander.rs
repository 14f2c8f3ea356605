//! Delays that change: slowly, and by a step.

use super::{count, Kind};
use crate::tools::third;
use endat_hdl::endat::{line_delay::mode, transaction::cause};
use endat_sim::{campaign::Traces, line::Jitter, MS, US};
use rtl_design::engine::Compiled;

/// What a change of it tries other cases by.
const TRACKER: &str = include_str!("../../../hdl/endat/phase_tracker.rs");

/// A microsecond in 10 000 frames, and then half a bit at once.
fn wanders(kind: Kind, jitter_bits: f64) {
    let mut case = kind.case(jitter_bits, 3.0, 10_000, 7);
    // A frame and its recovery time take 10 us and more: 1 us in 100 ms at least.
    case.line.data_in.drift = 10;
    let engine = Compiled::new(&case.design().unwrap()).unwrap();
    let bench = case.run_alone(engine, false);
    let got = count(&case, &Traces::of(&bench), case.calibration_frames());
    assert_eq!((got.good, got.wrong), (got.frames, 0), "{kind:?}");
    let moved = bench.now() / US * 10;
    assert!(moved >= US, "{moved} ps");
    let results = bench.results();
    let places = results[results.len() - 1].delay_cycles - results[4].delay_cycles;
    let cycle = 1e12 / case.system_hz as f64;
    assert!(
        (places as f64 - moved as f64 / cycle).abs() < 3.0,
        "{places}"
    );
}

#[test]
fn slow_drift_costs_no_frame() {
    let all = [
        (Kind::single(4), 0.0),
        (Kind::single(8), 0.2),
        (Kind::double(4), 0.2),
    ];
    for &(kind, jitter_bits) in third(&all, TRACKER.len()) {
        wanders(kind, jitter_bits);
    }
}

#[test]
fn a_step_costs_one_frame_at_most_and_never_a_wrong_position() {
    let kinds = [
        Kind::single(4),
        Kind::single(8),
        Kind::double(4),
        Kind::single(32),
    ];
    for &kind in third(&kinds, TRACKER.len()) {
        for sign in [-1.0, 1.0] {
            for sixteenths in 1..=16 {
                let mut case = kind.case(0.05, 3.0, 60, sixteenths);
                case.line.data_in.jitter = Jitter::Uniform((0.02 * kind.bit()) as u64);
                let step = sign * sixteenths as f64 / 16.0 * kind.bit();
                case.line.data_in.step = Some((2 * MS, step as i64));
                let engine = Compiled::new(&case.design().unwrap()).unwrap();
                let bench = case.run_alone(engine, false);
                let first = bench.results().iter().position(|r| r.time > MS).unwrap();
                let got = count(&case, &Traces::of(&bench), first);
                let what = format!("{kind:?}, {sign} * {sixteenths}/16: {got:?}");
                assert_eq!(got.wrong, 0, "{what}");
                assert!(got.good + 1 >= got.frames, "{what}");
                // The phase is found again: the last frames are good.
                let got = count(&case, &Traces::of(&bench), case.frames - 20);
                assert_eq!(got.good, got.frames, "{what}");
            }
        }
    }
}

/// The start bit's edge is looked for in its window in every mode, whether the cells follow it or not.
#[test]
fn a_start_bit_outside_its_window_is_refused_in_every_mode() {
    const WINDOW_CYCLES: i64 = 6;
    for cycles in [31, 32] {
        for phase_mode in [mode::TRACKED, mode::FRAME] {
            for step_cycles in [-12, -8, -6, -4, 4, 6, 9, 12] {
                let kind = Kind::single(cycles);
                let mut case = kind.case(0.0, 3.3, 100, 1);
                case.settings.phase_mode = phase_mode;
                case.settings.start_window_cycles = WINDOW_CYCLES as u64;
                let cycle_ps = 1e12 / case.system_hz as f64;
                case.line.data_in.step = Some((2 * MS, (step_cycles as f64 * cycle_ps) as i64));
                let engine = Compiled::new(&case.design().unwrap()).unwrap();
                let bench = case.run_alone(engine, false);
                let causes: Vec<u64> = bench.results().iter().map(|r| r.last_cause()).collect();
                let refused = causes.iter().filter(|c| **c != cause::NONE).count();
                let what = format!("{cycles} {phase_mode} {step_cycles}: {causes:?}");
                if i64::abs(step_cycles) <= WINDOW_CYCLES {
                    assert_eq!(refused, 0, "{what}");
                } else {
                    assert_eq!(refused, 1, "{what}");
                    assert!(causes.contains(&cause::START_WINDOW), "{what}");
                }
            }
        }
    }
}
