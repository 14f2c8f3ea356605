//! The command line of the workshop.

mod bench;
mod flows;
mod mutants;

use crate::boards::{self, BoardsArgs};
use crate::mutants::{page as page_of_mutants, NAME};
use crate::page;
use clap::{Args, CommandFactory, Parser, Subcommand};
use endat_campaign::part::Part;
use endat_console::error::CommandError;
use endat_terminal::outcome::Outcome;
use std::ffi::OsString;
use std::path::PathBuf;

/// Measures this project itself, and makes the pages of its results.
///
/// Exit code 0: good; 1: a check failed; 2: wrong usage or input.
#[derive(Parser)]
#[command(
    name = "endat-workshop",
    version,
    max_term_width = 100,
    arg_required_else_help = true
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Measure the simulators, this project's and others
    Bench(bench::BenchArgs),
    /// Put a card's Verilog through every synthesis flow of yosys, and count what it complains about
    Flows(flows::FlowsArgs),
    /// Build the shipped card with five seeds on each board that open tools know: takes an hour
    Boards(BoardsArgs),
    /// Change one bit of one cell in every block of the emitted Verilog: who sees it
    Mutants(mutants::MutantsArgs),
    /// Print docs/reliability.md from the files of whole campaigns; docs/mutants.md from those of mutants
    Page(PageArgs),
}

/// Arguments of `page`.
#[derive(Args)]
struct PageArgs {
    /// Files that --out of a campaign has written
    #[arg(value_name = "PART", required = true)]
    parts: Vec<PathBuf>,
    /// Print all tables (campaigns/results/tables.md) instead of the page
    #[arg(long)]
    tables: bool,
}

/// The command line: its commands, options and what they say of themselves.
pub fn command_line() -> clap::Command {
    Cli::command()
}

/// Runs the program with these arguments; the first is the program's name.
pub fn run(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Outcome {
    painted(arguments).plain()
}

/// The same with colours.
pub fn painted(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Outcome {
    Outcome::of(arguments, execute)
}

fn execute(cli: Cli) -> Result<Outcome, CommandError> {
    match cli.command {
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Flows(arguments) => flows::run(&arguments),
        Command::Boards(arguments) => boards::run(&arguments),
        Command::Mutants(arguments) => mutants::run(&arguments),
        Command::Page(arguments) => {
            let parts = arguments.parts.iter().map(|path| Part::read(path));
            let parts = parts.collect::<Result<Vec<_>, _>>()?;
            Ok(Outcome::good(match &parts[..] {
                [first, ..] if first.identity.campaign == NAME => page_of_mutants(&parts)?,
                parts if arguments.tables => page::tables(parts)?,
                parts => page::page(parts)?,
            }))
        }
    }
}
