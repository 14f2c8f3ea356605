//! Modules from blocks: nets, registers, instances, and the processes of the kernel.

use super::design::*;
use super::docs::Docs;
use super::draft::Draft;
use super::names::verilog_name;
use super::plan::{plan, Dependencies};
use super::scope::{drop_replaced, Scope, Symbol};
use super::tree::{AtomNode, BlockNode};
use super::ElaborateError;
use crate::memory::{MEMORY_TIMING, ROM_TIMING};
use crate::reg::{FALL_REG_TIMING, REG_TIMING, SYNC_REG_TIMING};
use rust_hdl::prelude::{clog2, AtomKind, TypeDescriptor, TypeKind, Verilog};
use std::collections::{BTreeMap, BTreeSet, HashMap};

type Result<T> = std::result::Result<T, ElaborateError>;

/// Elaborates the tree; the modules are in the order in which they were finished, children before parents.
pub(super) fn build(top: &BlockNode) -> Result<(Design, ModuleId)> {
    let mut builder = Builder {
        design: Design {
            modules: vec![],
            enums: vec![],
            has_initial_values: true,
        },
        through: vec![],
    };
    let top = builder.block(top)?;
    Ok((builder.design, top))
}

struct Builder {
    design: Design,
    /// For each module: port index of an output, port indices of the inputs that it depends on combinationally.
    through: Vec<BTreeMap<usize, BTreeSet<usize>>>,
}

/// Kind of a child block.
enum Kind {
    Register {
        is_synchroniser: bool,
        on_fall: bool,
    },
    Memory {
        is_read_only: bool,
    },
    Block,
}

fn kind(child: &BlockNode) -> Kind {
    let is = |name: &str| child.timing.iter().any(|t| t.name == name);
    let on_fall = is(FALL_REG_TIMING);
    if is(REG_TIMING) || is(SYNC_REG_TIMING) || on_fall {
        Kind::Register {
            is_synchroniser: is(SYNC_REG_TIMING) || on_fall,
            on_fall,
        }
    } else if is(MEMORY_TIMING) || is(ROM_TIMING) {
        Kind::Memory {
            is_read_only: is(ROM_TIMING),
        }
    } else {
        Kind::Block
    }
}

impl Builder {
    fn block(&mut self, block: &BlockNode) -> Result<ModuleId> {
        let Verilog::Combinatorial(kernel) = &block.hdl else {
            return Err(block.error(
                "update",
                "has no kernel that can be read",
                "put #[hdl_gen] before update, and use Reg, SyncReg, Memory or Rom for state",
            ));
        };
        let mut draft = self.draft(block)?;
        let mut children = vec![];
        for child in &block.children {
            match kind(child) {
                Kind::Register {
                    is_synchroniser,
                    on_fall,
                } => self.register(&mut draft, child, is_synchroniser, on_fall)?,
                Kind::Memory { is_read_only } => draft.memory(child, is_read_only)?,
                Kind::Block => {
                    let id = self.block(child)?;
                    self.instance(&mut draft, child, id)?;
                    children.push(id);
                }
            }
        }
        let mut scope = Scope {
            block,
            symbols: std::mem::take(&mut draft.symbols),
            nets: std::mem::take(&mut draft.module.nets),
            parameters: std::mem::take(&mut draft.module.parameters),
            enums: &self.design.enums,
            block_enums: std::mem::take(&mut draft.enums),
            loops: vec![],
            is_repeated: false,
        };
        let mut statements = scope.statements(kernel)?;
        draft.symbols = scope.symbols;
        draft.module.nets = scope.nets;
        draft.module.parameters = scope.parameters;

        drop_replaced(&mut statements, &draft.module.nets);
        draft.check_driven(&statements)?;
        draft.connect_directly(&mut statements);
        draft.check_clocks()?;
        let through_children = self.through_children(&draft);
        let (processes, mut depends) =
            plan(&statements, &through_children).map_err(|e| draft.plan_error(e))?;
        draft.module.processes = processes;
        for (net, sources) in through_children {
            depends.entry(net).or_default().extend(sources);
        }
        let through = draft.through(&depends);
        draft.select_texts()?;
        draft.drop_unused_nets();
        draft.check_names()?;
        // The same block type with the same parameters gives the same module.
        if let Some(same) = self.design.modules.iter().position(|m| *m == draft.module) {
            return Ok(same);
        }
        self.design.modules.push(draft.module);
        self.through.push(through);
        Ok(self.design.modules.len() - 1)
    }

