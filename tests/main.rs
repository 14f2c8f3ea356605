//! Tests of the whole system, one module per topic.

mod alignment;
mod boards;
mod bus;
mod campaign;
mod cli;
mod commands;
mod comparison;
mod config;
mod constraints;
mod cycle_time;
mod documents;
mod driver;
mod elaborate;
mod engines;
mod files;
mod host;
mod hosts;
mod house;
mod integrators;
mod keys;
mod maps;
mod new;
mod own_triggers;
mod packages;
mod pages;
mod passed;
mod position;
mod presets;
mod program;
mod prove;
mod python;
mod requests;
mod service;
mod shmoo;
mod sim;
mod ssi;
mod strangers;
mod stream;
mod t_format;
mod tools;
mod verilog;
mod vhdl;
mod view;

// What the tests of design/ are made of, for whole cards.
#[path = "../design/tests/ghdl.rs"]
mod ghdl;
#[path = "../design/tests/stimulus.rs"]
mod stimulus;
#[path = "../design/tests/three_way.rs"]
mod three_way;
use endat_sim::rng;
