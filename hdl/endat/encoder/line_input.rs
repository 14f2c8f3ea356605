//! Line input: brings CLOCK and DATA of the receiver into the system clock domain, and marks the edges of CLOCK.
//!
//! ```text
//! clock_pin --[SyncReg x2]--+-- level ----------> rise, fall
//!                           \--[Reg]-- level_before --^
//! data_pin  --[SyncReg x2]-- data
//! ```
//!
//! Both pins have the same delay. So `data` in the cycle of `rise` is DATA at the pin when CLOCK rose, to within one system clock cycle.

use rtl_design::reg::{Reg, SyncReg};
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Synchronisers of the encoder's two input pins, and edges of CLOCK.
#[derive(LogicBlock, Block)]
pub struct LineInput {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// CLOCK at the pin, asynchronous.
    pub clock_pin: Signal<In, Bit>,
    /// DATA at the pin, asynchronous.
    pub data_pin: Signal<In, Bit>,
    /// High for one cycle when CLOCK has risen.
    pub rise: Signal<Out, Bit>,
    /// High for one cycle when CLOCK has fallen.
    pub fall: Signal<Out, Bit>,
    /// CLOCK, one cycle later: in the cycle of `rise` or `fall` the level before the edge.
    pub level_before: Signal<Out, Bit>,
    /// DATA; sample it with `rise`.
    pub data: Signal<Out, Bit>,
    /// CLOCK, first synchroniser stage.
    #[start(true)]
    clock_1: SyncReg<Bit>,
    /// CLOCK, second synchroniser stage.
    #[start(true)]
    clock_2: SyncReg<Bit>,
    /// CLOCK after the synchroniser, one cycle later.
    #[start(true)]
    before: Reg<Bit>,
    /// DATA, first synchroniser stage.
    data_1: SyncReg<Bit>,
    /// DATA, second synchroniser stage.
    data_2: SyncReg<Bit>,
}

#[kernel]
impl Logic for LineInput {
    fn update(&mut self) {
        self.clock_1.d.next = self.clock_pin.val();
        self.clock_2.d.next = self.clock_1.q.val();
        self.before.d.next = self.clock_2.q.val();
        self.data_1.d.next = self.data_pin.val();
        self.data_2.d.next = self.data_1.q.val();
        self.rise.next = self.clock_2.q.val() & !self.before.q.val();
        self.fall.next = !self.clock_2.q.val() & self.before.q.val();
        self.level_before.next = self.before.q.val();
        self.data.next = self.data_2.q.val();
    }
}
