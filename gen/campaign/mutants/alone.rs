//! A block alone, with random inputs: what it is given, and the module that gives it.

use super::recorder;
use endat_sim::rng::Rng;
use rtl_design::elaborate::{mask, Design, Direction, Module};
use rtl_design::verilog::emitted_name;
use std::fmt::Write;

/// The player's name, and that of its file.
pub const TOP: &str = "alone";
/// Cycles of a block.
pub const CYCLES: usize = 24_000;
/// How long each input goes on in the same way, in cycles.
const EPOCH_CYCLES: std::ops::RangeInclusive<u64> = 40..=800;
/// Mean cycles between two resets behind the first one.
const RESET_CYCLES: u64 = 3_000;

/// The part of a design that is below one of its modules, which is the top.
#[must_use]
pub fn part(design: &Design, top: usize) -> Design {
    // Modules stand before those in them, so one walk from the top finds them all.
    let mut order = vec![top];
    for index in top..design.modules.len() {
        if order.contains(&index) {
            order.extend(design.modules[index].instances.iter().map(|i| i.module));
        }
    }
    order.sort_unstable();
    order.dedup();
    let place = |module: usize| order.iter().position(|&known| known == module).unwrap_or(0);
    let mut modules: Vec<Module> = order.iter().map(|&i| design.modules[i].clone()).collect();
    for instance in modules.iter_mut().flat_map(|m| &mut m.instances) {
        instance.module = place(instance.module);
    }
    Design {
        modules,
        ..design.clone()
    }
}

/// An input, and its bits.
pub struct Input {
    /// Its name.
    pub name: String,
    /// Bits.
    pub width_bits: usize,
}

/// The inputs of a module but for its clock.
#[must_use]
pub fn inputs(module: &Module) -> Vec<Input> {
    let ports = module.ports.iter();
    let ports = ports.filter(|p| p.direction == Direction::Input && !p.is_clock);
    ports
        .map(|port| Input {
            name: emitted_name(&module.nets[port.net].name),
            width_bits: module.nets[port.net].width_bits,
        })
        .collect()
}

/// How an input goes on for a while.
struct Way {
    cycles: u64,
    /// It changes once in so many cycles.
    hold_cycles: u64,
    /// Highest bit of what it takes.
    bits: u64,
    /// Back to 0 in the next cycle.
    is_strobe: bool,
    counts: bool,
}

impl Way {
    fn new(rng: &mut Rng, width_bits: usize) -> Self {
        let holds = [1, 2, 4, 8, 16, 50, 200, 100_000];
        Self {
            cycles: rng.in_range(*EPOCH_CYCLES.start(), *EPOCH_CYCLES.end()),
            hold_cycles: holds[rng.in_range(0, holds.len() as u64 - 1) as usize],
            // Half of them are small: what is counted down ends.
            bits: match rng.in_range(0, 1) {
                0 => width_bits as u64,
                _ => rng.in_range(1, width_bits as u64),
            },
            is_strobe: rng.in_range(0, 2) == 0,
            counts: rng.in_range(0, 5) == 0,
        }
    }

    fn value(&self, rng: &mut Rng, now: u128, width_bits: usize) -> u128 {
        let changes = rng.in_range(1, self.hold_cycles) == 1;
        let random = u128::from(rng.next_u64()) << 64 | u128::from(rng.next_u64());
        let all = mask(width_bits);
        match (changes, width_bits) {
            (false, 1) if self.is_strobe => 0,
            (false, _) if !self.counts => now,
            (false, _) => now.wrapping_add(1) & all,
            (true, 1) if self.is_strobe => 1,
            (true, 1) => random & 1,
            // A bit that is another one; everything; nothing; anything.
            (true, _) => match rng.in_range(0, 7) {
                0 => now ^ (1 << rng.in_range(0, width_bits as u64 - 1)),
                1 => all,
                2 => 0,
                _ => random & mask(self.bits as usize),
            },
        }
    }
}

