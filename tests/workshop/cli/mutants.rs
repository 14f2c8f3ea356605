//! `mutants`: what it is asked for, and one mutant alone.

use crate::mutants::{subjects, table, Emission, Mutants, NAME};
use clap::Args;
use endat_campaign::budget;
use endat_campaign::part::{merge, shard, Part};
use endat_console::error::{shorten, shown, CommandError};
use endat_console::number::number;
use endat_sim::campaign::{count, Shard};
use endat_terminal::outcome::Outcome;
use endat_terminal::work::{Steps, ThreadsArgs};
use std::path::PathBuf;

/// Mutants of each block by default, and of the one block of `--quick`.
const USUAL: &str = "30";
const QUICK: u64 = 20;
/// The card and the block of `--quick`: small ones.
const QUICK_SUBJECT: &str = "async_dsp";
const QUICK_BLOCK: &str = "RequestBits";
/// Most mutants of a block.
const PER_BLOCK_MAX: u64 = 1000;

/// Arguments of `mutants`.
#[derive(Args)]
pub struct MutantsArgs {
    /// Mutants of each block [default: 30]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    cases: Option<String>,
    /// Only this card [default: all]
    #[arg(long, value_name = "NAME")]
    subject: Option<String>,
    /// Only blocks whose name begins so
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Seed [default: 1]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    seed: Option<String>,
    /// A small part of the cases, in a minute
    #[arg(long, conflicts_with = "cases")]
    quick: bool,
    /// Only part I of N equal ones
    #[arg(long, value_name = "I/N")]
    shard: Option<String>,
    /// Write the counts as CSV
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Put parts together that --out has written, instead of running
    #[arg(long, value_name = "PART", num_args = 1.., conflicts_with_all = ["cases", "subject", "only", "seed", "quick", "shard", "case"])]
    merge: Vec<PathBuf>,
    #[command(flatten)]
    threads: ThreadsArgs,
    /// Run only this case, alone
    #[arg(long, value_name = "INDEX", allow_negative_numbers = true)]
    case: Option<String>,
}

/// The wish of the user.
enum Asked {
    /// One case, which has been run.
    One(Outcome),
    /// The plan, and the cases.
    All(String, Mutants),
}

/// Runs the command.
pub fn run(arguments: &MutantsArgs) -> Result<Outcome, CommandError> {
    let part = match arguments.merge.is_empty() {
        true => {
            let part = arguments.shard.as_deref().map(shard).transpose();
            let part = part.map_err(|e| CommandError::input(format!("--shard = {e}")))?;
            let seed = number(
                "--seed",
                arguments.seed.as_deref().unwrap_or("1"),
                0..=u64::MAX,
            )?;
            let (plan, mutants) = match asked(arguments, seed, part)? {
                Asked::One(outcome) => return Ok(outcome),
                Asked::All(plan, mutants) => (plan, mutants),
            };
            Part::run(
                NAME,
                plan,
                &mutants,
                part.unwrap_or(Shard::WHOLE),
                arguments.threads.count()?,
            )
        }
        false => {
            let named = |path: &PathBuf| Ok((path.display().to_string(), Part::read(path)?));
            let parts: Result<Vec<_>, CommandError> = arguments.merge.iter().map(named).collect();
            merge(parts?)?
        }
    };
    if let Some(path) = &arguments.out {
        part.write(path)?;
    }
    let (lines, holds) = budget::lines(NAME, &part.tally);
    Ok(Outcome {
        stdout: table(&part.tally) + &lines,
        exit_code: u8::from(part.shard == Shard::WHOLE && !holds),
        ..Outcome::default()
    })
}

/// The campaign that is asked for, ready to run a part of it; or one case of it.
fn asked(arguments: &MutantsArgs, seed: u64, part: Option<Shard>) -> Result<Asked, CommandError> {
    let told = arguments.cases.as_deref().unwrap_or(USUAL);
    let (per_block, usual_subject, usual_block) = match arguments.quick {
        true => (QUICK, Some(QUICK_SUBJECT), QUICK_BLOCK),
        false => (number("--cases", told, 1..=PER_BLOCK_MAX)?, None, ""),
    };
    let subject = arguments.subject.as_deref().or(usual_subject);
    let only = arguments.only.as_deref().unwrap_or(usual_block);
    if let Some(name) = subject.filter(|name| subjects().all(|s| s != *name)) {
        return Err(CommandError::input(format!(
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
        return Err(CommandError::input(format!(
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
