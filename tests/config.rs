//! Configuration files: what is refused, where, and with which remedy; and that nothing typed makes it panic.

use endat_config::{parse, Project};
use endat_console::error::Diagnostic;
use proptest::prelude::*;

const PRESET: &str = include_str!("../gen/config/presets/s6_two_channel.toml");

/// The preset without its stream, with one piece of text replaced, and the line of the replacement. What a rate is too fast or a line too
/// slow for is the stream first, which has tests of its own.
fn changed(from: &str, to: &str) -> (String, usize) {
    let text = PRESET.replace("fifo_bytes = 2_048", "fifo_bytes = 0");
    assert_ne!(text, PRESET);
    let at = text
        .find(from)
        .unwrap_or_else(|| panic!("the preset has no {from:?}"));
    let line =
        text[..at].matches('\n').count() + 1 + from.len() - from.trim_start_matches('\n').len();
    (text.replacen(from, to, 1), line)
}

fn refuse(text: &str) -> Vec<Diagnostic> {
    parse("card.toml", text).expect_err("must be refused")
}

#[test]
fn the_preset_gives_the_card_of_the_paper() {
    let project = parse("card.toml", PRESET).unwrap();
    assert_eq!(project.card.channels.len(), 2);
    assert_eq!(project.card.channels[0], project.card.channels[1]);
    assert_eq!(project.card.channels[0].period_cycles, 32);
    assert_eq!(
        project
            .pll
            .as_ref()
            .map(|pll| pll.multiply * 32_000_000 / pll.divide / pll.output_divide),
        Some(100_000_000)
    );
    assert_eq!(project.pins.len(), 1 + 3 + 8 + 3);
    assert_eq!(
        project.card.hash,
        u64::from_str_radix(&project.hash, 16).unwrap()
    );
}

#[test]
fn every_line_of_the_preset_is_explained() {
    for (number, line) in PRESET.lines().enumerate() {
        let heading = line.starts_with('[')
            && line.contains("[clock]") | line.contains("[endat]") | line.contains("[trigger]");
        let heading = heading || line.starts_with("[link]") || line.starts_with("[board]");
        let repeated = [
            "encoder = \"RCN 8510\"",
            "position_bits = 29",
            "command = \"111000\"",
            "multi_turn_bits = 0",
        ]
        .contains(&line);
        assert!(
            line.is_empty() || line.contains('#') || heading || repeated,
            "line {}: {line}",
            number + 1
        );
    }
}

