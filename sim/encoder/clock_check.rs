//! Checks the limits of the clock.

use super::{Encoder, Violation};
use crate::{Time, US};
use std::ops::RangeInclusive;

/// The rising edges used to measure the clock period.
pub(super) const PERIOD_EDGES: RangeInclusive<u32> = 1..=10;
/// Slowest clock of the interface: 100 kHz.
const LONGEST_PERIOD: Time = 10 * US;
/// Tolerance of a mean rate, as a part of the clock period.
const RATE_TOLERANCE: f64 = 0.005;

impl Encoder {
    /// Measures the clock period at its last edge.
    pub(super) fn check_rate(&mut self, time: Time) {
        let log = self.log();
        let edges = PERIOD_EDGES.end() - PERIOD_EDGES.start();
        log.period = (time - log.first_rise) / Time::from(edges);
        let period = log.period;
        let shortest = 1e12 / self.config.max_clock_hz as f64;
        if (period as f64) < shortest * (1.0 - RATE_TOLERANCE)
            || period as f64 > LONGEST_PERIOD as f64 * (1.0 + RATE_TOLERANCE)
        {
            self.violate(time, Violation::ClockRate { period });
        }
        let fast = self.work.command.is_some_and(|c| c.is_endat22());
        if fast && self.short_recovery() && period >= US {
            self.violate(time, Violation::ShortRecoveryTooSlow { period });
        }
    }

    pub(super) fn check_high(&mut self, time: Time, width: Time) {
        let (half, slack) = self.half_period();
        if width.abs_diff(half) > slack {
            let edge = self.log().rising_edges;
            self.violate(
                time,
                Violation::PulseWidth {
                    high: true,
                    width,
                    edge,
                },
            );
        }
    }

    /// A long LOW is a legal pause; a short one is not.
    pub(super) fn check_low(&mut self, time: Time, width: Time) {
        let edge = self.log().rising_edges + 1;
        if edge == 2 && self.work.nominal == 0 {
            self.work.nominal = width + self.work.last_high;
            self.check_high(time, self.work.last_high);
        }
        let (half, slack) = self.half_period();
        if width + slack < half {
            self.violate(
                time,
                Violation::PulseWidth {
                    high: false,
                    width,
                    edge,
                },
            );
        }
    }

    /// Half a clock period and the tolerance of a phase; before the period is known, for the fastest clock.
    fn half_period(&self) -> (Time, Time) {
        let period = match self.work.nominal {
            0 => 1_000_000_000_000 / self.config.max_clock_hz,
            known => known,
        };
        (
            period / 2,
            (period as f64 * self.config.pulse_variation) as Time + 1,
        )
    }
}
