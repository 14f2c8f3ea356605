//! Parts of a design that reach its ports or its properties.

use super::super::design::*;
use super::super::finish::order_modules;
use super::super::plan::{dependencies, Dependencies};
use super::known::Values;
use std::collections::{BTreeMap, BTreeSet};

/// Used parts of a module.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Live {
    /// Nets whose value matters.
    pub nets: BTreeSet<NetId>,
    /// Instances, by index.
    pub instances: BTreeSet<usize>,
}

impl Live {
    fn size(&self) -> usize {
        self.nets.len() + self.instances.len()
    }
}

/// Drivers of the nets of a module.
struct Drivers {
    /// For each net, the nets that its process reads for it.
    reads: Dependencies,
    /// For each net with a child as driver: instance and port.
    children: BTreeMap<NetId, (usize, usize)>,
}

impl Drivers {
    fn new(module: &Module) -> Self {
        let mut reads = Dependencies::new();
        for process in &module.processes {
            reads.extend(dependencies(&process.statements));
        }
        for register in &module.registers {
            let sources = [register.clock, register.next].into_iter();
            let sources = sources.chain(register.reset);
            reads.entry(register.q).or_default().extend(sources);
        }
        for memory in &module.memories {
            let sources = reads.entry(memory.read_data).or_default();
            sources.extend(memory.inputs());
        }
        let mut children = BTreeMap::new();
        for (index, instance) in module.instances.iter().enumerate() {
            for (port, connection) in instance.connections.iter().enumerate() {
                if let (Direction::Output, ExprKind::Net(net)) =
                    (connection.direction, &connection.value.kind)
                {
                    children.insert(*net, (index, port));
                }
            }
        }
        Self { reads, children }
    }
}

/// Used parts of each module, starting from the outputs of the top and the properties.
fn live(design: &Design, facts: &[Values]) -> Vec<Live> {
    let drivers: Vec<Drivers> = design.modules.iter().map(Drivers::new).collect();
    let mut all = vec![Live::default(); design.modules.len()];
    let top = design.top();
    let outputs = top.ports.iter();
    let outputs = outputs.filter(|port| port.direction == Direction::Output);
    all[0].nets = outputs.map(|port| port.net).collect();
    let mut is_used = vec![false; design.modules.len()];
    is_used[0] = true;
    loop {
        let before: usize = all.iter().map(Live::size).sum();
        for id in 0..design.modules.len() {
            if is_used[id] {
                let module = &design.modules[id];
                let named = module.named_in_properties().into_iter();
                let open = named.filter(|net| module.whole(*net, &facts[id]).is_none());
                all[id].nets.extend(open);
                follow(design, id, &drivers[id], &mut all, &mut is_used);
            }
        }
        if all.iter().map(Live::size).sum::<usize>() == before {
            return all;
        }
    }
}

/// Follows the live nets of a module to their drivers.
fn follow(
    design: &Design,
    id: ModuleId,
    drivers: &Drivers,
    all: &mut [Live],
    is_used: &mut [bool],
) {
    let module = &design.modules[id];
    let mut open: Vec<NetId> = all[id].nets.iter().copied().collect();
    loop {
        while let Some(net) = open.pop() {
            for source in drivers.reads.get(&net).into_iter().flatten() {
                if all[id].nets.insert(*source) {
                    open.push(*source);
                }
            }
            if let Some((index, port)) = drivers.children.get(&net) {
                let child = module.instances[*index].module;
                is_used[child] = true;
                all[id].instances.insert(*index);
                let inside = design.modules[child].ports[*port].net;
                all[child].nets.insert(inside);
            }
        }
        // Nets read by live children.
        for index in all[id].instances.clone() {
            let instance = &module.instances[index];
            let child = &design.modules[instance.module];
            let ports = child.ports.iter().zip(&instance.connections);
            for (port, connection) in ports.filter(|(p, _)| p.direction == Direction::Input) {
                if all[instance.module].nets.contains(&port.net) {
                    connection.value.for_each_net(&mut |net| {
                        if all[id].nets.insert(net) {
                            open.push(net);
                        }
                    });
                }
            }
        }
        if open.is_empty() {
            return;
        }
    }
}

/// The design with nothing but what is used. The top keeps its ports; what is proved sees a net that is known as the constant that it is.
pub(super) fn without_dead(design: &Design, facts: &[Values]) -> Design {
    let live = live(design, facts);
    let keeps_port = |id: ModuleId, port: &Port| id == 0 || live[id].nets.contains(&port.net);
    let mut modules = vec![];
    for (id, module) in design.modules.iter().enumerate() {
        let mut module = module.clone();
        let used = &live[id];
        let is_live = |net: NetId| used.nets.contains(&net);
        module.ports.retain(|port| keeps_port(id, port));
        module.registers.retain(|register| is_live(register.q));
        module.memories.retain(|memory| is_live(memory.read_data));
        for process in &mut module.processes {
            process.statements = restricted(&process.statements, &used.nets);
        }
        module.processes.retain(|p| !p.statements.is_empty());
        let instances = std::mem::take(&mut module.instances);
        for (index, mut instance) in instances.into_iter().enumerate() {
            if used.instances.contains(&index) {
                let ports = &design.modules[instance.module].ports;
                let mut kept = ports.iter().map(|port| keeps_port(instance.module, port));
                instance.connections.retain(|_| kept.next() == Some(true));
                module.instances.push(instance);
            }
        }
        let nets = module.mentioned_nets();
        let gone = module.named_in_properties();
        let gone = gone.difference(&nets).filter_map(|net| {
            let value = module.whole(*net, &facts[id])?;
            let Net {
                name, width_bits, ..
            } = &module.nets[*net];
            let last_bit = width_bits - 1;
            Some(format!(
                "wire [{last_bit}:0] {name} = {width_bits}'d{value};\n"
            ))
        });
        module.properties = gone.collect::<String>() + &module.properties;
        module.keep_nets(&nets);
        modules.push(module);
    }
    let mut design = Design {
        modules,
        ..design.clone()
    };
    order_modules(&mut design, 0);
    design
}
