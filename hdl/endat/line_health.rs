//! Line health: stuck and open data lines, and the watchdog of a frame.
//!
//! ```text
//! start       /\_____________________________
//! level       ________/~~\___________________    HIGH once: the line is not stuck LOW
//! under_way   _/~~~~~~~~~~~~~~~~~~~~\________
//! expired     ___________________/~~\________    watchdog_us after the start
//!
//! probe       ___/~~~~~~~~\__________________    DATA is HIGH at rest: driven LOW briefly
//! level       ~~~~~\______/~~~~~~~~~~~~~~~~~~    it follows: no other driver
//! ```
//!
//! A receiver receives its own mode command, so a frame without any HIGH means that the line, or its receiver, is stuck.
//! The transceiver must keep receiving while it sends.

use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Stuck lines, absent encoders and the watchdog of one channel.
#[derive(LogicBlock, Block)]
pub struct LineHealth {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// The data line.
    pub level: Signal<In, Bit>,
    /// Strobe: a frame begins.
    pub start: Signal<In, Bit>,
    /// A watched frame, or its recovery time, is under way.
    pub under_way: Signal<In, Bit>,
    /// Longest time from the start to the end of the recovery time; 0 = not watched.
    pub watchdog_us: Signal<In, Bits<12>>,
    /// Strobe: the line has been driven LOW for long enough; `level` shows whether it follows.
    pub probed: Signal<In, Bit>,
    /// DATA has been LOW for tR.
    pub is_ready: Signal<In, Bit>,
    /// `watchdog_us` have passed.
    pub expired: Signal<Out, Bit>,
    /// DATA has not been HIGH since the start.
    pub never_high: Signal<Out, Bit>,
    /// DATA is HIGH because no device drives it.
    pub is_open: Signal<Out, Bit>,
    /// DATA is HIGH even when the receiver drives it LOW.
    pub is_stuck: Signal<Out, Bit>,
    /// Microseconds since the frame began.
    passed_us: Reg<Bits<12>>,
    /// Set when the watchdog's time has passed; cleared when the frame ends or the next one begins.
    over: Reg<Bit>,
    /// Set when DATA is HIGH; cleared when a frame begins.
    was_high: Reg<Bit>,
    /// Set if DATA follows a probe, so nothing drives it; cleared when DATA has been LOW for tR.
    open: Reg<Bit>,
    /// Set if DATA stays HIGH in a probe; cleared when DATA has been LOW for tR.
    stuck: Reg<Bit>,
}

#[kernel]
impl Logic for LineHealth {
    fn update(&mut self) {
        if self.tick_us.val() {
            self.passed_us.d.next = self.passed_us.q.val() + 1;
        }
        self.over.d.next = self.under_way.val()
            & self.watchdog_us.val().any()
            & (self.over.q.val() | (self.passed_us.q.val() >= self.watchdog_us.val()));
        if self.level.val() {
            self.was_high.d.next = true;
        }
        if self.start.val() {
            self.passed_us.d.next = 0.into();
            self.over.d.next = false;
            self.was_high.d.next = false;
        }
        if self.probed.val() {
            self.open.d.next = !self.level.val();
            self.stuck.d.next = self.level.val();
        }
        if self.is_ready.val() {
            self.open.d.next = false;
            self.stuck.d.next = false;
        }
        self.expired.next = self.over.q.val();
        self.never_high.next = !self.was_high.q.val();
        self.is_open.next = self.open.q.val();
        self.is_stuck.next = self.stuck.q.val();
    }
}
