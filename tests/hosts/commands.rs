//! The commands of the program, at a card in the same process.

use crate::tools;
use std::fs;

fn run(arguments: &[&str]) -> endat_terminal::outcome::Outcome {
    crate::program::run(arguments)
}

fn json(outcome: &endat_terminal::outcome::Outcome) -> serde_json::Value {
    serde_json::from_str(&outcome.stdout).unwrap()
}

const PORT: [&str; 2] = ["--port", "virtual"];

fn service() -> [&'static str; 2] {
    ["--port", super::quicker_service_port()]
}

fn with<'a>(command: &[&'a str], port: [&'a str; 2]) -> endat_terminal::outcome::Outcome {
    run(&[command, &port].concat())
}

#[test]
fn read_shows_every_channel_in_degrees() {
    let outcome = with(&["read", "--json"], PORT);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let channels = json(&outcome);
    for (n, first_deg) in [(0, 36.0), (1, 72.0)] {
        let c = &channels[n];
        assert_eq!(
            (c["fresh"].as_bool(), c["cause"].as_str()),
            (Some(true), Some("none"))
        );
        // Shafts begin at a tenth of a turn per channel, and turn.
        let deg = c["value"].as_f64().unwrap();
        assert!((first_deg..first_deg + 1.0).contains(&deg), "{deg}");
        let raw = c["position"].as_u64().unwrap() as f64 * 360.0 / f64::from(1 << 29);
        assert!((raw - deg).abs() < 1e-9);
    }
    assert!(with(&["read"], PORT).stdout.contains(" deg "));
}

#[test]
fn id_reads_the_name_plate_and_param_the_same_word() {
    let outcome = with(&["id", "--json"], service());
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let card = json(&outcome);
    let encoder = &card["encoders"][1];
    assert_eq!(encoder["position_bits"], 29);
    assert_eq!(encoder["steps"], 1 << 29);
    assert_eq!(
        (encoder["id"].as_str(), encoder["serial"].as_str()),
        (Some("123456"), Some("1"))
    );
    assert!(encoder["delay_cycles"].as_u64().unwrap() > 5);
    let word = json(&with(
        &["param", "read", "0xA1", "0x0D", "--channel", "1", "--json"],
        service(),
    ));
    assert_eq!(word["value"], 0x801D);
    let plain = with(&["id"], PORT);
    assert!(
        plain.stdout.contains("the card has no part initialise"),
        "{plain:?}"
    );
}

#[test]
fn param_write_changes_the_encoder_and_what_it_refuses_is_told() {
    // The customer's area 0xA9 can be written.
    let written = with(
        &["param", "write", "0xA9", "0x05", "0x1234", "--json"],
        service(),
    );
    assert_eq!(written.exit_code, 0, "{written:?}");
    assert_eq!(json(&written)["value"], 0x1234);
    let refused = with(&["param", "write", "0xA1", "0x0D", "1"], service());
    assert_eq!(refused.exit_code, 1, "{refused:?}");
    assert!(refused.messages[0].contains("011100"), "{refused:?}");
    let absent = with(&["param", "read", "0xA1", "0x0D"], PORT);
    assert_eq!(absent.exit_code, 2);
    assert!(
        absent.messages[0].contains("the card has no part `requests`"),
        "{absent:?}"
    );
}

