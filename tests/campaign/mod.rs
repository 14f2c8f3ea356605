//! The campaigns of the command line.

mod configurations;
mod counted;
mod mutants;
mod results;
mod schedulers;

use endat_sim::campaign;
use endat_sim::encoder::Defect;
use rtl_design::engine::Compiled;
use serde_json::Value;

fn run(arguments: &[&str]) -> endat_terminal::outcome::Outcome {
    crate::program::run(arguments)
}

#[test]
fn a_random_campaign_is_clean_and_says_how_much_it_did() {
    let outcome = run(&[
        "campaign", "random", "--cases", "300", "--seed", "4", "--json",
    ]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let report: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(report["cases"], 300);
    assert_eq!(report["frames"], 300 * 5);
    assert_eq!(report["failures"], Value::Array(vec![]));
    assert!(report["cycles"].as_u64().unwrap() > 1_000_000);
}

/// The line that is printed for a failing case runs that very case again.
#[test]
fn one_case_is_the_same_alone() {
    let folder = crate::tools::folder("campaign");
    let (vcd, svg) = (folder.join("case.vcd"), folder.join("case.svg"));
    let outcome = run(&[
        "campaign",
        "random",
        "--cases",
        "300",
        "--seed",
        "4",
        "--case",
        "217",
        "--vcd",
        vcd.to_str().unwrap(),
        "--svg",
        svg.to_str().unwrap(),
    ]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let case = &campaign::random(300, 4)[217];
    assert_eq!(outcome.stdout, format!("case 217 ({}): good\n", case.title));
    assert!(std::fs::read_to_string(vcd)
        .unwrap()
        .contains("$enddefinitions"));
    assert!(std::fs::read_to_string(svg).unwrap().starts_with("<svg"));
}

#[test]
fn what_is_wrong_with_a_case_is_said_alike_alone_and_in_lanes() {
    let mut cases = campaign::random(3, 4);
    cases[1].encoder = cases[1].encoder.clone().defect(2, Defect::NoStartBit);
    let outcomes =
        campaign::run(&cases, Default::default(), campaign::Case::check, |_| {}).unwrap();
    let case = &cases[1];
    let bench = case.run_alone(Compiled::new(&case.design().unwrap()).unwrap(), false);
    let traces = campaign::Traces::of(&bench);
    assert!(outcomes[1].verdict.is_err());
    assert_eq!(outcomes[1].verdict, case.check(&traces));
}

#[test]
fn bad_arguments_are_refused_with_their_limits() {
    for (arguments, text) in [
        (["--cases", "0"], "--cases = 0: outside 1..1000000"),
        (["--case", "20000"], "--case = 20000: outside 0..9999"),
        (["--threads", "-1"], "--threads = -1: outside 1..1024"),
        (["--seed", "x"], "--seed = x: is not a number"),
    ] {
        let outcome = run(&["campaign", "random", arguments[0], arguments[1]]);
        assert_eq!(outcome.exit_code, 2);
        assert!(
            outcome.messages.iter().any(|m| m.contains(text)),
            "{outcome:?}"
        );
    }
}
