//! An expression as pieces side by side: what shifts and masks by constants put together.

use super::design::{mask, BinaryOp, Expr, ExprKind, NetId};

/// Some bits of a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    /// Index of its lowest bit.
    pub low_bit: usize,
    /// Content.
    pub expr: Expr,
}

impl Piece {
    /// The bit above it.
    pub fn end(&self) -> usize {
        self.low_bit + self.expr.width_bits
    }

    /// Its bits from `low_bit` of the value up to `end`; none if Verilog cannot take bits of it.
    fn cut(&self, low_bit: usize, end: usize) -> Option<Self> {
        let (low_bit, end) = (low_bit.max(self.low_bit), end.min(self.end()));
        let from = low_bit - self.low_bit;
        let width_bits = end - low_bit;
        if width_bits == self.expr.width_bits {
            return Some(self.clone());
        }
        let kind = match &self.expr.kind {
            ExprKind::Net(_) => ExprKind::Slice(Box::new(self.expr.clone()), from),
            ExprKind::Slice(net, low) if matches!(net.kind, ExprKind::Net(_)) => {
                ExprKind::Slice(net.clone(), low + from)
            }
            ExprKind::Constant(value) => ExprKind::Constant(value >> from & mask(width_bits)),
            _ => return None,
        };
        let expr = Expr { width_bits, kind };
        Some(Self { low_bit, expr })
    }

    /// Whether it is these very bits of the net.
    fn is_of(&self, net: NetId) -> bool {
        match &self.expr.kind {
            ExprKind::Net(own) => *own == net && self.low_bit == 0,
            ExprKind::Slice(inner, low) => inner.kind == ExprKind::Net(net) && *low == self.low_bit,
            _ => false,
        }
    }
}

/// A mask with more runs of ones than this reads better as a mask.
const RUNS_MAX: usize = 2;

/// The runs of ones in a number: first bit, and end (exclusive).
fn runs(bits: u128) -> Vec<(usize, usize)> {
    let is_one = |place: usize| place < 128 && bits >> place & 1 == 1;
    let starts = (0..128).filter(|place| is_one(*place) && (*place == 0 || !is_one(place - 1)));
    let run = |start: usize| {
        (
            start,
            (start..).find(|place| !is_one(*place)).unwrap_or(128),
        )
    };
    starts.map(run).collect()
}

/// Concatenated parts of an expression, lowest first; bits without a piece are 0. `None` if it is not a concatenation.
pub(crate) fn row(expr: &Expr) -> Option<Vec<Piece>> {
    if !matches!(
        expr.kind,
        ExprKind::Extend(_) | ExprKind::Slice(..) | ExprKind::Binary(..)
    ) {
        return None;
    }
    let row = pieces(expr);
    let is_one = matches!(&row[..], [piece] if piece.expr == *expr);
    (!is_one).then_some(row)
}

/// The pieces of an expression, lowest first; other bits are 0. An expression that is not a concatenation is one piece.
fn pieces(expr: &Expr) -> Vec<Piece> {
    let mut row = apart(expr).unwrap_or_else(|| {
        vec![Piece {
            low_bit: 0,
            expr: expr.clone(),
        }]
    });
    row.sort_by_key(|piece| piece.low_bit);
    row
}

fn apart(expr: &Expr) -> Option<Vec<Piece>> {
    let constant = |side: &Expr| match side.kind {
        ExprKind::Constant(value) => Some(value),
        _ => None,
    };
    match &expr.kind {
        ExprKind::Constant(value) => {
            let ones = |(low_bit, end): (usize, usize)| Piece {
                low_bit,
                expr: Expr::constant(u128::MAX, end - low_bit),
            };
            Some(runs(*value).into_iter().map(ones).collect())
        }
        ExprKind::Extend(inner) => Some(pieces(inner)),
        ExprKind::Slice(inner, low_bit) if !matches!(inner.kind, ExprKind::Net(_)) => {
            cut_out(&pieces(inner), *low_bit, low_bit + expr.width_bits)
        }
        ExprKind::Binary(BinaryOp::Or, left, right) => {
            let mut row = [pieces(left), pieces(right)].concat();
            row.sort_by_key(|piece| piece.low_bit);
            let is_apart = row.windows(2).all(|pair| pair[0].end() <= pair[1].low_bit);
            is_apart.then_some(row)
        }
        ExprKind::Binary(BinaryOp::Shl, inner, places) => {
            let places = usize::try_from(constant(places)?).ok()?;
            let below = expr.width_bits.saturating_sub(places);
            let mut moved = cut_out(&pieces(inner), 0, below)?;
            for piece in &mut moved {
                piece.low_bit += places;
            }
            Some(moved)
        }
        ExprKind::Binary(BinaryOp::Shr, inner, places) => {
            let places = usize::try_from(constant(places)?).ok()?;
            cut_out(&pieces(inner), places, usize::MAX)
        }
        ExprKind::Binary(BinaryOp::And, left, right) => {
            let (inner, bits) = match (constant(left), constant(right)) {
                (_, Some(bits)) => (left, bits),
                (Some(bits), _) => (right, bits),
                _ => return None,
            };
            let runs = runs(bits);
            if runs.len() > RUNS_MAX {
                return None;
            }
            let (whole, mut row) = (pieces(inner), vec![]);
            for (low_bit, end) in runs {
                for mut piece in cut_out(&whole, low_bit, end)? {
                    piece.low_bit += low_bit;
                    row.push(piece);
                }
            }
            Some(row)
        }
        _ => None,
    }
}

