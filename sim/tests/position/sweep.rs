//! Every width, command, rate and cable; and thousands of random lines and encoders.

use endat_sim::campaign::{self, Case, RunOptions};

/// All cases must be fault-free; the first few failing ones are printed.
fn all_sound(cases: &[Case]) {
    let options = RunOptions {
        threads: 2,
        ..RunOptions::default()
    };
    let outcomes = campaign::run(cases, options, Case::check, |_| {}).unwrap();
    assert_eq!(outcomes.len(), cases.len());
    let failed = cases.iter().zip(&outcomes);
    let failed = failed.filter_map(|(case, o)| o.verdict.as_ref().err().map(|f| (&case.title, f)));
    let failed: Vec<_> = failed.collect();
    assert!(
        failed.is_empty(),
        "{} of {} cases: {:#?}",
        failed.len(),
        cases.len(),
        &failed[..failed.len().min(3)]
    );
    let wanted: usize = cases.iter().map(|c| c.frames).sum();
    let checked: usize = outcomes.iter().map(|o| o.frames).sum();
    assert_eq!(checked, wanted);
}

/// 10 rates, 4 cables, 2 commands, the narrowest and the widest position; the first frame measures the delay, the second runs at the
/// full clock.
#[test]
fn narrow_and_wide_positions_are_sound_at_every_rate_and_cable() {
    let mut cases = campaign::sweep();
    cases.retain(|case| [1, 48].contains(&case.settings.position_bits));
    assert_eq!(cases.len(), 10 * 4 * 2 * 2);
    all_sound(&cases);
}

#[test]
#[ignore = "slow: all 48 widths"]
fn every_width_rate_cable() {
    let cases = campaign::sweep();
    assert_eq!(cases.len(), 10 * 4 * 2 * 48);
    all_sound(&cases);
}

/// Also the quick variant of `random::lines_and_encoders_within_their_limits_give_good_frames`.
#[test]
fn random_lines_and_encoders() {
    all_sound(&campaign::random(120, 1));
}

#[test]
#[ignore = "slow: three thousand of them"]
fn random_lines_and_encoders_by_the_thousand() {
    all_sound(&campaign::random(3000, 1));
}
