//! Processes of different modules that feed each other.
//!
//! Without a loop between nets there may still be one between processes: a process with two paths that are connected
//! outside of it. A simulator that runs a whole process would see its defaults as glitches and
//! never settle. Such processes are split until every process runs after all processes that it reads.

use super::design::{Design, ExprKind, Module, ModuleId, NetId};
use super::plan::split;
use super::tree::BlockNode;
use super::ElaborateError;
use std::collections::{BTreeMap, BTreeSet};

/// Takes processes apart until no process feeds itself, alone or with others.
pub(super) fn separate(design: &mut Design, tree: &BlockNode) -> Result<(), ElaborateError> {
    loop {
        let looped = Flat::new(design).on_loops();
        if looped.is_empty() {
            return Ok(());
        }
        let mut is_changed = false;
        for (module, process) in looped.iter().rev() {
            let processes = &mut design.modules[*module].processes;
            let parts = split(&processes[*process].statements);
            is_changed |= parts.len() > 1;
            processes.splice(*process..=*process, parts);
        }
        if !is_changed {
            let names: Vec<String> = looped
                .iter()
                .map(|(module, process)| target_name(&design.modules[*module], *process))
                .collect();
            return Err(tree.error(
                &names[0],
                format!(
                    "is part of a combinational loop through several blocks, among {}",
                    names.join(", ")
                ),
                "put a register into the loop",
            ));
        }
    }
}

fn target_name(module: &Module, process: usize) -> String {
    let mut name = String::new();
    for statement in &module.processes[process].statements {
        statement.for_each_target(&mut |net, _, _| {
            name = format!("{}.{}", module.type_name, module.nets[net].name)
        });
    }
    name
}

/// All processes of all instances, with the nets of the whole design.
#[derive(Default)]
struct Flat {
    net_count: usize,
    nodes: Vec<Node>,
}

/// A process of an instance, or a connection that is more than a net.
struct Node {
    process: Option<(ModuleId, usize)>,
    reads: BTreeSet<usize>,
    drives: BTreeSet<usize>,
}

impl Flat {
    fn new(design: &Design) -> Self {
        let mut flat = Self::default();
        let nets = (0..design.top().nets.len())
            .map(|_| flat.net())
            .collect::<Vec<_>>();
        flat.module(design, 0, &nets);
        flat
    }

    fn net(&mut self) -> usize {
        self.net_count += 1;
        self.net_count - 1
    }

    fn module(&mut self, design: &Design, id: ModuleId, nets: &[usize]) {
        let module = &design.modules[id];
        for (index, process) in module.processes.iter().enumerate() {
            let (mut reads, mut drives) = (BTreeSet::new(), BTreeSet::new());
            for statement in &process.statements {
                statement.for_each_target(&mut |net, _, _| {
                    drives.insert(nets[net]);
                });
                statement.for_each_expr(&mut |expr| {
                    expr.for_each_net(&mut |net| {
                        reads.insert(nets[net]);
                    });
                });
            }
            // Its reads of its driven nets are intermediate values.
            reads.retain(|net| !drives.contains(net));
            self.nodes.push(Node {
                process: Some((id, index)),
                reads,
                drives,
            });
        }
        for instance in &module.instances {
            let child = &design.modules[instance.module];
            let mut connected: BTreeMap<NetId, usize> = BTreeMap::new();
            for (port, connection) in child.ports.iter().zip(&instance.connections) {
                let net = match connection.value.kind {
                    ExprKind::Net(net) => nets[net],
                    _ => {
                        let net = self.net();
                        let mut reads = BTreeSet::new();
                        connection.value.for_each_net(&mut |read| {
                            reads.insert(nets[read]);
                        });
                        self.nodes.push(Node {
                            process: None,
                            reads,
                            drives: BTreeSet::from([net]),
                        });
                        net
                    }
                };
                connected.insert(port.net, net);
            }
            let child_nets: Vec<usize> = (0..child.nets.len())
                .map(|net| connected.get(&net).copied().unwrap_or_else(|| self.net()))
                .collect();
            self.module(design, instance.module, &child_nets);
        }
    }

    /// The processes that are on a loop, or between two loops.
    fn on_loops(&self) -> BTreeSet<(ModuleId, usize)> {
        let mut driver = vec![None; self.net_count];
        for (index, node) in self.nodes.iter().enumerate() {
            node.drives
                .iter()
                .for_each(|net| driver[*net] = Some(index));
        }
        let sources: Vec<BTreeSet<usize>> = self
            .nodes
            .iter()
            .map(|node| node.reads.iter().filter_map(|net| driver[*net]).collect())
            .collect();
        let mut left: BTreeSet<usize> = (0..self.nodes.len()).collect();
        loop {
            let fed: BTreeSet<usize> = left
                .iter()
                .flat_map(|node| &sources[*node])
                .filter(|source| left.contains(source))
                .copied()
                .collect();
            let stays = |node: &usize| {
                fed.contains(node) && sources[*node].iter().any(|s| left.contains(s))
            };
            let next: BTreeSet<usize> = left.iter().filter(|node| stays(node)).copied().collect();
            if next.len() == left.len() {
                return left
                    .iter()
                    .filter_map(|node| self.nodes[*node].process)
                    .collect();
            }
            left = next;
        }
    }
}
