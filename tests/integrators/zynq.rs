//! The block design for Zynq: Vivado's commands, for which tclsh stands in, put it together as the processor and the card need it.

use super::written;
use crate::tools::{require, run};
use endat_config::board::Board;
use endat_config::parse;
use endat_emit::{emit, emit_in, language::Language};
use endat_hdl::card::bus::HostBus;
use std::collections::BTreeSet;
use std::fs;

/// What stands in for Vivado.
const VIVADO: &str = include_str!("../data/block_design.tcl");

/// How a run of the script is set up.
struct Setup {
    /// The end of the configuration.
    more: &'static str,
    language: Language,
    /// Boards that Vivado has files of.
    boards: &'static str,
    /// The clock that the processor's dividers make.
    made_mhz: &'static str,
    /// Slack of the finished design, in ns.
    slack: &'static str,
    arguments: &'static str,
}

const USUAL: Setup = Setup {
    more: "[outputs]\nparts = [\"interrupt\"]\n",
    language: Language::Verilog,
    boards: "digilentinc.com:zybo-z7-10:part0:1.0 digilentinc.com:zybo-z7-10:part0:1.2",
    made_mhz: "100.000000",
    slack: "0.4",
    arguments: "",
};

/// What came of it, and the constraints that it wrote.
fn played(setup: &Setup, name: &str) -> (bool, String, String) {
    let text = crate::bus_card::text(HostBus::AxiLite, setup.more);
    let project = parse("card.toml", &text).unwrap();
    let folder = written(&emit_in(&project, setup.language).unwrap(), name);
    let instance = fs::read_to_string(folder.join("axi_lite_card_instance.vho")).unwrap();
    let ports = instance.lines().filter_map(|line| {
        let name = line.trim().split_once(" => ")?.0.trim();
        let is_output = ["_o", "_oe"].iter().any(|end| name.ends_with(end));
        let is_bus = name.starts_with("s_axi_");
        (!is_bus).then(|| format!("{name} {}", if is_output { "O" } else { "I" }))
    });
    let ports: BTreeSet<String> = ports.collect();
    let version = env!("CARGO_PKG_VERSION");
    let script = format!(
        "set ports {{{}}}\nset vlnv endat-gen:motion:axi_lite_card:{version}\nset interface s_axi\nset boards {{{}}}\n\
         set made_mhz {}\nset slack {}\nset argv {{{}}}\n{VIVADO}\nsource axi_lite_card_zynq.tcl\nfacts\n",
        ports.into_iter().collect::<Vec<_>>().join(" "),
        setup.boards, setup.made_mhz, setup.slack, setup.arguments
    );
    fs::write(folder.join("stand_in.tcl"), script).unwrap();
    let (is_good, told) = run("tclsh", &folder, &["stand_in.tcl"]);
    let constraints = fs::read_to_string(folder.join("zynq/pins.xdc")).unwrap_or_default();
    (is_good, told, constraints)
}

