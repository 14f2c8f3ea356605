//! What a T-format encoder is, and what may be wrong with it.

use crate::{Time, MS, US};

/// An encoder and its moment.
#[derive(Clone, Debug)]
pub struct EncoderConfig {
    /// Bit rate, in bits per second.
    pub bit_hz: u64,
    /// Its own rate is higher by this, in parts per million.
    pub rate_error_ppm: i64,
    /// From the end of the request to the start bit of the reply.
    pub reply_gap: Time,
    /// Each edge comes sooner or later by at most this.
    pub jitter: Time,
    /// Shortest time from the end of a reply to the next request.
    pub rest: Time,
    /// Single-turn position, 24 bits.
    pub single_turn: u32,
    /// Multi-turn position, 24 bits.
    pub multi_turn: u32,
    /// Kind of encoder.
    pub encoder_id: u8,
    /// Status field, without complaints.
    pub status: u8,
    /// Alarm field.
    pub alarm: u8,
    /// Pages of the EEPROM, of 127 bytes each.
    pub eeprom_pages: u8,
    /// How long the EEPROM is busy with a byte.
    pub write_time: Time,
    /// What is wrong with it.
    pub defect: Defect,
    /// For the jitter.
    pub seed: u64,
}

impl Default for EncoderConfig {
    /// A TS5700N8401 whose battery is empty, as in the published log.
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
            // No source: a usual time of such memories.
            write_time: 5 * MS,
            defect: Defect::None,
            seed: 1,
        }
    }
}

impl EncoderConfig {
    /// A bit of the nominal rate.
    pub fn nominal_bit(&self) -> Time {
        1_000_000_000_000 / self.bit_hz
    }
}

/// What may be wrong with a reply. Fields count from 0, the control field; bits of a field from 0, the first data bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// Nothing.
    None,
    /// No reply.
    Silent,
    /// The line is held LOW.
    StuckLow,
    /// A reply with another ID, its parity right.
    OtherId(u8),
    /// A bit is wrong; CRC and parity are those of the right one.
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
    /// There is a pause before a field.
    Pause {
        /// Field.
        field: usize,
        /// How long.
        length: Time,
    },
    /// More bits of the status field.
    Status(u8),
    /// A LOW pulse before the reply.
    Pulse {
        /// From its start to the start bit.
        ahead: Time,
        /// How long.
        width: Time,
    },
}
