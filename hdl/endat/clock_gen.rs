//! Clock generator: the EnDat clock of one frame, and a strobe for each of its edges.
//!
//! ```text
//! start       /\___________________________________
//! hold_low    __/~~~~~~~~\________________________    tST, or too many pulses in flight
//! endat_clk   ~~\_____________/~~~~\____/~~~~\____
//! fall        /\___________________/\________/\___
//! rise        _________________/\________/\_______
//! ```
//!
//! The line idles HIGH, and every frame ends HIGH, an aborted one as well. A whole half period follows a low phase that was held,
//! and a low phase that has begun is finished: no pulse is ever shortened.

use crate::endat::features::Features;
use crate::half_period::HalfPeriod;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// EnDat clock generator of one channel.
#[derive(LogicBlock, Block)]
#[properties("../properties/clock_gen.sv")]
pub struct ClockGen {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe: the first falling edge comes at the end of this cycle.
    pub start: Signal<In, Bit>,
    /// Keeps a low phase low.
    pub hold_low: Signal<In, Bit>,
    /// Keeps a high phase high: no frame, or its last rising edge has been sent.
    pub stop: Signal<In, Bit>,
    /// Period, in system clock cycles; if odd, the high phase is longer.
    pub period_cycles: Signal<In, Bits<11>>,
    /// The EnDat clock, one cycle before it reaches the pin.
    pub endat_clk: Signal<Out, Bit>,
    /// High in the last cycle before a rising edge.
    pub will_rise: Signal<Out, Bit>,
    /// High in the first cycle after a rising edge.
    pub rise: Signal<Out, Bit>,
    /// High in the last cycle before a falling edge.
    pub fall: Signal<Out, Bit>,
    half: HalfPeriod,
    /// Level of the EnDat clock; set with a rising edge, cleared with the start or a falling edge.
    #[start(true)]
    level: Reg<Bit>,
    /// High in the first cycle after a rising edge.
    risen: Reg<Bit>,
    /// High in the last cycle before a rising edge.
    rise_now: Signal<Local, Bit>,
    /// High in the last cycle before a falling edge, except the first one.
    fall_now: Signal<Local, Bit>,
    /// High while a low phase is held.
    held: Signal<Local, Bit>,
}

impl ClockGen {
    /// A clock generator with these features.
    pub fn new(features: Features) -> Self {
        Self::from_parts(ClockGenParts {
            half: HalfPeriod::new(false, features.double_edge),
        })
    }
}

#[kernel]
impl Logic for ClockGen {
    fn update(&mut self) {
        clock!(self, clock, half);
        connect!(self.half <= self; reset, period_cycles);
        self.half.second.next = self.level.q.val();
        self.half.began.next = false;
        self.half.shorten.next = false;
        self.half.lengthen.next = false;
        self.held.next = self.hold_low.val() & !self.level.q.val();
        self.half.restart.next = self.start.val() | self.held.val();
        self.rise_now.next = self.half.tick.val() & !self.level.q.val() & !self.held.val();
        self.fall_now.next = self.half.tick.val() & self.level.q.val() & !self.stop.val();
        if self.rise_now.val() {
            self.level.d.next = true;
        }
        if self.start.val() | self.fall_now.val() {
            self.level.d.next = false;
        }
        self.endat_clk.next = self.level.q.val();
        self.will_rise.next = self.rise_now.val();
        self.rise.next = self.risen.q.val();
        self.risen.d.next = self.rise_now.val();
        self.fall.next = self.fall_now.val();
    }
}
