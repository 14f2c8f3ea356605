//! The result of a channel, out of its words.

use crate::causes;
use crate::registers::Place;

/// Words of a result.
pub const WORDS: usize = 6;
/// Words from one channel's result to the next one's.
pub const STRIDE: usize = 8;

/// What became of a channel's last trigger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Number of results, wrapping.
    pub sequence: u16,
    /// Primary cause, 0 = none; see [`causes`].
    pub cause: u8,
    /// There is a good position.
    pub valid: bool,
    /// The last result brought it.
    pub fresh: bool,
    /// Last good position.
    pub position: u64,
    /// First falling clock edge of the frame that brought it, in system clock cycles, wrapping.
    pub timestamp: u32,
    /// CRC as received and as computed.
    pub crc: [u8; 2],
    /// Tracked line delay, in system clock cycles.
    pub delay_cycles: u16,
    /// Age of the position in microseconds; stops at 65535.
    pub age_us: u16,
    /// A trigger of this channel has come since this result.
    pub stale: bool,
    /// Recovery time of the last frame, in system clock cycles.
    pub recovery_cycles: u16,
}

impl Reading {
    /// Takes the words of a result apart.
    pub fn new(words: &[u32; WORDS]) -> Self {
        let field = |register: &str, field: &str| {
            let place = Place::field_at("result", register, field, 0);
            place.of(words[usize::from(place.register.offset)])
        };
        Self {
            sequence: field("status", "sequence") as u16,
            cause: field("status", "cause") as u8,
            valid: field("status", "valid") != 0,
            fresh: field("status", "fresh") != 0,
            position: u64::from(field("position_low", "value"))
                | u64::from(field("position_high", "value")) << 32,
            timestamp: field("timestamp", "value"),
            crc: [
                field("evidence", "crc_received") as u8,
                field("evidence", "crc_computed") as u8,
            ],
            delay_cycles: (field("evidence", "delay_cycles")
                | field("age_recovery", "delay_high") << 10) as u16,
            age_us: field("age_recovery", "age_us") as u16,
            stale: field("age_recovery", "stale") != 0,
            recovery_cycles: field("age_recovery", "recovery_cycles") as u16,
        }
    }

    /// There has been a result since reset.
    pub fn has_come(&self) -> bool {
        self.sequence != 0 || self.valid || self.cause != 0
    }

    /// Name of the primary cause.
    pub fn cause_name(&self) -> &'static str {
        causes::name(self.cause)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_of_the_host_link_page() {
        let words = [
            0x00C0_0002,
            0x0123_5678,
            0x0000_0009,
            77,
            (0x155 << 10) | (0x0A << 5) | 0x15,
            (1 << 30) | (1 << 29) | (0x123 << 16) | 500,
        ];
        let reading = Reading::new(&words);
        assert_eq!(
            reading,
            Reading {
                sequence: 2,
                cause: 0,
                valid: true,
                fresh: true,
                position: 0x9_0123_5678,
                timestamp: 77,
                crc: [0x15, 0x0A],
                delay_cycles: 0x555,
                age_us: 500,
                stale: true,
                recovery_cycles: 0x123,
            }
        );
        assert_eq!(reading.cause_name(), "none");
    }
}
