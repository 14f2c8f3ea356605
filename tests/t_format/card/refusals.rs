//! What a configuration of a mixed card may not say, with the line and the remedy.

use endat_config::{load_preset, parse, preset};

fn complaints(text: &str) -> String {
    match parse("mixed.toml", text) {
        Ok(_) => String::new(),
        Err(diagnostics) => {
            let lines: Vec<String> = diagnostics.iter().map(ToString::to_string).collect();
            lines.join("\n")
        }
    }
}

#[test]
fn mistakes_are_told_with_line_and_remedy() {
    let text = preset("mixed_protocols").unwrap();
    let rows = [
        ("\"t_format\"", "\"tamagawa\"", ":23: channel[1].protocol = \"tamagawa\": unknown protocol; use \"endat\" (default) or \"t_format\""),
        ("request = 3 ", "position_bits = 29\nrequest = 3 ", ":26: channel[1].position_bits = 29: is a key of EnDat, and this channel speaks T-format; remove it"),
        ("request = 3 ", "command = \"111000\"\nrequest = 3 ", "channel[1].command = \"111000\": is a key of EnDat"),
        ("request = 3 ", "clock_hz = 3_125_000\nrequest = 3 ", "channel[1].clock_hz = 3_125_000: is a key of EnDat"),
        ("position_bits = 29", "bit_hz = 2_500_000\nposition_bits = 29", "channel[0].bit_hz = 2_500_000: is a key of T-format, and this channel speaks EnDat; remove it, or add protocol = \"t_format\""),
        ("bit_hz = 2_500_000", "bit_hz = 4_000_000", "channel[1].bit_hz = 4000000: is no rate of T-format encoders; use 2500000 or 5000000"),
        ("request = 3 ", "request = 4 ", "channel[1].request = 4: is no request ID; use one of 0, 1, 2, 3, 7, 8, 12"),
        ("request = 3 ", "request = 13 ", "channel[1].request = 13: accesses the EEPROM, which a trigger must not; use 3, and the word t_format<n>.send"),
        ("reply_gap_us = 20", "reply_gap_us = 64", ":27: channel[1].reply_gap_us = 64: outside 1..63; choose a value in that range"),
        ("field_gap_us = 2", "field_gap_us = 8", "channel[1].field_gap_us = 8: outside 0..7; choose a value in that range"),
        ("filter_ns = 50", "filter_ns = 160", "channel[1].filter_ns = 160: is 16 cycles, more than 15 (half a bit, and 15 at most); use 150 ns or less"),
        ("system_hz = 100_000_000", "system_hz = 16_000_000", "channel[1].bit_hz = 2500000: has 6 cycles of clock.system_hz = 16000000 in a bit, 8 are needed; use a system clock of at least 20000000 Hz"),
        ("system_hz = 100_000_000", "system_hz = 32_000_000", "channel[1].bit_hz = 2500000: would become 2461538 bit/s (-15385 ppm), more than the allowed 10000 ppm; use a multiple of 2500000 Hz for clock.system_hz, for example 32500000"),
        ("sample_hz = 10_000", "sample_hz = 11_000", "an exchange of T-format channel 1 takes up to 91.4 us with its pauses, so at most 10940 Hz; lower it to 10940, or make the exchange shorter: lower reply_gap_us = 20"),
    ];
    for (from, to, expected) in rows {
        assert!(text.contains(from), "{from}");
        let found = complaints(&text.replacen(from, to, 1));
        assert!(found.contains(expected), "{expected}\n{found}");
    }
    // 250 MHz is no problem: 50 cycles in a fast bit.
    let fast = text.replace("system_hz = 100_000_000", "system_hz = 96_000_000");
    assert!(complaints(&fast.replace("3_125_000", "3_000_000")).contains("bit_hz"));
}

#[test]
fn what_only_endat_has_takes_an_endat_channel() {
    let only =
        "name = \"only\"\n[clock]\nsystem_hz = 100_000_000\n[[channel]]\nprotocol = \"t_format\"\n\
                [trigger]\nsample_hz = 10_000\n[host]\nbus = \"apb\"\n";
    assert_eq!(complaints(only), "");
    for (more, expected) in [
        ("[service]\nparts = [\"requests\"]\n", ":11: service.parts = \"requests\": takes a channel that speaks EnDat, and this card has none; leave the list empty"),
        ("[line]\nparts = [\"alignment\"]\n", ":11: line.parts = \"alignment\": takes a channel that speaks EnDat"),
        ("[endat]\nclock_hz = 2_000_000\n", "[endat]: no channel of this card speaks EnDat; remove the table"),
    ] {
        let found = complaints(&format!("{only}{more}"));
        assert!(found.contains(expected), "{expected}\n{found}");
    }
}

#[test]
fn every_number_of_the_channel_counts_in_the_hash() {
    let hash = |text: &str| parse("mixed.toml", text).unwrap().hash;
    let text = preset("mixed_protocols").unwrap();
    let mut seen = vec![load_preset("mixed_protocols").unwrap().hash];
    for (from, to) in [
        ("bit_hz = 2_500_000", "bit_hz = 5_000_000"),
        ("request = 3 ", "request = 0 "),
        ("reply_gap_us = 20", "reply_gap_us = 10"),
        ("field_gap_us = 2", "field_gap_us = 1"),
        ("filter_ns = 50", "filter_ns = 30"),
    ] {
        let other = hash(&text.replacen(from, to, 1));
        assert!(!seen.contains(&other), "{to}");
        seen.push(other);
    }
    // What is left out is what the preset says.
    let short: Vec<&str> = (text.lines())
        .filter(|l| {
            ![
                "bit_hz",
                "request",
                "reply_gap_us",
                "field_gap_us",
                "filter_ns = 50",
            ]
            .iter()
            .any(|key| l.starts_with(key))
        })
        .collect();
    assert_eq!(hash(&short.join("\n")), seen[0]);
}