/// Each row: text of the preset, its replacement, what the message about that line must contain.
#[test]
fn one_wrong_line_gives_one_message_about_that_line() {
    let rows = [
        // keys
        ("filter_ns = 20", "fliter_ns = 20", "endat.fliter_ns: unknown key; did you mean filter_ns?"),
        ("baud = ", "colour = 7\nbaud = ", "link.colour: unknown key; known keys here: baud, read_hz"),
        ("name = \"s6", "names = 1\nname = \"s6", "names: unknown key; name is there already, remove this one"),
        ("[board]", "[colour]\nx = 1\n[board]", "colour: unknown key; known keys here: board, channel"),
        ("encoder = ", "phase = 1\nencoder = ", "channel[0].phase: unknown key; it belongs to [line]"),
        ("[board]", "cable_m = 3\n[board]", "cable_m: unknown key; it belongs to [[channel]] or to [endat]"),
        ("[board]", "[host]\ninitial_values = false\n[board]", "host.initial_values: unknown key; it belongs to [device]"),
        ("system_hz = 100", "family = 1\nsystem_hz = 100", "clock.family: unknown key; known keys here: system_hz"),
        ("[trigger]", "[triger]", "triger: unknown key; did you mean trigger?"),
        ("[link]", "[links]", "links: unknown key; did you mean link?"),
        // types
        ("system_hz = 100_000_000", "system_hz = 80 MHz", "write system_hz = 80_000_000"),
        ("system_hz = 100_000_000", "system_hz = \"80 MHz\"", "must be a whole number; write system_hz = 80_000_000"),
        ("system_hz = 100_000_000", "system_hz = \"fast\"", "clock.system_hz = \"fast\": is a string, must be a whole number"),
        ("system_hz = 100_000_000", "system_hz = 1e8", "clock.system_hz = 1e8: is a float, must be a whole number"),
        ("system_hz = 100_000_000", "system_hz = -1", "clock.system_hz = -1: outside 1000000..250000000"),
        ("system_hz = 100_000_000", "system_hz = 99999999999999999999999999999999999999999", "outside 1000000..250000000"),
        ("system_hz = 100_000_000", "system_hz = true", "is a boolean, must be a whole number"),
        ("name = \"s6_two_channel\"", "name = 6", "name = 6: is an integer, must be text in quotes"),
        ("command = \"111000\"", "command = 111000", "channel[0].command = 111000: is an integer, must be text in quotes"),
        ("sources = [\"pin\", \"timer\"]", "sources = \"pin\"", "trigger.sources = \"pin\": is a string, must be a list"),
        ("sources = [\"pin\", \"timer\"]", "sources = [1]", "trigger.sources = 1: is an integer, must be text in quotes"),
        // numbers
        ("system_hz = 100_000_000", "system_hz = 0", "clock.system_hz = 0: outside 1000000..250000000"),
        ("system_hz = 100_000_000", "system_hz = 300_000_000", "outside 1000000..250000000"),
        ("system_hz = 100_000_000", "system_hz = 99_999_999", "the clock manager cannot make it from the board's 32000000 Hz; use 99200000 or 100000000 Hz"),
        ("clock_hz = 3_125_000", "clock_hz = 9_000_000", "endat.clock_hz = 9000000: would become 9090909 Hz (+10101 ppm), more than the allowed 5000 ppm"),
        ("clock_hz = 3_125_000", "clock_hz = 16_000_000", "would become 16666667 Hz (+41667 ppm), more than the allowed 5000 ppm"),
        // 16.67 MHz is above the fastest clock, so it is no advice.
        ("clock_hz = 3_125_000", "clock_hz = 16_000_000", "ppm; use 14285714 Hz, or another system clock"),
        ("clock_hz = 3_125_000", "clock_hz = 99_000", "outside 100000..16000000"),
        ("tst_ns = 2_000", "tst_ns = 400", "endat.tst_ns = 400: neither 0 nor in 500..10000"),
        ("filter_ns = 20", "filter_ns = 1_000", "endat.filter_ns = 1000: is 100 cycles, more than 15"),
        ("start_window_ns = 80", "start_window_ns = 0", "endat.start_window_ns = 0: is 0 cycles, outside 1..16"),
        ("start_window_ns = 80", "start_window_ns = 170", "use 10..160 ns"),
        ("tcal_max_ns = 5_000", "tcal_max_ns = 0", "endat.tcal_max_ns = 0: outside 1..4082800"),
        ("recovery_min_ns = 10_000", "recovery_min_ns = 40_000", "above recovery_max_ns = 30000; lower it to 30000, or raise recovery_max_ns to 40000"),
        ("recovery_min_ns = 10_000", "recovery_min_ns = 100", "outside 1250..80390"),
        ("recovery_max_ns = 30_000", "recovery_max_ns = 4_000_000_000", "outside 1250..80390"),
        ("cable_m = 100", "cable_m = 1_000", "endat.cable_m = 1000: outside 0..780"),
        ("position_bits = 29", "position_bits = 0", "channel[0].position_bits = 0: outside 1..48"),
        ("position_bits = 29", "position_bits = 49", "channel[0].position_bits = 49: outside 1..48"),
        ("position_bits = 29", "position_bits = 29\nclock_hz = 9_000_000", "channel[0].clock_hz = 9000000: would become"),
        ("command = \"111000\"", "command = \"101010\"", "channel[0].command = \"101010\": is not a mode command that a trigger can send"),
        ("command = \"111000\"", "command = \"position\"", "a mode command is six binary digits"),
        ("command = \"111000\"", "command = \"\"", "a mode command is six binary digits"),
        ("command = \"111000\"", "command = \"0000111\"", "a mode command is six binary digits"),
        ("sample_hz = 10_000", "sample_hz = 0", "trigger.sample_hz = 0: outside 6..1000000"),
        ("sample_hz = 10_000", "sample_hz = 25_000", "takes up to 49.07 us, the largest part from recovery_max_ns = 30000, so at most 20379 Hz"),
        ("[\"pin\", \"timer\"]", "[\"pin\", \"button\"]", "trigger.sources = \"button\": unknown trigger; use pin, timer, register"),
        ("[\"pin\", \"timer\"]", "[\"pin\", \"pin\"]", "trigger.sources = \"pin\": stands twice"),
        ("baud = 3_000_000", "baud = 9_000", "link.baud = 9000: outside 9600..3000000 (the fastest rate that the board passes on"),
        ("baud = 3_000_000", "baud = 115_200", "the link is too slow: reading 62 bytes 1000 times a second takes 620000 bit/s"),
        ("baud = 3_000_000", "baud = 4_000_000", "link.baud = 4000000: outside 9600..3000000"),
        ("read_hz = 1_000", "read_hz = 0", "link.read_hz = 0: outside 1..1000000"),
        // line
        ("[stream]", "samples = 3\n[stream]", "line.samples = 3: takes the part alignment; add it to line.parts"),
        ("[stream]", "phase = \"frame\"\n[stream]", "line.phase = \"frame\": takes the part alignment"),
        ("parts = []                      # (default: none)\n# with", "parts = [\"alignment\"]\nphase = \"mean\"\n# with", "line.phase = \"mean\": unknown; use tracked, frame, fixed"),
        ("parts = []                      # (default: none)\n# with", "parts = [\"alignment\"]\nphase = \"fixed\"\n# with", "line.phase = \"fixed\": takes line.fixed_delay_ns"),
        ("parts = []                      # (default: none)\n# with", "parts = [\"alignment\"]\nsamples = 2\n# with", "line.samples = 2: not a number of samples; use 1 or 3"),
        ("parts = []                      # (default: none)\n# with", "parts = [\"alignment\"]\nfixed_delay_ns = 30_000\n# with", "line.fixed_delay_ns = 30000: outside 0..20470"),
        ("parts = []                      # (default: none)\n# with", "parts = [\"alignment\"]\ndrift_limit_ns = 3_000\n# with", "line.drift_limit_ns = 3000: outside 0..2550"),
        // service
        ("parts = []", "parts = [\"all\"]", "service.parts = \"all\": unknown part; use requests"),
        ("parts = []", "parts = [\"continuous\"]", "every other part takes requests; add \"requests\""),
        ("parts = []", "infos = [0x4C]", "service.infos = 0x4C: a card without requests has no list"),
        ("parts = []", "parts = [\"requests\"]\ninfos = [0x4F]", "service.infos = 0x4F: no additional data; use MRS codes 0x40..0x4E"),
        ("parts = []", "parts = [\"requests\"]\ninfos = [\"0x4C\"]", "service.infos = \"0x4C\": is a string, must be a whole number"),
        ("parts = []", "parts = [\"requests\"]\ninfos = [-1]", "service.infos = -1: no additional data; use MRS codes 0x40..0x4E"),
        ("parts = []", "parts = [\"requests\"]\ninfos = [0x4C, 0x41, 0x4C]", "service.infos = 0x4C: stands twice; remove one"),
        ("parts = []", "parts = [\"requests\"]\ninfos = 0x4C", "service.infos = 0x4C: is an integer, must be a list of whole numbers"),
        ("parts = []", "parts = [\"requests\"]\ninfos = [64, 65, 66, 67, 68, 69, 70, 71, 72]", "service.infos = 0x48: more than 8"),
        // names
        ("name = \"s6_two_channel\"", "name = \"module\"", "name = \"module\": is a reserved word"),
        ("name = \"s6_two_channel\"", "name = \"Signal\"", "is a reserved word"),
        ("name = \"s6_two_channel\"", "name = \"\"", "is empty"),
        ("name = \"s6_two_channel\"", "name = \"../../etc\"", "is a path"),
        ("name = \"s6_two_channel\"", "name = \"C:\\\\x\"", "is a path"),
        ("name = \"s6_two_channel\"", "name = \"2card\"", "does not begin with a letter"),
        ("name = \"s6_two_channel\"", "name = \"two channel\"", "has the character ' '"),
        ("name = \"s6_two_channel\"", "name = \"a\\u0000b\"", "has the character '\\0'"),
        // board and pins
        ("name = \"papilio_pro\"", "name = \"papilio\"", "board.name = \"papilio\": unknown board; known boards: arty_a7_35, de10_nano, hx8k_b_evn, icebreaker, papilio_pro"),
        ("[pins]", "[pins]\ntrigger_i = \"P145\"", "pins.trigger_i = \"P145\": no such pin, the package of xc6slx9-tqg144-2 has P1..P144; use A0.."),
        ("[pins]", "[pins]\ntrigger_i = \"P2\"", "is not on a connector of papilio_pro; use A0..A15"),
        ("[pins]", "[pins]\ntrigger_i = \"D1\"", "is neither a pin (P48) nor a connector position (A0)"),
        ("[pins]", "[pins]\ntrigger_i = \"C0\"", "P114 already carries endat_clk0_o"),
        ("[pins]", "[pins]\nendat_clk2_o = \"A0\"", "pins.endat_clk2_o = \"A0\": no such signal; signals: trigger_i"),
        ("[pins]", "[pins]\ntrigger_i = 5", "pins.trigger_i = 5: is an integer, must be text in quotes"),
        // negative and huge numbers, with the range that counts
        ("position_bits = 29", "position_bits = -3", "channel[0].position_bits = -3: outside 1..48"),
        ("cable_m = 100", "cable_m = -1", "endat.cable_m = -1: outside 0..780"),
        ("filter_ns = 20", "filter_ns = -1", "endat.filter_ns = -1: outside 0..150"),
        ("start_window_ns = 80", "start_window_ns = -1", "endat.start_window_ns = -1: outside 10..630"),
        ("recovery_max_ns = 30_000", "recovery_max_ns = -1", "endat.recovery_max_ns = -1: outside 1250.."),
        ("tst_ns = 2_000", "tst_ns = -1", "endat.tst_ns = -1: neither 0 nor in 500..10000"),
        ("baud = 3_000_000", "baud = 1", "link.baud = 1: outside 9600..3000000"),
        ("baud = 3_000_000", "baud = -1", "link.baud = -1: outside 9600..3000000"),
        ("baud = 3_000_000", "baud = 12_500_001", "link.baud = 12500001: outside 9600..3000000"),
        ("read_hz = 1_000", "read_hz = -1", "link.read_hz = -1: outside 1..1000000"),
        ("clock_hz = 3_125_000", "clock_hz = -1", "endat.clock_hz = -1: outside 100000..16000000"),
        ("clock_hz = 3_125_000", "clock_hz = 3.125e6", "endat.clock_hz = 3.125e6: is a float"),
        ("system_hz = 100_000_000", "system_hz = 249_000_000", "use 248000000 Hz"),
        // the share that is to blame
        ("tcal_max_ns = 5_000", "tcal_max_ns = 4_090_000", "endat.tcal_max_ns = 4090000: outside 1..4082800"),
        ("recovery_max_ns = 30_000", "recovery_max_ns = 3_750", "endat.recovery_max_ns = 3750: below recovery_min_ns = 10000; use at least 10000, or add recovery_min_ns = 1250"),
        // text
        ("encoder = \"RCN 8510\"", "encoder = \"a\\nb\"", "channel[0].encoder = \"a\\nb\": has the character '\\n', which cannot be seen"),
        ("encoder = \"RCN 8510\"", "encoder = \"\\u001b[31m\"", "has the character '\\u{1b}'"),
        ("encoder = \"RCN 8510\"", "encoder = \"a\\u202eb\"", "has the character '\\u{202e}'"),
        ("encoder = \"RCN 8510\"", "encoder = \"12345678901234567890123456789012345678901\"", "has 41 characters, at most 40 are allowed"),
        // syntax
        ("system_hz = 100_000_000", "system_hz = 0100_000_000", "not TOML: unexpected leading zero, expected nothing; leave the first 0 out: system_hz = 100_000_000"),
        ("command = \"111000\"", "command = 000111", "not TOML: unexpected leading zero, expected nothing; put it in quotes: command = \"000111\""),
        ("baud = 3_000_000", "baud = 2\nbaud = 3_000_000", "not TOML: duplicate key; baud stands twice, remove one"),
        ("[clock]", "[clock", "not TOML:"),
        ("baud = 3_000_000", "baud = ", "not TOML:"),
        ("baud = 3_000_000", "baud = 3_000_000 bit", "not TOML:"),
        ("[link]", "[clock]", "not TOML:"),
    ];
    for (from, to, wanted) in rows {
        let (text, line) = changed(from, to);
        let found = refuse(&text);
        let lines = line..=line + to.matches('\n').count();
        let hit = found.iter().find(|d| d.text.contains(wanted));
        let hit = hit.unwrap_or_else(|| panic!("{to:?}: no message has {wanted:?}\n{found:#?}"));
        assert!(
            lines.contains(&hit.line),
            "{to:?}: line {} instead of {lines:?}",
            hit.line
        );
        assert_eq!(hit.file, "card.toml");
        let syntax = wanted.starts_with("not TOML");
        assert!(
            syntax || found.len() == 1,
            "{to:?}: more than one message\n{found:#?}"
        );
    }
}

