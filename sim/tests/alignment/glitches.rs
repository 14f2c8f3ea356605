//! Pulses on DATA that are shorter than the filter: nowhere in a frame do they change anything.

use super::{count, run, Count, Kind};
use crate::tools::third;
use endat_sim::{
    campaign::{Case, Traces},
    line::{Glitch, Jitter, Wire},
    Time,
};
use rtl_design::engine::Compiled;

/// What a change of it tries other widths by.
const FILTER: &str = include_str!("../../../hdl/input_filter.rs");

const FILTER_CYCLES: u64 = 3;

/// A case without jitter and with a filter, and the span of its last frame.
fn quiet(kind: Kind) -> (Case, Time, Time) {
    let mut case = kind.case(0.0, 2.3, 2, 3);
    case.line.data_in.jitter = Jitter::None;
    case.settings.filter_cycles = FILTER_CYCLES;
    let engine = Compiled::new(&case.design().unwrap()).unwrap();
    let bench = case.run_alone(engine, false);
    let all = count(&case, &Traces::of(&bench), 0);
    assert_eq!(all.good, all.frames);
    let last = bench.frames(0).last().unwrap();
    (
        case,
        last.first_fall,
        last.last_rise + 2 * kind.bit() as Time,
    )
}

/// A glitch of this width at every third of a cycle of the last frame, each in a channel of its own.
fn with_glitches(kind: Kind, width: f64) -> Vec<Case> {
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
    (0..count).map(glitch).collect()
}

#[test]
fn pulses_below_the_filter_have_no_effect_at_any_phase() {
    for kind in [Kind::single(16), Kind::double(16)] {
        for &width in third(&[0.4, 1.0, 1.9, 2.9], FILTER.len()) {
            let cases = with_glitches(kind, width);
            assert!(cases.len() > 1_000 / (1 + kind.double_edge as usize));
            for (i, got) in run(&cases, 0).iter().enumerate() {
                assert_eq!(
                    (got.good, got.wrong),
                    (got.frames, 0),
                    "{kind:?} {width} {i}"
                );
            }
        }
    }
}

/// Catches a filter that counts whole cycles only: 3.4 cycles are 6 or 7 looks.
#[test]
fn half_a_cycle_of_the_filter_counts() {
    let mut cases = with_glitches(Kind::double(16), 3.4);
    let is_harmed = |c: &Count| (c.good, c.wrong) != (c.frames, 0);
    let harmed = run(&cases, 0).iter().filter(|c| is_harmed(c)).count();
    assert!(harmed > cases.len() / 100, "{harmed} of {}", cases.len());
    for case in &mut cases {
        case.settings.filter_half = true;
    }
    let harmed = run(&cases, 0).iter().filter(|c| is_harmed(c)).count();
    assert_eq!(harmed, 0);
}

/// Longer ones do harm, so the sweep above means something; they are told, but for what CRC5 cannot see.
#[test]
fn pulses_above_the_filter_are_told() {
    for kind in [Kind::single(16), Kind::double(16)] {
        for &width in third(&[5.0, 12.0, 24.0], FILTER.len()) {
            let cases = with_glitches(kind, width);
            let counts = run(&cases, 0);
            let bad: usize = counts.iter().map(|c| c.frames - c.good).sum();
            let wrong: usize = counts.iter().map(|c| c.wrong).sum();
            assert!(width < 10.0 || bad > 0, "{kind:?} {width}");
            assert!(wrong * 16 <= bad, "{kind:?} {width}: {wrong} of {bad}");
        }
    }
}
