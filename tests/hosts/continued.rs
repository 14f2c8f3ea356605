//! Recordings that go on behind others, and what is told instead of guessed.

use super::{slow_card, Served};
use crate::program::{bad, endat, good, run, Dir};
use endat_card::Door;
use endat_terminal::outcome::Outcome;
use serde_json::Value;
use std::fs;
use std::time::{Duration, Instant};

fn log(out: &str, more: &[&str]) -> Outcome {
    let log = ["log", "--port", "load", "--samples", "30", "--out", out];
    run(&[&log[..], more].concat())
}

fn refused(out: &str, more: &[&str]) -> String {
    let outcome = log(out, more);
    assert_eq!(outcome.exit_code, 2, "{more:?}: {outcome:?}");
    outcome.messages.join("\n")
}

/// Catches a recording of two kinds of rows, and one whose first file is forgotten.
#[test]
fn what_a_log_cannot_go_on_behind_is_refused_with_its_remedy() {
    let dir = Dir::new("resume");
    for form in ["csv", "jsonl", "parquet"] {
        let out = dir.path(&format!("night.{form}"));
        assert_eq!(log(&out, &[]).exit_code, 0);
        let told = refused(&out, &["--resume"]);
        let first = dir.path(&format!("night-0001.{form}"));
        assert!(
            told.contains(&format!(
                "has no number, so nothing goes on behind it; rename it to {first}"
            )),
            "{told}"
        );
        fs::rename(&out, &first).unwrap();
        let told = refused(&out, &["--resume", "--derive", "a=0:zero"]);
        assert!(
            told.contains(&first)
                && told.contains(
                    "has other columns: 2 channels, where this log has 2 channels and a_deg"
                ),
            "{told}"
        );
        assert_eq!(log(&out, &["--resume"]).exit_code, 0);
        let second = dir.path(&format!("night-0002.{form}"));
        good(&["stats", "--json", &second]);
        // A file that somebody has cut in two is told, and loses nothing of what comes.
        let bytes = fs::read(&second).unwrap();
        fs::write(&second, &bytes[..bytes.len() / 2]).unwrap();
        assert_eq!(log(&out, &["--resume"]).exit_code, 0);
        good(&["stats", "--json", &dir.path(&format!("night-0003.{form}"))]);
    }
    let cut = bad(&["stats", &dir.path("night-0002.parquet")], 2);
    assert!(
        cut.contains("is cut off: the end of a Parquet file says where its rows are"),
        "{cut}"
    );
}

/// Catches files of one recording of which nobody gives figures, because they do not say when they were begun; and two recordings that
/// are taken for one.
#[test]
fn text_that_was_gone_on_with_has_figures_and_a_drawing() {
    let dir = Dir::new("resume-figures");
    for form in ["csv", "jsonl"] {
        let out = dir.path(&format!("night.{form}"));
        let files = [1, 2, 3].map(|n| dir.path(&format!("night-000{n}.{form}")));
        let pause = "do not both say when they were begun";
        for (n, about) in [false, false, true].into_iter().enumerate() {
            let more = ["--resume", "--about"];
            let outcome = log(&out, &more[..1 + usize::from(about)]);
            assert_eq!(outcome.exit_code, 0, "{outcome:?}");
            assert!(fs::exists(&files[n]).unwrap());
        }
        let alone: Value = serde_json::from_str(&good(&["stats", "--json", &files[0]])).unwrap();
        let all: Vec<&str> = files.iter().map(String::as_str).collect();
        let told = run(&[&["stats", "--json"][..], &all].concat());
        assert_eq!(told.exit_code, 0, "{told:?}");
        assert_eq!(told.messages.len(), 2, "{told:?}");
        assert!(told.messages[1].starts_with(&files[2]), "{told:?}");
        assert!(told.messages[0].contains("is put right behind"), "{told:?}");
        let whole: Value = serde_json::from_str(&told.stdout).unwrap();
        let number = |of: &Value, name: &str| of[name].as_f64().unwrap();
        assert_eq!(number(&whole, "rows"), 3.0 * number(&alone, "rows"));
        let ratio = number(&whole, "duration_s") / number(&alone, "duration_s");
        assert!((3.0..3.1).contains(&ratio), "{ratio}");
        assert_eq!(number(&whole, "missing"), 0.0);
        assert!((number(&whole, "trigger_hz") / number(&alone, "trigger_hz") - 1.0).abs() < 0.05);
        let plot = run(&[&["plot"][..], &all].concat());
        assert_eq!(plot.exit_code, 0, "{plot:?}");
        // Not of following numbers: nobody knows.
        let told = bad(&["stats", all[0], all[2]], 2);
        assert!(told.contains("another recording begins here"), "{told}");
        let turned = run(&["stats", "--json", all[1], all[0]]);
        assert_eq!(turned.exit_code, 0, "{turned:?}");
        assert_eq!(turned, run(&["stats", "--json", all[0], all[1]]));
        let program = endat()
            .args([
                "log",
                "--port",
                "virtual",
                "--samples",
                "5",
                "--resume",
                "--out",
                &out,
            ])
            .output()
            .unwrap();
        let told = String::from_utf8(program.stderr).unwrap();
        assert!(program.status.success() && told.contains(pause), "{told}");
    }
}

