//! The same stimulus on rust-hdl's kernels, on every engine for the design, on the emitted Verilog under iverilog, and on the emitted
//! VHDL under GHDL: all outputs must agree in every cycle.

use crate::{ghdl, tools};
use rtl_design::elaborate::{Design, Direction};
use rtl_design::engine::{
    Compiled, Engine, EngineError, Interpreter, Keep, LaneWords, Lanes, Port, PortId,
};
use rtl_design::verilog::{self, emitted_name, Header};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Input values, cycle by cycle.
#[derive(Clone, Debug, Default)]
pub struct Stimulus {
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// For each cycle, the value of each input.
    pub cycles: Vec<Vec<u128>>,
    /// The same in the middle of each cycle, at the falling edge of the clock; empty if that edge means nothing.
    pub middle: Vec<Vec<u128>>,
}

/// The outputs, cycle by cycle.
pub struct Recording {
    pub outputs: Vec<Port>,
    pub cycles: Vec<Vec<u128>>,
}

/// Runs an engine: in each cycle the inputs are set, the outputs noted, the clock ticked.
pub fn record(engine: &mut dyn Engine, stimulus: &Stimulus) -> Recording {
    let inputs: Vec<PortId> = stimulus
        .inputs
        .iter()
        .map(|name| engine.port(name))
        .collect();
    let outputs: Vec<Port> = engine
        .ports()
        .iter()
        .filter(|p| !p.is_input)
        .cloned()
        .collect();
    let ids: Vec<PortId> = outputs.iter().map(|p| engine.port(&p.name)).collect();
    let set = |engine: &mut dyn Engine, values: &[u128]| {
        for (port, value) in inputs.iter().zip(values) {
            engine.set(*port, *value);
        }
    };
    let cycle = |(cycle, values): (usize, &Vec<u128>)| {
        if let Some(middle) = stimulus.middle.get(cycle) {
            set(engine, middle);
            engine.fall();
        }
        set(engine, values);
        let row = ids.iter().map(|id| engine.get(*id)).collect();
        engine.tick();
        row
    };
    Recording {
        outputs,
        cycles: stimulus.cycles.iter().enumerate().map(cycle).collect(),
    }
}

impl Recording {
    /// The values of an output, cycle by cycle.
    #[allow(dead_code)] // tests of whole cards, which share this file, ask for it
    pub fn output(&self, name: &str) -> Vec<u128> {
        let at = self.outputs.iter().position(|p| p.name == name).unwrap();
        self.cycles.iter().map(|row| row[at]).collect()
    }
}

/// Checks that all executions agree and returns what they gave; `Err` names the first cycle and port where they
/// do not.
pub fn three_way(
    name: &str,
    kernel: &mut dyn Engine,
    design: &Design,
    stimulus: &Stimulus,
) -> Result<Recording, String> {
    let expected = record(kernel, stimulus);
    for port in design.top().ports.iter().filter(|p| !p.is_clock) {
        let net = &design.top().nets[port.net];
        let is_input = port.direction == Direction::Input;
        let found = kernel
            .ports()
            .iter()
            .find(|p| p.name == net.name && p.is_input == is_input);
        if found.is_none_or(|p| p.width_bits != net.width_bits) {
            return Err(format!(
                "port {}: the kernel engine does not have it so",
                net.name
            ));
        }
        if is_input && !stimulus.inputs.contains(&net.name) {
            return Err(format!("port {}: the stimulus does not drive it", net.name));
        }
    }
    for (engine_name, mut engine) in engines(design)? {
        let got = record(engine.as_mut(), stimulus);
        agree(engine_name, &expected, &got)?;
    }
    lanes_agree(design, stimulus, &expected)?;
    if tools::require(
        "iverilog",
        &format!("three-way check of {name}: emitted Verilog"),
    ) {
        replay(name, design, stimulus, &expected)?;
    }
    if tools::require("ghdl", &format!("four-way check of {name}: emitted VHDL")) {
        ghdl::replay(name, design, stimulus, &expected)?;
    }
    Ok(expected)
}

