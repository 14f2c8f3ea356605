//! Ports and signals of a module.

use super::ModulePrinter;
use crate::elaborate::{Direction, NetId};
use crate::printing::INDENT;
use crate::vhdl::text::{comment, subtype};
use std::collections::{BTreeMap, BTreeSet};

/// Attributes that keep a synchroniser stage a flip-flop: Vivado and XST, then others.
const SYNCHRONISER: [(&str, &str); 3] = [
    ("ASYNC_REG", "TRUE"),
    ("SHREG_EXTRACT", "NO"),
    ("keep", "true"),
];

impl ModulePrinter<'_> {
    pub(super) fn ports(&self) -> String {
        let module = self.module;
        if module.ports.is_empty() {
            return String::new();
        }
        let nets = module.ports.iter().map(|p| &module.nets[p.net]);
        let width = nets.map(|net| net.name.len()).max().unwrap_or(0);
        let pad = INDENT.repeat(2);
        let mut lines = String::new();
        for (index, port) in module.ports.iter().enumerate() {
            let net = &module.nets[port.net];
            let direction = match port.direction {
                Direction::Input => "in ",
                Direction::Output => "out",
            };
            let subtype = match self.is_top {
                true => subtype(net.width_bits).replace("unsigned", "std_logic_vector"),
                false => subtype(net.width_bits),
            };
            let end = match index + 1 < module.ports.len() {
                true => ";",
                false => "",
            };
            lines.push_str(&comment(&net.docs, &pad));
            lines.push_str(&format!(
                "{pad}{:width$} : {direction} {subtype}{end}\n",
                net.name
            ));
        }
        format!("{INDENT}port (\n{lines}{INDENT});\n")
    }

    /// Nets that are signals: all but ports, next values without a net, and what an instance gives and nobody takes.
    fn signals(&self) -> Vec<NetId> {
        let module = self.module;
        let mut others: BTreeSet<NetId> = module.ports.iter().map(|p| p.net).collect();
        others.extend((0..module.nets.len()).filter(|net| self.clocked.has_no_net(*net)));
        let read = module.read_bits();
        for connection in module.instances.iter().flat_map(|i| &i.connections) {
            if connection.direction == Direction::Output {
                connection.value.for_each_net(&mut |net| {
                    if !read.contains_key(&net) {
                        others.insert(net);
                    }
                });
            }
        }
        (0..module.nets.len())
            .filter(|net| !others.contains(net))
            .collect()
    }

    pub(super) fn declarations(&mut self) -> String {
        let module = self.module;
        let mut starts: BTreeMap<NetId, String> = BTreeMap::new();
        if self.design.has_initial_values {
            for register in &module.registers {
                starts.insert(register.q, self.start(register));
            }
            for memory in &module.memories {
                let zero = if memory.width_bits == 1 {
                    "'0'"
                } else {
                    "(others => '0')"
                };
                starts.insert(memory.read_data, zero.into());
            }
        }
        let signals = self.signals();
        let names = signals.iter().map(|id| &module.nets[*id].name);
        let added = self
            .added
            .iter()
            .map(|added| (&added.name, added.width_bits));
        let inner = self
            .inner
            .iter()
            .map(|(net, name)| (name, module.nets[*net].width_bits));
        let added: Vec<(&String, usize)> = inner.chain(added).collect();
        let names = names.chain(added.iter().map(|(name, _)| *name));
        let width = names.map(String::len).max().unwrap_or(0);
        let mut out = String::new();
        for id in signals {
            let net = &module.nets[id];
            let start = starts
                .get(&id)
                .map_or(String::new(), |start| format!(" := {start}"));
            out.push_str(&comment(&net.docs, INDENT));
            out.push_str(&format!(
                "{INDENT}signal {:width$} : {}{start};\n",
                net.name,
                subtype(net.width_bits)
            ));
        }
        for (name, width_bits) in added {
            out.push_str(&format!(
                "{INDENT}signal {name:width$} : {};\n",
                subtype(width_bits)
            ));
        }
        out + &self.attributes()
    }

    fn attributes(&self) -> String {
        let stages = self.module.registers.iter().filter(|r| r.is_synchroniser);
        let stages: Vec<&String> = stages.map(|r| &self.module.nets[r.q].name).collect();
        if stages.is_empty() {
            return String::new();
        }
        let mut out = format!("\n{INDENT}-- Synchroniser stages remain separate flip-flops.\n");
        for (attribute, value) in SYNCHRONISER {
            out.push_str(&format!("{INDENT}attribute {attribute} : string;\n"));
            for stage in &stages {
                out.push_str(&format!(
                    "{INDENT}attribute {attribute} of {stage} : signal is \"{value}\";\n"
                ));
            }
        }
        out
    }
}
