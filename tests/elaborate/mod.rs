//! From kernels to the typed design to Verilog: every construct, three ways.

mod core;
mod errors;
mod generator;
mod lint;
mod memories;
mod mismatch;
mod program;
mod random;
mod source_check;
mod trim;
mod zoo;
