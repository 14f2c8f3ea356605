//! EnDat protocol facts: mode commands, frame fields and bit counts. Plain Rust, no hardware.
//!
//! Ref: HEIDENHAIN Technical Information 383942 "EnDat 2.2 - Bidirectional Interface for Position Encoders";
//! HEIDENHAIN PWM 20 user's manual (Nov 2014), EnDat interface description;
//! Texas Instruments motor-control SDK, `position_sense/endat` (public source) for counts the brochures leave out.

use crate::named::named;
use crate::Named;

/// A 6-bit mode command, sent MSB first; the names are the encoder's view.
///
/// The right triplet of the code repeats the left one. It is complemented in the 2.1 commands, in `111000` and in `010010`, and also in the 2.2
/// commands with a supplement. So an encoder can reject a corrupted command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ModeCommand {
    /// `000111`: send position (EnDat 2.1 frame: start, F1, position, CRC).
    SendPosition,
    /// `001110`: select a memory area; the answer repeats MRS code and data.
    SelectMemory,
    /// `011100`: receive parameter, writes a word; the answer repeats address and data.
    ReceiveParameter,
    /// `100011`: send parameter, reads a word.
    SendParameter,
    /// `101010`: receive reset, like a power cycle.
    ReceiveReset,
    /// `010101`: send test values: F1 and 40 bits.
    SendTestValues,
    /// `110001`: receive test command: port and data.
    ReceiveTestCommand,
    /// `111000`: send position (EnDat 2.2 frame: start, F1, F2, position, CRC), then any selected additional data.
    SendPositionAddInfo,
    /// `001001`: as `111000`, then a supplement that selects a memory area or additional data.
    PositionSelectMemory,
    /// `011011`: as `111000`, then a supplement that writes a word.
    PositionReceiveParameter,
    /// `100100`: as `111000`, then a supplement that requests a word.
    PositionSendParameter,
    /// `101101`: as `111000`, then a supplement that clears errors and warnings.
    PositionErrorReset,
    /// `110110`: as `111000`, then a supplement with a test command.
    PositionTestCommand,
    /// `010010`: receive communication command: address and data.
    ReceiveCommunication,
}

impl ModeCommand {
    /// Every command; the first seven are EnDat 2.1.
    pub const ALL: [Self; 14] = [
        Self::SendPosition,
        Self::SelectMemory,
        Self::ReceiveParameter,
        Self::SendParameter,
        Self::ReceiveReset,
        Self::SendTestValues,
        Self::ReceiveTestCommand,
        Self::SendPositionAddInfo,
        Self::PositionSelectMemory,
        Self::PositionReceiveParameter,
        Self::PositionSendParameter,
        Self::PositionErrorReset,
        Self::PositionTestCommand,
        Self::ReceiveCommunication,
    ];
    /// The commands that only read a position: the ones that a trigger sends.
    pub const POSITION: [Self; 2] = [Self::SendPosition, Self::SendPositionAddInfo];

    /// The six bits as in the tables of the interface description.
    pub const fn code(self) -> u8 {
        match self {
            Self::SendPosition => 0b000_111,
            Self::SelectMemory => 0b001_110,
            Self::ReceiveParameter => 0b011_100,
            Self::SendParameter => 0b100_011,
            Self::ReceiveReset => 0b101_010,
            Self::SendTestValues => 0b010_101,
            Self::ReceiveTestCommand => 0b110_001,
            Self::SendPositionAddInfo => 0b111_000,
            Self::PositionSelectMemory => 0b001_001,
            Self::PositionReceiveParameter => 0b011_011,
            Self::PositionSendParameter => 0b100_100,
            Self::PositionErrorReset => 0b101_101,
            Self::PositionTestCommand => 0b110_110,
            Self::ReceiveCommunication => 0b010_010,
        }
    }

    /// The command with this code.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.code() == code)
    }

    /// True if only EnDat 2.2 encoders support it.
    pub const fn is_endat22(self) -> bool {
        self.has_f2() || matches!(self, Self::ReceiveCommunication)
    }

    /// True if the answer is a position.
    pub const fn is_position(self) -> bool {
        matches!(self, Self::SendPosition) || self.has_f2()
    }

    /// True if the answer carries F2 after F1 (EnDat 2.2 position frame).
    pub const fn has_f2(self) -> bool {
        matches!(self, Self::SendPositionAddInfo) || self.has_supplement()
    }

    /// True if 8 and 16 bits follow the mode command; the answer then has the same fields.
    pub const fn has_parameter(self) -> bool {
        matches!(
            self,
            Self::SelectMemory
                | Self::ReceiveParameter
                | Self::SendParameter
                | Self::ReceiveReset
                | Self::ReceiveTestCommand
                | Self::ReceiveCommunication
        )
    }

    /// True if 8 and 16 bits follow the answer.
    pub const fn has_supplement(self) -> bool {
        matches!(
            self,
            Self::PositionSelectMemory
                | Self::PositionReceiveParameter
                | Self::PositionSendParameter
                | Self::PositionErrorReset
                | Self::PositionTestCommand
        )
    }

    /// Error bits in the answer: none, F1, or F1 and F2.
    pub const fn error_bits(self) -> u32 {
        match self.has_parameter() {
            true => 0,
            false => 1 + self.has_f2() as u32,
        }
    }

    /// Bits between error bits and CRC, for a position of `position_bits`.
    pub const fn payload_bits(self, position_bits: u32) -> u32 {
        match self {
            Self::SendTestValues => TEST_VALUE_BITS,
            _ if self.has_parameter() => PARAMETER_BITS,
            _ => position_bits,
        }
    }

    /// Bits from the start bit to the last CRC bit (`L`) for a position of `position_bits`, without additional data.
    pub const fn answer_bits(self, position_bits: u32) -> u32 {
        START_BITS + self.error_bits() + self.payload_bits(position_bits) + CRC_BITS
    }

    /// Complete clock pulses before the earliest start bit: the command with its parameter, and 2T on either side.
    pub const fn lead_pulses(self) -> u32 {
        match self.has_parameter() {
            true => LEAD_PULSES + PARAMETER_BITS,
            false => LEAD_PULSES,
        }
    }
}

