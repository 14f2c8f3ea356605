//! The same form without a code generator: an interpreter over the same layout, for platforms that Cranelift does not know.

use super::layout::Layout;
use crate::engine::form::{evaluate, Commit, Form, Op};

/// The value of a net that is stored.
pub(super) fn value(layout: &Layout, form: &Form, state: &[u64], net: usize) -> u128 {
    let word = layout.place(net);
    let high = if form.nets[net].width_bits > 64 {
        u128::from(state[word + 1]) << 64
    } else {
        0
    };
    high | u128::from(state[word])
}

/// Stores a value; marks the readers if it is a new one.
pub(super) fn store(layout: &Layout, form: &Form, state: &mut [u64], net: usize, new: u128) {
    if value(layout, form, state, net) == new {
        return;
    }
    let word = layout.place(net);
    state[word] = new as u64;
    if form.nets[net].width_bits > 64 {
        state[word + 1] = (new >> 64) as u64;
    }
    layout.mark(state, net);
}

/// Runs all segments that are marked, in order.
pub(super) fn settle(form: &Form, layout: &Layout, state: &mut [u64]) {
    let mut values: Vec<u128> = vec![];
    while let Some(index) = Layout::take_lowest(state, layout.segment_words()) {
        let segment = &form.segments[index];
        values.clear();
        for node in &segment.nodes {
            let operands: [u128; 3] = {
                let mut found = [0; 3];
                for (place, operand) in found.iter_mut().zip(node.op.operands()) {
                    *place = values[operand];
                }
                found
            };
            let computed = match node.op {
                Op::Net(net) => value(layout, form, state, net),
                op => evaluate(&op, &operands, |n| segment.nodes[n].width_bits),
            };
            values.push(computed & crate::elaborate::mask(node.width_bits));
        }
        for (net, node) in &segment.writes {
            store(layout, form, state, *net, values[*node]);
        }
    }
}

/// Loads all groups of registers that are marked.
pub(super) fn commit(form: &Form, layout: &Layout, state: &mut [u64]) {
    while let Some(index) = Layout::take_lowest(state, layout.group_words()) {
        let Commit::Registers(registers) = &form.commits[index] else {
            unreachable!("memories come after all groups of registers")
        };
        for register in registers {
            let is_reset = register
                .reset
                .is_some_and(|reset| value(layout, form, state, reset) != 0);
            let loaded = if is_reset {
                register.start
            } else {
                value(layout, form, state, register.next)
            };
            store(layout, form, state, register.q, loaded);
        }
    }
}
