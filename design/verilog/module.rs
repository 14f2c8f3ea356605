//! One module as Verilog text.

mod constants;
pub(super) mod expression;

use super::text::{comment, properties, ranges, vector, INDENT};
use crate::elaborate::{mask, Design, Direction, Module, NetId, Statement};
use crate::printing::{constant_values, reads_and_targets, Clocked, Scope};
use expression::{literal, range, Helper, Helpers};
use std::collections::{BTreeMap, BTreeSet};

/// Keeps a synchroniser stage a flip-flop: Vivado and XST, then yosys and other tools.
const SYNCHRONISER: &str = "(* ASYNC_REG = \"TRUE\", SHREG_EXTRACT = \"NO\", keep = \"true\" *)";

/// The text of a module.
pub(super) fn print(design: &Design, module: &Module) -> String {
    ModulePrinter::new(design, module).print()
}

pub(super) struct ModulePrinter<'a> {
    pub design: &'a Design,
    pub module: &'a Module,
    pub scope: Scope<'a>,
    /// Helper nets that are assigned continuously.
    pub continuous: Vec<Helper>,
    /// Helper nets that are assigned inside a process.
    inside: Vec<Helper>,
    /// Targets of the process that is being printed.
    pub process_targets: BTreeSet<NetId>,
    /// Next values that need no net.
    pub clocked: Clocked,
    /// How the statements that are being printed assign: `=`, or `<=` in a clocked block.
    pub sign: &'static str,
}

impl<'a> ModulePrinter<'a> {
    fn new(design: &'a Design, module: &'a Module) -> Self {
        Self {
            design,
            module,
            scope: Scope::new(design, module, str::to_owned),
            continuous: vec![],
            inside: vec![],
            process_targets: BTreeSet::new(),
            clocked: Clocked::new(module),
            sign: "=",
        }
    }

    fn print(mut self) -> String {
        let instances: String = (0..self.module.instances.len())
            .map(|i| self.instance(i))
            .collect();
        let mut combinational = String::new();
        let mut in_always = BTreeSet::new();
        for process in self.clocked.processes.clone() {
            let text = self.process(&process.statements, &mut in_always);
            if combinational.ends_with(&format!("\n{INDENT}end\n")) && !text.starts_with('\n') {
                combinational.push('\n');
            }
            combinational.push_str(&text);
        }
        let registers = self.registers();
        let memories: String = self
            .module
            .memories
            .iter()
            .map(|m| self.memory(m))
            .collect();

        let mut out = comment(&self.module.docs, "");
        out.push_str(&format!("module {} (\n", self.module.name));
        out.push_str(&self.ports(&in_always));
        out.push_str(");\n");
        out.push_str(&self.constants());
        out.push_str(&self.declarations(&in_always));
        for helper in &self.continuous {
            out.push_str(&format!(
                "{INDENT}assign {} = {};\n",
                helper.name, helper.text
            ));
        }
        for section in [instances, combinational, registers, memories] {
            if !section.is_empty() {
                out.push('\n');
                out.push_str(section.trim_start_matches('\n'));
            }
        }
        out.push_str(&properties(&self.with_constants(&self.module.properties)));
        out.push_str("endmodule\n");
        out
    }

    fn ports(&self, in_always: &BTreeSet<NetId>) -> String {
        let mut out = String::new();
        for (index, port) in self.module.ports.iter().enumerate() {
            let net = &self.module.nets[port.net];
            let kind = match port.direction {
                Direction::Input => "input  wire",
                Direction::Output if in_always.contains(&port.net) => "output reg ",
                Direction::Output => "output wire",
            };
            let comma = if index + 1 < self.module.ports.len() {
                ","
            } else {
                ""
            };
            out.push_str(&comment(&net.docs, INDENT));
            out.push_str(&format!(
                "{INDENT}{kind} {:>7} {}{comma}\n",
                vector(net.width_bits),
                net.name
            ));
        }
        out
    }

