//! What is beside a core in VHDL: the benches, one with encoders and one that plays recorded vectors, and what a VHDL design takes a core in with.

mod bench;
mod component;
mod host;
mod play;
mod replay;

pub use bench::artifact as bench;
pub use component::artifacts as component;
pub use play::{card, receiver, Played};
pub use replay::{artifacts as replay, other_program};
