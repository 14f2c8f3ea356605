//! The register table: the one place that says which word and bit means what.
//!
//! ```text
//! 0x000  card: identification, capabilities, counters, strobes
//! 0x010  interrupt: status, mask, clear
//! 0x080  direct: 2 words of channel n at 0x080 + 8 n
//! 0x0C0  t_format: 4 words of channel n at 0x0C0 + 8 n
//! 0x100  configuration: 3 words of the card, then 3 words of channel n at 0x108 + 8 n
//! 0x180  results: 6 words of channel n at 0x180 + 8 n, 8 with requests
//! 0x200  line: 64 words of channel n at 0x200 + 64 n
//! 0x400  service: 128 words of channel n at 0x400 + 128 n
//! ```
//!
//! Offsets count 32-bit words. The decoder ([`crate::register_bank`]), the start values, the maps that come with a card and the
//! host's constants come from this table; within a major version an offset never moves.

mod line;
mod outputs;
mod service;
mod t_format;
mod table;
pub mod values;

pub use line::LINE;
pub use outputs::{DIRECT, INTERRUPT};
pub use service::SERVICE;
pub use t_format::T_FORMAT;
pub use table::{CARD, CARD_CONFIG, CHANNEL_CONFIG, RESULT};

use crate::config::CardConfig;
use crate::config_ring::RING_WORDS;
use crate::service::map::{self, COUNTER_POSITION_2};
use crate::transaction::cause;
use values::Values;

/// Major, minor and patch version of the register map.
pub const VERSION: [u8; 3] = [0, 9, 0];
/// Identification word: "EnDt" in ASCII, most significant byte first.
pub const ID: u32 = u32::from_be_bytes(*b"EnDt");
/// First word of the interrupt.
pub const INTERRUPT_BASE: u16 = 0x010;
/// First word of the direct outputs; block n is that of channel n.
pub const DIRECT_BASE: u16 = 0x080;
/// First word of the T-format ports; block n is that of channel n.
pub const T_FORMAT_BASE: u16 = 0x0C0;
/// First word of the configuration blocks; block 0 is the card's, block n + 1 that of channel n.
pub const CONFIG_BASE: u16 = 0x100;
/// First word of the result blocks; block n is that of channel n.
pub const RESULT_BASE: u16 = 0x180;
/// First word of the line blocks; block n is that of channel n.
pub const LINE_BASE: u16 = 0x200;
/// Words from one line block to the next.
pub const LINE_STRIDE: u16 = 64;
/// First word of the service blocks; block n is that of channel n.
pub const SERVICE_BASE: u16 = 0x400;
/// Words from one block to the next, but for lines and services.
pub const BLOCK_STRIDE: u16 = 8;
/// Most channels that the map and the decoder take.
pub const CHANNELS_MAX: usize = 8;

/// Words of the burst that gives the results of all channels of one moment, from [`RESULT_BASE`] on; the words between
/// two blocks are read too. With requests each result has its informations.
pub const fn result_words(channels: usize, requests: bool) -> u64 {
    let blocks_before = channels.saturating_sub(1) as u64;
    let words = if requests {
        RESULT.registers.len()
    } else {
        table::INFO_FIRST as usize
    };
    BLOCK_STRIDE as u64 * blocks_before + words as u64
}

/// What a host may do with a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read only: a write does nothing.
    ReadOnly,
    /// Read and write.
    ReadWrite,
    /// Write only: ones act once, a read gives 0.
    Strobe,
}

impl Access {
    /// Short form used in tables.
    pub const fn short(self) -> &'static str {
        match self {
            Self::ReadOnly => "ro",
            Self::ReadWrite => "rw",
            Self::Strobe => "strobe",
        }
    }
}

/// Numbers that the card takes, each range from and to; none = all that fit.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Of a channel that speaks EnDat, and of the card.
    pub endat: &'static [(u32, u32)],
    /// Of a channel that speaks T-format.
    pub t_format: &'static [(u32, u32)],
}

impl Limits {
    /// All numbers that fit.
    pub const ANY: Self = Self {
        endat: &[],
        t_format: &[],
    };
}

/// Some bits of a word.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Name, unique in its word.
    pub name: &'static str,
    /// Lowest bit.
    pub lsb: u32,
    /// Number of bits.
    pub width: u32,
    /// Unit of the number, or "".
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// Value after reset for a channel (0 for words of the card).
    pub start: fn(&CardConfig, usize) -> u64,
    /// What single numbers or bits stand for.
    pub values: Values,
    /// Which numbers the card takes.
    pub limits: Limits,
}

impl Field {
    /// The field's bits within its word.
    pub const fn mask(&self) -> u32 {
        (((1u64 << self.width) - 1) << self.lsb) as u32
    }

    /// The same field, with a list of what its numbers stand for.
    pub const fn codes(mut self, codes: &'static [values::Named]) -> Self {
        self.values = Values::Codes(codes);
        self
    }

    /// The same field, which takes these numbers only.
    pub const fn takes(
        mut self,
        endat: &'static [(u32, u32)],
        t_format: &'static [(u32, u32)],
    ) -> Self {
        self.limits = Limits { endat, t_format };
        self
    }

    /// The same field, with a list of what its bits stand for.
    pub const fn bits(mut self, bits: &'static [values::Named]) -> Self {
        self.values = Values::Bits(bits);
        self
    }
}

