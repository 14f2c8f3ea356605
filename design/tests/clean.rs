//! The printed text under the tools that read it: not one warning.

use crate::tools;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::verilog::{print_files, Header};
use rust_hdl::prelude::Block;
use std::fs;
use std::path::PathBuf;

/// Blocks as designs of these names.
pub fn elaborated(mut blocks: Vec<(Box<dyn Block>, &str)>) -> Vec<Design> {
    let design = |(block, name): &mut (Box<dyn Block>, &str)| {
        block.connect_all();
        elaborate(&**block, name).unwrap()
    };
    blocks.iter_mut().map(design).collect()
}

/// Prints a design into a separate folder; returns the file names.
pub fn write(design: &Design, test: &str) -> (PathBuf, Vec<String>) {
    let folder = tools::folder(&format!("{test}-{}", design.top().name));
    let files = print_files(design, &Header::default());
    for (name, text) in &files {
        fs::write(folder.join(name), text).unwrap();
    }
    (folder, files.into_iter().map(|(name, _)| name).collect())
}

/// Checks that Verilator and Icarus Verilog have nothing to say.
pub fn simulators_are_content(design: &Design) {
    let (folder, files) = write(design, "lint");
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    if tools::require("verilator", "lint of emitted Verilog") {
        let arguments = [&["--lint-only", "-Wall"][..], &files].concat();
        let (good, text) = tools::run("verilator", &folder, &arguments);
        assert!(good && text.is_empty(), "{}: {text}", folder.display());
    }
    if tools::require("iverilog", "lint of emitted Verilog") {
        let arguments = [&["-g2005", "-Wall", "-o", "lint.vvp"][..], &files].concat();
        let (good, text) = tools::run("iverilog", &folder, &arguments);
        assert!(good && text.is_empty(), "{}: {text}", folder.display());
    }
}

/// Checks that yosys finds neither problems nor latches.
pub fn yosys_is_content(design: &Design) {
    if !tools::require("yosys", "check of emitted Verilog") {
        return;
    }
    let (folder, files) = write(design, "yosys");
    let script = format!(
        "read_verilog {}; hierarchy -check -top {}; proc; check -assert; select -assert-none t:$dlatch t:$dlatchsr",
        files.join(" "),
        design.top().name
    );
    let (good, text) = tools::run("yosys", &folder, &["-q", "-p", &script]);
    assert!(good && text.is_empty(), "{}: {text}", folder.display());
}
