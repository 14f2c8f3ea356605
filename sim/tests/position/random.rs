//! Parameters that the sweep keeps constant: jitter, distortion, cable, encoder times, filter, window.

use endat_sim::{
    campaign::{self, Case, RunOptions, Story, RATES},
    NS, US,
};
use proptest::prelude::*;

fn stories() -> impl Strategy<Value = Story> {
    let line = (0.0..100.0, 4.5..7.0, 0..60 * NS, 0..200 * NS);
    let times = (0..12 * US, 0..3 * US);
    let parts = (0.0..1.0, -1.0..1.0, 0.0..1.0, 0.0..1.0);
    let kind = (0..RATES.len(), any::<bool>(), 1..=48u32, any::<u64>());
    (kind, line, times, parts).prop_map(|(kind, line, times, parts)| Story {
        rates: kind.0,
        f2: kind.1,
        position_bits: kind.2,
        seed: kind.3,
        cable_m: line.0,
        ns_per_m: line.1,
        transceivers: line.2,
        clock_to_data: line.3,
        tcal: times.0,
        tcal_jitter: times.1,
        jitter: parts.0,
        distortion: parts.1,
        filter: parts.2,
        window: parts.3,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, max_shrink_iters: 200, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "slow: lines and encoders that differ in every run, and are shrunk"]
    fn lines_and_encoders_within_their_limits_give_good_frames(stories in prop::collection::vec(stories(), 100..256)) {
        let cases: Vec<Case> = stories.iter().map(Story::case).collect();
        let options = RunOptions { threads: 2, ..RunOptions::default() };
        let outcomes = campaign::run(&cases, options, Case::check, |_| {}).unwrap();
        for (case, outcome) in cases.iter().zip(outcomes) {
            prop_assert_eq!(outcome.verdict, Ok(()), "{:?}", case);
        }
    }
}
