//! The generator: its command line, and what it explains by itself.

pub mod cli;
pub mod crc;
