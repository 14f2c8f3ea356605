//! Tests of the whole system, one module per topic.

mod cli;
mod config;
mod constraints;
mod program;
mod sim;
