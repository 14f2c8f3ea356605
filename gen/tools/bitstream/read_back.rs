//! What open tools have made of a card, read back as Verilog and compared with the card it was made of.

use super::replay::{self, Pins};
use super::{run, run_or};
use crate::readers::{is_bench, is_core};
use crate::scratch;
use endat_config::board::{Assignment, Board, Build, Kind, Placed, ReadBack, OSCILLATOR_PORT};
use endat_config::Project;
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use serde::Serialize;
use serde_json::{json, Value};
use std::fmt;
use std::path::Path;

/// Cycles that are compared, from power-up on: host commands, a frame that measures the delay, frames at the configured clock.
pub const CYCLES: usize = 60_000;
/// What is kept of the best seed for a netlist that is read.
const PLACED: &str = "best_placed.json";
/// How the name of the netlist ends that nextpnr writes.
const PLACED_END: &str = "_placed.json";
/// The device as plain Verilog.
const DEVICE: &str = "device.v";
/// The module that icebox_vlog writes.
const CHIP: &str = "chip";
/// The module that nextpnr writes.
const NETLIST: &str = "top";
/// What may be done when what was read is no Verilog.
const NO_MODEL: &str = "leave --simulate out: it has a cell, or a use of one, that no model here knows, and the bitstream is as good as without";
/// What installs the reader of iCE40 bitstreams.
const ICESTORM: &str = "apt install fpga-icestorm";

/// The first pin that is not as the card has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// Cycle, from power-up on.
    pub cycle: usize,
    /// The pins, with what the device says of each.
    pub pins: Vec<String>,
}

/// What came of a comparison.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Comparison {
    /// What was read.
    pub of: &'static str,
    /// Cycles that were compared, at most.
    pub cycles: usize,
    /// Where they part, if they do.
    pub difference: Option<Difference>,
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.difference {
            None => writeln!(
                f,
                "read back: the {} does what the card does, on every pin in each of {} cycles",
                self.of, self.cycles
            ),
            Some(d) => writeln!(
                f,
                "read back: the {} is NOT the card: in cycle {} {}",
                self.of,
                d.cycle,
                d.pins.join(", ")
            ),
        }
    }
}

/// How a board's result is read back; an error before anything is built if it cannot be.
pub fn way(project: &Project, board: &Board, build: &Build) -> Result<ReadBack, CommandError> {
    let wrong = |what: String| {
        Err(CommandError::input(format!(
            "--simulate: {what}; leave it out"
        )))
    };
    if let Some(pin) = project.pins.iter().find(|p| p.kind == Kind::BusData) {
        return wrong(format!(
            "{} goes both ways, and what is compared are pins that go one way",
            pin.signal
        ));
    }
    let netlist = format!("{{{{ name }}}}{}", PLACED_END);
    match build.read_back {
        Some(ReadBack::Netlist(_)) if !build.place.contains(&netlist) => wrong(format!(
            "nextpnr writes no netlist: `place` in {}/family.toml has no \"--write\", \"{netlist}\"",
            board.family.name
        )),
        Some(way) => Ok(way),
        None => wrong(format!(
            "what open tools make for {} cannot be read back, its family.toml has no read_back",
            board.family.title
        )),
    }
}

/// Pins of a card, without the oscillator.
fn pins(project: &Project) -> Pins {
    let names = |is_input: bool| {
        let pins = project.pins.iter().filter(|p| p.kind != Kind::Oscillator);
        let pins = pins.filter(|p| p.kind.is_input() == is_input);
        pins.map(|p| p.signal.clone()).collect()
    };
    Pins {
        inputs: names(true),
        outputs: names(false),
    }
}

/// Keeps what is read of the seed that was just placed.
pub(super) fn keep(folder: &Path, name: &str, way: ReadBack) -> Result<(), CommandError> {
    if let ReadBack::Netlist(_) = way {
        let path = folder.join(format!("{name}{PLACED_END}"));
        std::fs::copy(&path, folder.join(PLACED)).map_err(|e| {
            let remedy = "let `place` in the family's file write it";
            CommandError::io("read", &path, &e, remedy)
        })?;
    }
    Ok(())
}

