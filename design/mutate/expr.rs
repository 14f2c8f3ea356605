//! Changes of one expression.

use super::Kind;
use crate::elaborate::{mask, BinaryOp, Design, Expr, ExprKind, Module, UnaryOp};

/// The expression with one change in it, for every change.
pub(super) fn changes(design: &Design, module: &Module, expr: &Expr) -> Vec<(Kind, Expr)> {
    let mut found = own(design, module, expr);
    for (index, operand) in expr.operands().into_iter().enumerate() {
        for (kind, changed) in changes(design, module, operand) {
            let mut with = expr.clone();
            *with.operands_mut()[index] = changed;
            found.push((kind, with));
        }
    }
    found
}

/// Changes of the expression itself; its operands stay.
fn own(design: &Design, module: &Module, expr: &Expr) -> Vec<(Kind, Expr)> {
    let width_bits = expr.width_bits;
    let with = |kind: ExprKind| Expr { width_bits, kind };
    let near = |value: u128| {
        let mut values = vec![value.wrapping_add(1), value.wrapping_sub(1)];
        values.iter_mut().for_each(|v| *v &= mask(width_bits));
        values.dedup();
        let constant = |value| (Kind::Constant, Expr::constant(value, width_bits));
        values.into_iter().map(constant).collect::<Vec<_>>()
    };
    match &expr.kind {
        ExprKind::Constant(value) => near(*value),
        ExprKind::Parameter(index) => near(module.parameters[*index].value),
        ExprKind::Variant(id, index) => {
            let count = design.enums[*id].variants.len();
            let next = (index + 1) % count;
            let is_other = next != *index;
            let other = with(ExprKind::Variant(*id, next));
            is_other
                .then_some((Kind::Constant, other))
                .into_iter()
                .collect()
        }
        ExprKind::Slice(a, low) => {
            let places = [low + 1, low.wrapping_sub(1)].into_iter();
            let inside = |low: &usize| *low < a.width_bits && low + width_bits <= a.width_bits;
            let slice = |low| (Kind::Constant, with(ExprKind::Slice(a.clone(), low)));
            places.filter(inside).map(slice).collect()
        }
        ExprKind::Unary(op, a) => {
            let other = match op {
                UnaryOp::Not => (**a).clone(),
                UnaryOp::All => with(ExprKind::Unary(UnaryOp::Any, a.clone())),
                UnaryOp::Any => with(ExprKind::Unary(UnaryOp::All, a.clone())),
                UnaryOp::Xor => with(ExprKind::Unary(UnaryOp::Any, a.clone())),
            };
            vec![(Kind::Operator, other)]
        }
        ExprKind::Binary(op, a, b) => {
            let other = with(ExprKind::Binary(another(*op), a.clone(), b.clone()));
            let mut found = vec![(Kind::Operator, other)];
            if matches!(op, BinaryOp::And | BinaryOp::Or) && width_bits == 1 {
                found.extend([a, b].map(|operand| (Kind::Condition, (**operand).clone())));
            }
            found
        }
        ExprKind::Net(_) | ExprKind::Extend(_) | ExprKind::Select(..) => vec![],
    }
}

/// The operator that is taken for another one.
fn another(op: BinaryOp) -> BinaryOp {
    match op {
        BinaryOp::Add => BinaryOp::Sub,
        BinaryOp::Sub | BinaryOp::Mul => BinaryOp::Add,
        BinaryOp::And | BinaryOp::Xor => BinaryOp::Or,
        BinaryOp::Or => BinaryOp::And,
        BinaryOp::Shl => BinaryOp::Shr,
        BinaryOp::Shr => BinaryOp::Shl,
        BinaryOp::Eq => BinaryOp::Ne,
        BinaryOp::Ne => BinaryOp::Eq,
        BinaryOp::Lt => BinaryOp::Le,
        BinaryOp::Le => BinaryOp::Lt,
        BinaryOp::Gt => BinaryOp::Ge,
        BinaryOp::Ge => BinaryOp::Gt,
    }
}

/// The expression with one bit always 0, always 1 and inverted; without what changes nothing.
pub(super) fn bits(expr: &Expr) -> Vec<(Kind, Expr)> {
    let width_bits = expr.width_bits;
    let mut found = vec![];
    for bit in 0..width_bits {
        let one = 1_u128 << bit;
        let others = mask(width_bits) & !one;
        for (kind, op, value) in [
            (Kind::Stuck, BinaryOp::And, others),
            (Kind::Stuck, BinaryOp::Or, one),
            (Kind::Inverted, BinaryOp::Xor, one),
        ] {
            found.push((kind, masked(expr, op, value)));
        }
    }
    found.retain(|(_, changed)| changed != expr);
    found
}

fn masked(expr: &Expr, op: BinaryOp, value: u128) -> Expr {
    let width_bits = expr.width_bits;
    if let ExprKind::Constant(constant) = expr.kind {
        return Expr::constant(crate::elaborate::binary(op, constant, value), width_bits);
    }
    let kind = match (op, width_bits) {
        (BinaryOp::And, 1) => ExprKind::Constant(0),
        (BinaryOp::Or, 1) => ExprKind::Constant(1),
        (_, 1) => ExprKind::Unary(UnaryOp::Not, Box::new(expr.clone())),
        _ => {
            let value = Expr::constant(value, width_bits);
            ExprKind::Binary(op, Box::new(expr.clone()), Box::new(value))
        }
    };
    Expr { width_bits, kind }
}
