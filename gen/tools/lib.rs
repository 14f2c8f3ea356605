//! Starts the programs of others on an emission: proofs, area, bitstreams, linters and simulators.

pub mod area;
pub mod bitstream;
pub mod programs;
pub mod prove;
pub mod readers;
pub mod scratch;
