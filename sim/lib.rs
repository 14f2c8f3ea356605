//! The bench of the EnDat receiver core: encoders, lines and hosts. Engines of [`rtl_design`] run the core.
//!
//! Time is continuous: [`Time`] counts picoseconds, and the models of encoder and line are not quantised to the
//! system clock.

pub mod bench;
pub mod campaign;
pub mod diagram;
pub mod encoder;
pub mod frame;
mod journal;
pub mod line;
pub mod rng;
pub mod scenario;
pub mod segments;
pub mod shmoo;
pub mod ssi;
pub mod t_format;
#[cfg(test)]
mod test_receiver;
pub mod wave;

pub use journal::Journal;

/// A point in time or a duration, in picoseconds.
pub type Time = u64;
/// Picoseconds in a nanosecond.
pub const NS: Time = 1_000;
/// Picoseconds in a microsecond.
pub const US: Time = 1_000_000;
/// Picoseconds in a millisecond.
pub const MS: Time = 1_000_000_000;
