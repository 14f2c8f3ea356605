//! Pieces side by side: a concatenation.

use crate::elaborate::{row, Expr, ExprKind, Piece};

/// A part of a concatenation.
pub(crate) enum Part {
    /// Bits that are known: their value, and how many.
    Known(u128, usize),
    /// The value of an expression.
    Value(Expr),
}

/// Whether an expression is printed as a concatenation.
pub(crate) fn is_row(expr: &Expr) -> bool {
    row(expr).is_some()
}

/// The parts of an expression that is a concatenation, the lowest first, zeros between its pieces among them.
pub(crate) fn parts(expr: &Expr) -> Option<Vec<Part>> {
    let (row, width_bits) = (row(expr)?, expr.width_bits);
    let mut parts = vec![];
    // Bits that are known, from where on, and their value.
    let (mut known_from, mut known) = (0, 0);
    let top = Piece {
        low_bit: width_bits,
        expr: Expr::constant(0, 0),
    };
    for piece in row.into_iter().chain([top]) {
        if let ExprKind::Constant(value) = piece.expr.kind {
            let places = (piece.low_bit - known_from) as u32;
            known |= value.checked_shl(places).unwrap_or(0);
            if piece.low_bit < width_bits {
                continue;
            }
        }
        if piece.low_bit > known_from {
            parts.push(Part::Known(known, piece.low_bit - known_from));
        }
        let end = piece.end();
        if piece.low_bit < width_bits {
            parts.push(Part::Value(piece.expr));
        }
        (known_from, known) = (end, 0);
    }
    Some(parts)
}
