//! Modules from blocks: nets, registers, instances, and the processes of the kernel.

use super::design::*;
use super::names::{problem, verilog_name};
use super::plan::{for_each_read, plan, Dependencies, PlanError};
use super::scope::{child_port, drop_replaced, Scope, Symbol};
use super::tree::{AtomNode, BlockNode};
use super::{docs, ElaborateError};
use crate::memory::MEMORY_TIMING;
use crate::reg::{REG_TIMING, SYNC_REG_TIMING};
use rust_hdl::prelude::{clog2, AtomKind, TypeDescriptor, TypeKind, Verilog};
use std::collections::{BTreeMap, BTreeSet, HashMap};

type Result<T> = std::result::Result<T, ElaborateError>;

/// Elaborates the tree; the modules are in the order in which they were finished, children before parents.
pub(super) fn build(top: &BlockNode) -> Result<(Design, ModuleId)> {
    let mut builder = Builder {
        design: Design {
            modules: vec![],
            enums: vec![],
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

/// What a child block is.
enum Kind {
    Register { is_synchroniser: bool },
    Memory,
    Block,
}

fn kind(child: &BlockNode) -> Kind {
    let is = |name: &str| child.timing.iter().any(|t| t.name == name);
    if is(REG_TIMING) || is(SYNC_REG_TIMING) {
        Kind::Register {
            is_synchroniser: is(SYNC_REG_TIMING),
        }
    } else if is(MEMORY_TIMING) {
        Kind::Memory
    } else {
        Kind::Block
    }
}

/// A module under construction.
struct Draft<'a> {
    block: &'a BlockNode,
    module: Module,
    symbols: HashMap<String, Symbol>,
    enums: Vec<EnumId>,
    fields: HashMap<&'static str, &'static [String]>,
    /// Nets that stand for an input of a child (or of a register), with what to call them in a message.
    child_inputs: Vec<(NetId, String)>,
    /// For each child block, the nets of its ports.
    ports_of_child: Vec<Vec<NetId>>,
}

impl Builder {
    fn block(&mut self, block: &BlockNode) -> Result<ModuleId> {
        let Verilog::Combinatorial(kernel) = &block.hdl else {
            return Err(block.error(
                "update",
                "has no kernel that can be read",
                "put #[hdl_gen] before update, and use Reg, SyncReg or Memory for state",
            ));
        };
        let mut draft = self.draft(block)?;
        let mut children = vec![];
        for child in &block.children {
            match kind(child) {
                Kind::Register { is_synchroniser } => {
                    self.register(&mut draft, child, is_synchroniser)?
                }
                Kind::Memory => draft.memory(child)?,
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
        };
        let mut statements = scope.statements(kernel)?;
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
        let found = docs::find(block).map_err(|names| {
            block.error(
                "",
                format!("has the same fields as {}", names.join(" and ")),
                "give one of the types a field name of its own: types are told apart by their fields",
            )
        })?;
        let mut draft = Draft {
            block,
            module: Module {
                name: String::new(),
                type_name: match found {
                    Some(found) => found.name.clone(),
                    None => block.name.split('$').next().unwrap_or(&block.name).into(),
                },
                docs: found.map_or(vec![], |t| t.docs.clone()),
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
            fields: found
                .map(|t| {
                    t.fields
                        .iter()
                        .map(|f| (f.name.as_str(), f.docs.as_slice()))
                        .collect()
                })
                .unwrap_or_default(),
            child_inputs: vec![],
            ports_of_child: vec![],
        };
        for atom in &block.atoms {
            self.atom(&mut draft, atom)?;
        }
        Ok(draft)
    }

    fn atom(&mut self, draft: &mut Draft, atom: &AtomNode) -> Result<()> {
        let name = verilog_name(&atom.key);
        let docs = draft.docs(&atom.key);
        let enum_id = self.intern_enums(&mut draft.enums, &atom.descriptor);
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
                    let found = docs::find_enum(&descriptor.name, &variants);
                    self.design.enums.push(EnumType {
                        name: descriptor.name.clone(),
                        width_bits: clog2(variants.len()),
                        docs: found.map_or(vec![], |t| t.docs.clone()),
                        variant_docs: found.map_or(vec![], |t| {
                            t.fields.iter().map(|f| f.docs.clone()).collect()
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
                    self.intern_enums(block_enums, &field.kind);
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
    ) -> Result<()> {
        let (Some(d), Some(start)) = (child.atom("d"), child.atom("start")) else {
            return Err(child.error(
                "",
                "is called a register but has no d or start",
                "use Reg or SyncReg",
            ));
        };
        let name = verilog_name(&child.name);
        let enum_id = self.intern_enums(&mut draft.enums, &d.descriptor);
        let q = draft.net(name.clone(), d.width_bits, enum_id, draft.docs(&child.name));
        let free_name = draft.free_name(&format!("{name}_next"));
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
        });
        Ok(())
    }

    fn instance(&mut self, draft: &mut Draft, child: &BlockNode, id: ModuleId) -> Result<()> {
        let name = verilog_name(&child.name);
        let mut nets = vec![];
        let ports = child.atoms.iter().filter(|atom| atom.kind.is_parameter());
        for (atom, port) in ports.zip(&self.design.modules[id].ports.clone()) {
            let enum_id = self.intern_enums(&mut draft.enums, &atom.descriptor);
            let net_name = draft.free_name(&format!("{name}_{}", verilog_name(&atom.key)));
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

impl Draft<'_> {
    fn docs(&self, key: &str) -> Vec<String> {
        let field = key.split('$').next().unwrap_or(key);
        self.fields.get(field).map_or(vec![], |docs| docs.to_vec())
    }

    fn net(
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
    fn free_name(&self, base: &str) -> String {
        let fields = self.block.atoms.iter().map(|a| &a.key);
        let mut taken: BTreeSet<String> = fields
            .chain(self.block.children.iter().map(|c| &c.name))
            .map(|key| verilog_name(key).to_lowercase())
            .collect();
        taken.extend(self.module.nets.iter().map(|n| n.name.to_lowercase()));
        let numbered = (2..).map(|number| format!("{base}_{number}"));
        std::iter::once(base.to_string())
            .chain(numbered)
            .find(|name| !taken.contains(&name.to_lowercase()))
            .unwrap_or_default()
    }

    fn child_port(&mut self, child: &str, port: &str, net: NetId, direction: Direction) {
        self.symbols
            .insert(format!("{child}${port}"), child_port(net, direction));
        if direction == Direction::Input {
            self.child_inputs.push((net, format!("{child}.{port}")));
        }
    }

    fn memory(&mut self, child: &BlockNode) -> Result<()> {
        let name = verilog_name(&child.name);
        let mut nets = vec![];
        for (port, direction) in [
            ("clock", Direction::Input),
            ("read_address", Direction::Input),
            ("read_data", Direction::Output),
            ("write_enable", Direction::Input),
            ("write_address", Direction::Input),
            ("write_data", Direction::Input),
        ] {
            let Some(atom) = child.atom(port) else {
                return Err(child.error(port, "is missing from a memory", "use Memory"));
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
            write_enable: nets[3],
            write_address: nets[4],
            write_data: nets[5],
            docs: self.docs(&child.name),
        });
        Ok(())
    }

    /// Everything that needs a driver has one.
    fn check_driven(&self, statements: &[Statement]) -> Result<()> {
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

    /// Removes assignments that only rename: an input of a child is connected to the net it is assigned from, an output of a child
    /// to the port or local that takes it.
    fn connect_directly(&mut self, statements: &mut Vec<Statement>) {
        let inputs: BTreeSet<NetId> = self.child_inputs.iter().map(|(net, _)| *net).collect();
        let next: BTreeSet<NetId> = self.module.registers.iter().map(|r| r.next).collect();
        let outputs: BTreeSet<NetId> = self
            .ports_of_child
            .iter()
            .flatten()
            .filter(|net| !inputs.contains(net))
            .copied()
            .collect();
        let mut last: BTreeMap<NetId, usize> = BTreeMap::new();
        let mut count: BTreeMap<NetId, usize> = BTreeMap::new();
        for (at, statement) in statements.iter().enumerate() {
            statement.for_each_target(&mut |net, _, _| {
                last.insert(net, at);
                *count.entry(net).or_default() += 1;
            });
        }
        let mut sources: BTreeMap<NetId, Expr> = BTreeMap::new();
        let mut renamed: BTreeMap<NetId, NetId> = BTreeMap::new();
        let mut keep = vec![true; statements.len()];
        for (at, statement) in statements.iter().enumerate() {
            let Statement::Assign { net, value, .. } = statement else {
                continue;
            };
            if count[net] != 1 || value.width_bits != self.module.nets[*net].width_bits {
                continue;
            }
            let mut is_final = true;
            value.for_each_net(&mut |source| {
                is_final &= last.get(&source).is_none_or(|last| *last < at)
            });
            let is_plain = match &value.kind {
                ExprKind::Net(_)
                | ExprKind::Constant(_)
                | ExprKind::Variant(..)
                | ExprKind::Parameter(_) => true,
                ExprKind::Slice(inner, _) => matches!(inner.kind, ExprKind::Net(_)),
                _ => false,
            };
            if inputs.contains(net) && !next.contains(net) && is_plain && is_final {
                sources.insert(*net, value.clone());
                keep[at] = false;
            } else if let ExprKind::Net(source) = value.kind {
                if outputs.contains(&source)
                    && !inputs.contains(net)
                    && !renamed.contains_key(&source)
                {
                    renamed.insert(source, *net);
                    keep[at] = false;
                }
            }
        }
        let mut keep = keep.into_iter();
        statements.retain(|_| keep.next().unwrap_or(true));

        let rename = |net: &mut NetId| {
            if let Some(new) = renamed.get(net) {
                *net = *new;
            }
        };
        for statement in statements.iter_mut() {
            statement.for_each_expr_mut(&mut |expr| expr.for_each_net_mut(&mut |net| rename(net)));
        }
        for instance in &mut self.module.instances {
            for connection in &mut instance.connections {
                if let ExprKind::Net(net) = connection.value.kind {
                    if let Some(source) = sources.get(&net) {
                        connection.value = source.clone();
                    }
                }
                connection.value.for_each_net_mut(&mut |net| rename(net));
            }
        }
        let replace = |net: &mut NetId| {
            if let Some(Expr {
                kind: ExprKind::Net(source),
                ..
            }) = sources.get(net)
            {
                *net = *source;
                rename(net);
            }
        };
        for register in &mut self.module.registers {
            replace(&mut register.clock);
            if let Some(reset) = &mut register.reset {
                match sources.get(reset).map(|source| &source.kind) {
                    Some(ExprKind::Constant(0)) => register.reset = None,
                    _ => replace(reset),
                }
            }
        }
        for memory in &mut self.module.memories {
            for net in memory.inputs_mut() {
                replace(net);
            }
        }
        // What could not be replaced (a constant, a part of a net) stays an assignment.
        let mut used: BTreeSet<NetId> = BTreeSet::new();
        for register in &self.module.registers {
            used.extend(register.reset.iter().chain([&register.clock]));
        }
        for memory in &mut self.module.memories {
            used.extend(memory.inputs_mut().map(|net| *net));
        }
        for (net, mut value) in sources {
            if used.contains(&net) {
                value.for_each_net_mut(&mut |net| rename(net));
                statements.push(Statement::Assign {
                    net,
                    low_bit: 0,
                    value,
                });
            }
        }
    }

    fn check_clocks(&self) -> Result<()> {
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

    fn plan_error(&self, error: PlanError) -> ElaborateError {
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

    /// For each output port, the input ports that it depends on combinationally.
    fn through(&self, depends: &Dependencies) -> BTreeMap<usize, BTreeSet<usize>> {
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

    /// Removes nets that nothing refers to any more, and locals that nothing reads.
    fn drop_unused_nets(&mut self) {
        loop {
            let read = self.module.read_bits();
            let ports: BTreeSet<NetId> = self.module.ports.iter().map(|p| p.net).collect();
            let locals: BTreeSet<NetId> = (0..self.module.nets.len())
                .filter(|net| read.get(net).is_none() && !ports.contains(net))
                .collect();
            let keep = |statement: &Statement| {
                let mut set = BTreeSet::new();
                statement.for_each_target(&mut |net, _, _| {
                    if !locals.contains(&net) {
                        set.insert(net);
                    }
                });
                statement.restricted_to(&set)
            };
            let before = self.module.processes.clone();
            for process in &mut self.module.processes {
                process.statements = process.statements.iter().filter_map(keep).collect();
            }
            self.module.processes.retain(|p| !p.statements.is_empty());
            if self.module.processes == before {
                break;
            }
        }
        let used = self.module.mentioned_nets();
        let map: BTreeMap<NetId, NetId> = used
            .iter()
            .enumerate()
            .map(|(new, old)| (*old, new))
            .collect();
        let nets = std::mem::take(&mut self.module.nets);
        self.module.nets = nets
            .into_iter()
            .enumerate()
            .filter(|(net, _)| used.contains(net))
            .map(|(_, net)| net)
            .collect();
        self.module.renumber(&|net| map[&net]);
    }

    fn check_names(&self) -> Result<()> {
        let mut seen: BTreeMap<String, &str> = BTreeMap::new();
        let module = &self.module;
        let names = module.nets.iter().map(|n| &n.name);
        let names = names.chain(module.parameters.iter().map(|p| &p.name));
        let names = names.chain(module.memories.iter().map(|m| &m.name));
        for name in names.chain(module.instances.iter().map(|i| &i.name)) {
            if let Some(problem) = problem(name) {
                return Err(self.block.error(name, problem, "rename the field"));
            }
            if let Some(other) = seen.insert(name.to_lowercase(), name) {
                return Err(self.block.error(
                    name,
                    format!("and {other} would have the same Verilog name or differ only by case"),
                    "rename one of the fields",
                ));
            }
        }
        Ok(())
    }
}

impl Memory {
    fn inputs_mut(&mut self) -> impl Iterator<Item = &mut NetId> {
        [
            &mut self.clock,
            &mut self.read_address,
            &mut self.write_enable,
            &mut self.write_address,
            &mut self.write_data,
        ]
        .into_iter()
    }
}

impl Module {
    /// The bits of each net that something reads: a statement, a register, a memory, an instance.
    pub fn read_bits(&self) -> BTreeMap<NetId, u128> {
        let mut read: BTreeMap<NetId, u128> = BTreeMap::new();
        let mut note = |net: NetId, bits: u128| *read.entry(net).or_default() |= bits;
        for statement in self.processes.iter().flat_map(|p| &p.statements) {
            statement.for_each_expr(&mut |expr| for_each_read(expr, &mut note));
        }
        for register in &self.registers {
            for net in register
                .reset
                .iter()
                .chain([&register.clock, &register.next])
            {
                note(*net, u128::MAX);
            }
        }
        for memory in &self.memories {
            for net in memory.clone().inputs_mut() {
                note(*net, u128::MAX);
            }
        }
        for instance in &self.instances {
            let inputs = instance
                .connections
                .iter()
                .filter(|c| c.direction == Direction::Input);
            inputs.for_each(|c| for_each_read(&c.value, &mut note));
        }
        read
    }

    fn mentioned_nets(&self) -> BTreeSet<NetId> {
        let mut nets: BTreeSet<NetId> = self.read_bits().into_keys().collect();
        nets.extend(self.ports.iter().map(|p| p.net));
        nets.extend(self.registers.iter().map(|r| r.q));
        nets.extend(self.memories.iter().map(|m| m.read_data));
        for connection in self.instances.iter().flat_map(|i| &i.connections) {
            connection.value.for_each_net(&mut |net| {
                nets.insert(net);
            });
        }
        for statement in self.processes.iter().flat_map(|p| &p.statements) {
            statement.for_each_target(&mut |net, _, _| {
                nets.insert(net);
            });
        }
        nets
    }

    fn renumber(&mut self, map: &dyn Fn(NetId) -> NetId) {
        for statement in self.processes.iter_mut().flat_map(|p| &mut p.statements) {
            statement.for_each_net_mut(&mut |net| *net = map(*net));
        }
        for port in &mut self.ports {
            port.net = map(port.net);
        }
        for register in &mut self.registers {
            register.q = map(register.q);
            register.next = map(register.next);
            register.clock = map(register.clock);
            register.reset = register.reset.map(map);
        }
        for memory in &mut self.memories {
            memory.read_data = map(memory.read_data);
            memory.inputs_mut().for_each(|net| *net = map(*net));
        }
        for instance in &mut self.instances {
            for connection in &mut instance.connections {
                connection
                    .value
                    .for_each_net_mut(&mut |net| *net = map(*net));
            }
        }
    }
}