#[test]
fn param_send_sends_any_mode_command_and_tells_what_came_back() {
    let area = ["param", "send", "001110", "0xA1", "--json"];
    let answer = json(&with(&area, service()));
    assert_eq!(answer["command"], "001110");
    assert_eq!(answer["address"], 0xA1, "echo of the MRS code");
    // With EnDat 2.2 it rides on a position.
    let ridden = with(&["param", "send", "101101"], service());
    assert_eq!(ridden.exit_code, 0, "{ridden:?}");
    assert!(ridden
        .stdout
        .starts_with("channel 0, 101101: sent with a position"));
    for (command, wanted) in [
        (
            "1010",
            "command = 1010: a mode command is six binary digits",
        ),
        ("101012", "command = 101012: a mode command"),
    ] {
        let bad = with(&["param", "send", command], service());
        assert_eq!(bad.exit_code, 2);
        assert!(bad.messages[0].starts_with(wanted), "{bad:?}");
    }
    let unknown = with(&["param", "send", "111111"], service());
    // Both triplets are the same, and yet it has an answer of its own.
    let own = with(&["param", "send", "010010", "0x5A", "0x1234"], service());
    assert!(
        own.stdout.contains("8 bits 0x5A, 16 bits 0x1234"),
        "{own:?}"
    );
    assert_eq!(unknown.exit_code, 1);
    assert!(
        unknown.messages[0].contains("unknown mode command"),
        "{unknown:?}"
    );
}

#[test]
fn param_send_shows_a_long_answer_whole() {
    // 40 bits of test values.
    let values = with(&["param", "send", "010101"], service());
    assert!(values.stdout.contains("0x0123456789"), "{values:?}");
    let values = with(&["param", "send", "010101", "--json"], service());
    let values = json(&values);
    assert_eq!(values["answer"], 0x01_2345_6789_u64);
    assert!(values["data"].is_null(), "{values}");
    // 29 bits of a shaft at a tenth of a turn.
    let position = with(&["param", "send", "000111", "--json"], service());
    let position = json(&position)["answer"].as_u64().unwrap();
    let turn = position as f64 / f64::from(1 << 29);
    assert!((0.1..0.5).contains(&turn), "{position}");
}

#[test]
fn param_cancel_tells_what_became_of_the_request() {
    let nothing = with(&["param", "cancel", "--channel", "1"], service());
    assert_eq!(nothing.exit_code, 0, "{nothing:?}");
    assert!(
        nothing
            .stdout
            .contains("channel 1: no request is under way"),
        "{nothing:?}"
    );
}

#[test]
fn registers_are_read_and_written_by_name() {
    let read = with(&["reg", "read", "card.id", "config1.frame", "--json"], PORT);
    let words = json(&read);
    assert_eq!(words[0]["value"], 0x456E_4474);
    assert_eq!(words[1]["address"], 0x110);
    assert_eq!(words[1]["fields"]["position_bits"]["value"], 29);
    assert_eq!(
        words[1]["fields"]["command"]["meaning"],
        "111000 send position with additional data (EnDat 2.2)"
    );
    let block = with(&["reg", "read", "result0"], PORT);
    assert!(
        block.stdout.contains("result0.age_recovery = "),
        "{block:?}"
    );
    // A field, by name of its value; the fields beside it stay.
    let written = with(
        &["reg", "write", "config0.frame.command", "send_position"],
        PORT,
    );
    assert_eq!(written.stdout, "config0.frame.command = 0x00000007 = 7\n");
    let strobe = with(&["reg", "write", "card.trigger_now", "1"], PORT);
    assert_eq!(strobe.stdout, "card.trigger_now: done\n");
    for (arguments, told) in [
        (&["reg", "read", "result7.status"][..], "result0 to result1"),
        (
            &["reg", "write", "result0.status", "1"],
            "is read only; nothing was written",
        ),
        (
            &["reg", "write", "config0.frame.command", "64"],
            "value = 64: outside 0..63",
        ),
        (
            &["reg", "read", "service0.state"],
            "this card has no block service",
        ),
    ] {
        let outcome = with(arguments, PORT);
        assert_eq!(outcome.exit_code, 2, "{outcome:?}");
        assert!(outcome.messages[0].contains(told), "{outcome:?}");
    }
    assert!(run(&["reg", "list"])
        .stdout
        .contains("0x180 ro     result0.status"));
}

