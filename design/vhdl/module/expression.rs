//! Expressions as VHDL text: as values, and as conditions.

use super::ModulePrinter;
use crate::elaborate::{mask, BinaryOp, Expr, ExprKind, UnaryOp};
use crate::printing::{parts, Part};
use crate::vhdl::text::{binary, literal, mask_literal, number, Context};

/// Widest index that is surely an integer.
const INDEX_BITS: usize = 30;

/// How tightly a text holds together: what is looser than its place asks for gets parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    /// `and`, `or`, `xor`: only the same one goes on without parentheses.
    Logic(BinaryOp),
    /// `=` and its like.
    Relation,
    /// `+`: goes on to the right.
    Sum,
    /// `-`, `*`, `&`: nobody should have to think about these.
    Other,
    /// `not`.
    Not,
    /// A name, a literal, a call.
    Atom,
}

/// Text and its level.
struct Text(String, Level);

impl Text {
    fn atom(text: impl Into<String>) -> Self {
        Self(text.into(), Level::Atom)
    }

    /// In parentheses unless it is of one of these levels.
    fn within(self, levels: &[Level]) -> String {
        match self.1 == Level::Atom || levels.contains(&self.1) {
            true => self.0,
            false => format!("({})", self.0),
        }
    }
}

/// Whether VHDL says it as a condition.
pub(super) fn is_condition(expr: &Expr) -> bool {
    if expr.width_bits != 1 || parts(expr).is_some() {
        return false;
    }
    match &expr.kind {
        ExprKind::Binary(op, left, right) => match op {
            BinaryOp::And | BinaryOp::Or | BinaryOp::Xor => {
                is_condition(left) || is_condition(right)
            }
            op => is_comparison(*op),
        },
        ExprKind::Unary(UnaryOp::Not, inner) => is_condition(inner),
        ExprKind::Unary(UnaryOp::Any, inner) => inner.width_bits > 1 || is_condition(inner),
        ExprKind::Unary(_, inner) => inner.width_bits == 1 && is_condition(inner),
        _ => false,
    }
}

