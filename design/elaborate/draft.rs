//! A module under construction: its names and nets, and the checks on them.

use super::design::*;
use super::names::{free_name, problem_of_net, verilog_name};
use super::plan::{Dependencies, PlanError};
use super::properties::selected;
use super::scope::{child_port, Symbol};
use super::tree::BlockNode;
use super::words::{emitted_name, keyword_in_properties};
use super::ElaborateError;
use std::collections::{BTreeMap, BTreeSet, HashMap};

type Result<T> = std::result::Result<T, ElaborateError>;

/// A module under construction.
pub(super) struct Draft<'a> {
    pub block: &'a BlockNode,
    pub module: Module,
    pub symbols: HashMap<String, Symbol>,
    pub enums: Vec<EnumId>,
    pub fields: HashMap<&'a str, &'a [String]>,
    /// Names of the child blocks.
    pub child_names: Vec<String>,
    /// Nets for an input of a child (or of a register), with the name for messages.
    pub child_inputs: Vec<(NetId, String)>,
    /// For each child block, the nets of its ports.
    pub ports_of_child: Vec<Vec<NetId>>,
}
impl Draft<'_> {
    pub(super) fn docs(&self, key: &str) -> Vec<String> {
        let mut parts = key.split('$');
        let field = parts.next().unwrap_or(key);
        let port = parts.find(|part| !part.starts_with(|c: char| c.is_ascii_digit()));
        let of_port = port.and_then(|port| self.fields.get(format!("{field}${port}").as_str()));
        let found = of_port.or_else(|| self.fields.get(field));
        found.map_or(vec![], |docs| docs.to_vec())
    }

    pub(super) fn net(
        &mut self,
        name: String,
        width_bits: usize,
        enum_id: Option<EnumId>,
        docs: Vec<String>,
    ) -> NetId {
        self.module.nets.push(Net {
            name,
            width_bits,
            enum_id,
            docs,
        });
        self.module.nets.len() - 1
    }

    /// A name for a net that no field has: `base`, or `base` with a number if a field is called that.
    pub(super) fn free_name(&self, base: &str) -> String {
        self.free_name_of([base.to_string()])
    }

    /// The first of some names that no field has; the last one gets a number if all are taken.
    pub(super) fn free_name_of<const N: usize>(&self, names: [String; N]) -> String {
        let fields = self.block.atoms.iter().map(|a| &a.name);
        let nets = self.module.nets.iter().map(|n| &n.name);
        free_name(names, fields.chain(&self.child_names).chain(nets))
    }

    pub(super) fn child_port(&mut self, child: &str, port: &str, net: NetId, direction: Direction) {
        self.symbols
            .insert(format!("{child}${port}"), child_port(net, direction));
        if direction == Direction::Input {
            self.child_inputs.push((net, format!("{child}.{port}")));
        }
    }

    pub(super) fn memory(&mut self, child: &BlockNode, is_read_only: bool) -> Result<()> {
        let name = verilog_name(&child.name);
        let ports = [
            ("clock", Direction::Input),
            ("read_address", Direction::Input),
            ("read_data", Direction::Output),
            ("write_enable", Direction::Input),
            ("write_address", Direction::Input),
            ("write_data", Direction::Input),
        ];
        let mut nets = vec![];
        for (port, direction) in ports.into_iter().take(if is_read_only { 3 } else { 6 }) {
            let Some(atom) = child.atom(port) else {
                return Err(child.error(port, "is missing from a memory", "use Memory or Rom"));
            };
            let free_name = self.free_name(&format!("{name}_{port}"));
            let net = self.net(free_name, atom.width_bits, None, vec![]);
            self.child_port(&child.name, port, net, direction);
            nets.push(net);
        }
        let address_bits = self.module.nets[nets[1]].width_bits;
        if address_bits > 24 {
            return Err(child.error(
                "read_address",
                format!("is {address_bits} bits wide, the limit is 24"),
                "use a smaller memory",
            ));
        }
        self.module.memories.push(Memory {
            name,
            width_bits: self.module.nets[nets[2]].width_bits,
            words: 1 << address_bits,
            clock: nets[0],
            read_address: nets[1],
            read_data: nets[2],
            write: match nets[3..] {
                [enable, address, data] => Some(WritePort {
                    enable,
                    address,
                    data,
                }),
                _ => None,
            },
            start: child.constants().map(|atom| atom.value).collect(),
            docs: self.docs(&child.name),
        });
        Ok(())
    }

    /// Everything that needs a driver has one.
    pub(super) fn check_driven(&self, statements: &[Statement]) -> Result<()> {
        let mut driven: BTreeMap<NetId, u128> = BTreeMap::new();
        let mut read: BTreeSet<NetId> = BTreeSet::new();
        for statement in statements {
            statement.for_each_target(&mut |net, low, width| {
                *driven.entry(net).or_default() |= mask(width) << low;
            });
            statement.for_each_expr(&mut |expr| {
                expr.for_each_net(&mut |net| {
                    read.insert(net);
                });
            });
        }
        let is_driven = |net: NetId| {
            driven.get(&net).copied().unwrap_or(0) == mask(self.module.nets[net].width_bits)
        };
        if let Some((_, name)) = self.child_inputs.iter().find(|(net, _)| !is_driven(*net)) {
            return Err(self.block.error(
                name,
                "is not driven",
                format!("assign self.{name}.next in the kernel"),
            ));
        }
        for (key, symbol) in &self.symbols {
            if let Symbol::Net {
                net,
                is_assignable: true,
                is_readable: true,
            } = symbol
            {
                let is_port = self.module.ports.iter().any(|p| p.net == *net);
                if !is_driven(*net) && (is_port || read.contains(net)) {
                    return Err(self.block.error(
                        key,
                        "is not driven",
                        format!("assign self.{key}.next in the kernel"),
                    ));
                }
            }
        }
        Ok(())
    }

    pub(super) fn check_clocks(&self) -> Result<()> {
        let clocks: BTreeSet<NetId> = self
            .module
            .ports
            .iter()
            .filter(|p| p.is_clock)
            .map(|p| p.net)
            .collect();
        let registers = self.module.registers.iter().map(|r| (r.clock, r.q));
        let memories = self.module.memories.iter().map(|m| (m.clock, m.read_data));
        for (clock, output) in registers.chain(memories) {
            if !clocks.contains(&clock) {
                return Err(self.block.error(
                    &self.module.nets[output].name,
                    "has a clock that is no clock input of this block",
                    "assign its clock from a Signal<In, Clock>, without a condition",
                ));
            }
        }
        Ok(())
    }

    pub(super) fn plan_error(&self, error: PlanError) -> ElaborateError {
        let name = |net: NetId| self.module.nets[net].name.clone();
        match error {
            PlanError::Loop(nets) => {
                let names: Vec<String> = nets.iter().map(|net| name(*net)).collect();
                self.block.error(
                    &names[0],
                    format!("is part of a combinational loop: {}", names.join(" -> ")),
                    "put a register into the loop",
                )
            }
            PlanError::ReadBeforeAssigned(net) => self.block.error(
                &name(net),
                "is read before it is assigned, so its value depends on the order of evaluation",
                "assign it, or a default, before reading it",
            ),
            PlanError::Latch(net) => self.block.error(
                &name(net),
                "is not assigned on every way through the kernel, which would be a latch",
                "assign a default at the top of the kernel (a match on an enum may have unused encodings)",
            ),
        }
    }

    /// Leaves out what comments and properties say of parts that this block does not have.
    pub(super) fn select_texts(&mut self) -> Result<()> {
        let module = &self.module;
        let is_set = |name: &str| {
            let mut constants = module.parameters.iter();
            let found = constants.find(|c| c.name.eq_ignore_ascii_case(name));
            found.map(|c| c.value != 0)
        };
        let unknown = |line: &str| {
            let problem = "the block has no constant of this name, or no `end` follows";
            let remedy = "name one of its constants, and end the section";
            self.block.error(line, problem, remedy)
        };
        let properties =
            selected(module.properties.lines(), ("// ", ""), is_set).map_err(unknown)?;
        let lines = module.docs.iter().map(String::as_str);
        let docs = selected(lines, ("<!-- ", " -->"), is_set).map_err(unknown)?;
        let mut text = properties.join("\n");
        if !text.is_empty() {
            text.push('\n');
        }
        let docs = docs.into_iter().map(str::to_owned).collect();
        (self.module.properties, self.module.docs) = (text, docs);
        Ok(())
    }

    /// For each output port, the input ports that it depends on combinationally.
    pub(super) fn through(&self, depends: &Dependencies) -> BTreeMap<usize, BTreeSet<usize>> {
        let port_of: BTreeMap<NetId, usize> = self
            .module
            .ports
            .iter()
            .enumerate()
            .map(|(i, p)| (p.net, i))
            .collect();
        let mut through = BTreeMap::new();
        for (index, port) in self.module.ports.iter().enumerate() {
            if port.direction == Direction::Input {
                continue;
            }
            let mut seen = BTreeSet::new();
            let mut open = vec![port.net];
            while let Some(net) = open.pop() {
                if seen.insert(net) {
                    open.extend(depends.get(&net).into_iter().flatten());
                }
            }
            let inputs = seen
                .iter()
                .filter_map(|net| port_of.get(net))
                .filter(|p| self.module.ports[**p].direction == Direction::Input);
            through.insert(index, inputs.copied().collect());
        }
        through
    }

    pub(super) fn check_names(&self) -> Result<()> {
        let mut seen: BTreeMap<String, &str> = BTreeMap::new();
        let module = &self.module;
        let names = module.nets.iter().map(|n| &n.name);
        let names = names.chain(module.parameters.iter().map(|p| &p.name));
        let names = names.chain(module.memories.iter().map(|m| &m.name));
        for name in names.chain(module.instances.iter().map(|i| &i.name)) {
            if let Some(problem) = problem_of_net(name) {
                return Err(self.block.error(name, problem, "rename the field"));
            }
            if let Some(other) = seen.insert(emitted_name(name).to_lowercase(), name) {
                return Err(self.block.error(
                    name,
                    format!("and {other} would have the same Verilog name or differ only by case"),
                    "rename one of the fields",
                ));
            }
        }
        if let Some(word) = keyword_in_properties(&module.properties) {
            return Err(self.block.error(
                "properties",
                format!("{word} is a word of SystemVerilog"),
                "give it another name",
            ));
        }
        Ok(())
    }
}
