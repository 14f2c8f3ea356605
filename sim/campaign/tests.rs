use super::*;
use rtl_design::engine::{Compiled, LaneWords};

/// A failing check returns the records of the lanes.
fn digest(traces: &Traces<'_>) -> Result<(), String> {
    Err(format!("{traces:?}"))
}

#[test]
fn a_lane_leaves_what_the_case_leaves_alone() {
    let cases = random(70, 7);
    let traced = run(&cases, RunOptions::default(), |_, t| digest(t), |_| {}).unwrap();
    for index in [0, 1, 33, 69] {
        let case = &cases[index];
        let engine = Compiled::new(&case.design().unwrap()).unwrap();
        let bench = case.run_alone(engine, false);
        let alone = Traces::of(&bench);
        assert_eq!(traced[index].verdict, digest(&alone), "case {index}");
        assert_eq!(traced[index].cycles, bench.cycle(), "case {index}");
    }
}

#[test]
fn outcomes_do_not_depend_on_threads_and_lanes() {
    let cases = random(150, 8);
    let with = |threads, lanes| {
        let options = RunOptions {
            threads,
            lanes,
            samples: true,
        };
        run(&cases, options, |_, t| digest(t), |_| {}).unwrap()
    };
    let one = with(1, LaneWords::One);
    assert!(one == with(3, LaneWords::Two));
    assert_eq!(one.len(), cases.len());
    assert!(one.iter().all(|o| o.frames == 5));
}

#[test]
fn a_broken_case_is_found_and_the_others_are_not() {
    let mut cases = random(100, 9);
    cases[42].encoder = cases[42]
        .encoder
        .clone()
        .defect(3, crate::encoder::Defect::CrcXor(1));
    let outcomes = run(&cases, RunOptions::default(), Case::check, |_| {}).unwrap();
    let failed: Vec<usize> = (0..100).filter(|i| outcomes[*i].verdict.is_err()).collect();
    assert_eq!(failed, [42]);
    let what = outcomes[42].verdict.as_ref().unwrap_err();
    assert!(
        what.starts_with("frame 3: is not what the encoder should send"),
        "{what}"
    );
}
