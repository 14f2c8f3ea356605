//! The fourteen mode commands, from the encoder's side.

/// A receiver's command with its six bits. The first seven are EnDat 2.1, the others EnDat 2.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Position, without F2.
    SendPosition,
    /// Echo; selects a memory area.
    SelectMemory,
    /// Echo; writes a word.
    ReceiveParameter,
    /// Sends a word.
    SendParameter,
    /// Echo; restarts the encoder.
    ReceiveReset,
    /// 40 bits of test values.
    SendTestValues,
    /// Echo of port and data.
    ReceiveTestCommand,
    /// Position with the selected additional data.
    Position,
    /// As `Position`; the supplement selects a memory area or additional data.
    PositionSelectMemory,
    /// As `Position`; the supplement writes a word.
    PositionReceiveParameter,
    /// As `Position`; the supplement requests a word.
    PositionSendParameter,
    /// As `Position`; the supplement clears errors and warnings.
    PositionErrorReset,
    /// As `Position`; the supplement is a test command.
    PositionTestCommand,
    /// Echo of address and data.
    ReceiveCommunication,
}

impl Command {
    /// All commands, with their six bits (TI, ADDI-DATA and Renesas drivers agree).
    pub const ALL: [(u8, Self); 14] = [
        (0b000_111, Self::SendPosition),
        (0b001_110, Self::SelectMemory),
        (0b011_100, Self::ReceiveParameter),
        (0b100_011, Self::SendParameter),
        (0b101_010, Self::ReceiveReset),
        (0b010_101, Self::SendTestValues),
        (0b110_001, Self::ReceiveTestCommand),
        (0b111_000, Self::Position),
        (0b001_001, Self::PositionSelectMemory),
        (0b011_011, Self::PositionReceiveParameter),
        (0b100_100, Self::PositionSendParameter),
        (0b101_101, Self::PositionErrorReset),
        (0b110_110, Self::PositionTestCommand),
        (0b010_010, Self::ReceiveCommunication),
    ];

    /// Decodes the six bits.
    pub(super) fn decode(code: u8, endat22: bool) -> Option<Self> {
        let (_, command) = Self::ALL.into_iter().find(|c| c.0 == code)?;
        (endat22 || !command.is_endat22()).then_some(command)
    }

    /// True if only EnDat 2.2 encoders support it.
    pub fn is_endat22(self) -> bool {
        self.has_f2() || self == Self::ReceiveCommunication
    }

    /// True if the answer is a position with F1 and F2.
    pub fn has_f2(self) -> bool {
        self == Self::Position || self.has_supplement()
    }

    /// True if 8 and 16 bits follow the mode command, and the answer repeats them.
    pub fn has_parameter(self) -> bool {
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

    /// True if the receiver sends 8 and 16 bits after the answer.
    pub fn has_supplement(self) -> bool {
        matches!(
            self,
            Self::PositionSelectMemory
                | Self::PositionReceiveParameter
                | Self::PositionSendParameter
                | Self::PositionErrorReset
                | Self::PositionTestCommand
        )
    }
}
