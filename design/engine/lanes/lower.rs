//! Lowering to bits: bit `b` of a net is a vector, one bit for each lane.

use super::bits::{BitSegment, Gate};
use crate::engine::compiled::layout::Layout;
use crate::engine::compiled::native::{Code, Lower};
use crate::engine::form::{Commit, Form};
use cranelift_codegen::ir::types::I64;
use cranelift_codegen::ir::{InstBuilder, Type, Value};

/// A form on vectors of bits.
pub(super) struct Bits<'a> {
    pub form: &'a Form,
    pub segments: &'a [BitSegment],
    /// Machine type that holds one bit of all lanes.
    pub kind: Type,
}

impl Bits<'_> {
    fn words(&self) -> usize {
        self.kind.bytes() as usize / 8
    }

    fn load(&self, code: &mut Code<'_, '_>, net: usize, bit: usize) -> Value {
        let word = code.layout.place(net) + bit * self.words();
        code.load(self.kind, word)
    }

    fn constant(&self, code: &mut Code<'_, '_>, value: bool) -> Value {
        let word = code.builder.ins().iconst(I64, -i64::from(value));
        if self.kind == I64 {
            word
        } else {
            code.builder.ins().splat(self.kind, word)
        }
    }

    fn mux(&self, code: &mut Code<'_, '_>, c: Value, a: Value, b: Value) -> Value {
        let differ = code.builder.ins().bxor(a, b);
        let chosen = code.builder.ins().band(differ, c);
        code.builder.ins().bxor(chosen, b)
    }

    /// A number that is not 0 if any bit is set.
    fn any(&self, code: &mut Code<'_, '_>, bits: Value) -> Value {
        if self.kind == I64 {
            code.is_not_zero(bits)
        } else {
            code.builder.ins().vany_true(bits)
        }
    }

    fn write(
        &self,
        code: &mut Code<'_, '_>,
        changes: &mut Vec<(Vec<usize>, Value)>,
        (net, bit): (usize, usize),
        new: Value,
    ) {
        let old = self.load(code, net, bit);
        let word = code.layout.place(net) + bit * self.words();
        code.store(new, word);
        let marks = |net: &usize| code.layout.marks(*net);
        if marks(&net).is_empty() {
            return;
        }
        let same = |(nets, _): &&mut (Vec<usize>, Value)| marks(&nets[0]) == marks(&net);
        match changes.iter_mut().find(same) {
            Some((nets, sum)) => {
                if nets.last() != Some(&net) {
                    nets.push(net);
                }
                let difference = code.builder.ins().bxor(old, new);
                *sum = code.builder.ins().bor(*sum, difference);
            }
            None => {
                let difference = code.builder.ins().bxor(old, new);
                changes.push((vec![net], difference));
            }
        }
    }

    fn finish(
        &self,
        code: &mut Code<'_, '_>,
        mut changes: Vec<(Vec<usize>, Value)>,
    ) -> Vec<(Vec<usize>, Value)> {
        for (_, bits) in &mut changes {
            *bits = self.any(code, *bits);
        }
        changes
    }
}

impl Lower for Bits<'_> {
    fn segment(&self, code: &mut Code<'_, '_>, segment: usize) -> Vec<(Vec<usize>, Value)> {
        let segment = &self.segments[segment];
        let mut values: Vec<Value> = vec![];
        for gate in &segment.gates {
            let v = |bit: usize| values[bit];
            // "And not" is one instruction.
            let and = |code: &mut Code<'_, '_>, a: usize, b: usize| match segment.gates[b] {
                Gate::Not(inner) => code.builder.ins().band_not(v(a), v(inner)),
                _ => code.builder.ins().band(v(a), v(b)),
            };
            let value = match *gate {
                Gate::Constant(value) => self.constant(code, value),
                Gate::Net(net, bit) => self.load(code, net, bit),
                Gate::Not(a) => code.builder.ins().bnot(v(a)),
                Gate::And(a, b) => match segment.gates[a] {
                    Gate::Not(_) => and(code, b, a),
                    _ => and(code, a, b),
                },
                Gate::Or(a, b) => code.builder.ins().bor(v(a), v(b)),
                Gate::Xor(a, b) => code.builder.ins().bxor(v(a), v(b)),
                Gate::Mux(c, a, b) => self.mux(code, v(c), v(a), v(b)),
            };
            values.push(value);
        }
        let mut changes = vec![];
        for (net, number, bit) in &segment.writes {
            self.write(code, &mut changes, (*net, *number), values[*bit]);
        }
        self.finish(code, changes)
    }

    fn group(&self, code: &mut Code<'_, '_>, group: usize) -> Vec<(Vec<usize>, Value)> {
        let Commit::Registers(registers) = &self.form.commits[group] else {
            unreachable!("memories come after all groups of registers")
        };
        let mut changes = vec![];
        for register in registers {
            let reset = register.reset.map(|reset| self.load(code, reset, 0));
            for bit in 0..self.form.nets[register.q].width_bits {
                let mut new = self.load(code, register.next, bit);
                if let Some(reset) = reset {
                    new = if register.start >> bit & 1 == 1 {
                        code.builder.ins().bor(new, reset)
                    } else {
                        code.builder.ins().band_not(new, reset)
                    };
                }
                self.write(code, &mut changes, (register.q, bit), new);
            }
        }
        self.finish(code, changes)
    }
}

/// Where the words of a layout for this lowering are.
pub(super) fn layout(form: &Form, kind: Type) -> Layout {
    let words = kind.bytes() as usize / 8;
    Layout::new(form, |width_bits| width_bits * words)
}
