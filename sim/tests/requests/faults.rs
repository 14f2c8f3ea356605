//! Every kind of fault at every place of a frame with additional data 1 and 2 and a supplement.

use super::lanes::*;
use crate::position::rig::believes;
use endat_hdl::endat::{
    timing::{PROBE_US, SETTLE_US},
    transaction::cause,
};
use endat_sim::{
    campaign::ABORT_US,
    encoder::{Defect, EncoderConfig},
    line::{Glitch, LineConfig, Wire},
    Time, NS, US,
};

/// Bits of the answer: start bit, F1, F2, position, CRC; additional data 1 and 2.
const POSITION_ANSWER: u32 = 3 + POSITION_BITS + 5;
const ANSWER: u32 = POSITION_ANSWER + 60;
/// Clock pulses of the frame.
const PULSES: u32 = 10 + ANSWER + 35;
/// The longest frame, twice the limit of the start bit, the longest recovery time, the pause of an aborted frame, a look at an open line.
const LIMIT_US: u64 = 80 + 2 * 50 + 35 + ABORT_US + PROBE_US + SETTLE_US;
/// Triggers after a fault until two in a row are good: one measures the delay, two resynchronise the additional data.
const TRIGGERS: usize = 3;

struct Fault {
    what: String,
    encoder: EncoderConfig,
    line: LineConfig,
    /// Duration after the frame.
    lasts: Time,
}

fn defect(defect: Defect) -> Fault {
    Fault {
        what: format!("{defect:?}"),
        encoder: encoder().defect(FRAME, defect),
        line: line(),
        lasts: 0,
    }
}

/// Half clock periods from the first falling edge to the end of the recovery time.
fn places() -> impl Iterator<Item = Time> {
    (0..)
        .map(|i| i * HALF_PERIOD)
        .take_while(|t| *t < FRAME_TIME + RECOVERY)
}

/// Step of the quick tests, in places.
const SOME: usize = 9;

/// Every `step`th of the faults, with the minimum numbers of good and bad results for all.
fn run_some(faults: Vec<Fault>, step: usize, [good_min, bad_min]: [usize; 2]) {
    let some: Vec<Fault> = faults.into_iter().step_by(step).collect();
    let [good, bad, _] = run(&some);
    assert!(
        good * step >= good_min && bad * step >= bad_min,
        "{good} {bad}"
    );
}

/// Runs the frame with its fault, then triggers until everything is good again. Returns good and bad results, and wrong ones with a right CRC.
fn run(faults: &[Fault]) -> [usize; 3] {
    let mut counts = [0; 3];
    for faults in faults.chunks(LANES) {
        let cases: Vec<_> = faults
            .iter()
            .map(|f| (f.encoder.clone(), f.line.clone()))
            .collect();
        let mut rig = Rig::new(&cases);
        let what = |lane: usize| faults[lane].what.clone();
        let before: Vec<_> = (0..rig.used)
            .map(|lane| rig.bench.results(lane).len())
            .collect();
        let triggered = rig.bench.now();
        rig.trigger();
        let busy = rig.idle(LIMIT_US);
        assert!(busy.is_empty(), "busy: {}", what(busy[0]));
        rig.run_for(30 * US + faults.iter().map(|f| f.lasts).max().unwrap_or(0));
        // A disturbed line may have made the channel leave its idle state again.
        rig.settle(LIMIT_US);
        rig.bench.finish_samples();
        for (lane, before) in before.iter().enumerate() {
            let results = &rig.bench.results(lane)[*before..];
            assert_eq!(results.len(), 1, "results of a trigger: {}", what(lane));
            let result = &results[0];
            let frame = &rig.bench.link(0, lane).encoder().frames()[FRAME as usize];
            let taken = triggered..=result.time;
            let samples = rig.bench.samples(0, lane).iter();
            let levels: Vec<bool> = samples
                .filter(|s| taken.contains(&s.time))
                .map(|s| s.level)
                .collect();
            let believed = believes(&levels, POSITION_ANSWER, true, false);
            assert_eq!(
                result.fresh,
                believed,
                "{} {result:?} {levels:?}",
                what(lane)
            );
            assert!(
                result.fresh || result.cause != cause::NONE,
                "{}",
                what(lane)
            );
            let right = result.position == frame.position;
            counts[if !result.fresh {
                1
            } else if right {
                0
            } else {
                2
            }] += 1;
        }
        let (lost, _) = rig.recovered(TRIGGERS, &what);
        assert!(lost.is_empty(), "{lost:?}");
    }
    println!(
        "{} faults: {counts:?} good, bad, wrong with a right CRC",
        faults.len()
    );
    // A CRC5 lets 1 of 32 pass.
    assert!(counts[2] * 32 <= counts[1] + 32, "{counts:?}");
    counts
}

