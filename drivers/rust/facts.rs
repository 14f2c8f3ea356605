//! What a card says of itself.

use endat_regs::{Part, CHANNELS_MAX};

/// What a card says of itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// Major, minor and patch version of its register map.
    pub version: [u8; 3],
    /// First 8 digits of the hash in the generated files.
    pub configuration_hash: u32,
    /// The unit of every number of cycles.
    pub system_hz: u32,
    /// Encoder ports.
    pub channels: usize,
    /// Widest position.
    pub max_position_bits: u32,
    /// Bit n: channel n speaks T-format.
    pub t_format_channels: u32,
    /// Parts 0 to 15, then 16 to 31.
    pub(crate) features: u32,
}

impl Facts {
    /// Whether the card has this part.
    pub const fn has(&self, part: Part) -> bool {
        self.features >> part as u32 & 1 == 1
    }

    /// Whether a channel speaks T-format.
    pub const fn is_t_format(&self, channel: usize) -> bool {
        channel < CHANNELS_MAX && self.t_format_channels >> channel & 1 == 1
    }
}
