//! `flows`: a card's Verilog through every synthesis flow of yosys.

use crate::flows;
use clap::Args;
use endat_config::arguments::SourceArgs;
use endat_console::error::CommandError;
use endat_terminal::outcome::{to_json, Outcome};
use endat_terminal::work::Steps;

/// Arguments of `flows`.
///
/// Exit code 1 when yosys complains about the card, or leaves cells that no device has.
#[derive(Args)]
pub struct FlowsArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// Only these flows, by name
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    only: Vec<String>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(arguments: &FlowsArgs) -> Result<Outcome, CommandError> {
    let only = flows::named(&arguments.only)?;
    let configuration = arguments.source.load_any_on(None)?;
    let steps = Steps::new(None);
    let found = flows::all(&configuration, &only, &|step| steps.begin(step))?;
    drop(steps);
    let complaints = found.complaints();
    let stdout = match arguments.json {
        true => to_json(&found)?,
        false => found.to_string(),
    };
    Ok(Outcome {
        exit_code: u8::from(!complaints.is_empty()),
        messages: complaints,
        ..Outcome::good(stdout)
    })
}
