//! Recordings in every form: the same rows, read again by the program and by others.

use crate::program::{bad, good, run, Dir};
use crate::tools;
use serde_json::Value;
use std::fs;

const SAMPLES: &str = "150";

/// A log of the first sample sets of a card that makes the same ones each time.
fn log(out: &str, more: &[&str]) -> endat_terminal::outcome::Outcome {
    let log = ["log", "--port", "load", "--samples", SAMPLES, "--out", out];
    run(&[&log[..], more].concat())
}

fn stats(file: &str) -> Value {
    let mut told: Value = serde_json::from_str(&good(&["stats", "--json", file])).unwrap();
    told["start_time"] = Value::Null;
    told
}

/// Catches a form that loses or changes something, and a figure that hangs on the form.
#[test]
fn every_form_has_the_same_rows() {
    let dir = Dir::new("recordings");
    let derive = ["--about", "--derive", "twist=0-1:unwrap:zero"];
    let files = ["r.csv", "r.jsonl", "r.parquet"].map(|name| dir.path(name));
    for file in &files {
        let outcome = log(file, &derive);
        assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    }
    let [csv, jsonl, parquet] = files.each_ref().map(|file| stats(file));
    assert_eq!(csv["rows"], 150);
    assert_eq!(csv["missing"], 0);
    assert_eq!(csv["channels"][0]["causes"], serde_json::json!({}));
    assert!(
        (csv["trigger_hz"].as_f64().unwrap() - 10_000.0).abs() < 1.0,
        "{csv}"
    );
    assert_eq!(csv["derived"][0]["unit"], "deg");
    // A text has the digits of a measuring step, the others all.
    let channels = |told: &Value| told["channels"].clone();
    assert_eq!(channels(&csv), channels(&jsonl));
    assert_eq!(channels(&jsonl), channels(&parquet));
    for name in ["unit", "values", "least", "last"] {
        assert_eq!(
            jsonl["derived"][0][name], parquet["derived"][0][name],
            "{name}"
        );
    }
    for file in &files {
        let drawing = file.replace("/r.", "/drawn-") + ".svg";
        let plot = run(&["plot", file, "-o", &drawing, "--difference", "--velocity"]);
        assert_eq!(plot.exit_code, 0, "{plot:?}");
        assert_eq!(plot.messages, [format!("wrote {drawing}")]);
        let again = run(&["plot", file, "-o", &drawing, "--difference", "--velocity"]);
        assert_eq!(again.messages, [format!("{drawing}: up to date")]);
        for name in ["r.png", "r", "r.svg.gz"] {
            let other = dir.path(name);
            let told = bad(&["plot", file, "-o", &other], 2);
            assert!(
                told.contains("ends in .svg") && !fs::exists(&other).unwrap(),
                "{told}"
            );
        }
        let drawn = fs::read_to_string(&drawing).unwrap();
        for panel in [
            "channel 1 (deg)",
            "minus channel 1 (deg)",
            "velocity 0 (deg/s)",
            "twist",
        ] {
            assert!(drawn.contains(panel), "{file}: {panel}");
        }
    }
    // Without what it is of, too: turns are counted on all the same.
    let plain = dir.path("plain.csv");
    assert_eq!(log(&plain, &[]).exit_code, 0);
    let plain = stats(&plain);
    assert_eq!(plain["channels"][1]["values"], csv["channels"][1]["values"]);
    let near = |name: &str| {
        let [one, other] = [&plain, &csv].map(|s| s["channels"][1][name].as_f64().unwrap());
        assert!((one - other).abs() < 1e-6, "{name}: {one} {other}");
    };
    ["least", "greatest", "last"].into_iter().for_each(near);
}

/// Catches a Parquet file that only this program reads.
#[test]
fn duckdb_reads_a_recording() {
    if !tools::require("duckdb", "recordings as Parquet") {
        return;
    }
    let dir = Dir::new("recording_duckdb");
    let (parquet, csv) = (dir.path("r.parquet"), dir.path("r.csv"));
    for file in [&parquet, &csv] {
        assert_eq!(log(file, &[]).exit_code, 0);
    }
    let ask = |question: String| {
        let (is_good, told) = tools::run("duckdb", &dir.0, &["-csv", "-noheader", "-c", &question]);
        assert!(is_good, "{question}: {told}");
        told.trim().trim_matches('"').to_owned()
    };
    let figures = |file: &str, time: &str| {
        ask(format!(
            "select count(*), sum(ch0_raw), sum(ch1_raw), min(trigger), max(ch0_cause), round(max({time})) from '{file}'"
        ))
    };
    let told = figures(&parquet, "cycles / 1e8 * 1e9");
    assert_eq!(told, figures(&csv, "time_s * 1e9"));
    assert!(told.starts_with("150,"), "{told}");
    let about = ask(format!(
        "select decode(value)::json->>'$.channels[1].steps_per_turn' from parquet_kv_metadata('{parquet}') where decode(key) = 'endat'"
    ));
    assert_eq!(about, (1u64 << 29).to_string());
}

