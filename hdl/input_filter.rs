//! Input filter: brings the asynchronous data line into the system clock domain and removes short pulses.
//!
//! ```text
//! pin --[SyncReg x3]--> stable for filter_cycles + 1 samples? --[Reg]--> level, rise
//! ```
//!
//! The delay it adds is part of the propagation delay that the receiver measures, so it needs no correction.

use crate::reg::{Reg, SyncReg};
use rust_hdl::prelude::*;

/// Synchroniser of three stages and a run-time filter for one input pin.
#[derive(LogicBlock, Default)]
pub struct InputFilter {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// The pin, asynchronous.
    pub pin: Signal<In, Bit>,
    /// A pulse of at most this many samples is ignored; 0 switches the filter off.
    pub filter_cycles: Signal<In, Bits<4>>,
    /// The level after synchroniser and filter.
    pub level: Signal<Out, Bit>,
    /// High in the first cycle in which `level` is high.
    pub rise: Signal<Out, Bit>,
    sync1: SyncReg<Bit>,
    sync2: SyncReg<Bit>,
    sync3: SyncReg<Bit>,
    different: Reg<Bits<4>>,
    level_now: Reg<Bit>,
    rise_now: Reg<Bit>,
}

impl Logic for InputFilter {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, sync1, sync2, sync3);
        dff_setup!(self, clock, different, level_now, rise_now);
        self.sync1.reset.next = self.reset.val();
        self.sync2.reset.next = self.reset.val();
        self.sync3.reset.next = self.reset.val();
        self.different.reset.next = self.reset.val();
        self.level_now.reset.next = self.reset.val();
        self.rise_now.reset.next = self.reset.val();
        self.sync1.d.next = self.pin.val();
        self.sync2.d.next = self.sync1.q.val();
        self.sync3.d.next = self.sync2.q.val();
        self.rise_now.d.next = false;
        self.different.d.next = 0.into();
        if self.sync3.q.val() != self.level_now.q.val() {
            if self.different.q.val() == self.filter_cycles.val() {
                self.level_now.d.next = self.sync3.q.val();
                self.rise_now.d.next = self.sync3.q.val();
            } else {
                self.different.d.next = self.different.q.val() + 1;
            }
        }
        self.level.next = self.level_now.q.val();
        self.rise.next = self.rise_now.q.val();
    }
}
