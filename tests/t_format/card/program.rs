//! The program's commands at a virtual card that mixes protocols, and its stream.

use endat_card::{VirtualCard, VirtualConfig};
use endat_config::{parse, preset, Project};
use endat_hdl::regs::Protocol;
use endat_host::feed::Feed;
use endat_host::{Bridge, Card};
use std::collections::VecDeque;
use std::time::Duration;

const PORT: [&str; 2] = ["--port", "virtual:mixed_protocols"];

fn run(command: &[&str]) -> endat_terminal::outcome::Outcome {
    crate::program::run(&[command, &PORT].concat())
}

#[test]
fn the_host_commands_know_what_a_t_format_channel_is() {
    let read = run(&["read"]);
    assert_eq!(read.exit_code, 0, "{read:?}");
    assert!(read.stdout.contains(" deg "), "{read:?}");
    // Its shaft begins at 200.2 turns.
    assert!(read.stdout.contains(" counts, multi 200 "), "{read:?}");
    assert!(!read.stdout.lines().nth(2).unwrap().contains("deg"));
    let json: serde_json::Value = serde_json::from_str(&run(&["read", "--json"]).stdout).unwrap();
    assert_eq!(
        (&json[1]["unit"], &json[1]["turns"]),
        (&"counts".into(), &200.into())
    );
    let raw = json[1]["position"].as_u64().unwrap();
    assert_eq!(raw >> 24, 200);
    assert_eq!(json[1]["value"].as_f64(), Some((raw & 0xFF_FFFF) as f64));

    let id = run(&["id"]);
    assert_eq!(id.exit_code, 0);
    assert!(id.stdout.contains("t_format: T-format channels"), "{id:?}");
    assert!(id.stdout.contains("encoder 1\n  type              T-format, which has no name plate\n  kind              0x17 (ENID)\n"), "{id:?}");
    let monitor = run(&["monitor", "--count", "1"]);
    assert_eq!(monitor.exit_code, 0, "{monitor:?}");

    let param = run(&["param", "read", "0xA1", "0x0D", "--channel", "1"]);
    assert_eq!(param.exit_code, 2);
    assert!(param.messages[0].contains("channel 1: mode commands: the channel speaks T-format, which has none; its requests go through the words of t_format1 (`endat explain t_format`)"), "{param:?}");
    for (name, text) in [
        (
            "t_format0",
            "channel 0 speaks EnDat, which has no block t_format",
        ),
        ("service1.state", "this card has no block service"),
    ] {
        let refused = run(&["reg", "read", name]);
        assert_eq!(refused.exit_code, 2);
        assert!(refused.messages[0].contains(text), "{refused:?}");
    }
    let margin = run(&["margin", "--channel", "1"]);
    assert_eq!(margin.exit_code, 2);
    assert!(
        margin.messages[0].starts_with("--channel = 1: speaks T-format"),
        "{margin:?}"
    );
    let words = run(&["reg", "read", "t_format1"]);
    assert_eq!(words.exit_code, 0, "{words:?}");
    let told = crate::program::run(&["explain", "no_header"]);
    assert!(
        told.stdout.starts_with("cause 4 of T-format (no_header)"),
        "{told:?}"
    );
    assert!(!told.stdout.contains("counted in"));
}

