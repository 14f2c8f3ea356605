//! Positions counted on over turns, and over the end of what the encoder counts, with the range that configuration, name plate or user gives.

mod drivers;

use crate::desk::Desk;
use crate::program::{bad, good, run, Dir};
use endat_card::VirtualConfig;
use endat_config::{parse, preset, Project};
use endat_host::feed::{Feed, Row};
use endat_host::range::Ranges;
use endat_host::units::Scale;
use endat_recording::derive::Derivation;
use std::collections::VecDeque;
use std::fs;
use std::time::Duration;

/// A card with a T-format encoder of 17 bits and an SSI encoder, without ranges.
const CARD: &str = include_str!("../data/t_format_turns/card.toml");
const SAMPLE_HZ: f64 = 2_000.0;
/// Turns in a second: a tenth of a turn from one sample to the next.
const SPEED: f64 = 200.0;

/// The card with a faster timer and these lines in its channels.
fn card(t_format: &str, ssi: &str) -> Project {
    let mut text = CARD.replacen("sample_hz = 500", "sample_hz = 2_000", 1);
    for (key, more) in [("request = 3", t_format), ("position_bits = 17", ssi)] {
        assert!(text.contains(key), "{text}");
        text = text.replacen(key, &format!("{key}\n{more}"), 1);
    }
    let text = text.replace("position_bits = 17\nposition_bits", "position_bits");
    parse("card.toml", &text).unwrap()
}

/// The first rows of a card, and its scales.
fn recorded(project: &Project, speed: f64, count: usize, said: &[&str]) -> (Vec<Scale>, Vec<Row>) {
    let config = VirtualConfig {
        speed,
        ..VirtualConfig::default()
    };
    let mut desk = Desk::new(project, &config);
    let said: Vec<String> = said.iter().map(|text| (*text).to_owned()).collect();
    desk.card.set_ranges(Ranges::parse(&said).unwrap()).unwrap();
    let scales = desk.card.scales().unwrap();
    let mut feed = Feed::begin(&mut desk.card, false).unwrap();
    let mut rows = VecDeque::new();
    while rows.len() < count {
        feed.fill(&mut desk.card, &mut rows, Duration::from_millis(1))
            .unwrap();
    }
    (scales, rows.into())
}

/// A calculated column of these rows.
fn column(spec: &str, scales: &[Scale], rows: &[Row]) -> Vec<f64> {
    let mut all = Derivation::parse(&[spec.to_owned()], scales, &[]).unwrap();
    let values = rows.iter().map(|row| {
        let time_s = row.cycles as f64 / 20e6;
        all.values(row, time_s)[0]
    });
    values.flatten().collect()
}

/// Positions of a channel as they were sent.
fn raw(channel: usize, rows: &[Row]) -> Vec<u64> {
    let cells = rows.iter().map(|row| &row.cells[channel]);
    let fresh = cells.filter(|cell| cell.fresh);
    fresh.filter_map(|cell| cell.position).collect()
}

/// Checks that a shaft that turns evenly goes on evenly, by degrees in a row.
fn assert_even(unwrapped: &[f64], degrees: f64, what: &str) {
    assert!(unwrapped.len() > 10, "{what}: {unwrapped:?}");
    for pair in unwrapped.windows(2) {
        let rows = ((pair[1] - pair[0]) / degrees).round();
        let off = pair[1] - pair[0] - rows * degrees;
        // Rows of a card that is read one by one may be missing.
        assert!(
            (1.0..4.0).contains(&rows) && off.abs() < 0.2 * degrees.abs(),
            "{what}: {pair:?}"
        );
    }
}

#[test]
fn t_format_turns_of_17_bits_are_counted_on_over_each_wrap() {
    let per_row = SPEED / SAMPLE_HZ * 360.0;
    let known = card("single_turn_bits = 17\nmulti_turn_bits = 16", "");
    let unknown = card("", "");
    // The option serves a card that does not know it.
    for (project, said) in [(&known, &[][..]), (&unknown, &["0=17+16"][..])] {
        for speed in [SPEED, -SPEED] {
            let (scales, rows) = recorded(project, speed, 40, said);
            assert_eq!(scales[0], Scale::of_bits(17, 16, Some(24)));
            let sent = raw(0, &rows);
            let turns = sent.windows(2).filter(|p| p[0] >> 24 != p[1] >> 24);
            assert!(turns.count() >= 2, "{sent:x?}");
            assert!(sent.iter().all(|position| position & 0xFE_0000 == 0));
            let unwrapped = column("t=0:unwrap:zero", &scales, &rows);
            assert_even(
                &unwrapped,
                per_row * speed.signum(),
                &format!("{speed} {said:?}"),
            );
            let velocity = column("v=0:unwrap:velocity", &scales, &rows);
            let wanted = 360.0 * speed;
            let is_near = |v: &f64| (v - wanted).abs() < 0.25 * wanted.abs();
            assert!(velocity.iter().all(is_near), "{velocity:?}");
        }
    }
}

