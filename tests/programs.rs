//! The program, by its commands and from the host's side, and programs that are not ours.

#[allow(dead_code)] // other topics take the rest
mod bus_card;
mod campaign;
mod cli;
mod commands;
mod hosts;
mod integrators;
#[allow(dead_code)] // other topics take the rest
mod program;
mod python;
mod sim;
#[allow(dead_code, unused_imports)]
mod tools;
mod view;

/// These tests wait for programs more than they compute: twice as many at a time as the machine has cores.
#[ctor::ctor(unsafe)]
fn more_threads() {
    const THREADS: &str = "RUST_TEST_THREADS";
    if std::env::var_os(THREADS).is_none() {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        std::env::set_var(THREADS, (2 * cores).to_string());
    }
}
