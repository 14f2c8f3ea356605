//! The program `endat`; everything it does is in its library.

use endat_terminal::outcome::main_of;
use std::process::ExitCode;

fn main() -> ExitCode {
    main_of("endat", || endat::painted(std::env::args_os()))
}
