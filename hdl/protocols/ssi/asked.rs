//! What is asked of a channel that speaks SSI.

use endat_regs::protocols::ssi::frame;
use std::ops::RangeInclusive;

/// A bit behind the position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Parity {
    /// There is none.
    #[default]
    None,
    /// With it the number of ones is even.
    Even,
    /// With it the number of ones is odd.
    Odd,
}

/// What is asked of such a channel besides clock, width, filter and recovery time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SsiSpec {
    /// The position is in Gray code.
    pub gray: bool,
    /// Each position comes twice, and the two are compared.
    pub twice: bool,
    /// What stands behind each.
    pub parity: Parity,
}

impl SsiSpec {
    /// Whether there is a parity bit.
    pub const fn has_parity(&self) -> bool {
        !matches!(self.parity, Parity::None)
    }

    /// Falling edges of the clock in a frame.
    pub const fn clocks(&self, position_bits: u32) -> u64 {
        (position_bits as u64 + self.has_parity() as u64 + 1) * (1 + self.twice as u64)
    }

    /// The bits of `config.frame.command`.
    pub const fn frame(&self) -> u64 {
        let parity = match self.parity {
            Parity::None => 0,
            Parity::Even => 1 << frame::PARITY,
            Parity::Odd => 1 << frame::PARITY | 1 << frame::ODD,
        };
        parity
            | 1 << frame::CLOCKED
            | (self.gray as u64) << frame::GRAY
            | (self.twice as u64) << frame::TWICE
    }

    /// What a field is in it after reset, if that is something else than in EnDat.
    pub(crate) fn start(&self, register: &str, field: &str) -> Option<u64> {
        (register == "frame" && field == "command").then(|| self.frame())
    }
}

/// Range of a key that only SSI has: none is a number.
pub(crate) fn range(_: &str) -> Option<RangeInclusive<u64>> {
    None
}
