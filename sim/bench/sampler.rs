//! The content of DATA when a design sampled it.

use super::{half_time, Link};
use crate::{line::Sample, Time, US};

/// A sample is evaluated when the line has advanced by this time, so that the next change is known.
const SETTLES: Time = 20 * US;

/// Keeps the samples of one link.
#[derive(Clone, Debug, Default)]
pub(super) struct Sampler {
    /// Half cycles from the pin to the strobe of the sampled level.
    pub latency_halves: u64,
    /// Times of samples that are not evaluated yet.
    open: Vec<Time>,
    /// Evaluated samples.
    pub samples: Vec<Sample>,
}

impl Sampler {
    /// Notes that the design samples in this cycle; `is_first`: half a cycle before.
    pub fn strobe(&mut self, cycle: u64, system_hz: u64, is_first: bool) {
        let pin = (2 * cycle).saturating_sub(self.latency_halves + u64::from(is_first));
        self.open.push(half_time(pin, system_hz));
    }

    /// True if samples wait to be evaluated.
    pub fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// Evaluates all samples that are certain by now, and lets the line drop older history.
    pub fn look_up(&mut self, link: &mut Link, now: Time) {
        let line = link.line();
        let settled = |t: &Time| t + SETTLES < now || line.sample(*t).until.is_some();
        let ready = self.open.iter().take_while(|t| settled(t)).count();
        for time in self.open.drain(..ready) {
            self.samples.push(link.line().sample(time));
        }
        let oldest = self.open.first().copied().unwrap_or(now);
        let keep = oldest.min(now.saturating_sub(SETTLES));
        link.line_mut().forget_before(keep);
    }
}
