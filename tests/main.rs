//! Tests of the whole system, one module per topic.

mod alignment;
mod bus;
mod campaign;
mod cli;
mod config;
mod constraints;
mod cycle_time;
mod elaborate;
mod engines;
mod files;
mod host;
mod hosts;
mod integrators;
mod maps;
mod pages;
mod position;
mod program;
mod requests;
mod service;
mod shmoo;
mod sim;
mod stream;
mod t_format;
mod three_way;
mod tools;
mod verilog;