#[test]
fn an_unknown_suffix_is_refused_and_a_new_folder_is_told() {
    let dir = Dir::new("suffix");
    let out = dir.path("night.xlsx");
    let told = refused(&out, &[]);
    assert!(told.contains("--out = ") && told.contains(".xlsx is no form of a recording; give a name that ends in .csv, .jsonl, .ndjson, .parquet or .pq"), "{told}");
    assert!(!fs::exists(&out).unwrap());
    assert_eq!(log(&out, &["--format", "csv"]).exit_code, 0);
    let out = dir.path("new/folder/rows.csv");
    for is_told in [true, false] {
        let log = [
            "log",
            "--port",
            "virtual",
            "--samples",
            "5",
            "--force",
            "--out",
            &out,
        ];
        let output = endat().args(log).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        let says = told.contains("--out: the folder ") && told.contains("has been made");
        assert_eq!((output.status.code(), says), (Some(0), is_told), "{told}");
    }
}

/// Catches figures of rows that somebody has changed.
#[test]
fn causes_that_are_none_and_degrees_that_are_not_those_of_raw_are_told() {
    let dir = Dir::new("changed");
    let csv = dir.path("r.csv");
    assert_eq!(log(&csv, &["--about"]).exit_code, 0);
    let text = fs::read_to_string(&csv).unwrap();
    let spoilt = dir.write("cause.csv", text.replacen(",none,", ",nine,", 1).as_bytes());
    let told = bad(&["stats", &spoilt], 2);
    assert!(told.contains(":3: ch0_cause = nine: is no cause"), "{told}");
    let row: Vec<&str> = text.lines().nth(2).unwrap().split(',').collect();
    let more = format!(",{},{:.7},", row[3], row[4].parse::<f64>().unwrap() + 0.001);
    let spoilt = text.replacen(&format!(",{},{},", row[3], row[4]), &more, 1);
    let spoilt = dir.write("degrees.csv", spoilt.as_bytes());
    let told = bad(&["stats", &spoilt], 2);
    assert!(
        told.contains(":3: ch0_deg = ")
            && told.contains(&format!("does not fit ch0_raw = {}", row[3])),
        "{told}"
    );
}

/// Catches a share of one thing that is taken for that of another.
#[test]
fn the_share_of_bad_rows_says_of_what_it_is() {
    let dir = Dir::new("share");
    let csv = dir.path("r.csv");
    assert_eq!(log(&csv, &["--about", "--every", "5"]).exit_code, 0);
    assert!(good(&["stats", &csv]).contains("% of the rows that were kept)"));
    assert_eq!(log(&csv, &["--about", "--force"]).exit_code, 0);
    assert!(!good(&["stats", &csv]).contains("that were kept"));
}

/// Catches one exit code for a port that nobody serves here, and another one there.
#[test]
fn what_is_not_there_has_one_exit_code_and_a_wrong_name_loses_no_other() {
    let nobody = ["--port", "tcp:127.0.0.1:1"];
    for command in [
        &["read"][..],
        &["inject", "unplug", "0"],
        &["monitor", "--plain"],
    ] {
        bad(&[command, &nobody].concat(), 2);
    }
    let read = [
        "reg",
        "read",
        "card.nonsense",
        "card.system_hz",
        "--port",
        "virtual",
    ];
    let outcome = run(&read);
    assert_eq!(outcome.exit_code, 2, "{outcome:?}");
    assert!(
        outcome.stdout.starts_with("card.system_hz = "),
        "{outcome:?}"
    );
    assert!(outcome.messages[0].contains("nonsense"), "{outcome:?}");
    let minus = ["inject", "--port", "tcp:127.0.0.1:1", "crc", "0", "-1"];
    assert!(bad(&minus, 2).contains("frames = -1: outside 1..1000000000"));
}

