//! Turns a configuration into the files of an EnDat receiver card. Makes text; only [`cli`] touches the disk.

pub mod board;
pub mod config;
pub mod error;
