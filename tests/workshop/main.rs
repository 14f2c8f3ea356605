//! The program of the workshop; everything it does is in its library.

use endat_terminal::outcome::main_of;
use std::process::ExitCode;

fn main() -> ExitCode {
    main_of("endat-workshop", || {
        endat_workshop::cli::painted(std::env::args_os())
    })
}
