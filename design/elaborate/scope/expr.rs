//! Expressions: rust-hdl's untyped tree becomes one in which every node has the width that the Rust simulation uses.

use super::{Scope, Symbol};
use crate::elaborate::design::{mask, BinaryOp, Expr, ExprKind, UnaryOp};
use crate::elaborate::tree::{literal_value, literal_width};
use crate::elaborate::ElaborateError;
use rust_hdl::ast::{VerilogExpression as Ast, VerilogOp, VerilogOpUnary};

type Result<T> = std::result::Result<T, ElaborateError>;

/// Kind of a kernel expression: a signal value, or a Rust integer that takes the width of its context.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Typed(Expr),
    Integer(u128),
}

impl Scope<'_> {
    /// The expression, `width_bits` wide.
    pub fn expr(&self, ast: &Ast, width_bits: usize, field: &str) -> Result<Expr> {
        let value = self.value(ast, field)?;
        let expr = self.coerce(value, width_bits, field)?;
        if expr.width_bits == width_bits {
            return Ok(expr);
        }
        Err(self.block.error(
            field,
            format!("takes {width_bits} bits but is given {}", expr.width_bits),
            "widen or narrow it with bit_cast",
        ))
    }

    fn coerce(&self, value: Value, width_bits: usize, field: &str) -> Result<Expr> {
        match value {
            Value::Typed(expr) => Ok(expr),
            Value::Integer(value) if value <= mask(width_bits) => {
                Ok(Expr::constant(value, width_bits))
            }
            Value::Integer(value) => Err(self.block.error(
                field,
                format!("literal = {value}: does not fit into {width_bits} bits"),
                format!("write a value up to {}", mask(width_bits)),
            )),
        }
    }

    pub(super) fn value(&self, ast: &Ast, field: &str) -> Result<Value> {
        match ast {
            Ast::Signal(path) => self.signal(path, field),
            Ast::Literal(literal) => {
                let value = literal_value(literal).ok_or_else(|| {
                    self.block
                        .error(field, "uses a negative literal", "write an unsigned one")
                })?;
                if literal_width(literal) == 1 {
                    return Ok(Value::Typed(Expr::constant(value, 1)));
                }
                Ok(Value::Integer(value))
            }
            Ast::Paren(inner) => self.value(inner, field),
            Ast::Cast(inner, width_bits) => {
                let inner = self.value(inner, field)?;
                Ok(Value::Typed(match inner {
                    Value::Typed(expr) => resize(expr, *width_bits),
                    integer => self.coerce(integer, *width_bits, field)?,
                }))
            }
            Ast::Signed(_) | Ast::Unsigned(_) => Err(self.block.error(
                field,
                "uses a signed value",
                "compute with Bits<N>; signed types are not supported",
            )),
            Ast::Binary(left, op, right) => self.binary(left, op, right, field),
            Ast::Unary(op, inner) => self.unary(op, inner, field),
            Ast::Index(inner, index) => self.select(inner, index, 1, field),
            Ast::Slice(inner, width_bits, offset) => self.select(inner, offset, *width_bits, field),
            Ast::IndexReplace(inner, index, bit) => self.replace_bit(inner, index, bit, field),
        }
    }

    fn signal(&self, path: &str, field: &str) -> Result<Value> {
        if let Some((_, value)) = self.loops.iter().rev().find(|(name, _)| name == path) {
            return Ok(Value::Integer(*value as u128));
        }
        if path.ends_with("::next") || path.ends_with("$next") {
            return Err(self.block.error(path, "reads .next", "read .val()"));
        }
        let key = self.key(path, field)?;
        match self.symbols.get(&key) {
            Some(Symbol::Net {
                net,
                is_readable: true,
                ..
            }) => Ok(Value::Typed(self.net_expr(*net))),
            Some(Symbol::Net { .. }) => Err(self.block.error(
                &key,
                "is an input of a child block and is read here",
                "compute the value in a Local and read that",
            )),
            Some(Symbol::Parameter(index)) => Ok(Value::Typed(Expr {
                width_bits: self.parameters[*index].width_bits,
                kind: ExprKind::Parameter(*index),
            })),
            None => self.variant(&key, field).map(Value::Typed),
        }
    }

    /// An enum variant, written `Type$Variant`, possibly with a module path before it.
    fn variant(&self, key: &str, field: &str) -> Result<Expr> {
        let mut parts = key.rsplit('$');
        let (variant, type_name) = (parts.next().unwrap_or(""), parts.next());
        let mut found = self.block_enums.iter().filter_map(|&id| {
            let enum_type = &self.enums[id];
            let index = enum_type.variants.iter().position(|v| v == variant)?;
            (type_name == Some(&enum_type.name)).then_some((id, index))
        });
        match (found.next(), found.next()) {
            (Some((id, index)), None) => Ok(Expr {
                width_bits: self.enums[id].width_bits,
                kind: ExprKind::Variant(id, index),
            }),
            (Some(_), Some(_)) => Err(self.block.error(
                field,
                format!("{key} is a variant of two enums of the same name"),
                "rename one of the enums",
            )),
            (None, _) => Err(self.block.error(
                field,
                format!("uses {key}, which is neither a signal nor a state of this block"),
                "use a Constant<..> field or a literal: rust-hdl does not evaluate Rust constants and plain fields",
            )),
        }
    }

    fn binary(&self, left: &Ast, op: &VerilogOp, right: &Ast, field: &str) -> Result<Value> {
        let (left, right) = (self.value(left, field)?, self.value(right, field)?);
        if let (Value::Integer(a), Value::Integer(b)) = (&left, &right) {
            return self.integer_binary(*a, op, *b, field);
        }
        if matches!(op, VerilogOp::Shl | VerilogOp::Shr) {
            // rust-hdl computes `1 << self.n.val()` with 64 bits; a shift amount has its own width.
            let left = self.coerce(left, 64, field)?;
            let right = match right {
                Value::Integer(amount) => Expr::constant(amount, bits_for(amount)),
                Value::Typed(expr) => expr,
            };
            let op = if matches!(op, VerilogOp::Shl) {
                BinaryOp::Shl
            } else {
                BinaryOp::Shr
            };
            return Ok(Value::Typed(shift(op, left, right)));
        }
        let width_bits = match (&left, &right) {
            (Value::Typed(expr), _) | (_, Value::Typed(expr)) => expr.width_bits,
            _ => 0,
        };
        let left = self.coerce(left, width_bits, field)?;
        let right = self.coerce(right, width_bits, field)?;
        if left.width_bits != right.width_bits {
            return Err(self.block.error(
                field,
                format!(
                    "has operands of {} and {} bits",
                    left.width_bits, right.width_bits
                ),
                "bring both to one width with bit_cast",
            ));
        }
        if matches!(op, VerilogOp::Mul) {
            if width_bits != 16 {
                return Err(self.block.error(
                    field,
                    format!("multiplies {width_bits} bits"),
                    "multiply Bits<16> with Bits<16>",
                ));
            }
            let (left, right) = (resize(left, 32), resize(right, 32));
            return Ok(Value::Typed(binary(BinaryOp::Mul, left, right)));
        }
        Ok(Value::Typed(binary(binary_op(op), left, right)))
    }

    /// Arithmetic between Rust integers, as in an index `i + 1`.
    fn integer_binary(&self, a: u128, op: &VerilogOp, b: u128, field: &str) -> Result<Value> {
        let comparison = match op {
            VerilogOp::Eq => Some(a == b),
            VerilogOp::Ne => Some(a != b),
            VerilogOp::Lt => Some(a < b),
            VerilogOp::Le => Some(a <= b),
            VerilogOp::Gt => Some(a > b),
            VerilogOp::Ge => Some(a >= b),
            _ => None,
        };
        if let Some(bit) = comparison {
            return Ok(Value::Typed(Expr::constant(bit.into(), 1)));
        }
        let shift =
            |f: fn(u128, u32) -> u128| u32::try_from(b).ok().filter(|b| *b < 64).map(|b| f(a, b));
        match op {
            VerilogOp::Add => a.checked_add(b),
            VerilogOp::Sub => a.checked_sub(b),
            VerilogOp::Mul => a.checked_mul(b),
            VerilogOp::BitAnd => Some(a & b),
            VerilogOp::BitOr => Some(a | b),
            VerilogOp::BitXor => Some(a ^ b),
            VerilogOp::Shl => shift(|a, b| a << b),
            VerilogOp::Shr => shift(|a, b| a >> b),
            _ => None,
        }
        .filter(|result| *result <= mask(64))
        .map(Value::Integer)
        .ok_or_else(|| {
            self.block.error(
                field,
                format!("computes {a} {op:?} {b}, which is no unsigned 64-bit integer"),
                "write the result as a literal",
            )
        })
    }

    fn unary(&self, op: &VerilogOpUnary, inner: &Ast, field: &str) -> Result<Value> {
        let Value::Typed(inner) = self.value(inner, field)? else {
            return Err(self.block.error(
                field,
                format!("applies {op:?} to a literal, whose width is unknown"),
                "give it a width with bits::<N>(..)",
            ));
        };
        let op = match op {
            VerilogOpUnary::Not => UnaryOp::Not,
            VerilogOpUnary::All => UnaryOp::All,
            VerilogOpUnary::Any => UnaryOp::Any,
            VerilogOpUnary::Xor => UnaryOp::Xor,
            VerilogOpUnary::Neg => {
                return Err(self.block.error(
                    field,
                    "negates a value",
                    "write bits::<N>(0) - x; signed types are not supported",
                ))
            }
        };
        Ok(Value::Typed(unary(op, inner)))
    }

    fn select(&self, inner: &Ast, index: &Ast, width_bits: usize, field: &str) -> Result<Value> {
        let Value::Typed(inner) = self.value(inner, field)? else {
            return Err(self.block.error(
                field,
                "takes bits of a literal, whose width is unknown",
                "give it a width with bits::<N>(..)",
            ));
        };
        match self.value(index, field)? {
            Value::Integer(low_bit) => {
                // rust-hdl allows a slice to reach above the end (zeros come in), but to begin there only if empty.
                let low_bit = usize::try_from(low_bit).unwrap_or(usize::MAX);
                if low_bit >= inner.width_bits {
                    return Err(self.block.error(
                        field,
                        format!(
                            "bit index = {low_bit}: the value has {} bits",
                            inner.width_bits
                        ),
                        "use an index below the width",
                    ));
                }
                let kept_bits = width_bits.min(inner.width_bits - low_bit);
                Ok(Value::Typed(resize(
                    slice(inner, low_bit, kept_bits),
                    width_bits,
                )))
            }
            Value::Typed(index) => Ok(Value::Typed(Expr {
                width_bits,
                kind: ExprKind::Select(Box::new(inner), Box::new(index)),
            })),
        }
    }

    /// `x & !(1 << index) | bit << index`
    fn replace_bit(&self, inner: &Ast, index: &Ast, bit: &Ast, field: &str) -> Result<Value> {
        let Value::Typed(inner) = self.value(inner, field)? else {
            return Err(self.block.error(
                field,
                "replaces a bit of a literal, whose width is unknown",
                "give it a width with bits::<N>(..)",
            ));
        };
        let width_bits = inner.width_bits;
        let index = match self.value(index, field)? {
            Value::Typed(index) => index,
            Value::Integer(index) if index < width_bits as u128 => {
                Expr::constant(index, bits_for(index))
            }
            Value::Integer(index) => {
                return Err(self.block.error(
                    field,
                    format!("bit index = {index}: the value has {width_bits} bits"),
                    "use an index below the width",
                ))
            }
        };
        let bit = self.expr(bit, 1, field)?;
        let one = shift(BinaryOp::Shl, Expr::constant(1, width_bits), index.clone());
        let kept = binary(BinaryOp::And, inner, unary(UnaryOp::Not, one));
        let set = shift(BinaryOp::Shl, resize(bit, width_bits), index);
        Ok(Value::Typed(binary(BinaryOp::Or, kept, set)))
    }
}