    fn declarations(&mut self, in_always: &BTreeSet<NetId>) -> String {
        let module = self.module;
        let ports: BTreeSet<NetId> = module.ports.iter().map(|p| p.net).collect();
        let mut starts: BTreeMap<NetId, (String, bool)> = BTreeMap::new();
        for register in &module.registers {
            starts.insert(register.q, (self.start(register), register.is_synchroniser));
        }
        for memory in &module.memories {
            starts.insert(memory.read_data, (literal(0, memory.width_bits), false));
        }
        let mut out = String::new();
        for (id, net) in module
            .nets
            .iter()
            .enumerate()
            .filter(|(id, _)| !ports.contains(id) && !self.clocked.has_no_net(*id))
        {
            out.push_str(&comment(&net.docs, INDENT));
            let vector = vector(net.width_bits);
            out.push_str(&match starts.get(&id) {
                // A start value in the declaration is set before time 0 in SystemVerilog, where `always @*` waits for a change
                // and never sees one. Set by a process it is a change in every language.
                Some((start, is_synchroniser)) => {
                    let attributes = match is_synchroniser {
                        true => format!("{INDENT}{SYNCHRONISER}\n"),
                        false => String::new(),
                    };
                    let name = &net.name;
                    let initial = match self.design.has_initial_values {
                        true => format!(" initial {name} = {start};"),
                        false => String::new(),
                    };
                    format!("{attributes}{INDENT}reg  {vector:>7} {name};{initial}\n")
                }
                None if in_always.contains(&id) => {
                    format!("{INDENT}reg  {vector:>7} {};\n", net.name)
                }
                None => format!("{INDENT}wire {vector:>7} {};\n", net.name),
            });
        }
        for (kind, helpers) in [("wire", &self.continuous), ("reg ", &self.inside)] {
            for helper in helpers {
                out.push_str(&format!(
                    "{INDENT}{kind} {:>7} {};\n",
                    vector(helper.width_bits),
                    helper.name
                ));
            }
        }
        let unused = self.unused();
        if !unused.is_empty() {
            let name = self.scope.unique("unused_ok");
            out.push_str(&format!(
                "{INDENT}wire {:>7} _{name} = &{{1'b0, {}}};\n",
                "",
                unused.join(", ")
            ));
        }
        out
    }

    /// Driven nets that are never read, as Verilog expressions.
    fn unused(&self) -> Vec<String> {
        let read = self.clocked.read_bits(self.module);
        let outputs: BTreeSet<NetId> = self
            .module
            .ports
            .iter()
            .filter(|p| p.direction == Direction::Output)
            .map(|p| p.net)
            .collect();
        let mut out = vec![];
        for (id, net) in self
            .module
            .nets
            .iter()
            .enumerate()
            .filter(|(id, _)| !outputs.contains(id))
        {
            let unread = mask(net.width_bits) & !read.get(&id).copied().unwrap_or(0);
            out.extend(
                ranges(unread).map(|(low, width)| range(&net.name, low, width, net.width_bits)),
            );
        }
        for helper in self.continuous.iter().chain(&self.inside) {
            let unread = mask(helper.width_bits) & !helper.read_bits;
            out.extend(
                ranges(unread)
                    .map(|(low, width)| range(&helper.name, low, width, helper.width_bits)),
            );
        }
        out
    }

    fn instance(&mut self, index: usize) -> String {
        let instance = &self.module.instances[index];
        let child = &self.design.modules[instance.module];
        let mut lines = vec![];
        for (port, connection) in child.ports.iter().zip(&instance.connections) {
            let value = self.expression(&connection.value, "", &mut Helpers::default());
            lines.push(format!(
                "{INDENT}{INDENT}.{}({value})",
                child.nets[port.net].name
            ));
        }
        format!(
            "{INDENT}{} {} (\n{}\n{INDENT});\n",
            child.name,
            instance.name,
            lines.join(",\n")
        )
    }