#[test]
fn log_writes_a_file_and_does_not_replace_another() {
    let folder = tools::folder("host_log");
    let path = folder.join("angles.csv");
    let file = path.to_str().unwrap();
    let log = ["log", "--samples", "25", "--out", file, "--poll"];
    let outcome = with(&log, PORT);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let text = fs::read_to_string(&path).unwrap();
    let mut rows = csv_rows(&text);
    assert_eq!(rows.len(), 26);
    let head = rows.remove(0);
    let column = |name: &str| head.iter().position(|h| h == name).unwrap();
    let (trigger, time, missing) = (column("trigger"), column("time_s"), column("missing"));
    for pair in rows.windows(2) {
        let number = |row: &[String], at: usize| row[at].parse::<f64>().unwrap();
        let steps = number(&pair[1], trigger) - number(&pair[0], trigger);
        assert_eq!(number(&pair[1], missing), steps - 1.0);
        // 10 kHz by the card's own clock.
        let span = number(&pair[1], time) - number(&pair[0], time);
        assert!((span - steps * 1e-4).abs() < 1e-7, "{span}");
        let angle = number(&pair[1], column("ch1_deg")) - number(&pair[0], column("ch1_deg"));
        assert!(angle > 0.0 && angle < 1.0);
    }
    let again = with(&log, PORT);
    assert_eq!(again.exit_code, 2);
    assert!(again.messages[0].contains("--force"), "{again:?}");
    assert_eq!(fs::read_to_string(&path).unwrap(), text);
    let forced = with(
        &[&log[..], &["--force", "--format", "jsonl"]].concat(),
        PORT,
    );
    assert_eq!(forced.exit_code, 0, "{forced:?}");
    let lines = fs::read_to_string(&path).unwrap();
    assert_eq!(lines.lines().count(), 25);
    assert!(lines
        .lines()
        .all(|l| serde_json::from_str::<serde_json::Value>(l).is_ok()));
}

/// Catches a row of a trigger that never was.
#[test]
fn a_log_has_no_row_before_the_first_trigger() {
    use endat_host::feed::Feed;
    let mut card = super::host("artinchip_endat_if");
    let mut feed = Feed::begin(&mut card, true).unwrap();
    let mut rows = std::collections::VecDeque::new();
    let mut fill = |card: &mut _, rows: &mut _| {
        for _ in 0..3 {
            feed.fill(card, rows, std::time::Duration::ZERO).unwrap();
        }
    };
    fill(&mut card, &mut rows);
    assert!(rows.is_empty(), "{rows:?}");
    let now = card.place("card.trigger_now").unwrap();
    card.write(&now, 1).unwrap();
    card.bridge().transport().run(200_000);
    fill(&mut card, &mut rows);
    assert_eq!(rows.len(), 1, "{rows:?}");
}

/// Catches a stream that loses or doubles a set, and a link that is not as before when the log has ended.
#[test]
fn log_has_every_trigger_of_a_card_with_a_stream() {
    use endat_host::feed::Feed;
    let mut card = super::found(&super::quick(super::SERVICE));
    for channel in [0, 1] {
        card.wait_for_initialisation(channel).unwrap();
    }
    for _ in 0..2 {
        let mut feed = Feed::begin(&mut card, false).unwrap();
        assert!(feed.streams());
        let mut rows = std::collections::VecDeque::new();
        while rows.len() < 60 {
            feed.fill(&mut card, &mut rows, std::time::Duration::from_millis(5))
                .unwrap();
            // Registers can be read meanwhile.
            assert_eq!(card.bridge().read(0, 1).unwrap(), [0x456E_4474]);
        }
        assert_eq!(feed.lost_in_card(), 0);
        feed.end(&mut card).unwrap();
        for (before, row) in rows.iter().zip(rows.iter().skip(1)) {
            assert_eq!((row.trigger - before.trigger, row.missing), (1, 0));
            assert_eq!(row.cycles - before.cycles, 4_000);
            assert!(row.cells.iter().all(|c| c.fresh && c.cause == "none"));
        }
        // Plain UARTBone again, without a wait.
        let retries = card.bridge().retries();
        assert_eq!(card.bridge().read(0, 1).unwrap(), [0x456E_4474]);
        assert_eq!(card.bridge().retries(), retries);
    }
}

