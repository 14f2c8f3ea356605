//! `bench cycle-time`: the core at the protocol's limit.

use crate::program::{bad, good, run};

#[test]
fn the_limits_of_cycle_time_are_said() {
    for (option, text, wanted) in [
        ("--bits", "0", "outside 1..48"),
        ("--bits", "x", "is not a number from 1 to 48"),
        ("--cable-m", "151", "outside 0..150"),
        ("--cable-m", "-1", "outside 0..150"),
        ("--cable-m", "1.5", "is not a number from 0 to 150"),
        ("--tcal-ns", "100001", "outside 0..100000"),
        ("--tm-ns", "1249", "outside 1250..30000"),
        ("--tm-ns", "30001", "outside 1250..30000"),
    ] {
        let message = bad(&["bench", "cycle-time", option, text], 2);
        let wanted = format!("{option} = {text}: {wanted}");
        assert!(message.starts_with(&wanted), "{message}");
    }
}

/// Pulses and microseconds of the frames as they follow from the interface description.
#[test]
fn cycle_time_measures_the_shortest_frames_that_there_are() {
    let text = good(&["bench", "cycle-time", "--json", "--tm-ns", "1250"]);
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2 * (4 + 10) + 4);
    for (command, bits, clock_hz, pulses, frame_us, tm_us) in [
        ("000111", 25, 100_000, 43, 425.0, 10.0),
        ("000111", 37, 2_000_000, 55, 27.25, 10.0),
        ("000111", 36, 2_000_000, 54, 26.75, 10.0),
        ("111000", 25, 200_000, 44, 217.5, 10.0),
        ("111000", 25, 1_000_000, 44, 45.0, 10.0),
        ("111000", 37, 2_000_000, 56, 29.5, 1.25),
        ("111000", 29, 3_125_000, 48, 17.04, 1.25),
        ("111000", 25, 4_000_000, 46, 13.25, 1.25),
        ("111000", 37, 8_000_000, 70, 10.625, 1.25),
        ("111000", 37, 10_000_000, 76, 9.5, 1.25),
        ("111000", 37, 12_500_000, 84, 8.64, 1.25),
        ("111000", 25, 16_000_000, 82, 7.0625, 1.25),
    ] {
        let is_it = |row: &&serde_json::Value| {
            row["command"] == command && row["position_bits"] == bits && row["clock_hz"] == clock_hz
        };
        let row = rows.iter().find(is_it).unwrap();
        assert_eq!(row["pulses"], pulses, "{row}");
        assert_eq!(row["tm_us"], tm_us, "{row}");
        let near = |key: &str, us: f64| (row[key].as_f64().unwrap() - us).abs() < 1e-5;
        assert!(near("frame_us", frame_us), "{row}");
        assert!(near("cycle_limit_us", frame_us + tm_us + 0.5), "{row}");
    }
    for row in rows {
        let figure = |key: &str| row[key].as_f64().unwrap();
        let over = figure("cycle_us") - figure("cycle_limit_us");
        assert!((0.0..0.2).contains(&over), "{row}");
        assert!((figure("cycles_per_s") * figure("cycle_us") - 1e6).abs() < 1e-3);
        assert!(row["failure"].is_null());
    }
    let mut count = 0;
    for row in rows.iter().filter(|row| !row["published"].is_null()) {
        count += 1;
        let theirs = row["published"]["us"].as_f64().unwrap();
        let ours = match row["published"]["is_frame"].as_bool().unwrap() {
            true => row["frame_us"].as_f64().unwrap(),
            false => row["cycle_us"].as_f64().unwrap(),
        };
        assert!(ours < theirs, "{row}");
    }
    assert_eq!(count, 4);
}

#[test]
fn cycle_time_holds_behind_a_long_cable_and_marks_what_does_not() {
    good(&["bench", "cycle-time", "--cable-m", "100"]);
    let outcome = run(&["bench", "cycle-time", "--cable-m", "100", "--bits", "1"]);
    assert_eq!((outcome.exit_code, outcome.messages.len()), (1, 0));
    assert!(outcome.stdout.contains("^ WRONG: "), "{}", outcome.stdout);
}

#[test]
fn the_cycle_times_in_the_documentation_are_those_of_the_program() {
    let page = include_str!("../docs/simulation.md");
    let text = good(&["bench", "cycle-time", "--json", "--tm-ns", "1250"]);
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    for row in report["rows"].as_array().unwrap() {
        let figure = |key: &str| row[key].as_f64().unwrap();
        let wanted = format!(
            "| {} | {} | {} | {} | {:.2} | {} | {:.2} | {:.2} | {:.0} |",
            row["command"].as_str().unwrap(),
            row["position_bits"],
            figure("clock_hz") / 1e6,
            row["pulses"],
            figure("frame_us"),
            figure("tm_us"),
            figure("cycle_us"),
            figure("cycle_limit_us"),
            figure("cycles_per_s"),
        );
        let is_usual = [25, 37].map(Into::into).contains(&row["position_bits"]);
        let is_there = page.lines().any(|line| line == wanted);
        assert!(!is_usual || is_there, "{wanted}");
    }
}
