//! `bench cycle-time`: the core at the protocol's limit.

use crate::program::{bad, good, run};

#[test]
fn the_limits_of_cycle_time_are_said() {
    for (option, text, wanted) in [
        ("--bits", "0", "outside 1..48"),
        ("--bits", "x", "is not a number from 1 to 48"),
        ("--cable-m", "781", "outside 0..780"),
        ("--cable-m", "-1", "outside 0..780"),
        ("--cable-m", "1.5", "is not a number from 0 to 780"),
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
    assert_eq!(rows.len(), 2 * (4 + 10) + 4 + 4 * 3);
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
            let keys = ["command", "infos", "position_bits", "clock_hz"].map(|key| &row[key]);
            keys[0] == command && keys[1] == 0 && keys[2] == bits && keys[3] == clock_hz
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
        let has_supplement = row["command"] == "101101";
        assert!(
            (0.0..0.2).contains(&over) || (has_supplement && over < 0.3),
            "{row}"
        );
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

/// 25 bits; pulses and microseconds as they follow from the interface description. How long the clock is parked before a supplement is
/// the receiver's own choice: the answer has come in, and then 2 us.
#[test]
fn cycle_time_measures_frames_with_additional_data_and_a_supplement() {
    let text = good(&["bench", "cycle-time", "--json", "--tm-ns", "1250"]);
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    let came_in_us = report["round_trip_us"].as_f64().unwrap() + 0.05;
    for (command, infos, clock_hz, pulses, frame_us) in [
        ("111000", 1, 2_000_000, 74, 38.5),
        ("111000", 1, 8_000_000, 88, 12.875),
        ("111000", 1, 16_000_000, 112, 8.9375),
        ("111000", 2, 2_000_000, 104, 53.5),
        ("111000", 2, 8_000_000, 118, 16.625),
        ("111000", 2, 16_000_000, 142, 10.8125),
        ("101101", 0, 2_000_000, 78, 42.5),
        ("101101", 0, 8_000_000, 92, 15.375),
        ("101101", 0, 16_000_000, 116, 11.1875),
        ("101101", 2, 2_000_000, 138, 72.5),
        ("101101", 2, 8_000_000, 152, 22.875),
        ("101101", 2, 16_000_000, 176, 14.9375),
    ] {
        let mut rows = report["rows"].as_array().unwrap().iter();
        let row = rows.find(|row| {
            row["command"] == command
                && row["infos"] == infos
                && row["clock_hz"] == clock_hz
                && row["position_bits"] == 25
        });
        let row = row.expect("a row");
        assert_eq!(row["pulses"], pulses, "{row}");
        let figure = |key: &str| row[key].as_f64().unwrap();
        let parked_us = if command == "101101" { came_in_us } else { 0.0 };
        let frame_limit_us = frame_us + parked_us;
        assert!(
            (figure("frame_limit_us") - frame_limit_us).abs() < 1e-5,
            "{row}"
        );
        let limit_us = frame_limit_us + 1.25 + 0.5;
        assert!((figure("cycle_limit_us") - limit_us).abs() < 1e-5, "{row}");
        assert!(
            (0.0..1.0).contains(&(figure("cycle_us") - limit_us)),
            "{row}"
        );
    }
}

#[test]
#[ignore = "slow: cycle times behind a long cable"]
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
            "| {}{} | {} | {} | {} | {:.2} | {} | {:.2} | {:.2} | {:.0} |",
            row["command"].as_str().unwrap(),
            match row["infos"].as_u64().unwrap() {
                0 => String::new(),
                infos => format!(" + {infos}"),
            },
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
