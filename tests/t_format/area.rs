//! Area of the receiver with all its guards, next to the published one without.

use crate::tools;
use crate::verilog::area::{require, subject};
use crate::verilog::is_core;
use endat_config::{load_any_preset, Configuration};
use endat_console::artifact::Artifact;
use endat_emit::protocols::t_format::emit;
use endat_tools::area::{synthesise, Family, ECP5, ICE40, XC6S};
use std::fs;

/// LUTs of four inputs and flip-flops of Microchip's T-Format interface.
const PEER: (u64, u64) = (248, 256);

#[test]
fn the_receiver_with_its_guards_is_at_most_a_quarter_larger_than_the_published_one() {
    receiver_is_small(&[ECP5], 125);
}

#[test]
#[ignore = "slow: the same for iCE40"]
fn the_receiver_is_at_most_three_tenths_larger_for_ice40() {
    // A quarter until the wait after a reset took 13 LUTs more.
    receiver_is_small(&[ICE40], 130);
}

/// At most so many per cent of the published LUTs, and 105 of the flip-flops.
fn receiver_is_small(families: &[Family], lut_percent: u64) {
    if !require("area of the T-format receiver") {
        return;
    }
    let receiver = subject("t_format");
    for family in families {
        let folder = tools::folder(&format!("t_format-{}", family.name));
        let found = synthesise(&folder, &receiver.files(), receiver.name, family).unwrap();
        let usage = found.usage;
        assert!(
            usage.lut < PEER.0 * lut_percent / 100 && usage.ff < PEER.1 * 21 / 20,
            "{}: {usage:?}, {:?}",
            family.name,
            found.cells
        );
    }
}

/// The files of the preset, the top module first.
fn preset() -> Vec<Artifact> {
    let Configuration::Receiver(receiver) = load_any_preset("async_dsp").unwrap() else {
        panic!("a card");
    };
    let files = emit(&receiver).unwrap().into_iter();
    files.filter(is_core).collect()
}

#[test]
#[ignore = "slow: three families"]
fn the_preset_is_synthesised_for_three_families() {
    if !require("synthesis of the T-format preset") {
        return;
    }
    for family in [XC6S, ECP5, ICE40] {
        let folder = tools::folder(&format!("async_dsp-{}", family.name));
        let found = synthesise(&folder, &preset(), "async_dsp", &family).unwrap();
        assert!((200..400).contains(&found.usage.ff), "{:?}", found.usage);
    }
}

#[test]
fn the_preset_is_clean_under_verilator_and_iverilog() {
    let folder = tools::folder("async_dsp-lint");
    let files = preset();
    for file in &files {
        fs::write(folder.join(&file.path), &file.text).unwrap();
    }
    let names: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
    for (tool, flags) in [
        ("verilator", &["--lint-only", "-Wall"][..]),
        ("iverilog", &["-g2005", "-Wall", "-o", "lint.vvp"]),
    ] {
        if tools::require(tool, "lint of the T-format preset") {
            let (good, text) = tools::run(tool, &folder, &[flags, &names].concat());
            assert!(good && text.is_empty(), "{tool}: {text}");
        }
    }
}
