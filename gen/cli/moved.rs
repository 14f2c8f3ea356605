//! Commands that the program `endat` has now: an old spelling says the new one, and runs it where it is there.

use endat_console::error::CommandError;
use endat_terminal::outcome::Outcome;
use endat_terminal::work::say;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;

/// They were commands of this program until version 0.2.
const MOVED: [&str; 13] = [
    "card", "id", "inject", "log", "margin", "monitor", "param", "plot", "read", "reg", "serve",
    "stats", "view",
];
/// Commands of the workshop, which is not shipped.
const WORKSHOP: [&str; 2] = ["bench", "flows"];

/// The program beside this one, or where the shell finds it.
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

/// Runs a command that is elsewhere now; none if the words after the program's name are none.
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
