//! Tests of the whole system, one module per topic.

mod cli;
mod config;
mod constraints;
mod position;
mod program;
mod sim;