/// Turns of 13 bits, three bits that count them: positions wrap after eight turns.
#[test]
fn ssi_positions_are_counted_on_over_turns_and_over_the_last_of_them() {
    let project = card(
        "",
        "position_bits = 16\nsingle_turn_bits = 13\nmulti_turn_bits = 3",
    );
    let (scales, rows) = recorded(&project, SPEED, 90, &[]);
    let sent = raw(1, &rows);
    let wraps = sent.windows(2).filter(|p| p[1] < p[0]);
    assert!(wraps.count() >= 1, "{sent:x?}");
    // The second shaft is half as fast again.
    let per_row = 1.5 * SPEED / SAMPLE_HZ * 360.0;
    assert_even(&column("t=1:unwrap", &scales, &rows), per_row, "13+3");
    assert_eq!(scales[1], Scale::of_bits(13, 3, None));
}

#[test]
fn a_linear_ssi_encoder_never_wraps() {
    let project = card("", "linear = true");
    let (scales, rows) = recorded(&project, SPEED, 30, &[]);
    assert_eq!(scales[1], Scale::Counted);
    let sent: Vec<f64> = raw(1, &rows).iter().map(|p| *p as f64).collect();
    assert_eq!(column("t=1:unwrap", &scales, &rows), sent);
    let [least, most] = [f64::min, f64::max].map(|of| sent.iter().copied().fold(sent[0], of));
    assert!(most - least > 10_000.0, "{sent:?}");
}

/// A card that asks the encoder for nothing: its configuration says that 12 of 37 bits count turns.
#[test]
fn endat_turns_are_counted_on_without_a_name_plate() {
    let text = CARD.replacen("sample_hz = 500", "sample_hz = 2_000", 1);
    let begin = text.find("[[channel]]").unwrap();
    let end = text.find("[board]").unwrap();
    let channel = "[[channel]]\nclock_hz = 2_000_000\nfilter_ns = 50\nstart_window_ns = 100\nposition_bits = 37\nsingle_turn_bits = 25\nmulti_turn_bits = 12\ncommand = \"111000\"\n";
    let text = text[..begin].to_owned() + channel + &text[end..];
    let project = parse("endat.toml", &text).unwrap();
    let (scales, rows) = recorded(&project, SPEED, 40, &[]);
    assert_eq!(scales, [Scale::of_bits(25, 12, None)]);
    let sent = raw(0, &rows);
    assert!(
        sent.windows(2).any(|p| p[0] >> 25 != p[1] >> 25),
        "{sent:x?}"
    );
    let per_row = SPEED / SAMPLE_HZ * 360.0;
    // The first frame measures the delay, and comes late.
    assert_even(&column("t=0:unwrap", &scales, &rows[1..]), per_row, "25+12");
}

