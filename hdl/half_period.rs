//! Half-period timer: ends every half of an EnDat clock period, for the clock generator and for the receiver's cells.
//!
//! ```text
//! restart   ~\________________________________
//! second    ____________/~~~~~~~~~~~~~\______    (first half, second half)
//! tick      ___________/\____________/\______
//! ```
//!
//! A period with an odd number of cycles has a second half that is one cycle longer. The comparison is registered, so
//! the counter starts at 2.

use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Marks the last cycle of each half of a clock period.
#[derive(LogicBlock, Block)]
#[properties("properties/half_period.sv")]
pub struct HalfPeriod {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Begins a half with the next cycle; while high, it keeps the timer at the beginning.
    pub restart: Signal<In, Bit>,
    /// With `restart`: the half began with this cycle.
    pub began: Signal<In, Bit>,
    /// High in the second half of the period.
    pub second: Signal<In, Bit>,
    /// The next half is one cycle shorter; for halves of at least 4 cycles.
    pub shorten: Signal<In, Bit>,
    /// The next half is one cycle longer.
    pub lengthen: Signal<In, Bit>,
    /// Period, in system clock cycles.
    pub period_cycles: Signal<In, Bits<11>>,
    /// High in the last cycle of a half.
    pub tick: Signal<Out, Bit>,
    /// Cycles until `tick` and one more: 1 with `tick`.
    pub left_cycles: Signal<Out, Bits<10>>,
    /// Cycles of the half under way, plus 2; compared one cycle ahead.
    #[start(2.into())]
    count: Reg<Bits<10>>,
    /// High in the last cycle of a half, unless it is a longer second half.
    hit: Reg<Bit>,
    /// High if the period has an odd number of cycles.
    is_odd: Reg<Bit>,
    /// High one cycle after `hit`: last cycle of a second half that is one cycle longer.
    hit_late: Reg<Bit>,
    /// Length of a half, in system clock cycles, rounded down.
    half_cycles: Signal<Local, Bits<10>>,
    /// High in the last cycle of the half.
    tick_now: Signal<Local, Bit>,
    /// High if a half is a single cycle.
    is_one: Signal<Local, Bit>,
    /// 1 if `began` can come with halves of two cycles.
    has_snap: Constant<Bit>,
    /// 1 if halves of a single cycle are supported.
    has_one: Constant<Bit>,
}

impl HalfPeriod {
    /// A timer for halves of at least two cycles, of one if `has_one`; `began` may come with halves of two cycles if `has_snap`.
    pub fn new(has_snap: bool, has_one: bool) -> Self {
        Self::from_parts(HalfPeriodParts {
            has_snap: Constant::new(has_snap),
            has_one: Constant::new(has_one),
        })
    }
}

#[kernel]
impl Logic for HalfPeriod {
    fn update(&mut self) {
        self.half_cycles.next = self.period_cycles.val().get_bits::<10>(1);
        self.tick_now.next = self.hit.q.val();
        // Registered, because the clock period may be selected late in the cycle.
        self.is_odd.d.next = self.period_cycles.val().get_bit(0);
        if self.second.val() & self.is_odd.q.val() {
            self.tick_now.next = self.hit_late.q.val();
        }
        self.is_one.next = self.has_one.val() & (self.half_cycles.val() == 1);
        self.hit.d.next = (self.count.q.val() == self.half_cycles.val()) | self.is_one.val();
        self.hit_late.d.next = self.hit.q.val();
        self.count.d.next = self.count.q.val() + 1;
        if self.restart.val() | self.tick_now.val() {
            self.count.d.next = 2.into();
            self.hit.d.next = self.is_one.val();
            self.hit_late.d.next = false;
        }
        if self.tick_now.val() & self.shorten.val() {
            self.count.d.next = 3.into();
        }
        if self.tick_now.val() & self.lengthen.val() {
            self.count.d.next = 1.into();
        }
        if self.restart.val() & self.began.val() {
            self.count.d.next = 3.into();
            // A half of two cycles ends at once.
            self.hit.d.next = self.has_snap.val() & (self.half_cycles.val() == 2);
        }
        self.tick.next = self.tick_now.val();
        self.left_cycles.next = self.half_cycles.val()
            + bit_cast::<10, 1>((self.second.val() & self.period_cycles.val().get_bit(0)).into())
            + 2
            - self.count.q.val();
    }
}
