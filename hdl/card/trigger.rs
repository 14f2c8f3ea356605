//! Triggers: three sources, one strobe for all channels. A card with separate channel triggers derives them from the same hits
//! ([`crate::card::channel_trigger`]).
//!
//! ```text
//! trigger pin -> synchroniser -> rising edge --+
//! timer, every period_cycles ------------------+-- enabled? --> register --> trigger, trigger_count
//! register strobe -----------------------------+
//! ```
//!
//! Sources that coincide make one trigger. The strobe begins with the third clock edge that samples the pin high, and with the
//! first that samples the register strobe.

use rtl_design::reg::{Reg, SyncReg};
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Shortest period of the timer, in system clock cycles.
pub const PERIOD_CYCLES_MIN: u64 = 4;
/// Bits of the timer period.
pub const PERIOD_BITS: usize = 24;

/// Trigger sources of the card.
#[derive(LogicBlock, Block)]
pub struct Trigger {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Trigger pin, asynchronous; a rising edge triggers.
    pub pin: Signal<In, Bit>,
    /// Strobe from the host.
    pub register: Signal<In, Bit>,
    /// Enabled sources: bit 0 pin, bit 1 timer, bit 2 register.
    pub sources: Signal<In, Bits<3>>,
    /// Period of the timer, at least 4 system clock cycles.
    pub period_cycles: Signal<In, Bits<24>>,
    /// Enabled sources that trigger in the next cycle, as `sources`.
    pub hits: Signal<Out, Bits<3>>,
    /// One-cycle strobe to all channels, from a register.
    pub trigger: Signal<Out, Bit>,
    /// Triggers since reset, wrapping.
    pub trigger_count: Signal<Out, Bits<32>>,
    /// Trigger pin, first synchroniser stage; starts HIGH, so that a pin HIGH at power-up is not an edge.
    #[start(true)]
    sync0: SyncReg<Bit>,
    /// Trigger pin, second synchroniser stage.
    #[start(true)]
    sync1: SyncReg<Bit>,
    /// Trigger pin one cycle before `sync1`, to find the edge.
    #[start(true)]
    sync2: SyncReg<Bit>,
    /// Counts the timer period; held at its start while the timer source is disabled.
    #[start(TIMER_FIRST.into())]
    timer: Reg<Bits<24>>,
    /// High if the low half of the timer was equal to that of the period one cycle ago.
    timer_hit_low: Reg<Bit>,
    /// High if the high half of the timer was equal to that of the period one cycle ago.
    timer_hit_high: Reg<Bit>,
    /// High for one cycle at the end of each timer period.
    timer_hit: Signal<Local, Bit>,
    /// High for one cycle at a rising edge of the trigger pin.
    pin_hit: Signal<Local, Bit>,
    /// Enabled sources that trigger in the next cycle, one bit each.
    hit: Signal<Local, Bits<3>>,
    /// High for one cycle at each trigger.
    strobe: Reg<Bit>,
    /// Triggers since reset, wrapping.
    count: Reg<Bits<32>>,
    /// Start value of the timer.
    timer_first: Constant<Bits<24>>,
}

/// Start value of the timer: its comparison and its restart take a cycle each.
const TIMER_FIRST: u64 = 2;

impl Default for Trigger {
    fn default() -> Self {
        Self::from_parts(TriggerParts {
            timer_first: Constant::new(TIMER_FIRST.into()),
        })
    }
}

#[kernel]
impl Logic for Trigger {
    fn update(&mut self) {
        self.sync0.d.next = self.pin.val();
        self.sync1.d.next = self.sync0.q.val();
        self.sync2.d.next = self.sync1.q.val();

        self.timer_hit_low.d.next =
            self.timer.q.val().get_bits::<12>(0) == self.period_cycles.val().get_bits::<12>(0);
        self.timer_hit_high.d.next =
            self.timer.q.val().get_bits::<12>(12) == self.period_cycles.val().get_bits::<12>(12);
        self.timer_hit.next = self.timer_hit_low.q.val() & self.timer_hit_high.q.val();
        self.timer.d.next = self.timer.q.val() + 1;
        // Restarts while disabled, so that the first period is a whole one.
        if self.timer_hit.val() | !self.sources.val().get_bit(1) {
            self.timer.d.next = self.timer_first.val();
            self.timer_hit_low.d.next = false;
        }

        self.pin_hit.next = self.sync1.q.val() & !self.sync2.q.val();
        self.hit.next = (bit_cast::<3, 1>(self.pin_hit.val().into())
            | (bit_cast::<3, 1>(self.timer_hit.val().into()) << 1)
            | (bit_cast::<3, 1>(self.register.val().into()) << 2))
            & self.sources.val();
        self.hits.next = self.hit.val();
        self.strobe.d.next = self.hit.val().any();
        if self.strobe.q.val() {
            self.count.d.next = self.count.q.val() + 1;
        }
        self.trigger.next = self.strobe.q.val();
        self.trigger_count.next = self.count.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::tick;

    fn new(sources: u64, period: u64) -> Trigger {
        let mut uut = Trigger::default();
        uut.sources.next = sources.into();
        uut.period_cycles.next = period.into();
        uut.connect_all();
        step(&mut uut);
        uut
    }

    fn step(uut: &mut Trigger) -> bool {
        tick(uut, |u, level| u.clock.next = level.into());
        uut.trigger.val()
    }

    /// Cycles of the next `n` in which the strobe is high.
    fn strobes(uut: &mut Trigger, n: u64) -> Vec<u64> {
        (1..=n).filter(|_| step(uut)).collect()
    }

    #[test]
    fn timer_period_is_exact() {
        for period in [PERIOD_CYCLES_MIN, 5, 17, 100] {
            let mut uut = new(2, period);
            let at = strobes(&mut uut, 10 * period);
            assert!(at.len() >= 9, "{period}: {at:?}");
            assert!(
                at.windows(2).all(|w| w[1] - w[0] == period),
                "{period}: {at:?}"
            );
            assert_eq!(uut.trigger_count.val().to_u64() as usize, at.len());
        }
    }

    #[test]
    fn first_period_after_enabling_is_a_whole_one() {
        let mut uut = new(0, 50);
        assert!(strobes(&mut uut, 175).is_empty());
        uut.sources.next = 2u64.into();
        let at = strobes(&mut uut, 60);
        assert_eq!(at.len(), 1);
        assert!((49..=52).contains(&at[0]), "{at:?}");
    }

    #[test]
    fn pin_triggers_once_per_rising_edge_after_a_constant_delay() {
        let mut uut = new(1, 1_000);
        for _ in 0..3 {
            uut.pin.next = true;
            assert_eq!(strobes(&mut uut, 20), [3]);
            uut.pin.next = false;
            assert!(strobes(&mut uut, 20).is_empty());
        }
    }

    #[test]
    fn a_pin_that_is_high_at_power_up_is_not_an_edge() {
        let mut uut = Trigger::default();
        uut.pin.next = true;
        uut.sources.next = 7u64.into();
        uut.period_cycles.next = 1_000u64.into();
        uut.connect_all();
        assert!(strobes(&mut uut, 20).is_empty());
    }

    #[test]
    fn a_disabled_source_does_not_trigger_and_coinciding_ones_trigger_once() {
        for (sources, expected) in [(0, 0), (1, 1), (4, 1), (5, 1)] {
            let mut uut = new(sources, 1_000);
            uut.pin.next = true;
            let mut count = 0;
            for cycle in 0..20 {
                uut.register.next = cycle == 2;
                count += u64::from(step(&mut uut));
            }
            assert_eq!(count, expected, "sources {sources}");
        }
    }
}