/// Catches a remedy that the command itself refuses, and figures of positions that nobody explains.
#[test]
fn what_counts_turns_is_refused_until_somebody_says_what_a_turn_is() {
    let dir = Dir::new("turns");
    let file = dir.write(
        "card.toml",
        CARD.replace("sample_hz = 500", "sample_hz = 2_000")
            .as_bytes(),
    );
    let port = format!("virtual:{file}");
    let csv = dir.path("r.csv");
    let log = [
        "log",
        "--port",
        &port,
        "--samples",
        "120",
        "--force",
        "--out",
        &csv,
    ];
    for derive in ["t=0:unwrap", "v=1:velocity"] {
        let asked = [&log[..], &["--derive", derive]].concat();
        let told = bad(&asked, 2);
        let channel = &derive[2..3];
        let remedy = format!("--range {channel}=SINGLE+MULTI");
        assert!(
            told.contains(&format!("--derive = {derive}: ")) && told.contains(&remedy),
            "{told}"
        );
        assert!(!fs::exists(&csv).unwrap());
        let range = if channel == "0" {
            "0=17+16"
        } else {
            "1=linear"
        };
        let given = run(&[&asked[..], &["--range", range]].concat());
        assert_eq!(given.exit_code, 0, "{given:?}");
        fs::remove_file(&csv).unwrap();
    }
    for about in [&[][..], &["--about"]] {
        assert_eq!(run(&[&log[..], about].concat()).exit_code, 0);
        let json = |more: &[&str]| {
            let told = run(&[&["stats", "--json", &csv], more].concat());
            assert_eq!(told.exit_code, 0, "{told:?}");
            serde_json::from_str::<serde_json::Value>(&told.stdout).unwrap()["channels"][0].clone()
        };
        let unknown = json(&[]);
        assert!(
            unknown["drift_per_s"].is_null() && unknown["noise"].is_null(),
            "{unknown}"
        );
        assert_eq!(unknown["unit"], "counts");
        let text = run(&["stats", &csv]);
        assert!(
            text.stdout
                .contains("drift, noise      not known: see --range"),
            "{}",
            text.stdout
        );
        let remedies = text.messages.iter().filter(|m| m.contains("give --range "));
        assert_eq!(remedies.count(), 2, "{text:?}");
        let known = json(&["--range", "0=17+16"]);
        // A quarter of a turn in a second.
        let drift = known["drift_per_s"].as_f64().unwrap();
        assert!(
            known["unit"] == "deg" && (drift - 90.0).abs() < 1.0,
            "{known}"
        );
        assert!(known["noise"].as_f64().unwrap() < 0.01, "{known}");
        // Fewer bits than the encoder has are none.
        let told = bad(&["stats", &csv, "--range", "0=12+16"], 2);
        assert!(
            told.contains("ch0_raw = ") && told.contains("--range"),
            "{told}"
        );
        let drawing = dir.path("r.svg");
        let told = bad(&["plot", &csv, "-o", &drawing, "--velocity"], 2);
        assert!(
            told.contains("--velocity: ") && told.contains("--range 0="),
            "{told}"
        );
        let both = ["--range", "0=17+16", "--range", "1=linear"];
        let plot = [&["plot", &csv, "-o", &drawing, "--velocity"], &both[..]].concat();
        assert_eq!(run(&plot).exit_code, 0);
        fs::remove_file(drawing).unwrap();
    }
    let read = good(&["read", "--port", &port, "--range", "0=17+16"]);
    assert!(read.contains(" deg + 100 turns"), "{read}");
    let told = bad(&["read", "--port", &port, "--range", "2=17"], 2);
    assert!(
        told.contains("--range = 2: the card has no such channel"),
        "{told}"
    );
    let told = bad(&["read", "--port", &port, "--range", "1=12+13"], 2);
    assert!(
        told.contains("--range = 1=12+13: is 25 bits, and positions of the channel have 17"),
        "{told}"
    );
}

/// Catches an encoder of more bits than the range leaves room for, whose angle would be cut.
#[test]
fn positions_that_the_range_has_no_room_for_are_told_and_not_calculated_with() {
    let dir = Dir::new("turns_small");
    let file = dir.write("card.toml", CARD.as_bytes());
    let csv = dir.path("r.csv");
    let port = format!("virtual:{file}");
    let log = ["log", "--port", &port, "--samples", "5", "--out", &csv];
    let small = ["--range", "0=10+16", "--derive", "t=0:unwrap"];
    let told = run(&[&log[..], &small].concat());
    assert_eq!(told.exit_code, 1, "{told:?}");
    let is_it = |m: &String| m.contains("channel 0: 5 positions have bits outside 1024 steps");
    assert!(told.messages.iter().any(is_it), "{told:?}");
    let rows = fs::read_to_string(&csv).unwrap();
    assert!(rows.lines().skip(1).all(|row| row.ends_with(',')), "{rows}");
}

#[test]
fn a_name_plate_that_contradicts_the_configuration_is_told_and_counts() {
    let mut text = preset("s6_two_channel_service").unwrap().to_owned();
    for (from, to) in [
        ("system_hz = 100_000_000", "system_hz = 10_000_000"),
        ("clock_hz = 3_125_000", "clock_hz = 1_000_000"),
        ("filter_ns = 20", "filter_ns = 100"),
        ("start_window_ns = 80", "start_window_ns = 200"),
        ("baud = 3_000_000", "baud = 1_000_000"),
        ("sample_hz = 10_000", "sample_hz = 2_500"),
        ("multi_turn_bits = 0 ", "multi_turn_bits = 1 "),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let project = parse("service.toml", &text).unwrap();
    let mut desk = Desk::new(&project, &VirtualConfig::default());
    assert_eq!(desk.card.scales().unwrap(), [Scale::singleturn(29); 2]);
    let notes = desk.card.scale_notes().unwrap();
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].starts_with("channel 0: the configuration says 268435456 steps a turn and 2 turns, the encoder 536870912 steps a turn and 1 turns"), "{notes:?}");
    // The user knows better than both.
    let said = Ranges::parse(&["0=20+9".to_owned()]).unwrap();
    desk.card.set_ranges(said).unwrap();
    assert_eq!(desk.card.scales().unwrap()[0], Scale::of_bits(20, 9, None));
    assert_eq!(desk.card.scale_notes().unwrap(), [""; 0]);
}

