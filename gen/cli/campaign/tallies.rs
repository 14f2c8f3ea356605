//! Campaigns that count what becomes of each case: shards, tables, the worst places.

use super::{fault, CampaignArgs};
use crate::campaign::report;
use crate::cli::number::number;
use crate::cli::work::progress;
use crate::cli::Outcome;
use crate::error::GenError;
use endat_sim::campaign::upsets::{Draw, Port, Upsets};
use endat_sim::campaign::{count, run_shard, Shard};
use std::time::Instant;

/// Most moments of a frame.
const MOMENTS_MAX: u64 = 1_000_000;
/// Most cases of a campaign.
const CASES_MAX: u64 = 1_000_000_000_000;

/// Runs such a campaign.
pub fn run(arguments: &CampaignArgs, seed: u64) -> Result<Outcome, GenError> {
    let draw = match &arguments.cases {
        Some(text) => Draw::Random {
            cases: number("--cases", text, 1..=CASES_MAX)?,
        },
        None => Draw::Grid {
            moments: number("--moments", &arguments.moments, 1..=MOMENTS_MAX)?,
        },
    };
    let chosen = |port: &Port| {
        arguments
            .subject
            .as_deref()
            .is_none_or(|s| s == port.name())
    };
    let ports: Vec<Port> = Port::ALL.into_iter().filter(chosen).collect();
    let campaign = Upsets::new(&ports, draw, seed, &arguments.only).map_err(|e| fault(&e))?;
    let start = Instant::now();
    let cases = count(&campaign);
    let told = progress(cases as usize, "flips");
    let tally = run_shard(
        &campaign,
        Shard::WHOLE,
        arguments.threads.count()?,
        |done| told(done as usize),
    );
    let seconds = start.elapsed().as_secs_f64();
    Ok(Outcome::good(
        report::upsets(&tally) + &format!("\n{cases} flips in {seconds:.1} s\n"),
    ))
}