/// An engine and what it is called.
type Named = (&'static str, Box<dyn Engine>);

/// Every engine that runs a design.
pub fn engines(design: &Design) -> Result<Vec<Named>, String> {
    let error = |e: EngineError| e.to_string();
    Ok(vec![
        (
            "interpreter",
            Box::new(Interpreter::new(design).map_err(error)?),
        ),
        ("compiled", Box::new(Compiled::new(design).map_err(error)?)),
        (
            "compiled, all nets kept",
            Box::new(Compiled::keeping(design, Keep::Nets).map_err(error)?),
        ),
        (
            "compiled, portable",
            Box::new(Compiled::portable(design, Keep::Registers).map_err(error)?),
        ),
    ])
}

/// Lane `n` is given the stimulus from cycle `n` on; it must give what the compiled engine gives for that alone.
pub fn lanes_agree(
    design: &Design,
    stimulus: &Stimulus,
    expected: &Recording,
) -> Result<(), String> {
    let error = |e: EngineError| e.to_string();
    let made = [
        (
            "64 lanes",
            Lanes::new(design, Keep::Outputs, LaneWords::One),
        ),
        (
            "128 lanes",
            Lanes::new(design, Keep::Registers, LaneWords::Two),
        ),
        (
            "128 lanes, portable",
            Lanes::portable(design, Keep::Outputs, LaneWords::Two),
        ),
    ];
    let from = |lane: usize| {
        let mut moved = stimulus.clone();
        moved
            .cycles
            .rotate_left(lane % stimulus.cycles.len().max(1));
        moved
            .middle
            .rotate_left(lane % stimulus.middle.len().max(1));
        moved
    };
    let changes = Changes::of(stimulus);
    let alone = Compiled::new(design).map_err(error)?;
    let mut wanted: BTreeMap<usize, Recording> = BTreeMap::new();
    for (name, lanes) in made {
        let mut lanes = lanes.map_err(error)?;
        let inputs: Vec<PortId> = stimulus.inputs.iter().map(|n| lanes.port(n)).collect();
        let outputs: Vec<PortId> = expected
            .outputs
            .iter()
            .map(|p| lanes.port(&p.name))
            .collect();
        let watched = [0, 1, 31, lanes.lanes() / 2, lanes.lanes() - 1];
        let mut got: Vec<Vec<Vec<u128>>> = vec![vec![]; watched.len()];
        // The values before the first row of each lane.
        if let Some(count) = stimulus.cycles.len().checked_sub(1) {
            for lane in 0..lanes.lanes() {
                let row = &stimulus.cycles[(count + lane) % stimulus.cycles.len()];
                for (port, value) in inputs.iter().zip(row) {
                    lanes.set(*port, lane, *value);
                }
            }
        }
        let drive = |lanes: &mut Lanes, cycle: usize, rows: &[Vec<u128>], new: &[Vec<usize>]| {
            for lane in 0..lanes.lanes() {
                let at = (cycle + lane) % rows.len();
                for input in &new[at] {
                    lanes.set(inputs[*input], lane, rows[at][*input]);
                }
            }
        };
        for cycle in 0..stimulus.cycles.len() {
            if !stimulus.middle.is_empty() {
                drive(&mut lanes, cycle, &stimulus.middle, &changes.middle);
                lanes.fall();
            }
            drive(&mut lanes, cycle, &stimulus.cycles, &changes.cycles);
            for (lane, rows) in watched.iter().zip(&mut got) {
                rows.push(outputs.iter().map(|id| lanes.get(*id, *lane)).collect());
            }
            lanes.tick();
        }
        for (lane, rows) in watched.iter().zip(got) {
            let want = match lane {
                0 => expected,
                lane => (wanted.entry(*lane))
                    .or_insert_with(|| record(&mut alone.clone(), &from(*lane))),
            };
            let rows = Recording {
                outputs: expected.outputs.clone(),
                cycles: rows,
            };
            agree(&format!("{name}, lane {lane}"), want, &rows)?;
        }
    }
    Ok(())
}

/// For each row of a stimulus, the inputs whose values differ from the row before; the last row precedes the first.
struct Changes {
    cycles: Vec<Vec<usize>>,
    middle: Vec<Vec<usize>>,
}

impl Changes {
    fn of(stimulus: &Stimulus) -> Self {
        let new = |before: &[u128], row: &[u128]| {
            let is_new = |i: &usize| before[*i] != row[*i];
            (0..row.len()).filter(is_new).collect()
        };
        let rows = &stimulus.cycles;
        let last = |at: usize| &rows[(at + rows.len() - 1) % rows.len()];
        let middle = &stimulus.middle;
        assert!(middle.is_empty() || middle.len() == rows.len());
        Self {
            cycles: (0..rows.len())
                .map(|at| new(middle.get(at).unwrap_or(last(at)), &rows[at]))
                .collect(),
            middle: (0..middle.len())
                .map(|at| new(last(at), &middle[at]))
                .collect(),
        }
    }
}

pub fn agree(engine: &str, expected: &Recording, got: &Recording) -> Result<(), String> {
    for (cycle, expected_row) in expected.cycles.iter().enumerate() {
        for (port, want) in expected.outputs.iter().zip(expected_row) {
            let at = got.outputs.iter().position(|p| p.name == port.name);
            let got = got.cycles[cycle][at.ok_or(format!("{engine}: no port {}", port.name))?];
            if got != *want {
                return Err(format!(
                    "{engine}, cycle {cycle}, port {}: {got:#x} instead of {want:#x}",
                    port.name
                ));
            }
        }
    }
    Ok(())
}

/// Runs the emitted Verilog on the stimulus under iverilog and compares every output in every cycle.
pub fn replay(
    name: &str,
    design: &Design,
    stimulus: &Stimulus,
    expected: &Recording,
) -> Result<(), String> {
    let folder = tools::folder(&format!("three_way-{name}"));
    fs::write(
        folder.join("design.v"),
        verilog::print(design, &Header::default()),
    )
    .unwrap();
    fs::write(folder.join("bench.v"), bench(design, stimulus, expected)).unwrap();
    write_rows(&folder, "hex", design, stimulus, expected);
    let arguments = ["-g2005", "-Wall", "-o", "bench.vvp", "design.v", "bench.v"];
    let (good, text) = tools::run("iverilog", &folder, &arguments);
    if !good || !text.is_empty() {
        return Err(format!("iverilog, {}: {text}", folder.display()));
    }
    let (_, text) = tools::run("vvp", &folder, &["-n", "bench.vvp"]);
    match text.trim() {
        "PASS" => Ok(()),
        other => Err(format!("Verilog, {}: {other}", folder.display())),
    }
}

/// Writes what a bench plays, and what it expects; their names end with `end`.
pub fn write_rows(
    folder: &Path,
    end: &str,
    design: &Design,
    stimulus: &Stimulus,
    expected: &Recording,
) {
    let write = |name: &str, cycles: &[Vec<u128>], ports: &[Port]| {
        let widths: Vec<usize> = ports.iter().map(|p| p.width_bits).collect();
        fs::write(folder.join(format!("{name}.{end}")), rows(cycles, &widths)).unwrap();
    };
    let inputs = input_ports(design, stimulus);
    write("stimulus", &stimulus.cycles, &inputs);
    write("expected", &expected.cycles, &expected.outputs);
    if !stimulus.middle.is_empty() {
        write("middle", &stimulus.middle, &inputs);
    }
}

pub fn input_ports(design: &Design, stimulus: &Stimulus) -> Vec<Port> {
    let top = design.top();
    let port = |name: &String| {
        let net = top.nets.iter().find(|n| n.name == *name).unwrap();
        Port {
            name: name.clone(),
            width_bits: net.width_bits,
            is_input: true,
        }
    };
    stimulus.inputs.iter().map(port).collect()
}

/// Each row as one binary word, the first value in the lowest bits.
fn rows(cycles: &[Vec<u128>], widths: &[usize]) -> String {
    let mut out = String::new();
    for row in cycles {
        for (value, width) in row.iter().zip(widths).rev() {
            let _ = write!(out, "{value:0width$b}");
        }
        if widths.is_empty() {
            out.push('0');
        }
        out.push('\n');
    }
    out
}

fn bench(design: &Design, stimulus: &Stimulus, expected: &Recording) -> String {
    let inputs = input_ports(design, stimulus);
    let total = |ports: &[Port]| ports.iter().map(|p| p.width_bits).sum::<usize>().max(1);
    let (input_bits, output_bits) = (total(&inputs), total(&expected.outputs));
    let last = stimulus.cycles.len() - 1;
    let mut connections = vec![];
    let mut checks = String::new();
    let top = design.top();
    for port in top.ports.iter().filter(|p| p.is_clock) {
        connections.push(format!(".{}(clk)", emitted_name(&top.nets[port.net].name)));
    }
    let mut low = 0;
    for port in &inputs {
        let high = low + port.width_bits - 1;
        connections.push(format!(".{}(in[{high}:{low}])", emitted_name(&port.name)));
        low += port.width_bits;
    }
    low = 0;
    for port in &expected.outputs {
        let high = low + port.width_bits - 1;
        connections.push(format!(".{}(out[{high}:{low}])", emitted_name(&port.name)));
        let _ = write!(
            checks,
            "            if (out[{high}:{low}] !== want[{high}:{low}]) begin
                $display(\"cycle %0d, port {}: %h instead of %h\", cycle, out[{high}:{low}], want[{high}:{low}]);
                $finish;
            end
",
            port.name
        );
        low += port.width_bits;
    }
    // The clock stays HIGH into the next cycle if its falling edge means something.
    let (load_middle, fall, end) = match stimulus.middle.is_empty() {
        true => (String::new(), "", "            clk = 1'b0;\n"),
        false => (
            format!("    reg [{}:0] middle [0:{last}];\n    initial $readmemb(\"middle.hex\", middle);\n", input_bits - 1),
            "            in = middle[cycle];\n            #5;\n            clk = 1'b0;\n            #1;\n",
            "",
        ),
    };
    format!(
        "`timescale 1ns / 1ps
module bench;
    reg [{input_top}:0] stimulus [0:{last}];
    reg [{output_top}:0] expected [0:{last}];
    reg clk;
    reg [{input_top}:0] in;
    reg [{output_top}:0] want;
    wire [{output_top}:0] out;
    integer cycle;
{load_middle}    {name} dut ({connections});
    initial begin
        $readmemb(\"stimulus.hex\", stimulus);
        $readmemb(\"expected.hex\", expected);
        clk = 1'b0;
        for (cycle = 0; cycle <= {last}; cycle = cycle + 1) begin
{fall}            in = stimulus[cycle];
            want = expected[cycle];
            #5;
{checks}            clk = 1'b1;
            #5;
{end}        end
        $display(\"PASS\");
        $finish;
    end
endmodule
",
        input_top = input_bits - 1,
        output_top = output_bits - 1,
        name = top.name,
        connections = connections.join(", "),
    )
}
