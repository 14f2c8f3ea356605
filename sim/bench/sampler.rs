//! What was on DATA at the moments at which a design sampled it.

use super::{half_time, Link};
use crate::{line::Sample, Time, US};

/// A sample is looked up when the line has gone on for this long, so that the next change is known.
const SETTLES: Time = 20 * US;

/// Keeps the samples of one link.
#[derive(Clone, Debug, Default)]
pub(super) struct Sampler {
    /// How many half cycles before the strobe's the sampled level was at the pin.
    pub latency_halves: u64,
    /// Moments at which DATA was sampled, not yet looked up in the line's history.
    open: Vec<Time>,
    /// The samples that have been looked up.
    pub samples: Vec<Sample>,
}

impl Sampler {
    /// Notes that the design takes a sample in this cycle; `is_first`: the one half a cycle before.
    pub fn strobe(&mut self, cycle: u64, system_hz: u64, is_first: bool) {
        let pin = (2 * cycle).saturating_sub(self.latency_halves + u64::from(is_first));
        self.open.push(half_time(pin, system_hz));
    }

    /// Whether samples wait to be looked up.
    pub fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// Looks up what can be known by now, and lets the line forget what was before.
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
