//! `sim`: runs a named scenario of the bench.

use super::Outcome;
use crate::error::GenError;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `sim`.
#[derive(Args)]
pub struct SimArgs {
    /// Scenario to run
    #[arg(required_unless_present = "list")]
    name: Option<String>,
    /// List the scenarios
    #[arg(long)]
    list: bool,
    /// Write the waveforms, and a GTKWave layout beside them
    #[arg(long, value_name = "FILE")]
    vcd: Option<PathBuf>,
    /// Draw the first frame as a timing diagram
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(_arguments: &SimArgs) -> Result<Outcome, GenError> {
    Err(GenError::input("sim: no scenario is built in yet"))
}
