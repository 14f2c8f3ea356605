//! `campaign mutants`: what it is asked for, and one mutant alone.

use super::CampaignArgs;
use crate::campaign::mutants::{subjects, Emission, Mutants};
use crate::cli::work::Steps;
use crate::cli::Outcome;
use crate::error::{shorten, shown, GenError};
use crate::number::number;
use endat_sim::campaign::{count, Shard};

/// Mutants of each block, if not told, and of the one block of `--quick`.
const USUAL: &str = "30";
const QUICK: u64 = 20;
/// The card and the block of `--quick`: small ones.
const QUICK_SUBJECT: &str = "async_dsp";
const QUICK_BLOCK: &str = "RequestBits";
/// Most mutants of a block.
const PER_BLOCK_MAX: u64 = 1000;

/// What is asked for.
pub(super) enum Asked {
    /// One case, which has been run.
    One(Outcome),
    /// The plan, and the cases.
    All(String, Mutants),
}

/// The campaign that is asked for, ready to run a part of it; or one case of it.
pub(super) fn asked(
    arguments: &CampaignArgs,
    seed: u64,
    part: Option<Shard>,
) -> Result<Asked, GenError> {
    let told = arguments.cases.as_deref().unwrap_or(USUAL);
    let (per_block, usual_subject, usual_block) = match arguments.quick {
        true => (QUICK, Some(QUICK_SUBJECT), QUICK_BLOCK),
        false => (number("--cases", told, 1..=PER_BLOCK_MAX)?, None, ""),
    };
    let subject = arguments.subject.as_deref().or(usual_subject);
    let only = arguments.only.as_deref().unwrap_or(usual_block);
    if let Some(name) = subject.filter(|name| subjects().all(|s| s != *name)) {
        return Err(GenError::input(format!(
            "--subject = {}: is no subject of this campaign; take one of {}",
            shown(name),
            subjects().collect::<Vec<_>>().join(", ")
        )));
    }
    let steps = Steps::new(None);
    let begin = |step: &str| steps.begin(step);
    begin("listing mutants");
    let emissions: Result<Vec<_>, _> = subjects().map(Emission::named).collect();
    let mut mutants = Mutants::new(emissions?, subject, per_block, seed, only)?;
    let all = count(&mutants);
    if all == 0 {
        return Err(GenError::input(format!(
            "--only = {}: no block that is tried in --subject {} begins like this; take a name of the first table of docs/mutants.md, or leave it out",
            shorten(only),
            subject.unwrap_or("all")
        )));
    }
    if let Some(index) = &arguments.case {
        let case = number("--case", index, 0..=all - 1)?;
        // The part with this case alone.
        let alone = Shard {
            index: case + 1,
            of: all,
        };
        mutants.prepare(alone, &begin)?;
        let (fate, block, place) = mutants.case(case)?;
        let text = format!("case {case} ({block}, {place}): {}\n", fate.name());
        return Ok(Asked::One(Outcome::good(text)));
    }
    mutants.prepare(part.unwrap_or(Shard::WHOLE), &begin)?;
    let subject = subject.unwrap_or("all");
    let plan = format!("{per_block} of a block; seed {seed}; subject {subject}; only {only}*");
    Ok(Asked::All(plan, mutants))
}
