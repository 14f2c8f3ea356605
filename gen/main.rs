//! The program `endat-gen`; everything it does is in [`endat_gen::cli`].

use endat_gen::cli;
use endat_terminal::outcome::main_of;
use std::process::ExitCode;

fn main() -> ExitCode {
    main_of("endat-gen", || cli::painted(std::env::args_os()))
}
