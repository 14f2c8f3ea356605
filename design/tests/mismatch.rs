//! Expressions that rust-hdl's own printer gets wrong, over all values of their operands. (Match guards and `..=` are erased before
//! anything can see them: the source check bans them.)

use crate::three_way::{three_way, Stimulus};
use rtl_design::elaborate::elaborate;
use rtl_design::kernel_engine;
use rust_hdl::prelude::*;

#[derive(LogicBlock, Default)]
struct Mismatch {
    a: Signal<In, Bits<6>>,
    b: Signal<In, Bits<6>>,
    f: Signal<In, Bit>,
    clock: Signal<In, Clock>,
    sum_equal: Signal<Out, Bit>,
    difference_greater: Signal<Out, Bit>,
    complement_zero: Signal<Out, Bit>,
    precedence: Signal<Out, Bit>,
    cast_sum: Signal<Out, Bits<8>>,
    cast_complement: Signal<Out, Bits<8>>,
    cast_flag: Signal<Out, Bits<8>>,
    cast_difference: Signal<Out, Bits<3>>,
    shifted_sum: Signal<Out, Bits<6>>,
    compared_shift: Signal<Out, Bit>,
    literal_first: Signal<Out, Bits<6>>,
}

impl Logic for Mismatch {
    #[hdl_gen]
    fn update(&mut self) {
        self.sum_equal.next = (self.a.val() + 1) == self.b.val();
        self.difference_greater.next = (self.a.val() - self.b.val()) > 5;
        self.complement_zero.next = (!self.a.val()) == 0;
        self.precedence.next = self.a.val() & self.b.val() == self.b.val();
        self.cast_sum.next = bit_cast::<8, 6>(self.a.val() + self.b.val());
        self.cast_complement.next = bit_cast::<8, 6>(!self.a.val());
        self.cast_flag.next = bit_cast::<8, 1>((!self.f.val()).into());
        self.cast_difference.next = bit_cast::<3, 6>(self.a.val() - self.b.val());
        self.shifted_sum.next = (self.a.val() + self.b.val()) >> 1;
        self.compared_shift.next = (self.a.val() << 2) == self.b.val();
        self.literal_first.next = 1 - self.a.val();
    }
}

#[test]
fn all_values_agree() {
    let mut block = Mismatch::default();
    block.connect_all();
    let design = elaborate(&block, "mismatch").unwrap();
    let mut kernel = kernel_engine!(block; clock; in a, b, f; out sum_equal, difference_greater, complement_zero,
        precedence, cast_sum, cast_complement, cast_flag, cast_difference, shifted_sum, compared_shift, literal_first);
    let stimulus = Stimulus {
        inputs: ["a", "b", "f"].map(String::from).into(),
        cycles: (0..1 << 13)
            .map(|v: u128| vec![v & 63, v >> 6 & 63, v >> 12])
            .collect(),
        middle: vec![],
    };
    three_way("mismatch", &mut kernel, &design, &stimulus).unwrap();
}