/// The lines of all files, with a mark in the place of each number.
fn without_numbers(project: &Project) -> Vec<(String, Vec<String>)> {
    let plain = |line: &str| {
        let mut plain = String::new();
        for c in line.replace("'h", "'").chars() {
            let c = if c.is_ascii_hexdigit() { '0' } else { c };
            if c != '0' || !plain.ends_with('0') {
                plain.push(c);
            }
        }
        plain
    };
    let is_logic = |path: &str| {
        [".v", ".ucf", ".sdc", ".core"]
            .iter()
            .any(|s| path.ends_with(s))
    };
    let files = endat_emit::emit(project).unwrap().into_iter();
    let files = files.filter(|file| is_logic(&file.path));
    let is_text = |line: &&str| !line.trim_start().starts_with(['/', '#']);
    files
        .map(|file| {
            let lines = file.text.lines().filter(is_text);
            (file.path.clone(), lines.map(plain).collect())
        })
        .collect()
}

/// Catches logic, a port or a line that a range costs.
#[test]
fn a_range_costs_start_values_and_nothing_else() {
    let without = card("", "");
    let with = card(
        "single_turn_bits = 17\nmulti_turn_bits = 16",
        "position_bits = 17\nmulti_turn_bits = 5",
    );
    assert_ne!(without.hash, with.hash);
    let (before, now) = (without_numbers(&without), without_numbers(&with));
    assert_eq!(before.len(), now.len());
    for ((path, before), (_, now)) in before.iter().zip(&now) {
        assert!(before == now, "{path}");
    }
    let start = |project: &Project, channel: usize| {
        endat_hdl::regs::config_words(&project.card, Some(channel))
    };
    let kinds = [0, 1].map(|n| {
        let words = start(&with, n);
        assert_ne!(words, start(&without, n));
        let field = |word: usize, register, field| {
            let field = endat_regs::CHANNEL_CONFIG.field(register, field);
            field.of(words[word])
        };
        [
            field(0, "frame", "position_bits"),
            field(1, "timing", "multi_turn_bits"),
            field(2, "limits", "range"),
        ]
    });
    assert_eq!(kinds, [[33, 16, 1], [17, 5, 1]]);
    // Bits of a card that does not say it are as they have always been.
    for n in [0, 1] {
        let words = start(&without, n);
        assert_eq!((words[1] >> 11 & 31, words[2] >> 12 & 15), (0, 0));
    }
}

#[test]
fn keys_of_a_range_are_refused_with_line_and_remedy() {
    let told = |t_format: &str, ssi: &str| {
        let mut text = CARD.to_owned();
        for (key, more) in [("request = 3", t_format), ("position_bits = 17", ssi)] {
            text = text.replacen(key, &format!("{key}\n{more}"), 1);
        }
        let wrong = parse("card.toml", &text).unwrap_err();
        wrong
            .iter()
            .map(|one| format!("{one}\n"))
            .collect::<String>()
    };
    for (t_format, ssi, is) in [
        ("multi_turn_bits = 16", "", "card.toml:13: channel[0].multi_turn_bits = 16: counts turns of an angle, and nothing says how many bits that has; add, for example, single_turn_bits = 17, or remove it"),
        ("single_turn_bits = 25", "", "card.toml:13: channel[0].single_turn_bits = 25: outside 1..24"),
        ("", "linear = true\nmulti_turn_bits = 3", "channel[1].linear = true: a scale has no turns, and single_turn_bits or multi_turn_bits is there; remove it"),
        ("", "single_turn_bits = 13\nmulti_turn_bits = 5", "channel[1].single_turn_bits = 13: with multi_turn_bits = 5 that is 18 bits, and position_bits = 17; set single_turn_bits to 12, or set multi_turn_bits to 4"),
        ("", "multi_turn_bits = 17", "channel[1].multi_turn_bits = 17: outside 0..16"),
    ] {
        let told = told(t_format, ssi);
        assert!(told.contains(is) && told.lines().count() == 1, "{told}");
    }
}