fn stuck_or_open(step: usize) {
    let stuck = |level| move |bit| defect(Defect::StuckFrom { bit, level });
    let faults: Vec<Fault> = (0..=ANSWER)
        .flat_map(|bit| {
            [
                stuck(false)(bit),
                stuck(true)(bit),
                defect(Defect::OpenFrom(bit)),
            ]
        })
        .collect();
    // A fault after the position does not affect it.
    run_some(faults, step, [3 * 60, 41]);
}

#[test]
fn channel_recovers_from_a_stuck_or_open_line() {
    stuck_or_open(4);
}

#[test]
#[ignore = "slow: every bit"]
fn a_line_stuck_or_open_from_any_bit_on() {
    stuck_or_open(1);
}

fn lost(step: usize) {
    let lost = |after, length| {
        let mut fault = defect(Defect::BrownOut { after, length });
        fault.lasts = length;
        fault
    };
    let faults: Vec<Fault> = [3 * US, 40 * US, 300 * US]
        .into_iter()
        .flat_map(|length| places().map(move |after| lost(after, length)))
        .collect();
    run_some(faults, step, [301, 151]);
}

#[test]
fn channel_recovers_from_a_lost_encoder() {
    lost(SOME);
}

#[test]
#[ignore = "slow: every half clock period"]
fn an_encoder_lost_at_any_half_clock_period() {
    lost(1);
}

fn glitches(step: usize) {
    let mut faults = vec![];
    for (wire, widths) in [
        (Wire::Data, [125 * NS, 500 * NS, 5 * US, 30 * US]),
        (Wire::Clock, [30 * NS, 125 * NS, 500 * NS, 5 * US]),
    ] {
        for width in widths {
            for after in places() {
                let at = Rig::trigger_time() + after + 10 * NS;
                let glitch = Glitch { wire, at, width };
                faults.push(Fault {
                    what: format!("{glitch:?}"),
                    encoder: encoder(),
                    line: LineConfig {
                        glitches: vec![glitch],
                        ..line()
                    },
                    lasts: 0,
                });
            }
        }
    }
    run_some(faults, step, [501, 201]);
}

#[test]
fn channel_recovers_from_a_glitch_on_either_wire() {
    glitches(2 * SOME + 1);
}

#[test]
#[ignore = "slow: every half clock period"]
fn a_glitch_on_either_wire_at_any_half_clock_period() {
    glitches(1);
}

fn missed_or_doubled(step: usize) {
    let faults: Vec<Fault> = (1..=PULSES)
        .flat_map(|n| [defect(Defect::MissEdge(n)), defect(Defect::DoubleEdge(n))])
        .collect();
    run_some(faults, step, [0, 0]);
}

#[test]
fn channel_recovers_from_missed_and_doubled_clock_pulses() {
    missed_or_doubled(3);
}

#[test]
#[ignore = "slow: every pulse"]
fn clock_pulses_that_the_encoder_misses_or_sees_twice() {
    missed_or_doubled(1);
}

fn wrong_answers(step: usize) {
    let mut faults: Vec<Fault> = (0..ANSWER)
        .map(|bit| defect(Defect::FlipBits(1 << bit)))
        .collect();
    let glitch = |after| Defect::Glitch {
        after,
        width: HALF_PERIOD,
    };
    faults.extend(places().map(|after| defect(glitch(after))));
    for xor in 1..32 {
        faults.push(defect(Defect::CrcXor(xor)));
        faults.extend([1, 2].map(|info| defect(Defect::InfoCrcXor { info, xor })));
    }
    for (f1, f2) in [(true, true), (false, false), (true, false)] {
        faults.push(defect(Defect::ErrorBits { f1, f2 }));
    }
    faults.extend(
        (-12..=12)
            .filter(|n| *n != 0)
            .map(|n| defect(Defect::WiderBy(n))),
    );
    faults.push(defect(Defect::WithoutF2));
    run_some(faults, step, [151, 81]);
}

#[test]
fn channel_recovers_from_wrong_answers() {
    wrong_answers(5);
}

#[test]
#[ignore = "slow: every bit, every wrong CRC, every half clock period"]
fn an_encoder_that_is_wrong_in_what_it_sends() {
    wrong_answers(1);
}

fn silent_early_or_late(step: usize) {
    let mut faults = vec![defect(Defect::NoStartBit), defect(Defect::Open)];
    faults.extend((1..40).map(|edge| defect(Defect::StartAtEdge(edge))));
    faults.extend((1..240).map(|i| defect(Defect::LateStart(i * HALF_PERIOD))));
    for length in (1..160).map(|i| i * HALF_PERIOD) {
        for mut late in [Defect::LateFall(length), Defect::HighWhenIdle(length)].map(defect) {
            late.lasts = length;
            faults.push(late);
        }
    }
    run_some(faults, step, [401, 21]);
}

#[test]
fn channel_recovers_from_a_silent_or_late_encoder() {
    silent_early_or_late(5);
}

#[test]
#[ignore = "slow: every clock edge, every half clock period"]
fn an_encoder_that_is_silent_early_or_late() {
    silent_early_or_late(1);
}
