//! Violations by the receiver of an SSI encoder.

use std::fmt;

/// A violation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Violation {
    /// The clock stayed HIGH for the recovery time before the frame was complete, or continued after it: number of rising edges.
    Clocks(u64),
    /// A pulse of the clock was shorter than the encoder's shortest.
    ShortPulse,
    /// The clock continued within the recovery time, and this encoder does not repeat a position.
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
