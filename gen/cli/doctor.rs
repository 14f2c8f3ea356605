//! `doctor`: which programs of others are there, and what those are for that are not.

use super::{colour, to_json, Outcome};
use clap::Args;
use endat_console::error::CommandError;
use endat_tools::programs::{version, TOOLS};
use serde_json::json;
use std::fmt::Write;

/// Arguments of `doctor`.
#[derive(Args)]
pub struct DoctorArgs {
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(arguments: &DoctorArgs) -> Result<Outcome, CommandError> {
    let found: Vec<_> = TOOLS.iter().map(|tool| (tool, version(tool))).collect();
    if arguments.json {
        let all = found.iter().map(|(tool, version)| {
            json!({
                "program": tool.program,
                "version": version,
                "enables": tool.enables,
                "install": tool.install,
            })
        });
        return Ok(Outcome::good(to_json(&all.collect::<Vec<_>>())?));
    }
    let mut text =
        String::from("Nothing of this is needed to emit, to simulate or to talk to a card.\n\n");
    for (tool, version) in &found {
        let state = match version {
            Some(version) => colour::good(version),
            None => colour::doubtful(format_args!("missing: {}", tool.install)),
        };
        let _ = writeln!(text, "{:<32} {:<46} {state}", tool.program, tool.enables);
    }
    Ok(Outcome::good(text))
}