#[test]
fn what_is_missing_is_named_with_an_example() {
    let rows = [
        (
            "name = \"s6_two_channel\"",
            "name: is missing; add, for example, `name = \"my_card\"`",
        ),
        (
            "system_hz = 100_000_000",
            "clock.system_hz: is missing; add, for example, `system_hz = 100_000_000`",
        ),
        (
            "clock_hz = 3_125_000",
            "channel[1].clock_hz: is missing; add `clock_hz = 3_125_000` here or in [endat]",
        ),
        (
            "position_bits = 29",
            "channel[0].position_bits: is missing; add, for example, `position_bits = 29`",
        ),
        ("command = \"111000\"", "channel[0].command: is missing"),
        ("sample_hz = 10_000", "trigger.sample_hz: is missing"),
        ("baud = 3_000_000", "link.baud: is missing"),
        (
            "name = \"papilio_pro\"",
            "board.name: is missing; add, for example, `name = \"papilio_pro\"`",
        ),
    ];
    for (from, wanted) in rows {
        let found = refuse(&changed(from, "").0);
        assert!(
            found
                .iter()
                .any(|d| d.text.starts_with(wanted) && d.line > 0),
            "{wanted}\n{found:#?}"
        );
    }
    assert!(refuse("").iter().all(|d| d.text.starts_with("is empty")));
    assert!(refuse(" \n\t")
        .iter()
        .all(|d| d.text.starts_with("is empty")));
    assert!(
        refuse("name = \"x\"").len() >= 4,
        "every missing key is named"
    );
}