/// Compares what is in the folder of a build with the card.
pub(super) fn compare(
    folder: &Path,
    (project, board, build, way): (&Project, &Board, &Build, ReadBack),
    artifacts: &[Artifact],
    bitstream: &str,
) -> Result<Comparison, CommandError> {
    let pins = pins(project);
    let name = project.name.as_str();
    // Lights that shine when they are low are inverted in the board top.
    let is_low = |signal: &str| {
        let pin = project.pins.iter().find(|pin| pin.signal == signal);
        pin.is_some_and(|pin| board.inverts(pin))
    };
    let verilog = artifacts.iter().filter(|a| is_core(a) || is_bench(a));
    let verilog: Vec<String> = verilog.map(|a| a.path.clone()).collect();
    let recording = replay::record(folder, name, &verilog, &pins, &is_low, CYCLES)?;
    let (of, top) = match way {
        ReadBack::Icestorm => {
            icestorm(folder, project, build, bitstream)?;
            ("bitstream", CHIP)
        }
        ReadBack::Netlist(device) => {
            netlist(folder, build, device)?;
            ("placed and routed netlist", NETLIST)
        }
    };
    let instance = format!("{top} dut (.{OSCILLATOR_PORT}(clk)");
    let said = replay::play(folder, &recording, &instance, &pins, &[DEVICE])?;
    Ok(Comparison {
        of,
        cycles: recording.lines().count(),
        difference: difference(&said, &pins)?,
    })
}

/// What the player's words mean.
fn difference(said: &str, pins: &Pins) -> Result<Option<Difference>, CommandError> {
    if said == replay::SAME {
        return Ok(None);
    }
    let read = || {
        let (cycle, values) = said.strip_prefix("cycle ")?.split_once(": ")?;
        let (got, want) = values.trim().split_once(" instead of ")?;
        // The last output comes first.
        let values = got.chars().rev().zip(want.chars().rev());
        let pins = pins.outputs.iter().zip(values);
        let pins = pins.filter(|(_, (got, want))| got != want);
        let pins = pins.map(|(pin, (got, want))| format!("{pin} = {got} instead of {want}"));
        Some(Difference {
            cycle: cycle.parse().ok()?,
            pins: pins.collect(),
        })
    };
    let found =
        read().ok_or_else(|| CommandError::fault("simulation of what was read back", &said));
    found.map(Some)
}

/// Reads the bitstream of an iCE40.
fn icestorm(
    folder: &Path,
    project: &Project,
    build: &Build,
    bitstream: &str,
) -> Result<(), CommandError> {
    // Names of pins as the constraints have them, without what else stands there.
    let place = |pin: &Assignment| format!("set_io {} {}\n", pin.signal, pin.pin);
    let places: String = project.pins.iter().map(place).collect();
    artifact::write(
        folder,
        &[Artifact::new("pins.pcf", places)],
        scratch::REMEDY,
    )?;
    let words = |text: &[&str]| text.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>();
    run(
        folder,
        &words(&["iceunpack", bitstream, "chip.asc"]),
        ICESTORM,
    )?;
    let read = words(&[
        "icebox_vlog",
        "-s",
        "-S",
        "-p",
        "pins.pcf",
        "-n",
        CHIP,
        "chip.asc",
    ]);
    let chip = run(folder, &read, ICESTORM)?.stdout;
    let clock = chip.replace("SB_PLL40_CORE #(", "clock_stand_in #(");
    let clock = clock.replace("SB_PLL40_PAD #(", "clock_stand_in #(");
    let chip = with_oscillator(&clock).unwrap_or(clock);
    let files = [
        Artifact::new("chip.v", chip),
        Artifact::new("models.v", include_str!("read_back/ice40.v")),
    ];
    artifact::write(folder, &files, scratch::REMEDY)?;
    let read = "read_verilog -D ICE40_HX -D NO_ICE40_DEFAULT_ASSIGNMENTS +/ice40/cells_sim.v; read_verilog models.v chip.v";
    flatten(folder, build, read, CHIP)
}

