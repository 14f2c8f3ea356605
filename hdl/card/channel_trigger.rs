//! Trigger of one channel, if channels have separate triggers: ignored sources, divider, enable.
//!
//! ```text
//! sources' hits --> not ignored, not disabled --> every (skip + 1)-th --> register --> trigger
//! ring: settings --(ring at rest)-----^           ^-- restart: all channels count from here
//! ```
//!
//! Channels with equal settings trigger in the same cycle: settings take effect in the same cycle, busy or not, and a write to one of
//! them restarts the count of all channels. The strobe is in the cycle of the card's strobe.

use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Bits of `skip`.
pub const SKIP_BITS: u32 = 5;

/// Trigger of a channel.
#[derive(LogicBlock, Block)]
pub struct ChannelTrigger {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Enabled sources that trigger in the next cycle: bit 0 pin, bit 1 timer, bit 2 register.
    pub hits: Signal<In, Bits<3>>,
    /// The settings below are valid; otherwise the ring is turning.
    pub home: Signal<In, Bit>,
    /// Sources that this channel ignores, as `hits`.
    pub ignored_sources: Signal<In, Bits<3>>,
    /// Triggers to skip after each accepted one.
    pub skip: Signal<In, Bits<5>>,
    /// The channel ignores triggers.
    pub off: Signal<In, Bit>,
    /// Strobe: the next trigger is accepted, and counting restarts.
    pub restart: Signal<In, Bit>,
    /// One-cycle strobe to the channel, from a register.
    pub trigger: Signal<Out, Bit>,
    /// The channel ignores triggers.
    pub disabled: Signal<Out, Bit>,
    /// Sources that do not trigger this channel; copied from the ring while it is at rest.
    #[given]
    ignored: Reg<Bits<3>>,
    /// Triggers to skip after each accepted one; copied from the ring while it is at rest.
    #[given]
    skipped: Reg<Bits<5>>,
    /// High if the channel ignores triggers; copied from the ring while it is at rest.
    #[given]
    is_off: Reg<Bit>,
    /// Triggers left to skip; cleared by `restart`.
    left: Reg<Bits<5>>,
    /// High for one cycle when the channel triggers.
    strobe: Reg<Bit>,
    /// High if an enabled source that this channel does not ignore has a hit.
    own: Signal<Local, Bit>,
    /// High if no trigger is left to skip.
    is_due: Signal<Local, Bit>,
}

impl ChannelTrigger {
    /// A trigger with these settings after reset, as the inputs of the same names.
    pub fn new(ignored_sources: u64, skip: u64, off: bool) -> Self {
        Self::from_parts(ChannelTriggerParts {
            ignored: Reg::new(ignored_sources.into()),
            skipped: Reg::new(skip.into()),
            is_off: Reg::new(off),
        })
    }
}

#[kernel]
impl Logic for ChannelTrigger {
    fn update(&mut self) {
        self.left.reset.next = self.reset.val() | self.restart.val();

        if self.home.val() {
            self.ignored.d.next = self.ignored_sources.val();
            self.skipped.d.next = self.skip.val();
            self.is_off.d.next = self.off.val();
        }
        self.own.next = (self.hits.val() & !self.ignored.q.val()).any();
        self.is_due.next = !self.left.q.val().any();
        if self.own.val() {
            self.left.d.next = self.left.q.val() - 1;
            if self.is_due.val() {
                self.left.d.next = self.skipped.q.val();
            }
        }
        self.strobe.d.next = self.own.val() & self.is_due.val() & !self.is_off.q.val();
        self.trigger.next = self.strobe.q.val();
        self.disabled.next = self.is_off.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::tick;

    fn step(uut: &mut ChannelTrigger, hits: u64) -> bool {
        uut.hits.next = hits.into();
        tick(uut, |u, level| u.clock.next = level.into());
        uut.trigger.val()
    }

    fn set(uut: &mut ChannelTrigger, ignored: u64, skip: u64, off: bool) {
        uut.ignored_sources.next = ignored.into();
        uut.skip.next = skip.into();
        uut.off.next = off;
        uut.home.next = true;
        step(uut, 0);
        uut.home.next = false;
    }

    fn restart(uut: &mut ChannelTrigger) {
        uut.restart.next = true;
        step(uut, 0);
        uut.restart.next = false;
    }

    #[test]
    fn one_of_so_many_of_the_sources_that_are_not_ignored() {
        let mut uut = ChannelTrigger::new(0, 0, false);
        uut.connect_all();
        for (ignored, skip) in [(0, 0), (0, 1), (2, 0), (5, 3), (3, 31), (7, 0)] {
            set(&mut uut, ignored, skip, false);
            restart(&mut uut);
            let mut count = 0u64;
            for n in 0..200u64 {
                let hits = [1, 2, 4, 3, 0][n as usize % 5];
                let own = hits & !ignored != 0;
                let expected = own && count.is_multiple_of(skip + 1);
                count += u64::from(own);
                assert_eq!(step(&mut uut, hits), expected, "{ignored} {skip} {n}");
            }
        }
    }

    #[test]
    fn a_disabled_channel_counts_but_does_not_trigger() {
        let mut uut = ChannelTrigger::new(0, 2, true);
        uut.connect_all();
        step(&mut uut, 0);
        assert!((0..4).all(|_| !step(&mut uut, 1)) && uut.disabled.val());
        set(&mut uut, 0, 2, false);
        assert_eq!(
            [0, 1, 2, 3].map(|_| step(&mut uut, 1)),
            [false, false, true, false]
        );
    }
}