/// One word.
#[derive(Clone, Copy, Debug)]
pub struct Register {
    /// Name, unique in its block.
    pub name: &'static str,
    /// Word offset in its block.
    pub offset: u16,
    /// What a host may do with it.
    pub access: Access,
    /// One sentence.
    pub meaning: &'static str,
    /// Fields, lowest first; bits of no field read as 0, except in configuration words, which keep what is written.
    pub fields: &'static [Field],
}

impl Register {
    /// Value after reset.
    pub fn start(&self, config: &CardConfig, channel: usize) -> u32 {
        let part = |f: &Field| ((f.start)(config, channel) << f.lsb) as u32 & f.mask();
        self.fields
            .iter()
            .map(part)
            .fold(0, |word, part| word | part)
    }

    /// The field called `name`.
    pub fn field(&self, name: &str) -> Option<&'static Field> {
        self.fields.iter().find(|f| f.name == name)
    }
}

fn zero(_: &CardConfig, _: usize) -> u64 {
    0
}

/// A field that is 0 after reset.
const fn field(
    name: &'static str,
    lsb: u32,
    width: u32,
    unit: &'static str,
    meaning: &'static str,
) -> Field {
    Field {
        name,
        lsb,
        width,
        unit,
        meaning,
        start: zero,
        values: Values::Plain,
        limits: Limits::ANY,
    }
}

const fn word(
    name: &'static str,
    offset: u8,
    access: Access,
    meaning: &'static str,
    fields: &'static [Field],
) -> Register {
    Register {
        name,
        offset: offset as u16,
        access,
        meaning,
        fields,
    }
}

/// Words that stand together, once in the card or once for each channel.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Name; registers of a channel are called `<name><channel>_<register>`.
    pub name: &'static str,
    /// First word, for channel 0.
    pub base: u16,
    /// Words from one channel's to the next one's.
    pub stride: u16,
    /// Whether every channel has one.
    pub per_channel: bool,
    /// One sentence.
    pub meaning: &'static str,
    /// Whether it is RAM: 0 after power-up, and no reset clears it.
    pub is_ram: bool,
    /// Its words, lowest offset first.
    pub registers: &'static [Register],
}

impl Block {
    /// Word address of one of its registers.
    pub const fn address(&self, register: &Register, channel: usize) -> u16 {
        let block = if self.per_channel { channel as u16 } else { 0 };
        self.base + self.stride * block + register.offset
    }

    /// The register called `name`.
    pub fn register(&self, name: &str) -> Option<&'static Register> {
        self.registers.iter().find(|r| r.name == name)
    }

    /// Its words on this card: what only parts fill that the card does not have is left out.
    pub fn present(&self, config: &CardConfig) -> impl Iterator<Item = &'static Register> {
        let (base, parts) = (self.base, config.service);
        let first_line = u16::from(map::word::COUNTERS) + cause::NO_ENCODER as u16;
        let past_line = u16::from(map::word::COUNTERS + COUNTER_POSITION_2);
        let margin = config.line.margin;
        let stream = config.stream.fifo_bytes != 0;
        self.registers.iter().filter(move |register| {
            if base == CARD.base {
                return stream || register.offset < u16::from(table::STREAM_FIRST);
            }
            if base == RESULT_BASE {
                return parts.requests || register.offset < u16::from(table::INFO_FIRST);
            }
            if base == LINE_BASE {
                return margin || line::is_setting(register.offset);
            }
            let at = |word: u8| register.offset == u16::from(word);
            base != SERVICE_BASE
                || if at(map::word::PROGRESS) || register.offset >= u16::from(map::word::NAME_PLATE)
                {
                    parts.initialise
                } else if at(map::word::LIMITS)
                    || (first_line..past_line).contains(&register.offset)
                {
                    parts.diagnosis
                } else {
                    !at(map::word::CONTINUOUS) || parts.continuous
                }
        })
    }
}

/// All blocks, lowest base first.
pub const BLOCKS: [Block; 9] = [
    CARD,
    INTERRUPT,
    DIRECT,
    T_FORMAT,
    CARD_CONFIG,
    CHANNEL_CONFIG,
    RESULT,
    LINE,
    SERVICE,
];

/// The blocks that a card has.
pub fn blocks(config: &CardConfig) -> impl Iterator<Item = Block> {
    let (line, service) = (config.line.alignment, config.service.requests);
    let outputs = config.outputs;
    let t_format = config.t_format_channels() != 0;
    BLOCKS.into_iter().filter(move |block| match block.base {
        LINE_BASE => line,
        SERVICE_BASE => service,
        INTERRUPT_BASE => outputs.interrupt,
        DIRECT_BASE => outputs.any(),
        T_FORMAT_BASE => t_format,
        _ => true,
    })
}

/// The words of a configuration block after reset; `channel` is `None` for the card's own.
pub fn config_words(config: &CardConfig, channel: Option<usize>) -> [u32; RING_WORDS] {
    let mut words = [0; RING_WORDS];
    let block = if channel.is_some() {
        CHANNEL_CONFIG
    } else {
        CARD_CONFIG
    };
    for register in block.registers {
        words[register.offset as usize] = register.start(config, channel.unwrap_or(0));
    }
    words
}

#[cfg(test)]
pub(crate) mod tests;