/// The clock of the frame that measures the delay: 200 kHz, or what is asked for, as fast as the cable lets it be.
#[test]
fn the_calibration_clock_is_a_setting_with_a_safe_default() {
    let (text, _) = changed("clock_hz = 3_125_000", "clock_hz = 3_125_000");
    let whole = parse("card.toml", &text).unwrap();
    assert_eq!(
        whole.card.channels[0].calibration_period_cycles(100_000_000),
        500
    );
    let said = |hz: &str| {
        changed(
            "clock_hz = 3_125_000",
            &format!("clock_hz = 3_125_000\ncalibration_hz = {hz}"),
        )
        .0
    };
    let same = parse("card.toml", &said("200_000")).unwrap();
    assert_eq!(same.hash, whole.hash);
    let faster = parse("card.toml", &said("400_000")).unwrap();
    assert_ne!(faster.hash, whole.hash);
    assert_eq!(
        faster.card.channels[1].calibration_period_cycles(100_000_000),
        250
    );
    // A start bit may be two periods late.
    let waits = |p: &Project| p.card.channels[0].start_timeout_us;
    assert_eq!(waits(&whole) - waits(&faster), 5);
    let (text, _) = changed(
        "position_bits = 29",
        "position_bits = 29\ncalibration_hz = 100_000",
    );
    let one = parse("card.toml", &text).unwrap();
    let periods: Vec<u64> = one
        .card
        .channels
        .iter()
        .map(|c| c.calibration_period_cycles(100_000_000))
        .collect();
    assert_eq!(periods, [1_000, 500]);
    for (hz, wanted) in [
        ("99_000", "endat.calibration_hz = 99000: outside 100000..655737"),
        ("700_000", "endat.calibration_hz = 700000: outside 100000..655737 (four fifths of its period must hold the 1220 ns of cable and filter, "),
    ] {
        let found = refuse(&said(hz));
        assert!(found.iter().any(|d| d.text.contains(wanted)), "{found:?}");
    }
    // Never faster than the frames that follow.
    let text = said("600_000")
        .replace("clock_hz = 3_125_000", "clock_hz = 500_000")
        .replace("sample_hz = 10_000", "sample_hz = 1_000");
    let text = text.replace("start_window_ns = 80", "start_window_ns = 500");
    let found = refuse(&text);
    assert!(
        found[0]
            .text
            .contains("calibration_hz = 600000: above clock_hz = 500000"),
        "{found:?}"
    );
    // Slow system clocks time it, quick ones may not.
    let text = said("100_000").replace("system_hz = 100_000_000", "system_hz = 240_000_000");
    let found = refuse(&text);
    assert!(
        found.iter().any(|d| d
            .text
            .contains("calibration_hz = 100000: outside 117245..655737")),
        "{found:?}"
    );
}

