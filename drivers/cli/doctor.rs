//! `doctor`: what of this machine the program can use.

use clap::Args;
use endat_console::error::CommandError;
use endat_host::transport::serial_ports;
use endat_terminal::colour;
use endat_terminal::outcome::{to_json, Outcome};
use serde_json::json;
use std::fmt::Write;

/// Arguments of `doctor`.
#[derive(Args)]
pub struct DoctorArgs {
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Why virtual cards are slow or not there; none if they are as quick as they can be.
#[cfg(feature = "virtual")]
fn engine() -> Option<String> {
    let why = rtl_design::engine::has_native_code().err()?;
    Some(format!(
        "no native code on this machine ({why}): simulated in the slower interpreter"
    ))
}

#[cfg(not(feature = "virtual"))]
fn engine() -> Option<String> {
    Some("built without the feature virtual: install with it for simulated cards".into())
}

/// Runs the command.
pub fn run(arguments: &DoctorArgs) -> Result<Outcome, CommandError> {
    let ports = serial_ports();
    let engine = engine();
    if arguments.json {
        return Ok(Outcome::good(to_json(&json!({
            "serial_ports": ports,
            "virtual_cards": engine.is_none(),
            "note": engine,
        }))?));
    }
    let mut text = String::new();
    let found = match ports.is_empty() {
        true => colour::doubtful(
            "none found; a card's USB adapter makes one, on Linux for members of the group dialout",
        ),
        false => colour::good(ports.join(", ")),
    };
    let _ = writeln!(text, "{:<16} {found}", "serial ports");
    let state = match &engine {
        None => colour::good("compiled for this machine"),
        Some(why) => colour::doubtful(why),
    };
    let _ = writeln!(text, "{:<16} {state}", "virtual cards");
    Ok(Outcome::good(text))
}
