//! `log` and `reg write` when something is wrong: what is told, drawn and kept.

use super::{changed_text, quick_text, slow_card, Served, QUICKER};
use crate::tools;
use endat_card::Door;
use std::fs;
use std::path::PathBuf;

fn run(arguments: &[&str]) -> endat_terminal::outcome::Outcome {
    crate::program::run(arguments)
}

/// A card whose channel 0 expects another width than its encoder has: every frame is bad.
fn wrong_width(folder: &str) -> (PathBuf, String) {
    let folder = tools::folder(folder);
    let toml = folder.join("wrong.toml");
    let text = quick_text("s6_two_channel");
    let text = text.replacen("\nposition_bits = 29", "\nposition_bits = 25", 1);
    fs::write(&toml, text).unwrap();
    (folder, format!("virtual:{}", toml.display()))
}

/// Catches a log that calls a run good whose rows are bad, and a plot that shows nothing of it.
#[test]
fn a_bad_run_is_told_by_cause_marked_in_the_plot_and_not_good() {
    let (folder, port) = wrong_width("host_bad_run");
    let (svg, out) = (folder.join("bad.svg"), folder.join("bad.csv"));
    let (svg, out) = (svg.to_str().unwrap(), out.to_str().unwrap());
    let log = [
        "log",
        "--samples",
        "100",
        "--force",
        "--port",
        &port,
        "--svg",
        svg,
        "--out",
        out,
    ];
    let outcome = run(&log);
    assert_eq!(outcome.exit_code, 1, "{outcome:?}");
    let told = &outcome.messages;
    assert!(
        told[0].contains("of 100 rows bad (") && told[0].contains("; channel 0: "),
        "{told:?}"
    );
    assert!(!told[0].contains("channel 1"), "{told:?}");
    assert!(
        told[1].starts_with("bad rows = ") && told[1].contains("more than 1 %"),
        "{told:?}"
    );
    let drawn = fs::read_to_string(svg).unwrap();
    assert!(drawn.matches("class=\"bad\"").count() > 50, "marks");
    let allowed = run(&[&log[..], &["--bad-max", "100"]].concat());
    assert_eq!(allowed.exit_code, 0, "{allowed:?}");
    assert!(allowed.messages[0].contains("rows bad"), "{allowed:?}");
    let wrong = run(&[&log[..], &["--bad-max", "101"]].concat());
    assert_eq!(
        wrong.messages,
        ["--bad-max = 101: outside 0..100; give a number in that range"]
    );
}

/// Catches a run whose drawing is lost with its disk.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_the_plot_is_there() {
    let svg = tools::folder("host_full_disk").join("full.svg");
    let svg = svg.to_str().unwrap();
    let outcome = run(&[
        "log",
        "--samples",
        "60",
        "--out",
        "/dev/full",
        "--force",
        "--svg",
        svg,
        "--port",
        "virtual",
    ]);
    assert_eq!(outcome.exit_code, 2, "{outcome:?}");
    let begins = |text: &str| outcome.messages.iter().position(|m| m.starts_with(text));
    let told = begins("/dev/full: cannot write: ").expect("the rows");
    assert!(told < begins("wrote ").expect("the drawing"), "{outcome:?}");
    assert!(
        outcome.messages[0].contains(" sample sets in "),
        "{outcome:?}"
    );
    assert!(fs::read_to_string(svg).unwrap().contains("channel 1 (deg)"));
}

/// Catches a run of which only the drawing's failure is told, and not that its rows were cut.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_without_room_for_rows_and_drawing_is_told_for_both() {
    let folder = tools::folder("host_fuller_disk");
    let svg = folder.join("plots").join("full.svg");
    let gone = folder.join("plots");
    let _ = fs::create_dir_all(&gone);
    let end = std::thread::spawn(move || {
        std::thread::sleep(std::time::Duration::from_millis(1500));
        // No drawing can be made where a file stands in the place of its folder.
        fs::remove_dir_all(&gone).unwrap();
        fs::write(&gone, "").unwrap();
    });
    // A device is no file that could be replaced: no --force.
    let log = [
        "log",
        "--seconds",
        "5",
        "--out",
        "/dev/full",
        "--port",
        "virtual",
    ];
    let outcome = run(&[&log[..], &["--svg", svg.to_str().unwrap()]].concat());
    end.join().unwrap();
    fs::remove_file(folder.join("plots")).unwrap();
    assert_eq!(outcome.exit_code, 2, "{outcome:?}");
    assert!(
        outcome.messages[0].contains(" sample sets in "),
        "{outcome:?}"
    );
    let begins = |text: &str| outcome.messages.iter().position(|m| m.starts_with(text));
    let rows = begins("/dev/full: cannot write: ").expect("the rows");
    assert!(rows < outcome.messages.len() - 1, "{outcome:?}");
}

