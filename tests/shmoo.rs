//! Maps from the command line.

use crate::program::{bad, good, run};
use crate::tools;
use serde_json::Value;

#[test]
fn a_map_is_drawn_written_and_told() {
    let folder = tools::folder("shmoo");
    let (svg, csv) = (folder.join("map.svg"), folder.join("map.csv"));
    let outcome = run(&[
        "shmoo",
        "--x",
        "jitter_ns=0,40,150",
        "--y",
        "clock_mhz=4,8",
        "--at",
        "cable_m=100",
        "--frames",
        "8",
        "--runs",
        "1",
        "--svg",
        svg.to_str().unwrap(),
        "--csv",
        csv.to_str().unwrap(),
    ]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    // The first line of cells is the fastest clock; at 150 ns nothing is left of either bit.
    let rows: Vec<&str> = outcome.stdout.lines().skip(1).take(2).collect();
    assert!(rows[0].starts_with("8 |") && rows[1].starts_with("4 |"));
    let digit = |row: &str, place: usize| row[3 + place..].chars().next().unwrap().to_digit(10);
    for row in rows {
        assert!(digit(row, 0) >= Some(4), "{row}");
        assert!(
            digit(row, 1).is_some() && digit(row, 1) < digit(row, 0),
            "{row}"
        );
        assert_eq!(digit(row, 2), None, "{row}");
    }
    let table = std::fs::read_to_string(&csv).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 7);
    assert!(lines[0].starts_with("jitter_ns,clock_mhz,fate,frames,good,margin_percent,"));
    assert!(lines[1].starts_with("0,4,good,8,8,4"), "{}", lines[1]);
    assert!(lines[6].starts_with("150,8,") && !lines[6].contains("good"));
    let drawing = std::fs::read_to_string(&svg).unwrap();
    assert_eq!(
        drawing.matches("<rect class=\"m").count(),
        4 + 8,
        "cells and legend"
    );
    // A second time: the program's own files are replaced, others are not.
    let again = ["shmoo", "--x", "cable_m=0,5", "--y", "clock_mhz=4,8"];
    let with = |flag, file: &std::path::Path| {
        let file = file.to_str().unwrap().to_owned();
        run(&[&again[..], &["--runs", "1", flag, file.as_str()]].concat())
    };
    assert_eq!(with("--csv", &csv).exit_code, 0);
    let notes = folder.join("notes.csv");
    std::fs::write(&notes, "a,b,c\n1,2,3\n").unwrap();
    let refused = with("--csv", &notes);
    assert_eq!(refused.exit_code, 2);
    assert!(
        refused.messages[0].contains("holds something else"),
        "{refused:?}"
    );
    assert_eq!(std::fs::read_to_string(&notes).unwrap(), "a,b,c\n1,2,3\n");
    let refused = with("--svg", &folder);
    assert!(
        refused.messages[0].contains("is a folder, not a file"),
        "{refused:?}"
    );
}

#[test]
fn every_cable_and_clock_of_the_usual_map_is_good() {
    let map: Value = serde_json::from_str(&good(&["shmoo", "--runs", "1", "--json"])).unwrap();
    let cells = map["cells"].as_array().unwrap();
    assert_eq!(cells.len(), 31 * 13);
    assert_eq!(map["passed"], cells.len());
    // 8 cycles to a bit: a cycle and a half from its middle at most.
    for cell in cells {
        let margin = cell["margin"].as_f64().unwrap();
        assert!(margin > 0.5 - 1.5 / 8.0 && margin <= 0.5, "{margin}");
    }
}

