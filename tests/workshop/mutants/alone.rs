//! A block alone, with random inputs: what it is given, and the module that gives it.

use super::known::known;
use super::recorder;
use super::stimulus::{Input, Rows};
use rtl_design::elaborate::{Design, Direction, Module};
use rtl_design::verilog::emitted_name;
use std::fmt::Write;

/// The player's name, and that of its file.
pub const TOP: &str = "alone";

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

/// What a module of a design is given in each cycle, an input for each column.
pub fn rows(design: &Design, index: usize) -> Rows {
    let module = &design.modules[index];
    let seed = module.type_name.bytes().fold(1, |seed: u64, byte| {
        seed.wrapping_mul(31).wrapping_add(u64::from(byte))
    });
    Rows::new(&inputs(module), known(&part(design, index)), seed)
}

/// The rows of a module of a design as the player reads them, so many at most, the first input lowest.
pub fn rows_text(design: &Design, index: usize, cycles: usize) -> String {
    let inputs = inputs(&design.modules[index]);
    let mut text = String::new();
    for row in rows(design, index).take(cycles) {
        let bits = inputs.iter().zip(row);
        let bits = bits.flat_map(|(i, value)| (0..i.width_bits).map(move |bit| value >> bit & 1));
        text += &hexadecimal(&bits.collect::<Vec<_>>());
        text.push('\n');
    }
    text
}

/// A number from its bits, the lowest first.
fn hexadecimal(bits: &[u128]) -> String {
    let digits = bits.chunks(4).map(|four| {
        let value = four.iter().rev().fold(0, |above, bit| above << 1 | bit);
        char::from_digit(value as u32, 16).unwrap_or('0')
    });
    digits.rev().collect()
}

/// The file of a module's rows.
pub fn rows_file(module: &Module) -> String {
    format!("{}.rows", module.name)
}

/// The player of some modules, for so many cycles. Plusarg `alone` chooses one by its index in the design; what it prints is the sum over its ports, and those directly below.
pub fn text(design: &Design, modules: &[usize], cycles: usize) -> String {
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
            "        if (chosen == {index}) $readmemh(\"{}\", rows);",
            rows_file(module)
        );
    }
    format!(
        "`timescale 1ns / 1ps
module {TOP};
    reg clock;
    integer chosen, cycle;
    reg [{last}:0] rows [0:{cycles}];
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
    always @(negedge clock) if (cycle == {cycles}) begin
        $display(\"sum 0 %0d\", sum);
        $finish;
    end
endmodule
",
        start = recorder::START
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_read_as_it_is_written() {
        let bits: Vec<u128> = (0..9).map(|bit| 0x1A5 >> bit & 1).collect();
        assert_eq!(hexadecimal(&bits), "1a5");
    }
}
