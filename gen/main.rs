//! The program `endat-gen`; everything it does is in [`endat_gen::cli`].

use endat_gen::cli::{self, colour};
use std::io::ErrorKind;
use std::process::ExitCode;

/// A file that the shell allows no more of is an error of the write, as a full disk is: not the end of the program in the middle of a line.
#[cfg(unix)]
fn outlive_limits() {
    let limit = signal_hook::consts::SIGXFSZ;
    // Nobody looks at the flag. Where it cannot be had all is as it was.
    let _ = signal_hook::flag::register(limit, Default::default());
}

fn main() -> ExitCode {
    #[cfg(unix)]
    outlive_limits();
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
