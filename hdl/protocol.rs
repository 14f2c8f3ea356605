//! EnDat protocol facts: mode commands, frame fields and bit counts. Plain Rust, no hardware.
//!
//! Ref: HEIDENHAIN Technical Information 383942 "EnDat 2.2 - Bidirectional Interface for Position Encoders";
//! HEIDENHAIN PWM 20 user's manual (Nov 2014), EnDat interface description;
//! Texas Instruments motor-control SDK, `position_sense/endat` (public source) for counts the brochures leave out.

/// A 6-bit mode command, sent MSB first.
///
/// The right triplet of the code is the complement of the left one in the 2.1 commands and in `111000`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ModeCommand {
    /// `000111`: encoder sends its position (EnDat 2.1 frame: start, F1, position, CRC).
    SendPosition,
    /// `111000`: encoder sends its position (EnDat 2.2 frame: start, F1, F2, position, CRC), then any selected additional information.
    SendPositionAddInfo,
}

impl ModeCommand {
    /// Every command this version of the core sends.
    pub const ALL: [Self; 2] = [Self::SendPosition, Self::SendPositionAddInfo];

    /// The six bits as they stand in the tables of the interface description.
    pub const fn code(self) -> u8 {
        match self {
            Self::SendPosition => 0b000_111,
            Self::SendPositionAddInfo => 0b111_000,
        }
    }

    /// The command with this code, if the core can send it.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.code() == code)
    }

    /// Whether the answer carries F2 after F1 (EnDat 2.2 position frame).
    pub const fn has_f2(self) -> bool {
        matches!(self, Self::SendPositionAddInfo)
    }

    /// Error bits in the answer: F1, or F1 and F2.
    pub const fn error_bits(self) -> u32 {
        1 + self.has_f2() as u32
    }

    /// Bits from the start bit to the last CRC bit (`L`) for a position of `position_bits`.
    pub const fn answer_bits(self, position_bits: u32) -> u32 {
        START_BITS + self.error_bits() + position_bits + CRC_BITS
    }
}

/// Bits of a mode command.
pub const MODE_COMMAND_BITS: u32 = 6;
/// The falling clock edge (1 = first of the frame) on which the receiver enables its driver (PWM 20, TI).
pub const DRIVER_ON_FALL: u32 = 2;
/// The falling edge that launches the first bit of the mode command (TI capture).
pub const FIRST_COMMAND_FALL: u32 = 3;
/// The falling edge on which the receiver releases the data line: one after the last command bit.
pub const DRIVER_OFF_FALL: u32 = FIRST_COMMAND_FALL + MODE_COMMAND_BITS;
/// Complete clock pulses before the earliest start bit: 2T + mode command + 2T (PWM 20; other receivers agree).
pub const LEAD_PULSES: u32 = 2 + MODE_COMMAND_BITS + 2;
/// Start bits of an answer.
pub const START_BITS: u32 = 1;
/// Bits of the CRC.
pub const CRC_BITS: u32 = 5;
/// Position widths that the core takes, in bits.
pub const POSITION_BITS: std::ops::RangeInclusive<u32> = 1..=48;
/// Widest position, in bits.
pub const MAX_POSITION_BITS: u32 = *POSITION_BITS.end();
/// CRC5 generator x^5+x^3+x+1 without its leading term.
pub const CRC5_POLYNOMIAL: u8 = 0b0_1011;
/// CRC5 register before the first bit.
pub const CRC5_PRESET: u8 = 0b1_1111;
/// CRC5 register after the (inverted) received CRC itself has gone through it.
pub const CRC5_RESIDUE: u8 = 0b0_1000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mode_commands_carry_their_redundancy() {
        for c in ModeCommand::ALL {
            assert_eq!(c.code() >> 3, !c.code() & 0b111, "{c:?}");
            assert_eq!(ModeCommand::from_code(c.code()), Some(c));
        }
        assert_eq!(ModeCommand::from_code(0), None);
    }

    #[test]
    fn answer_of_the_rcn_8510_has_37_bits() {
        assert_eq!(ModeCommand::SendPositionAddInfo.answer_bits(29), 37);
        assert_eq!(ModeCommand::SendPosition.answer_bits(36), 43);
    }
}
