//! Masters that others have written, on the emitted Verilog: cocotb with the bus models of cocotbext, in iverilog.

use super::{text, WORD_BUSES};
use crate::passed::Check;
use crate::tools;
use endat_gen::config::parse;
use std::path::Path;

#[test]
fn masters_of_cocotb_read_write_and_trigger() {
    for bus in WORD_BUSES {
        let name = bus.name();
        let module = match name {
            "axi_lite" => "cocotbext.axi",
            "apb" => "cocotbext.apb",
            "ahb_lite" => "cocotbext.ahb",
            _ => "cocotbext.wishbone",
        };
        let check = format!("cocotb masters, {name}");
        if !tools::require("iverilog", &check)
            || !tools::require_python("cocotb_tools.runner", &check)
            || !tools::require_python(module, &check)
        {
            continue;
        }
        let project = parse("card.toml", &text(bus, "")).unwrap();
        let files = endat_gen::emit(&project).unwrap();
        let check = Check::new(check).files(&files).source("tests/cocotb");
        let Some(_running) = check.begin() else {
            continue;
        };
        let folder = tools::folder(&format!("cocotb-{name}"));
        for file in files {
            std::fs::write(folder.join(&file.path), &file.text).unwrap();
        }
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cocotb/run.py");
        let arguments = [script.to_str().unwrap(), name, &project.name, &project.hash];
        let (good, text) = tools::run("python3", &folder, &arguments);
        assert!(good, "{}: {text}", folder.display());
    }
}
