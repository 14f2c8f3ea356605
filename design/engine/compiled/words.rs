//! Lowering to machine words: a net of up to 64 bits is a word, a wider one a pair.

use super::layout::Layout;
use super::native::{Code, Lower};
use crate::elaborate::mask;
use crate::engine::form::{Commit, Form, Node, NodeId, Op};
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::{I128, I64};
use cranelift_codegen::ir::{InstBuilder, Type, Value};

/// Words that a net takes.
pub(super) fn words_of(width_bits: usize) -> usize {
    width_bits.div_ceil(64)
}

/// A form on machine words.
pub(super) struct Words<'a>(pub &'a Form);

fn type_of(width_bits: usize) -> Type {
    if width_bits > 64 {
        I128
    } else {
        I64
    }
}

impl Lower for Words<'_> {
    fn segment(&self, code: &mut Code<'_, '_>, segment: usize) -> Vec<(Vec<usize>, Value)> {
        let segment = &self.0.segments[segment];
        let mut lowered = Lowered {
            form: self.0,
            nodes: &segment.nodes,
            values: vec![],
        };
        for node in &segment.nodes {
            let value = lowered.node(code, node);
            lowered.values.push(value);
        }
        let mut changes = Changes::default();
        for (net, node) in &segment.writes {
            let new = lowered.values[*node].number;
            changes.write(code, self.0, *net, new);
        }
        changes.finish(code)
    }

    fn group(&self, code: &mut Code<'_, '_>, group: usize) -> Vec<(Vec<usize>, Value)> {
        let Commit::Registers(registers) = &self.0.commits[group] else {
            unreachable!("memories come after all groups of registers")
        };
        let mut changes = Changes::default();
        for register in registers {
            let width = self.0.nets[register.q].width_bits;
            let mut new = load(code, register.next, width);
            if let Some(reset) = register.reset {
                let reset = load(code, reset, 1);
                let start = constant(code, register.start, width);
                new = code.builder.ins().select(reset, start, new);
            }
            changes.write(code, self.0, register.q, new);
        }
        changes.finish(code)
    }
}

fn load(code: &mut Code<'_, '_>, net: usize, width_bits: usize) -> Value {
    let word = code.layout.place(net);
    let low = code.load(I64, word);
    if width_bits <= 64 {
        return low;
    }
    let high = code.load(I64, word + 1);
    code.builder.ins().iconcat(low, high)
}

fn constant(code: &mut Code<'_, '_>, value: u128, width_bits: usize) -> Value {
    let low = (value as u64).cast_signed();
    let low = code.builder.ins().iconst(I64, low);
    if width_bits <= 64 {
        return low;
    }
    let high = ((value >> 64) as u64).cast_signed();
    let high = code.builder.ins().iconst(I64, high);
    code.builder.ins().iconcat(low, high)
}

/// Nets stored by one part, those with the same readers together, with the bits in which any has changed.
#[derive(Default)]
struct Changes(Vec<(Vec<usize>, Value)>);

impl Changes {
    fn write(&mut self, code: &mut Code<'_, '_>, form: &Form, net: usize, new: Value) {
        let width = form.nets[net].width_bits;
        let old = load(code, net, width);
        let word = code.layout.place(net);
        let mut difference = code.builder.ins().bxor(old, new);
        if width > 64 {
            let (low, high) = code.builder.ins().isplit(new);
            code.store(low, word);
            code.store(high, word + 1);
            let (low, high) = code.builder.ins().isplit(difference);
            difference = code.builder.ins().bor(low, high);
        } else {
            code.store(new, word);
        }
        let marks = |net: &usize| code.layout.marks(*net);
        if marks(&net).is_empty() {
            return;
        }
        let same = |(nets, _): &&mut (Vec<usize>, Value)| marks(&nets[0]) == marks(&net);
        match self.0.iter_mut().find(same) {
            Some((nets, sum)) => {
                nets.push(net);
                *sum = code.builder.ins().bor(*sum, difference);
            }
            None => self.0.push((vec![net], difference)),
        }
    }

    fn finish(mut self, code: &mut Code<'_, '_>) -> Vec<(Vec<usize>, Value)> {
        for (_, difference) in &mut self.0 {
            *difference = code.is_not_zero(*difference);
        }
        self.0
    }
}

/// Result of a node.
#[derive(Clone, Copy)]
struct Computed {
    /// The number, with zeros above its width.
    number: Value,
    /// For a comparison, its flag.
    flag: Option<Value>,
}

struct Lowered<'a> {
    form: &'a Form,
    nodes: &'a [Node],
    values: Vec<Computed>,
}

