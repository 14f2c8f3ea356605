//! Violations by the receiver of a T-format encoder.

use std::fmt;

/// A violation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Violation {
    /// The sync code of the request is not 0, 1, 0.
    Sync,
    /// The parity of the request's ID is wrong.
    Parity,
    /// A field of the request ends LOW.
    Delimiter,
    /// The CRC of the request is wrong.
    Crc,
    /// Unknown request ID.
    UnknownId(u8),
    /// A request without all its fields.
    Incomplete,
    /// An edge that is not on the grid of the nominal rate.
    BitWidth,
    /// The driver was off before the last delimiter had ended.
    ReleasedEarly,
    /// Both drivers are on.
    Conflict,
    /// A request before the reply to the previous one.
    Impatient,
    /// A request too soon after a reply.
    TooEarly,
}

impl Violation {
    /// True if the receiver drove into a reply, or too soon after it.
    pub fn is_collision(&self) -> bool {
        matches!(self, Self::Conflict | Self::Impatient | Self::TooEarly)
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sync => f.write_str("request without sync code"),
            Self::Parity => f.write_str("request with a wrong parity"),
            Self::Delimiter => f.write_str("request with a LOW delimiter"),
            Self::Crc => f.write_str("request with a wrong CRC"),
            Self::UnknownId(id) => write!(f, "request with the unknown ID {id:X}"),
            Self::Incomplete => f.write_str("request with too few fields"),
            Self::BitWidth => f.write_str("request with an edge off the bit grid"),
            Self::ReleasedEarly => f.write_str("driver off before the end of the request"),
            Self::Conflict => f.write_str("both drivers on"),
            Self::Impatient => f.write_str("request before the reply to the last one"),
            Self::TooEarly => f.write_str("request too soon after a reply"),
        }
    }
}