/// Catches a clock, a reset, an interrupt or a bus that goes nowhere, and a line of an encoder that is on another pin than the board's file says.
#[test]
fn the_block_design_joins_processor_card_and_pins() {
    if !require("tclsh", "block design") {
        return;
    }
    for language in [Language::Verilog, Language::Vhdl] {
        let setup = Setup { language, ..USUAL };
        let (is_good, told, constraints) = played(&setup, "zynq");
        assert!(is_good, "{told}");
        for line in [
            "core/clk_i <- processor/FCLK_CLK0",
            "bus/aclk <- processor/FCLK_CLK0",
            "reset/slowest_sync_clk <- processor/FCLK_CLK0",
            "processor/M_AXI_GP0_ACLK <- processor/FCLK_CLK0",
            "reset/ext_reset_in <- processor/FCLK_RESET0_N",
            "core/rst_i <- reset/peripheral_reset",
            "bus/aresetn <- reset/interconnect_aresetn",
            "processor/IRQ_F2P <- core/irq_o",
            "core/s_axi <= bus/M00_AXI",
            "bus/S00_AXI <= processor/M_AXI_GP0",
            "core/endat_data1_i <- endat_data1_i",
            "endat_clk0_o <- core/endat_clk0_o",
            "address 0x43C00000 8192",
            "clock 100",
            "board digilentinc.com:zybo-z7-10:part0:1.2 preset 2 part xc7z010clg400-1",
        ] {
            assert!(told.lines().any(|l| l == line), "{line} is not in\n{told}");
        }
        let zybo = Board::named("zybo_z7_10").unwrap();
        let pin = |signal: &str| zybo.pin(zybo.usual_place(signal).unwrap()).unwrap();
        for signal in [
            "endat_clk0_o",
            "endat_data0_oe",
            "endat_data1_i",
            "trigger_i",
        ] {
            let line = format!(
                "set_property -dict {{PACKAGE_PIN {} IOSTANDARD LVCMOS33}} [get_ports {signal}]",
                pin(signal)
            );
            assert!(
                constraints.contains(&line),
                "{line} is not in\n{constraints}"
            );
        }
        let pins: Vec<&str> = constraints
            .lines()
            .filter_map(|l| l.split(' ').nth(3))
            .collect();
        let different: BTreeSet<_> = pins.iter().collect();
        assert_eq!(pins.len(), different.len(), "{constraints}");
    }
}

#[test]
fn the_block_design_goes_on_to_the_bitstream_if_it_is_asked_to() {
    if !require("tclsh", "block design") {
        return;
    }
    let (is_good, told, _) = played(
        &Setup {
            arguments: "bitstream",
            boards: "",
            ..USUAL
        },
        "zynq-bitstream",
    );
    assert!(
        is_good && told.contains("platform axi_lite_card.xsa"),
        "{told}"
    );
    assert!(
        told.contains("Vivado has no files of digilentinc.com:zybo-z7-10:*"),
        "{told}"
    );
}

/// Catches a design that is made although it cannot work.
#[test]
fn what_the_block_design_cannot_do_is_refused() {
    if !require("tclsh", "block design") {
        return;
    }
    let third = "[[channel]]\nposition_bits = 13\ncommand = \"000111\"\n";
    for (setup, wanted) in [
        (Setup { more: third, ..USUAL }, "endat_clk2_o has no pin here: write one behind it in the list of axi_lite_card_zynq.tcl"),
        (Setup { made_mhz: "99.999", ..USUAL }, "FCLK_CLK0 = 99.999 MHz: the processor's dividers do not make 100 MHz; give clock.system_hz a rate that they make"),
        (Setup { slack: "-0.1", arguments: "bitstream", ..USUAL }, "no bitstream, or one that is too slow"),
    ] {
        let (is_good, told, _) = played(&setup, "zynq-refused");
        assert!(!is_good && told.contains(wanted), "{told}");
    }
}

/// Catches a script that puts the registers where the processor does not look, or where the register map says otherwise.
#[test]
fn the_block_design_has_the_registers_where_the_map_has_them() {
    if !require("tclsh", "block design") {
        return;
    }
    let more = "base_address = 0x4000_2000\n";
    let (is_good, told, _) = played(&Setup { more, ..USUAL }, "zynq-base");
    assert!(
        is_good && told.contains("address 0x40002000 8192"),
        "{told}"
    );
    let out_of_reach = crate::bus_card::text(HostBus::AxiLite, "base_address = 0x8000_0000\n");
    let others = crate::bus_card::text(HostBus::Wishbone, "");
    for text in [out_of_reach, others] {
        let files = emit(&parse("card.toml", &text).unwrap()).unwrap();
        let scripts = files.iter().filter(|file| file.path.ends_with("_zynq.tcl"));
        assert_eq!(scripts.count(), 0);
    }
}
