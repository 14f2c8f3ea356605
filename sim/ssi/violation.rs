//! What a receiver can do wrong towards an SSI encoder.

use std::fmt;

/// A fault of the receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Violation {
    /// The clock stayed HIGH for the recovery time before the frame was whole, or went on behind it: so many rising edges.
    Clocks(u64),
    /// A pulse of the clock was shorter than the encoder's shortest.
    ShortPulse,
    /// The clock went on within the recovery time, and this encoder does not send a position twice.
    NoRepeat,
    /// The receiver drives DATA.
    Conflict,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Clocks(clocks) => write!(f, "a frame of {clocks} clocks"),
            Self::ShortPulse => f.write_str("a clock pulse that is too short"),
            Self::NoRepeat => f.write_str("clock within the recovery time"),
            Self::Conflict => f.write_str("DATA driven by the receiver"),
        }
    }
}
