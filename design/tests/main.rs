//! Tests of the whole way: blocks, designs, engines, Verilog, VHDL.

mod bundles;
mod clean;
mod clocked;
mod comments;
mod designs;
mod errors;
mod generator;
mod ghdl;
mod header;
mod lint;
mod memories;
mod mismatch;
mod mutants;
mod program;
mod random;
mod rng;
mod stimulus;
mod three_way;
mod tools;
mod trim;
mod vhdl;
mod zoo;
