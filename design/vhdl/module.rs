//! One module as VHDL text: an entity and its architecture.

mod constants;
mod declarations;
mod expression;
pub(super) mod process;

use super::package::package_name;
use super::text::{comment, Context};
use crate::elaborate::{Design, Direction, ExprKind, Module, NetId};
use crate::printing::{reads_and_targets, Clocked, Scope, INDENT};
use std::collections::{BTreeMap, BTreeSet};

/// Name of the architecture of a module.
const ARCHITECTURE: &str = "rtl";

/// The text of a module.
pub(super) fn print(design: &Design, module: &Module) -> String {
    let mut printer = ModulePrinter::new(design, module);
    let architecture = printer.architecture(ARCHITECTURE);
    let name = &module.name;
    let docs = comment(&module.docs, "");
    let ports = printer.ports();
    let libraries = printer.libraries();
    format!("{libraries}{docs}entity {name} is\n{ports}end entity;\n\n{architecture}")
}

/// Its architecture alone, under another name.
pub(super) fn print_architecture(design: &Design, module: &Module, name: &str) -> String {
    let mut printer = ModulePrinter::new(design, module);
    let architecture = printer.architecture(name);
    format!("{}{architecture}", printer.libraries())
}

/// A signal or variable that the printer adds.
pub(super) struct Added {
    pub name: String,
    pub width_bits: usize,
}

pub(super) struct ModulePrinter<'a> {
    pub design: &'a Design,
    pub module: &'a Module,
    /// Its ports are `std_logic_vector`.
    is_top: bool,
    pub scope: Scope<'a>,
    /// Next values that need no signal.
    pub clocked: Clocked,
    /// Signals in the place of output ports: VHDL-93 does not read a port that it drives.
    inner: BTreeMap<NetId, String>,
    /// Signals of instances' inputs that are no names.
    added: Vec<Added>,
    /// Variables of the process that is being printed, in the place of signals: these would not have their new value yet.
    variables: BTreeMap<NetId, String>,
    /// More variables of that process.
    subjects: Vec<Added>,
}

impl<'a> ModulePrinter<'a> {
    fn new(design: &'a Design, module: &'a Module) -> Self {
        let mut printer = Self {
            design,
            module,
            is_top: std::ptr::eq(module, design.top()),
            scope: Scope::new(design, module, super::emitted_name),
            clocked: Clocked::new(module),
            inner: BTreeMap::new(),
            added: vec![],
            variables: BTreeMap::new(),
            subjects: vec![],
        };
        for net in printer.read_outputs() {
            let name = printer
                .scope
                .unique(&format!("{}_sig", module.nets[net].name));
            printer.inner.insert(net, name);
        }
        printer
    }

    /// Output ports that need a signal in their place: those that are read, and those whose type is not that of the values.
    fn read_outputs(&self) -> BTreeSet<NetId> {
        let module = self.module;
        let mut read = BTreeSet::new();
        for process in &module.processes {
            let (reads, targets) = reads_and_targets(&process.statements);
            read.extend(reads.difference(&targets));
        }
        for register in &module.registers {
            read.extend([register.next, register.clock]);
            read.extend(register.reset);
        }
        read.extend(module.memories.iter().flat_map(|m| m.inputs()));
        for connection in module.instances.iter().flat_map(|i| &i.connections) {
            if connection.direction == Direction::Input {
                connection.value.for_each_net(&mut |net| {
                    read.insert(net);
                });
            }
        }
        let outputs = (module.ports.iter()).filter(|p| p.direction == Direction::Output);
        let is_needed =
            |net: &NetId| read.contains(net) || self.is_top && module.nets[*net].width_bits > 1;
        outputs.map(|p| p.net).filter(is_needed).collect()
    }

    /// Whether it is a `std_logic_vector` that is read.
    fn is_vector_port(&self, net: NetId) -> bool {
        let is_input = |p: &crate::elaborate::Port| p.direction == Direction::Input && p.net == net;
        self.is_top
            && self.module.nets[net].width_bits > 1
            && self.module.ports.iter().any(is_input)
    }

    /// Text for a net.
    pub fn reference(&self, net: NetId) -> String {
        let name = self.variables.get(&net).or(self.inner.get(&net));
        name.unwrap_or(&self.module.nets[net].name).clone()
    }