impl Lowered<'_> {
    fn number(&self, node: NodeId) -> Value {
        self.values[node].number
    }

    fn width(&self, node: NodeId) -> usize {
        self.nodes[node].width_bits
    }

    fn flag(&self, node: NodeId) -> Value {
        self.values[node].flag.unwrap_or(self.values[node].number)
    }

    fn node(&self, code: &mut Code<'_, '_>, node: &Node) -> Computed {
        let width = node.width_bits;
        let flag = match node.op {
            Op::Eq(a, b) => Some((IntCC::Equal, a, b)),
            Op::Lt(a, b) => Some((IntCC::UnsignedLessThan, a, b)),
            _ => None,
        };
        if let Some((condition, a, b)) = flag {
            let (a, b) = (self.number(a), self.number(b));
            let flag = code.builder.ins().icmp(condition, a, b);
            return Computed {
                number: code.builder.ins().uextend(I64, flag),
                flag: Some(flag),
            };
        }
        let number = match node.op {
            Op::Constant(value) => constant(code, value, width),
            Op::Net(net) => load(code, net, self.form.nets[net].width_bits),
            Op::Not(a) => {
                let ones = constant(code, mask(width), width);
                code.builder.ins().bxor(self.number(a), ones)
            }
            Op::And(a, b) => code.builder.ins().band(self.number(a), self.number(b)),
            Op::Or(a, b) => code.builder.ins().bor(self.number(a), self.number(b)),
            Op::Xor(a, b) => code.builder.ins().bxor(self.number(a), self.number(b)),
            Op::Add(a, b) => {
                let sum = code.builder.ins().iadd(self.number(a), self.number(b));
                cut(code, sum, width)
            }
            Op::Sub(a, b) => {
                let difference = code.builder.ins().isub(self.number(a), self.number(b));
                cut(code, difference, width)
            }
            Op::Mul(a, b) => {
                let product = code.builder.ins().imul(self.number(a), self.number(b));
                cut(code, product, width)
            }
            Op::Shl(a, b) => {
                let shifted = self.shift(code, a, b, true);
                cut(code, shifted, width)
            }
            Op::Shr(a, b) => {
                let mut shifted = self.shift(code, a, b, false);
                if self.width(a) > 64 && width <= 64 {
                    shifted = code.builder.ins().ireduce(I64, shifted);
                }
                let by = self.constant_of(b).unwrap_or(0);
                if by.saturating_add(width as u128) >= self.width(a) as u128 {
                    shifted
                } else {
                    cut(code, shifted, width)
                }
            }
            Op::Parity(a) => self.parity(code, a),
            Op::Mux(c, a, b) => {
                let (a, b) = (self.number(a), self.number(b));
                code.builder.ins().select(self.flag(c), a, b)
            }
            Op::Extend(a) => {
                let number = self.number(a);
                if width > 64 && self.width(a) <= 64 {
                    code.builder.ins().uextend(I128, number)
                } else {
                    number
                }
            }
            Op::Eq(..) | Op::Lt(..) => unreachable!("done above"),
        };
        Computed { number, flag: None }
    }

    fn constant_of(&self, node: NodeId) -> Option<u128> {
        match self.nodes[node].op {
            Op::Constant(value) => Some(value),
            _ => None,
        }
    }

    fn shift(&self, code: &mut Code<'_, '_>, a: NodeId, by: NodeId, is_left: bool) -> Value {
        let width = self.width(a);
        let kind = type_of(width);
        let number = self.number(a);
        let bits = kind.bits();
        let shifted = |code: &mut Code<'_, '_>, amount: Value| {
            if is_left {
                code.builder.ins().ishl(number, amount)
            } else {
                code.builder.ins().ushr(number, amount)
            }
        };
        if let Some(amount) = self.constant_of(by) {
            if amount >= u128::from(bits) {
                return constant(code, 0, width);
            }
            let amount = code.builder.ins().iconst(I64, amount as i64);
            return shifted(code, amount);
        }
        let mut amount = self.number(by);
        let mut is_far = None;
        if self.width(by) > 64 {
            let (low, high) = code.builder.ins().isplit(amount);
            amount = low;
            is_far = Some(code.is_not_zero(high));
        }
        let within = shifted(code, amount);
        // An amount of 6 bits cannot shift a word out.
        if self.width(by) < 7 && bits == 64 || self.width(by) < 8 && bits == 128 {
            return within;
        }
        let limit = i64::from(bits) - 1;
        let beyond = IntCC::UnsignedGreaterThan;
        let mut is_out = code.builder.ins().icmp_imm_s(beyond, amount, limit);
        if let Some(is_far) = is_far {
            is_out = code.builder.ins().bor(is_out, is_far);
        }
        let zero = constant(code, 0, width);
        code.builder.ins().select(is_out, zero, within)
    }

    fn parity(&self, code: &mut Code<'_, '_>, a: NodeId) -> Value {
        let mut number = self.number(a);
        if self.width(a) > 64 {
            let (low, high) = code.builder.ins().isplit(number);
            number = code.builder.ins().bxor(low, high);
        }
        let ones = code.builder.ins().popcnt(number);
        code.builder.ins().band_imm_s(ones, 1)
    }
}

/// Zeros above the width.
fn cut(code: &mut Code<'_, '_>, value: Value, width_bits: usize) -> Value {
    if width_bits == 64 || width_bits == 128 {
        return value;
    }
    let bits = constant(code, mask(width_bits), width_bits);
    code.builder.ins().band(value, bits)
}

/// Where the words of a layout for this lowering are.
pub(super) fn layout(form: &Form) -> Layout {
    Layout::new(form, words_of)
}
