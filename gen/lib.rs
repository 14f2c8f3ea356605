//! x

pub mod verilog;
