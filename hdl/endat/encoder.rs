//! Encoder: answers mode commands as a position encoder does, at the other end of the line.
//!
//! ```text
//!          F1   R1 F2 R2 F3 R3      F8 R8 F9 R9 F10 R10 F11 R11       R(s)      R(s+L-1) R(s+L)
//! CLOCK ~~~~|____|~~|__|~~|__|~ .. ~|__|~~|__|~~~|___|~~~|___|~ .. ~|__|~ .. ~|__|~~~~~~~~|__|~~~~~~~~~~~~~~~~~~~~~
//! DATA  LOW | driver off            |               | LOW           | S  ..   | CRC0     | HIGH for tm | LOW
//! phase Idle|  Listen               |  Wait                         | F1 ..   | .. Tail  | Recovery    | Idle
//! ```
//!
//! `R(s)` launches the start bit: the first rising edge from `R11` on that comes `tcal_cycles` after `F1`. The encoder takes the position at
//! `F1`, and the alarms with the start bit. It answers `000111`, and `111000` without additional data. Any other mode command has no answer:
//! DATA is LOW from `F10` on, from `F34` on if the receiver sends a parameter with it.
//!
//! CLOCK and DATA pass two synchroniser stages. So DATA changes two to three system clock cycles after the edge of CLOCK at the pin, and a
//! system clock of 64 MHz is enough for a CLOCK of 16 MHz.
//!
//! CLOCK HIGH for more than 10 us within a frame ends the frame; CLOCK LOW for more than 50 ms, and a falling edge within the recovery time,
//! switch the driver off until CLOCK has been HIGH for 10 us. The block is in that state after a reset, too.
//!
//! The block shares the protocol's numbers with the receiver, and no logic.
//!
//! Ref: HEIDENHAIN PWM 20 user's manual (frame, tcal, tm, limits of CLOCK); TI motor-control SDK (launch on rising edges).

mod answer_errors;
mod crc;
mod line_input;
mod phase;
mod ports;

use crate::protocol::{ModeCommand, CRC_BITS, LEAD_PULSES, MODE_COMMAND_BITS, PARAMETER_BITS};
pub use answer_errors::bit_error;
use answer_errors::AnswerErrors;
use crc::SerialCrc;
use line_input::LineInput;
use phase::Phase;
pub use ports::{EncoderErrorsIn, EncoderLineOut, EncoderSettingsIn};
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;

/// Longest CLOCK HIGH within a frame, in microseconds (PWM 20: tHI).
pub const CLOCK_HIGH_MAX_US: u64 = 10;
/// Longest CLOCK LOW, in microseconds (PWM 20: tLO).
pub const CLOCK_LOW_MAX_US: u64 = 50_000;
/// From an edge of CLOCK at the pin to the change of DATA that it causes, in system clock cycles: at least this, and less than one more.
pub const CLOCK_TO_DATA_CYCLES: u64 = 2;

/// Edges of CLOCK before the first bit of the mode command: `R1` and `R2`.
const LEAD_IN: u32 = 2;
/// Rising edges from the last bit of a command to the last one before the earliest start bit.
const TURNAROUND: u32 = LEAD_PULSES - LEAD_IN - MODE_COMMAND_BITS;