#[test]
fn optional_keys_may_be_left_out_and_keep_the_card() {
    let whole = parse("card.toml", PRESET).unwrap();
    for key in [
        "tst_ns",
        "start_window_ns",
        "tcal_max_ns",
        "recovery_min_ns",
        "recovery_max_ns",
        "cable_m",
    ] {
        let shorter: String = PRESET
            .lines()
            .filter(|l| !l.starts_with(key))
            .map(|l| format!("{l}\n"))
            .collect();
        let project = parse("card.toml", &shorter).unwrap_or_else(|e| panic!("{key}: {e:?}"));
        assert_eq!(project.hash, whole.hash, "{key}");
    }
    // Without read_hz the host is to read every sample, which this link cannot.
    assert!(refuse(&changed("read_hz = 1_000", "").0)[0]
        .text
        .contains("the link is too slow"));
}

#[test]
fn a_channel_overrides_the_common_keys() {
    let (text, _) = changed(
        "command = \"111000\"",
        "command = \"000111\"\nclock_hz = 2_000_000\ntst_ns = 0",
    );
    let project = parse("card.toml", &text).unwrap();
    assert_eq!(project.card.channels[0].period_cycles, 50);
    assert_eq!(project.card.channels[0].first_low_extra_cycles, 0);
    assert_eq!(project.card.channels[1].period_cycles, 32);
}