/// The shipped card as a newcomer logs it: no sample of its 10 kHz is missing, and none comes twice.
#[test]
fn log_records_every_sample_of_the_shipped_card() {
    records_every_sample(300);
}

#[test]
#[ignore = "slow: three thousand samples of the shipped card"]
fn log_records_every_sample_of_the_shipped_card_for_long() {
    records_every_sample(3_000);
}

fn records_every_sample(count: usize) {
    let samples = count.to_string();
    let out = tools::folder(&format!("host_every_sample_{samples}")).join("log.csv");
    let outcome = run(&[
        "log",
        "--port",
        "virtual",
        "--samples",
        &samples,
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let told = &outcome.messages[0];
    assert!(
        told.contains("; 0 triggers missing, 0 of them dropped in the card; 0 frames damaged"),
        "{told}"
    );
    let rows = csv_rows(&fs::read_to_string(&out).unwrap());
    assert_eq!(rows.len(), count + 1);
    let column = |row: &Vec<String>, name: &str| {
        let at = rows[0].iter().position(|n| n == name).unwrap();
        row[at].clone()
    };
    let trigger = |row| column(row, "trigger").parse::<u64>().unwrap();
    for pair in rows[1..].windows(2) {
        assert_eq!(trigger(&pair[1]), trigger(&pair[0]) + 1);
    }
    // The card is on when the log begins: every position is of its own trigger.
    for row in &rows[8..] {
        for channel in ["ch0", "ch1"] {
            let cell = |name| column(row, &format!("{channel}_{name}"));
            assert_eq!(
                (cell("fresh").as_str(), cell("cause").as_str()),
                ("1", "none")
            );
        }
    }
}

fn csv_rows(text: &str) -> Vec<Vec<String>> {
    let row = |line: &str| line.split(',').map(str::to_owned).collect();
    text.lines().map(row).collect()
}

#[test]
fn margin_is_what_the_card_has_measured() {
    let folder = tools::folder("host_margin");
    let toml = folder.join("margin.toml");
    let text = endat_config::preset("s6_two_channel").unwrap();
    let parts = "parts = []                      # (default: none)\n# with";
    assert!(text.contains(parts));
    let text = text.replace(parts, "parts = [\"alignment\", \"margin\"]\n# with");
    fs::write(&toml, text).unwrap();
    let port = format!("virtual:{}", toml.display());
    let svg = folder.join("edges.svg");
    let margin = [
        "margin",
        "--frames",
        "30",
        "--json",
        "--svg",
        svg.to_str().unwrap(),
        "--port",
        &port,
    ];
    let outcome = run(&margin);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    let told = json(&outcome);
    let edges: Vec<u64> = told["edges"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| e.as_u64().unwrap())
        .collect();
    assert!(told["frames"].as_u64().unwrap() >= 30 && told["bad_frames"] == 0);
    // Without jitter all edges are within a place of where they are expected; a bit is 32 places.
    assert!(edges[14..=17].iter().sum::<u64>() > 300, "{edges:?}");
    assert_eq!(
        edges[..14].iter().chain(&edges[18..]).sum::<u64>(),
        0,
        "{edges:?}"
    );
    let ns = told["margin_ns"].as_f64().unwrap();
    assert!((130.0..=160.0).contains(&ns), "{ns}");
    assert!(fs::read_to_string(svg).unwrap().contains("sample before"));
    assert_eq!(outcome.messages.len(), 1, "{outcome:?}");
    // Frames that nothing triggers are not waited for.
    let still = fs::read_to_string(&toml).unwrap();
    let line = still.lines().find(|line| line.starts_with("sources = "));
    let still = still.replace(line.unwrap(), "sources = [\"register\"]");
    fs::write(&toml, still).unwrap();
    let outcome = run(&["margin", "--frames", "30", "--port", &port]);
    assert_eq!(outcome.exit_code, 1, "{outcome:?}");
    assert!(
        outcome.messages[0].contains("only trigger_now triggers"),
        "{outcome:?}"
    );
    let none = with(&["margin"], PORT);
    assert_eq!(none.exit_code, 2);
    assert!(none.messages[0].contains("no part `margin`"), "{none:?}");
}

#[test]
fn monitor_shows_rate_health_and_state() {
    // Not the screen, whatever the tests run on.
    for form in ["--plain", "--json"] {
        let outcome = with(
            &["monitor", form, "--count", "3", "--every", "0"],
            service(),
        );
        assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    }
}

#[test]
fn every_name_of_the_map_is_explained() {
    for name in [
        "crc",
        "no_encoder",
        "result0.status",
        "tracked",
        "status.cause",
        "line",
        "2",
    ] {
        let outcome = run(&["explain", name]);
        assert_eq!(outcome.exit_code, 0, "{name}: {outcome:?}");
    }
    for block in endat_regs::BLOCKS {
        for register in block.registers {
            let name = format!("{}.{}", block.name, register.name);
            let text = run(&["explain", &name]).stdout;
            assert!(text.contains(register.meaning), "{name}");
            for field in register.fields {
                let text = run(&["explain", &format!("{name}.{}", field.name)]).stdout;
                assert!(text.contains(field.meaning), "{name}.{}", field.name);
            }
        }
    }
    // Values of a field, too.
    for (name, told) in [
        ("busy_timeout", "request_state.error"),
        ("double_edge", "bit 10"),
    ] {
        assert!(run(&["explain", name]).stdout.contains(told), "{name}");
    }
    // Large letters are the same names; events of the interrupt are told once, behind the block of that name.
    assert_eq!(run(&["explain", "CRC"]), run(&["explain", "crc"]));
    let result = run(&["explain", "result"]).stdout;
    assert!(result.starts_with("block result: "), "{result}");
    assert_eq!(result.matches("interrupt.mask.channel").count(), 1);
    assert!(result.contains("bit 0 of interrupt.mask.channel_<n>: "));
    let unknown = run(&["explain", "crx"]);
    assert_eq!(unknown.exit_code, 2);
    assert!(
        unknown.messages[0].contains("did you mean crc?"),
        "{unknown:?}"
    );
}

/// Nothing would ever come: said at once, and no file is made.
#[test]
fn a_log_without_triggers_is_refused() {
    let folder = tools::folder("log-without-triggers");
    let text = endat_config::preset("s6_two_channel").unwrap();
    let line = text.lines().find(|l| l.starts_with("sources = ")).unwrap();
    let file = folder.join("silent.toml");
    fs::write(&file, text.replacen(line, "sources = []", 1)).unwrap();
    let port = format!("virtual:{}", file.display());
    let out = folder.join("log.csv");
    let outcome = run(&[
        "log",
        "--port",
        &port,
        "--samples",
        "3",
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(outcome.exit_code, 1, "{outcome:?}");
    assert!(
        outcome.messages[0].starts_with("no trigger is enabled"),
        "{outcome:?}"
    );
    assert!(!out.exists());
}

#[test]
fn what_cannot_be_is_told_with_a_remedy() {
    for (arguments, code, told) in [
        (
            &["read", "--port", "virtual:nothing"][..],
            2,
            "virtual:PRESET in --port = nothing: unknown preset; known presets",
        ),
        (&["read", "--port", "/nowhere/ttyX"], 2, "tcp:HOST:PORT"),
        (
            &["read", "--port", "tcp:127.0.0.1:1"],
            2,
            "is `card`, or the serial server, running",
        ),
        (
            &["read", "--port", "virtual", "--baud", "5"],
            2,
            "--baud = 5: outside 300..12000000",
        ),
        (&["read"], 2, "--port <PORT>"),
        (
            &["log", "--port", "virtual", "--samples", "0"],
            2,
            "--samples",
        ),
        (
            &["param", "read", "0x1A1", "0", "--port", "virtual"],
            2,
            "area = 0x1A1: outside 0..255",
        ),
        (&["card", "--tcp", "nowhere"], 2, "give HOST:PORT"),
        (
            &["card", "--encoder", "RCN"],
            2,
            "channel 0 speaks EnDat; the devices there are RCN 8510",
        ),
        (
            &["card", "--encoder", "LC-416"],
            2,
            "has positions of 36 bits, and channel 0 asks for 29; take another one, or a card with \"initialise\"",
        ),
        (&["card", "--cable-m", "-3"], 2, "--cable-m"),
    ] {
        let outcome = run(arguments);
        assert_eq!(outcome.exit_code, code, "{arguments:?}: {outcome:?}");
        assert!(
            outcome.messages.iter().any(|m| m.contains(told)),
            "{arguments:?}: {outcome:?}"
        );
    }
}

/// Catches a sum that overflows: no card has counted so far.
#[test]
fn a_count_that_no_card_has_is_refused_with_its_line() {
    let folder = tools::folder("host_strange");
    let file = folder.join("strange.csv");
    let head = "trigger,time_s,missing,ch0_raw,ch0_deg,ch0_turns,ch0_fresh,ch0_cause";
    for (missing, exit_code) in [(u64::from(u32::MAX), 0), (1 << 32, 2), (u64::MAX, 2)] {
        let row = |n: u64, trigger: u64| format!("{trigger},{n}000,{missing},5,0.1,0,1,none\n");
        let text = format!("{head}\n{}{}", row(1, 1), row(2, missing.saturating_add(2)));
        fs::write(&file, text).unwrap();
        let name = file.to_str().unwrap();
        for command in ["stats", "plot"] {
            let outcome = run(&[command, name]);
            assert_eq!(outcome.exit_code, exit_code, "{missing}: {outcome:?}");
            if exit_code != 0 {
                let told = format!(":2: missing = {missing}: a card counts triggers up to");
                assert!(outcome.messages[0].contains(&told), "{outcome:?}");
            }
        }
    }
}

/// Catches a text that takes every channel but T-format for EnDat.
#[test]
fn id_names_the_protocol_of_each_encoder() {
    let port = ["--port", "virtual:ssi_two_channel"];
    let told = run(&[&["id"], &port[..]].concat());
    assert_eq!(told.exit_code, 0, "{told:?}");
    let plate = "type              SSI, which has no name plate";
    assert_eq!(told.stdout.matches(plate).count(), 2, "{}", told.stdout);
    assert!(!told.stdout.contains("EnDat"), "{}", told.stdout);
    let json = run(&[&["id", "--json"], &port[..]].concat()).stdout;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["encoders"][1]["protocol"], "ssi");
}

/// Catches a virtual encoder whose upper bits count revolutions and whose name plate says singleturn.
#[test]
fn id_calls_a_37_bit_encoder_multiturn() {
    let text = fs::read_to_string(super::quicker_service_file()).unwrap();
    let text = text.replace("position_bits = 29", "position_bits = 37");
    // No device by its name; the width alone decides in channel 0.
    let text = text.replace("encoder = \"RCN 8510\"", "");
    let text = text.replacen("multi_turn_bits = 0", "", 1);
    let text = text.replacen("multi_turn_bits = 0", "multi_turn_bits = 14", 1);
    let file = tools::folder("id_multiturn").join("card.toml");
    fs::write(&file, text).unwrap();
    let port = format!("virtual:{}", file.display());
    let told = run(&["id", "--port", &port]);
    assert_eq!(told.exit_code, 0, "{told:?}");
    for (line, count) in [
        ("position          37 bits\n", 2),
        ("revolutions       4096\n", 1),
        ("revolutions       16384\n", 1),
        ("singleturn", 0),
    ] {
        assert_eq!(told.stdout.matches(line).count(), count, "{line}: {told:?}");
    }
}