/// The bits of a row from `low_bit` up to `end`, the lowest of them at 0.
fn cut_out(row: &[Piece], low_bit: usize, end: usize) -> Option<Vec<Piece>> {
    let inside = row.iter();
    let inside = inside.filter(|piece| piece.low_bit < end && piece.end() > low_bit);
    let moved = inside.map(|piece| {
        let mut piece = piece.cut(low_bit, end)?;
        piece.low_bit -= low_bit;
        Some(piece)
    });
    moved.collect()
}

/// If an assignment to a whole net changes one range of its bits only: where that begins, and what it becomes.
pub(super) fn replaced(net: NetId, value: &Expr) -> Option<(usize, Expr)> {
    let row = pieces(value);
    let kept: u128 = row
        .iter()
        .filter(|piece| piece.is_of(net))
        .map(bits_of)
        .sum();
    let changed = runs(mask(value.width_bits) & !kept);
    let [(low_bit, end)] = changed[..] else {
        return None;
    };
    let mut new = row.into_iter().filter(|piece| !piece.is_of(net));
    let (new, None) = (new.next(), new.next()) else {
        return None;
    };
    let is_whole = low_bit == 0 && end == value.width_bits;
    let expr = match new {
        None => Expr::constant(0, end - low_bit),
        Some(piece) if piece.low_bit == low_bit && piece.end() == end => piece.expr,
        Some(_) => return None,
    };
    (!is_whole).then_some((low_bit, expr))
}

fn bits_of(piece: &Piece) -> u128 {
    mask(piece.expr.width_bits) << piece.low_bit
}

#[cfg(test)]
mod tests {
    use super::*;

    fn net(id: NetId, width_bits: usize) -> Expr {
        Expr {
            width_bits,
            kind: ExprKind::Net(id),
        }
    }

    fn of(op: BinaryOp, left: Expr, right: Expr) -> Expr {
        Expr {
            width_bits: left.width_bits,
            kind: ExprKind::Binary(op, Box::new(left), Box::new(right)),
        }
    }

    fn bit(of: Expr) -> Expr {
        Expr {
            width_bits: 8,
            kind: ExprKind::Extend(Box::new(of)),
        }
    }

    fn slice(of: Expr, low: usize, width_bits: usize) -> Expr {
        Expr {
            width_bits,
            kind: ExprKind::Slice(Box::new(of), low),
        }
    }

    #[test]
    fn a_shifted_in_bit_stands_beside_the_others() {
        let shifted = of(BinaryOp::Shl, net(0, 8), Expr::constant(1, 4));
        let row = pieces(&of(BinaryOp::Or, shifted, bit(net(1, 1))));
        let places: Vec<_> = row.iter().map(|p| (p.low_bit, p.expr.clone())).collect();
        assert_eq!(places, [(0, net(1, 1)), (1, slice(net(0, 8), 0, 7))]);
    }

    /// Catches pieces that overlap: an OR of them is no row.
    #[test]
    fn what_overlaps_is_one_piece() {
        let both = of(BinaryOp::Or, net(0, 8), bit(net(1, 1)));
        let row = pieces(&both);
        assert_eq!(row.len(), 1);
        assert_eq!(row[0].expr, both);
    }

    /// Bits of what was put together are bits of its pieces; of a sum none can be taken.
    #[test]
    fn bits_of_a_row_are_bits_of_its_pieces() {
        let byte = of(
            BinaryOp::Or,
            of(BinaryOp::Shl, net(0, 8), Expr::constant(4, 3)),
            bit(net(1, 1)),
        );
        let found = row(&slice(byte, 3, 3)).unwrap();
        let places: Vec<_> = found.iter().map(|p| (p.low_bit, p.expr.clone())).collect();
        assert_eq!(places, [(1, slice(net(0, 8), 0, 2))]);
        let sum = of(BinaryOp::Add, net(0, 8), net(2, 8));
        assert_eq!(row(&slice(sum, 3, 3)), None);
        assert_eq!(row(&net(0, 8)), None);
    }

    #[test]
    fn a_replaced_bit_is_an_assignment_to_it() {
        let others = of(BinaryOp::And, net(0, 8), Expr::constant(0xDF, 8));
        let new = of(BinaryOp::Shl, bit(net(1, 1)), Expr::constant(5, 3));
        let value = of(BinaryOp::Or, others.clone(), new);
        assert_eq!(replaced(0, &value), Some((5, net(1, 1))));
        assert_eq!(replaced(2, &value), None);
        assert_eq!(replaced(0, &others), Some((5, Expr::constant(0, 1))));
        let two = of(BinaryOp::And, net(0, 8), Expr::constant(0xDD, 8));
        assert_eq!(replaced(0, &two), None);
    }
}
