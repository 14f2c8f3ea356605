//! Protected bit: with guards, a single upset does not set this flag.
//!
//! ```text
//! raise      __/\__________________
//! clear      ____________/\________
//! stored     ____/~~~~~~~~~\_______
//! complement ~~~~\_________/~~~~~~~
//! is_set     ____/~~~~~~~~~\_______    stored and not complement; both equal: an upset clears the bit (without guards: stored)
//! ```
//!
//! For bits whose upset would start an unintended action, such as a repeated request or a continuous clock.

use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// A flag with a stored complement.
#[derive(LogicBlock, Block)]
pub struct ProtectedBit {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: set the bit; overrides `clear`.
    pub raise: Signal<In, Bit>,
    /// Strobe: clear the bit.
    pub clear: Signal<In, Bit>,
    /// The bit is set.
    pub is_set: Signal<Out, Bit>,
    /// High while the bit is set.
    stored: Reg<Bit>,
    /// Complement of `stored`; the same level in both means an upset.
    #[start(true)]
    complement: Reg<Bit>,
    /// 1 if the complement is stored and compared.
    has_guards: Constant<Bit>,
}

impl ProtectedBit {
    /// Two registers with guards, one without.
    pub fn new(guards: bool) -> Self {
        Self::from_parts(ProtectedBitParts {
            has_guards: Constant::new(guards),
        })
    }
}

#[kernel]
impl Logic for ProtectedBit {
    fn update(&mut self) {
        if self.clear.val()
            | (self.has_guards.val() & (self.stored.q.val() == self.complement.q.val()))
        {
            self.stored.d.next = false;
            self.complement.d.next = true;
        }
        if self.raise.val() {
            self.stored.d.next = true;
            self.complement.d.next = false;
        }
        self.is_set.next = self.stored.q.val() & !(self.has_guards.val() & self.complement.q.val());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::settle;

    /// A bit with these registers, one clock edge later.
    fn after(stored: bool, complement: bool, set: bool, clear: bool) -> (bool, bool) {
        let mut block = ProtectedBit::new(true);
        block.connect_all();
        block.stored.q.next = stored;
        block.complement.q.next = complement;
        block.raise.next = set;
        block.clear.next = clear;
        settle(&mut block);
        (block.stored.d.val(), block.complement.d.val())
    }

    #[test]
    fn bit_clears_if_both_registers_are_alike() {
        for (stored, complement) in [(false, false), (true, true)] {
            assert_eq!(after(stored, complement, false, false), (false, true));
            assert_eq!(after(stored, complement, true, false), (true, false));
        }
        assert_eq!(after(true, false, false, false), (true, false));
        assert_eq!(after(true, false, false, true), (false, true));
        assert_eq!(after(true, false, true, true), (true, false));
        assert_eq!(after(false, true, false, false), (false, true));
    }
}
