//! What an encoder notes down: one record for each frame, and everything the receiver did wrong.

use crate::{
    frame::{position_field, AnswerBits, Field, PositionAnswer},
    Time,
};

/// How a frame ended, seen from the encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameEnd {
    /// It is still going on.
    Running,
    /// All bits were clocked out and the recovery time was respected.
    Complete,
    /// The clock stopped HIGH before the answer was complete.
    Stopped,
    /// The clock went on after the answer, or came back within the recovery time.
    Overrun,
    /// The encoder lost its supply or its plug.
    Lost,
}

/// One frame as the encoder saw it. Edges are counted and timed at the encoder.
#[derive(Clone, Debug)]
pub struct FrameLog {
    /// Number of the frame, 0 = first.
    pub index: u64,
    /// First falling clock edge: the moment of the position.
    pub first_fall: Time,
    /// First rising clock edge.
    pub first_rise: Time,
    /// Last rising clock edge so far.
    pub last_rise: Time,
    /// Rising clock edges so far.
    pub rising_edges: u32,
    /// Mean clock period over the mode command.
    pub period: Time,
    /// The mode command.
    pub command: Option<u8>,
    /// The position that was latched.
    pub position: u64,
    /// Number of the rising edge that launched the start bit (`s`).
    pub start_edge: Option<u32>,
    /// When the start bit was launched.
    pub start_time: Time,
    /// The answer, with its defects.
    pub answer: AnswerBits,
    /// Whether the answer has an F2.
    pub has_f2: bool,
    /// Width of the position in the answer.
    pub position_bits: u32,
    /// DATA fell at the end of the recovery time.
    pub data_fall: Option<Time>,
    /// How it ended.
    pub end: FrameEnd,
}

impl FrameLog {
    /// Rising edges that this frame must have: `s` + answer bits; none if the answer never began.
    pub fn expected_rising_edges(&self) -> Option<u32> {
        self.start_edge.map(|s| s + self.answer.len)
    }

    /// What bit `index` of the answer is.
    pub fn field(&self, index: u32) -> Field {
        position_field(index, self.has_f2, self.position_bits)
    }

    /// Whether the answer is, bit by bit, what a sound encoder would send for this position.
    pub fn is_true_answer(&self, position_bits: u32, f2: bool) -> bool {
        let good = PositionAnswer {
            f1: false,
            f2: f2.then_some(true),
            position: self.position,
            position_bits,
        };
        self.answer == good.bits()
    }
}

/// A rule that the receiver broke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Violation {
    /// The clock stopped in the middle of the answer.
    TooFewPulses {
        /// Rising edges seen.
        seen: u32,
        /// Rising edges the frame should have had.
        expected: u32,
    },
    /// The clock went on after the last bit of the answer.
    TooManyPulses {
        /// Rising edges the frame should have had.
        expected: u32,
    },
    /// The clock stopped before the answer began. Right after a start time-out, wrong otherwise.
    StoppedBeforeAnswer {
        /// Rising edges seen.
        seen: u32,
    },
    /// The clock fell within the recovery time, or before DATA had been LOW for tR.
    EarlyRestart {
        /// How long after the last rising edge.
        after: Time,
    },
    /// The mean clock period is longer than 10 us or shorter than the encoder takes.
    ClockRate {
        /// The mean period.
        period: Time,
    },
    /// A HIGH phase, or a LOW phase that is no pause, differs too much from half a period.
    PulseWidth {
        /// Whether it was a HIGH phase.
        high: bool,
        /// How long it was.
        width: Time,
        /// The rising edge before or after which it was.
        edge: u32,
    },
    /// The clock was LOW for too long.
    ClockLowTooLong,
    /// A mode command that the encoder does not know; it stays silent.
    UnknownCommand(u8),
    /// DATA was driven by nobody when a bit of the mode command was taken.
    CommandNotDriven {
        /// The rising edge.
        edge: u32,
    },
}

impl std::fmt::Display for Violation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let us = |t: &Time| *t as f64 / 1e6;
        match self {
            Self::TooFewPulses { seen, expected } => {
                write!(
                    f,
                    "too few clock pulses: {seen} rising edges, expected {expected}"
                )
            }
            Self::TooManyPulses { expected } => {
                write!(f, "too many clock pulses: more than {expected}")
            }
            Self::StoppedBeforeAnswer { seen } => {
                write!(f, "clock stopped after {seen} pulses, before the answer")
            }
            Self::EarlyRestart { after } => write!(
                f,
                "new frame {:.3} us after the last rising edge: encoder was not ready",
                us(after)
            ),
            Self::ClockRate { period } => {
                write!(f, "clock period of {:.4} us is out of range", us(period))
            }
            Self::PulseWidth { high, width, edge } => write!(
                f,
                "clock {} for {:.4} us at rising edge {edge}: too far from half a period",
                if *high { "HIGH" } else { "LOW" },
                us(width)
            ),
            Self::ClockLowTooLong => f.write_str("clock LOW for too long"),
            Self::UnknownCommand(c) => write!(f, "unknown mode command {c:06b}"),
            Self::CommandNotDriven { edge } => write!(
                f,
                "nobody drove DATA at rising edge {edge}, in the mode command"
            ),
        }
    }
}