    /// A range of bits of a net, as a value.
    pub fn range(&self, net: NetId, low_bit: usize, width_bits: usize) -> String {
        let place = self.place(net, low_bit, width_bits);
        match width_bits > 1 && self.is_vector_port(net) {
            true => format!("unsigned({place})"),
            false => place,
        }
    }

    /// The same, to be assigned.
    fn place(&self, net: NetId, low_bit: usize, width_bits: usize) -> String {
        let name = self.reference(net);
        match width_bits {
            _ if width_bits == self.module.nets[net].width_bits => name,
            1 => format!("{name}({low_bit})"),
            _ => format!("{name}({} downto {low_bit})", low_bit + width_bits - 1),
        }
    }

    fn libraries(&self) -> String {
        let package = package_name(self.design);
        format!(
            "library ieee;\nuse ieee.std_logic_1164.all;\nuse ieee.numeric_std.all;\nuse work.{package}.all;\n\n"
        )
    }

    fn architecture(&mut self, name: &str) -> String {
        let instances: Vec<String> = (0..self.module.instances.len())
            .map(|i| self.instance(i))
            .collect();
        let processes = self.processes();
        let registers = self.registers();
        let (memory_types, memories) = self.memories();
        let sections = [
            instances.join("\n"),
            processes,
            registers,
            memories,
            self.outputs(),
        ];
        let sections = sections.iter().map(|text| text.trim_matches('\n'));
        let sections: Vec<&str> = sections.filter(|text| !text.is_empty()).collect();
        let sections = sections.join("\n\n").replace("\n\n\n", "\n\n");
        let declarations = self.declarations();
        format!(
            "architecture {name} of {} is\n{}{declarations}{memory_types}begin\n{}\nend architecture;\n",
            self.module.name,
            self.constants(),
            sections
        )
    }

    /// The ports driven by a signal of this module.
    fn outputs(&self) -> String {
        let line = |(net, signal): (&NetId, &String)| {
            let net = &self.module.nets[*net];
            let value = match self.is_top && net.width_bits > 1 {
                true => format!("std_logic_vector({signal})"),
                false => signal.clone(),
            };
            format!("{INDENT}{} <= {value};\n", net.name)
        };
        self.inner.iter().map(line).collect()
    }

    fn instance(&mut self, index: usize) -> String {
        let instance = &self.module.instances[index];
        let child = &self.design.modules[instance.module];
        let read = self.module.read_bits();
        let ports: BTreeSet<NetId> = self.module.ports.iter().map(|p| p.net).collect();
        let mut before = String::new();
        let mut lines = vec![];
        for (port, connection) in child.ports.iter().zip(&instance.connections) {
            let value = &connection.value;
            let actual = match (&value.kind, connection.direction) {
                (ExprKind::Net(net), Direction::Output)
                    if !read.contains_key(net) && !ports.contains(net) =>
                {
                    "open".into()
                }
                (
                    ExprKind::Net(_)
                    | ExprKind::Constant(_)
                    | ExprKind::Parameter(_)
                    | ExprKind::Variant(..),
                    _,
                ) => self.value(value, Context::Target),
                (ExprKind::Slice(inner, _), _) if matches!(inner.kind, ExprKind::Net(_)) => {
                    self.value(value, Context::Target)
                }
                // VHDL-93 takes nothing that would have to be computed.
                _ => {
                    let base = format!("{}_{}", instance.name, child.nets[port.net].name);
                    let name = self.scope.unique(&base);
                    let text = self.value(value, Context::Target);
                    before.push_str(&format!("{INDENT}{name} <= {text};\n"));
                    self.added.push(Added {
                        name: name.clone(),
                        width_bits: value.width_bits,
                    });
                    name
                }
            };
            lines.push((child.nets[port.net].name.clone(), actual));
        }
        let width = lines.iter().map(|(port, _)| port.len()).max().unwrap_or(0);
        let pad = INDENT.repeat(3);
        let lines: Vec<String> = lines
            .iter()
            .map(|(port, actual)| format!("{pad}{port:width$} => {actual}"))
            .collect();
        format!(
            "{before}{INDENT}{} : entity work.{}\n{INDENT}{INDENT}port map (\n{}\n{INDENT}{INDENT});\n",
            instance.name,
            child.name,
            lines.join(",\n")
        )
    }
}
