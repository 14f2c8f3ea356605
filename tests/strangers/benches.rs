//! The emitted test bench as each language of Verilog, behind each bus, at each usual clock: a case is a clock, a bus and a reader.

use super::on_both_cores;
use crate::tools;
use crate::verilog::testbench::at_50_mhz;
use crate::verilog::write;
use endat_config::{parse, preset};
use endat_console::artifact::Artifact;
use endat_tools::readers::Reader;
use std::path::Path;
use Reader::{Icarus, Verilator};

const LANGUAGES: [Reader; 3] = [Icarus("-g2005"), Icarus("-g2009"), Icarus("-g2012")];
const BUSES: [&str; 5] = ["apb", "wishbone", "axi_lite", "spi", "parallel"];
/// Usual system clocks, in kHz.
const CLOCKS_KHZ: [u64; 27] = [
    24_000, 25_000, 27_000, 32_000, 33_333, 40_000, 48_000, 50_000, 60_000, 64_000, 66_000, 73_728,
    75_000, 77_000, 80_000, 96_000, 100_000, 112_000, 120_000, 125_000, 128_000, 133_333, 150_000,
    160_000, 200_000, 240_000, 250_000,
];

/// Both languages and two buses, at a clock whose half period is no whole number of picoseconds and at the slowest.
const QUICK: [(u64, &str, Reader); 2] = [
    (33_333, "wishbone", Icarus("-g2005")),
    (24_000, "axi_lite", Icarus("-g2012")),
];

/// A UART has clocks that the clock manager of its board makes.
const UART: [(u64, &str, Reader); 3] = [
    (40_000, "uart", Icarus("-g2005")),
    (112_000, "uart", Icarus("-g2009")),
    (160_000, "uart", Icarus("-g2012")),
];

/// Each clock once, each of the other buses at clocks over the whole range, and each pair of a bus and a language.
fn full() -> Vec<(u64, &'static str, Reader)> {
    let clocks = CLOCKS_KHZ.into_iter().enumerate();
    let case = |(index, khz): (usize, u64)| {
        let bus = BUSES[index % BUSES.len()];
        let language = LANGUAGES[index / BUSES.len() % LANGUAGES.len()];
        (khz, bus, language)
    };
    clocks.map(case).chain(UART).collect()
}

/// A card of two channels with sixteen clocks in a bit.
fn card(khz: u64, bus: &str) -> Vec<Artifact> {
    let board = match bus {
        "uart" => "[link]\nbaud = 1_000_000\nread_hz = 100\n[board]\nname = \"papilio_pro\"\n",
        _ => "",
    };
    let text = format!(
        "name = \"stranger\"\n[clock]\nsystem_hz = {hz}\n[endat]\nclock_hz = {bit_hz}\ncable_m = 20\n\
         [[channel]]\nposition_bits = 25\ncommand = \"111000\"\n[[channel]]\nposition_bits = 13\ncommand = \"000111\"\n\
         [trigger]\nsample_hz = 1_000\nsources = [\"pin\", \"register\"]\n{board}[host]\nbus = \"{bus}\"\n",
        hz = 1_000 * khz,
        bit_hz = 1_000 * khz / 16,
    );
    endat_emit::emit(&parse("stranger.toml", &text).unwrap()).unwrap()
}

/// Runs the bench of `files` in `folder`; whether it passed, and what was said.
fn play(folder: &Path, files: &[Artifact], reader: Reader, plusargs: &[&str]) -> (bool, String) {
    reader.play(folder, files, plusargs).unwrap()
}

/// Runs cases; the complaints.
fn complaints(test: &str, cases: &[(u64, &str, Reader)], plusargs: &[&str]) -> Vec<String> {
    on_both_cores(cases, |index, (khz, bus, reader)| {
        let files = card(*khz, bus);
        let case = format!("{khz} kHz, {bus}, {reader:?}");
        let (folder, _) = write(&format!("strangers-{test}-{index}"), &files);
        let (passes, text) = play(&folder, &files, *reader, plusargs);
        let _ = std::fs::remove_dir_all(folder);
        (!passes).then(|| format!("{case}: {text}"))
    })
}

pub fn has_tools() -> bool {
    tools::require("iverilog", "strangers") && tools::require("verilator", "strangers")
}

/// Catches a start value that SystemVerilog sets before time 0, and a bench that counts other clocks than it makes. The first steps of the
/// bench show both; `bench_of_a_quick_card_passes_and_fails_on_broken_cards` runs all steps once.
#[test]
fn two_languages_buses_and_odd_clocks_pass() {
    if has_tools() {
        let said = complaints("quick", &QUICK, &["+quick"]);
        assert!(said.is_empty(), "{}", said.join("\n"));
    }
}