/// Position encoder.
#[derive(LogicBlock, Block)]
#[properties("../properties/encoder.sv")]
pub struct Encoder {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// The encoder has plug and supply. Low: driver off, and the frame is lost.
    pub plugged: Signal<In, Bit>,
    /// Settings of an encoder.
    #[bundle]
    pub settings: EncoderSettingsIn,
    /// Errors that an encoder makes, if it can.
    #[bundle]
    pub wanted: EncoderErrorsIn,
    /// The position, bit 0 = LSB; taken with `latch`.
    pub position: Signal<In, Bits<48>>,
    /// Alarm 1: F1 = 1; taken with the start bit.
    pub alarm_1: Signal<In, Bit>,
    /// Alarm 2: F2 = 0; taken with the start bit.
    pub alarm_2: Signal<In, Bit>,
    /// The line, at the encoder's end.
    #[bundle]
    pub line: EncoderLineOut,
    /// High for one cycle with the first falling edge: the encoder takes the position at the end of this cycle.
    pub latch: Signal<Out, Bit>,
    /// High for one cycle when a whole mode command has come.
    pub command_strobe: Signal<Out, Bit>,
    /// With `command_strobe`: the mode command.
    pub command: Signal<Out, Bits<6>>,
    /// High for one cycle when the whole answer has been sent and the recovery time begins.
    pub answered: Signal<Out, Bit>,
    /// Low while the encoder is ready for a frame.
    pub busy: Signal<Out, Bit>,
    #[start]
    pins: LineInput,
    #[start]
    crc: SerialCrc,
    /// Errors on command, if the encoder makes them.
    errors: Vec<AnswerErrors>,
    /// What the encoder is doing.
    #[start(Phase::Deaf)]
    phase: Reg<Phase>,
    /// Rising edges until the part of the frame ends: 1 with its last one, then 0.
    left: Reg<Bits<6>>,
    /// The last five bits of the mode command.
    code: Reg<Bits<5>>,
    /// High if the answer has an F2; cleared when a frame begins.
    has_f2: Reg<Bit>,
    /// Bits of the position that are still to be sent, the next one in bit 0.
    word: Reg<Bits<48>>,
    /// F1 of this answer.
    f1: Reg<Bit>,
    /// F2 of this answer.
    f2: Reg<Bit>,
    /// System clock cycles until tcal or tm is over, and one more.
    timer: Reg<Bits<16>>,
    /// Microseconds since the last edge of CLOCK, or since the plug came; wrapping.
    level_us: Reg<Bits<16>>,
    /// Level of DATA, for the pin.
    data_pin: Reg<Bit>,
    /// Driver enable, for the pin.
    oe_pin: Reg<Bit>,
    /// The mode command, with the bit that comes in this cycle.
    code_now: Signal<Local, Bits<6>>,
    /// High for one cycle when the mode command is complete.
    decodes: Signal<Local, Bit>,
    /// High if `code_now` is a mode command with a parameter.
    is_parameter: Signal<Local, Bit>,
    /// High for one cycle when a frame begins.
    begins: Signal<Local, Bit>,
    /// High for one cycle when the start bit is launched.
    starts: Signal<Local, Bit>,
    /// High for one cycle when the recovery time begins.
    ends: Signal<Local, Bit>,
    /// High if tcal or tm is over.
    is_due: Signal<Local, Bit>,
    /// High with the last rising edge of a part of the frame.
    is_last: Signal<Local, Bit>,
    /// Calculation time of a frame that begins, in system clock cycles.
    tcal: Signal<Local, Bits<16>>,
    /// Recovery time of this frame, in system clock cycles.
    tm: Signal<Local, Bits<13>>,
    /// Width of the position in this frame.
    bits: Signal<Local, Bits<6>>,
    /// High if the next rising edge may launch the start bit, as far as edges are counted.
    may_start: Signal<Local, Bit>,
    /// Levels with which F1 and F2 are inverted.
    inverts: Signal<Local, Bits<2>>,
    /// Inverted bits of the CRC; `left` selects the one that is next.
    crc_wrong: Signal<Local, Bits<8>>,
    /// `left`, modulo 8.
    left_low: Signal<Local, Bits<3>>,
    /// High for one cycle when a bit of the answer, or the HIGH after it, is launched.
    launches: Signal<Local, Bit>,
    /// Level that the next rising edge of CLOCK launches.
    level: Signal<Local, Bit>,
    /// High if the CRC covers `level`.
    is_covered: Signal<Local, Bit>,
    /// High when CLOCK has been HIGH for so long that a frame is over.
    is_high_long: Signal<Local, Bit>,
    /// High when CLOCK has been LOW for too long.
    is_low_long: Signal<Local, Bit>,
    /// Mode command: send position.
    send_position: Constant<Bits<6>>,
    /// Mode command: send position with additional data.
    send_position_22: Constant<Bits<6>>,
    /// Rising edges up to the last bit of a mode command.
    command_edges: Constant<Bits<6>>,
    /// Rising edges from there to the last one before the earliest start bit.
    turnaround_edges: Constant<Bits<6>>,
    /// Rising edges from there to the same one, with a parameter between them.
    parameter_edges: Constant<Bits<6>>,
    /// Bits of the CRC.
    crc_bits: Constant<Bits<6>>,
    /// Microseconds of CLOCK HIGH that end a frame.
    high_limit_us: Constant<Bits<16>>,
    /// Microseconds of CLOCK LOW that end a frame.
    low_limit_us: Constant<Bits<16>>,
    /// 1 if the encoder makes errors on command.
    has_errors: Constant<Bit>,
    _errors: usize,
}

/// What is fixed when an encoder is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EncoderMake {
    /// Longest CLOCK LOW, in microseconds, 1..=65534 (LC linear encoders: 30).
    pub clock_low_max_us: u64,
    /// The encoder makes errors on command; without them `wanted` has no effect and takes no logic.
    pub errors: bool,
}

impl Default for EncoderMake {
    fn default() -> Self {
        Self {
            clock_low_max_us: CLOCK_LOW_MAX_US,
            errors: false,
        }
    }
}

impl Encoder {
    /// An encoder of this make.
    pub fn new(make: EncoderMake) -> Self {
        let edges = |edges: u32| Constant::new(u64::from(edges).into());
        let code = |command: ModeCommand| Constant::new(u64::from(command.code()).into());
        // One more: the first tick comes within a microsecond.
        let limit = |us: u64| Constant::new((us + 1).into());
        Self::from_parts(EncoderParts {
            send_position: code(ModeCommand::SendPosition),
            send_position_22: code(ModeCommand::SendPositionAddInfo),
            command_edges: edges(LEAD_IN + MODE_COMMAND_BITS),
            turnaround_edges: edges(TURNAROUND),
            parameter_edges: edges(TURNAROUND + PARAMETER_BITS),
            crc_bits: edges(CRC_BITS),
            high_limit_us: limit(CLOCK_HIGH_MAX_US),
            low_limit_us: limit(make.clock_low_max_us),
            errors: (0..usize::from(make.errors))
                .map(|_| AnswerErrors::default())
                .collect(),
            has_errors: Constant::new(make.errors),
            _errors: make.errors.into(),
        })
    }
}

impl Default for Encoder {
    fn default() -> Self {
        Self::new(EncoderMake::default())
    }
}

mod kernel;
#[cfg(test)]
mod tests;
