//! The register table: defines the meaning of every word and bit.
//!
//! ```text
//! 0x000  card: identification, capabilities, counters, strobes
//! 0x010  interrupt: status, mask, clear
//! 0x040  recovery: 2 words of channel n at 0x040 + 8 n
//! 0x080  direct: 2 words of channel n at 0x080 + 8 n
//! 0x0C0  t_format: 4 words of channel n at 0x0C0 + 8 n
//! 0x100  configuration: 3 words of the card, then 3 words of channel n at 0x108 + 8 n
//! 0x180  results: 6 words of channel n at 0x180 + 8 n, 8 with requests
//! 0x200  line: 64 words of channel n at 0x200 + 64 n
//! 0x400  service: 128 words of channel n at 0x400 + 128 n
//! ```
//!
//! Offsets count 32-bit words. The card's blocks and kernels, the register maps and the host library read this table. An offset never moves
//! within a major version. The table is plain data, independent of hardware and configuration.

#![cfg_attr(not(test), no_std)]

#[cfg(feature = "alloc")]
extern crate alloc;

mod card;
pub mod causes;
mod config;
pub mod line;
mod named;
mod outputs;
mod part;
pub mod protocol;
pub mod protocol_row;
pub mod protocols;
mod recovery;
mod register;
mod result;
pub mod service;
#[cfg(feature = "alloc")]
mod text;

use register::{field, word};

pub use card::CARD;
pub use config::{range, CARD_CONFIG, CHANNEL_CONFIG};
pub use line::LINE;
pub use named::{Named, Values};
pub use outputs::{DIRECT, ERROR_CAUSES, INTERRUPT, INTERRUPT_EVENTS};
pub use part::{Part, FEATURES, FEATURES_BITS, MORE_FEATURES};
pub use protocols::t_format::T_FORMAT;
pub use protocols::{Protocol, Protocols};
pub use recovery::{COUNTER_SPACING, RECOVERY};
pub use register::{Access, Block, Field, Register};
pub use result::{EVIDENCE_FLAGS, INFO_FIRST, LINE_FLAGS, RESULT};
pub use service::SERVICE;

/// Major, minor and patch version of the register map; each added word or field raises minor (`regs/tests.rs` checks it).
pub const VERSION: [u8; 3] = [1, 1, 0];
/// Identification word: "EnDt" in ASCII, most significant byte first.
pub const ID: u32 = u32::from_be_bytes(*b"EnDt");
/// First word of the interrupt.
pub const INTERRUPT_BASE: u16 = 0x010;
/// First word of the recovery counters; block n belongs to channel n.
pub const RECOVERY_BASE: u16 = 0x040;
/// First word of the direct outputs; block n belongs to channel n.
pub const DIRECT_BASE: u16 = 0x080;
/// First word of the T-format ports; block n belongs to channel n.
pub const T_FORMAT_BASE: u16 = 0x0C0;
/// First word of the configuration blocks; block 0 belongs to the card, block n + 1 to channel n.
pub const CONFIG_BASE: u16 = 0x100;
/// First word of the result blocks; block n belongs to channel n.
pub const RESULT_BASE: u16 = 0x180;
/// First word of the line blocks; block n belongs to channel n.
pub const LINE_BASE: u16 = 0x200;
/// Words from one line block to the next.
pub const LINE_STRIDE: u16 = 64;
/// First word of the service blocks; block n belongs to channel n.
pub const SERVICE_BASE: u16 = 0x400;
/// Words from one block to the next, except for lines and services.
pub const BLOCK_STRIDE: u16 = 8;
/// Most channels that map and decoder support.
pub const CHANNELS_MAX: usize = 8;

/// Bytes of a word.
pub const WORD_BYTES: u32 = 4;
/// Size of the largest map in bytes.
pub const MAP_BYTES: u32 =
    WORD_BYTES * (SERVICE_BASE as u32 + SERVICE.stride as u32 * CHANNELS_MAX as u32);

/// Words of the burst that reads the results of all channels at one instant, from [`RESULT_BASE`] on. It includes the words between two blocks,
/// and with requests the additional data of each result.
pub const fn result_words(channels: usize, requests: bool) -> u64 {
    let blocks_before = channels.saturating_sub(1) as u64;
    let words = if requests {
        RESULT.registers.len()
    } else {
        result::INFO_FIRST as usize
    };
    BLOCK_STRIDE as u64 * blocks_before + words as u64
}

/// All blocks, lowest base first.
pub const BLOCKS: &[Block] = &[
    CARD,
    INTERRUPT,
    RECOVERY,
    DIRECT,
    T_FORMAT,
    CARD_CONFIG,
    CHANNEL_CONFIG,
    RESULT,
    LINE,
    SERVICE,
];

#[cfg(test)]
mod tests;
