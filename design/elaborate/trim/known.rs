//! Static knowledge of values: bits that are equal in every cycle.

use super::super::design::{mask, BinaryOp, Expr, ExprKind, Module, NetId, Statement, UnaryOp};
use super::super::execute::binary;

/// Bits of a value that never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Known {
    /// Which are known.
    known: u128,
    /// Those that are; the others are 0 here.
    value: u128,
}

impl Known {
    pub const UNKNOWN: Self = Self { known: 0, value: 0 };

    /// A value all of whose bits are known.
    pub const fn of(value: u128) -> Self {
        Self {
            known: u128::MAX,
            value,
        }
    }

    /// The value, if all of its bits are known.
    pub fn whole(self, width_bits: usize) -> Option<u128> {
        let bits = mask(width_bits);
        (self.known & bits == bits).then_some(self.value & bits)
    }

    /// Knowledge valid for both.
    fn or_else(self, other: Self) -> Self {
        let known = self.known & other.known & !(self.value ^ other.value);
        Self {
            known,
            value: self.value & known,
        }
    }

    /// Smallest and largest value.
    fn range(self, width_bits: usize) -> (u128, u128) {
        let bits = mask(width_bits);
        (self.value & bits, (self.value | !self.known) & bits)
    }

    /// These bits in the place of those from `low_bit` upwards.
    fn put(self, part: Self, low_bit: usize, width_bits: usize) -> Self {
        let bits = mask(width_bits) << low_bit;
        Self {
            known: self.known & !bits | (part.known << low_bit) & bits,
            value: self.value & !bits | (part.value << low_bit) & bits,
        }
    }

    const fn flag(known: Option<bool>) -> Self {
        match known {
            Some(value) => Self::of(value as u128),
            None => Self::UNKNOWN,
        }
    }
}

/// Knowledge of the nets of a module; `None` = not computed yet.
pub(super) type Values = Vec<Option<Known>>;

/// Knowledge valid for both.
pub(super) fn either(one: Option<Known>, other: Option<Known>) -> Option<Known> {
    match (one, other) {
        (Some(one), Some(other)) => Some(one.or_else(other)),
        (one, other) => one.or(other),
    }
}

/// Knowledge of an expression; `None` while it reads a net without a computed value.
pub(super) fn known(module: &Module, expr: &Expr, values: &Values) -> Option<Known> {
    let of = |expr: &Expr| known(module, expr, values);
    let bits = match &expr.kind {
        ExprKind::Constant(value) => Known::of(*value),
        ExprKind::Variant(_, index) => Known::of(*index as u128),
        ExprKind::Parameter(index) => Known::of(module.parameters[*index].value),
        ExprKind::Net(net) => values[*net]?,
        ExprKind::Extend(inner) => Known::of(0).put(of(inner)?, 0, inner.width_bits),
        ExprKind::Slice(inner, low_bit) => shifted_right(of(inner)?, inner.width_bits, *low_bit),
        ExprKind::Select(inner, index) => {
            let (whole, index) = (of(inner)?, of(index)?.whole(index.width_bits));
            match index.map(usize::try_from) {
                Some(Ok(place)) => shifted_right(whole, inner.width_bits, place),
                _ if whole.whole(inner.width_bits) == Some(0) => Known::of(0),
                _ => Known::UNKNOWN,
            }
        }
        ExprKind::Unary(op, inner) => unary(*op, of(inner)?, inner.width_bits),
        ExprKind::Binary(op, left, right) => {
            let widths = [left.width_bits, right.width_bits];
            two(*op, [of(left)?, of(right)?], widths)
        }
    };
    let own = mask(expr.width_bits);
    Some(Known {
        known: bits.known | !own,
        value: bits.value & bits.known & own,
    })
}

fn shifted_right(bits: Known, width_bits: usize, places: usize) -> Known {
    let above = !mask(width_bits);
    let known = bits.known | above;
    let value = bits.value & !above;
    let places = places as u32;
    Known {
        known: !(!known).checked_shr(places).unwrap_or(0),
        value: value.checked_shr(places).unwrap_or(0),
    }
}

fn unary(op: UnaryOp, bits: Known, width_bits: usize) -> Known {
    let all = mask(width_bits);
    let (low, high) = bits.range(width_bits);
    match op {
        UnaryOp::Not => Known {
            known: bits.known,
            value: !bits.value & bits.known,
        },
        UnaryOp::All if low == all => Known::of(1),
        UnaryOp::All if high != all => Known::of(0),
        UnaryOp::Any if low != 0 => Known::of(1),
        UnaryOp::Any if high == 0 => Known::of(0),
        UnaryOp::Xor => Known::flag(bits.whole(width_bits).map(|v| v.count_ones() % 2 == 1)),
        UnaryOp::All | UnaryOp::Any => Known::UNKNOWN,
    }
}

