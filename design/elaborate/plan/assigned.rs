//! Every way through a process must assign all its targets, and each before it is read.

use super::super::design::{mask, Expr, ExprKind, NetId, Statement};
use super::super::pieces::row;
use super::PlanError;
use std::collections::{BTreeMap, BTreeSet};

/// Checks that every way through the statements assigns all targets, and assigns them before reading them.
pub(super) fn check_assigned(
    statements: &[Statement],
    set: &BTreeSet<NetId>,
) -> Result<(), PlanError> {
    let mut widths: BTreeMap<NetId, u128> = BTreeMap::new();
    for statement in statements {
        statement.for_each_target(&mut |net, low, width| {
            *widths.entry(net).or_default() |= mask(width) << low;
        });
    }
    let mut assigned = BTreeMap::new();
    walk(statements, set, &mut assigned)?;
    for (net, bits) in widths {
        if assigned.get(&net).copied().unwrap_or(0) != bits {
            return Err(PlanError::Latch(net));
        }
    }
    Ok(())
}

type Assigned = BTreeMap<NetId, u128>;

fn walk(
    statements: &[Statement],
    set: &BTreeSet<NetId>,
    assigned: &mut Assigned,
) -> Result<(), PlanError> {
    for statement in statements {
        match statement {
            Statement::Assign {
                net,
                low_bit,
                value,
                ..
            } => {
                check_reads(value, set, assigned)?;
                *assigned.entry(*net).or_default() |= mask(value.width_bits) << low_bit;
            }
            Statement::If {
                condition,
                then,
                otherwise,
                ..
            } => {
                check_reads(condition, set, assigned)?;
                branches(&[then, otherwise], set, assigned)?;
            }
            Statement::Case {
                subject,
                arms,
                default,
                ..
            } => {
                check_reads(subject, set, assigned)?;
                let mut blocks: Vec<&[Statement]> =
                    arms.iter().map(|(_, block)| &block[..]).collect();
                if arms.len() as u128 <= mask(subject.width_bits) {
                    blocks.push(default);
                }
                branches(&blocks, set, assigned)?;
            }
        }
    }
    Ok(())
}

fn branches(
    blocks: &[&[Statement]],
    set: &BTreeSet<NetId>,
    assigned: &mut Assigned,
) -> Result<(), PlanError> {
    let mut common: Option<Assigned> = None;
    for block in blocks {
        let mut branch = assigned.clone();
        walk(block, set, &mut branch)?;
        common = Some(match common {
            None => branch,
            Some(other) => other
                .into_iter()
                .filter_map(|(net, bits)| Some((net, bits & branch.get(&net)?)))
                .collect(),
        });
    }
    *assigned = common.unwrap_or_default();
    Ok(())
}

fn check_reads(expr: &Expr, set: &BTreeSet<NetId>, assigned: &Assigned) -> Result<(), PlanError> {
    let mut result = Ok(());
    for_each_read(expr, &mut |net, bits| {
        if set.contains(&net) && bits & !assigned.get(&net).copied().unwrap_or(0) != 0 {
            result = Err(PlanError::ReadBeforeAssigned(net));
        }
    });
    result
}

/// Calls `visit` for every net that an expression names, with the bits that matter: of what it puts side by side, those of the pieces.
pub(in crate::elaborate) fn for_each_read(expr: &Expr, visit: &mut dyn FnMut(NetId, u128)) {
    if let Some(row) = row(expr) {
        for piece in row {
            for_each_read(&piece.expr, visit);
        }
        expr.for_each_net(&mut |net| visit(net, 0));
        return;
    }
    match &expr.kind {
        ExprKind::Net(net) => visit(*net, mask(expr.width_bits)),
        ExprKind::Slice(inner, low_bit) => {
            if let ExprKind::Net(net) = inner.kind {
                visit(net, mask(expr.width_bits) << low_bit);
            } else {
                for_each_read(inner, visit);
            }
        }
        _ => expr
            .operands()
            .into_iter()
            .for_each(|operand| for_each_read(operand, visit)),
    }
}
