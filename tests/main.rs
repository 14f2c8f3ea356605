//! Tests of the whole system, one module per topic.

mod cli;
mod config;
mod constraints;
mod elaborate;
mod files;
mod pages;
mod position;
mod program;
mod sim;
mod three_way;
mod tools;
mod verilog;
