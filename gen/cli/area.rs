//! `area`: measures the emitted Verilog with outside tools.

use super::work::Steps;
use super::{to_json, Outcome};
use clap::Args;
use endat_console::error::CommandError;
use endat_tools::area;
use std::path::PathBuf;

/// Arguments of `area`.
#[derive(Args)]
pub struct AreaArgs {
    /// Also place and route card and channel: takes minutes
    #[arg(long)]
    fmax: bool,
    /// Also print the worst path of the median seed: block, signal and line of the emitted text for each hop
    #[arg(long, requires = "fmax")]
    path: bool,
    /// Measure only these, by name
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    only: Vec<String>,
    /// Keep sources, netlists and reports of the tools in this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(arguments: &AreaArgs) -> Result<Outcome, CommandError> {
    let steps = Steps::new(None);
    let scope = area::Scope {
        only: &arguments.only,
        with_speed: arguments.fmax,
        with_path: arguments.path,
        out: arguments.out.as_deref(),
    };
    let report = area::report(&scope, &|name| steps.begin(name))?;
    drop(steps);
    Ok(Outcome::good(if arguments.json {
        to_json(&report)?
    } else {
        report.to_string()
    }))
}
