//! `host.bus` in a configuration: what is emitted, and what is refused.

use crate::bus_card::{text, WORD_BUSES};
use endat_config::{load_preset, parse, preset, DEFAULT_PRESET};
use endat_hdl::card::bus::HostBus;

#[test]
fn a_card_with_a_bus_has_a_test_bench_and_no_board_top() {
    for bus in WORD_BUSES {
        let project = parse("card.toml", &text(bus, "")).unwrap();
        let files = endat_emit::emit(&project).unwrap();
        let has = |end: &str| files.iter().any(|f| f.path.ends_with(end));
        assert!(has("_card.v") && has("_registers.h") && has(".svd") && has("README.md"));
        assert!(!has("_top.v") && !has(".ucf") && has("_tb.v"), "{bus:?}");
        assert!(!has("uart_bridge.v") && has("_word_access.v"), "{bus:?}");
        let readme = files.iter().find(|f| f.path == "README.md").unwrap();
        assert!(
            readme.text.contains(&format!("`{}`", bus.name()))
                && readme.text.contains("no board top")
        );
    }
}

#[test]
fn uart_is_what_a_card_has_if_nothing_is_asked() {
    let preset = load_preset(DEFAULT_PRESET).unwrap();
    assert_eq!(preset.bus, HostBus::Uart);
    let asked =
        endat_config::preset(DEFAULT_PRESET).unwrap().to_owned() + "\n[host]\nbus = \"uart\"\n";
    assert_eq!(parse("card.toml", &asked).unwrap().hash, preset.hash);
}

/// Catches a card with a UART that only a board may hold: whoever has a top of his own gives it the clock.
#[test]
fn a_card_with_a_uart_comes_without_a_board_too() {
    let with = preset(DEFAULT_PRESET).unwrap();
    let without = with.split("\n[board]").next().unwrap();
    let card = parse("card.toml", without).unwrap();
    assert!(card.board.is_none() && card.pins.is_empty());
    let files = endat_emit::emit(&card).unwrap();
    let has = |end: &str| files.iter().any(|file| file.path.ends_with(end));
    assert!(has("_tb.v") && has("_example.c") && has(".sdc"));
    assert!(!has("_top.v") && !has(".ucf") && !has("_build.tcl"));
    let readme = files.iter().find(|file| file.path == "README.md").unwrap();
    assert!(
        readme.text.contains("registers behind a UART"),
        "{}",
        readme.text
    );
    assert!(readme.text.contains("the configuration names no board"));
    let pins = format!("{without}\n[pins]\ntrigger_i = \"A0\"\n");
    let found = parse("card.toml", &pins).unwrap_err();
    assert!(
        found.len() == 1 && found[0].text.contains("there is no board; add [board]"),
        "{found:?}"
    );
    // `--board` holds it, too.
    let board = endat_config::board::Board::named("papilio_pro").unwrap();
    let held = endat_config::parse_on("card.toml", without, Some(&board)).unwrap();
    assert!(held.board.is_some() && !held.pins.is_empty());
}

#[test]
fn what_a_bus_has_no_use_for_is_refused_with_the_reason() {
    for (bus, more, message) in [
        (
            HostBus::Apb,
            "[link]\nbaud = 9600\n",
            "[link]: host.bus = \"apb\" has no UART",
        ),
        (
            HostBus::Spi,
            "[pins]\ntrigger_i = \"A0\"\n",
            "[pins]: says which pins of a board the signals are on, and there is no board; add [board]",
        ),
        (
            HostBus::Wishbone,
            "[board]\nname = \"papilio_pro\"\n",
            "[board]: host.bus = \"wishbone\" stays inside the chip",
        ),
        (
            HostBus::AxiLite,
            "[pins]\ntrigger_i = \"A0\"\n",
            "[pins]: host.bus = \"axi_lite\" stays inside the chip",
        ),
    ] {
        let all = parse("card.toml", &text(bus, more)).unwrap_err();
        assert_eq!(all.len(), 1, "{all:?}");
        let found = all[0].to_string();
        assert!(
            found.contains(message) && found.contains("remove the table"),
            "{found}"
        );
    }
    let fast = parse("card.toml", &text(HostBus::Spi, "sck_hz = 12_500_001\n")).unwrap_err();
    assert!(
        fast[0]
            .to_string()
            .contains("host.sck_hz = 12500001: outside 1..12500000"),
        "{fast:?}"
    );
    assert!(parse("card.toml", &text(HostBus::Spi, "sck_hz = 12_500_000\n")).is_ok());
    let wrong = text(HostBus::Apb, "").replace("\"apb\"", "\"ahb\"");
    let all = parse("card.toml", &wrong).unwrap_err();
    assert!(
        all[0]
            .to_string()
            .contains("host.bus = \"ahb\": unknown bus; use uart, "),
        "{all:?}"
    );
}

#[test]
fn another_bus_is_another_hash() {
    let hash = |bus| parse("card.toml", &text(bus, "")).unwrap().hash;
    let mut hashes: Vec<String> = WORD_BUSES.into_iter().map(hash).collect();
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), WORD_BUSES.len());
}

/// One channel without any bus.
fn bare(more: &str) -> String {
    let both = text(HostBus::Bare, more);
    let second = "[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n";
    assert!(both.contains(second));
    both.replace(second, "")
}

#[test]
fn without_a_bus_one_port_is_emitted_and_no_registers() {
    let project = parse("port.toml", &bare("")).unwrap();
    let files = endat_emit::emit(&project).unwrap();
    let has = |end: &str| files.iter().any(|f| f.path.ends_with(end));
    assert!(has("none_card.v") && has("_instance.vh") && has(".core") && has("README.md"));
    assert!(!has("_registers.h") && !has(".svd") && !has("register_bank.v") && !has("_top.v"));
    let top = files.iter().find(|f| f.path == "none_card.v").unwrap();
    for port in [
        "input  wire         trigger",
        "output wire  [47:0] position",
        "endat_clk",
    ] {
        assert!(top.text.contains(port), "{port}");
    }
    let two = parse("port.toml", &text(HostBus::Bare, "")).unwrap_err();
    assert_eq!(two.len(), 1, "{two:?}");
    assert!(
        two[0].to_string().contains("makes one encoder port"),
        "{two:?}"
    );
}