/// The preset with a stream, at a slower clock without its board, which is simulated sooner.
fn slow_project() -> Project {
    let text = preset("mixed_protocols").unwrap();
    let mut text = text.split("\n[board]").next().unwrap().to_owned();
    for (from, to) in [
        ("system_hz = 100_000_000", "system_hz = 40_000_000"),
        ("clock_hz = 3_125_000", "clock_hz = 2_000_000"),
        ("baud = 3_000_000", "baud = 2_000_000"),
        ("fifo_bytes = 0", "fifo_bytes = 2048"),
        ("sample_hz = 10_000", "sample_hz = 5_000"),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    parse("mixed.toml", &text).unwrap()
}

/// One device for all goes to the channels that speak its protocol. Each case has devices, and whether each channel has positions.
fn devices_go_to_the_channels(cases: &[(&[&str], [bool; 2])]) {
    let project = slow_project();
    let with = |devices: &[&str]| {
        let encoders = devices.iter().map(|d| d.to_string()).collect();
        let config = VirtualConfig {
            encoders,
            ..VirtualConfig::default()
        };
        let card = VirtualCard::new(&project, &config).map_err(|e| e.to_string())?;
        let mut card = Card::find(Bridge::new(card)).unwrap();
        while card.results().unwrap().channels[0].sequence < 3 {}
        let results = card.results().unwrap().channels;
        Ok::<_, String>([results[0].fresh, results[1].fresh])
    };
    for &(devices, fresh) in cases {
        assert_eq!(with(devices), Ok(fresh), "{devices:?}");
    }
    for (devices, told) in [
        (
            &["TS5700N8401", "TS5700N8401"][..],
            "channel 0 speaks EnDat; the devices there are",
        ),
        (
            &["RCN-8510", "RCN-8510"],
            "channel 1 speaks T-format; the devices there are TS5700N8401 and none",
        ),
        (&["what"], "channel 0 speaks EnDat; the devices there are"),
    ] {
        let error = with(devices).unwrap_err();
        assert!(error.contains(told), "{devices:?}: {error}");
    }
}

#[test]
fn devices_go_to_the_channels_of_their_protocol() {
    devices_go_to_the_channels(&[
        (&["ts5700n8401"], [true, true]),
        (&["none", "TS5700N8401"], [false, true]),
    ]);
}

#[test]
#[ignore = "slow: devices of either protocol, and none"]
fn any_devices_go_to_the_channels_of_their_protocol() {
    devices_go_to_the_channels(&[
        (&["ts5700n8401"], [true, true]),
        (&["RCN 8510"], [true, true]),
        (&["none"], [false, false]),
        (&["none", "TS5700N8401"], [false, true]),
    ]);
}

#[test]
fn the_stream_of_a_mixed_card_has_both_positions() {
    let project = slow_project();
    let virtual_card = VirtualCard::new(&project, &VirtualConfig::default()).unwrap();
    let mut card = Card::find(Bridge::new(virtual_card)).unwrap();
    let protocols = [0, 1].map(|n| card.identity().protocol(n));
    assert_eq!(protocols, [Protocol::Endat, Protocol::TFormat]);
    let mut feed = Feed::begin(&mut card, false).unwrap();
    let mut rows = VecDeque::new();
    while rows.len() < 300 {
        feed.fill(&mut card, &mut rows, Duration::from_millis(1))
            .unwrap();
    }
    let rows: Vec<_> = rows.into_iter().skip(5).collect();
    let at = |n: usize, channel: usize| rows[n].cells[channel].position.unwrap();
    for (n, row) in rows.iter().enumerate() {
        assert_eq!(row.missing, 0, "{n}");
        for cell in &row.cells {
            assert!(cell.fresh && cell.cause == "none", "{n} {cell:?}");
        }
        assert_eq!(at(n, 1) >> 24, 200);
    }
    // Both shafts turn as they should, the second one half as fast again.
    let last = rows.len() - 1;
    let seconds = (rows[last].cycles - rows[0].cycles) as f64 / 40e6;
    let turns = (at(last, 1) - at(0, 1)) as f64 / f64::from(1 << 17);
    assert!(
        (turns / seconds - 0.375).abs() < 0.002,
        "{turns} in {seconds}"
    );
    let turns = (at(last, 0) - at(0, 0)) as f64 / f64::from(1 << 29);
    // The swing on top has at most 0.004 turns a second.
    assert!(
        (turns / seconds - 0.25).abs() < 0.006,
        "{turns} in {seconds}"
    );
}
