//! Identification of a card.

use endat_regs::{Part, Protocol, Protocols, CHANNELS_MAX};

/// Identification of a card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// Major, minor and patch version of its register map.
    pub version: [u8; 3],
    /// First 8 digits of the hash in the generated files.
    pub configuration_hash: u32,
    /// System clock in hertz: the unit of every number of cycles.
    pub system_hz: u32,
    /// Encoder ports.
    pub channels: usize,
    /// Widest position.
    pub max_position_bits: u32,
    /// Protocol of each channel.
    pub protocols: Protocols,
    /// Parts 0 to 15, then 16 to 31.
    pub(crate) features: u32,
}

impl Facts {
    /// True if the card has this part.
    pub const fn has(&self, part: Part) -> bool {
        self.features >> part as u32 & 1 == 1
    }

    /// Protocol of a channel; EnDat for an absent channel.
    pub const fn protocol(&self, channel: usize) -> Protocol {
        match channel < CHANNELS_MAX {
            true => self.protocols.of(channel),
            false => Protocol::Endat,
        }
    }
}
