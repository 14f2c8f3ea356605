//! Code that programs and libraries share: messages with exit codes, numbers that options take, files that are written whole.

pub mod artifact;
pub mod did_you_mean;
pub mod error;
pub mod number;
