//! The program `endat-gen`; everything it does is in [`endat_gen::cli`].

use endat_gen::cli;
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = cli::run(std::env::args_os());
    // A reader that has gone away (`| head`) is not an error worth a message.
    let _ = std::io::stdout().write_all(outcome.stdout.as_bytes());
    for message in &outcome.messages {
        let _ = writeln!(std::io::stderr(), "endat-gen: {message}");
    }
    ExitCode::from(outcome.exit_code)
}
