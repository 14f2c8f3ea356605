//! From kernels to the typed design to Verilog: every construct, three ways.

mod core;
mod lint;
mod source_check;
mod trim;
