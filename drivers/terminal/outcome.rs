//! The outcome of a run, and its way to the terminal.

use crate::colour;
use crate::work::{program, set_program};
use clap::Parser;
use endat_console::error::CommandError;
use std::ffi::OsString;
use std::io::ErrorKind;
use std::process::ExitCode;

/// The outcome of a run of a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Results.
    pub stdout: String,
    /// Messages, one a line.
    pub messages: Vec<String>,
    /// 0 good, 1 a check failed, 2 wrong usage or input.
    pub exit_code: u8,
}

impl Outcome {
    /// A good result.
    pub fn good(stdout: impl Into<String>) -> Self {
        Self {
            stdout: stdout.into(),
            ..Self::default()
        }
    }

    /// The outcome of an error.
    pub fn failed(error: &CommandError) -> Self {
        Self {
            stdout: String::new(),
            messages: error.messages().to_vec(),
            exit_code: error.exit_code(),
        }
    }

    /// The same without colours.
    pub fn plain(self) -> Self {
        Self {
            stdout: colour::plain(&self.stdout),
            messages: self.messages.iter().map(|m| colour::plain(m)).collect(),
            exit_code: self.exit_code,
        }
    }

    /// Runs a program with these arguments, the first of which is its name; the outcome has colours.
    pub fn of<P: Parser>(
        arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>,
        execute: impl FnOnce(P) -> Result<Self, CommandError>,
    ) -> Self {
        match P::try_parse_from(arguments) {
            Ok(parsed) => execute(parsed).unwrap_or_else(|error| Self::failed(&error)),
            Err(error) if !error.use_stderr() => Self::good(error.render().ansi().to_string()),
            Err(error) => {
                let text = error.to_string();
                let messages = text
                    .trim_end()
                    .trim_start_matches("error: ")
                    .lines()
                    .filter(|l| !l.is_empty());
                Self {
                    stdout: String::new(),
                    messages: messages.map(str::to_owned).collect(),
                    exit_code: 2,
                }
            }
        }
    }

    /// Prints it, and gives the exit code of the program.
    pub fn print(mut self) -> ExitCode {
        match colour::to_stdout(&self.stdout) {
            Ok(()) => {}
            // A reader that has gone away (`| head`) is not an error worth a message.
            Err(e) if e.kind() == ErrorKind::BrokenPipe => {}
            Err(e) => {
                let text = format!("stdout: cannot write: {e}; is the disk full?");
                self.messages.push(text);
                self.exit_code = self.exit_code.max(2);
            }
        }
        for message in &self.messages {
            colour::to_stderr(program(), message, self.exit_code != 0);
        }
        ExitCode::from(self.exit_code)
    }
}

/// A file that the shell allows no more of is an error of the write, as a full disk is: not the end of the program in the middle of a line.
#[cfg(unix)]
fn outlive_limits() {
    let limit = signal_hook::consts::SIGXFSZ;
    // Nobody looks at the flag. Where it cannot be had all is as it was.
    let _ = signal_hook::flag::register(limit, Default::default());
}

/// The `main` of a program with this name.
pub fn main_of(name: &'static str, run: impl FnOnce() -> Outcome) -> ExitCode {
    set_program(name);
    #[cfg(unix)]
    outlive_limits();
    run().print()
}

/// Indented JSON with a newline at the end.
pub fn to_json(value: &impl serde::Serialize) -> Result<String, CommandError> {
    let text = serde_json::to_string_pretty(value);
    text.map(|t| t + "\n")
        .map_err(|e| CommandError::fault("JSON", &e))
}