impl ModulePrinter<'_> {
    /// The text of an expression as a value: a bit, or `unsigned`.
    pub fn value(&mut self, expr: &Expr, context: Context) -> String {
        self.value_text(expr, context).0
    }

    /// The text of a bit as a condition.
    pub fn condition(&mut self, expr: &Expr) -> String {
        self.condition_text(expr).0
    }

    fn value_text(&mut self, expr: &Expr, context: Context) -> Text {
        if let Some(parts) = parts(expr) {
            return self.side_by_side(parts, expr.width_bits, context);
        }
        match &expr.kind {
            ExprKind::Constant(value) => literal_text(literal(*value, expr.width_bits, context)),
            ExprKind::Variant(enum_id, variant) => Text::atom(self.scope.state(*enum_id, *variant)),
            ExprKind::Parameter(index) => Text::atom(&self.module.parameters[*index].name),
            ExprKind::Net(net) => Text::atom(self.range(*net, 0, expr.width_bits)),
            ExprKind::Extend(inner) => self.resized(inner, expr.width_bits),
            ExprKind::Slice(inner, low_bit) => {
                Text::atom(self.slice(inner, *low_bit, expr.width_bits, context))
            }
            ExprKind::Select(inner, index) => {
                Text::atom(self.select(inner, index, expr.width_bits))
            }
            ExprKind::Unary(op, inner) => self.unary(*op, inner, context),
            ExprKind::Binary(op, left, right) => self.binary(*op, left, right, context),
        }
    }

    /// Parts side by side, the lowest first.
    fn side_by_side(&mut self, mut parts: Vec<Part>, width_bits: usize, context: Context) -> Text {
        match &parts[..] {
            [Part::Known(value, _)] => {
                return literal_text(mask_literal(*value, width_bits, context))
            }
            [Part::Value(expr)] => return self.value_text(expr, context),
            // Zeros above a value: that value, wider.
            [Part::Value(expr), Part::Known(0, _)] => return self.resized(expr, width_bits),
            _ => {}
        }
        parts.reverse();
        let is_typed = |part: &Part| matches!(part, Part::Value(e) if e.width_bits > 1);
        let is_alone = context != Context::Target && !parts.iter().any(is_typed);
        let text = |part: Part| match part {
            Part::Known(value, places) => match value {
                0 if places > 1 => format!("\"{}\"", "0".repeat(places)),
                _ => mask_literal(value, places, Context::Operand),
            },
            Part::Value(expr) => self.value_text(&expr, Context::Operand).within(&[]),
        };
        let texts: Vec<String> = parts.into_iter().map(text).collect();
        let text = texts.join(" & ");
        match is_alone {
            true => Text::atom(format!("unsigned'({text})")),
            false => Text(text, Level::Other),
        }
    }

    fn resized(&mut self, inner: &Expr, width_bits: usize) -> Text {
        let inner = self.value(inner, Context::Alone);
        Text::atom(format!("resize({inner}, {width_bits})"))
    }

    fn slice(
        &mut self,
        inner: &Expr,
        low_bit: usize,
        width_bits: usize,
        context: Context,
    ) -> String {
        if let Some(value) = self.scope.named_value(inner) {
            return literal((value >> low_bit) & mask(width_bits), width_bits, context);
        }
        if let ExprKind::Net(net) = inner.kind {
            return self.range(net, low_bit, width_bits);
        }
        if inner.width_bits == width_bits {
            return self.value_text(inner, Context::Operand).within(&[]);
        }
        let inner = self.value(inner, Context::Alone);
        match (width_bits, low_bit) {
            (1, _) => format!("bit_at({inner}, {low_bit})"),
            (_, 0) => format!("resize({inner}, {width_bits})"),
            _ => format!("slice({inner}, {}, {low_bit})", low_bit + width_bits - 1),
        }
    }

    /// Bits from a variable position; above the end there are zeros.
    fn select(&mut self, inner: &Expr, index: &Expr, width_bits: usize) -> String {
        let at = self.places(index);
        let is_inside = index.width_bits <= INDEX_BITS && 1 << index.width_bits <= inner.width_bits;
        match inner.kind {
            ExprKind::Net(net) if width_bits == 1 && inner.width_bits > 1 && is_inside => {
                return format!("{}({at})", self.reference(net));
            }
            _ => {}
        }
        let inner = match inner.width_bits {
            1 => self.resized(inner, 2).0,
            _ => self.value(inner, Context::Alone),
        };
        match width_bits {
            1 => format!("bit_at({inner}, {at})"),
            _ => format!("resize(shift_right({inner}, {at}), {width_bits})"),
        }
    }

    /// A number as one that counts places.
    pub fn places(&mut self, expr: &Expr) -> String {
        match (&expr.kind, expr.width_bits) {
            (ExprKind::Constant(value), _) => (*value).min(1023).to_string(),
            (_, width_bits) if width_bits > INDEX_BITS => {
                format!("places({})", self.value(expr, Context::Alone))
            }
            _ => format!("to_integer({})", self.value(expr, Context::Alone)),
        }
    }

    fn unary(&mut self, op: UnaryOp, inner: &Expr, context: Context) -> Text {
        let call = |name: &str, inner: String| Text::atom(format!("{name}({inner})"));
        match op {
            UnaryOp::Not if is_condition(inner) => {
                let not = negated(inner);
                self.as_bit(&not)
            }
            UnaryOp::Not => {
                let inner = self.value_text(inner, context).within(&[]);
                Text(format!("not {inner}"), Level::Not)
            }
            _ if inner.width_bits == 1 => self.value_text(inner, context),
            UnaryOp::All => call("and_reduce", self.value(inner, Context::Alone)),
            UnaryOp::Xor => call("xor_reduce", self.value(inner, Context::Alone)),
            UnaryOp::Any => {
                let any = any(inner);
                self.as_bit(&any)
            }
        }
    }

    /// A condition as a bit.
    fn as_bit(&mut self, expr: &Expr) -> Text {
        Text::atom(format!("to_sl({})", self.condition(expr)))
    }

    fn binary(&mut self, op: BinaryOp, left: &Expr, right: &Expr, context: Context) -> Text {
        let is_bit = left.width_bits == 1;
        match op {
            _ if is_comparison(op) => {
                let both = compared(op, left, right);
                self.as_bit(&both)
            }
            BinaryOp::Shl | BinaryOp::Shr => {
                let at = self.places(right);
                let name = if op == BinaryOp::Shl {
                    "shift_left"
                } else {
                    "shift_right"
                };
                match is_bit {
                    // One bit is selected, or shifted out.
                    true => {
                        let left = self.value(left, Context::Alone);
                        Text::atom(format!("bit_at({name}(resize({left}, 2), {at}), 0)"))
                    }
                    false => {
                        let left = self.value(left, Context::Alone);
                        Text::atom(format!("{name}({left}, {at})"))
                    }
                }
            }
            BinaryOp::And | BinaryOp::Or | BinaryOp::Xor => self.logic(op, left, right, context),
            // Without a carry.
            BinaryOp::Add | BinaryOp::Sub if is_bit => {
                self.logic(BinaryOp::Xor, left, right, context)
            }
            BinaryOp::Mul if is_bit => self.logic(BinaryOp::And, left, right, context),
            _ => self.sum(op, left, right),
        }
    }

    fn logic(&mut self, op: BinaryOp, left: &Expr, right: &Expr, context: Context) -> Text {
        let (sign, own) = (sign(op), Level::Logic(op));
        if is_condition(left) && is_condition(right) && left.width_bits == 1 {
            let both = compared(op, left, right);
            return self.as_bit(&both);
        }
        let are_both_known = is_literal(left) && is_literal(right);
        let mut operand = |expr: &Expr, levels: &[Level], context| match &expr.kind {
            ExprKind::Constant(value) => {
                literal_text(mask_literal(*value, expr.width_bits, context)).within(&[])
            }
            _ => self.value_text(expr, context).within(levels),
        };
        // One of two literals needs an explicit type.
        let first = match (are_both_known, context) {
            (true, Context::Alone) => Context::Alone,
            _ => Context::Operand,
        };
        let left = operand(left, &[own, Level::Not], first);
        let right = operand(right, &[Level::Not], Context::Operand);
        Text(format!("{left} {sign} {right}"), own)
    }

    fn sum(&mut self, op: BinaryOp, left: &Expr, right: &Expr) -> Text {
        let are_both_known = is_literal(left) && is_literal(right);
        let mut operand = |expr: &Expr, levels: &[Level], is_number: bool| match expr.kind {
            ExprKind::Constant(value) if is_number => match number(value) {
                Some(number) => number,
                None => self.value_text(expr, Context::Operand).within(&[]),
            },
            ExprKind::Constant(_) => self.value_text(expr, Context::Alone).within(&[]),
            _ => self.value_text(expr, Context::Operand).within(levels),
        };
        let left_levels: &[Level] = match op {
            BinaryOp::Add | BinaryOp::Sub => &[Level::Sum],
            _ => &[],
        };
        let width_bits = left.width_bits;
        let left = operand(left, left_levels, !are_both_known);
        let right = operand(right, &[], true);
        let text = format!("{left} {} {right}", sign(op));
        match op {
            BinaryOp::Mul => Text::atom(format!("resize({text}, {width_bits})")),
            BinaryOp::Add => Text(text, Level::Sum),
            _ => Text(text, Level::Other),
        }
    }

    fn condition_text(&mut self, expr: &Expr) -> Text {
        if parts(expr).is_none() {
            match &expr.kind {
                ExprKind::Constant(value) => return Text::atom((*value != 0).to_string()),
                ExprKind::Unary(UnaryOp::Not, inner) => {
                    return match is_condition(inner) || is_logic(inner) {
                        true if !matches!(
                            negated(inner).kind,
                            ExprKind::Unary(UnaryOp::Not, _)
                        ) =>
                        {
                            self.condition_text(&negated(inner))
                        }
                        true => {
                            let inner = self.condition_text(inner).within(&[]);
                            Text(format!("not {inner}"), Level::Not)
                        }
                        false => {
                            let inner = self.value_text(inner, Context::Operand).within(&[]);
                            Text(format!("{inner} = '0'"), Level::Relation)
                        }
                    };
                }
                ExprKind::Unary(UnaryOp::Any, inner) if inner.width_bits > 1 => {
                    return self.condition_text(&any(inner));
                }
                ExprKind::Binary(op, left, right) if is_comparison(*op) => {
                    return self.relation(*op, left, right);
                }
                ExprKind::Binary(op, left, right)
                    if is_logic(expr) && (*op != BinaryOp::Xor || is_condition(expr)) =>
                {
                    let own = Level::Logic(*op);
                    let left =
                        (self.condition_text(left)).within(&[own, Level::Relation, Level::Not]);
                    let right = (self.condition_text(right)).within(&[Level::Relation, Level::Not]);
                    return Text(format!("{left} {} {right}", sign(*op)), own);
                }
                _ => {}
            }
        }
        let value = self.value_text(expr, Context::Operand).within(&[]);
        Text(format!("{value} = '1'"), Level::Relation)
    }

    fn relation(&mut self, op: BinaryOp, left: &Expr, right: &Expr) -> Text {
        let are_both_known = is_literal(left) && is_literal(right);
        let mut operand = |expr: &Expr, is_number: bool| match expr.kind {
            ExprKind::Constant(value) if expr.width_bits > 1 && is_number => match number(value) {
                Some(number) => number,
                None => self.value_text(expr, Context::Operand).within(&[]),
            },
            ExprKind::Constant(_) => self.value_text(expr, Context::Alone).within(&[]),
            _ => self.value_text(expr, Context::Operand).within(&[]),
        };
        let left = operand(left, !are_both_known);
        let right = operand(right, true);
        Text(format!("{left} {} {right}", sign(op)), Level::Relation)
    }
}

