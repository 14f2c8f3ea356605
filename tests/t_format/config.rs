//! Configuration of a receiver: what is wrong is told with its line, and what is right is shown.

use crate::program::{bad, good, Dir};

#[test]
fn the_preset_explains_itself() {
    let text = good(&["explain", "--preset", "async_dsp"]);
    for line in [
        "async_dsp: T-format receiver, configuration ",
        "line           2500000 bit/s, a field of 10 bits takes 4 us",
        "clk_select 0   20 MHz, 8 samples in a bit, pulses up to 50 ns are ignored",
        "clk_select 1   60 MHz, 24 samples in a bit, pulses up to 16.7 ns are ignored",
        "reply          taken up to 20 us after the request, refused from 23 us on",
        "3        1, 11           48 us",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    let json = good(&["explain", "--preset", "async_dsp", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["requests"][3]["wire_us"], 48.0);
    assert_eq!(json["clocks"][1]["bit_cycles"], 24);
    assert!(good(&["presets"]).contains("async_dsp "));
}

#[test]
fn the_preset_is_emitted_and_checked() {
    let dir = Dir::new("t-format");
    let arguments = [
        "emit",
        "--preset",
        "async_dsp",
        "--with",
        "all",
        "--out",
        &dir.path("o"),
    ];
    good(&arguments);
    let check = [&arguments[..], &["--check"]].concat();
    assert!(good(&check).ends_with("up to date\n"));
    let folder = dir.0.join("o/async_dsp");
    let top = std::fs::read_to_string(folder.join("async_dsp.v")).unwrap();
    assert!(top.contains("module async_dsp ("), "{top}");
    let readme = std::fs::read_to_string(folder.join("README.md")).unwrap();
    for end in [
        "_registers.md",
        "_tb.v",
        "_instance.vh",
        ".core",
        "_vivado.tcl",
        "_litex.py",
        "_amaranth.py",
        "_spinal.scala",
    ] {
        let file = format!("async_dsp{end}");
        assert!(folder.join(&file).exists(), "{file}");
        assert!(readme.contains(&format!("| `{file}` |")), "{file}");
    }
    assert!(readme.contains("20 or 60 MHz"), "{readme}");
    assert!(folder.join("MANIFEST").exists());
}

#[test]
fn mistakes_are_told_with_line_and_remedy() {
    let dir = Dir::new("t-format-mistakes");
    let text = good(&["presets", "--show", "async_dsp"]);
    let rows = [
        (
            "reply_gap_us = 20",
            "reply_gap_us = 64",
            ":15: channel[0].reply_gap_us = 64: outside 1..63; choose a value in that range",
        ),
        (
            "field_gap_us = 2",
            "field_gap_us = 8",
            "channel[0].field_gap_us = 8: outside 0..7; choose a value in that range",
        ),
        (
            "bit_hz = 2_500_000",
            "bit_hz = 4_000_000",
            "channel[0].bit_hz = 4000000: is no rate of T-format encoders; use 2500000 or 5000000",
        ),
        (
            "request = 3",
            "request = 4",
            "channel[0].request = 4: is no request ID; use one of 0, 1, 2, 3, 6, 7, 8, 12, 13",
        ),
        (
            "\"t_format\"",
            "\"endat\"",
            "channel[0].protocol = \"endat\": the bus \"dsp\" is that of a T-format receiver; use ",
        ),
        ("encoder =", "encodr =", "encodr"),
        (
            "[[channel]]",
            "[[chanel]]",
            ":10: chanel: unknown key; did you mean channel?",
        ),
    ];
    for (from, to, expected) in rows {
        assert!(text.contains(from), "{from}");
        let file = dir.write("receiver.toml", text.replacen(from, to, 1).as_bytes());
        let found = bad(&["explain", "--config", &file], 2);
        assert!(found.contains(expected), "{expected}\n{found}");
    }
    // A filter as long as half a bit of four clocks.
    let fast = text.replace("2_500_000      ", "5_000_000      ");
    let file = dir.write(
        "fast.toml",
        fast.replace("filter_cycles = 1", "filter_cycles = 2")
            .as_bytes(),
    );
    let found = bad(&["explain", "--config", &file], 2);
    let told =
        "channel[0].filter_cycles = 2: outside 0..1 (a bit has four clocks of 20 MHz); choose a ";
    assert!(found.contains(told), "{found}");
    good(&[
        "explain",
        "--config",
        &dir.write("fast.toml", fast.as_bytes()),
    ]);
    // Commands that take a card say so.
    let found = bad(&["read", "--port", "virtual:async_dsp"], 2);
    let told = "is a T-format receiver, and this command works on cards; use emit or explain";
    assert!(found.contains(told), "{found}");
}