/// Each clock, each bus with each language; not every pair of a clock with a bus or a language: the bench has one text for all buses, and its
/// arithmetic of the clock is the same in each.
#[test]
#[ignore = "slow: all clocks and languages with APB and Wishbone"]
fn every_language_and_odd_clock_passes_behind_apb_and_wishbone() {
    clocks_pass("apb", |bus| ["apb", "wishbone"].contains(&bus));
}

#[test]
#[ignore = "slow: all clocks and languages with AXI4-Lite and the parallel bus"]
fn every_language_and_odd_clock_passes_behind_axi_lite_and_parallel() {
    clocks_pass("axi-lite", |bus| ["axi_lite", "parallel"].contains(&bus));
}

#[test]
#[ignore = "slow: SPI in every language"]
fn spi_passes_in_every_language() {
    clocks_pass("spi", |bus| bus == "spi");
}

#[test]
#[ignore = "slow: a UART in every language"]
fn uart_passes_in_every_language() {
    clocks_pass("uart", |bus| bus == "uart");
}

fn clocks_pass(test: &str, is_wanted: impl Fn(&str) -> bool) {
    let cases = full();
    for bus in BUSES.into_iter().chain(["uart"]) {
        for language in LANGUAGES {
            let has = |case: &(u64, &str, Reader)| case.1 == bus && case.2 == language;
            assert!(cases.iter().any(has), "{bus}, {language}");
        }
    }
    if has_tools() {
        let wanted: Vec<_> = cases.into_iter().filter(|case| is_wanted(case.1)).collect();
        let said = complaints(test, &wanted, &[]);
        assert!(said.is_empty(), "{}", said.join("\n"));
    }
}

/// Catches a bench that fails and says so in words only. One complaint means that all else is good.
#[test]
fn a_failing_bench_has_an_exit_code() {
    if tools::require("iverilog", "exit code of a failing bench") {
        failing_bench_has_an_exit_code("icarus", Icarus("-g2005"), &["+quick"]);
    }
}

#[test]
#[ignore = "slow: a bench built by Verilator"]
fn a_failing_bench_of_verilator_has_an_exit_code() {
    if tools::require("verilator", "exit code of a failing bench") {
        failing_bench_has_an_exit_code("verilator", Verilator, &[]);
    }
}

fn failing_bench_has_an_exit_code(name: &str, reader: Reader, plusargs: &[&str]) {
    let mut files = card(24_000, "apb");
    let bench = files.iter_mut().find(|f| f.path.ends_with("_tb.v"));
    let text = &mut bench.unwrap().text;
    let right = "check(\"identification word 0\", word(0), 32'h456E4474);";
    assert_eq!(text.matches(right).count(), 1);
    *text = text.replace(right, &right.replace("4474", "4475"));
    let (folder, _) = write(&format!("strangers-exit-{name}"), &files);
    let (is_good, text) = play(&folder, &files, reader, plusargs);
    assert!(!is_good && text.contains("FAIL 1 complaints"), "{text}");
}

/// Runs the bench of the shipped card with these lines of its preset changed, as a user changes them.
fn passes_with(test: &str, changes: &[(&str, &str)]) {
    if !tools::require("iverilog", "strangers") {
        return;
    }
    let change = |text: String, (old, new): &(&str, &str)| {
        assert_eq!(text.matches(old).count(), 1, "{old}");
        text.replacen(old, new, 1)
    };
    let text = at_50_mhz(preset("s6_two_channel").unwrap());
    let text = changes.iter().fold(text, change);
    let files = endat_emit::emit(&parse("changed.toml", &text).unwrap()).unwrap();
    let (folder, _) = write(test, &files);
    let (is_good, text) = play(&folder, &files, Icarus("-g2012"), &[]);
    assert!(is_good, "{text}");
}

#[test]
#[ignore = "slow: bench with a list of additional data"]
fn the_bench_passes_with_a_list_of_additional_data() {
    let list = ("# infos =", "infos =");
    let none = "parts = []                      # (default: none)\n\n[line]";
    let requests = (none, "parts = [\"requests\"]\n\n[line]");
    // Half as fast a clock again is half as much to simulate.
    let clock = ("system_hz = 50_000_000", "system_hz = 25_000_000");
    let baud = ("baud = 3_000_000", "baud = 2_500_000");
    let rate = ("sample_hz = 10_000", "sample_hz = 8_000");
    passes_with("strangers-infos", &[list, requests, clock, baud, rate]);
}

/// Frames of the stream are on the line from the first trigger on.
#[test]
#[ignore = "slow: bench of a card that pushes"]
fn the_bench_passes_where_the_card_pushes_from_the_start() {
    passes_with("strangers-push", &[("start = \"off\"", "start = \"push\"")]);
}