/// With the oscillator at a clock manager that has a pin of its own, which icebox_vlog leaves open; none if there is no such.
fn with_oscillator(chip: &str) -> Option<String> {
    let (before, rest) = chip.split_once(".PACKAGEPIN(")?;
    let (_, behind) = rest.split_once(')')?;
    Some(format!("{before}.PACKAGEPIN({OSCILLATOR_PORT}){behind}"))
}

/// What is to be known of a device to simulate the netlist that nextpnr has written of it.
struct Cells {
    /// yosys' own models of its cells, as it calls the file; none if ours have all.
    library: Option<&'static str>,
    /// Ours, which take the place of those.
    models: &'static str,
    /// Cells with inputs that are high when nothing is connected; others are low.
    high: &'static [(&'static str, &'static [&'static str])],
    /// Cells whose inputs have parameters of their own (`WEAMUX`): a constant, or the other way round, which of an open one, high, is low.
    chosen: &'static [&'static str],
}

const ECP5: Cells = Cells {
    library: None,
    models: include_str!("read_back/ecp5.v"),
    high: &[("TRELLIS_COMB", &["A", "B", "C", "D"])],
    chosen: &["DP16KD"],
};

const GOWIN: Cells = Cells {
    library: Some("+/gowin/cells_sim.v"),
    models: include_str!("read_back/gowin.v"),
    // The first adder of a chain is connected to the last one of another in the device: it must not listen.
    high: &[("ALU", &["CIN"])],
    chosen: &[],
};

/// Reads the netlist that nextpnr has written.
fn netlist(folder: &Path, build: &Build, device: Placed) -> Result<(), CommandError> {
    let device = match device {
        Placed::Ecp5 => ECP5,
        Placed::Gowin => GOWIN,
    };
    let text = scratch::read(&folder.join(PLACED))?;
    let fault = |e: &dyn fmt::Display| CommandError::fault("netlist of nextpnr", e);
    let mut netlist: Value = serde_json::from_str(&text).map_err(|e| fault(&e))?;
    // A cell may have the name of a net, which yosys does not take; nets are known by their numbers.
    netlist["modules"][NETLIST]["netnames"] = json!({});
    let cells = netlist["modules"][NETLIST]["cells"].as_object_mut();
    let cells = cells.ok_or_else(|| fault(&"it has no module top"))?;
    for cell in cells.values_mut() {
        // Memories begin empty; their contents would be 64 parameters of a model.
        if let Some(parameters) = cell["parameters"].as_object_mut() {
            let is_empty = |bits: &Value| bits.as_str().is_some_and(|bits| !bits.contains('1'));
            let is_part =
                |name: &str| name.starts_with("INIT_RAM_") || name.starts_with("INITVAL_");
            parameters.retain(|name, value| !(is_part(name) && is_empty(value)));
        }
        let kind = cell["type"].as_str().unwrap_or_default().to_owned();
        if device.chosen.contains(&kind.as_str()) {
            choose(cell);
        }
        let high = device.high.iter().find(|(of, _)| *of == kind);
        for pin in high.map_or(&[][..], |(_, pins)| pins) {
            if is_open(cell, pin) {
                drive(cell, pin, "1");
            }
        }
    }
    let files = [
        Artifact::new("netlist.json", netlist.to_string()),
        Artifact::new("memory.v", include_str!("read_back/memory.v")),
        Artifact::new("models.v", device.models),
    ];
    artifact::write(folder, &files, scratch::REMEDY)?;
    let library = device.library.map_or_else(String::new, |file| {
        format!("read_verilog -overwrite {file}; ")
    });
    let read =
        format!("read_json netlist.json; {library}read_verilog -overwrite memory.v models.v");
    flatten(folder, build, &read, NETLIST)
}

