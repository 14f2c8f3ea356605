//! Recordings as text that were changed, cut and saved by others: what the figures say of them.

use crate::program::{bad, endat_path, good, run, Dir};
use serde_json::Value;
use std::fs;

fn log(out: &str, more: &[&str]) -> Vec<String> {
    let log = ["log", "--port", "load", "--samples", "200", "--out", out];
    let outcome = run(&[&log[..], more].concat());
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let text = fs::read_to_string(out).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// Catches rows that were deleted, doubled or changed, and figures that are made of them without a word.
#[test]
fn rows_that_do_not_fit_are_counted_named_and_no_success() {
    let dir = Dir::new("recording_rows");
    for form in ["csv", "jsonl"] {
        let file = dir.path(&format!("good.{form}"));
        let lines = log(&file, &["--about"]);
        good(&["stats", &file]);
        let first = if form == "csv" { 2 } else { 1 };
        let at = first + 100;
        let field = |lines: &[String], name: &str, from: &str, to: &str| {
            let mut lines = lines.to_vec();
            let (from, to) = match form {
                "csv" => (from.to_owned(), to.to_owned()),
                _ => (format!("\"{name}\":{from}"), format!("\"{name}\":{to}")),
            };
            lines[at] = match (form, name) {
                ("csv", "trigger") => lines[at].replacen(&from, &to, 1),
                ("csv", _) => lines[at].replacen(&format!(",{from},"), &format!(",{to},"), 1),
                _ => lines[at].replacen(&from, &to, 1),
            };
            lines
        };
        let trigger = match form {
            "csv" => lines[at].split(',').next().unwrap().to_owned(),
            _ => {
                let row: Value = serde_json::from_str(&lines[at]).unwrap();
                row["trigger"].to_string()
            }
        };
        let deleted = [&lines[..at], &lines[at + 11..]].concat();
        let twice = [&lines[..=at], &lines[at..]].concat();
        let number = field(
            &lines,
            "trigger",
            &trigger,
            &format!("{trigger}000000000000"),
        );
        let missing = field(&lines, "missing", "0", "7");
        for (name, lines, line, what) in [
            (
                "deleted",
                deleted,
                at,
                "11 triggers before it are neither rows nor counted as missing",
            ),
            ("twice", twice, at + 1, "is there twice"),
            ("number", number, at, "neither rows nor counted"),
            ("missing", missing, at, "missing = 7: does not fit"),
        ] {
            let damaged = dir.write(
                &format!("{name}.{form}"),
                (lines.join("\n") + "\n").as_bytes(),
            );
            let outcome = run(&["stats", "--json", &damaged]);
            assert_eq!(outcome.exit_code, 1, "{name}: {outcome:?}");
            let place = format!("{damaged}:{}: ", line + 1);
            assert!(
                outcome.messages[0].starts_with(&place) && outcome.messages[0].contains(what),
                "{name}: {outcome:?}"
            );
            let told = &outcome.messages[1];
            assert!(told.starts_with("rows that do not fit = 1: "), "{told}");
            let figures: Value = serde_json::from_str(&outcome.stdout).unwrap();
            assert_eq!(
                (&figures["misfits"], &figures["missing"]),
                (&1.into(), &0.into())
            );
            let hz = figures["trigger_hz"].as_f64().unwrap();
            assert!((hz - 10_000.0).abs() < 100.0, "{name}: {hz}");
            let plain = run(&["stats", &damaged]);
            assert!(
                plain.stdout.contains("do not fit          1 rows; "),
                "{plain:?}"
            );
            let drawing = dir.path("drawing.svg");
            let plot = run(&["plot", &damaged, "--out", &drawing]);
            assert!(plot.messages[0].starts_with(&place), "{plot:?}");
        }
    }
}

/// Catches rows that were left out on purpose and are taken for damage, and no way to say so.
#[test]
fn rows_that_were_left_out_on_purpose_are_no_damage() {
    let dir = Dir::new("recording_sparse");
    let file = dir.path("every.csv");
    log(&file, &["--every", "10", "--about"]);
    good(&["stats", &file]);
    let plain = dir.path("plain.csv");
    log(&plain, &["--every", "10"]);
    let told = bad(&["stats", &plain], 1);
    assert!(
        told.contains("with --about, and else with `stats --sparse`"),
        "{told}"
    );
    good(&["stats", "--sparse", &plain]);
}

/// Catches a recording that nobody can read any more because a spreadsheet has saved it.
#[test]
fn recordings_that_a_spreadsheet_saved_are_read() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/spreadsheets/");
    let stats = |name: &str| -> Value {
        serde_json::from_str(&good(&["stats", "--json", &format!("{folder}{name}")])).unwrap()
    };
    let wanted = stats("semi.csv");
    assert_eq!(
        (&wanted["rows"], &wanted["channels"][0]["unit"]),
        (&11.into(), &"deg".into())
    );
    let last = wanted["channels"][0]["last"].as_f64().unwrap();
    assert!((last - 48.79925).abs() < 1e-9, "{last}");
    let derived = wanted["derived"][0]["first"].as_f64().unwrap();
    assert!((derived - 19.828906059265137).abs() < 1e-12, "{derived}");
    for name in ["excel_de.csv", "tab.csv"] {
        assert_eq!(stats(name), wanted, "{name}");
    }
    let short = stats("sep.csv");
    assert_eq!(short["rows"], 10);
    assert_eq!(
        short["channels"][0]["first"],
        wanted["channels"][0]["first"]
    );
    // What a spreadsheet makes of a head, a line end and a mark of its own.
    let dir = Dir::new("recording_spreadsheet");
    let text = fs::read_to_string(format!("{folder}excel_de.csv")).unwrap();
    let text =
        format!("\u{feff}sep=;\n\"# {{\"\"form\"\"\";1}};;;;;;;\n{text}").replace('\n', "\r\n");
    let other = dir.write("other.csv", text.as_bytes());
    let other: Value = serde_json::from_str(&good(&["stats", "--json", &other])).unwrap();
    assert_eq!(other, wanted);
    // And what `log` writes for one is the same recording.
    let [point, comma] = ["point.csv", "comma.csv"].map(|name| dir.path(name));
    log(&point, &["--about", "--derive", "twist=0-1:unwrap"]);
    let lines = log(
        &comma,
        &["--about", "--derive", "twist=0-1:unwrap", "--decimal-comma"],
    );
    assert!(lines[2].contains(";0,000000000;0;"), "{}", lines[2]);
    let figures = |file: &str| {
        let mut told: Value = serde_json::from_str(&good(&["stats", "--json", file])).unwrap();
        told["start_time"] = Value::Null;
        told
    };
    assert_eq!(figures(&point), figures(&comma));
    let wrong = [
        "log",
        "--port",
        "load",
        "--decimal-comma",
        "--out",
        "x.jsonl",
    ];
    assert!(bad(&wrong, 2).contains("--decimal-comma: is of CSV alone"));
    // Two commas are no number.
    let wrong = text.replace("40,57216", "40,572,16");
    let wrong = dir.write("wrong.csv", wrong.as_bytes());
    assert!(bad(&["stats", &wrong], 2).contains("ch0_deg = 40,572,16: is no number"));
}

/// Catches a log that dies of a limit of the shell, with half a line at its end.
#[cfg(target_os = "linux")]
#[test]
fn a_limit_of_the_shell_ends_a_log_with_a_message_and_a_whole_file() {
    let dir = Dir::new("recording_limit");
    for form in ["csv", "parquet"] {
        let out = dir.path(&format!("r.{form}"));
        let rows = if form == "csv" { "3000" } else { "600000" };
        let command = format!(
            "ulimit -f 100; exec '{}' log --port load --samples {rows} --out '{out}'",
            endat_path().display()
        );
        let output = std::process::Command::new("bash")
            .args(["-c", &command])
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{told}");
        let text = format!(
            "{out}: cannot write: a file of this size is not allowed (ulimit -f); raise the limit, or begin files that are smaller with --file-mb"
        );
        assert!(told.contains(&text), "{told}");
        match form {
            "csv" => {
                let text = fs::read_to_string(&out).unwrap();
                assert!(
                    text.ends_with('\n') && text.len() > 90_000,
                    "{}",
                    text.len()
                );
                good(&["stats", &out]);
            }
            // A group that did not fit is not in it, and it is whole.
            _ => assert!(bad(&["stats", &out], 2).contains("has no rows")),
        }
    }
}
