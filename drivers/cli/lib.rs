//! The program for who measures: it reads, records and watches EnDat acquisition cards, real and virtual.

#[cfg(feature = "virtual")]
mod card;
mod doctor;
mod explain;
mod id;
#[cfg(feature = "virtual")]
mod inject;
mod log;
mod margin;
mod monitor;
mod param;
mod plot;
mod port;
mod read;
mod recorded;
mod reg;
mod serve;
mod simulated;
mod stats;
mod view;

use clap::{CommandFactory, Parser, Subcommand};
use endat_console::error::CommandError;
use endat_terminal::documents::{self, CompletionsArgs, ManArgs};
use endat_terminal::outcome::Outcome;
use std::ffi::OsString;

/// Reads, records and watches EnDat acquisition cards, real and virtual.
///
/// Exit code 0: good; 1: a check failed; 2: wrong usage or input.
#[derive(Parser)]
#[command(
    name = "endat",
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
    /// Ask a card who it is, and what its encoders are
    Id(id::IdArgs),
    /// Read the latest position of every channel
    Read(read::ReadArgs),
    /// Log positions as CSV, JSON lines or Parquet
    Log(log::LogArgs),
    /// Draw a recording: positions over time, faults below them
    Plot(plot::PlotArgs),
    /// Say what is in a recording: rate, what is missing, noise, drift, faults
    Stats(stats::StatsArgs),
    /// Watch positions, rate, health and margin live
    Monitor(monitor::MonitorArgs),
    /// Watch a card in a browser: positions over time, causes, health, registers; record
    View(view::ViewArgs),
    /// Serve a card to PandABlocks clients, which record HDF5
    Serve(serve::ServeArgs),
    /// Read and write registers of a card by name
    Reg(reg::RegArgs),
    /// Read and write words of the encoder's memory
    Param(param::ParamArgs),
    /// Show where the edges of DATA are, as the card has measured it
    Margin(margin::MarginArgs),
    /// Run a card without hardware, for this program and others: the core and encoders, simulated, behind a port
    #[cfg(feature = "virtual")]
    Card(card::CardArgs),
    /// Make a fault in a virtual card that runs: plug, cable, encoder
    #[cfg(feature = "virtual")]
    Inject(inject::InjectArgs),
    /// Show what a cause, register, field or value means
    Explain(explain::ExplainArgs),
    /// Say what of this machine the program can use: serial ports, the engine of virtual cards
    Doctor(doctor::DoctorArgs),
    /// Print the completions of the command line for a shell
    Completions(CompletionsArgs),
    /// Print the manual page, or write those of all commands
    Man(ManArgs),
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
        Command::Id(arguments) => id::run(&arguments),
        Command::Read(arguments) => read::run(&arguments),
        Command::Log(arguments) => log::run(&arguments),
        Command::Plot(arguments) => plot::run(&arguments),
        Command::Stats(arguments) => stats::run(&arguments),
        Command::Monitor(arguments) => monitor::run(&arguments),
        Command::View(arguments) => view::run(&arguments),
        Command::Serve(arguments) => serve::run(&arguments),
        Command::Reg(arguments) => reg::run(&arguments),
        Command::Param(arguments) => param::run(&arguments),
        Command::Margin(arguments) => margin::run(&arguments),
        #[cfg(feature = "virtual")]
        Command::Card(arguments) => card::run(&arguments),
        #[cfg(feature = "virtual")]
        Command::Inject(arguments) => inject::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Doctor(arguments) => doctor::run(&arguments),
        Command::Completions(arguments) => documents::completions(command_line(), &arguments),
        Command::Man(arguments) => documents::man(command_line(), &arguments),
    }
}
