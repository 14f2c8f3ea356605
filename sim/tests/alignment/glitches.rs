//! Pulses on DATA shorter than the filter have no effect anywhere in a frame.

use super::{count, engine, run, Count, Kind};
use endat_sim::{
    campaign::{Case, Traces},
    line::{Glitch, Jitter, Wire},
    Time,
};

const FILTER_CYCLES: u64 = 3;

/// A case without jitter and with a filter, and the span of its last frame.
fn quiet(kind: Kind) -> (Case, Time, Time) {
    let mut case = kind.case(0.0, 2.3, 2, 3);
    case.line.data_in.jitter = Jitter::None;
    case.settings.filter_cycles = FILTER_CYCLES;
    let bench = case.run_alone(engine(&case), false);
    let all = count(&case, &Traces::of(&bench), 0);
    assert_eq!(all.good, all.frames);
    let last = bench.frames(0).last().unwrap();
    (
        case,
        last.first_fall,
        last.last_rise + 2 * kind.bit() as Time,
    )
}

/// A glitch of this width at every third of a cycle of the last frame, each in a separate channel; every `step`th of them.
fn with_glitches(kind: Kind, width: f64, step: usize) -> Vec<Case> {
    let (case, from, until) = quiet(kind);
    let cycle = 1e12 / case.system_hz as f64;
    let count = ((until - from) as f64 / cycle * 3.0) as u64;
    let glitch = |i: u64| {
        let mut case = case.clone();
        case.line.glitches = vec![Glitch {
            wire: Wire::Data,
            at: from + (i as f64 * cycle / 3.0) as Time,
            width: (width * cycle) as Time,
        }];
        case
    };
    (0..count).step_by(step).map(glitch).collect()
}

/// Both inputs.
const KINDS: [Kind; 2] = [Kind::single(16), Kind::double(16)];

/// Step of the quick tests: every third of a cycle occurs, at other places of a bit.
const SOME: usize = 59;

/// Runs glitches of these widths in parallel. Returns a result for each width.
fn of_widths(kind: Kind, widths: &[f64], step: usize) -> Vec<Vec<Count>> {
    let cases: Vec<Vec<Case>> = (widths.iter())
        .map(|width| with_glitches(kind, *width, step))
        .collect();
    let mut counts = run(&cases.concat(), 0).into_iter();
    let of = |cases: &Vec<Case>| counts.by_ref().take(cases.len()).collect();
    cases.iter().map(of).collect()
}

fn is_harmed(count: &Count) -> bool {
    (count.good, count.wrong) != (count.frames, 0)
}

/// Pulses with widths below and above the filter, in cycles.
fn filter(kinds: &[Kind], step: usize) {
    const BELOW: [f64; 4] = [0.4, 1.0, 1.9, 2.9];
    const ABOVE: [f64; 3] = [5.0, 12.0, 24.0];
    for &kind in kinds {
        let counts = of_widths(kind, &[&BELOW[..], &ABOVE[..]].concat(), step);
        let (below, above) = counts.split_at(BELOW.len());
        for (width, counts) in BELOW.iter().zip(below) {
            assert!(counts.len() > 1_000 / (1 + kind.double_edge as usize) / step);
            let harmed = counts.iter().position(is_harmed);
            assert_eq!(harmed, None, "{kind:?} {width}");
        }
        // Longer pulses do harm, which validates the sweep above. They are reported, except those that CRC5 cannot detect.
        for (width, counts) in ABOVE.iter().zip(above) {
            let bad: usize = counts.iter().map(|c| c.frames - c.good).sum();
            let wrong: usize = counts.iter().map(|c| c.wrong).sum();
            assert!(*width < 10.0 || bad > 0, "{kind:?} {width}");
            assert!(wrong * 16 <= bad, "{kind:?} {width}: {wrong} of {bad}");
        }
    }
}

#[test]
fn pulses_below_the_filter_have_no_effect_and_longer_ones_are_reported() {
    filter(&[KINDS[0].slower(), KINDS[1].slower()], SOME);
}

#[test]
#[ignore = "slow: pulses at every third of a cycle of a frame, one edge"]
fn pulses_are_filtered_at_any_phase_on_one_edge() {
    filter(&KINDS[..1], 1);
}

#[test]
#[ignore = "slow: pulses at every third of a cycle of a frame, both edges"]
fn pulses_are_filtered_at_any_phase_on_both_edges() {
    filter(&KINDS[1..], 1);
}

/// Catches a filter that counts whole cycles only: 3.4 cycles are 6 or 7 samples.
fn half_a_cycle_counts(kind: Kind, step: usize) {
    let cases = with_glitches(kind, 3.4, step);
    let mut both = cases.clone();
    both.extend(cases.iter().cloned().map(|mut case| {
        case.settings.filter_half = true;
        case
    }));
    let counts = run(&both, 0);
    let (without, with) = counts.split_at(cases.len());
    let harmed = |counts: &[Count]| counts.iter().filter(|c| is_harmed(c)).count();
    let count = harmed(without);
    assert!(count > cases.len() / 100, "{count} of {}", cases.len());
    assert_eq!(harmed(with), 0);
}

#[test]
fn half_a_cycle_of_the_filter_counts() {
    half_a_cycle_counts(KINDS[1].slower(), 11);
}

#[test]
#[ignore = "slow: pulses at every third of a cycle of a frame"]
fn half_a_cycle_of_the_filter_counts_at_any_phase() {
    half_a_cycle_counts(KINDS[1], 1);
}
