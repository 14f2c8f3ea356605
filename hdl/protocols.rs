//! The protocols that a channel may speak. Each is a folder; in addition it has this file, and its place in
//! [`EncoderPort`](crate::encoder_port::EncoderPort), are all of this crate that knows it by name.

pub mod ssi;
pub mod t_format;

pub use ssi::asked::SsiSpec;
pub use t_format::asked::TFormatSpec;

use endat_regs::Protocol;
use std::ops::RangeInclusive;

/// What a channel speaks, with what only that protocol is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spoken {
    /// EnDat: what is asked for is the rest of the channel.
    #[default]
    Endat,
    /// T-format.
    TFormat(TFormatSpec),
    /// SSI.
    Ssi(SsiSpec),
}

/// What EnDat does, or what the other protocol does with what it is asked for.
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

    /// What is asked of a T-format channel.
    pub const fn t_format(&self) -> Option<&TFormatSpec> {
        match self {
            Self::TFormat(asked) => Some(asked),
            _ => None,
        }
    }

    /// What is asked of a channel that speaks SSI.
    pub const fn ssi(&self) -> Option<&SsiSpec> {
        match self {
            Self::Ssi(asked) => Some(asked),
            _ => None,
        }
    }

    /// What a field of `config` that only this protocol has is after reset.
    pub(crate) fn start(&self, register: &str, field: &str) -> Option<u64> {
        of_spoken!(self, None, asked => asked.start(register, field))
    }
}

/// Slowest clock of those that have one, in hertz.
pub(crate) const CLOCK_HZ_MIN: u64 = ssi::protocol::CLOCK_HZ_MIN;

/// Range of a key that only one of the other protocols has.
pub(crate) fn range(key: &str) -> Option<RangeInclusive<u64>> {
    [t_format::asked::range, ssi::asked::range]
        .iter()
        .find_map(|range| range(key))
}
