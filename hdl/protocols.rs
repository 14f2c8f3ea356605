//! The protocols that a channel may speak. Each is a folder; beside it this file, its cycles in `config/spoken.rs` and its place in
//! [`EncoderPort`](crate::encoder_port::EncoderPort) are all of this crate that knows it by name.

use crate::t_format::asked;
pub use crate::t_format::asked::TFormatSpec;
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
}

impl Spoken {
    /// The protocol.
    pub const fn protocol(&self) -> Protocol {
        match self {
            Self::Endat => Protocol::Endat,
            Self::TFormat(_) => Protocol::TFormat,
        }
    }

    /// What is asked of a T-format channel.
    pub const fn t_format(&self) -> Option<&TFormatSpec> {
        match self {
            Self::TFormat(request) => Some(request),
            Self::Endat => None,
        }
    }

    /// What a field of `config` that only this protocol has is after reset.
    pub(crate) fn start(&self, register: &str, field: &str) -> Option<u64> {
        match self {
            Self::Endat => None,
            Self::TFormat(request) => request.start(register, field),
        }
    }
}

/// Range of a key that only one of the other protocols has.
pub(crate) fn range(key: &str) -> Option<RangeInclusive<u64>> {
    asked::range(key)
}
