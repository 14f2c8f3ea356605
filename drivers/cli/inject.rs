//! `inject`: faults of a virtual card that runs, to rehearse what a program does about them.

use clap::Args;
use endat_card::{Fault, CONTROL, FAULTS};
use endat_console::error::{shown, CommandError};
use endat_terminal::outcome::{to_json, Outcome};
use serde_json::json;
use std::io::{Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

/// Arguments of `inject`.
#[derive(Args)]
pub struct InjectArgs {
    /// Where the virtual card is: tcp:HOST:PORT, as `card --tcp` has told it
    #[arg(long, value_name = "PORT", required_unless_present = "list")]
    port: Option<String>,
    /// List the faults that there are
    #[arg(long, conflicts_with = "fault")]
    list: bool,
    /// The list as JSON
    #[arg(long, requires = "list")]
    json: bool,
    /// Fault, channel, and how much, as in: unplug 0, crc 1 5, slow 0 30us, heal 0
    #[arg(value_name = "FAULT", required_unless_present = "list")]
    fault: Option<String>,
    /// Channel
    #[arg(value_name = "CHANNEL", allow_negative_numbers = true)]
    channel: Option<String>,
    /// How much, for faults that take it
    #[arg(value_name = "VALUE", allow_hyphen_values = true)]
    value: Option<String>,
}

/// A card answers within this; a machine may be busy.
const PATIENCE: Duration = Duration::from_secs(10);
/// Longest answer.
const ANSWER_BYTES: u64 = 4096;

/// Runs the command.
pub fn run(arguments: &InjectArgs) -> Result<Outcome, CommandError> {
    if arguments.list && arguments.json {
        let all = FAULTS
            .iter()
            .map(|(name, takes, is)| json!({"name": name, "takes": takes, "is": is}));
        return Ok(Outcome::good(to_json(&all.collect::<Vec<_>>())?));
    }
    if arguments.list {
        let lines = FAULTS.iter().map(|(name, takes, is)| {
            let call = format!("{name} {takes}");
            format!("{call:<24} {is}\n")
        });
        return Ok(Outcome::good(lines.collect::<String>()));
    }
    let words = [&arguments.fault, &arguments.channel, &arguments.value];
    let words: Vec<&str> = words.into_iter().flatten().map(String::as_str).collect();
    let port = arguments.port.as_deref().unwrap_or_default();
    make(port, &words).map(|done| Outcome::good(done + "\n"))
}

/// Makes a fault in the card of a port; what was done.
pub fn make(port: &str, words: &[&str]) -> Result<String, CommandError> {
    // Before anybody is asked.
    Fault::parse(words).map_err(CommandError::input)?;
    let answer = ask(port, &words.join(" "))?;
    match answer.trim_end().split_once(' ') {
        Some(("ok", done)) => Ok(done.to_owned()),
        Some(("error", why)) => Err(CommandError::input(why)),
        _ => Err(CommandError::CheckFailed(vec![format!(
            "--port = {port}: no virtual card of this program answers; faults are made in one that `endat card --tcp` has begun"
        )])),
    }
}

/// Sends a line to a card, and waits for its answer.
fn ask(port: &str, words: &str) -> Result<String, CommandError> {
    let wrong = |why: &str| CommandError::input(format!("--port = {}: {why}", shown(port)));
    let address = port.strip_prefix("tcp:").ok_or_else(|| {
        wrong("faults are made in a virtual card behind TCP; give tcp:HOST:PORT, as `endat card --tcp` has told it")
    })?;
    let found = address.to_socket_addrs();
    let found = found.map_err(|e| wrong(&format!("{e}; give tcp:HOST:PORT")))?;
    let here: Vec<_> = found.filter(|a| a.ip().is_loopback()).collect();
    if here.is_empty() {
        return Err(wrong(
            "is another machine; faults are made on the machine of the card only",
        ));
    }
    let silent = |e: std::io::Error| {
        CommandError::CheckFailed(vec![format!(
            "--port = {}: {e}; is the card running?",
            shown(port)
        )])
    };
    let connected = TcpStream::connect(&here[..]);
    let mut stream = connected.map_err(|e| wrong(&format!("{e}; is the card running?")))?;
    stream.set_read_timeout(Some(PATIENCE)).map_err(silent)?;
    let line = format!("{CONTROL}{words}\n");
    stream.write_all(line.as_bytes()).map_err(silent)?;
    let mut answer = String::new();
    let read = stream.take(ANSWER_BYTES).read_to_string(&mut answer);
    read.map_err(silent)?;
    Ok(answer)
}
