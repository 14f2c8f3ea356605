//! The program `endat-gen`; everything it does is in [`endat_gen::cli`].

use endat_gen::cli::{self, colour};
use std::io::ErrorKind;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut outcome = cli::painted(std::env::args_os());
    match colour::to_stdout(&outcome.stdout) {
        Ok(()) => {}
        // A reader that has gone away (`| head`) is not an error worth a message.
        Err(e) if e.kind() == ErrorKind::BrokenPipe => {}
        Err(e) => {
            let text = format!("stdout: cannot write: {e}; is the disk full?");
            outcome.messages.push(text);
            outcome.exit_code = outcome.exit_code.max(2);
        }
    }
    for message in &outcome.messages {
        colour::to_stderr(message, outcome.exit_code != 0);
    }
    ExitCode::from(outcome.exit_code)
}
