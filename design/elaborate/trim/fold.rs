//! Statements without the branches that are never taken, expressions without what is known.

use super::super::design::{
    hand_on, mask, BinaryOp, Expr, ExprKind, Module, NetId, Statement, UnaryOp,
};
use super::super::pieces::replaced;
use super::known::{assign, known, meet, ways, Known, Values};

/// Keeps the statements if this is known; then their targets are known after them.
pub(super) fn fold(
    module: &Module,
    statements: &[Statement],
    values: &mut Values,
) -> Vec<Statement> {
    let mut out = vec![];
    for statement in statements {
        one(module, statement, values, &mut out);
    }
    without_overwritten(module, out)
}

fn one(module: &Module, statement: &Statement, values: &mut Values, out: &mut Vec<Statement>) {
    if let Statement::Assign {
        net,
        low_bit,
        value,
        ..
    } = statement
    {
        let part = known(module, value, values);
        let short = shorter(module, value, values);
        let is_whole = value.width_bits == module.nets[*net].width_bits;
        let bits = replaced(*net, &short).filter(|_| is_whole);
        let (low_bit_now, value_now) = bits.unwrap_or((*low_bit, short));
        out.push(Statement::Assign {
            docs: statement.docs().to_vec(),
            net: *net,
            low_bit: low_bit_now,
            value: value_now,
        });
        assign(values, *net, *low_bit, part, value.width_bits);
        return;
    }
    let blocks = statement.blocks();
    let reached = ways(module, statement, values);
    let is_reached = reached.is_some();
    let ways = reached.unwrap_or_else(|| vec![true; blocks.len()]);
    let mut possible = ways
        .iter()
        .enumerate()
        .filter(|(_, is_possible)| **is_possible);
    if let (Some((only, _)), None) = (possible.next(), possible.next()) {
        let first = out.len();
        for inner in blocks[only] {
            one(module, inner, values, out);
        }
        hand_on(statement.docs(), &mut out[first..]);
        return;
    }
    let mut after = vec![];
    let mut folded_block = |block: &[Statement]| {
        let mut own = values.clone();
        let folded = fold(module, block, &mut own);
        if is_reached {
            after.push(own);
        }
        folded
    };
    let folded = blocks
        .iter()
        .zip(&ways)
        .map(|(block, is_possible)| is_possible.then(|| folded_block(block)));
    let folded: Vec<Option<Vec<Statement>>> = folded.collect();
    if folded.iter().flatten().any(|block| !block.is_empty()) {
        out.push(with_blocks(module, statement, values, folded));
    }
    meet(statement, &after, values);
}

/// The statement with other blocks; none = is never taken.
fn with_blocks(
    module: &Module,
    statement: &Statement,
    values: &Values,
    mut blocks: Vec<Option<Vec<Statement>>>,
) -> Statement {
    let last = blocks.pop().flatten().unwrap_or_default();
    match statement {
        Statement::Assign { .. } => statement.clone(),
        Statement::If { condition, .. } => {
            let condition = shorter(module, condition, values);
            let then = blocks.pop().flatten().unwrap_or_default();
            match then.is_empty() {
                true => Statement::If {
                    docs: statement.docs().to_vec(),
                    condition: not(condition),
                    then: last,
                    otherwise: then,
                },
                false => Statement::If {
                    docs: statement.docs().to_vec(),
                    condition,
                    then,
                    otherwise: last,
                },
            }
        }
        Statement::Case { subject, arms, .. } => {
            let arms = arms.iter().zip(blocks);
            let arms = arms.filter_map(|((value, _), block)| Some((value.clone(), block?)));
            Statement::Case {
                docs: statement.docs().to_vec(),
                subject: shorter(module, subject, values),
                arms: arms.collect(),
                default: last,
            }
        }
    }
}

fn not(condition: Expr) -> Expr {
    match condition.kind {
        ExprKind::Unary(UnaryOp::Not, inner) => *inner,
        _ => Expr {
            width_bits: 1,
            kind: ExprKind::Unary(UnaryOp::Not, Box::new(condition)),
        },
    }
}

