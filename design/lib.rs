#![doc = include_str!("README.md")]
//!
//! Reading order: [`reg`] and [`memory`] (the only state there is), [`elaborate`] (a block becomes a [`Design`](elaborate::Design)),
//! [`engine`] (runs it), [`verilog`] and [`vhdl`] (print it).

pub mod elaborate;
pub mod engine;
pub mod memory;
pub mod mutate;
mod printing;
pub mod reg;
pub mod verilog;
pub mod vhdl;

pub use printing::with_wrapped_comments;
pub use rtl_design_macros::{kernel, kernel_of_parts, kernel_parts, ports, Block, States};