/// Catches 20 s of waiting for triggers that nobody can give, and a file that is there told as an error of the system.
#[test]
fn what_cannot_be_logged_is_told_at_once() {
    let folder = tools::folder("host_only_register");
    let toml = folder.join("register.toml");
    // The second one could have a clock running, and has none.
    for name in ["s6_two_channel", "s6_two_channel_service"] {
        let text = changed_text(name, &QUICKER);
        let line = text.lines().find(|l| l.starts_with("sources = ")).unwrap();
        fs::write(&toml, text.replacen(line, "sources = [\"register\"]", 1)).unwrap();
        let port = format!("virtual:{}", toml.display());
        let outcome = run(&["log", "--port", &port]);
        assert_eq!(outcome.exit_code, 1, "{outcome:?}");
        let told = &outcome.messages[0];
        assert!(
            told.starts_with("only trigger_now triggers this card"),
            "{outcome:?}"
        );
    }
    let file = toml.to_str().unwrap();
    let log = ["log", "--samples", "1", "--port", "virtual", "--out", file];
    // Its suffix is none of a recording.
    let outcome = run(&[&log[..], &["--format", "csv"]].concat());
    assert_eq!(outcome.exit_code, 2, "{outcome:?}");
    let told = format!("--out = {file}: is there already; give another file with --out, or replace it with --force");
    assert_eq!(outcome.messages, [told]);
}

/// Catches a run whose drawing is lost with its card. The host waits 20 s for it.
#[test]
#[ignore = "slow: a log that nobody answers any more"]
fn a_card_that_dies_leaves_file_and_plot() {
    let folder = tools::folder("host_card_dies");
    let (svg, out) = (folder.join("dies.svg"), folder.join("dies.csv"));
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let port = card.name.clone();
    let rows = out.clone();
    let end = std::thread::spawn(move || {
        // Until some rows are in the file.
        let lines = || fs::read_to_string(&rows).map_or(0, |text| text.lines().count());
        for _ in 0..600 {
            if lines() > 5 {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(100));
        }
        drop(card);
    });
    let outcome = run(&[
        "log",
        "--samples",
        "1000000",
        "--port",
        &port,
        "--svg",
        svg.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ]);
    end.join().unwrap();
    assert_eq!(outcome.exit_code, 1, "{outcome:?}");
    assert!(
        outcome.messages[0].contains(" sample sets in "),
        "{outcome:?}"
    );
    let text = fs::read_to_string(&out).unwrap();
    assert!(text.ends_with('\n') && text.lines().count() > 2, "{text}");
    assert!(fs::read_to_string(&svg)
        .unwrap()
        .contains("channel 1 (deg)"));
}

