//! The program, by its commands and from the host's side, and programs that are not ours.

#[allow(dead_code)] // other topics take the rest
mod bus_card;
mod campaign;
mod cli;
mod commands;
mod cycle_time;
mod hosts;
mod integrators;
mod new;
#[allow(dead_code)] // other topics take the rest
mod program;
mod python;
mod shmoo;
mod sim;
#[allow(dead_code, unused_imports)]
mod tools;
mod view;