#[test]
fn all_mistakes_of_a_file_are_listed_in_the_order_of_its_lines() {
    let text = PRESET
        .replacen("name = \"s6_two_channel\"", "name = \"a b\"", 1)
        .replacen("filter_ns", "fliter_ns", 1)
        .replacen("position_bits = 29", "position_bits = 50", 1)
        .replacen("baud = 3_000_000", "baud = 1", 1);
    let found = refuse(&text);
    let keys: Vec<&str> = found
        .iter()
        .map(|d| d.text.split([' ', ':']).next().unwrap())
        .collect();
    assert_eq!(
        keys,
        [
            "name",
            "endat.fliter_ns",
            "channel[0].position_bits",
            "link.baud"
        ]
    );
}

/// Catches a width that is looked at only when the command beside it has been mended.
#[test]
fn beside_a_wrong_command_the_numbers_of_a_channel_are_looked_at() {
    let text = PRESET
        .replacen(
            "command = \"111000\"",
            "command = \"101010\"\nclock_hz = 1",
            1,
        )
        .replacen("position_bits = 29", "position_bits = 0", 1);
    let found = refuse(&text);
    let mut keys: Vec<&str> = found
        .iter()
        .map(|d| d.text.split([' ', ':']).next().unwrap())
        .collect();
    keys.sort_unstable();
    let wanted = ["clock_hz", "command", "position_bits"].map(|key| format!("channel[0].{key}"));
    assert_eq!(keys, wanted, "{found:?}");
    assert!(found
        .iter()
        .any(|d| d.text.contains("position_bits = 0: outside 1..48; ")));
}

#[test]
fn the_messages_on_the_page_are_the_real_ones() {
    let page = include_str!("../docs/configuration.md");
    let text = PRESET
        .replacen("clock_hz = 3_125_000", "clock_hz = 9_000_000", 1)
        .replacen("position_bits = 29", "position_bits = 49", 1);
    for d in parse("my_card.toml", &text).unwrap_err() {
        assert!(page.contains(&format!("endat-gen: {d}\n")), "{d}");
    }
}

#[test]
fn a_mistake_in_the_common_keys_is_told_once_not_for_each_channel() {
    assert_eq!(
        refuse(&changed("clock_hz = 3_125_000", "clock_hz = 1").0).len(),
        1
    );
}

