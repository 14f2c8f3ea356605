//! `explain`: its own report can be looked up.

use crate::bases::BASES;
use crate::program::{good, run, Dir};
use endat_config::{PRESETS, RECEIVER_PRESETS};
use std::collections::BTreeSet;

/// Words at the left of a report, and those above a table.
fn heads(report: &str) -> BTreeSet<String> {
    let is_receiver = report.contains(" receiver, configuration ");
    let width = if is_receiver { 15 } else { 18 };
    let mut heads = BTreeSet::new();
    // The first line has the name.
    for line in report.lines().skip(1) {
        if line.starts_with("request  ") {
            heads.extend(line.split("  ").map(|head| head.trim().to_owned()));
            // Numbers follow.
            break;
        }
        let sentence = line
            .split_once(": ")
            .filter(|(head, _)| !head.contains(' '));
        let column = line.get(..width).filter(|head| !head.contains(" is the"));
        let head = sentence.map(|(head, _)| head).or(column);
        heads.extend(head.map(|head| head.trim().to_owned()));
    }
    heads.remove("");
    heads
}

/// Catches a row of the report that nobody can look up.
#[test]
fn explain_knows_the_words_that_it_prints() {
    let dir = Dir::new("explain-words");
    let preset = |(name, _): &(&str, _)| good(&["explain", "--preset", name]);
    let base = |text: &&str| {
        good(&[
            "explain",
            "--config",
            &dir.write("card.toml", text.as_bytes()),
        ])
    };
    let presets = PRESETS.iter().chain(RECEIVER_PRESETS).map(preset);
    let mut all = BTreeSet::new();
    for report in presets.chain(BASES.iter().map(base)) {
        let found = heads(&report);
        assert!(found.len() > 6, "{report}");
        all.extend(found);
    }
    // Each part of a report has brought some.
    for head in [
        "host link",
        "host bus",
        "turns of port 0",
        "of channel 1",
        "safety",
        "bits before",
        "pauses",
        "reply",
        "on the line",
    ] {
        assert!(all.contains(head), "{head}: {all:?}");
    }
    let others = ["tD", "tm", "tST", "supplement"].map(str::to_owned);
    for head in all.into_iter().chain(others) {
        let told = run(&["explain", &head]);
        assert_eq!(told.exit_code, 0, "{head}: {told:?}");
    }
    let told = good(&["explain", "tD"]);
    assert!(told.contains("propagation delay"), "{told}");
    // A number that is part of the word.
    let told = good(&["explain", "position 2"]);
    assert!(
        told.contains("a second position") && !told.contains("its code"),
        "{told}"
    );
}

/// Catches a list of everything in the place of a guess.
#[test]
fn explain_suggests_for_a_misspelt_name() {
    let told = run(&["explain", "recoverry time"]);
    assert_eq!(told.exit_code, 2);
    assert!(
        told.messages[0].contains("did you mean recovery time"),
        "{told:?}"
    );
    let told = run(&["explain", "bogus"]);
    assert!(told.messages[0].len() < 250, "{told:?}");
}
