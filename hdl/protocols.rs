//! The protocols of a channel. Each is a folder; only this file and
//! [`EncoderPort`](crate::encoder_port::EncoderPort) name it in this crate.

pub mod ssi;
pub mod t_format;

pub use ssi::asked::SsiSpec;
pub use t_format::asked::TFormatSpec;

use endat_regs::Protocol;
use std::ops::RangeInclusive;

/// Protocol of a channel, with its specific request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spoken {
    /// EnDat: the request is the rest of the channel.
    #[default]
    Endat,
    /// T-format.
    TFormat(TFormatSpec),
    /// SSI.
    Ssi(SsiSpec),
}

/// The expression for EnDat, or that of another protocol with its request.
macro_rules! of_spoken {
    ($spoken:expr, $endat:expr, $asked:ident => $other:expr) => {
        match $spoken {
            $crate::protocols::Spoken::Endat => $endat,
            $crate::protocols::Spoken::TFormat($asked) => $other,
            $crate::protocols::Spoken::Ssi($asked) => $other,
        }
    };
}
pub(crate) use of_spoken;

impl Spoken {
    /// The protocol.
    pub const fn protocol(&self) -> Protocol {
        match self {
            Self::Endat => Protocol::Endat,
            Self::TFormat(_) => Protocol::TFormat,
            Self::Ssi(_) => Protocol::Ssi,
        }
    }

    /// Request for a T-format channel.
    pub const fn t_format(&self) -> Option<&TFormatSpec> {
        match self {
            Self::TFormat(asked) => Some(asked),
            _ => None,
        }
    }

    /// Request for an SSI channel.
    pub const fn ssi(&self) -> Option<&SsiSpec> {
        match self {
            Self::Ssi(asked) => Some(asked),
            _ => None,
        }
    }

    /// Value after reset of a field of `config` that only this protocol has.
    pub(crate) fn start(&self, register: &str, field: &str) -> Option<u64> {
        of_spoken!(self, None, asked => asked.start(register, field))
    }
}

/// Slowest clock of the protocols with a clock, in hertz.
pub(crate) const CLOCK_HZ_MIN: u64 = ssi::protocol::CLOCK_HZ_MIN;

/// Range of a key of one of the other protocols.
pub(crate) fn range(key: &str) -> Option<RangeInclusive<u64>> {
    [t_format::asked::range, ssi::asked::range]
        .iter()
        .find_map(|range| range(key))
}
