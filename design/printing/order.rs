//! Parts that a printer reads of a module: registers of a clocked block, bits that statements read, constants.

use crate::elaborate::{execute, Expr, ExprKind, Module, NetId, Register, Statement};
use std::collections::{BTreeMap, BTreeSet};

/// Clock, its falling edge, and reset, and the registers that have all of them.
pub(crate) type Group<'a> = ((NetId, bool, Option<NetId>), Vec<&'a Register>);

/// The registers of each clock and reset.
pub(crate) fn register_groups(module: &Module) -> Vec<Group<'_>> {
    let mut groups: Vec<Group> = vec![];
    for register in &module.registers {
        let key = (register.clock, register.on_fall, register.reset);
        match groups.iter_mut().find(|(k, _)| *k == key) {
            Some((_, group)) => group.push(register),
            None => groups.push((key, vec![register])),
        }
    }
    groups
}

/// The parameters that the text names.
pub(super) fn used_parameters(module: &Module) -> BTreeSet<usize> {
    fn visit(expr: &Expr, used: &mut BTreeSet<usize>) {
        if let ExprKind::Parameter(index) = expr.kind {
            used.insert(index);
        }
        // bits of a constant are printed as a literal
        let is_literal = matches!(&expr.kind, ExprKind::Slice(inner, _) if matches!(inner.kind, ExprKind::Parameter(_)));
        if !is_literal {
            expr.operands().into_iter().for_each(|e| visit(e, used));
        }
    }
    let mut used = BTreeSet::new();
    for statement in module.processes.iter().flat_map(|p| &p.statements) {
        statement.for_each_expr(&mut |expr| visit(expr, &mut used));
    }
    for connection in module.instances.iter().flat_map(|i| &i.connections) {
        visit(&connection.value, &mut used);
    }
    used
}

/// The nets that statements read, and those that they assign.
pub(crate) fn reads_and_targets(statements: &[Statement]) -> (BTreeSet<NetId>, BTreeSet<NetId>) {
    let (mut reads, mut targets) = (BTreeSet::new(), BTreeSet::new());
    for statement in statements {
        statement.for_each_target(&mut |net, _, _| {
            targets.insert(net);
        });
        statement.for_each_expr(&mut |e| {
            e.for_each_net(&mut |net| {
                reads.insert(net);
            });
        });
    }
    (reads, targets)
}

/// Values assigned by statements that read only their own targets.
pub(crate) fn constant_values(module: &Module, statements: &[Statement]) -> BTreeMap<NetId, u128> {
    let mut values: BTreeMap<NetId, u128> = BTreeMap::new();
    let parameters: Vec<u128> = module.parameters.iter().map(|p| p.value).collect();
    execute(statements, &parameters, &mut values);
    values
}