    fn process(&mut self, statements: &[Statement], in_always: &mut BTreeSet<NetId>) -> String {
        let (reads, targets) = reads_and_targets(statements);
        self.process_targets = targets;
        if let [Statement::Assign {
            net,
            low_bit: 0,
            value,
            docs,
        }] = statements
        {
            if value.width_bits == self.module.nets[*net].width_bits && !reads.contains(net) {
                let name = self.module.nets[*net].name.clone();
                let text = self.expression(value, &name, &mut Helpers::default());
                let docs = comment(docs, INDENT);
                return format!("{docs}{INDENT}assign {name} = {text};\n");
            }
        }
        if reads.is_subset(&self.process_targets) {
            // `always @*` would never run: the values are constants.
            return self.constant_process(statements);
        }
        in_always.extend(&self.process_targets);
        let first_helper = self.inside.len();
        let body = self.block(statements, 2);
        let defaults: String = self.inside[first_helper..]
            .iter()
            .map(|h| {
                format!(
                    "{INDENT}{INDENT}{} = {};\n",
                    h.name,
                    literal(0, h.width_bits)
                )
            })
            .collect();
        format!("\n{INDENT}always @* begin\n{defaults}{body}{INDENT}end\n")
    }

    fn constant_process(&self, statements: &[Statement]) -> String {
        let line = |(net, value): (&NetId, &u128)| {
            let net = &self.module.nets[*net];
            format!(
                "{INDENT}assign {} = {};\n",
                net.name,
                literal(*value, net.width_bits)
            )
        };
        constant_values(self.module, statements)
            .iter()
            .map(line)
            .collect()
    }

    pub fn block(&mut self, statements: &[Statement], depth: usize) -> String {
        statements
            .iter()
            .map(|s| self.statement(s, depth))
            .collect()
    }

    /// A statement at an indentation depth, after the helper nets that it needs.
    fn statement(&mut self, statement: &Statement, depth: usize) -> String {
        let pad = INDENT.repeat(depth);
        let mut helpers = Helpers::default();
        let docs = comment(statement.docs(), &pad);
        let text = match statement {
            Statement::Assign {
                net,
                low_bit,
                value,
                ..
            } => {
                let target = &self.module.nets[*net];
                let place = range(&target.name, *low_bit, value.width_bits, target.width_bits);
                let value = self.expression(value, &target.name, &mut helpers);
                format!("{pad}{place} {} {value};\n", self.sign)
            }
            Statement::If {
                condition,
                then,
                otherwise,
                ..
            } => {
                let condition = self.expression(condition, "condition", &mut helpers);
                format!(
                    "{pad}if ({condition}) begin\n{}{}",
                    self.block(then, depth + 1),
                    self.otherwise(otherwise, depth)
                )
            }
            Statement::Case {
                subject,
                arms,
                default,
                ..
            } => {
                let subject = self.expression(subject, "subject", &mut helpers);
                let mut text = format!("{pad}case ({subject})\n");
                let inner = INDENT.repeat(depth + 1);
                for (value, body) in arms {
                    let value = self.expression(value, "", &mut helpers);
                    let body = self.block(body, depth + 2);
                    text.push_str(&format!("{inner}{value}: begin\n{body}{inner}end\n"));
                }
                let body = self.block(default, depth + 2);
                text.push_str(&format!(
                    "{inner}default: begin\n{body}{inner}end\n{pad}endcase\n"
                ));
                text
            }
        };
        let before: String = helpers
            .nets
            .iter()
            .map(|h| format!("{pad}{} = {};\n", h.name, h.text))
            .collect();
        self.inside.extend(helpers.nets);
        docs + &before + &text
    }

    fn otherwise(&mut self, otherwise: &[Statement], depth: usize) -> String {
        let pad = INDENT.repeat(depth);
        match otherwise {
            [] => format!("{pad}end\n"),
            [Statement::If { docs, .. }] if docs.is_empty() => {
                let text = self.statement(&otherwise[0], depth);
                match text.trim_start().starts_with("if (") {
                    true => format!("{pad}end else {}", text.trim_start()),
                    false => format!("{pad}end else begin\n{text}{pad}end\n"),
                }
            }
            _ => format!(
                "{pad}end else begin\n{}{pad}end\n",
                self.block(otherwise, depth + 1)
            ),
        }
    }
}
