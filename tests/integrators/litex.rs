//! LiteX: a system with a card on its bus, simulated.

use super::written;
use crate::tools::{require, require_python, run};
use endat_config::parse;
use endat_emit::emit;
use std::fs;

/// The system's pins: DATA stays HIGH, as without an encoder. Ends when a result has interrupted, or when that takes too long.
const BENCH: &str = "
`timescale 1ns / 1ps
module bench;
    reg clk = 1'b0;
    always #5 clk = !clk;
    wire done, wrong, irq;
    integer cycles = 0;
    soc dut (
        .sys_clk(clk), .sys_rst(1'b0), .report_done(done), .report_wrong(wrong), .report_irq(irq), .endat_endat_clk0_o(),
        .endat_endat_data0_o(), .endat_endat_data0_oe(), .endat_endat_data0_i(1'b1), .endat_trigger_i(1'b0), .sim_trace(1'b0));
    always @(posedge clk) begin
        cycles = cycles + 1;
        if ((done && irq) || cycles == 600_000) begin
            $display(\"done=%b wrong=%b irq=%b\", done, wrong, irq);
            $finish;
        end
    end
endmodule
";

/// A slow system clock: the 30 ms after a reset are few cycles then.
fn text(bus: &str) -> String {
    format!(
        "name = \"{bus}_card\"\n[clock]\nsystem_hz = 8_000_000\n[endat]\nclock_hz = 1_000_000\n\
         [[channel]]\nposition_bits = 29\ncommand = \"111000\"\n[trigger]\nsample_hz = 1_000\nsources = [\"register\"]\n\
         [host]\nbus = \"{bus}\"\nbase_address = 0x4000_0000\n[outputs]\nparts = [\"interrupt\"]\n"
    )
}

/// Catches a signal of the bus in another one's place, an address that is not the system's, pads and an interrupt that lead nowhere.
/// Verilator builds the whole system; the quick suite elaborates the card as a module of LiteX.
#[test]
#[ignore = "slow: LiteX system with Wishbone"]
fn a_litex_system_reads_the_card_and_is_interrupted() {
    reads_the_card("wishbone", "WishboneCard");
}

#[test]
#[ignore = "slow: LiteX system with AXI4-Lite"]
fn a_litex_system_with_axi_lite_reads_the_card_and_is_interrupted() {
    reads_the_card("axi_lite", "AxiLiteCard");
}

fn reads_the_card(bus: &str, class: &str) {
    let check = "LiteX system";
    if !require_python("litex", check) || !require("verilator", check) {
        return;
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/litex_soc.py");
    let files = emit(&parse("card.toml", &text(bus)).unwrap()).unwrap();
    let name = format!("{bus}_card");
    let place = written(&files, &format!("litex-{bus}"));
    let header = fs::read_to_string(place.join(format!("{name}_registers.h"))).unwrap();
    let base = format!("#define {}_BASE_ADDRESS 0x40000000u\n", name.to_uppercase());
    assert!(header.contains(&base), "{header}");
    let end = "_CARD_CONFIGURATION_HASH_RESET ";
    let hash = header.lines().find_map(|l| l.split_once(end)).unwrap().1;
    let arguments = [script, &name, class, hash.trim_end_matches('u')];
    let (is_good, told) = run("python3", &place, &arguments);
    assert!(is_good, "{bus}: {told}");
    fs::write(place.join("bench.v"), BENCH).unwrap();
    let sources = fs::read_to_string(place.join("sources")).unwrap();
    // LiteX assigns combinational signals in blocks that read each other, which iverilog may evaluate for ever.
    let options = [
        "--binary",
        "--timing",
        "-Wno-fatal",
        "--top-module",
        "bench",
        "-Mdir",
        "sim",
    ];
    let mut arguments = [&options[..], &["bench.v", "soc.v"]].concat();
    arguments.extend(sources.lines());
    let (is_good, told) = run("verilator", &place, &arguments);
    assert!(is_good, "{bus}: {told}");
    let program = place.join("sim/Vbench");
    let (_, told) = run(program.to_str().unwrap(), &place, &[]);
    assert!(told.contains("done=1 wrong=0 irq=1"), "{bus}: {told}");
}