fn binary_op(op: &VerilogOp) -> BinaryOp {
    match op {
        VerilogOp::Add => BinaryOp::Add,
        VerilogOp::Sub => BinaryOp::Sub,
        VerilogOp::Mul => BinaryOp::Mul,
        // Operands of the lazy operators are single bits without side effects.
        VerilogOp::LogicalAnd | VerilogOp::BitAnd => BinaryOp::And,
        VerilogOp::LogicalOr | VerilogOp::BitOr => BinaryOp::Or,
        VerilogOp::BitXor => BinaryOp::Xor,
        VerilogOp::Shl => BinaryOp::Shl,
        VerilogOp::Shr => BinaryOp::Shr,
        VerilogOp::Eq => BinaryOp::Eq,
        VerilogOp::Ne => BinaryOp::Ne,
        VerilogOp::Lt => BinaryOp::Lt,
        VerilogOp::Le => BinaryOp::Le,
        VerilogOp::Gt => BinaryOp::Gt,
        VerilogOp::Ge => BinaryOp::Ge,
    }
}

fn bits_for(value: u128) -> usize {
    (128 - value.leading_zeros() as usize).max(1)
}

/// Zero-extends or truncates.
pub(super) fn resize(expr: Expr, width_bits: usize) -> Expr {
    match expr.kind {
        _ if width_bits == expr.width_bits => expr,
        ExprKind::Constant(value) => Expr::constant(value, width_bits),
        _ if width_bits < expr.width_bits => slice(expr, 0, width_bits),
        ExprKind::Extend(inner) => resize(*inner, width_bits),
        _ => Expr {
            width_bits,
            kind: ExprKind::Extend(Box::new(expr)),
        },
    }
}

