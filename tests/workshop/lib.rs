//! The workshop, which is not shipped: what measures this project itself, and makes the pages of its results.

pub mod bench;
mod boards;
pub mod cli;
pub mod flows;
pub mod mutants;
pub mod page;
