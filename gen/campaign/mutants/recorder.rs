//! The module around a bench: it sums up every port of every block in every cycle, and ends a run that does not end.

use crate::prove::Subject;
use rtl_design::elaborate::{Design, Direction};
use rtl_design::verilog::emitted_name;
use std::fmt::Write;

/// Its name, and that of its file.
pub const TOP: &str = "mutants";
/// What a sum begins with, and the factor of one step: FNV-1a, as everywhere.
const START: u64 = 0xCBF2_9CE4_8422_2325;
const FACTOR: u64 = 0x0100_0000_01B3;

/// A port somewhere in a card.
#[derive(Clone, Debug)]
pub struct Watched {
    /// Names of the instances from the top on, and of the port.
    pub path: String,
    /// Bits.
    pub width_bits: usize,
}

/// The ports to watch of each module: its own, and those of the blocks directly below, in every place where it stands.
pub fn watched(design: &Design) -> Vec<Vec<Watched>> {
    let mut found = vec![vec![]; design.modules.len()];
    walk(design, 0, "", &mut found);
    found
}

fn walk(design: &Design, index: usize, path: &str, found: &mut [Vec<Watched>]) {
    found[index].extend(ports(design, index, path));
    for instance in &design.modules[index].instances {
        let below = format!("{path}{}.", instance.name);
        found[index].extend(ports(design, instance.module, &below));
        walk(design, instance.module, &below, found);
    }
}

fn ports(design: &Design, index: usize, path: &str) -> Vec<Watched> {
    let module = &design.modules[index];
    let ports = module.ports.iter().filter(|port| !port.is_clock);
    let port = |net: usize| Watched {
        path: format!("{path}{}", emitted_name(&module.nets[net].name)),
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

/// The sum of nothing.
pub const fn start() -> u64 {
    START
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
        for Watched { path, width_bits } in ports {
            let path = format!("bench.dut.{path}");
            let low = match width_bits {
                0..=64 => path.clone(),
                _ => format!("{path}[63:0]"),
            };
            let _ = writeln!(sums, "            sum = (sum ^ {low}) * 64'd{FACTOR};");
            if *width_bits > 64 {
                let top = width_bits - 1;
                let _ = writeln!(
                    sums,
                    "            sum = (sum ^ {path}[{top}:64]) * 64'd{FACTOR};"
                );
            }
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