const fn command(name: &'static str, command: ModeCommand, meaning: &'static str) -> Named {
    named(name, command.code() as u32, meaning)
}

const SEND_POSITION: Named = command(
    "send_position",
    ModeCommand::SendPosition,
    "000111 send position (EnDat 2.1)",
);
const SEND_POSITION_ADD_INFO: Named = command(
    "send_position_add_info",
    ModeCommand::SendPositionAddInfo,
    "111000 send position with additional data (EnDat 2.2)",
);

/// Mode commands that a trigger may send.
pub const POSITION_COMMANDS: &[Named] = &[SEND_POSITION, SEND_POSITION_ADD_INFO];

/// Mode commands that a request may send.
pub const MODE_COMMANDS: &[Named] = &[
    SEND_POSITION,
    command(
        "select_memory",
        ModeCommand::SelectMemory,
        "001110 selection of memory area",
    ),
    command(
        "receive_parameter",
        ModeCommand::ReceiveParameter,
        "011100 receive parameter",
    ),
    command(
        "send_parameter",
        ModeCommand::SendParameter,
        "100011 send parameter",
    ),
    command(
        "receive_reset",
        ModeCommand::ReceiveReset,
        "101010 receive reset",
    ),
    command(
        "send_test_values",
        ModeCommand::SendTestValues,
        "010101 send test values",
    ),
    command(
        "receive_test_command",
        ModeCommand::ReceiveTestCommand,
        "110001 receive test command",
    ),
    SEND_POSITION_ADD_INFO,
    command(
        "position_select_memory",
        ModeCommand::PositionSelectMemory,
        "001001 send position, then selection of memory area or additional data",
    ),
    command(
        "position_receive_parameter",
        ModeCommand::PositionReceiveParameter,
        "011011 send position, then receive parameter",
    ),
    command(
        "position_send_parameter",
        ModeCommand::PositionSendParameter,
        "100100 send position, then send parameter",
    ),
    command(
        "position_error_reset",
        ModeCommand::PositionErrorReset,
        "101101 send position, then receive error reset",
    ),
    command(
        "position_test_command",
        ModeCommand::PositionTestCommand,
        "110110 send position, then receive test command",
    ),
    command(
        "receive_communication",
        ModeCommand::ReceiveCommunication,
        "010010 receive communication command",
    ),
];

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
/// Bits of an MRS code, address or port, and of the data that follow it.
pub const PARAMETER_BITS: u32 = 8 + 16;
/// Bits of the test values (TI, C2000).
pub const TEST_VALUE_BITS: u32 = 40;
/// Bits of a block of additional data: a LOW bit, 24 bits, CRC.
pub const INFO_BITS: u32 = 1 + PARAMETER_BITS + CRC_BITS;
/// LOW bits before the start bit of a supplement (TI; fewer may do).
pub const SUPPLEMENT_ZEROS: u32 = 7;
/// Rising clock edges of a supplement: zeros, start bit, 24 bits, and three around them (TI capture).
pub const SUPPLEMENT_PULSES: u32 = SUPPLEMENT_ZEROS + 1 + PARAMETER_BITS + 3;
/// Start bits of an answer.
pub const START_BITS: u32 = 1;
/// Bits of the CRC.
pub const CRC_BITS: u32 = 5;
/// Position widths that the core takes, in bits.
pub const POSITION_BITS: core::ops::RangeInclusive<u32> = 1..=48;
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
            let (left, right) = (c.code() >> 3, c.code() & 0b111);
            let repeats = c.has_supplement() || c == ModeCommand::ReceiveCommunication;
            assert_eq!(left ^ right, if repeats { 0 } else { 0b111 }, "{c:?}");
            assert_eq!(ModeCommand::from_code(c.code()), Some(c));
        }
        assert_eq!(ModeCommand::from_code(0), None);
        let known = (0..64).filter(|c| ModeCommand::from_code(*c).is_some());
        assert_eq!(known.count(), 14, "no code twice");
    }

    #[test]
    fn lengths_are_those_of_the_sources() {
        assert_eq!(ModeCommand::SendParameter.answer_bits(13), 30);
        assert_eq!(ModeCommand::SendTestValues.answer_bits(13), 47);
        assert_eq!(ModeCommand::ReceiveReset.lead_pulses(), 34);
        assert_eq!((INFO_BITS, SUPPLEMENT_PULSES), (30, 35));
    }

    #[test]
    fn answer_of_the_rcn_8510_has_37_bits() {
        assert_eq!(ModeCommand::SendPositionAddInfo.answer_bits(29), 37);
        assert_eq!(ModeCommand::SendPosition.answer_bits(36), 43);
    }
}