/// What a module is given in each cycle, an input for each column.
#[must_use]
pub fn rows(module: &Module) -> Vec<Vec<u128>> {
    let seed = module.type_name.bytes().fold(1, |seed: u64, byte| {
        seed.wrapping_mul(31).wrapping_add(u64::from(byte))
    });
    let mut rng = Rng::new(seed);
    let inputs = inputs(module);
    let mut ways: Vec<Way> = inputs
        .iter()
        .map(|i| Way::new(&mut rng, i.width_bits))
        .collect();
    let mut row = vec![0; inputs.len()];
    let mut cycle = |cycle: usize| {
        for ((input, way), value) in inputs.iter().zip(&mut ways).zip(&mut row) {
            way.cycles -= 1;
            if way.cycles == 0 {
                *way = Way::new(&mut rng, input.width_bits);
            }
            *value = match input.name.as_str() {
                "reset" | "rst_i" => u128::from(cycle < 3 || rng.in_range(1, RESET_CYCLES) == 1),
                _ => way.value(&mut rng, *value, input.width_bits),
            };
        }
        row.clone()
    };
    (0..CYCLES).map(&mut cycle).collect()
}

/// The rows of a module as the player reads them, the first input lowest.
pub fn rows_text(module: &Module) -> String {
    let inputs = inputs(module);
    let mut text = String::new();
    for row in rows(module) {
        for (input, value) in inputs.iter().zip(row).rev() {
            let _ = write!(text, "{value:0width$b}", width = input.width_bits);
        }
        text.push('\n');
    }
    text
}

/// The file of a module's rows.
pub fn rows_file(module: &Module) -> String {
    format!("{}.rows", module.name)
}

/// The player of some modules. Plusarg `alone` chooses one by its index in the design; what it prints is the sum over its ports, and those directly below.
pub fn text(design: &Design, modules: &[usize]) -> String {
    let widths = modules.iter().map(|&index| {
        let inputs = inputs(&design.modules[index]);
        inputs.iter().map(|i| i.width_bits).sum::<usize>()
    });
    let last = widths.max().unwrap_or(1).max(1) - 1;
    let (mut blocks, mut loads) = (String::new(), String::new());
    for &index in modules {
        let module = &design.modules[index];
        let clock = module.ports.iter().find(|p| p.is_clock);
        let clock = clock.map(|p| emitted_name(&module.nets[p.net].name));
        let mut connections: Vec<String> = clock
            .iter()
            .map(|c| format!(".{c}(clock_{index})"))
            .collect();
        let mut from = 0;
        for input in inputs(module) {
            let to = from + input.width_bits - 1;
            connections.push(format!(".{}(row_{index}[{to}:{from}])", input.name));
            from = to + 1;
        }
        let mut sums = String::new();
        for port in recorder::watched(&part(design, index)).swap_remove(0) {
            let path = format!("dut_{index}.{}", port.path);
            recorder::steps(&mut sums, &path, port.width_bits);
        }
        let _ = write!(
            blocks,
            "    wire clock_{index} = clock & (chosen == {index});
    wire [{last}:0] row_{index} = (chosen == {index}) ? row : {zero}'d0;
    {name} dut_{index} ({connections});
    always @(posedge clock_{index}) begin
{sums}    end
",
            zero = last + 1,
            name = module.name,
            connections = connections.join(", "),
        );
        let _ = writeln!(
            loads,
            "        if (chosen == {index}) $readmemb(\"{}\", rows);",
            rows_file(module)
        );
    }
    format!(
        "`timescale 1ns / 1ps
module {TOP};
    reg clock;
    integer chosen, cycle;
    reg [{last}:0] rows [0:{CYCLES}];
    reg [{last}:0] row;
    reg [63:0] sum;
{blocks}    initial begin
        if (!$value$plusargs(\"alone=%d\", chosen)) chosen = -1;
{loads}        clock = 1'b0;
        row = rows[0];
        sum = 64'd{start};
        cycle = 0;
    end
    always #5 clock = !clock;
    // Behind the edge: a block on the falling edge has the row of the same cycle.
    always @(posedge clock) begin
        cycle = cycle + 1;
        row <= rows[cycle];
    end
    always @(negedge clock) if (cycle == {CYCLES}) begin
        $display(\"sum 0 %0d\", sum);
        $finish;
    end
endmodule
",
        start = recorder::START
    )
}
