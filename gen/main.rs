//! The program `endat-gen`; everything it does is in [`endat_gen::cli`].

use endat_gen::cli;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut outcome = cli::run(std::env::args_os());
    let mut stdout = std::io::stdout();
    let written = stdout.write_all(outcome.stdout.as_bytes());
    match written.and_then(|()| stdout.flush()) {
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
        let _ = writeln!(std::io::stderr(), "endat-gen: {message}");
    }
    ExitCode::from(outcome.exit_code)
}
