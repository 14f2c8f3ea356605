//! A bitstream read back: what its bits say, simulated against the card that it was made of.

use crate::program::Dir;
use crate::tools::{self, run};
use crate::verilog::{compile, netlist};
use endat_gen::board::Kind;
use endat_gen::config::Project;
use std::collections::BTreeSet;
use std::fs;

/// Cycles that are compared: reset, host commands, a frame that measures the delay, frames at the configured clock.
const CYCLES: usize = 50_000;

/// How many stages the reset of the board top has.
const RESET_STAGES: usize = 4;

/// How long the card is held in reset first: whoever plays it begins as the card does, synchronisers filled by the same pins.
const HELD_CYCLES: usize = 16;

/// A clock manager that gives the oscillator on, and locks when the player says so.
const CLOCK: &str = "
module clock_stand_in #(
    parameter FEEDBACK_PATH = 0, parameter DELAY_ADJUSTMENT_MODE_FEEDBACK = 0, parameter DELAY_ADJUSTMENT_MODE_RELATIVE = 0,
    parameter SHIFTREG_DIV_MODE = 0, parameter FDA_FEEDBACK = 0, parameter FDA_RELATIVE = 0, parameter PLLOUT_SELECT = 0,
    parameter DIVR = 0, parameter DIVF = 0, parameter DIVQ = 0, parameter FILTER_RANGE = 0, parameter ENABLE_ICEGATE = 0,
    parameter TEST_MODE = 0, parameter EXTERNAL_DIVIDE_FACTOR = 1
) (
    input REFERENCECLK, input PACKAGEPIN, output PLLOUTCORE, output PLLOUTGLOBAL, input EXTFEEDBACK, input [7:0] DYNAMICDELAY,
    output LOCK, input BYPASS, input RESETB, input LATCHINPUTVALUE, input SDI, input SCLK, output SDO
);
    assign PLLOUTCORE = player.osc;
    assign PLLOUTGLOBAL = player.osc;
    assign LOCK = player.lock;
endmodule
";