fn is_literal(expr: &Expr) -> bool {
    matches!(expr.kind, ExprKind::Constant(_))
}

/// A literal is an atom, unless it is strings side by side.
fn literal_text(text: String) -> Text {
    match text.contains('&') && !text.starts_with("unsigned'") {
        true => Text(text, Level::Other),
        false => Text::atom(text),
    }
}

/// Whether it is an operation on bits that goes on in conditions.
fn is_logic(expr: &Expr) -> bool {
    let is_logic = |op| matches!(op, BinaryOp::And | BinaryOp::Or | BinaryOp::Xor);
    expr.width_bits == 1
        && parts(expr).is_none()
        && matches!(expr.kind, ExprKind::Binary(op, ..) if is_logic(op))
}

fn compared(op: BinaryOp, left: &Expr, right: &Expr) -> Expr {
    Expr {
        width_bits: 1,
        kind: ExprKind::Binary(op, Box::new(left.clone()), Box::new(right.clone())),
    }
}

/// Any bit of a value: it is not 0.
fn any(inner: &Expr) -> Expr {
    compared(BinaryOp::Ne, inner, &Expr::constant(0, inner.width_bits))
}

/// The opposite of a condition: the opposite comparison, if it is one.
fn negated(expr: &Expr) -> Expr {
    let opposite = |op| {
        Some(match op {
            BinaryOp::Eq => BinaryOp::Ne,
            BinaryOp::Ne => BinaryOp::Eq,
            BinaryOp::Lt => BinaryOp::Ge,
            BinaryOp::Le => BinaryOp::Gt,
            BinaryOp::Gt => BinaryOp::Le,
            BinaryOp::Ge => BinaryOp::Lt,
            _ => return None,
        })
    };
    match &expr.kind {
        ExprKind::Binary(op, left, right) => {
            if let Some(op) = opposite(*op) {
                return compared(op, left, right);
            }
        }
        ExprKind::Unary(UnaryOp::Not, inner) => return (**inner).clone(),
        ExprKind::Unary(UnaryOp::Any, inner) if inner.width_bits > 1 => {
            return compared(BinaryOp::Eq, inner, &Expr::constant(0, inner.width_bits));
        }
        _ => {}
    }
    Expr {
        width_bits: 1,
        kind: ExprKind::Unary(UnaryOp::Not, Box::new(expr.clone())),
    }
}

fn is_comparison(op: BinaryOp) -> bool {
    use BinaryOp::{Eq, Ge, Gt, Le, Lt, Ne};
    matches!(op, Eq | Ne | Lt | Le | Gt | Ge)
}

fn sign(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Add => "+",
        BinaryOp::Sub => "-",
        BinaryOp::Mul => "*",
        BinaryOp::And => "and",
        BinaryOp::Or => "or",
        BinaryOp::Xor => "xor",
        BinaryOp::Shl => "sll",
        BinaryOp::Shr => "srl",
        BinaryOp::Eq => "=",
        BinaryOp::Ne => "/=",
        BinaryOp::Lt => "<",
        BinaryOp::Le => "<=",
        BinaryOp::Gt => ">",
        BinaryOp::Ge => ">=",
    }
}

/// Value of a case choice.
pub(super) fn choice(value: u128, width_bits: usize) -> String {
    match width_bits {
        1 => format!("'{value}'"),
        _ => binary(value, width_bits),
    }
}
