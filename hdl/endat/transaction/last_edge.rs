//! Last edge: detects when the last rising edge of CLOCK has come back; the recovery time counts from it.
//!
//! ```text
//! center     /\__/\__/\__/\______    between two samples; the edge is in the middle after the last bit
//! last_bit   ___/\_______________    the last bit is sampled
//! in_tail    _________/~~~\______    double edge: the answer has been processed, some cells later
//! comes      ____________/\______    the timer begins here
//! ago_cycles             2           with the cycles that have passed
//! ```
//!
//! The cable never carries more pulses than the answer needs. If all are sent before the answer begins, CLOCK is held LOW, and the edge comes a cell
//! later.

use crate::endat::features::Features;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Finds the beginning of the recovery time.
#[derive(LogicBlock, Block)]
pub struct LastEdge {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: a frame begins.
    pub start: Signal<In, Bit>,
    /// All pulses of the answer are sent, or on their way to the pin.
    pub no_pulse_left: Signal<In, Bit>,
    /// One pulse of the answer is left.
    pub one_pulse_left: Signal<In, Bit>,
    /// Strobe: the last pulse is counted in this cycle.
    pub last_sent: Signal<In, Bit>,
    /// Strobe: CLOCK rises in the next cycle.
    pub will_rise: Signal<In, Bit>,
    /// All sent pulses have come back.
    pub none_under_way: Signal<In, Bit>,
    /// The start bit has been received.
    pub started: Signal<In, Bit>,
    /// The clock continues after this answer.
    pub going: Signal<In, Bit>,
    /// Pulses are being sent.
    pub running: Signal<In, Bit>,
    /// Strobe: a cycle ago was the middle between two samples.
    pub was_center: Signal<In, Bit>,
    /// Strobe: the last bit before the tail has been sampled; used with double edge only.
    pub last_bit: Signal<In, Bit>,
    /// The answer has been processed; the cell after it continues.
    pub in_tail: Signal<In, Bit>,
    /// The cell after the answer is over.
    pub in_recovery: Signal<In, Bit>,
    /// The HIGH after the answer has been sampled.
    pub tail_sampled: Signal<In, Bit>,
    /// A supplement ends the frame, so no edge is late.
    pub in_supplement: Signal<In, Bit>,
    /// Strobe: the edge has come back, `ago_cycles` ago; repeated if it came later than expected.
    pub comes: Signal<Out, Bit>,
    /// Cycles since then, in system clock cycles; stable in the cycle after `comes`.
    pub ago_cycles: Signal<Out, Bits<3>>,
    /// All pulses are sent.
    pub all_sent: Signal<Out, Bit>,
    /// CLOCK must be held LOW.
    pub holds: Signal<Out, Bit>,
    /// CLOCK waits for the pulses on the cable.
    pub stalled: Signal<Out, Bit>,
    has_double: Constant<Bit>,
    /// High if all pulses of the answer are sent.
    sent: Reg<Bit>,
    /// `one_pulse_left`, one cycle later.
    one_left: Reg<Bit>,
    /// Set when CLOCK is held LOW because the start bit is late; cleared when no pulse is under way.
    stall: Reg<Bit>,
    /// High if all pulses are sent and the start bit has not come yet.
    holds_now: Signal<Local, Bit>,
    /// Set when CLOCK is held LOW: the last edge comes one cell later. Cleared in that cell, or by a start.
    waited: Reg<Bit>,
    /// Set when the last bit is sampled; cleared when the last edge comes back (double edge only).
    due: Reg<Bit>,
    /// System clock cycles since the last edge came back; counts until `comes` (double edge only).
    ago: Reg<Bits<3>>,
    /// High for one cycle when a last edge that is still due comes back.
    is_there: Signal<Local, Bit>,
    /// High for one cycle: the recovery time begins, or begins anew with a later edge.
    comes_now: Signal<Local, Bit>,
}

impl LastEdge {
    /// For a channel with these features.
    pub fn new(features: Features) -> Self {
        Self::from_parts(LastEdgeParts {
            has_double: Constant::new(features.double_edge),
        })
    }
}

#[kernel]
impl Logic for LastEdge {
    fn update(&mut self) {
        self.sent.d.next = self.no_pulse_left.val() | self.last_sent.val();
        // With two system clock cycles in a bit there is no time to count this pulse.
        if self.has_double.val() {
            self.one_left.d.next = self.one_pulse_left.val();
            self.sent.d.next =
                self.no_pulse_left.val() | (self.one_left.q.val() & self.will_rise.val());
        }
        self.holds_now.next = self.sent.q.val() & !self.started.val() & !self.going.val();
        if self.holds_now.val() {
            self.stall.d.next = true;
        }
        if self.none_under_way.val() | !self.running.val() {
            self.stall.d.next = false;
        }
        self.all_sent.next = self.sent.q.val();
        self.stalled.next = self.stall.q.val();
        self.holds.next = self.stall.q.val() | (self.has_double.val() & self.holds_now.val());

        self.is_there.next = self.was_center.val() & self.waited.q.val();
        if self.has_double.val() {
            self.is_there.next = self.was_center.val() & self.due.q.val() & !self.waited.q.val();
        }
        self.comes_now.next = (self.in_tail.val() & self.was_center.val())
            | (self.in_recovery.val() & self.is_there.val() & !self.tail_sampled.val());
        self.comes.next = self.comes_now.val();

        if self.holds_now.val() {
            self.waited.d.next = true;
        }
        if self.was_center.val()
            & (self.in_recovery.val() | (self.has_double.val() & self.due.q.val()))
        {
            self.waited.d.next = false;
        }
        if self.start.val() {
            self.waited.d.next = false;
        }

        // With few cycles in a bit the edge has come back before the answer was processed.
        self.ago_cycles.next = 0.into();
        if self.has_double.val() {
            if self.is_there.val() {
                self.due.d.next = false;
            }
            if !self.due.q.val() | self.is_there.val() {
                self.ago.d.next = self.ago.q.val() + 1;
            }
            if self.comes_now.val() | self.in_recovery.val() {
                self.ago.d.next = self.ago.q.val();
            }
            if self.last_bit.val() {
                self.due.d.next = true;
                self.ago.d.next = 0.into();
            }
            if self.in_supplement.val() {
                self.ago.d.next = 0.into();
            }
            self.ago_cycles.next = self.ago.q.val();
        }
    }
}
