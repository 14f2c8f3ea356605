//! `view`: one page for a browser, live.
//!
//! ```text
//! card -> endat_host::owner -> collect -> History --plot--> api -> http -> page (page/)
//! ```
//!
//! Pages poll; what they are shown is worked out here, so ten of them are no more work for the card than one.

mod api;
mod collect;
mod connections;
mod guard;
mod history;
mod http;

use crate::port::{told, RangedPort};
use crate::simulated::{card_at, is_virtual};
use api::Api;
use clap::Args;
use collect::{Find, Shared};
use endat_console::error::CommandError;
use endat_host::owner::Handle;
use endat_terminal::outcome::Outcome;
use endat_terminal::work::interrupted;
use guard::Guard;
use std::fmt::Write as _;
use std::io::Write as _;
use std::net::TcpListener;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Where pages come in, unless told otherwise.
const LISTEN: &str = "127.0.0.1:8480";
/// A token that is shorter can be guessed.
const TOKEN_CHARACTERS_MIN: usize = 12;

/// Nothing for so long, or three times as long as triggers are apart: what is shown is old.
const SILENT: Duration = Duration::from_millis(1_500);
/// The same of a card that is simulated here, and slow.
const SILENT_SIMULATED: Duration = Duration::from_secs(10);

/// Arguments of `view`.
#[derive(Args)]
pub struct ViewArgs {
    #[command(flatten)]
    port: RangedPort,
    /// Address of the page; port 0 takes a free one. Others than 127.0.0.1 and ::1 need the token that is printed [default: 127.0.0.1:8480]
    #[arg(long, value_name = "HOST:PORT")]
    listen: Option<String>,
    /// Token for the page instead of a random one
    #[arg(long, value_name = "TEXT")]
    token: Option<String>,
    /// Folder for recordings that are begun on the page [default: recordings]
    #[arg(long, value_name = "DIR")]
    folder: Option<PathBuf>,
    /// Let the page make faults: the card is a virtual one behind TCP
    #[arg(long)]
    rehearse: bool,
}

/// A token that nobody guesses.
fn random_token() -> Result<String, CommandError> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|e| CommandError::fault("random numbers", &e))?;
    Ok(bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}

/// Runs the command.
pub fn run(arguments: &ViewArgs) -> Result<Outcome, CommandError> {
    let address = arguments.listen.as_deref().unwrap_or(LISTEN);
    let fail = |e: std::io::Error| {
        CommandError::input(format!(
            "--listen = {address:?}: {e}; give HOST:PORT, for example 127.0.0.1:8480 (port 0 takes a free one)"
        ))
    };
    if let Some(short) = arguments
        .token
        .as_ref()
        .filter(|t| t.len() < TOKEN_CHARACTERS_MIN)
    {
        return Err(CommandError::input(format!(
            "--token = {} characters: can be guessed, at least {TOKEN_CHARACTERS_MIN}; leave it out for a random one",
            short.len()
        )));
    }
    if arguments
        .token
        .as_ref()
        .is_some_and(|t| !t.bytes().all(|b| b.is_ascii_alphanumeric()))
    {
        return Err(CommandError::input(
            "--token: has other characters than letters and digits; leave it out for a random one",
        ));
    }
    let (name, baud) = (
        arguments.port.checked_name()?.to_owned(),
        arguments.port.baud()?,
    );
    if arguments.rehearse && !name.starts_with("tcp:") {
        return Err(CommandError::input(format!(
            "--rehearse: faults are made in a virtual card behind TCP, not in {name}; begin one with `endat card --tcp 127.0.0.1:7700`"
        )));
    }
    let listener = TcpListener::bind(address).map_err(fail)?;
    let local = listener.local_addr().map_err(fail)?;
    let token = match (&arguments.token, local.ip().is_loopback()) {
        (Some(token), _) => Some(token.clone()),
        (None, true) => None,
        (None, false) => Some(random_token()?),
    };
    let port = name.clone();
    let may_be_silent = match is_virtual(&port) {
        true => SILENT_SIMULATED,
        false => SILENT,
    };
    let folder = (arguments.folder.clone()).unwrap_or_else(|| "recordings".into());
    // A folder is made for the first recording; whether it can be is told now.
    if let Some(file) = folder
        .ancestors()
        .find(|f| f.exists())
        .filter(|f| !f.is_dir())
    {
        return Err(CommandError::input(format!(
            "--folder = {}: {} is no folder; give another one",
            folder.display(),
            file.display()
        )));
    }
    let ranges = arguments.port.ranges()?;
    let find: Find = Arc::new(move || {
        let is_real = !is_virtual(&name);
        let (name, ranges) = (name.clone(), ranges.clone());
        let card = move || {
            let mut card = card_at(&name, baud)?;
            card.set_ranges(ranges)?;
            Ok(card)
        };
        Handle::open(card, is_real, || Ok(()))?
    });
    let stop = interrupted();
    let (shared, collecting) = Shared::collect(find, stop.clone()).map_err(told)?;
    let query = token
        .as_ref()
        .map_or(String::new(), |token| format!("?token={token}"));
    let shown = match local.ip().is_unspecified() {
        true => format!(
            "port {} of this machine: http://NAME:{}/{query}",
            local.port(),
            local.port()
        ),
        false => format!("http://{local}/{query}"),
    };
    let mut stdout = std::io::stdout();
    // Nobody reads it: the page is there all the same.
    let _ = writeln!(stdout, "{port}: {shown} (Ctrl-C ends it)").and_then(|()| stdout.flush());
    let api = Api {
        shared: shared.clone(),
        guard: Guard::new(local, token),
        folder,
        port,
        may_be_silent,
        rehearses: arguments.rehearse,
    };
    connections::serve(&listener, &stop, move |request| api.answer(request)).map_err(fail)?;
    // The thread has seen the same flag; it leaves the card quiet.
    let _ = collecting.join();
    let ended = shared.state().end_recording();
    ended.map_err(|text| CommandError::CheckFailed(vec![text]))?;
    Ok(Outcome::default())
}