/// Catches a panic, or a row that is made of half a line.
#[test]
fn cut_off_foreign_and_empty_files_are_told_with_their_line() {
    let dir = Dir::new("recordings_wrong");
    let csv = dir.path("r.csv");
    assert_eq!(log(&csv, &["--about"]).exit_code, 0);
    let text = fs::read_to_string(&csv).unwrap();
    let cut = dir.write("cut.csv", &text.as_bytes()[..text.len() - 20]);
    let outcome = run(&["stats", "--json", &cut]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    assert_eq!(
        outcome.messages,
        [format!(
            "{cut}:152: the last line does not end: it is cut off, and left out"
        )]
    );
    assert!(outcome.stdout.contains("\"rows\": 149,"), "{outcome:?}");
    let middle = text.replacen(",none,", ",none,,", 1);
    let lines: Vec<&str> = text.lines().collect();
    let twice = format!("{text}{}\n", lines[5]);
    let number = text.replacen(&lines[4][..6], "7x,", 1);
    for (name, bytes, told) in [
        ("empty.csv", &b""[..], "empty.csv: is empty"),
        (
            "foreign.csv",
            b"a,b\n1,2\n",
            "foreign.csv:1: there is no column trigger",
        ),
        (
            "binary.csv",
            b"\xFF\xFE\x00\x01\n",
            "binary.csv:1: is no text",
        ),
        (
            "head.csv",
            lines[1].as_bytes(),
            "head.csv:1: there is no whole line",
        ),
        (
            "fields.csv",
            middle.as_bytes(),
            "fields.csv:3: has 14 fields, the head line 13",
        ),
        (
            "twice.csv",
            twice.as_bytes(),
            "another recording begins here",
        ),
        (
            "number.csv",
            number.as_bytes(),
            "is no number; delete the line",
        ),
        (
            "broken.jsonl",
            b"{\"trigger\": 1\n",
            "broken.jsonl:1: is no JSON",
        ),
        (
            "other.jsonl",
            b"{\"a\": 1}\n",
            "other.jsonl:1: there is no channels",
        ),
        ("short.parquet", b"PAR1", "short.parquet: is cut off"),
    ] {
        let file = dir.write(name, bytes);
        let message = bad(&["stats", &file], 2);
        assert!(message.contains(told), "{name}: {message}");
        assert!(bad(&["plot", &file], 2).contains(told), "{name}");
    }
    // The lines that a head alone has are no rows.
    let rows = dir.write("rows.csv", format!("{}\n", lines[1]).as_bytes());
    assert!(bad(&["stats", &rows], 2).contains("rows.csv: has no rows"));
    assert!(bad(&["plot", &csv, "--from", "9"], 2).contains("no rows between"));
}

/// Catches a bit that has become another one in a night on a disk, and a panic of who reads it.
#[test]
fn a_parquet_file_with_any_bit_changed_is_told() {
    let dir = Dir::new("recordings_damaged");
    let file = dir.path("r.parquet");
    assert_eq!(log(&file, &[]).exit_code, 0);
    let bytes = fs::read(&file).unwrap();
    for n in 0..400 {
        let mut wrong = bytes.clone();
        // Each of the last bytes, where the end is told, and others.
        let place = match n {
            0..40 => wrong.len() - 1 - n,
            _ => 4 + n * 7919 % (wrong.len() - 4),
        };
        wrong[place] ^= 1 << (n % 8);
        if n % 50 == 49 {
            wrong.truncate(place.max(4));
        }
        let damaged = dir.write("damaged.parquet", &wrong);
        let told = bad(&["stats", &damaged], 2);
        assert!(
            told.contains("is damaged") || told.contains("is cut off"),
            "{n}: {told}"
        );
    }
}

/// Catches wishes that are read only when the card has been recorded.
#[test]
fn wrong_wishes_are_told_before_a_card_is_opened() {
    let dir = Dir::new("recording_wishes");
    let out = dir.path("w.csv");
    let log = |more: &[&str]| {
        let begin = ["log", "--port", "tcp:127.0.0.1:1", "--out", out.as_str()];
        bad(&[&begin[..], more].concat(), 2)
    };
    for (more, told) in [
        (
            &["--on-cause", "crd"][..],
            "--on-cause = crd: there is no such cause; did you mean crc?",
        ),
        (&["--file-mb", "0"], "--file-mb = 0: outside 1..1000000"),
        (&["--every", "0"], "--every = 0: outside 1..1000000000"),
        (
            &["--force", "--file-mb", "1"],
            "are never replaced; go on behind them with --resume",
        ),
        (&["--before", "5"], "--on-cause"),
        (
            &["--on-cause", "crc", "--every", "5"],
            "cannot be used with",
        ),
    ] {
        let message = log(more);
        assert!(message.contains(told), "{more:?}: {message}");
    }
    let stdout = bad(&["log", "--port", "virtual", "--format", "parquet"], 2);
    assert!(
        stdout.contains("--format = parquet: needs a regular file"),
        "{stdout}"
    );
    let derive = [
        "log",
        "--port",
        "virtual",
        "--out",
        out.as_str(),
        "--derive",
        "a=0:unwarp",
    ];
    assert!(bad(&derive, 2).contains("did you mean unwrap?"));
    assert!(!fs::exists(&out).unwrap());
}

/// Catches a decimation that leaves a fault out, or tells less than it has seen.
#[test]
fn every_nth_row_is_kept_and_all_are_counted() {
    let dir = Dir::new("recording_every");
    let out = dir.path("e.csv");
    let outcome = log(&out, &["--every", "50", "--about"]);
    let told = &outcome.messages[0];
    assert!(
        told.contains("150 sample sets, 3 of them written,"),
        "{told}"
    );
    let told = good(&["stats", &out]);
    assert!(
        told.contains("one of 50 rows, and every one with a fault"),
        "{told}"
    );
}
