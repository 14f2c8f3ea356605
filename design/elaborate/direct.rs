//! Fewer names for the same thing: direct connections, and no net that nothing reads.

use super::design::*;
use super::draft::Draft;
use std::collections::{BTreeMap, BTreeSet};

impl Draft<'_> {
    /// Removes assignments that only rename: an input of a child is connected to the net it is assigned from, an output of a child
    /// to the port or local that takes it.
    pub(super) fn connect_directly(&mut self, statements: &mut Vec<Statement>) {
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
        // A net that could not be replaced (a constant, a part of a net) remains an assignment.
        let mut used: BTreeSet<NetId> = BTreeSet::new();
        for register in &self.module.registers {
            used.extend(register.reset.iter().chain([&register.clock]));
        }
        for memory in &self.module.memories {
            used.extend(memory.inputs());
        }
        for (net, mut value) in sources {
            if used.contains(&net) {
                value.for_each_net_mut(&mut |net| rename(net));
                statements.push(Statement::Assign {
                    docs: vec![],
                    net,
                    low_bit: 0,
                    value,
                });
            }
        }
    }

    /// Removes nets that nothing refers to any more, and locals that nothing reads.
    pub(super) fn drop_unused_nets(&mut self) {
        loop {
            let read = self.module.read_bits();
            let ports: BTreeSet<NetId> = self.module.ports.iter().map(|p| p.net).collect();
            let locals: BTreeSet<NetId> = (0..self.module.nets.len())
                .filter(|net| !read.contains_key(net) && !ports.contains(net))
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
        self.module.keep_nets(&used);
    }
}