fn two(op: BinaryOp, [a, b]: [Known; 2], [width_bits, other_bits]: [usize; 2]) -> Known {
    let (ones_a, ones_b) = (a.value & a.known, b.value & b.known);
    let (zeros_a, zeros_b) = (!a.value & a.known, !b.value & b.known);
    let ((low_a, high_a), (low_b, high_b)) = (a.range(width_bits), b.range(other_bits));
    let differ = a.known & b.known & (a.value ^ b.value) & mask(width_bits) != 0;
    // True, false, or open: what a comparison gives for each pair of ends.
    let compared = |always: bool, never: bool| match (always, never) {
        (true, _) => Known::of(1),
        (_, true) => Known::of(0),
        _ => Known::UNKNOWN,
    };
    let is_same = low_a == high_a && low_b == high_b && low_a == low_b;
    match op {
        BinaryOp::And => Known {
            known: zeros_a | zeros_b | a.known & b.known,
            value: ones_a & ones_b,
        },
        BinaryOp::Or => Known {
            known: ones_a | ones_b | a.known & b.known,
            value: ones_a | ones_b,
        },
        BinaryOp::Xor => Known {
            known: a.known & b.known,
            value: (a.value ^ b.value) & a.known & b.known,
        },
        BinaryOp::Eq => compared(is_same, differ),
        BinaryOp::Ne => compared(differ, is_same),
        BinaryOp::Lt => compared(high_a < low_b, low_a >= high_b),
        BinaryOp::Le => compared(high_a <= low_b, low_a > high_b),
        BinaryOp::Gt => compared(low_a > high_b, high_a <= low_b),
        BinaryOp::Ge => compared(low_a >= high_b, high_a < low_b),
        BinaryOp::Shr if low_b == high_b => match usize::try_from(low_b) {
            Ok(places) => shifted_right(a, width_bits, places),
            Err(_) => Known::of(0),
        },
        BinaryOp::Shl if low_b == high_b => match u32::try_from(low_b).ok().filter(|n| *n < 128) {
            Some(places) => Known {
                known: a.known << places | mask(places as usize),
                value: a.value << places,
            },
            None => Known::of(0),
        },
        _ if low_a == high_a && low_b == high_b => Known::of(binary(op, low_a, low_b)),
        _ => Known::UNKNOWN,
    }
}

/// Content of `net` after `bits` have been written to it from `low_bit` upwards.
pub(super) fn assign(
    values: &mut Values,
    net: NetId,
    low_bit: usize,
    part: Option<Known>,
    width_bits: usize,
) {
    values[net] = part.map(|part| {
        values[net]
            .unwrap_or(Known::UNKNOWN)
            .put(part, low_bit, width_bits)
    });
}

/// Which blocks of a statement may be taken, in the order of [`Statement::blocks`]; none as long as nothing has come to its condition.
pub(super) fn ways(module: &Module, statement: &Statement, values: &Values) -> Option<Vec<bool>> {
    match statement {
        Statement::Assign { .. } => None,
        Statement::If { condition, .. } => {
            let value = known(module, condition, values)?.whole(1);
            Some(vec![value != Some(0), value != Some(1)])
        }
        Statement::Case { subject, arms, .. } => {
            let seen = known(module, subject, values)?;
            let width_bits = subject.width_bits;
            let mut is_open = true;
            let mut ways = vec![];
            for (value, _) in arms {
                let value = known(module, value, values).unwrap_or(Known::UNKNOWN);
                let widths = [width_bits; 2];
                let is_equal = two(BinaryOp::Eq, [seen, value], widths).whole(1);
                ways.push(is_open && is_equal != Some(0));
                is_open &= is_equal != Some(1);
            }
            ways.push(is_open);
            Some(ways)
        }
    }
}

/// Runs statements on what is known.
pub(super) fn run(module: &Module, statements: &[Statement], values: &mut Values) {
    for statement in statements {
        if let Statement::Assign {
            net,
            low_bit,
            value,
            ..
        } = statement
        {
            let part = known(module, value, values);
            assign(values, *net, *low_bit, part, value.width_bits);
            continue;
        }
        let ways = ways(module, statement, values).unwrap_or_default();
        let blocks = statement.blocks().into_iter();
        let taken = blocks.zip(ways).filter(|(_, is_possible)| *is_possible);
        let after = taken.map(|(block, _)| {
            let mut after = values.clone();
            run(module, block, &mut after);
            after
        });
        let after: Vec<Values> = after.collect();
        meet(statement, &after, values);
    }
}

/// Values of a statement's targets after it, from their values after each possible block; without a possible block there are none.
pub(super) fn meet(statement: &Statement, after: &[Values], values: &mut Values) {
    statement.for_each_target(&mut |net, _, _| {
        let ends = after.iter().map(|values| values[net]);
        values[net] = ends.fold(None, either);
    });
}
