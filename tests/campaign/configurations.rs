//! The campaign over configurations: a small part of it, cut and put together.

use super::run;
use crate::tools;
use endat_config::parse_any;

fn has_tools() -> bool {
    let check = "campaign over configurations";
    tools::require("iverilog", check) && tools::require("verilator", check)
}

/// Catches an emission that a linter complains about: the first of five parts.
#[test]
fn a_few_random_configurations_are_clean_in_every_language() {
    if !has_tools() {
        return;
    }
    let part = ["campaign", "configurations", "--quick", "--shard", "1/5"];
    let outcome = run(&part);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    assert!(
        outcome.stdout.contains("complains about: 0 of "),
        "{outcome:?}"
    );
}

/// Catches a panic, too, and a part that draws what another one draws.
#[test]
#[ignore = "slow: random configurations in two parts, one of them with its bench"]
fn random_configurations_are_clean_in_every_language_however_they_are_cut() {
    if !has_tools() {
        return;
    }
    let folder = tools::folder("campaign_configurations");
    let file = |name: &str| folder.join(name).display().to_string();
    let quick = ["campaign", "configurations", "--quick"];
    let parts = ["1/2", "2/2"].map(|shard| {
        let out = file(&format!("{}.csv", &shard[..1]));
        let outcome = run(&[&quick[..], &["--shard", shard, "--out", &out]].concat());
        assert_eq!(outcome.exit_code, 0, "{outcome:?}");
        out
    });
    let outcome = run(&["campaign", "merge", &parts[0], &parts[1]]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    for line in [
        "complains about: 0 of 10,",
        "fail: 0 of 1,",
        "panics: 0 of 14,",
    ] {
        assert!(outcome.stdout.contains(line), "{line} {}", outcome.stdout);
    }
}

#[test]
fn one_configuration_is_shown_alone() {
    if !has_tools() {
        return;
    }
    let outcome = run(&["campaign", "configurations", "--quick", "--case", "1"]);
    assert_eq!(
        (outcome.exit_code, outcome.messages.len()),
        (0, 0),
        "{outcome:?}"
    );
    assert!(
        parse_any("case.toml", &outcome.stdout).is_ok(),
        "{outcome:?}"
    );
    for (arguments, told) in [
        (["--case", "14"], "--case = 14: outside 0..13"),
        (
            ["--subject", "port"],
            "campaign configurations: --subject: is only of upsets, faults, garbage; leave it out",
        ),
    ] {
        let outcome = run(&[&["campaign", "configurations", "--quick"], &arguments[..]].concat());
        assert_eq!(outcome.exit_code, 2);
        assert!(outcome.messages[0].contains(told), "{outcome:?}");
    }
}