/// Bits of an expression. They are taken from the operands wherever that is the same, because Verilog has no
/// slices of expressions.
pub(super) fn slice(expr: Expr, low_bit: usize, width_bits: usize) -> Expr {
    if low_bit == 0 && width_bits == expr.width_bits {
        return expr;
    }
    match expr.kind {
        ExprKind::Constant(value) => Expr::constant(value >> low_bit, width_bits),
        ExprKind::Slice(inner, inner_low) => slice(*inner, inner_low + low_bit, width_bits),
        ExprKind::Extend(inner) if low_bit >= inner.width_bits => Expr::constant(0, width_bits),
        ExprKind::Extend(inner) => {
            let kept_bits = width_bits.min(inner.width_bits - low_bit);
            resize(slice(*inner, low_bit, kept_bits), width_bits)
        }
        ExprKind::Unary(UnaryOp::Not, inner) => {
            unary(UnaryOp::Not, slice(*inner, low_bit, width_bits))
        }
        ExprKind::Binary(op @ (BinaryOp::And | BinaryOp::Or | BinaryOp::Xor), a, b) => binary(
            op,
            slice(*a, low_bit, width_bits),
            slice(*b, low_bit, width_bits),
        ),
        ExprKind::Binary(op @ (BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul), a, b)
            if low_bit == 0 =>
        {
            binary(op, slice(*a, 0, width_bits), slice(*b, 0, width_bits))
        }
        _ => Expr {
            width_bits,
            kind: ExprKind::Slice(Box::new(expr), low_bit),
        },
    }
}

