//! The meaning of statements and expressions, stated once as plainly as possible.

use super::design::{mask, BinaryOp, Expr, ExprKind, NetId, Statement, UnaryOp};
use std::collections::BTreeMap;

/// Executes statements on `values`; nets that are not there are 0.
pub fn execute(statements: &[Statement], parameters: &[u128], values: &mut BTreeMap<NetId, u128>) {
    for statement in statements {
        match statement {
            Statement::Assign {
                net,
                low_bit,
                value,
                ..
            } => {
                let bits = mask(value.width_bits) << low_bit;
                let value = evaluate(value, parameters, values) << low_bit;
                let target = values.entry(*net).or_default();
                *target = (*target & !bits) | value;
            }
            Statement::If {
                condition,
                then,
                otherwise,
                ..
            } => match evaluate(condition, parameters, values) {
                0 => execute(otherwise, parameters, values),
                _ => execute(then, parameters, values),
            },
            Statement::Case {
                subject,
                arms,
                default,
                ..
            } => {
                let subject = evaluate(subject, parameters, values);
                let arm = arms
                    .iter()
                    .find(|(value, _)| evaluate(value, parameters, values) == subject);
                let block = arm.map_or(default, |(_, block)| block);
                execute(block, parameters, values);
            }
        }
    }
}

/// The value of an expression.
pub fn evaluate(expr: &Expr, parameters: &[u128], values: &BTreeMap<NetId, u128>) -> u128 {
    let value = |e: &Expr| evaluate(e, parameters, values);
    let result = match &expr.kind {
        ExprKind::Constant(value) => *value,
        ExprKind::Variant(_, index) => *index as u128,
        ExprKind::Parameter(index) => parameters[*index],
        ExprKind::Net(net) => values.get(net).copied().unwrap_or(0),
        ExprKind::Extend(inner) => value(inner),
        ExprKind::Slice(inner, low_bit) => value(inner) >> low_bit,
        ExprKind::Select(inner, index) => binary(BinaryOp::Shr, value(inner), value(index)),
        ExprKind::Unary(UnaryOp::Not, inner) => !value(inner),
        ExprKind::Unary(UnaryOp::All, inner) => (value(inner) == mask(inner.width_bits)).into(),
        ExprKind::Unary(UnaryOp::Any, inner) => (value(inner) != 0).into(),
        ExprKind::Unary(UnaryOp::Xor, inner) => (value(inner).count_ones() & 1).into(),
        ExprKind::Binary(op, left, right) => binary(*op, value(left), value(right)),
    };
    result & mask(expr.width_bits)
}

/// An operator on numbers, before the result is cut to its width.
pub fn binary(op: BinaryOp, a: u128, b: u128) -> u128 {
    let amount = u32::try_from(b).ok();
    match op {
        BinaryOp::Add => a.wrapping_add(b),
        BinaryOp::Sub => a.wrapping_sub(b),
        BinaryOp::Mul => a.wrapping_mul(b),
        BinaryOp::And => a & b,
        BinaryOp::Or => a | b,
        BinaryOp::Xor => a ^ b,
        BinaryOp::Shl => amount.and_then(|n| a.checked_shl(n)).unwrap_or(0),
        BinaryOp::Shr => amount.and_then(|n| a.checked_shr(n)).unwrap_or(0),
        BinaryOp::Eq => (a == b).into(),
        BinaryOp::Ne => (a != b).into(),
        BinaryOp::Lt => (a < b).into(),
        BinaryOp::Le => (a <= b).into(),
        BinaryOp::Gt => (a > b).into(),
        BinaryOp::Ge => (a >= b).into(),
    }
}
