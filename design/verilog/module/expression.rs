//! Expressions as Verilog text.

use super::ModulePrinter;
use crate::elaborate::{mask, BinaryOp, Expr, ExprKind, NetId, UnaryOp};
use crate::printing::{is_count, is_quantity, is_row, parts, Part, SMALL_MASK_MAX};

/// The value of something that has a name: quantities in decimal, what may be flags or several fields in hexadecimal.
pub(in crate::verilog) fn named_literal(name: &str, value: u128, width_bits: usize) -> String {
    match is_quantity(name, value) {
        true => format!(
            "{width_bits}'{}{value}",
            if width_bits == 1 { 'b' } else { 'd' }
        ),
        false => bits(value, width_bits),
    }
}

/// A sized literal: times and counts, which are below a million or round, in decimal, the others in hexadecimal.
pub(in crate::verilog) fn literal(value: u128, width_bits: usize) -> String {
    match width_bits {
        1 => format!("1'b{value}"),
        _ if is_count(value) => format!("{width_bits}'d{value}"),
        _ => bits(value, width_bits),
    }
}

/// A sized literal in which each bit has a separate meaning.
pub(in crate::verilog) fn bits(value: u128, width_bits: usize) -> String {
    format!("{width_bits}'h{value:x}")
}

/// A net that the printer adds because Verilog cannot take bits of an expression.
pub(in crate::verilog) struct Helper {
    pub name: String,
    pub width_bits: usize,
    pub value: Expr,
    /// Printed value.
    pub text: String,
    /// Bits that are read.
    pub read_bits: u128,
}

/// Collects the helper nets of one statement, in the order in which they must be assigned.
#[derive(Default)]
pub(in crate::verilog) struct Helpers {
    pub nets: Vec<Helper>,
}

