//! What a block knows: values that it compares something with, and lengths of time. Inputs that never have them leave what they decide untried.

use super::stimulus::{Compared, Known};
use rtl_design::elaborate::{BinaryOp, Design, Expr, ExprKind, Module, Statement};
use std::collections::BTreeSet;
use std::ops::RangeInclusive;

/// Named constants that are taken for lengths of time, in cycles.
const BEATS: RangeInclusive<u64> = 2..=4096;

/// Of the modules of a design: literals that something is compared with, and named constants.
pub fn known(design: &Design) -> Known {
    let (mut compared, mut beats) = (BTreeSet::new(), BTreeSet::new());
    for module in &design.modules {
        // What counts from 0 up to a limit takes one cycle more.
        let lengths = module.parameters.iter().map(|p| p.value as u64);
        beats.extend(lengths.map(|length| length.saturating_add(1)));
        let mut note = |subject: &Expr, value: &Expr| {
            compared.extend(field(module, subject, value));
        };
        for process in &module.processes {
            for_each_comparison(&process.statements, &mut note);
        }
    }
    beats.retain(|cycles| BEATS.contains(cycles));
    Known {
        compared: compared.into_iter().collect(),
        beats: beats.into_iter().collect(),
    }
}

fn for_each_comparison(statements: &[Statement], note: &mut dyn FnMut(&Expr, &Expr)) {
    for statement in statements {
        match statement {
            Statement::Assign { value, .. } => in_expr(value, note),
            Statement::If {
                condition,
                then,
                otherwise,
                ..
            } => {
                in_expr(condition, note);
                for_each_comparison(then, note);
                for_each_comparison(otherwise, note);
            }
            Statement::Case {
                subject,
                arms,
                default,
                ..
            } => {
                in_expr(subject, note);
                for (value, inner) in arms {
                    note(subject, value);
                    for_each_comparison(inner, note);
                }
                for_each_comparison(default, note);
            }
        }
    }
}

fn in_expr(expr: &Expr, note: &mut dyn FnMut(&Expr, &Expr)) {
    use BinaryOp::{Eq, Ge, Gt, Le, Lt, Ne};
    if let ExprKind::Binary(Eq | Ne | Lt | Le | Gt | Ge, a, b) = &expr.kind {
        note(a, b);
        note(b, a);
    }
    for operand in expr.operands() {
        in_expr(operand, note);
    }
}

/// The field, of two bits or more, that is compared with a constant.
fn field(module: &Module, subject: &Expr, value: &Expr) -> Option<Compared> {
    let value = match value.kind {
        ExprKind::Constant(value) => value,
        ExprKind::Parameter(index) => module.parameters[index].value,
        _ => return None,
    };
    let low_bit = match subject.kind {
        ExprKind::Slice(_, low_bit) => low_bit,
        _ => 0,
    };
    let width_bits = subject.width_bits;
    (width_bits > 1).then_some(Compared {
        low_bit,
        width_bits,
        value,
    })
}
