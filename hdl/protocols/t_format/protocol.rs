//! T-format protocol facts: requests, fields, rates and check sum. Plain Rust, no hardware.
//!
//! Ref: Kang et al., "A FPGA implementation of a rotary machine receiver with detecting a header on the asynchronous serial
//! communication system", 2004 (fields, header, seven-address map); Texas Instruments motor-control SDK,
//! `position_sense/tamagawa_over_soc_uart` (rates, requests); HPMicro SDK, `samples/drivers/sei` (EEPROM, logged frames);
//! Microchip T-Format Interface IP (error bits of the status field).

use endat_regs::protocols::t_format::request;

/// Bit rate, in bits per second.
pub const BIT_HZ: u64 = 2_500_000;
/// The faster rate of some encoders, in bits per second.
pub const FAST_BIT_HZ: u64 = 5_000_000;
/// Bits of a field: start (LOW), eight data bits LSB first, delimiter (HIGH).
pub const FIELD_BITS: u64 = 10;
/// System clocks that the `clk_select` pin chooses from, in hertz: LOW, HIGH.
pub const SYSTEM_HZ: [u64; 2] = [20_000_000, 60_000_000];
/// System clock cycles in a bit that the receiver supports.
pub const BIT_CYCLES: std::ops::RangeInclusive<u64> = 4..=127;
/// Fewest cycles in a bit on a card, with any system clock: an edge is timed to an eighth of a bit.
pub const CARD_BIT_CYCLES_MIN: u64 = 8;
/// Largest deviation of a card's bit rate from the nominal one, in parts per million: the start bit resynchronises each field,
/// so its last bit is off by at most a tenth of a bit.
pub const RATE_TOLERANCE_PPM: u64 = 10_000;
/// Rest between two exchanges of a port, in microseconds, up to one less; it begins within the last delimiter.
pub const REST_US: u64 = 2;
/// Longest pause before a reply that can be set, in microseconds.
pub const REPLY_GAP_US_MAX: u64 = 63;
/// Longest pause between two fields that can be set, in microseconds.
pub const FIELD_GAP_US_MAX: u64 = 7;
/// Longest filter at 2.5 Mbit/s and a clock of 20 MHz, in system clock cycles: less than half a bit.
pub const FILTER_CYCLES_MAX: u64 = 3;
/// A wait ends at most this many microseconds after its setting, and at most one microsecond before it.
pub const WAIT_GRACE_US: u64 = 3;
/// EEPROM address of the page register.
pub const EEPROM_PAGE_ADDRESS: u8 = 127;

/// Content of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Sync code 0, 1, 0, request ID LSB first, and the parity of the ID.
    Control,
    /// Bits 3..0 information, 4 counting error, 5 multi-turn alarm, 6 and 7 parity and delimiter error of the request.
    Status,
    /// A byte of the single-turn position, least significant first.
    SingleTurn,
    /// The kind of encoder.
    EncoderId,
    /// A byte of the multi-turn position, least significant first.
    MultiTurn,
    /// Alarms of the encoder.
    Alarm,
    /// EEPROM address; bit 7 of a reply: the memory is busy.
    Address,
    /// EEPROM data.
    Data,
    /// XOR of all bytes before it: the CRC x^8 + 1.
    Crc,
}

/// A request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Request {
    /// ID 0: single-turn position.
    SingleTurn,
    /// ID 1: multi-turn position.
    MultiTurn,
    /// ID 2: kind of encoder.
    EncoderId,
    /// ID 3: both positions, kind and alarms.
    Everything,
    /// ID 6: writes a byte of the EEPROM.
    WriteEeprom,
    /// ID 7: clears errors; takes ten requests in a row.
    ClearErrors,
    /// ID 8: makes the present angle zero; takes ten requests in a row.
    ClearSingleTurn,
    /// ID C: clears turns and errors; takes ten requests in a row.
    ClearMultiTurn,
    /// ID D: reads a byte of the EEPROM.
    ReadEeprom,
}

impl Request {
    /// All requests.
    pub const ALL: [Self; 9] = [
        Self::SingleTurn,
        Self::MultiTurn,
        Self::EncoderId,
        Self::Everything,
        Self::WriteEeprom,
        Self::ClearErrors,
        Self::ClearSingleTurn,
        Self::ClearMultiTurn,
        Self::ReadEeprom,
    ];

