//! Delays that change: slowly, and by a step.

use super::{count, engine, Kind};
use endat_hdl::endat::{line_delay::mode, transaction::cause};
use endat_sim::{campaign::Traces, line::Jitter, Time, MS, US};

/// A delay that grows by `drift` ps in each microsecond, for this many frames.
fn wanders(kind: Kind, jitter_bits: f64, frames: usize, drift: u64) {
    let mut case = kind.case(jitter_bits, 3.0, frames, 7);
    case.line.data_in.drift = drift as i64;
    let bench = case.run_alone(engine(&case), false);
    let got = count(&case, &Traces::of(&bench), case.calibration_frames());
    assert_eq!((got.good, got.wrong), (got.frames, 0), "{kind:?}");
    let moved = bench.now() / US * drift;
    // A frame and its recovery time take at least 10 us.
    assert!(moved >= 10 * drift * frames as u64, "{moved} ps");
    let results = bench.results();
    let places = results[results.len() - 1].delay_cycles - results[4].delay_cycles;
    let cycle = 1e12 / case.system_hz as f64;
    assert!(
        (places as f64 - moved as f64 / cycle).abs() < 3.0,
        "{places}"
    );
}

/// 0.4 us, five times as fast as in the slow test; with jitter at the same rate.
#[test]
fn slow_drift_costs_no_frame() {
    wanders(Kind::single(4), 0.0, 800, 50);
    wanders(Kind::double(4), 0.2, 800, 10);
}

#[test]
#[ignore = "slow: a microsecond in ten thousand frames, three oversamplings"]
fn slow_drift_costs_no_frame_of_ten_thousand() {
    for (kind, jitter_bits) in [
        (Kind::single(4), 0.0),
        (Kind::single(8), 0.2),
        (Kind::double(4), 0.2),
    ] {
        wanders(kind, jitter_bits, 10_000, 10);
    }
}

/// After the frames that measure the delay and some more, and before the last ones.
const STEP: Time = 1_200 * US;

/// The largest step after which the phase is certain. After a larger one the delay may be wrong by a whole bit, because the window of the start
/// bit is as wide as a bit. Positions are still right then, but the encoder does not receive exactly its pulses.
const CERTAIN_SIXTEENTHS: u64 = 6;

/// Steps of these sixteenths of a bit, in both directions.
fn steps(kinds: &[Kind], steps_sixteenths: &[u64]) {
    for &kind in kinds {
        for sign in [-1.0, 1.0] {
            for &sixteenths in steps_sixteenths {
                let mut case = kind.case(0.05, 3.0, 60, sixteenths);
                case.line.data_in.jitter = Jitter::Uniform((0.02 * kind.bit()) as u64);
                let step = sign * sixteenths as f64 / 16.0 * kind.bit();
                case.line.data_in.step = Some((STEP, step as i64));
                let bench = case.run_alone(engine(&case), false);
                let first = bench.results().iter().position(|r| r.time > MS).unwrap();
                let before = bench.results().iter().filter(|r| r.time < STEP).count();
                assert!((first + 10..case.frames - 20).contains(&before), "{before}");
                let got = count(&case, &Traces::of(&bench), first);
                let what = format!("{kind:?}, {sign} * {sixteenths}/16: {got:?}");
                assert_eq!(got.wrong, 0, "{what}");
                if sixteenths > CERTAIN_SIXTEENTHS {
                    continue;
                }
                assert!(got.good + 1 >= got.frames, "{what}");
                // The phase recovers: the last frames are good.
                let got = count(&case, &Traces::of(&bench), case.frames - 20);
                assert_eq!(got.good, got.frames, "{what}");
            }
        }
    }
}

#[test]
fn a_step_costs_one_frame_at_most_and_never_a_wrong_position() {
    steps(
        &[Kind::single(8).slower(), Kind::double(4).slower()],
        &[1, 6, 16],
    );
}

#[test]
#[ignore = "slow: steps of every sixteenth of a bit at four oversamplings"]
fn a_step_of_up_to_a_bit_never_gives_a_wrong_position() {
    let kinds = [
        Kind::single(4),
        Kind::single(8),
        Kind::double(4),
        Kind::single(32),
    ];
    let all: Vec<u64> = (1..=16).collect();
    steps(&kinds, &all);
}

/// The edge of the start bit must be in its window in every mode, whether the cells follow it or not.
fn windows(kinds: &[Kind], steps_cycles: &[i64]) {
    const WINDOW_CYCLES: i64 = 6;
    for &kind in kinds {
        for phase_mode in [mode::TRACKED, mode::FRAME] {
            for &step_cycles in steps_cycles {
                let mut case = kind.case(0.0, 3.3, 100, 1);
                case.settings.phase_mode = phase_mode;
                case.settings.start_window_cycles = WINDOW_CYCLES as u64;
                let cycle_ps = 1e12 / case.system_hz as f64;
                case.line.data_in.step = Some((2 * MS, (step_cycles as f64 * cycle_ps) as i64));
                let bench = case.run_alone(engine(&case), false);
                let causes: Vec<u64> = bench.results().iter().map(|r| r.last_cause()).collect();
                let refused = causes.iter().filter(|c| **c != cause::NONE).count();
                let what = format!("{kind:?} {phase_mode} {step_cycles}: {causes:?}");
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

#[test]
fn a_start_bit_outside_its_window_is_refused_in_every_mode() {
    windows(&[Kind::single(31).slower()], &[-8, -6, 6, 9]);
}

#[test]
#[ignore = "slow: odd and even bits, steps up to twice the window"]
fn a_start_bit_far_outside_its_window_is_refused_in_every_mode() {
    windows(&[31, 32].map(Kind::single), &[-12, -8, -6, -4, 4, 6, 9, 12]);
}
