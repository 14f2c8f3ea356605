//! What is beside a core in VHDL: the bench that plays recorded vectors, and what a VHDL design takes a core in with.

mod bench;
mod component;
mod host;
mod play;

pub use bench::artifacts as bench;
pub use component::artifacts as component;
pub use play::{card, receiver, Played};
