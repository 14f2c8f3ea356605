//! Registers and memories as VHDL text.

use super::module::process::variable_lines;
use super::module::ModulePrinter;
use super::text::{bits, comment, named_literal, subtype, wrapped};
use crate::elaborate::{Memory, NetId, Register};
use crate::printing::{register_groups, INDENT};
use std::collections::BTreeSet;

/// Words of a memory in a line of its start values.
const LINE: usize = 96;

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
            let (pad, deep) = (INDENT.repeat(3), INDENT.repeat(4));
            let edge = if on_fall {
                "falling_edge"
            } else {
                "rising_edge"
            };
            let body = match reset {
                None => self.next_values(&group, 3),
                Some(reset) => {
                    let next = self.next_values(&group, 4);
                    let mut start = |r: &&Register| {
                        let start = self.start(r);
                        format!("{deep}{} <= {start};\n", self.module.nets[r.q].name)
                    };
                    let starts: String = group.iter().map(&mut start).collect();
                    let reset = self.reference(reset);
                    format!("{pad}if {reset} = '1' then\n{starts}{pad}else\n{next}{pad}end if;\n")
                }
            };
            out.push_str(&self.clocked(clock, edge, &body));
        }
        out
    }

    /// A process at an edge of a clock.
    fn clocked(&mut self, clock: NetId, edge: &str, body: &str) -> String {
        let (clock, deep) = (self.reference(clock), INDENT.repeat(2));
        let variables = variable_lines(&self.taken_subjects());
        format!(
            "\n{INDENT}process ({clock})\n{variables}{INDENT}begin\n{deep}if {edge}({clock}) then\n{body}{deep}end if;\n{INDENT}end process;\n"
        )
    }

    fn next_values(&mut self, group: &[&Register], depth: usize) -> String {
        let (mut out, mut done) = (String::new(), BTreeSet::new());
        for register in group {
            match self.clocked.statements(register.next) {
                Some((number, statements)) if done.insert(number) => {
                    out.push_str(&self.block(&statements, depth));
                }
                Some(_) => {}
                None => {
                    let (q, next) = (self.reference(register.q), self.reference(register.next));
                    out.push_str(&format!("{}{q} <= {next};\n", INDENT.repeat(depth)));
                }
            }
        }
        out
    }

    /// Declarations of the memories, and their processes.
    pub fn memories(&mut self) -> (String, String) {
        let (mut declarations, mut processes) = (String::new(), String::new());
        for memory in &self.module.memories {
            let (declaration, process) = self.memory(memory);
            declarations.push_str(&declaration);
            processes.push_str(&process);
        }
        (declarations, processes)
    }

    fn memory(&mut self, memory: &Memory) -> (String, String) {
        let (word, last) = (&memory.name, memory.words - 1);
        let words = self.scope.unique(&format!("{word}_words"));
        let docs = comment(&memory.docs, INDENT);
        let element = subtype(memory.width_bits);
        let declare = |kind: &str, start: &str| {
            format!(
                "\n{docs}{INDENT}type {words} is array (0 to {last}) of {element};\n{INDENT}{kind} {word} : {words}{start};\n"
            )
        };
        let start = format!(" := (\n{}\n{INDENT})", start_words(memory));
        let declaration = match memory.write {
            None => declare("constant", &start),
            Some(_) if self.design.has_initial_values => declare("signal", &start),
            Some(_) => declare("signal", ""),
        };
        let pad = INDENT.repeat(3);
        let index = |net: NetId| {
            let address = self.range(net, 0, self.module.nets[net].width_bits);
            format!("to_integer({address})")
        };
        let write = memory.write.map_or(String::new(), |port| {
            let (enable, data) = (self.reference(port.enable), self.range(port.data, 0, memory.width_bits));
            let address = index(port.address);
            format!(
                "{pad}if {enable} = '1' then\n{pad}{INDENT}{word}({address}) <= {data};\n{pad}end if;\n"
            )
        });
        let read_data = self.reference(memory.read_data);
        let read = format!(
            "{pad}{read_data} <= {word}({});\n",
            index(memory.read_address)
        );
        let process = self.clocked(memory.clock, "rising_edge", &format!("{write}{read}"));
        (declaration, process)
    }
}

/// The start values, as many in a line as fit; other words are 0.
fn start_words(memory: &Memory) -> String {
    let pad = INDENT.repeat(2);
    let mut items: Vec<String> = (memory.start.iter().enumerate())
        .map(|(index, value)| format!("{index} => {}", bits(*value, memory.width_bits)))
        .collect();
    if memory.start.len() < memory.words {
        items.push(match memory.width_bits {
            1 => "others => '0'".into(),
            _ => "others => (others => '0')".into(),
        });
    }
    let lines = wrapped(&items, LINE);
    let lines: Vec<String> = lines.iter().map(|line| format!("{pad}{line}")).collect();
    lines.join("\n")
}