    /// The ID on the wire, 4 bits.
    pub const fn id(self) -> u8 {
        match self {
            Self::SingleTurn => request::SINGLE_TURN,
            Self::MultiTurn => request::MULTI_TURN,
            Self::EncoderId => request::ENCODER_ID,
            Self::Everything => request::EVERYTHING,
            Self::WriteEeprom => request::WRITE_EEPROM,
            Self::ClearErrors => request::CLEAR_ERRORS,
            Self::ClearSingleTurn => request::CLEAR_SINGLE_TURN,
            Self::ClearMultiTurn => request::CLEAR_MULTI_TURN,
            Self::ReadEeprom => request::READ_EEPROM,
        }
    }

    /// The request of an ID.
    pub fn from_id(id: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|r| r.id() == id)
    }

    /// The control byte of this request.
    pub const fn control(self) -> u8 {
        control(self.id())
    }

    /// Fields of the request.
    pub const fn sent(self) -> &'static [Content] {
        use Content::{Address, Control, Crc, Data};
        match self {
            Self::WriteEeprom => &[Control, Address, Data, Crc],
            Self::ReadEeprom => &[Control, Address, Crc],
            _ => &[Control],
        }
    }

    /// Fields of the reply.
    pub const fn reply(self) -> &'static [Content] {
        use Content::{
            Address, Alarm, Control, Crc, Data, EncoderId, MultiTurn, SingleTurn, Status,
        };
        match self {
            Self::MultiTurn => &[Control, Status, MultiTurn, MultiTurn, MultiTurn, Crc],
            Self::EncoderId => &[Control, Status, EncoderId, Crc],
            Self::Everything => &[
                Control, Status, SingleTurn, SingleTurn, SingleTurn, EncoderId, MultiTurn,
                MultiTurn, MultiTurn, Alarm, Crc,
            ],
            Self::WriteEeprom | Self::ReadEeprom => &[Control, Address, Data, Crc],
            _ => &[Control, Status, SingleTurn, SingleTurn, SingleTurn, Crc],
        }
    }

    /// Bits on the wire in both directions, without pauses.
    pub const fn wire_bits(self) -> u64 {
        FIELD_BITS * (self.sent().len() + self.reply().len()) as u64
    }
}

/// The control byte of an ID.
pub const fn control(id: u8) -> u8 {
    let id = id & 15;
    0b010 | id << 3 | ((id.count_ones() as u8 & 1) << 7)
}

/// The check sum of bytes.
pub fn crc(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum ^ byte)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_bytes_and_lengths_are_the_published_ones() {
        let rows = [
            (0x0, 0x02, 1, 6),
            (0x1, 0x8A, 1, 6),
            (0x2, 0x92, 1, 4),
            (0x3, 0x1A, 1, 11),
            (0x6, 0x32, 4, 4),
            (0x7, 0xBA, 1, 6),
            (0x8, 0xC2, 1, 6),
            (0xC, 0x62, 1, 6),
            (0xD, 0xEA, 3, 4),
        ];
        assert_eq!(rows.len(), Request::ALL.len());
        for ((id, control, sent, reply), request) in rows.into_iter().zip(Request::ALL) {
            assert_eq!(request.id(), id);
            assert_eq!(Request::from_id(id), Some(request));
            assert_eq!(request.control(), control, "{id:X}");
            assert_eq!(request.sent().len(), sent, "{id:X}");
            assert_eq!(request.reply().len(), reply, "{id:X}");
        }
        assert_eq!(Request::from_id(4), None);
        // 28 us and 48 us at 2.5 Mbit/s.
        assert_eq!(Request::SingleTurn.wire_bits(), 70);
        assert_eq!(Request::Everything.wire_bits(), 120);
    }

    #[test]
    fn crc_is_the_remainder_of_x8_plus_1() {
        // The division, bit by bit, LSB first.
        let divide = |bytes: &[u8]| {
            let mut rest = 0u8;
            for bit in bytes.iter().flat_map(|b| (0..8).map(move |i| b >> i & 1)) {
                rest = rest >> 1 | ((rest & 1) ^ bit) << 7;
            }
            rest
        };
        for bytes in [&[0x32, 0x7F, 0x01][..], &[0xEA, 0x01], &[0x1A, 0x20, 0x29]] {
            assert_eq!(crc(bytes), divide(bytes));
        }
        assert_eq!(crc(&[0x32, 0x01, 0x5A]), 0x69);
    }
}
