//! Registers and memories as Verilog text.

use super::module::expression::{bits, literal, named_literal};
use super::module::ModulePrinter;
use super::text::{comment, vector, INDENT};
use crate::elaborate::{Memory, NetId, Register};
use crate::printing::register_groups;
use std::collections::BTreeSet;

impl ModulePrinter<'_> {
    pub fn start(&mut self, register: &Register) -> String {
        let net = &self.module.nets[register.q];
        let state = self.scope.start_state(register);
        state.unwrap_or_else(|| named_literal(&net.name, register.start, net.width_bits))
    }

    /// One clocked process for all registers of one clock and reset.
    pub fn registers(&mut self) -> String {
        let mut out = String::new();
        for ((clock, on_fall, reset), group) in register_groups(self.module) {
            let name = |net: NetId| &self.module.nets[net].name;
            let (pad, deep) = (INDENT.repeat(2), INDENT.repeat(3));
            let edge = if on_fall { "negedge" } else { "posedge" };
            let head = format!("\n{INDENT}always @({edge} {}) begin\n", name(clock));
            let reset = reset.map(|net| name(net).clone());
            let body = match reset {
                None => self.next_values(&group, 2),
                Some(reset) => {
                    let next = self.next_values(&group, 3);
                    let mut start = |r: &&Register| {
                        let start = self.start(r);
                        format!("{deep}{} <= {start};\n", self.module.nets[r.q].name)
                    };
                    let starts: String = group.iter().map(&mut start).collect();
                    format!(
                        "{pad}if ({reset}) begin\n{starts}{pad}end else begin\n{next}{pad}end\n"
                    )
                }
            };
            out.push_str(&format!("{head}{body}{INDENT}end\n"));
        }
        out
    }

    fn next_values(&mut self, group: &[&Register], depth: usize) -> String {
        let (mut out, mut done) = (String::new(), BTreeSet::new());
        self.process_targets.clear();
        self.sign = "<=";
        for register in group {
            match self.clocked.statements(register.next) {
                Some((number, statements)) if done.insert(number) => {
                    out.push_str(&self.block(&statements, depth));
                }
                Some(_) => {}
                None => {
                    let name = |net: NetId| &self.module.nets[net].name;
                    let (q, next) = (name(register.q), name(register.next));
                    out.push_str(&format!("{}{q} <= {next};\n", INDENT.repeat(depth)));
                }
            }
        }
        self.sign = "=";
        out
    }

    pub fn memory(&mut self, memory: &Memory) -> String {
        let name = |net: NetId| self.module.nets[net].name.clone();
        let (clock, read_data) = (name(memory.clock), name(memory.read_data));
        let read_address = name(memory.read_address);
        let word = &memory.name;
        let docs = comment(&memory.docs, INDENT);
        if !self.design.has_initial_values && memory.write.is_none() {
            return self.table(memory, &docs);
        }
        let write = memory.write.map_or(String::new(), |port| {
            let (enable, address, data) = (name(port.enable), name(port.address), name(port.data));
            format!(
                "        if ({enable}) begin
            {word}[{address}] <= {data};
        end
"
            )
        });
        let start: String = (memory.start.iter().enumerate())
            .map(|(index, value)| {
                let value = bits(*value, memory.width_bits);
                format!("        {word}[{index}] = {value};\n")
            })
            .collect();
        let (counter, zeros) = self.zero_words(memory);
        let initial = match self.design.has_initial_values {
            true => format!("{counter}    initial begin\n{start}{zeros}    end\n"),
            false => String::new(),
        };
        let vector = vector(memory.width_bits);
        format!(
            "\n{docs}    reg {vector} {word} [0:{last}];
{initial}    always @(posedge {clock}) begin
{write}        {read_data} <= {word}[{read_address}];
    end
",
            last = memory.words - 1
        )
    }

    /// Memory that is only read, where no device fills it: a table that synthesis makes logic of, or a memory in its own way.
    fn table(&self, memory: &Memory, docs: &str) -> String {
        let name = |net: NetId| &self.module.nets[net].name;
        let (clock, read_data) = (name(memory.clock), name(memory.read_data));
        let read_address = name(memory.read_address);
        let address_bits = self.module.nets[memory.read_address].width_bits;
        let words: String = (memory.start.iter().enumerate())
            .map(|(index, value)| {
                let (index, value) = (
                    literal(index as u128, address_bits),
                    bits(*value, memory.width_bits),
                );
                format!("            {index}: {read_data} <= {value};\n")
            })
            .collect();
        let zero = literal(0, memory.width_bits);
        format!(
            "\n{docs}    always @(posedge {clock})
        case ({read_address})
{words}            default: {read_data} <= {zero};
        endcase
"
        )
    }

    /// Declares a counter and fills the words without a start value.
    fn zero_words(&mut self, memory: &Memory) -> (String, String) {
        let first = memory.start.len();
        if first == memory.words {
            return Default::default();
        }
        let counter = self.scope.unique(&format!("{}_word", memory.name));
        let (word, words) = (&memory.name, memory.words);
        let zero = literal(0, memory.width_bits);
        (
            format!("{INDENT}integer {counter};\n"),
            format!(
                "        for ({counter} = {first}; {counter} < {words}; {counter} = {counter} + 1) begin
            {word}[{counter}] = {zero};
        end
"
            ),
        )
    }
}