    fn draft<'a>(&mut self, block: &'a BlockNode) -> Result<Draft<'a>> {
        let found = block.docs.first();
        let mut draft = Draft {
            block,
            module: Module {
                name: String::new(),
                type_name: match found {
                    Some(found) => found.name.clone(),
                    None => block.name.split('$').next().unwrap_or(&block.name).into(),
                },
                docs: found.map_or(vec![], |t| t.lines.clone()),
                properties: block.properties.clone(),
                nets: vec![],
                ports: vec![],
                parameters: vec![],
                registers: vec![],
                memories: vec![],
                instances: vec![],
                processes: vec![],
            },
            symbols: HashMap::new(),
            enums: vec![],
            fields: (found.into_iter().flat_map(|t| &t.parts))
                .map(|(name, lines)| (name.as_str(), lines.as_slice()))
                .collect(),
            child_names: (block.children.iter())
                .map(|child| verilog_name(&child.name))
                .collect(),
            child_inputs: vec![],
            ports_of_child: vec![],
        };
        for atom in &block.atoms {
            self.atom(&mut draft, atom)?;
        }
        Ok(draft)
    }

    fn atom(&mut self, draft: &mut Draft, atom: &AtomNode) -> Result<()> {
        let name = atom.name.clone();
        let docs = draft.docs(&atom.key);
        let enum_id = self.intern_enums(&mut draft.enums, &draft.block.docs, &atom.descriptor);
        let direction = match atom.kind {
            AtomKind::Constant => {
                draft.module.parameters.push(Parameter {
                    name: name.to_uppercase(),
                    width_bits: atom.width_bits,
                    value: atom.value,
                    docs,
                });
                let symbol = Symbol::Parameter(draft.module.parameters.len() - 1);
                draft.symbols.insert(atom.key.clone(), symbol);
                return Ok(());
            }
            AtomKind::InputParameter => Some(Direction::Input),
            AtomKind::OutputParameter => Some(Direction::Output),
            AtomKind::LocalSignal => None,
            _ => {
                return Err(draft.block.error(
                    &atom.key,
                    "is bidirectional",
                    "use three signals: value out, output enable, value in",
                ))
            }
        };
        if matches!(atom.descriptor.kind, TypeKind::Signed(_)) {
            return Err(draft.block.error(
                &atom.key,
                "is signed",
                "use Bits<N>; signed types are not supported",
            ));
        }
        let net = draft.net(name, atom.width_bits, enum_id, docs);
        if let Some(direction) = direction {
            draft.module.ports.push(Port {
                net,
                direction,
                is_clock: atom.descriptor.name == "clock",
            });
        }
        let symbol = Symbol::Net {
            net,
            is_assignable: direction != Some(Direction::Input),
            is_readable: true,
        };
        draft.symbols.insert(atom.key.clone(), symbol);
        Ok(())
    }

    /// The enum of a type; also notes the enums inside a struct, whose variants the kernel may name.
    fn intern_enums(
        &mut self,
        block_enums: &mut Vec<EnumId>,
        docs: &[Docs],
        descriptor: &TypeDescriptor,
    ) -> Option<EnumId> {
        match &descriptor.kind {
            TypeKind::Enum(paths) => {
                let variants: Vec<String> = paths
                    .iter()
                    .map(|path| path.rsplit("::").next().unwrap_or(path).to_string())
                    .collect();
                let known = self
                    .design
                    .enums
                    .iter()
                    .position(|e| e.name == descriptor.name && e.variants == variants);
                let id = known.unwrap_or_else(|| {
                    let found = docs.iter().find(|t| t.name == descriptor.name);
                    self.design.enums.push(EnumType {
                        name: descriptor.name.clone(),
                        width_bits: clog2(variants.len()),
                        docs: found.map_or(vec![], |t| t.lines.clone()),
                        variant_docs: found.map_or(vec![], |t| {
                            t.parts.iter().map(|(_, lines)| lines.clone()).collect()
                        }),
                        variants,
                    });
                    self.design.enums.len() - 1
                });
                if !block_enums.contains(&id) {
                    block_enums.push(id);
                }
                Some(id)
            }
            TypeKind::Composite(fields) => {
                for field in fields {
                    self.intern_enums(block_enums, docs, &field.kind);
                }
                None
            }
            _ => None,
        }
    }

    /// A register child becomes two nets: `name` (present value) and `name_next`.
    fn register(
        &mut self,
        draft: &mut Draft,
        child: &BlockNode,
        is_synchroniser: bool,
        on_fall: bool,
    ) -> Result<()> {
        let (Some(d), Some(start)) = (child.atom("d"), child.atom("start")) else {
            return Err(child.error(
                "",
                "is called a register but has no d or start",
                "use Reg or SyncReg",
            ));
        };
        let name = verilog_name(&child.name);
        let enum_id = self.intern_enums(&mut draft.enums, &draft.block.docs, &d.descriptor);
        let q = draft.net(name.clone(), d.width_bits, enum_id, draft.docs(&child.name));
        // The input of a flip-flop is called d if a field already has the better name.
        let free_name = draft.free_name_of(["next", "d"].map(|end| format!("{name}_{end}")));
        let next = draft.net(free_name, d.width_bits, enum_id, vec![]);
        let free_name = draft.free_name(&format!("{name}_clock"));
        let clock = draft.net(free_name, 1, None, vec![]);
        let free_name = draft.free_name(&format!("{name}_reset"));
        let reset = draft.net(free_name, 1, None, vec![]);
        for (port, net, direction) in [
            ("q", q, Direction::Output),
            ("d", next, Direction::Input),
            ("clock", clock, Direction::Input),
            ("reset", reset, Direction::Input),
        ] {
            draft.child_port(&child.name, port, net, direction);
        }
        draft.module.registers.push(Register {
            q,
            next,
            clock,
            reset: Some(reset),
            start: start.value,
            is_synchroniser,
            on_fall,
        });
        Ok(())
    }

    fn instance(&mut self, draft: &mut Draft, child: &BlockNode, id: ModuleId) -> Result<()> {
        let name = verilog_name(&child.name);
        let mut nets = vec![];
        let ports = child.atoms.iter().filter(|atom| atom.kind.is_parameter());
        for (atom, port) in ports.zip(&self.design.modules[id].ports.clone()) {
            let enum_id = self.intern_enums(&mut draft.enums, &child.docs, &atom.descriptor);
            let net_name = draft.free_name(&format!("{name}_{}", atom.name));
            let net = draft.net(net_name, atom.width_bits, enum_id, vec![]);
            draft.child_port(&child.name, &atom.key, net, port.direction);
            nets.push(net);
        }
        draft.module.instances.push(Instance {
            name,
            module: id,
            connections: nets
                .iter()
                .zip(&self.design.modules[id].ports)
                .map(|(net, port)| Connection {
                    direction: port.direction,
                    value: draft.module.net_expr(*net),
                })
                .collect(),
        });
        draft.ports_of_child.push(nets);
        Ok(())
    }

    /// Nets that each output of a child depends on, by way of the child.
    fn through_children(&self, draft: &Draft) -> Dependencies {
        let mut depends = Dependencies::new();
        for instance in &draft.module.instances {
            for (output, inputs) in &self.through[instance.module] {
                let ExprKind::Net(net) = instance.connections[*output].value.kind else {
                    continue;
                };
                let sources: &mut BTreeSet<NetId> = depends.entry(net).or_default();
                for input in inputs {
                    instance.connections[*input].value.for_each_net(&mut |net| {
                        sources.insert(net);
                    });
                }
            }
        }
        // From output to input of the same or another child, directly connected.
        loop {
            let before: usize = depends.values().map(BTreeSet::len).sum();
            let snapshot = depends.clone();
            for sources in depends.values_mut() {
                let more: Vec<NetId> = sources
                    .iter()
                    .filter_map(|s| snapshot.get(s))
                    .flatten()
                    .copied()
                    .collect();
                sources.extend(more);
            }
            if depends.values().map(BTreeSet::len).sum::<usize>() == before {
                return depends;
            }
        }
    }
}