#[test]
fn wrong_axes_are_told_with_their_limits() {
    for (arguments, wanted) in [
        (
            vec!["--x", "nope=1:2:1"],
            "--x = nope=1:2:1: begins with no quantity, as there are cable_m, clock_mhz",
        ),
        (
            vec!["--x", "cable_m"],
            "--x = cable_m: has no value; write, for example, cable_m=0:100:10",
        ),
        (
            vec!["--x", "cable_m=5"],
            "--x = cable_m=5: has one value; give at least two",
        ),
        (
            vec!["--x", "cable_m=5,1"],
            "--x = cable_m=5,1: does not go up",
        ),
        (
            vec!["--x", "cable_m=0:10:0"],
            "--x = cable_m=0:10:0: FROM:TO:STEP goes up",
        ),
        (
            vec!["--x", "cable_m=0:10"],
            "--x = cable_m=0:10: is neither FROM:TO:STEP nor a list",
        ),
        (
            vec!["--x", "cable_m=0:400:0.001"],
            "--x = cable_m=0:400:0.001: has more than 200 values",
        ),
        (
            vec!["--x", "cable_m=0,nan"],
            "--x = cable_m=0,nan: cable_m = nan is outside 0..800",
        ),
        (
            vec!["--x", "cable_m=0,abc"],
            "--x = cable_m=0,abc: abc is not a number",
        ),
        (
            vec!["--y", "clock_mhz=1,17"],
            "--y = clock_mhz=1,17: clock_mhz = 17 is outside 0.0625..16",
        ),
        (
            vec!["--at", "filter_cycles=16"],
            "--at = filter_cycles=16: filter_cycles = 16 is outside 0..15",
        ),
        (
            vec!["--y", "cable_m=1,2"],
            "--y = cable_m: is what --x has as well",
        ),
        (
            vec!["--runs", "1000"],
            "--runs = 1000: 403000 channels in all cells together, at most 100000",
        ),
        (
            vec!["--at", "offset_percent=10"],
            "--at = offset_percent=10: moves the sample, which only a phase from a register allows",
        ),
        (
            vec!["--x", "offset_percent=0,10", "--phase", "frame"],
            "--x = offset_percent=0,10: moves the sample",
        ),
        (
            vec!["--phase", "step", "--majority"],
            "--phase = step: a channel without alignment has no --majority",
        ),
        (vec!["--bits", "49"], "--bits = 49: outside 1..48"),
        (
            vec!["--system-hz", "1"],
            "--system-hz = 1: outside 1000000..250000000",
        ),
    ] {
        let message = bad(&[&["shmoo"], &arguments[..]].concat(), 2);
        assert!(message.starts_with(wanted), "{message}\n{wanted}");
    }
}

#[test]
fn eye_takes_no_phase_but_that_of_the_register() {
    let message = bad(&["eye", "--phase", "tracked"], 2);
    assert!(
        message.starts_with("--phase = tracked: eye moves the sample"),
        "{message}"
    );
}

/// The map of these axes with these options.
fn map(x: &str, y: &str, frames: &str, more: &[&str]) -> Value {
    let map = ["shmoo", "--x", x, "--y", y, "--frames", frames, "--json"];
    serde_json::from_str(&good(&[&map[..], more].concat())).unwrap()
}

/// Four to seven cycles in a bit.
const COARSE: [&str; 4] = ["--at", "cable_m=50", "--system-hz", "64000000"];
const COARSE_CLOCKS: &str = "clock_mhz=9.14,10.667,12.8,16";
const NOISE: [&str; 2] = ["--at", "noise_khz=3"];

/// Catches an option that is read and then forgotten: each changes the map.
#[test]
fn phase_double_edge_and_majority_reach_the_receiver() {
    let coarse = |more: &[&str]| {
        let more = [&COARSE, more].concat();
        map("jitter_ns=14:30:8", COARSE_CLOCKS, "20", &more)
    };
    let passed = |map: &Value| map["passed"].as_u64().unwrap();
    let tracked = coarse(&[]);
    // The start bit's own jitter comes on top of that of each bit.
    assert!(passed(&coarse(&["--phase", "frame"])) < passed(&tracked));
    assert_ne!(coarse(&["--double-edge"])["cells"], tracked["cells"]);
    let noisy = |more: &[&str]| {
        let more = [&NOISE, more].concat();
        map("jitter_ns=0:10:5", "clock_mhz=4,8", "20", &more)
    };
    assert_ne!(noisy(&["--majority"])["cells"], noisy(&[])["cells"]);
}

/// Catches an option that does the wrong thing: each changes what one row of jitters comes to.
#[test]
#[ignore = "slow: options of the receiver on fine maps"]
fn phase_double_edge_and_majority_change_what_the_receiver_tolerates() {
    let passed = |x: &str, y: &str, more: &[&str]| {
        let map = map(x, y, "40", more);
        map["passed"].as_u64().unwrap()
    };
    let coarse = |more: &[&str]| {
        let more = [&COARSE, more].concat();
        passed("jitter_ns=14:30:1", COARSE_CLOCKS, &more)
    };
    let tracked = coarse(&[]);
    assert_eq!(coarse(&["--phase", "tracked"]), tracked);
    // The start bit's own jitter comes on top of that of each bit.
    assert!(coarse(&["--phase", "frame"]) < tracked);
    assert!(coarse(&["--double-edge"]) > tracked);
    // Single samples that a glitch has changed are outvoted.
    let noisy = |more: &[&str]| {
        let more = [&NOISE, more].concat();
        passed("jitter_ns=0:10:0.25", "clock_mhz=4,8", &more)
    };
    assert!(noisy(&["--majority"]) > noisy(&[]));
}