/// Plays a recording to the chip, whose clock locks so that its reset ends when the recorded one did; the first input is that reset.
fn player(inputs: &[String], outputs: &[String]) -> String {
    let (i, o) = (inputs.len(), outputs.len());
    format!(
        "`timescale 1ns / 1ps
{CLOCK}
module player;
    reg [{row_top}:0] recording [0:{last}];
    reg osc;
    reg lock;
    reg [{i_top}:0] in;
    wire [{pins_top}:0] pins = in[{i_top}:1];
    reg [{o_top}:0] want;
    wire [{o_top}:0] out;
    integer cycle;
    chip dut (.osc_i(osc){ins}{outs});
    initial begin
        $readmemb(\"recording.txt\", recording);
        osc = 1'b0;
        lock = 1'b0;
        // Before the recording: without a clock that has locked, then as many cycles as the reset needs to end.
        for (cycle = -2 - {RESET_STAGES}; cycle <= {last} - {RESET_STAGES}; cycle = cycle + 1) begin
            if (cycle >= -{RESET_STAGES}) begin
                {{want, in}} = recording[cycle + {RESET_STAGES}];
                lock = ~in[0];
            end
            {{want, in}} = recording[cycle < 0 ? 0 : cycle];
            #5;
            // All registers of the reset and of the pins have their values.
            if (cycle >= {HELD_CYCLES} / 2 && out !== want) begin
                $display(\"cycle %0d: %b instead of %b\", cycle, out, want);
                $finish;
            end
            osc = 1'b1;
            #5;
            osc = 1'b0;
        end
        $display(\"PASS\");
        $finish;
    end
endmodule
",
        row_top = i + o - 1,
        i_top = i - 1,
        pins_top = i - 2,
        o_top = o - 1,
        last = CYCLES - 1,
        ins = netlist::connections(&inputs[1..], "pins"),
        outs = netlist::connections(outputs, "out"),
    )
}

/// Reads a bitstream of iCE40 back, and compares it with the card on every pin in every cycle of the card's own bench.
pub fn compare_ice40(dir: &Dir, project: &Project, bitstream: &str) {
    let wanted = ["iceunpack", "icebox_vlog", "iverilog", "yosys"];
    if !tools::require_all(&wanted, "bitstream read back") {
        return;
    }
    let (folder, name) = (&dir.0, project.name.as_str());
    let (inputs, outputs): (Vec<_>, Vec<_>) = (project.pins.iter())
        .filter(|pin| pin.kind != Kind::Oscillator)
        .partition(|pin| pin.kind.is_input());
    let names = |pins: Vec<&endat_gen::board::Assignment>| -> Vec<String> {
        pins.iter().map(|pin| pin.signal.clone()).collect()
    };
    let inputs = [vec!["rst_i".to_owned()], names(inputs)].concat();
    let outputs = names(outputs);

    let mut sources = vec![];
    for file in endat_gen::emit(project).unwrap() {
        let is_top = file.path.ends_with("_top.v");
        if file.path.ends_with(".v") && !is_top {
            fs::write(folder.join(&file.path), &file.text).unwrap();
            sources.push(file.path);
        }
    }
    let recorder = netlist::recorder(name, &inputs, &outputs, CYCLES);
    let bench = format!("{name}_tb");
    let holder = format!(
        "module holder;
    initial begin
        force {bench}.dut.rst_i = 1'b1;
        repeat ({HELD_CYCLES}) @(posedge {bench}.clk);
        #1 release {bench}.dut.rst_i;
    end
endmodule
"
    );
    fs::write(folder.join("recorder.v"), recorder + &holder).unwrap();
    sources.push("recorder.v".into());
    compile(
        folder,
        "recorder",
        &sources,
        &["-s", &bench, "-s", "holder"],
    );
    let (is_good, told) = run("vvp", folder, &["-n", "sim.vvp"]);
    assert!(is_good && !told.contains("FAIL"), "{told}");
    let recording = fs::read_to_string(folder.join("recording.txt")).unwrap();
    assert_eq!(recording.lines().count(), CYCLES);
    for (place, name) in outputs.iter().rev().enumerate() {
        let bits: BTreeSet<u8> = recording.lines().map(|l| l.as_bytes()[place]).collect();
        assert!(
            bits.len() == 2 || name.starts_with("led_"),
            "{name} does not move"
        );
    }

    // Names of pins as the constraints have them, without what else stands there.
    let place = |pin: &endat_gen::board::Assignment| format!("set_io {} {}\n", pin.signal, pin.pin);
    let places: String = project.pins.iter().map(place).collect();
    fs::write(folder.join("pins.pcf"), places).unwrap();
    let (is_good, told) = run("iceunpack", folder, &[bitstream, "chip.asc"]);
    assert!(is_good, "{told}");
    let read = ["-s", "-S", "-p", "pins.pcf", "-n", "chip", "chip.asc"];
    let (is_good, chip) = run("icebox_vlog", folder, &read);
    assert!(is_good, "{chip}");
    let clock = ["SB_PLL40_CORE #(", "SB_PLL40_PAD #("];
    let clock = clock.iter().find(|clock| chip.contains(*clock));
    let clock = clock.unwrap_or_else(|| panic!("no clock manager: {}", &chip[..2000]));
    let chip = chip.replace(clock, "clock_stand_in #(");
    fs::write(folder.join("player.v"), player(&inputs, &outputs)).unwrap();
    let cells = netlist::share().join("ice40/cells_sim.v");
    let play = |chip: &str| {
        fs::write(folder.join("chip.v"), chip).unwrap();
        let cells = cells.to_str().unwrap();
        let arguments = [
            "-g2005",
            "-DNO_ICE40_DEFAULT_ASSIGNMENTS",
            "-o",
            "chip.vvp",
            "-s",
            "player",
            "player.v",
            "chip.v",
            cells,
        ];
        let (is_good, told) = run("iverilog", folder, &arguments);
        assert!(is_good, "{told}");
        run("vvp", folder, &["-n", "chip.vvp"]).1
    };
    assert_eq!(play(&chip), "PASS\n");
    // One wire the other way round: the comparison sees it.
    let wire = "assign endat_clk0_o = ";
    assert_eq!(chip.matches(wire).count(), 1);
    assert_ne!(
        play(&chip.replace(wire, "assign endat_clk0_o = !")),
        "PASS\n"
    );
}
