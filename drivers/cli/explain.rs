//! `explain NAME`: what a cause, a register, a field or a value is.

use clap::Args;
use endat_console::did_you_mean::guesses;
use endat_console::error::{shown, CommandError};
use endat_host::explain;
use endat_terminal::outcome::Outcome;

/// Arguments of `explain`.
#[derive(Args)]
pub struct ExplainArgs {
    /// Name of a cause, register, field or value, for example crc, result.status or tracked
    #[arg(value_name = "NAME")]
    name: String,
}

/// Runs the command.
pub fn run(arguments: &ExplainArgs) -> Result<Outcome, CommandError> {
    let text = explain::text(&arguments.name.to_ascii_lowercase());
    if !text.is_empty() {
        return Ok(Outcome::good(text));
    }
    let guess = guesses(&arguments.name, explain::names());
    Err(CommandError::input(format!(
        "name = {}: no cause, register, field or value has this name; {guess}`endat reg list` lists registers, and `endat-gen explain` knows keys of a configuration",
        shown(&arguments.name),
    )))
}
