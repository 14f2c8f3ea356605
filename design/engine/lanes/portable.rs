//! The lanes without a code generator: gates on words, one after the other.

use super::bits::{BitSegment, Gate};
use crate::engine::compiled::layout::Layout;
use crate::engine::form::{Commit, Form};

/// Executes bits on the layout of the native code.
pub(super) struct Portable {
    segments: Vec<BitSegment>,
    words: usize,
}

impl Portable {
    pub fn new(segments: Vec<BitSegment>, words: usize) -> Self {
        Self { segments, words }
    }

    /// Runs all segments that are marked, in order.
    pub fn settle(&self, layout: &Layout, state: &mut [u64]) {
        let mut values: Vec<u64> = vec![];
        while let Some(index) = Layout::take_lowest(state, layout.segment_words()) {
            let segment = &self.segments[index];
            for part in 0..self.words {
                values.clear();
                for gate in &segment.gates {
                    let v = |bit: usize| values[bit];
                    let value = match *gate {
                        Gate::Constant(value) => 0u64.wrapping_sub(value.into()),
                        Gate::Net(net, bit) => state[layout.place(net) + bit * self.words + part],
                        Gate::Not(a) => !v(a),
                        Gate::And(a, b) => v(a) & v(b),
                        Gate::Or(a, b) => v(a) | v(b),
                        Gate::Xor(a, b) => v(a) ^ v(b),
                        Gate::Mux(c, a, b) => v(a) & v(c) | v(b) & !v(c),
                    };
                    values.push(value);
                }
                for (net, number, bit) in &segment.writes {
                    self.store(layout, state, (*net, *number, part), values[*bit]);
                }
            }
        }
    }

    /// Loads all groups of registers that are marked.
    pub fn commit(&self, form: &Form, layout: &Layout, state: &mut [u64]) {
        while let Some(index) = Layout::take_lowest(state, layout.group_words()) {
            let Commit::Registers(registers) = &form.commits[index] else {
                unreachable!("memories come after all groups of registers")
            };
            for register in registers {
                for part in 0..self.words {
                    let reset = register
                        .reset
                        .map_or(0, |net| state[layout.place(net) + part]);
                    for bit in 0..form.nets[register.q].width_bits {
                        let next = layout.place(register.next) + bit * self.words + part;
                        let start = 0u64.wrapping_sub((register.start >> bit & 1) as u64);
                        let value = state[next] & !reset | start & reset;
                        self.store(layout, state, (register.q, bit, part), value);
                    }
                }
            }
        }
    }

    fn store(
        &self,
        layout: &Layout,
        state: &mut [u64],
        (net, bit, part): (usize, usize, usize),
        value: u64,
    ) {
        let word = layout.place(net) + bit * self.words + part;
        if state[word] != value {
            state[word] = value;
            layout.mark(state, net);
        }
    }
}
