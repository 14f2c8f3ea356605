//! Masters that others have written, on the emitted Verilog: cocotb with the bus models of cocotbext, in iverilog.

use crate::bus_card::{text, WORD_BUSES};
use crate::tools;
use endat_config::parse;
use endat_hdl::card::bus::HostBus;
use std::path::Path;

fn masters_of_cocotb(buses: &[HostBus]) {
    for &bus in buses {
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
        let files = endat_emit::emit(&project).unwrap();
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

/// AXI4-Lite has most channels.
#[test]
fn a_master_of_cocotb_reads_writes_and_triggers() {
    masters_of_cocotb(&[HostBus::AxiLite]);
}

#[test]
#[ignore = "slow: masters of cocotb on every bus with words"]
fn masters_of_cocotb_read_write_and_trigger() {
    masters_of_cocotb(&WORD_BUSES);
}
