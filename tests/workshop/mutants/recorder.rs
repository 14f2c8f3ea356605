//! The module around a bench: it sums up every port of every block in every cycle, and ends a run that does not end.

use endat_tools::prove::Subject;
use rtl_design::elaborate::{Design, Direction, ExprKind, Module};
use rtl_design::verilog::emitted_name;
use std::fmt::Write;

/// Its name, and that of its file.
pub const TOP: &str = "mutants";
/// What a sum begins with, and below the factor of one step: FNV-1a.
pub const START: u64 = 0xCBF2_9CE4_8422_2325;
const FACTOR: u64 = 0x0100_0000_01B3;

/// A port somewhere in a card.
#[derive(Clone, Debug)]
pub struct Watched {
    /// Names of the instances from the top on, and of the port.
    pub path: String,
    /// The net that it is in an engine, where a port is one with what it is connected to.
    pub net: String,
    /// Bits.
    pub width_bits: usize,
}

/// The ports to watch of each module: its own, and those of the blocks directly below, in every place where it stands.
#[must_use]
pub fn watched(design: &Design) -> Vec<Vec<Watched>> {
    let mut found = vec![vec![]; design.modules.len()];
    let nets = design.top().nets.iter().map(|n| n.name.clone()).collect();
    walk(design, 0, "", nets, &mut found);
    found
}

/// `nets` are the names that an engine has for those of the module.
fn walk(design: &Design, index: usize, path: &str, nets: Vec<String>, found: &mut [Vec<Watched>]) {
    let module = &design.modules[index];
    found[index].extend(ports(module, path, &nets));
    for instance in &module.instances {
        let below = format!("{path}{}.", instance.name);
        let child = &design.modules[instance.module];
        let own = child.nets.iter().map(|n| format!("{below}{}", n.name));
        let mut inside: Vec<String> = own.collect();
        for (port, connection) in child.ports.iter().zip(&instance.connections) {
            if let ExprKind::Net(net) = connection.value.kind {
                inside[port.net] = nets[net].clone();
            }
        }
        found[index].extend(ports(child, &below, &inside));
        walk(design, instance.module, &below, inside, found);
    }
}

fn ports(module: &Module, path: &str, nets: &[String]) -> Vec<Watched> {
    let ports = module.ports.iter().filter(|port| !port.is_clock);
    let port = |net: usize| Watched {
        path: format!("{path}{}", emitted_name(&module.nets[net].name)),
        net: nets[net].clone(),
        width_bits: module.nets[net].width_bits,
    };
    ports.map(|p| port(p.net)).collect()
}

/// One step of a sum, as [`text`] does it.
#[must_use]
pub fn step(sum: u64, value: u128, width_bits: usize) -> u64 {
    let low = (sum ^ value as u64).wrapping_mul(FACTOR);
    match width_bits > 64 {
        true => (low ^ (value >> 64) as u64).wrapping_mul(FACTOR),
        false => low,
    }
}

/// The step of a port, and a second one if it is wide.
pub(super) fn steps(text: &mut String, path: &str, width_bits: usize) {
    let mut step = |part: &str| {
        let _ = writeln!(
            text,
            "            sum = (sum ^ {path}{part}) * 64'd{FACTOR};"
        );
    };
    if width_bits <= 64 {
        return step("");
    }
    step("[63:0]");
    step(&format!("[{}:64]", width_bits - 1));
}

/// The text; `bench` is the module that simulates the card. Plusargs: `watched`, the index of a module (all, if there is none), and `cycles_max`.
/// With `inputs` it writes the card's inputs of each cycle into `inputs.txt`, the first one lowest.
pub fn text(subject: &Subject, bench: &str) -> String {
    let design = &subject.design;
    let top = design.top();
    let name = |net: usize| emitted_name(&top.nets[net].name);
    let clock = top.ports.iter().find(|p| p.is_clock);
    let clock = clock.map_or_else(String::new, |p| name(p.net));
    let inputs = top.ports.iter().rev();
    let inputs = inputs.filter(|p| p.direction == Direction::Input && !p.is_clock);
    let inputs: Vec<String> = inputs
        .map(|p| format!("bench.dut.{}", name(p.net)))
        .collect();
    let mut sums = String::new();
    for (index, ports) in watched(design).iter().enumerate() {
        let _ = writeln!(
            sums,
            "        if (watched < 0 || watched == {index}) begin\n            sum = sums[{index}];"
        );
        for port in ports {
            steps(
                &mut sums,
                &format!("bench.dut.{}", port.path),
                port.width_bits,
            );
        }
        let _ = writeln!(sums, "            sums[{index}] = sum;\n        end");
    }
    let last = design.modules.len() - 1;
    format!(
        "`timescale 1ns / 1ps
module {TOP};
    {bench} bench ();
    integer watched, cycles_max, cycles, index, file;
    reg [63:0] sums [0:{last}];
    reg [63:0] sum;
    initial begin
        if (!$value$plusargs(\"watched=%d\", watched)) watched = -1;
        if (!$value$plusargs(\"cycles_max=%d\", cycles_max)) cycles_max = 0;
        cycles = 0;
        file = 0;
        if ($test$plusargs(\"inputs\")) file = $fopen(\"inputs.txt\", \"w\");
        for (index = 0; index <= {last}; index = index + 1) sums[index] = 64'd{START};
    end
    // Values just before the edge: nothing has moved yet.
    always @(posedge bench.dut.{clock}) begin
        cycles = cycles + 1;
        if (file != 0) $fwrite(file, \"%b\\n\", {{{inputs}}});
{sums}        if (cycles == cycles_max) begin
            $display(\"FAIL too many cycles\");
            $finish;
        end
    end
    final begin
        $display(\"cycles %0d\", cycles);
        for (index = 0; index <= {last}; index = index + 1) $display(\"sum %0d %0d\", index, sums[index]);
    end
endmodule
",
        inputs = inputs.join(", ")
    )
}
