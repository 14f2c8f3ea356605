//! `bench`: measures the simulators.

use super::number::number;
use super::{to_json, Outcome};
use crate::bench::{self, Options};
use crate::error::GenError;
use clap::{Args, Subcommand};
use std::io::Write;

/// Arguments of `bench`.
#[derive(Args)]
pub struct BenchArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// The card on the same stimulus in every engine and in other simulators; results are compared
    Engines(EnginesArgs),
}

#[derive(Args)]
struct EnginesArgs {
    /// Cycles for the fast engines; slow ones run a part of them
    #[arg(
        long,
        value_name = "N",
        default_value = "2000000",
        allow_negative_numbers = true
    )]
    cycles: String,
    /// Only this project's own engines
    #[arg(long)]
    own: bool,
    /// Count instructions with valgrind: takes minutes
    #[arg(long)]
    instructions: bool,
    /// Run one engine and print nothing
    #[arg(long, value_name = "ENGINE", hide = true)]
    only: Option<String>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Fewest cycles: the slow engines run a part of them.
const CYCLES_MIN: u64 = 1000;
/// Most cycles: a byte of stimulus is kept for each.
const CYCLES_MAX: u64 = 1_000_000_000;

/// Runs the command.
pub fn run(arguments: &BenchArgs) -> Result<Outcome, GenError> {
    let What::Engines(arguments) = &arguments.what;
    let cycles = number("--cycles", &arguments.cycles, CYCLES_MIN..=CYCLES_MAX)? as usize;
    if let Some(engine) = &arguments.only {
        bench::run_one(engine, cycles)?;
        return Ok(Outcome::default());
    }
    let options = Options {
        cycles,
        outside: !arguments.own,
        instructions: arguments.instructions,
    };
    // A progress line that cannot be written is no reason to stop.
    let progress = |what: &str| drop(writeln!(std::io::stderr(), "bench: {what}"));
    let report = bench::run(options, &progress)?;
    let mut outcome = Outcome::good(if arguments.json {
        to_json(&report)?
    } else {
        report.to_string()
    });
    if !report.is_equal() {
        outcome.exit_code = 1;
    }
    Ok(outcome)
}