/// Catches a log that waits and says nothing.
#[test]
fn a_card_that_somebody_else_has_is_waited_for_and_that_is_told() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let dir = Dir::new("taken");
    let first = dir.path("first.csv");
    let mut other = endat()
        .args(["log", "--port", &card.name, "--out", &first])
        .spawn()
        .unwrap();
    // It has the card when it has rows.
    let has_rows = || fs::metadata(&first).is_ok_and(|m| m.len() > 1_000);
    let begin = Instant::now();
    while !has_rows() {
        assert!(begin.elapsed() < Duration::from_secs(120), "no rows");
        std::thread::sleep(Duration::from_millis(50));
    }
    let log = ["log", "--samples", "1", "--port", &card.name];
    let output = endat().args(log).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("waiting for the card at tcp:"), "{told}");
    assert_eq!(output.status.code(), Some(1), "{told}");
    other.kill().unwrap();
    other.wait().unwrap();
}

/// Catches data that no program can read.
#[test]
fn what_is_data_is_there_as_json() {
    let dir = Dir::new("json");
    let json = |arguments: &[&str]| -> Value { serde_json::from_str(&good(arguments)).unwrap() };
    let out = dir.path("out");
    let emit = ["emit", "--json", "--out", &out];
    let written = json(&emit);
    assert_eq!(
        written["files"].as_array().unwrap().len(),
        written["written"].as_array().unwrap().len()
    );
    assert!(json(&emit)["written"].as_array().unwrap().is_empty());
    assert_eq!(json(&["inject", "--list", "--json"])[0]["name"], "unplug");
    let blocks = json(&["reg", "list", "--json"]);
    let blocks = blocks.as_array().unwrap();
    assert_eq!(blocks.len(), endat_regs::BLOCKS.len());
    let write = [
        "reg",
        "write",
        "card_config.hold.scratch",
        "5",
        "--json",
        "--port",
        "virtual",
    ];
    assert_eq!(json(&write)["value"], 5);
    let monitor = [
        "monitor", "--json", "--count", "2", "--every", "0", "--port", "virtual",
    ];
    let output = endat().args(monitor).output().unwrap();
    let looks = String::from_utf8(output.stdout).unwrap();
    let looks: Vec<Value> = looks
        .lines()
        .map(|l| serde_json::from_str(l).unwrap())
        .collect();
    assert_eq!(looks.len(), 2);
    assert_eq!(looks[1]["channels"][1]["unit"], "deg");
}

/// Catches a rehearsal that nobody can count, because its card was faster than the clock of the host.
#[test]
fn recording_that_was_begun_before_the_end_of_the_last_one_is_read() {
    let dir = Dir::new("resume-fast");
    let out = dir.path("night.parquet");
    let log = ["log", "--port", "load", "--samples", "200000", "--out"];
    for _ in 0..3 {
        let told = run(&[&log[..], &[&*out, "--resume"]].concat());
        assert_eq!(told.exit_code, 0, "{told:?}");
    }
    let files = [1, 2, 3].map(|n| dir.path(&format!("night-000{n}.parquet")));
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let told = run(&[&["stats", "--json"][..], &files].concat());
    assert_eq!((told.exit_code, told.messages.len()), (0, 2), "{told:?}");
    let note = "was begun before the last row of the file before it";
    assert!(told.messages.iter().all(|m| m.contains(note)), "{told:?}");
    let found: Value = serde_json::from_str(&told.stdout).unwrap();
    assert_eq!(
        (&found["rows"], &found["missing"]),
        (&600_000.into(), &0.into())
    );
    // A file that is left out is another matter.
    let told = bad(&["stats", files[0], files[2]], 2);
    assert!(told.contains("another recording begins here"), "{told}");
    // One that is damaged is not named by anybody, and stops the others until it is moved away.
    let plain = dir.path("whole.parquet");
    fs::copy(files[0], &plain).unwrap();
    let behind = dir.path("whole-0002.parquet");
    let mut bytes = fs::read(&plain).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&behind, bytes).unwrap();
    let told = bad(&["stats", &plain], 2);
    assert!(
        told.contains(&behind) && told.contains("or move it away to read the others"),
        "{told}"
    );
    fs::rename(&behind, dir.path("bad.parquet")).unwrap();
    good(&["stats", &plain]);
}
