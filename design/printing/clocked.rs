//! Next values that are assigned in the clocked block of their register, without a net.
//!
//! ```text
//! x_next = x;                 if (load)
//! if (load)                       x <= data;
//!     x_next = data;
//! ```
//!
//! A next value that nothing but its register reads needs no net. Registers have their old value in the clocked block, so every
//! statement reads there what it reads in the process.

use super::register_groups;
use crate::elaborate::properties::words;
use crate::elaborate::{hand_on, restricted, targets, ExprKind, Module, NetId, Process, Statement};
use std::collections::{BTreeMap, BTreeSet};

/// The processes of a module, and the statements that are in clocked blocks instead.
pub(crate) struct Clocked {
    /// Processes that remain outside clocked blocks.
    pub processes: Vec<Process>,
    /// Statements in clocked blocks; they assign the registers.
    moved: Vec<Vec<Statement>>,
    /// For each next value without a net, the index of its statements.
    index: BTreeMap<NetId, usize>,
}

impl Clocked {
    pub fn new(module: &Module) -> Self {
        let candidates = candidates(module);
        let mut clocked = Self {
            processes: vec![],
            moved: vec![],
            index: BTreeMap::new(),
        };
        for process in &module.processes {
            let all = targets(&process.statements);
            let targets = movable(&process.statements, &candidates);
            let others: BTreeSet<NetId> = all.difference(&targets).copied().collect();
            if !others.is_empty() {
                let statements = restricted(&process.statements, &others);
                clocked.processes.push(Process { statements });
            }
            for (_, group) in register_groups(module) {
                let next = group.iter().map(|r| r.next);
                let next: BTreeSet<NetId> = next.filter(|net| targets.contains(net)).collect();
                if next.is_empty() {
                    continue;
                }
                let statements = restricted(&process.statements, &next);
                let number = clocked.moved.len();
                clocked.moved.push(in_clocked_block(module, statements));
                clocked.index.extend(next.iter().map(|net| (*net, number)));
            }
        }
        clocked
    }

    /// Whether this is a next value without a net.
    pub fn has_no_net(&self, net: NetId) -> bool {
        self.index.contains_key(&net)
    }

    /// The statements that assign the register with this next value, and their number; `None` if the next value has a net.
    pub fn statements(&self, next: NetId) -> Option<(usize, Vec<Statement>)> {
        let number = *self.index.get(&next)?;
        Some((number, self.moved[number].clone()))
    }

    /// The bits of each net that the printed text reads.
    pub fn read_bits(&self, module: &Module) -> BTreeMap<NetId, u128> {
        let moved = self.moved.iter().cloned();
        let moved = moved.map(|statements| Process { statements });
        let mut printed = module.clone();
        printed.processes = self.processes.iter().cloned().chain(moved).collect();
        printed.read_bits()
    }
}

/// Next values that nothing but their register reads.
fn candidates(module: &Module) -> BTreeSet<NetId> {
    let mut others: BTreeSet<NetId> = module.ports.iter().map(|p| p.net).collect();
    for statement in module.processes.iter().flat_map(|p| &p.statements) {
        statement.for_each_expr(&mut |expr| {
            expr.for_each_net(&mut |net| {
                others.insert(net);
            });
        });
    }
    others.extend(module.memories.iter().flat_map(|m| m.inputs()));
    for connection in module.instances.iter().flat_map(|i| &i.connections) {
        connection.value.for_each_net(&mut |net| {
            others.insert(net);
        });
    }
    let mut seen = BTreeSet::new();
    for register in &module.registers {
        others.extend(register.reset.iter().chain([&register.clock]));
        if !seen.insert(register.next) {
            others.insert(register.next);
        }
    }
    let named = words(&module.properties);
    let is_free =
        |net: &NetId| !others.contains(net) && !named.contains(module.nets[*net].name.as_str());
    seen.into_iter().filter(is_free).collect()
}

/// Targets of a process that can be assigned in a clocked block. A target stays with the wires of the process if a statement of the process
/// assigns both, and if a statement that assigns it reads such a wire before the last assignment to the wire.
fn movable(statements: &[Statement], candidates: &BTreeSet<NetId>) -> BTreeSet<NetId> {
    let each: Vec<BTreeSet<NetId>> = (statements.iter())
        .map(|statement| targets(std::slice::from_ref(statement)))
        .collect();
    let mut moved: BTreeSet<NetId> = targets(statements);
    moved.retain(|net| candidates.contains(net));
    loop {
        let before = moved.len();
        for (at, (statement, set)) in statements.iter().zip(&each).enumerate() {
            let mut stays = !set.is_subset(&moved);
            for later in &each[at..] {
                statement.for_each_expr(&mut |expr| {
                    expr.for_each_net(&mut |net| stays |= later.contains(&net));
                });
            }
            if stays {
                moved.retain(|net| !set.contains(net));
            }
        }
        if moved.len() == before {
            return moved;
        }
    }
}

/// The statements with registers in the place of their next values. A register holds its value anyway: a statement that says so before
/// any other assignment is left out.
fn in_clocked_block(module: &Module, statements: Vec<Statement>) -> Vec<Statement> {
    let registers: BTreeMap<NetId, NetId> =
        (module.registers.iter()).map(|r| (r.next, r.q)).collect();
    let mut assigned = BTreeSet::new();
    let mut rest = statements.into_iter().peekable();
    let mut kept: Vec<Statement> = vec![];
    let mut docs: Vec<String> = vec![];
    while let Some(mut statement) = rest.next() {
        let is_last = rest.peek().is_none() && kept.is_empty();
        if !is_last && holds(&statement, &registers) {
            let is_first = targets(std::slice::from_ref(&statement)).is_disjoint(&assigned);
            if is_first {
                docs.extend_from_slice(statement.docs());
                continue;
            }
        }
        assigned.extend(targets(std::slice::from_ref(&statement)));
        hand_on(
            &std::mem::take(&mut docs),
            std::slice::from_mut(&mut statement),
        );
        statement.for_each_target_mut(&mut |net| *net = registers[net]);
        kept.push(statement);
    }
    kept
}

/// Whether a statement gives a register the value that it has.
fn holds(statement: &Statement, registers: &BTreeMap<NetId, NetId>) -> bool {
    let Statement::Assign { net, value, .. } = statement else {
        return false;
    };
    matches!(value.kind, ExprKind::Net(q) if registers.get(net) == Some(&q))
}
