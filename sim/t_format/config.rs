//! Configuration of a T-format encoder, with its faults.

use crate::{Time, MS, US};

/// An encoder and its present state.
#[derive(Clone, Debug)]
pub struct EncoderConfig {
    /// Bit rate, in bits per second.
    pub bit_hz: u64,
    /// Deviation of its rate, in parts per million.
    pub rate_error_ppm: i64,
    /// Time from the end of the request to the start bit of the reply.
    pub reply_gap: Time,
    /// Largest deviation of each edge.
    pub jitter: Time,
    /// Shortest time from the end of a reply to the next request.
    pub rest: Time,
    /// Single-turn position, 24 bits.
    pub single_turn: u32,
    /// Multi-turn position, 24 bits.
    pub multi_turn: u32,
    /// Kind of encoder.
    pub encoder_id: u8,
    /// Status field, without error bits.
    pub status: u8,
    /// Alarm field.
    pub alarm: u8,
    /// Pages of the EEPROM, of 127 bytes each.
    pub eeprom_pages: u8,
    /// Time that the EEPROM is busy with a byte.
    pub write_time: Time,
    /// Fault.
    pub defect: Defect,
    /// Seed of the jitter.
    pub seed: u64,
}

impl Default for EncoderConfig {
    /// A TS5700N8401 with an empty battery, as in the published log.
    fn default() -> Self {
        Self {
            bit_hz: 2_500_000,
            rate_error_ppm: 0,
            reply_gap: 28 * US / 10,
            jitter: 0,
            rest: US / 2,
            single_turn: 0,
            multi_turn: 0,
            encoder_id: 0x17,
            status: 0x20,
            alarm: 0xC8,
            eeprom_pages: 8,
            // No source: typical for such memories.
            write_time: 5 * MS,
            defect: Defect::None,
            seed: 1,
        }
    }
}

impl EncoderConfig {
    /// Duration of a bit at the nominal rate.
    pub fn nominal_bit(&self) -> Time {
        1_000_000_000_000 / self.bit_hz
    }
}

/// Fault of a reply. Fields count from 0, the control field; bits of a field from 0, the first data bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// Nothing.
    None,
    /// No reply.
    Silent,
    /// The line is held LOW.
    StuckLow,
    /// A reply with another ID and matching parity.
    OtherId(u8),
    /// A wrong bit; CRC and parity match the right one.
    Flip {
        /// Field.
        field: usize,
        /// Bit.
        bit: usize,
    },
    /// A delimiter is LOW.
    Delimiter {
        /// Field.
        field: usize,
    },
    /// The reply ends after this many fields.
    Short {
        /// Fields.
        fields: usize,
    },
    /// A pause before a field.
    Pause {
        /// Field.
        field: usize,
        /// Duration.
        length: Time,
    },
    /// Additional bits of the status field.
    Status(u8),
    /// A LOW pulse before the reply.
    Pulse {
        /// Time from its start to the start bit.
        ahead: Time,
        /// Duration.
        width: Time,
    },
}
