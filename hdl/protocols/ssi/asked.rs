//! Request for an SSI channel.

use super::protocol::{BIT_DELAY_NS, BIT_DELAY_NS_MAX};
use super::specials::{Special, Specials};
use endat_regs::protocols::ssi::frame;
use std::ops::RangeInclusive;

/// Parity bit after the position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Parity {
    /// No parity bit.
    #[default]
    None,
    /// Even number of ones, including the parity bit.
    Even,
    /// Odd number of ones, including the parity bit.
    Odd,
}

/// Request for such a channel, in addition to clock, width, filter and recovery time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SsiSpec {
    /// The position is in Gray code.
    pub gray: bool,
    /// The encoder sends each position twice; the card compares the two.
    pub twice: bool,
    /// Parity bit after each position.
    pub parity: Parity,
    /// Special bits before the position.
    pub before: Specials,
    /// Bits after the position, and after its parity bit.
    pub after: Specials,
    /// The encoder keeps its last bit on the line, instead of LOW, until the recovery time is over.
    pub holds_end: bool,
    /// Longest time from a rising clock edge to its bit, at the encoder, in ns.
    pub bit_delay_ns: u64,
}

impl Default for SsiSpec {
    fn default() -> Self {
        Self {
            gray: false,
            twice: false,
            parity: Parity::None,
            before: Specials::default(),
            after: Specials::default(),
            holds_end: false,
            bit_delay_ns: BIT_DELAY_NS,
        }
    }
}

impl SsiSpec {
    /// True if a parity bit follows the position.
    pub const fn has_parity(&self) -> bool {
        !matches!(self.parity, Parity::None)
    }

    /// True if there are special bits, not counting that parity bit.
    pub const fn has_specials(&self) -> bool {
        !self.before.is_empty() || !self.after.is_empty()
    }

    /// The special bits, in the order of transmission.
    pub fn specials(&self) -> impl Iterator<Item = Special> + '_ {
        self.before.iter().chain(self.after.iter())
    }

    /// Bits of a copy.
    pub fn copy_bits(&self, position_bits: u32) -> u64 {
        let others = usize::from(self.has_parity()) + self.before.bits() + self.after.bits();
        u64::from(position_bits) + others as u64
    }

    /// Falling edges of the clock in a frame.
    pub fn clocks(&self, position_bits: u32) -> u64 {
        (self.copy_bits(position_bits) + 1) * (1 + u64::from(self.twice))
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

    /// Value of a field after reset, if it differs from EnDat.
    pub(crate) fn start(&self, register: &str, field: &str) -> Option<u64> {
        (register == "frame" && field == "command").then(|| self.frame())
    }
}

/// Range of a key that only SSI has.
pub(crate) fn range(key: &str) -> Option<RangeInclusive<u64>> {
    (key == "bit_delay_ns").then_some(0..=BIT_DELAY_NS_MAX)
}
