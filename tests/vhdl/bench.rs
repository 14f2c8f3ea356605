//! The bench in VHDL with encoders: it passes on cards of every bus, follows its generics, and refuses broken cards.

use super::mutations::MUTATIONS;
use super::{emission, ghdl, listed, mutant, preset, quick, write};
use crate::strangers::on_both_cores;
use crate::tools;
use crate::verilog::mutations::Mutation;
use endat_config as config;
use endat_console::artifact::Artifact;
use std::path::Path;

/// Cards of this size take a simulator a second.
const SMALL: &str = "name = \"small_card\"
[clock]
system_hz = 10_000_000
[endat]
clock_hz = 1_000_000
[[channel]]
position_bits = 25
command = \"111000\"
[trigger]
sample_hz = 1_000
[host]
";
/// A second channel, which answers to the other mode command.
const SECOND: &str = "[[channel]]\nposition_bits = 13\ncommand = \"000111\"\n[trigger]";
/// The rate of a card with a UART.
const LINK: &str = "[link]\nbaud = 1_000_000\n";
/// Ends behind the first faults.
const SHORT: &str = "-gSHORT=true";
/// Presets whose whole bench is run: the others have frames of many cycles.
const WHOLE: [&str; 4] = ["clb_2mhz", "demo", "mixed_protocols", "ssi_two_channel"];
/// The bench does not see these: one changes no result, the other needs a read while a result is loaded.
const NOT_SEEN: [&str; 2] = [
    "delay measured a cycle too long",
    "results are taken too early",
];

fn small(bus: &str, more: &str) -> Vec<Artifact> {
    let text = format!("{SMALL}bus = \"{bus}\"\n{more}");
    emission(&config::parse_any_on("small.toml", &text, None).unwrap())
}

/// Output of the bench with these generics.
fn bench(folder: &Path, files: &[Artifact], generics: &[&str]) -> (bool, String) {
    let (name, _) = listed(files);
    let (bench, file) = (format!("{name}_tb"), format!("{name}_tb.vhd"));
    let run = [&[&bench[..], "--ieee-asserts=disable-at-0"][..], generics].concat();
    ghdl(folder, files, "--std=08", &[&file], &run)
}

fn assert_passes(test: &str, files: &[Artifact], generics: &[&str]) {
    let folder = write(test, files);
    let (is_good, text) = bench(&folder, files, generics);
    let passes = text.lines().any(|line| line == "PASS");
    // Without one warning of numeric_std.
    let is_quiet = !text.contains("warning");
    assert!(is_good && passes && is_quiet, "{test} {generics:?}: {text}");
}

/// The complaint of the bench about a broken card; none if it passes.
fn complaint(test: &str, files: &[Artifact], mutation: &Mutation) -> Option<String> {
    let broken = mutant(files, mutation).unwrap();
    let folder = write(test, &broken);
    let (is_good, text) = bench(&folder, &broken, &["-gFIRST_ONLY=true"]);
    let line = text.lines().find(|line| line.starts_with("FAIL "));
    line.filter(|_| !is_good).map(str::to_owned)
}

#[test]
fn bench_with_encoders_passes_with_another_width_clock_and_cable_and_fails_on_a_broken_card() {
    if !tools::require("ghdl", "VHDL bench with encoders") {
        return;
    }
    let files = small("apb", "");
    assert_passes("encoders", &files, &[SHORT]);
    let generics = ["-gPOSITION_BITS=13", "-gCLOCK_HZ=2000000", "-gCABLE_NS=120"];
    let folder = write("encoders-other", &files);
    // The table of rates has no such one.
    let (is_good, text) = bench(&folder, &files, &["-gCLOCK_HZ=12345"]);
    assert!(
        !is_good && text.contains("CLOCK_HZ = 12345: is not in the table RATES"),
        "{text}"
    );
    let (is_good, text) = bench(&folder, &files, &[&generics[..], &[SHORT]].concat());
    assert!(is_good && text.contains("PASS"), "{text}");
    let seen = complaint("encoders-mutant", &files, &MUTATIONS[3]);
    assert!(seen.is_some_and(|line| line.contains("encoder 0")));
}

#[test]
#[ignore = "slow: VHDL bench with encoders on every bus"]
fn bench_with_encoders_passes_on_every_bus() {
    if !tools::require("ghdl", "VHDL bench with encoders") {
        return;
    }
    let buses = [
        "uart", "apb", "wishbone", "axi_lite", "ahb_lite", "spi", "parallel",
    ];
    on_both_cores(&buses, |_, bus| {
        let begins = SMALL.replace("[trigger]", SECOND);
        let link = if *bus == "uart" { LINK } else { "" };
        let text = format!("{begins}bus = \"{bus}\"\n{link}");
        let card = config::parse_any_on("small.toml", &text, None).unwrap();
        assert_passes(&format!("encoders-{bus}"), &emission(&card), &[]);
        None
    });
    // Before the reset numeric_std may say that values are none.
    let files = small("apb", "[device]\ninitial_values = false\n");
    let (is_good, text) = bench(&write("encoders-reset", &files), &files, &[]);
    assert!(is_good && text.lines().any(|line| line == "PASS"), "{text}");
}

#[test]
#[ignore = "slow: VHDL bench with encoders on every preset"]
fn bench_with_encoders_passes_on_every_preset() {
    if !tools::require("ghdl", "VHDL bench with encoders") {
        return;
    }
    let names: Vec<&str> = config::PRESETS.iter().map(|preset| preset.0).collect();
    on_both_cores(&names, |_, name| {
        let generics: &[&str] = if WHOLE.contains(name) { &[] } else { &[SHORT] };
        assert_passes(&format!("encoders-{name}"), &preset(name), generics);
        None
    });
}

#[test]
#[ignore = "slow: VHDL bench with encoders at other widths, clocks, times and cables"]
fn bench_with_encoders_follows_its_generics() {
    if !tools::require("ghdl", "VHDL bench with encoders") {
        return;
    }
    let cases: [&[&str]; 5] = [
        &["-gPOSITION_BITS=48", "-gCABLE_NS=500"],
        &["-gPOSITION_BITS=1", "-gCABLE_NS=0"],
        &["-gSYSTEM_HZ=40000000", "-gTCAL_NS=0"],
        &["-gCLOCK_HZ=1000000", "-gTM_NS=12000"],
        &["-gSYSTEM_HZ=62500000", "-gPOSITION_BITS=37"],
    ];
    let files = quick();
    on_both_cores(&cases, |index, generics| {
        assert_passes(&format!("encoders-generics{index}"), &files, generics);
        None
    });
}

#[test]
#[ignore = "slow: VHDL bench with encoders on every broken card"]
fn bench_with_encoders_fails_on_broken_cards() {
    if !tools::require("ghdl", "VHDL bench with encoders") {
        return;
    }
    let files = quick();
    let mut survivors = on_both_cores(MUTATIONS, |index, mutation| {
        let seen = complaint(&format!("encoders-mutant{index}"), &files, mutation);
        seen.is_none().then(|| mutation.name.to_owned())
    });
    survivors.sort_unstable();
    assert_eq!(survivors, NOT_SEEN);
}