/// Catches a write that the map itself forbids.
#[test]
fn reg_write_keeps_to_the_limits_of_the_map_unless_forced() {
    let write = |name: &str, value: &str, more: &[&str]| {
        run(&[&["reg", "write", name, value, "--port", "virtual"], more].concat())
    };
    for (name, value, told) in [
        (
            "card_config.trigger_period",
            "3",
            "value = 3: card_config.trigger_period would have value = 3, which takes 4..16777215; --force writes it all the same",
        ),
        (
            "config1.frame.position_bits",
            "60",
            "value = 60: config1.frame.position_bits would have position_bits = 60, which takes 1..48; --force",
        ),
        (
            "config0.frame.command",
            "5",
            "which takes send_position, send_position_add_info; --force",
        ),
    ] {
        let outcome = write(name, value, &[]);
        assert_eq!(outcome.exit_code, 2, "{outcome:?}");
        assert!(outcome.messages[0].contains(told), "{outcome:?}");
        let forced = write(name, value, &["--force"]);
        assert_eq!(forced.exit_code, 0, "{forced:?}");
        assert!(forced.stdout.ends_with(&format!(" = {value}\n")), "{forced:?}");
    }
    let many =
        "config0.frame.position_bits would have position_bits = 64, which takes 1..48; --force";
    for (name, value, told) in [
        (
            "config0.frame.period_cycles",
            "2",
            "which takes 4..2047; --force",
        ),
        ("config0.frame.position_bits", "64", many),
        (
            "card.trigger_now",
            "2",
            "value = 2: card.trigger_now has no such bits; give bits of 0x1; --force",
        ),
        (
            "card_config.trigger_period",
            "160000000",
            "card_config.trigger_period has no such bits; give bits of 0xFFFFFF; --force",
        ),
        (
            "card.calibrate",
            "0xFFFF",
            "has no such bits; give bits of 0xFF; --force",
        ),
    ] {
        let outcome = write(name, value, &[]);
        assert_eq!(outcome.exit_code, 2, "{outcome:?}");
        assert!(outcome.messages[0].contains(told), "{outcome:?}");
    }
    assert_eq!(write("card.calibrate", "3", &[]).exit_code, 0);
    let foreign = run(&["reg", "read", "nosuch", "--port", "virtual"]);
    let told = &foreign.messages[0];
    let begin = "register = \"nosuch\": no block is called \"nosuch\" (";
    // The card has no services and no T-format channel.
    assert!(
        told.starts_with(begin) && told.contains("config0"),
        "{told}"
    );
    assert!(
        !told.contains("service0") && !told.contains("t_format0"),
        "{told}"
    );
    let near = run(&["reg", "read", "age_recovery", "--port", "virtual"]);
    assert_eq!(near.exit_code, 2);
    assert!(
        near.messages[0].contains("; did you mean result0.age_recovery? ("),
        "{near:?}"
    );
}

/// Catches names that `reg list` and `reg read` print, and `reg write` does not take.
#[test]
fn reg_write_takes_names_of_a_words_bits() {
    let sources = "card_config.trigger_sources";
    let port = ["--port", super::quicker_service_port()];
    let write =
        |name: &str, value: &str| run(&[&["reg", "write", name, value][..], &port].concat());
    for (value, wanted) in [("pin,timer", 3), ("timer", 2), ("pin, register", 5)] {
        let outcome = write(sources, value);
        assert_eq!(outcome.exit_code, 0, "{outcome:?}");
        assert!(
            outcome.stdout.ends_with(&format!(" = {wanted}\n")),
            "{outcome:?}"
        );
    }
    let outcome = write(sources, "pin,tmier");
    assert_eq!(outcome.exit_code, 2, "{outcome:?}");
    assert_eq!(
        outcome.messages,
        ["value = pin,tmier: is not a number from 0 to 4294967295; write 123, 0x7B or 0b1111011, or names of its bits: pin, timer, register"]
    );
}

/// Catches a program that says nothing of results that nobody got.
#[cfg(target_os = "linux")]
#[test]
fn a_full_stdout_is_no_success() {
    use std::process::Stdio;
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = crate::program::endat()
        .args(["explain", "crc"])
        .stdout(Stdio::from(full))
        .stderr(Stdio::piped())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.starts_with("endat: stdout: cannot write: "), "{told}");
}

/// Before anything is written: the plot would take the place of the rows.
#[test]
fn rows_and_plot_are_two_files() {
    let file = tools::folder("log-same").join("same.csv");
    let file = file.to_str().unwrap();
    let outcome = run(&["log", "--port", "virtual", "--out", file, "--svg", file]);
    assert_eq!(outcome.exit_code, 2, "{outcome:?}");
    assert!(!std::path::Path::new(file).exists());
}

/// What stands in a row instead of a cause can be asked for, too.
#[test]
fn every_word_of_a_row_is_explained() {
    for (name, means) in endat_host::feed::NO_CAUSES {
        let outcome = run(&["explain", name]);
        assert_eq!(outcome.exit_code, 0, "{outcome:?}");
        assert!(outcome.stdout.contains(means), "{outcome:?}");
    }
}
