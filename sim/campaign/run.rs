//! Runs cases in lanes, on all processors. The results do not depend on the numbers of lanes and processors.

use super::case::{Case, DesignKey, Traces, RESET_CYCLES};
use crate::bench::{LaneBench, PinNames};
use rtl_design::elaborate::ElaborateError;
use rtl_design::engine::{EngineError, Keep, LaneWords, Lanes};
use std::collections::btree_map::{BTreeMap, Entry};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Mutex;
use std::{panic, thread};

/// Options of a run.
#[derive(Clone, Copy, Debug)]
pub struct RunOptions {
    /// Threads; 0 = one for each processor.
    pub threads: usize,
    /// Copies in one pass.
    pub lanes: LaneWords,
    /// Evaluate and check every sample of DATA, too.
    pub samples: bool,
}

impl Default for RunOptions {
    fn default() -> Self {
        Self {
            threads: 0,
            lanes: LaneWords::Two,
            samples: true,
        }
    }
}

/// Outcome of one case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome<V> {
    /// Number of evaluated results.
    pub frames: usize,
    /// System clock cycles of the case.
    pub cycles: u64,
    /// Verdict of the judge.
    pub verdict: V,
}

/// Reasons why a campaign cannot run: bugs in this program.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// The channel has no design.
    #[error(transparent)]
    Elaborate(#[from] ElaborateError),
    /// The design cannot be executed.
    #[error(transparent)]
    Engine(#[from] EngineError),
}

/// Cases that share a design, few enough for one pass.
struct Batch {
    key: DesignKey,
    cases: Vec<usize>,
}

/// Cases of one design together, grouped by similar duration.
fn batches(cases: &[Case], lanes: usize) -> Vec<Batch> {
    let mut by_design: BTreeMap<DesignKey, Vec<usize>> = BTreeMap::new();
    for (index, case) in cases.iter().enumerate() {
        by_design.entry(case.key()).or_default().push(index);
    }
    let mut batches = vec![];
    for (key, mut members) in by_design {
        members.sort_by_key(|i| {
            let case = &cases[*i];
            let bits = u64::from(case.settings.position_bits);
            (case.frames as u64 * case.settings.period_cycles, bits, *i)
        });
        batches.extend(members.chunks(lanes).map(|chunk| Batch {
            key,
            cases: chunk.to_vec(),
        }));
    }
    // The longest first, so that the last batches are short.
    batches.reverse();
    batches
}

/// Runs and judges all cases (by [`Case::check`], for example); `progress` receives the number of finished cases. Outcomes are in the order
/// of the cases.
///
/// # Errors
/// If the design of a case cannot be elaborated.
pub fn run<V: Clone + Send>(
    cases: &[Case],
    options: RunOptions,
    judge: impl Fn(&Case, &Traces<'_>) -> V + Sync,
    progress: impl Fn(usize) + Sync,
) -> Result<Vec<Outcome<V>>, CampaignError> {
    let batches = batches(cases, options.lanes.count() * 64);
    let mut engines: BTreeMap<DesignKey, Lanes> = BTreeMap::new();
    for batch in &batches {
        if let Entry::Vacant(place) = engines.entry(batch.key) {
            place.insert(Lanes::new(
                &batch.key.design()?,
                Keep::Outputs,
                options.lanes,
            )?);
        }
    }
    let outcomes: Mutex<Vec<Option<Outcome<V>>>> = Mutex::new(vec![None; cases.len()]);
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let work = || {
        while let Some(batch) = batches.get(next.fetch_add(1, Ordering::Relaxed)) {
            let engine = engines[&batch.key].clone();
            let found = run_batch(batch, cases, engine, options, &judge);
            let mut outcomes = outcomes.lock().unwrap_or_else(|e| e.into_inner());
            for (case, outcome) in batch.cases.iter().zip(found) {
                outcomes[*case] = Some(outcome);
            }
            drop(outcomes);
            let before = done.fetch_add(batch.cases.len(), Ordering::Relaxed);
            progress(before + batch.cases.len());
        }
    };
    let threads = match options.threads {
        0 => thread::available_parallelism().map_or(1, usize::from),
        count => count,
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.min(batches.len()))
            .map(|_| scope.spawn(work))
            .collect();
        for worker in workers {
            if let Err(cause) = worker.join() {
                panic::resume_unwind(cause);
            }
        }
    });
    let outcomes = outcomes.into_inner().unwrap_or_else(|e| e.into_inner());
    Ok(outcomes.into_iter().flatten().collect())
}

fn run_batch<V>(
    batch: &Batch,
    cases: &[Case],
    engine: Lanes,
    options: RunOptions,
    judge: &(impl Fn(&Case, &Traces<'_>) -> V + Sync),
) -> Vec<Outcome<V>> {
    let members: Vec<&Case> = batch.cases.iter().map(|i| &cases[*i]).collect();
    // Unused lanes repeat the first case, without triggers.
    let case_of = |lane: usize| members.get(lane).copied().unwrap_or(members[0]);
    let links = (0..engine.lanes()).map(|lane| case_of(lane).link());
    let pins = (PinNames::channel(), links.collect());
    let mut bench = LaneBench::new(engine, batch.key.system_hz, vec![pins]);
    if options.samples {
        bench.keep_samples(|lane| case_of(lane).latency_halves());
    }
    if batch.key.features.double_edge {
        bench.set_double_edge();
    }
    for lane in 0..bench.lanes() {
        bench.configure(lane, &case_of(lane).settings);
    }
    (0..=RESET_CYCLES).for_each(|_| bench.tick());
    let limit = members.iter().map(|c| c.limit_cycles()).max().unwrap_or(0);
    let mut ends: Vec<Option<u64>> = vec![None; members.len()];
    let words = bench.lanes() / 64;
    // Lanes that need more results, and running lanes.
    let mut wanting = vec![0u64; words];
    let mut running = vec![0u64; words];
    for lane in 0..members.len() {
        wanting[lane / 64] |= 1 << (lane % 64);
    }
    running.copy_from_slice(&wanting);
    let mut delivered = 0;
    while running.iter().any(|word| *word != 0) && bench.cycle() < limit {
        for part in 0..words {
            let idle = !bench.busy(part);
            let mut finished = running[part] & idle & !wanting[part];
            running[part] &= !finished;
            while finished != 0 {
                let lane = 64 * part + finished.trailing_zeros() as usize;
                finished &= finished - 1;
                ends[lane] = Some(bench.cycle());
            }
            bench.set_trigger(part, idle & wanting[part]);
        }
        bench.tick();
        if bench.delivered() != delivered {
            delivered = bench.delivered();
            for (lane, case) in members.iter().enumerate() {
                if bench.results(lane).len() >= case.frames {
                    wanting[lane / 64] &= !(1 << (lane % 64));
                }
            }
        }
    }
    bench.finish_samples();
    let outcome = |(lane, case): (usize, &&Case)| {
        let encoder = bench.link(0, lane).encoder();
        let traces = Traces {
            results: bench.results(lane),
            frames: encoder.frames(),
            violations: encoder.violations(),
            conflicts: bench.link(0, lane).line().conflicts(bench.now()),
            samples: bench.samples(0, lane),
        };
        Outcome {
            frames: traces.results.len(),
            cycles: ends[lane].unwrap_or(bench.cycle()),
            verdict: judge(case, &traces),
        }
    };
    members.iter().enumerate().map(outcome).collect()
}
