//! A card's own bench, recorded, and played to something else that should do the same on every pin in every cycle.

use crate::area::run as run_tool;
use crate::scratch;
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use std::path::Path;

/// What the player says when nothing differs.
pub const SAME: &str = "PASS\n";

/// Signals of a card, without the clock.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pins {
    /// Into the card.
    pub inputs: Vec<String>,
    /// Out of it.
    pub outputs: Vec<String>,
}

/// A module that records, beside a card's own bench, what goes into the card and what it makes of it: a line for each of so many cycles.
/// Outputs that `is_inverted` names are written down the other way round.
fn recorder(card: &str, pins: &Pins, is_inverted: &dyn Fn(&str) -> bool, cycles: usize) -> String {
    let joined = |names: &[String]| {
        let pins = names.iter().rev();
        let pins: Vec<String> = pins
            .map(|name| {
                let sign = if is_inverted(name) { "~" } else { "" };
                format!("{sign}{card}_tb.dut.{name}")
            })
            .collect();
        pins.join(", ")
    };
    format!(
        "`timescale 1ns / 1ps
module recorder;
    integer file, cycle;
    initial begin file = $fopen(\"recording.txt\"); cycle = 0; end
    // Values just before the edge: nothing has moved yet.
    always @(posedge {card}_tb.clk) begin
        $fwrite(file, \"%b%b\\n\", {{{}}}, {{{}}});
        cycle = cycle + 1;
        if (cycle == {cycles}) begin $fclose(file); $finish; end
    end
endmodule
",
        joined(&pins.outputs),
        joined(&pins.inputs)
    )
}

/// Ports of an instance, connected to the bits of a vector.
fn connections(names: &[String], vector: &str) -> String {
    let names = names.iter().enumerate();
    names
        .map(|(k, name)| format!(", .{name}({vector}[{k}])"))
        .collect()
}

/// A bench that plays a recording to a module and compares all outputs before every clock edge; `instance` is the module with its
/// clock, `clk`, connected.
fn player(instance: &str, pins: &Pins, cycles: usize) -> String {
    let (i, o) = (pins.inputs.len(), pins.outputs.len());
    format!(
        "`timescale 1ns / 1ps
module player;
    reg [{row_top}:0] recording [0:{last}];
    reg clk;
    reg [{i_top}:0] in;
    reg [{o_top}:0] want;
    wire [{o_top}:0] out;
    integer cycle;
    {instance}{ins}{outs});
    initial begin
        $readmemb(\"recording.txt\", recording);
        clk = 1'b0;
        for (cycle = 0; cycle <= {last}; cycle = cycle + 1) begin
            {{want, in}} = recording[cycle];
            #5;
            if (out !== want) begin
                $display(\"cycle %0d: %b instead of %b\", cycle, out, want);
                $finish;
            end
            clk = 1'b1;
            #5;
            clk = 1'b0;
        end
        $display(\"PASS\");
        $finish;
    end
endmodule
",
        row_top = i + o - 1,
        i_top = i - 1,
        o_top = o - 1,
        last = cycles - 1,
        ins = connections(&pins.inputs, "in"),
        outs = connections(&pins.outputs, "out"),
    )
}

/// Compiles with iverilog and runs; what the simulation prints.
fn simulate(folder: &Path, tops: &[&str], more: &[&str]) -> Result<String, CommandError> {
    let mut arguments = vec!["-g2005", "-o", "sim.vvp"];
    arguments.extend(tops.iter().flat_map(|top| ["-s", top]));
    arguments.extend(more);
    run_tool("iverilog", folder, &arguments)?;
    run_tool("vvp", folder, &["-n", "sim.vvp"])
}

/// Stimulus and outputs of a card, one line a cycle, recorded while it runs in its own test bench; `files` are its Verilog and that of
/// its bench, in `folder`.
pub fn record(
    folder: &Path,
    card: &str,
    files: &[String],
    pins: &Pins,
    is_inverted: &dyn Fn(&str) -> bool,
    cycles: usize,
) -> Result<String, CommandError> {
    let text = recorder(card, pins, is_inverted, cycles);
    artifact::write(
        folder,
        &[Artifact::new("recorder.v", text)],
        scratch::REMEDY,
    )?;
    let bench = format!("{card}_tb");
    let files = files.iter().map(String::as_str);
    let files: Vec<&str> = files.chain(["recorder.v"]).collect();
    let said = simulate(folder, &["recorder", &bench], &files)?;
    if said.contains("FAIL") {
        let text = format!("{bench}: the card fails in its own bench: {said}");
        return Err(CommandError::input(text));
    }
    scratch::read(&folder.join("recording.txt"))
}

/// Plays a recording to a module of these files, which are in `folder`, or options of iverilog; what the player says, [`SAME`] if
/// nothing differs.
pub fn play(
    folder: &Path,
    recording: &str,
    instance: &str,
    pins: &Pins,
    files: &[&str],
) -> Result<String, CommandError> {
    let text = player(instance, pins, recording.lines().count());
    let more = [
        Artifact::new("recording.txt", recording),
        Artifact::new("player.v", text),
    ];
    artifact::write(folder, &more, scratch::REMEDY)?;
    let files: Vec<&str> = ["player.v"]
        .into_iter()
        .chain(files.iter().copied())
        .collect();
    simulate(folder, &["player"], &files)
}
