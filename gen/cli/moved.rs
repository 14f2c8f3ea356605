//! Commands that moved to the program `endat`: an old spelling prints the new one, and runs it if `endat` is installed.

use endat_console::error::CommandError;
use endat_terminal::outcome::Outcome;
use endat_terminal::work::say;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;

/// Commands of this program before version 0.2.
const MOVED: [&str; 13] = [
    "card", "id", "inject", "log", "margin", "monitor", "param", "plot", "read", "reg", "serve",
    "stats", "view",
];
/// Commands of the workshop, which is not shipped.
const WORKSHOP: [&str; 2] = ["bench", "flows"];

/// The program `endat` next to this one, or the one in PATH.
fn endat() -> PathBuf {
    let name = format!("endat{}", std::env::consts::EXE_SUFFIX);
    let beside = std::env::current_exe()
        .ok()
        .map(|own| own.with_file_name(&name));
    match beside {
        Some(path) if path.is_file() => path,
        _ => name.into(),
    }
}

/// Runs a command that moved; `None` if the words after the program's name begin with no such command.
pub fn run(words: &[OsString]) -> Option<Result<Outcome, CommandError>> {
    let name = words.first()?.to_str()?;
    if WORKSHOP.contains(&name) {
        return Some(Err(CommandError::input(format!(
            "{name}: is a command of the workshop, in a clone of the project: `cargo run -p endat-workshop -- {name}`"
        ))));
    }
    MOVED.contains(&name).then(|| run_moved(name, words))
}

fn run_moved(name: &str, words: &[OsString]) -> Result<Outcome, CommandError> {
    let now = format!("`endat-gen {name}` is `endat {name}` now");
    let started = Command::new(endat()).args(words).spawn();
    let ended = started.and_then(|mut child| {
        say(&now);
        child.wait()
    });
    match ended {
        Ok(status) => Ok(Outcome {
            exit_code: status.code().and_then(|code| code.try_into().ok()).unwrap_or(1),
            ..Outcome::default()
        }),
        Err(_) => Err(CommandError::input(format!(
            "{now}, and the program endat is not there; install it with `cargo install --path drivers/cli`, or run `cargo run -p endat -- {name}` in a clone"
        ))),
    }
}
