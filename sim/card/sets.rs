//! Sets of the stream out of arithmetic instead of the core: as many as a host takes, or one for each trigger of real time.
//!
//! A simulated core is slower than a real one, so it can tell neither what a host does with an hour of samples nor whether it keeps up. These
//! sets are what a card without faults sends: each trigger's number and moment, positions of the encoders' own motion, no cause.

use endat_host::stream::{Sample, SampleSet};
use endat_sim::Time;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

/// Position of a channel at a time.
pub type Motion = Arc<dyn Fn(Time) -> u64 + Send + Sync>;

/// Sets that are given at once where nobody keeps time.
const BATCH: u64 = 256;

/// Makes sets.
pub struct Sets {
    motions: Vec<Motion>,
    /// From trigger to trigger, in system clock cycles, and a cycle of it.
    period_cycles: u64,
    system_hz: u64,
    has_infos: bool,
    /// Sets so far, and since the stream has begun.
    made: u64,
    since: u64,
    /// When that was, where time is kept.
    begun: Option<Instant>,
    keeps_time: bool,
}

impl Sets {
    /// Sets of these channels, one each `period_cycles` of `system_hz`.
    pub fn new(motions: Vec<Motion>, period_cycles: u64, system_hz: u64, has_infos: bool) -> Self {
        Self {
            motions,
            period_cycles,
            system_hz,
            has_infos,
            made: 0,
            since: 0,
            begun: None,
            keeps_time: false,
        }
    }

    /// From now on a set comes when its trigger would.
    pub fn keep_time(&mut self) {
        self.keeps_time = true;
    }

    /// A host wants them from now on.
    pub fn begin(&mut self) {
        self.since = self.made;
        self.begun = Some(Instant::now());
    }

    /// Triggers so far, wrapping as the card's count does.
    pub fn triggers(&self) -> u32 {
        self.made as u32
    }

    fn due(&self) -> u64 {
        let Some(begun) = self.begun.filter(|_| self.keeps_time) else {
            return BATCH;
        };
        let triggers = begun.elapsed().as_secs_f64() * self.system_hz as f64;
        let due = (triggers / self.period_cycles as f64) as u64;
        due.saturating_sub(self.made - self.since)
    }

    /// Gives what is due.
    pub fn give(&mut self, to: &mut VecDeque<u8>) {
        for _ in 0..self.due().min(BATCH) {
            to.extend(self.next().to_frame());
        }
    }

    fn next(&mut self) -> SampleSet {
        self.made += 1;
        let cycles = self.made * self.period_cycles;
        // Picoseconds of a day are more than 64 bits hold in one product.
        let time = u128::from(cycles) * 1_000_000_000_000 / u128::from(self.system_hz);
        let sample = |motion: &Motion| Sample {
            position: motion(time as Time),
            valid: true,
            fresh: true,
            taken: true,
            infos: self.has_infos.then(Default::default),
            ..Sample::default()
        };
        SampleSet {
            run: None,
            lost: 0,
            sequence: self.made as u16,
            timestamp: cycles as u32,
            channels: self.motions.iter().map(sample).collect(),
        }
    }
}
