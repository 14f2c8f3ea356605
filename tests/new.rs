//! `new`: questions, and the configurations that come of them.

use crate::program::{bad, good, program, run, Dir};
use endat_config::board::{self, Board};
use endat_config::json_schema::plain;
use endat_config::keys::{self, ENDAT_FORM, KEYS, RECEIVER_FORM, TABLES};
use endat_config::{parse, parse_any, parse_on, Configuration};
use endat_terminal::outcome::Outcome;
use std::collections::BTreeMap;
use std::io::Write;
use std::process::{Output, Stdio};

/// The program with these lines on standard input.
fn asked(dir: &Dir, arguments: &[&str], lines: &str) -> Output {
    let mut child = program()
        .current_dir(&dir.0)
        .arg("new")
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    stdin.write_all(lines.as_bytes()).unwrap();
    drop(stdin);
    child.wait_with_output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Boards with fewer free pins than the parallel bus has signals.
const WITH_FEW_PINS: [&str; 2] = ["icebreaker", "tang_nano_9k"];

/// Every way through the questions that asks something else.
fn ways() -> Vec<Vec<String>> {
    let mut ways = Vec::new();
    for protocol in ["endat", "t_format", "ssi"] {
        for bus in [
            "uart", "apb", "wishbone", "axi_lite", "spi", "parallel", "none", "dsp",
        ] {
            let boards = match bus {
                "uart" | "spi" | "parallel" => [vec!["none"], board::names()].concat(),
                _ => vec![""],
            };
            let has_pins = |board: &&&str| bus != "parallel" || !WITH_FEW_PINS.contains(board);
            for board in boards
                .iter()
                .filter(|_| protocol == "t_format" || bus != "dsp")
                .filter(has_pins)
            {
                let mut way = vec![
                    "--protocol".into(),
                    protocol.into(),
                    "--bus".into(),
                    bus.into(),
                ];
                if !board.is_empty() {
                    way.extend(["--board".into(), board.to_string()]);
                }
                ways.push(way);
            }
        }
    }
    ways
}

/// Catches a usual answer that does not go with those before it.
#[test]
fn every_way_through_the_questions_gives_a_good_configuration() {
    for way in ways() {
        let words: Vec<&str> = way.iter().map(String::as_str).collect();
        let text = good(&[&["new", "--yes", "-"], &words[..]].concat());
        let read =
            parse_any("new.toml", &text).unwrap_or_else(|e| panic!("{way:?}: {e:?}\n{text}"));
        if let Configuration::Card(card) = &read {
            let board = way
                .iter()
                .position(|w| w == "--board")
                .map(|at| &way[at + 1]);
            let board = board.filter(|b| *b != "none");
            assert_eq!(card.board.as_ref().map(|b| &b.name), board, "{way:?}");
        }
        // What counts without a key changes nothing where it is written.
        let lines: Vec<&str> = text.lines().collect();
        // None at the top of the file.
        let mut table = None;
        for (n, line) in lines.iter().enumerate() {
            let plain = line.trim_start_matches("# ");
            let head = plain.trim_start_matches('[');
            if head.len() < plain.len()
                && head.starts_with(char::is_alphabetic)
                && head.contains(']')
            {
                table = Some(n);
            }
            let said = line
                .strip_prefix("# ")
                .filter(|l| l.contains(" = ") && !l.ends_with("..."));
            let Some(said) = said.filter(|l| l.split(' ').nth(1) == Some("=")) else {
                continue;
            };
            let about = lines[..n].iter().rev().take_while(|l| !l.contains(" = "));
            if about.clone().any(|l| l.contains("; takes ")) {
                continue;
            }
            let mut changed: Vec<&str> = lines.clone();
            changed[n] = said;
            if let Some(table) = table {
                changed[table] = changed[table].trim_start_matches("# ");
            }
            // A trigger of its own is logic of its own, whatever is said of it.
            let is_own = ["enabled", "divider"].contains(&said.split(' ').next().unwrap());
            let is_own = is_own
                || table.is_some_and(|n| lines[n].starts_with("[[")) && said.starts_with("sources");
            let with = parse_any("new.toml", &(changed.join("\n") + "\n"));
            let with = with.unwrap_or_else(|wrong| panic!("{way:?}: {said}: {wrong:?}"));
            let hash = |c: &Configuration| match c {
                Configuration::Card(card) => card.hash.clone(),
                Configuration::Receiver(receiver) => receiver.hash.clone(),
            };
            assert!(is_own || hash(&with) == hash(&read), "{way:?}: {said}");
        }
    }
}

/// Catches comments that are not those of the table of keys.
#[test]
fn every_key_is_there_with_what_the_table_of_keys_says() {
    let joined = |text: &str| {
        let words = text.split_whitespace().filter(|word| *word != "#");
        words.collect::<Vec<_>>().join(" ")
    };
    // Each bus that takes a key of its own.
    let cards = ["uart", "spi", "apb"].map(|bus| good(&["new", "--yes", "--bus", bus, "-"]));
    let card = joined(&cards.concat());
    let receiver = joined(&good(&["new", "--yes", "--bus", "dsp", "-"]));
    for key in KEYS {
        let told = joined(&plain(&format!("{}: {}", key.meaning, key.may_be(""))));
        let is_here = [(&card, ENDAT_FORM), (&receiver, RECEIVER_FORM)]
            .map(|(text, form)| (text, key.forms & form != 0));
        for (text, is_here) in is_here {
            assert_eq!(text.contains(&told), is_here, "{}: {told}", key.name);
        }
    }
    for (table, meaning) in TABLES {
        assert!(card.contains(&plain(meaning)), "{table}");
    }
}

#[test]
fn answers_come_from_standard_input_and_wrong_ones_are_asked_for_again() {
    let dir = Dir::new("new");
    // Protocol, bus, board, name, clock, channels, encoder, bits, those of angle and turns, command, EnDat clock, cable, rate, triggers, service, baud, reads.
    let lines =
        "\nuart\nulx3s\n2cards\nmine\n0\n\n2\nROD 1\n99\n37\n\n38\n12\n000111\n4000000\nlong\n50\n\ntimre\ntimer, register\ninitialise\nrequests,initialise\n\n\n";
    let output = asked(&dir, &[], lines);
    let told = text(&output.stderr);
    assert!(output.status.success(), "{told}");
    for wrong in [
        "name = \"2cards\": ",
        "clock.system_hz = 0: outside ",
        "channel.position_bits = 99: outside 1..48",
        "channel.multi_turn_bits = 38: ",
        "endat.cable_m = long: is not a number from 0 to ",
        "unknown trigger; use pin, timer, register",
        "service.parts = \"initialise\": every other part takes requests",
        "several with commas, or none",
    ] {
        assert!(told.contains(wrong), "{wrong}: {told}");
    }
    let next = text(&output.stdout);
    assert!(next.contains("mine.toml: written"), "{next}");
    assert!(next.contains("endat-gen emit --config mine.toml"), "{next}");
    let path = dir.path("mine.toml");
    let card = endat_config::load_file(path.as_ref()).unwrap();
    assert_eq!(card.card.channels.len(), 2);
    assert_eq!(card.encoders, ["ROD 1", "ROD 1"]);
    assert_eq!(card.card.channels[1].spec.clock_hz, 4_000_000);
    assert_eq!(card.card.channels[1].turn_bits(), Some([25, 12]));
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(
        written.contains("\nsources = [\"timer\", \"register\"]\n"),
        "{written}"
    );
    assert!(
        written.contains("\nparts = [\"requests\", \"initialise\"]\n"),
        "{written}"
    );
    let plain = good(&["new", "--yes", "--trigger-sources", "none", "-"]);
    assert!(plain.contains("\nsources = []\n"), "{plain}");
    // Who wants none of it gets a card without a service.
    assert!(plain.contains("\nparts = []\n"), "{plain}");
    // Not a word of warning.
    let out = dir.path("out");
    assert!(good(&["emit", "--config", &path, "--out", &out]).contains("mine_top.v"));
}

/// Catches a file that is lost, and half a dialog that is taken for a whole one.
#[test]
fn no_file_is_replaced_and_no_answer_is_made_up() {
    let dir = Dir::new("new-again");
    let path = dir.write("card.toml", b"mine");
    let new = ["new", "--yes", &path];
    assert!(bad(&new, 2).contains("is there already"));
    assert_eq!(std::fs::read(&path).unwrap(), b"mine");
    good(&[&new[..], &["--force"]].concat());
    assert_ne!(std::fs::read(&path).unwrap(), b"mine");
    let output = asked(&dir, &["half.toml"], "endat\n");
    assert_eq!(output.status.code(), Some(2));
    let told = text(&output.stderr);
    assert!(
        told.contains("bus: has no answer: standard input is at its end"),
        "{told}"
    );
    assert!(!dir.0.join("half.toml").exists());
    // What an option says is not asked for, and what goes with nothing is refused.
    let output = asked(&dir, &["--bus", "dsp", "-"], "\nfast\n\n5000000\n");
    assert!(
        text(&output.stdout).contains("bit_hz = 5_000_000"),
        "{output:?}"
    );
    let told = bad(&["new", "--yes", "--bus", "apb", "--baud", "9600"], 2);
    assert!(
        told.contains("--baud = 9600: a card with protocol endat and bus apb has no such key; leave --baud out"),
        "{told}"
    );
    for (option, value) in [
        ("--position-bits", "-1"),
        ("--channels", "9"),
        ("--board", "x"),
        ("--bus", "usb"),
    ] {
        let told = bad(&["new", "--yes", option, value], 2);
        assert!(told.contains(value), "{told}");
    }
    let nowhere = dir.path("no/folder.toml");
    assert!(bad(&["new", "--yes", &nowhere], 2).contains("in a folder that is there"));
    assert_eq!(run(&["new", "--yes", &path, "--name", "a\"b"]).exit_code, 2);
}

/// Catches an SSI encoder that `new` cannot describe, and a complaint about a key that stands elsewhere.
#[test]
fn what_the_data_sheet_of_an_ssi_encoder_says_is_asked_for() {
    let new = |protocol: &str, more: &[&str]| {
        let first = ["new", "-", "--yes", "--protocol", protocol];
        run(&[&first[..], more].concat())
    };
    let given = [
        ["--code", "gray"],
        ["--parity", "even"],
        ["--bits-before", "ignored, shown"],
        ["--bits-after", "power_fail"],
        ["--twice", "true"],
    ]
    .concat();
    let made = new("ssi", &given).stdout;
    for line in [
        "code = \"gray\"",
        "parity = \"even\"",
        "bits_before = [\"ignored\", \"shown\"]",
        "bits_after = [\"power_fail\"]",
        "twice = true",
        "end_low = true",
    ] {
        assert!(made.contains(&format!("\n{line}\n")), "{line}: {made}");
    }
    // The bits that the angle leaves count turns, so that either may be answered first.
    for turns in [
        &["--single-turn-bits", "12"][..],
        &["--multi-turn-bits", "12"],
    ] {
        let made = new("ssi", &[&["--position-bits", "24"], turns].concat());
        let card = parse("new.toml", &made.stdout).unwrap().card;
        let bits = card.channels.iter().map(|c| c.turn_bits());
        assert!(bits.eq([Some([12, 12]), Some([12, 12])]), "{made:?}");
    }
    for (protocol, option, value, told) in [
        ("ssi", "--twice", "yes", "channel.twice = yes: is neither"),
        ("ssi", "--clock-hz", "1", "channel.clock_hz = 1: "),
        ("endat", "--clock-hz", "1", "endat.clock_hz = 1: "),
        (
            "t_format",
            "--multi-turn-bits",
            "16",
            "give --single-turn-bits, too",
        ),
    ] {
        let refused = new(protocol, &[option, value]);
        assert_eq!(refused.exit_code, 2, "{refused:?}");
        assert!(refused.messages[0].contains(told), "{refused:?}");
    }
}

/// The values that a remedy such as `use --board none, arty, or --bus uart` names for each option.
fn remedies(told: &str) -> Vec<(&str, Vec<&str>)> {
    let (_, remedy) = told.rsplit_once("; use ").expect(told);
    let options = remedy.split(", or ");
    let split = options.map(|one| one.split_once(' ').expect(told));
    split
        .map(|(o, values)| (o, values.split(", ").collect()))
        .collect()
}

/// Catches a key that a remedy names and `new` asks of another protocol only.
#[test]
fn recovery_time_is_taken_for_endat_too() {
    let fast = [
        "new",
        "-",
        "--yes",
        "--sample-hz",
        "20000",
        "--position-bits",
        "48",
    ];
    let told = bad(&fast, 2);
    assert!(told.contains("--recovery-max-ns"), "{told}");
    let text = good(&[&fast[..], &["--recovery-max-ns", "10500"]].concat());
    assert!(
        text.contains("\nrecovery_max_ns = 10500\n")
            || text.contains("\nrecovery_max_ns = 10_500\n"),
        "{text}"
    );
}

/// Catches a board that the help offers and the command refuses, and a remedy that it refuses again.
#[test]
fn board_goes_with_every_bus_or_the_error_names_what_goes() {
    let new = |bus: &str, board: &str, more: &[&str]| {
        let first = ["new", "-", "--yes", "--bus", bus, "--board", board];
        run(&[&first[..], more].concat())
    };
    let buses = keys::BUS.words();
    let boards = [vec!["none"], board::names()].concat();
    let mut all: BTreeMap<(String, &str), Outcome> = BTreeMap::new();
    for bus in &buses {
        all.extend(boards.iter().map(|b| ((bus.clone(), *b), new(bus, b, &[]))));
    }
    let is_good = |bus: &str, board: &str| all[&(bus.to_owned(), board)].exit_code == 0;
    for ((bus, board), made) in &all {
        let wanted = Some(*board).filter(|board| *board != "none");
        if made.exit_code == 0 {
            let read = parse_any("new.toml", &made.stdout).unwrap();
            let Configuration::Card(card) = read else {
                assert_eq!(wanted, None, "{bus}");
                continue;
            };
            let found = card.board.as_ref().map(|board| board.name.as_str());
            assert_eq!(found, wanted, "{bus}");
            continue;
        }
        let told = made.messages.join("\n");
        let options = remedies(&told);
        // None of them goes with a board inside a chip; the parallel bus has many signals.
        let least = if bus == "parallel" { (8, 2) } else { (1, 2) };
        let count = |option: &str| {
            let found = options.iter().find(|(name, _)| *name == option);
            found.map_or(0, |(_, values)| values.len())
        };
        assert!((count("--board"), count("--bus")) >= least, "{told}");
        for (option, values) in &options {
            for value in values {
                match *option {
                    "--board" => assert!(is_good(bus, value), "{board}: {told}"),
                    "--bus" => assert!(is_good(value, board), "{board}: {told}"),
                    option => panic!("{option}: {told}"),
                }
            }
        }
    }
    let refused = |board: &&str| !is_good("parallel", board);
    let refused: Vec<&str> = boards.iter().copied().filter(refused).collect();
    assert_eq!(refused, WITH_FEW_PINS);
    // More channels than the board has pins for.
    let told = new("parallel", "ulx3s", &["--channels", "8"])
        .messages
        .join("\n");
    let options = remedies(&told);
    let (last, values) = options.last().unwrap();
    assert_eq!((*last, &values[..]), ("--channels", &["7"][..]), "{told}");
    let made = new("parallel", "ulx3s", &["--channels", "7"]);
    assert_eq!(made.exit_code, 0, "{made:?}");
}

/// Catches a remedy that names a table of the file, which is not written yet, and an empty answer that is taken for none.
#[test]
fn number_of_channels_and_empty_answers_name_options() {
    let more = ["new", "-", "--yes", "--bus", "none", "--channels"];
    let told = bad(&[&more[..], &["2"]].concat(), 2);
    assert!(
        told.starts_with("--channels = 2: ") && told.contains("--channels 1"),
        "{told}"
    );
    good(&[&more[..], &["1"]].concat());
    let told = remedies(&told);
    let (_, buses) = told.iter().find(|(option, _)| *option == "--bus").unwrap();
    for bus in buses {
        good(&["new", "-", "--yes", "--bus", bus, "--channels", "2"]);
    }
    for option in ["protocol", "bus", "board", "name", "clock-hz", "parity"] {
        let option = format!("--{option}");
        let protocol = if option == "--parity" { "ssi" } else { "endat" };
        let new = |value: Option<&str>| {
            let mut all = vec!["new", "-", "--yes"];
            if option != "--protocol" {
                all.extend(["--protocol", protocol]);
            }
            all.extend(value.into_iter().flat_map(|value| [&*option, value]));
            run(&all)
        };
        let refused = new(Some("")).messages.join("\n");
        let told = refused.strip_prefix(&format!("{option} = \"\": is empty; give {option} "));
        let told = told.and_then(|rest| rest.strip_suffix(&format!(", or leave {option} out")));
        let value = told.unwrap_or_else(|| panic!("{refused}"));
        for value in [Some(value), None] {
            assert_eq!(new(value).exit_code, 0, "{option} {value:?}");
        }
    }
}

/// Catches pins of `new` that the board does not have, and a board of the command line that has too few without a remedy.
#[test]
fn emit_takes_free_pins_from_new() {
    let dir = Dir::new("new-pins");
    let (path, out) = (dir.path("card.toml"), dir.path("out"));
    let new = ["new", "--yes", "--bus", "parallel", "--board"];
    good(&[&new[..], &["zybo_z7_10", &path]].concat());
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(
        text.contains("check each of\n# them against your wiring"),
        "{text}"
    );
    assert_eq!(text.matches("\nbus_").count(), 22, "{text}");
    let emit = ["emit", "--config", &path, "--out", &out];
    assert!(good(&emit).contains("my_card.xdc"));
    // The same without those pins, on a board of the command line.
    let (text, _) = text.split_once("\n[board]").unwrap();
    let text = text.replace("system_hz = 100_000_000", "system_hz = 24_000_000");
    let text = text.replace("clock_hz = 3_125_000", "clock_hz = 3_000_000");
    std::fs::write(&path, &text).unwrap();
    let told = bad(&[&emit[..], &["--board", "icebreaker"]].concat(), 2);
    assert!(
        told.contains("--board = icebreaker: has 14 free pins for 22 signals without a usual pin, 8 too few; use one of "),
        "{told}"
    );
    let (_, boards) = told.trim().rsplit_once("; use one of ").unwrap();
    for board in boards.split(", ") {
        let board = Board::named(board).unwrap();
        // The pins that the messages name, if the board has no usual ones.
        let told = parse_on("card.toml", &text, Some(&board))
            .err()
            .unwrap_or_default();
        let pins = told
            .iter()
            .map(|one| one.text.split('`').nth(1).expect(&one.text));
        let text = format!("{text}[pins]\n{}\n", pins.collect::<Vec<_>>().join("\n"));
        let read = parse_on("card.toml", &text, Some(&board));
        assert!(read.is_ok(), "{}: {read:?}", board.name);
    }
}

/// Catches a clock that the help offers and the command refuses, and a remedy that is no option of it.
#[test]
fn slow_and_fast_ssi_clocks_give_a_file_or_a_remedy_that_is_an_option() {
    let new = |more: &[&str]| {
        let first = ["new", "-", "--yes", "--protocol", "ssi"];
        run(&[&first[..], &["--position-bits", "12"], more].concat())
    };
    for hz in ["80_000", "100000", "125000", "133333", "1000000"] {
        let made = new(&["--clock-hz", hz]);
        assert_eq!(made.exit_code, 0, "{hz}: {made:?}");
        parse_any("new.toml", &made.stdout).unwrap_or_else(|e| panic!("{hz}: {e:?}"));
    }
    let made = new(&[
        "--clock-hz",
        "100000",
        "--recovery-min-ns",
        "16000",
        "--recovery-max-ns",
        "40000",
    ]);
    assert!(
        made.stdout.contains("\nrecovery_min_ns = 16_000\n"),
        "{made:?}"
    );
    assert!(
        made.stdout.contains("\nrecovery_max_ns = 40_000\n"),
        "{made:?}"
    );
    let refused = new(&["--clock-hz", "4000000", "--cable-m", "2"]);
    let told = refused.messages.join("\n");
    assert!(
        told.ends_with("or lower --bit-delay-ns to 170, if that is the encoder's"),
        "{told}"
    );
    let made = new(&[
        "--clock-hz",
        "4000000",
        "--cable-m",
        "2",
        "--bit-delay-ns",
        "170",
    ]);
    assert!(made.stdout.contains("\nbit_delay_ns = 170\n"), "{made:?}");
    let refused = new(&["--clock-hz", "100000", "--recovery-min-ns", "10000"]);
    let told = refused.messages.join("\n");
    assert!(told.contains("raise --recovery-min-ns to 15000"), "{told}");
}