/// Without assignments that a later one in the same row replaces before anybody reads them.
fn without_overwritten(module: &Module, statements: Vec<Statement>) -> Vec<Statement> {
    let whole = |statement: &Statement| match statement {
        Statement::Assign { net, value, .. }
            if value.width_bits == module.nets[*net].width_bits =>
        {
            Some(*net)
        }
        _ => None,
    };
    let reads = |statement: &Statement, net: NetId| {
        let mut is_read = false;
        statement.for_each_expr(&mut |expr| expr.for_each_net(&mut |read| is_read |= read == net));
        is_read
    };
    let is_lost = |at: usize| {
        let Some(net) = whole(&statements[at]) else {
            return false;
        };
        for later in &statements[at + 1..] {
            if reads(later, net) {
                return false;
            }
            if whole(later) == Some(net) {
                return true;
            }
        }
        false
    };
    let kept: Vec<bool> = (0..statements.len()).map(|at| !is_lost(at)).collect();
    let kept = statements.into_iter().zip(kept);
    kept.filter_map(|(statement, is_kept)| is_kept.then_some(statement))
        .collect()
}

/// The expression where this is known. Constants with a name keep it, but for flags.
pub(super) fn shorter(module: &Module, expr: &Expr, values: &Values) -> Expr {
    let of = |expr: &Expr| known(module, expr, values).unwrap_or(Known::UNKNOWN);
    let is_flag = expr.width_bits == 1 && !matches!(expr.kind, ExprKind::Variant(..));
    if let Some(value) = of(expr)
        .whole(expr.width_bits)
        .filter(|_| is_flag || reads_nets(expr))
    {
        let name = (!is_flag).then(|| named(module, expr, value)).flatten();
        return name.unwrap_or_else(|| Expr::constant(value, expr.width_bits));
    }
    let short = |expr: &Expr| Box::new(shorter(module, expr, values));
    let kind = match &expr.kind {
        ExprKind::Extend(inner) => ExprKind::Extend(short(inner)),
        ExprKind::Slice(inner, low_bit) => ExprKind::Slice(short(inner), *low_bit),
        ExprKind::Select(inner, index) => match of(index).whole(index.width_bits) {
            Some(place) if place as usize + expr.width_bits <= inner.width_bits => {
                ExprKind::Slice(short(inner), place as usize)
            }
            _ => ExprKind::Select(short(inner), short(index)),
        },
        ExprKind::Unary(op, inner) => ExprKind::Unary(*op, short(inner)),
        ExprKind::Binary(op, left, right) => {
            let whole = |side: &Expr| of(side).whole(side.width_bits);
            let (one, other) = (whole(left), whole(right));
            let ones = Some(mask(expr.width_bits));
            use BinaryOp::*;
            let same = match op {
                And if one == ones => Some(right),
                And if other == ones => Some(left),
                Or | Xor | Add if one == Some(0) => Some(right),
                Or | Xor | Add | Sub | Shl | Shr if other == Some(0) => Some(left),
                _ => None,
            };
            if let Some(side) = same {
                return shorter(module, side, values);
            }
            ExprKind::Binary(*op, short(left), short(right))
        }
        kind => kind.clone(),
    };
    Expr {
        width_bits: expr.width_bits,
        kind,
    }
}

/// The named constant that a net is, if it is assigned one of this value.
fn named(module: &Module, expr: &Expr, value: u128) -> Option<Expr> {
    let ExprKind::Net(own) = expr.kind else {
        return None;
    };
    let assigned = module.processes.iter().flat_map(|p| &p.statements);
    let mut assigned = assigned.filter_map(|statement| match statement {
        Statement::Assign { net, value, .. } if *net == own => Some(value),
        _ => None,
    });
    let is_it = |constant: &&Expr| match constant.kind {
        ExprKind::Parameter(index) => module.parameters[index].value == value,
        ExprKind::Variant(_, variant) => variant as u128 == value,
        _ => false,
    };
    let constant = assigned.find(is_it)?;
    (constant.width_bits == expr.width_bits).then(|| constant.clone())
}

fn reads_nets(expr: &Expr) -> bool {
    let mut is_read = false;
    expr.for_each_net(&mut |_| is_read = true);
    is_read
}