#[test]
fn what_follows_from_another_mistake_is_not_told() {
    let second = PRESET
        .find("[[channel]]                     # channel 1")
        .unwrap();
    let end = PRESET.find("[trigger]").unwrap();
    let single = format!("{}{}", &PRESET[..second], &PRESET[end..]);
    let rows = [
        (
            single.replacen("[[channel]]    ", "[channel]", 1),
            "[channel]: stands in single brackets",
        ),
        (
            format!("{}{}", &PRESET[..second], &PRESET[end..]).replacen(
                "[clock]",
                "channel = 5\n[clock]",
                1,
            ),
            "not TOML",
        ),
        // sample_hz is what read_hz would be
        (
            changed("read_hz = 1_000", "")
                .0
                .replacen("sample_hz = 10_000", "sample_hz = 0", 1),
            "trigger.sample_hz = 0: outside",
        ),
    ];
    for (text, wanted) in rows {
        let found = refuse(&text);
        assert!(
            found.len() == 1 && found[0].text.starts_with(wanted),
            "{found:#?}"
        );
    }
    let no_channels = "name = \"x\"\nchannel = 5\n[clock]\nsystem_hz = 100_000_000\n[board]\nname = \"papilio_pro\"\n\
         [trigger]\nsample_hz = 10_000\n[link]\nbaud = 1_000_000\nread_hz = 1\n";
    let found = refuse(no_channels);
    assert!(
        found.len() == 1 && found[0].text.starts_with("channel = 5: is an integer"),
        "{found:#?}"
    );
    // The rest of the file is judged all the same.
    let found = refuse(&no_channels.replacen("baud = 1_000_000", "baud = 1", 1));
    assert_eq!(found.len(), 2, "{found:#?}");
}

#[test]
fn too_many_channels_are_one_mistake_on_the_line_of_the_first_one_too_many() {
    let more = "[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n".repeat(7);
    let (text, line) = changed("[trigger]", &format!("{more}[trigger]"));
    let found = refuse(&text);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0].line, line + 18);
    assert!(found[0]
        .text
        .starts_with("channel = 9 tables: a card has 1..8 channels"));
}

#[test]
fn a_frame_that_waits_too_long_for_the_encoder_blames_tcal() {
    let (text, line) = changed("tcal_max_ns = 5_000", "tcal_max_ns = 100_000");
    let found = refuse(&text);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(found[0].line != line && found[0].text.contains("channel 0"));
    assert!(
        found[0].text.ends_with("takes up to 144.11 us, the largest part from tcal_max_ns = 100000, so at most 6939 Hz; lower it to 6939, or make the frame shorter: shorten tcal_max_ns, or shorten recovery_max_ns, or raise clock_hz"),
        "{}",
        found[0].text
    );
}

#[test]
fn a_file_with_only_a_name_is_checked_as_a_whole() {
    let found = refuse("name = \"x\"");
    let has = |text: &str| {
        found
            .iter()
            .any(|d| d.line == 0 && d.text.starts_with(text))
    };
    assert!(
        has("channel = 0 tables: a card has 1..8 channels"),
        "{found:#?}"
    );
    assert!(has("link.baud: is missing"), "{found:#?}");
    // A card need not be on a board.
    assert!(!has("board"), "{found:#?}");
}

#[test]
fn channels_without_pins_say_which_pins_they_need() {
    let third =
        "[[channel]]\nposition_bits = 25\ncommand = \"000111\"\nclock_hz = 1_000_000\n\n[trigger]";
    let (text, _) = changed("[trigger]", third);
    let found = refuse(&text);
    assert_eq!(found.len(), 5, "{found:#?}");
    assert!(found[0]
        .text
        .contains("has no usual pin for it; add, for example, `endat_clk2_o = \"A0\"` to [pins]"));
    let advised: String = found
        .iter()
        .map(|d| format!("{}\n", d.text.split('`').nth(1).unwrap()))
        .collect();
    let followed = text.replacen("[pins]", &format!("[pins]\n{advised}"), 1);
    assert_eq!(parse("card.toml", &followed).map(|p| p.pins.len()), Ok(20));
    let pins = "[pins]\nendat_clk2_o = \"A0\"\nendat_data2_o = \"A1\"\nendat_data2_oe = \"A2\"\nendat_data2_i = \"P58\"\nled_channel2_o = \"b0\"\n";
    let project = parse("card.toml", &text.replacen("[pins]", pins, 1)).unwrap();
    assert_eq!(project.card.channels.len(), 3);
}