impl ModulePrinter<'_> {
    /// The text of an expression; `for_net` names helper nets.
    pub fn expression(&mut self, expr: &Expr, for_net: &str, helpers: &mut Helpers) -> String {
        if let Some(parts) = parts(expr) {
            return self.side_by_side(parts, for_net, helpers);
        }
        match &expr.kind {
            ExprKind::Constant(value) => literal(*value, expr.width_bits),
            ExprKind::Variant(enum_id, variant) => self.scope.state(*enum_id, *variant),
            ExprKind::Parameter(index) => self.module.parameters[*index].name.clone(),
            ExprKind::Net(net) => self.module.nets[*net].name.clone(),
            ExprKind::Extend(inner) => {
                let padding = literal(0, expr.width_bits - inner.width_bits);
                let inner = self.expression(inner, for_net, helpers);
                format!("{{{padding}, {inner}}}")
            }
            ExprKind::Slice(inner, low_bit) => {
                self.slice(inner, *low_bit, expr.width_bits, for_net, helpers)
            }
            ExprKind::Select(inner, index) => {
                self.select(inner, index, expr.width_bits, for_net, helpers)
            }
            ExprKind::Unary(op, inner) => {
                let is_flag = inner.width_bits == 1;
                let is_bare = is_row(inner)
                    || !matches!(inner.kind, ExprKind::Unary(..) | ExprKind::Binary(..));
                let inner = self.operand(inner, is_bare, for_net, helpers);
                let sign = match op {
                    UnaryOp::Not if is_flag => "!",
                    UnaryOp::Not => "~",
                    UnaryOp::All => "&",
                    UnaryOp::Any => "|",
                    UnaryOp::Xor => "^",
                };
                format!("{sign}{inner}")
            }
            ExprKind::Binary(op, left, right) => {
                let is_bare = |e: &Expr, is_left: bool| match e.kind {
                    _ if is_row(e) => true,
                    ExprKind::Binary(inner, ..) => is_left && inner == *op && is_chain(inner),
                    ExprKind::Unary(inner, _) => inner == UnaryOp::Not,
                    _ => true,
                };
                if let (BinaryOp::And | BinaryOp::Or | BinaryOp::Xor, ExprKind::Constant(value)) =
                    (op, &right.kind)
                {
                    if *value > SMALL_MASK_MAX {
                        let left = self.operand(left, is_bare(left, true), for_net, helpers);
                        let mask = bits(*value, right.width_bits);
                        return format!("{left} {} {mask}", sign(*op));
                    }
                }
                let left = self.operand(left, is_bare(left, true), for_net, helpers);
                let right = self.operand(right, is_bare(right, false), for_net, helpers);
                format!("{left} {} {right}", sign(*op))
            }
        }
    }

    /// Parts side by side: a concatenation.
    fn side_by_side(&mut self, parts: Vec<Part>, for_net: &str, helpers: &mut Helpers) -> String {
        let text = |part| match part {
            Part::Known(value, places) if value <= SMALL_MASK_MAX => literal(value, places),
            Part::Known(value, places) => bits(value, places),
            Part::Value(expr) => self.expression(&expr, for_net, helpers),
        };
        let mut texts: Vec<String> = parts.into_iter().map(text).collect();
        texts.reverse();
        match &texts[..] {
            [text] if !text.contains(' ') => text.clone(),
            _ => format!("{{{}}}", texts.join(", ")),
        }
    }

    /// An operand, in parentheses unless it binds tighter for everyone to see.
    fn operand(
        &mut self,
        expr: &Expr,
        is_bare: bool,
        for_net: &str,
        helpers: &mut Helpers,
    ) -> String {
        let text = self.expression(expr, for_net, helpers);
        match is_bare {
            true => text,
            false => format!("({text})"),
        }
    }

    fn slice(
        &mut self,
        inner: &Expr,
        low_bit: usize,
        width_bits: usize,
        for_net: &str,
        helpers: &mut Helpers,
    ) -> String {
        if let Some(value) = self.scope.named_value(inner) {
            return literal((value >> low_bit) & mask(width_bits), width_bits);
        }
        let bits = mask(width_bits) << low_bit;
        let name = match inner.kind {
            ExprKind::Net(net) => self.module.nets[net].name.clone(),
            _ => self.helper(
                inner.clone(),
                format!("{for_net}_full"),
                bits,
                for_net,
                helpers,
            ),
        };
        range(&name, low_bit, width_bits, inner.width_bits)
    }

    /// Bits from a variable position: of a net that is long enough for every position, so that nothing is undefined.
    fn select(
        &mut self,
        inner: &Expr,
        index: &Expr,
        width_bits: usize,
        for_net: &str,
        helpers: &mut Helpers,
    ) -> String {
        let positions = 1usize
            .checked_shl(index.width_bits as u32)
            .unwrap_or(usize::MAX);
        let needed_bits = positions.saturating_add(width_bits - 1);
        let (name, net_bits) = match inner.kind {
            ExprKind::Net(net) if needed_bits <= inner.width_bits => {
                (self.module.nets[net].name.clone(), inner.width_bits)
            }
            _ if needed_bits <= 1024 => {
                let base = match inner.kind {
                    ExprKind::Net(net) => format!("{}_padded", self.module.nets[net].name),
                    _ => format!("{for_net}_full"),
                };
                let value = match needed_bits > inner.width_bits {
                    true => Expr {
                        width_bits: needed_bits,
                        kind: ExprKind::Extend(Box::new(inner.clone())),
                    },
                    false => inner.clone(),
                };
                let net_bits = value.width_bits;
                (
                    self.helper(value, base, u128::MAX, for_net, helpers),
                    net_bits,
                )
            }
            _ => {
                let shifted = Expr {
                    width_bits: inner.width_bits,
                    kind: ExprKind::Binary(
                        BinaryOp::Shr,
                        Box::new(inner.clone()),
                        Box::new(index.clone()),
                    ),
                };
                let shifted = match width_bits > inner.width_bits {
                    true => Expr {
                        width_bits,
                        kind: ExprKind::Extend(Box::new(shifted)),
                    },
                    false => shifted,
                };
                return match shifted.width_bits == width_bits {
                    true => format!("({})", self.expression(&shifted, for_net, helpers)),
                    false => self.slice(&shifted, 0, width_bits, for_net, helpers),
                };
            }
        };
        // As many bits as count the bits of the net: linters take less for a mistake.
        let index_bits = usize::BITS as usize - (net_bits - 1).leading_zeros() as usize;
        let index = match index_bits > index.width_bits {
            true => Expr {
                width_bits: index_bits,
                kind: ExprKind::Extend(Box::new(index.clone())),
            },
            false => index.clone(),
        };
        let index = self.expression(&index, for_net, helpers);
        match width_bits {
            1 => format!("{name}[{index}]"),
            _ => format!("{name}[{index} +: {width_bits}]"),
        }
    }

    /// The name of a helper net with this value.
    fn helper(
        &mut self,
        value: Expr,
        base: String,
        read_bits: u128,
        for_net: &str,
        helpers: &mut Helpers,
    ) -> String {
        let known = self
            .continuous
            .iter_mut()
            .chain(helpers.nets.iter_mut())
            .find(|h| h.value == value);
        if let Some(known) = known {
            known.read_bits |= read_bits;
            return known.name.clone();
        }
        let text = self.expression(&value, for_net, helpers);
        let name = self.scope.unique(&base);
        let mut nets: Vec<NetId> = vec![];
        value.for_each_net(&mut |net| nets.push(net));
        let is_continuous = nets.iter().all(|net| !self.process_targets.contains(net));
        let width_bits = value.width_bits;
        let helper = Helper {
            name: name.clone(),
            width_bits,
            value,
            text,
            read_bits,
        };
        match is_continuous {
            true => self.continuous.push(helper),
            false => helpers.nets.push(helper),
        }
        name
    }
}

/// A constant range of a net.
pub(in crate::verilog) fn range(
    name: &str,
    low_bit: usize,
    width_bits: usize,
    net_width_bits: usize,
) -> String {
    match width_bits {
        _ if width_bits == net_width_bits => name.into(),
        1 => format!("{name}[{low_bit}]"),
        _ => format!("{name}[{}:{low_bit}]", low_bit + width_bits - 1),
    }
}

/// Operators that read well in a row.
fn is_chain(op: BinaryOp) -> bool {
    matches!(
        op,
        BinaryOp::And | BinaryOp::Or | BinaryOp::Xor | BinaryOp::Add
    )
}

fn sign(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Add => "+",
        BinaryOp::Sub => "-",
        BinaryOp::Mul => "*",
        BinaryOp::And => "&",
        BinaryOp::Or => "|",
        BinaryOp::Xor => "^",
        BinaryOp::Shl => "<<",
        BinaryOp::Shr => ">>",
        BinaryOp::Eq => "==",
        BinaryOp::Ne => "!=",
        BinaryOp::Lt => "<",
        BinaryOp::Le => "<=",
        BinaryOp::Gt => ">",
        BinaryOp::Ge => ">=",
    }
}
