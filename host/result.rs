//! The result of a channel, out of its words.

use crate::causes;
use crate::info::Info;
use crate::registers::Place;

/// Words of a result.
pub const WORDS: usize = endat_regs::RESULT.registers.len();

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
    /// The position as it was read fits the CRC that the encoder sent with it, or there is nothing to check.
    pub fits: bool,
    /// Additional data 1 and 2 of the same frame; none came on a card without requests.
    pub infos: [Info; 2],
}

/// CRC5 of EnDat over these bits, in the order received; bit by bit, since answers are no whole bytes.
fn crc5(bits: impl Iterator<Item = bool>) -> u32 {
    let step = |register: u32, bit: bool| {
        let feedback = (register >> 4 & 1 == 1) != bit;
        (register << 1 & 0x1F) ^ if feedback { 0x0B } else { 0 }
    };
    bits.fold(0x1F, step) ^ 0x1F
}

impl Reading {
    /// The results of all channels, out of the burst that reads them ([`endat_regs::result_words`]).
    pub fn of_burst(words: &[u32], channels: usize, has_infos: bool) -> Vec<Self> {
        let of_each = endat_regs::result_words(1, has_infos) as usize;
        let one = |channel: usize| {
            let mut own = [0; WORDS];
            let first = usize::from(endat_regs::RESULT.stride) * channel;
            own[..of_each].copy_from_slice(&words[first..][..of_each]);
            Self::new(&own)
        };
        (0..channels).map(one).collect()
    }

    /// Takes the words of a result apart.
    pub fn new(words: &[u32; WORDS]) -> Self {
        let field = |register: &str, field: &str| {
            let place = Place::field_at("result", register, field, 0);
            place.of(words[usize::from(place.register.offset)])
        };
        let position = u64::from(field("position_low", "value"))
            | u64::from(field("position_high", "value")) << 32;
        let width = field("position_high", "width");
        // F1 = 0, then F2 = 1 if there was one.
        let error_bits = [false, true].into_iter();
        let covered = error_bits
            .take(1 + field("position_high", "f2") as usize)
            .chain((0..width).map(|i| position >> i & 1 == 1));
        let fits =
            width == 0 || position >> width == 0 && crc5(covered) == field("position_high", "crc");
        Self {
            sequence: field("status", "sequence") as u16,
            cause: field("status", "cause") as u8,
            valid: field("status", "valid") != 0,
            fresh: field("status", "fresh") != 0,
            position,
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
            fits,
            infos: ["info_1", "info_2"].map(|name| {
                let word = words[usize::from(Place::at("result", name, 0).register.offset)];
                let bit = |name_of| field(name, name_of) != 0;
                Info::new(word & 0xFF_FFFF, bit("came"), bit("good"), false)
            }),
        }
    }

    /// The same if the position fits its CRC; otherwise without one: it was spoilt behind the check in the card.
    pub fn checked(self) -> Self {
        if self.fits {
            return self;
        }
        let cause = causes::number("upset").unwrap_or(self.cause);
        Self {
            valid: false,
            fresh: false,
            cause,
            ..self
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

    /// The bytes of the page are those of a card: what stands beside the high bits of the position is not left out.
    #[test]
    fn the_examples_of_the_programming_page_are_results_that_fit() {
        let page = include_str!("../docs/programming.md");
        let word = |line: &str| {
            let behind = line.rsplit("->").next().unwrap_or(line);
            let bytes = behind.split_whitespace().take(4);
            bytes.fold(0, |word, b| word << 8 | u32::from_str_radix(b, 16).unwrap())
        };
        let mut count = 0;
        let mut lines = page.lines();
        while let Some(line) = lines.next() {
            if !line.starts_with("02 03 00 00 01 80") {
                continue;
            }
            let mut words = [0; WORDS];
            for (to, line) in words
                .iter_mut()
                .zip([Some(line), lines.next(), lines.next()])
            {
                *to = word(line.unwrap());
            }
            let reading = Reading::new(&words);
            assert!(words[2] >> 24 == 29 && reading.fits, "{words:x?}");
            assert_eq!(reading.position, 0x0123_5678);
            count += 1;
        }
        assert_eq!(count, 2);
    }

    #[test]
    fn the_example_of_the_host_link_page() {
        // F1 = 0, F2 = 1, 36 bits.
        let covered = [false, true]
            .into_iter()
            .chain((0..36).map(|i| 0x9_0123_5678u64 >> i & 1 == 1));
        let crc = crc5(covered);
        let words = [
            0x00C0_0002,
            0x0123_5678,
            0x2400_0009 | 1 << 22 | crc << 16,
            77,
            (0x155 << 10) | (0x0A << 5) | 0x15,
            (1 << 30) | (1 << 29) | (0x123 << 16) | 500,
            0x0324_1234,
            0x0100_0000,
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
                fits: true,
                infos: [
                    Info {
                        came: true,
                        good: true,
                        due: false,
                        status: 0x24,
                        content: 0x1234,
                    },
                    Info {
                        came: true,
                        ..Info::default()
                    },
                ],
            }
        );
        assert_eq!(reading.infos[0].number(), 4);
        assert_eq!(reading.cause_name(), "none");
        assert_eq!(reading.checked(), reading);
        for bit in 0..36 {
            let mut spoilt = words;
            spoilt[1 + bit / 32] ^= 1 << (bit % 32);
            let checked = Reading::new(&spoilt).checked();
            assert_eq!(
                (checked.valid, checked.fresh, checked.cause_name()),
                (false, false, "upset"),
                "{bit}"
            );
        }
    }
}