fn unary(op: UnaryOp, inner: Expr) -> Expr {
    if let (UnaryOp::Not, ExprKind::Constant(value)) = (op, &inner.kind) {
        return Expr::constant(!value, inner.width_bits);
    }
    // A reduction of one bit is the bit.
    if op != UnaryOp::Not && inner.width_bits == 1 {
        return inner;
    }
    Expr {
        width_bits: if op == UnaryOp::Not {
            inner.width_bits
        } else {
            1
        },
        kind: ExprKind::Unary(op, Box::new(inner)),
    }
}

/// A shift; one by a constant becomes a plain selection of bits where it takes bits away at one end.
fn shift(op: BinaryOp, left: Expr, amount: Expr) -> Expr {
    let width_bits = left.width_bits;
    if let ExprKind::Constant(amount) = amount.kind {
        if amount >= width_bits as u128 {
            return Expr::constant(0, width_bits);
        }
        let amount = amount as usize;
        if amount == 0 {
            return left;
        }
        if let (BinaryOp::Shl, ExprKind::Constant(value)) = (op, &left.kind) {
            return Expr::constant(value << amount, width_bits);
        }
        if op == BinaryOp::Shr {
            return resize(slice(left, amount, width_bits - amount), width_bits);
        }
    }
    Expr {
        width_bits,
        kind: ExprKind::Binary(op, Box::new(left), Box::new(amount)),
    }
}

/// An operator on two operands of one width; comparisons that cannot come out otherwise are decided here.
pub(super) fn binary(op: BinaryOp, left: Expr, right: Expr) -> Expr {
    let max = mask(left.width_bits);
    let decided = match (op, &left.kind, &right.kind) {
        (BinaryOp::Lt, _, ExprKind::Constant(0)) => Some(0),
        (BinaryOp::Ge, _, ExprKind::Constant(0)) => Some(1),
        (BinaryOp::Gt, ExprKind::Constant(0), _) => Some(0),
        (BinaryOp::Le, ExprKind::Constant(0), _) => Some(1),
        (BinaryOp::Gt, _, ExprKind::Constant(c)) if *c == max => Some(0),
        (BinaryOp::Le, _, ExprKind::Constant(c)) if *c == max => Some(1),
        (BinaryOp::Lt, ExprKind::Constant(c), _) if *c == max => Some(0),
        (BinaryOp::Ge, ExprKind::Constant(c), _) if *c == max => Some(1),
        (_, ExprKind::Constant(a), ExprKind::Constant(b)) => evaluate_comparison(op, *a, *b),
        _ => None,
    };
    if let Some(bit) = decided {
        return Expr::constant(bit, 1);
    }
    let is_comparison = evaluate_comparison(op, 0, 0).is_some();
    Expr {
        width_bits: if is_comparison { 1 } else { left.width_bits },
        kind: ExprKind::Binary(op, Box::new(left), Box::new(right)),
    }
}

fn evaluate_comparison(op: BinaryOp, a: u128, b: u128) -> Option<u128> {
    let bit = match op {
        BinaryOp::Eq => a == b,
        BinaryOp::Ne => a != b,
        BinaryOp::Lt => a < b,
        BinaryOp::Le => a <= b,
        BinaryOp::Gt => a > b,
        BinaryOp::Ge => a >= b,
        _ => return None,
    };
    Some(bit.into())
}
