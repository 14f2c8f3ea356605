//! The range of a position: turns and an angle, or a place on a scale.

use crate::card::Card;
use crate::error::Error;
use crate::link::Link;
use crate::map::field;
use crate::result::signed;
use embedded_hal::delay::DelayNs;
use endat_regs::{range, Protocol};

/// The range of a channel's position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Range {
    /// The configuration does not define it; the name plate of an EnDat encoder may.
    #[default]
    Unknown,
    /// Turns and the angle within a turn.
    Rotary(Turns),
    /// A place on a scale, which does not wrap.
    Linear,
}

/// Where turns and angle are in a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turns {
    /// Bits of the angle.
    pub single_turn_bits: u32,
    /// Bits that count turns; 0: the encoder counts none.
    pub multi_turn_bits: u32,
    /// Lowest bit that counts turns.
    pub turns_at: u32,
}

/// The lowest `bits` bits.
const fn low(bits: u32) -> u64 {
    match bits {
        64.. => u64::MAX,
        bits => (1 << bits) - 1,
    }
}

impl Turns {
    /// Turn, and steps within it; `1 << single_turn_bits` steps are a turn.
    pub const fn split(self, position: u64) -> (u64, u64) {
        let turn = match position.checked_shr(self.turns_at) {
            Some(upper) => upper & low(self.multi_turn_bits),
            None => 0,
        };
        (turn, position & low(self.single_turn_bits))
    }

    /// Steps from the start of turn 0; wraps with the turns.
    pub const fn steps(self, position: u64) -> u64 {
        let (turn, step) = self.split(position);
        turn << self.single_turn_bits | step
    }

    /// Steps from one position to another, the shorter way round, past turns and the end of their count.
    pub const fn difference(self, from: u64, to: u64) -> i64 {
        let width = self.single_turn_bits + self.multi_turn_bits;
        signed(self.steps(to).wrapping_sub(self.steps(from)), width)
    }

    /// True if the bits between angle and turns are 0; otherwise the encoder uses more than `single_turn_bits`.
    pub const fn fits(self, position: u64) -> bool {
        position & low(self.turns_at) == position & low(self.single_turn_bits)
    }
}

impl Range {
    /// A range with `single_turn_bits` bits of angle and `multi_turn_bits` bits of turns, in a channel with `protocol`; `None` if its positions
    /// have fewer bits.
    pub const fn rotary(
        single_turn_bits: u32,
        multi_turn_bits: u32,
        protocol: Protocol,
    ) -> Option<Self> {
        let most = endat_regs::protocol::MAX_POSITION_BITS;
        let (turns_at, fits) = match protocol.row().turns_at {
            Some(at) => (at, single_turn_bits <= at && multi_turn_bits <= most - at),
            None => (
                single_turn_bits,
                single_turn_bits <= most && multi_turn_bits <= most - single_turn_bits,
            ),
        };
        match fits && single_turn_bits > 0 {
            true => Some(Self::Rotary(Turns {
                single_turn_bits,
                multi_turn_bits,
                turns_at,
            })),
            false => None,
        }
    }

    /// Decodes the words `config<n>.frame`, `timing` and `limits` of a channel.
    pub fn of_words([frame, timing, limits]: [u32; 3], protocol: Protocol) -> Self {
        let kind = field!(CHANNEL_CONFIG.limits.range).of(limits) as u8;
        let bits = field!(CHANNEL_CONFIG.frame.position_bits).of(frame);
        let turns = field!(CHANNEL_CONFIG.timing.multi_turn_bits).of(timing);
        let asked = field!(CHANNEL_CONFIG.timing.request_id).of(timing) as u8;
        // Other requests bring no turns: the turns in a position are from the last reply with turns.
        let requests = protocol.row().turns_with;
        let has_turns = requests.is_none_or(|all| all.contains(&asked));
        match kind {
            range::LINEAR => Self::Linear,
            range::ROTARY => {
                let told = if has_turns { turns } else { 0 };
                match Self::rotary(bits.saturating_sub(turns), told, protocol) {
                    Some(range) => range,
                    None => Self::Unknown,
                }
            }
            _ => Self::Unknown,
        }
    }

    /// The bits of turns and angle; `None` for a scale and for an unknown range.
    pub const fn turns(self) -> Option<Turns> {
        match self {
            Self::Rotary(turns) => Some(turns),
            Self::Unknown | Self::Linear => None,
        }
    }

    /// Steps from one position to another: the shorter way round, or along the scale; `None` for an unknown range.
    pub const fn difference(self, from: u64, to: u64) -> Option<i64> {
        match self {
            Self::Rotary(turns) => Some(turns.difference(from, to)),
            Self::Linear => Some(to.wrapping_sub(from) as i64),
            Self::Unknown => None,
        }
    }
}

impl<L: Link, D: DelayNs> Card<L, D> {
    /// Reads the range of a channel from the card's configuration.
    pub fn read_range(&mut self, channel: usize) -> Result<Range, Error<L::Error>> {
        if channel >= self.facts().channels {
            return Err(Error::Argument);
        }
        let protocol = self.facts().protocol(channel);
        Ok(Range::of_words(self.settings_words(channel)?, protocol))
    }
}