/// Whether nothing is connected to a pin of a cell.
fn is_open(cell: &Value, pin: &str) -> bool {
    let connected = cell["connections"][pin].as_array();
    connected.is_none_or(Vec::is_empty)
}

/// Connects an input of a cell to a constant.
fn drive(cell: &mut Value, pin: &str, value: &str) {
    cell["connections"][pin] = json!([value]);
    cell["port_directions"][pin] = json!("input");
}

/// Does what the parameters of a cell's inputs say. One of an input that is used the other way round stays, and no model has it.
fn choose(cell: &mut Value) {
    let Some(parameters) = cell["parameters"].as_object() else {
        return;
    };
    let of_inputs = parameters.iter().filter_map(|(name, value)| {
        let pin = name.strip_suffix("MUX")?;
        // nextpnr puts a blank behind texts that look like bits.
        Some((
            name.clone(),
            pin.to_owned(),
            value.as_str()?.trim_end().to_owned(),
        ))
    });
    for (name, pin, choice) in of_inputs.collect::<Vec<_>>() {
        match choice.as_str() {
            "0" | "1" => drive(cell, &pin, &choice),
            "INV" if is_open(cell, &pin) => drive(cell, &pin, "0"),
            _ if choice == pin && is_open(cell, &pin) => drive(cell, &pin, "1"),
            _ if choice == pin => {}
            _ => continue,
        }
        if let Some(parameters) = cell["parameters"].as_object_mut() {
            parameters.remove(&name);
        }
    }
}

/// Makes plain Verilog of what was read and of models of its cells.
fn flatten(folder: &Path, build: &Build, read: &str, top: &str) -> Result<(), CommandError> {
    // Behind a reset a channel is quiet for 30 ms, which are millions of cycles: the registers of the reset, the only ones with an
    // asynchronous one, begin as they are when it is over, and the card by the start values of its registers, as in its bench.
    let after = |set: char, over: char| {
        format!("setattr -set init 1'{over} t:$adff t:$adffe %u r:ARST_VALUE=1'{set} %i %co1:+[Q] w:* %i")
    };
    // Memories are taken together before what is undefined becomes 0: an enable of a read port among it.
    let script = format!(
        "{read}; hierarchy -top {top}; proc; flatten; memory_collect; setundef -zero -undriven; opt_clean; select -assert-min 1 t:$adff t:$adffe; {}; {}; write_verilog -noattr {DEVICE}",
        after('1', '0'),
        after('0', '1')
    );
    let words = ["yosys", "-q", "-p", &script].map(str::to_owned);
    run_or(folder, &words, &build.install, NO_MODEL).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a device that stands still, and is right until somebody asks it for something.
    #[test]
    fn the_oscillator_reaches_a_clock_manager_with_a_pin_of_its_own() {
        let text = ".DIVQ(3'd5)\n) p (\n  .PACKAGEPIN(n34),\n  .LOCK(n4)\n);";
        let told = with_oscillator(text).unwrap();
        assert_eq!(told, text.replace("n34", OSCILLATOR_PORT));
        assert_eq!(with_oscillator("  .REFERENCECLK(osc_i),"), None);
    }

    #[test]
    fn a_difference_names_its_cycle_and_pins() {
        let pins = Pins {
            inputs: vec!["i".into()],
            outputs: ["a", "b", "c"].map(str::to_owned).to_vec(),
        };
        assert_eq!(difference("PASS\n", &pins).unwrap(), None);
        let told = difference("cycle 7: 0x1 instead of 001\n", &pins).unwrap();
        let wanted = Difference {
            cycle: 7,
            pins: vec!["b = x instead of 0".into()],
        };
        assert_eq!(told, Some(wanted));
        assert!(difference("", &pins).is_err());
    }
}