#[test]
fn the_hash_follows_the_meaning_and_not_the_spelling() {
    let hash = |text: &str| parse("card.toml", text).unwrap().hash;
    let whole = hash(PRESET);
    assert_eq!(whole.len(), 12);
    assert_eq!(hash(&PRESET.replace("100_000_000", "0x5F5E100")), whole);
    assert_eq!(hash(&format!("# another comment\n{PRESET}")), whole);
    for (from, to) in [
        ("position_bits = 29", "position_bits = 28"),
        ("filter_ns = 20", "filter_ns = 30"),
        ("[pins]", "[pins]\ntrigger_i = \"A0\""),
        ("[\"pin\", \"timer\"]", "[\"pin\"]"),
    ] {
        assert_ne!(hash(&changed(from, to).0), whole, "{to}");
    }
}

/// What every verdict must satisfy.
fn judge(text: &str) -> Result<(), TestCaseError> {
    let lines = text.matches('\n').count() + 1;
    match parse("card.toml", text) {
        Ok(project) => {
            let project: Project = project;
            prop_assert!(endat_config::check_name(&project.name).is_ok());
            prop_assert!(!project.card.channels.is_empty());
        }
        Err(found) => {
            prop_assert!(!found.is_empty());
            for d in found {
                prop_assert!(
                    d.line <= lines && !d.text.is_empty() && !d.text.contains('\n'),
                    "{d:?}"
                );
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Pieces cut out, doubled or replaced by something typed.
    #[test]
    fn a_mangled_file_gives_messages_and_never_a_panic(
        cuts in prop::collection::vec((0usize..4_000, 0usize..40, "[ -~\n\u{e4}]{0,12}"), 1..4),
    ) {
        let mut text: Vec<char> = PRESET.chars().collect();
        for (at, length, insert) in cuts {
            let at = at % (text.len() + 1);
            let end = (at + length).min(text.len());
            text.splice(at..end, insert.chars());
        }
        judge(&text.into_iter().collect::<String>())?;
    }

    /// Any number in any place.
    #[test]
    fn any_number_in_any_place_gives_a_verdict(which in 0usize..64, value in prop_oneof![any::<i128>(), -10i128..100_000_000]) {
        let lines: Vec<&str> = PRESET.lines().collect();
        let numeric: Vec<usize> = (0..lines.len()).filter(|n| lines[*n].contains(" = ") && !lines[*n].starts_with('#')).collect();
        let target = numeric[which % numeric.len()];
        let key = lines[target].split(" = ").next().unwrap_or("");
        let text: String = (0..lines.len())
            .map(|n| if n == target { format!("{key} = {value}\n") } else { format!("{}\n", lines[n]) })
            .collect();
        judge(&text)?;
    }
}

#[test]
fn single_brackets_and_the_bus_of_a_receiver_are_called_what_they_are() {
    use endat_config::parse_any;
    let from = PRESET.find("\n[[channel]]").unwrap() + 1;
    let line = PRESET[..from].matches('\n').count() + 1;
    let channel = &PRESET[from..][..PRESET[from + 1..].find("\n[").unwrap() + 2];
    let single = format!(
        "{}{}",
        &PRESET[..from],
        channel.replace("[[channel]]", "[channel]")
    );
    let told = refuse(&single);
    let wanted =
        format!("card.toml:{line}: [channel]: stands in single brackets; write [[channel]]");
    assert!(
        told.iter().any(|d| d.to_string().starts_with(&wanted)),
        "{told:?}"
    );
    let dsp = PRESET.replacen("[link]", "[host]\nbus = \"dsp\"\n[link]", 1);
    let told = refuse(&dsp);
    assert_eq!(told.len(), 1);
    assert_eq!(dsp.lines().nth(told[0].line - 1), Some("bus = \"dsp\""));
    assert!(told[0].text.contains("this command works on cards"));
    let told = parse_any("card.toml", &dsp).unwrap_err();
    let says = |text: &str| told.iter().any(|d| d.text.starts_with(text));
    assert!(
        says("[endat]: is a table of cards, and host.bus"),
        "{told:?}"
    );
    assert!(told
        .iter()
        .all(|d| !d.text.contains("unknown key; known keys here: channel")));
}

#[test]
fn two_channels_in_single_brackets_are_told_how_to_write_them() {
    let text = PRESET.replace("\n[[channel]]", "\n[channel]");
    assert_ne!(text, PRESET);
    let found = refuse(&text);
    let told = found.iter().any(|d| d.text.contains("write [[channel]]"));
    assert!(told, "{found:#?}");
}
