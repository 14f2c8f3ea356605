//! Time base: the microsecond strobe and the free-running time in system clock cycles.
//!
//! ```text
//! count     0 1 2 ..  98 99 0 1 2 ..
//! tick_us   _____________/~\________   one cycle in each microsecond
//! timestamp counts every cycle and wraps
//! ```

use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Fastest system clock that the microsecond counter can divide, in hertz.
pub const SYSTEM_HZ_MAX: u64 = 256_000_000;

/// Microsecond strobe and time stamp counter.
#[derive(LogicBlock, Block)]
pub struct Timebase {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// High for one cycle each microsecond.
    pub tick_us: Signal<Out, Bit>,
    /// System clock cycles since reset, wrapping.
    pub timestamp: Signal<Out, Bits<32>>,
    /// System clock cycles of the current microsecond, from 0.
    count: Reg<Bits<8>>,
    /// High for one cycle each microsecond.
    tick: Reg<Bit>,
    /// System clock cycles since reset, wrapping.
    cycles: Reg<Bits<32>>,
    /// High in the last cycle of a microsecond.
    hit: Signal<Local, Bit>,
    /// System clock cycles in a microsecond, minus one.
    last_count: Constant<Bits<8>>,
}

/// System clock cycles in a microsecond, to the nearest cycle and within the range of the counter.
pub const fn cycles_per_us(system_hz: u64) -> u64 {
    let cycles = (system_hz + 500_000) / 1_000_000;
    if cycles < 1 {
        1
    } else if cycles > SYSTEM_HZ_MAX / 1_000_000 {
        SYSTEM_HZ_MAX / 1_000_000
    } else {
        cycles
    }
}

impl Timebase {
    /// A time base for a system clock of `system_hz`.
    pub fn new(system_hz: u64) -> Self {
        Self::from_parts(TimebaseParts {
            last_count: Constant::new((cycles_per_us(system_hz) - 1).into()),
        })
    }
}

#[kernel]
impl Logic for Timebase {
    fn update(&mut self) {
        self.hit.next = self.count.q.val() == self.last_count.val();
        self.count.d.next = self.count.q.val() + 1;
        if self.hit.val() {
            self.count.d.next = 0.into();
        }
        self.tick.d.next = self.hit.val();
        self.cycles.d.next = self.cycles.q.val() + 1;
        self.tick_us.next = self.tick.q.val();
        self.timestamp.next = self.cycles.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::tick;

    #[test]
    fn strobe_comes_once_in_a_microsecond_and_time_counts_cycles() {
        for system_hz in [1_000_000, 8_000_000, 100_000_000, 128_000_000, 256_000_000] {
            let mut uut = Timebase::new(system_hz);
            uut.connect_all();
            let mut strobes = Vec::new();
            for cycle in 0..1_100 {
                tick(&mut uut, |u, level| u.clock.next = level.into());
                assert_eq!(uut.timestamp.val().to_u64(), cycle + 1);
                if uut.tick_us.val() {
                    strobes.push(cycle);
                }
            }
            assert!(strobes.len() >= 3);
            assert!(strobes
                .windows(2)
                .all(|w| w[1] - w[0] == system_hz / 1_000_000));
        }
    }
}
