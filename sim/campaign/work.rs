//! Numbered cases on all processors: batches of one group each, counted in any order.

use super::{Shard, Tally};
use rtl_design::elaborate::Design;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::Mutex;
use std::{panic, thread};

/// Numbered cases. The outcome of a case depends only on its number.
pub trait Campaign: Send + Sync {
    /// Identifies its designs.
    fn digest(&self) -> u64;

    /// Number of cases in each group, in order.
    fn groups(&self) -> Vec<u64>;

    /// Runs some cases of a group, at most [`Campaign::batch`].
    fn run(&self, group: usize, cases: Range<u64>) -> Tally;

    /// Number of cases of a group in one run.
    fn batch(&self, _group: usize) -> u64 {
        128
    }
}

/// Consecutive campaigns.
pub struct Joined(pub Vec<Box<dyn Campaign>>);

impl Campaign for Joined {
    fn digest(&self) -> u64 {
        self.0.iter().fold(0, |digest, c| digest ^ c.digest())
    }

    fn groups(&self) -> Vec<u64> {
        self.0.iter().flat_map(|c| c.groups()).collect()
    }

    fn run(&self, mut group: usize, cases: Range<u64>) -> Tally {
        for campaign in &self.0 {
            match group.checked_sub(campaign.groups().len()) {
                None => return campaign.run(group, cases),
                Some(rest) => group = rest,
            }
        }
        Tally::default()
    }
}

/// A machine-independent hash of a text (FNV-1a).
pub(super) fn hash(text: &str) -> u64 {
    text.bytes().fold(0xCBF2_9CE4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3)
    })
}

/// A number that identifies a design.
pub fn digest(design: &Design) -> u64 {
    hash(&format!("{design:?}"))
}

/// Number of cases of a campaign.
pub fn count(campaign: &dyn Campaign) -> u64 {
    campaign.groups().iter().sum()
}

/// Runs one part of a campaign on this many threads (0 = one for each processor). `progress` receives the number of finished cases.
pub fn run_shard(
    campaign: &dyn Campaign,
    shard: Shard,
    threads: usize,
    progress: impl Fn(u64) + Sync,
) -> Tally {
    let jobs = jobs(campaign, shard.cases(count(campaign)));
    let tally = Mutex::new(Tally::default());
    let (next, done) = (AtomicUsize::new(0), AtomicU64::new(0));
    let work = || {
        while let Some((group, cases)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let found = campaign.run(*group, cases.clone());
            tally.lock().unwrap_or_else(|e| e.into_inner()).merge(found);
            let more = cases.end - cases.start;
            progress(done.fetch_add(more, Ordering::Relaxed) + more);
        }
    };
    let threads = match threads {
        0 => thread::available_parallelism().map_or(1, usize::from),
        count => count,
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.min(jobs.len()))
            .map(|_| scope.spawn(work))
            .collect();
        for worker in workers {
            if let Err(cause) = worker.join() {
                panic::resume_unwind(cause);
            }
        }
    });
    tally.into_inner().unwrap_or_else(|e| e.into_inner())
}

/// The batches that cover these cases.
fn jobs(campaign: &dyn Campaign, cases: Range<u64>) -> Vec<(usize, Range<u64>)> {
    let mut jobs = vec![];
    let mut first = 0;
    for (group, count) in campaign.groups().into_iter().enumerate() {
        let mut from = cases.start.clamp(first, first + count) - first;
        let end = cases.end.clamp(first, first + count) - first;
        while from < end {
            let to = end.min(from + campaign.batch(group));
            jobs.push((group, from..to));
            from = to;
        }
        first += count;
    }
    jobs
}
