//! Sure bit: a flag that, with guards, one upset does not set.
//!
//! ```text
//! raise    __/\__________________
//! clear    ____________/\________
//! yes      ____/~~~~~~~~~\_______
//! no       ~~~~\_________/~~~~~~~
//! is_set   ____/~~~~~~~~~\_______    yes and not no; both alike: an upset, and it is clear again (without guards: yes)
//! ```
//!
//! For what would begin something that nobody has asked for: a request sent once more, a clock that goes on.

use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// A flag.
#[derive(LogicBlock, Block)]
pub struct SureBit {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: set it; stronger than `clear`.
    pub raise: Signal<In, Bit>,
    /// Strobe: clear it.
    pub clear: Signal<In, Bit>,
    /// It is set.
    pub is_set: Signal<Out, Bit>,
    /// High while the bit is set.
    yes: Reg<Bit>,
    /// Complement of `yes`; both alike mean an upset.
    #[start(true)]
    no: Reg<Bit>,
    /// 1 if the complement is stored and compared.
    has_guards: Constant<Bit>,
}

impl SureBit {
    /// In two registers with guards, in one without.
    pub fn new(guards: bool) -> Self {
        Self::from_parts(SureBitParts {
            has_guards: Constant::new(guards),
        })
    }
}

#[kernel]
impl Logic for SureBit {
    fn update(&mut self) {
        if self.clear.val() | (self.has_guards.val() & (self.yes.q.val() == self.no.q.val())) {
            self.yes.d.next = false;
            self.no.d.next = true;
        }
        if self.raise.val() {
            self.yes.d.next = true;
            self.no.d.next = false;
        }
        self.is_set.next = self.yes.q.val() & !(self.has_guards.val() & self.no.q.val());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::settle;

    /// A bit with these registers, one clock edge later.
    fn after(yes: bool, no: bool, set: bool, clear: bool) -> (bool, bool) {
        let mut block = SureBit::new(true);
        block.connect_all();
        block.yes.q.next = yes;
        block.no.q.next = no;
        block.raise.next = set;
        block.clear.next = clear;
        settle(&mut block);
        (block.yes.d.val(), block.no.d.val())
    }

    #[test]
    fn two_that_are_alike_are_clear() {
        for (yes, no) in [(false, false), (true, true)] {
            assert_eq!(after(yes, no, false, false), (false, true));
            assert_eq!(after(yes, no, true, false), (true, false));
        }
        assert_eq!(after(true, false, false, false), (true, false));
        assert_eq!(after(true, false, false, true), (false, true));
        assert_eq!(after(true, false, true, true), (true, false));
        assert_eq!(after(false, true, false, false), (false, true));
    }
}
