//! Bit grid: one strobe in each bit, resynchronised by edges of the line.
//!
//! ```text
//! line    ~~~~\_______________/~~~~~~~
//! restart _____/\_____________________   first cycle after the edge
//! strobe  _________/\______________/\_   middle of the bit, then every bit_cycles
//! ```

use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Counter of system clock cycles in a bit.
#[derive(LogicBlock, Block)]
#[properties("../../properties/bit_grid.sv")]
pub struct BitGrid {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// System clock cycles in a bit, 4 to 127.
    pub bit_cycles: Signal<In, Bits<7>>,
    /// This cycle is the first one of a bit.
    pub restart: Signal<In, Bit>,
    /// High for one cycle in the middle of each bit.
    pub strobe: Signal<Out, Bit>,
    /// Counts the cycles of a bit down to 1; the strobe is at 2.
    left: Reg<Bits<7>>,
}

#[kernel]
impl Logic for BitGrid {
    fn update(&mut self) {
        self.left.d.next = self.left.q.val() - 1;
        if self.left.q.val() == 1 {
            self.left.d.next = self.bit_cycles.val();
        }
        if self.restart.val() {
            self.left.d.next = self.bit_cycles.val() >> 1;
        }
        // At 2, not at 1: the restart takes a cycle.
        self.strobe.next = self.left.q.val() == 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::tick;

    #[test]
    fn strobes_are_a_bit_apart_and_the_first_is_half_a_bit_after_the_edge() {
        for bit_cycles in [4, 8, 12, 24, 31, 40, 127] {
            let mut uut = BitGrid::default();
            uut.bit_cycles.next = (bit_cycles as u64).into();
            uut.connect_all();
            let step = |uut: &mut BitGrid| tick(uut, |u, level| u.clock.next = level.into());
            (0..300).for_each(|_| step(&mut uut));
            uut.restart.next = true;
            step(&mut uut);
            uut.restart.next = false;
            let mut at = vec![];
            for cycle in 1..=4 * bit_cycles {
                crate::testing::settle(&mut uut);
                if uut.strobe.val() {
                    at.push(cycle);
                }
                step(&mut uut);
            }
            assert_eq!(at[0], bit_cycles / 2 - 1, "{bit_cycles}");
            assert!(at.windows(2).all(|w| w[1] - w[0] == bit_cycles), "{at:?}");
        }
    }
}
