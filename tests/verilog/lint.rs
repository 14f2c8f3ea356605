//! Linters over the emitted card: not one warning, not one latch.

use super::{compile, preset_files, write};
use crate::tools;
use endat_gen::config::DEFAULT_PRESET;

#[test]
fn verilator_has_nothing_to_say_about_the_card() {
    if tools::require("verilator", "lint of the emitted card") {
        let (folder, files) = write("verilator", preset_files());
        let mut arguments = vec!["--lint-only", "-Wall", "--top-module", DEFAULT_PRESET];
        arguments.extend(files.iter().map(String::as_str));
        let (good, text) = tools::run("verilator", &folder, &arguments);
        assert!(good && text.is_empty(), "{}: {text}", folder.display());
    }
}

#[test]
fn iverilog_has_nothing_to_say_about_the_card() {
    if tools::require("iverilog", "lint of the emitted card") {
        let (folder, files) = write("iverilog", preset_files());
        compile(&folder, DEFAULT_PRESET, &files, &["-Wall"]);
    }
}

#[test]
fn yosys_finds_neither_problems_nor_latches_in_the_card() {
    if tools::require("yosys", "check of the emitted card") {
        let (folder, files) = write("yosys", preset_files());
        let script = format!(
            "read_verilog {}; hierarchy -check -top {DEFAULT_PRESET}; proc; check -assert; select -assert-none t:$dlatch t:$dlatchsr t:$adlatch",
            files.join(" ")
        );
        let (good, text) = tools::run("yosys", &folder, &["-q", "-p", &script]);
        assert!(good && text.is_empty(), "{}: {text}", folder.display());
    }
}
