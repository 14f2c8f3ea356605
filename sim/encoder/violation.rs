//! Violations by a receiver.

use crate::Time;

/// A rule broken by the receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Violation {
    /// The clock stopped in the middle of the answer.
    TooFewPulses {
        /// Rising edges seen.
        seen: u32,
        /// Rising edges the frame should have had.
        expected: u32,
    },
    /// The clock continued after the last bit of the answer.
    TooManyPulses {
        /// Rising edges the frame should have had.
        expected: u32,
    },
    /// The clock stopped before the answer began. Correct after a start time-out, otherwise wrong.
    StoppedBeforeAnswer {
        /// Rising edges seen.
        seen: u32,
    },
    /// The clock fell within the recovery time, or before DATA had been LOW for tR.
    EarlyRestart {
        /// Time after the last rising edge.
        after: Time,
    },
    /// The mean clock period is longer than 10 us or shorter than the encoder supports.
    ClockRate {
        /// The mean period.
        period: Time,
    },
    /// A HIGH phase, or a LOW phase that is no pause, differs too much from half a period.
    PulseWidth {
        /// True for a HIGH phase.
        high: bool,
        /// Width.
        width: Time,
        /// The nearest rising edge.
        edge: u32,
    },
    /// The clock was LOW for too long.
    ClockLowTooLong,
    /// An unknown mode command; the encoder does not answer.
    UnknownCommand(u8),
    /// DATA was not driven when a bit of the command, or of the supplement, was sampled.
    CommandNotDriven {
        /// The rising edge.
        edge: u32,
    },
    /// The clock continued before the encoder had released DATA for the supplement.
    EarlySupplement {
        /// Duration of clock LOW.
        pause: Time,
    },
    /// Too few LOW bits before the start bit of the supplement.
    SupplementZeros {
        /// Number of LOW bits.
        seen: u32,
    },
    /// The clock stopped before the start bit of a supplement.
    NoSupplement {
        /// Rising edges seen.
        seen: u32,
    },
    /// An EnDat 2.1 command with a parameter too soon after the previous one.
    ParameterGap {
        /// Time after the last rising edge.
        after: Time,
    },
    /// A frame while the encoder was starting again after a reset.
    DuringReset {
        /// Time after the reset.
        after: Time,
    },
    /// An EnDat 2.2 frame with the short recovery time at 1 MHz or less.
    ShortRecoveryTooSlow {
        /// The mean clock period.
        period: Time,
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
                "nobody drove DATA at rising edge {edge}, in the command or supplement"
            ),
            Self::EarlySupplement { pause } => write!(
                f,
                "clock LOW for only {:.3} us before the supplement",
                us(pause)
            ),
            Self::SupplementZeros { seen } => {
                write!(f, "only {seen} LOW bits before the supplement's start bit")
            }
            Self::NoSupplement { seen } => {
                write!(
                    f,
                    "clock stopped after {seen} pulses, before the supplement"
                )
            }
            Self::ParameterGap { after } => write!(
                f,
                "command with a parameter {:.3} us after the one before",
                us(after)
            ),
            Self::DuringReset { after } => {
                write!(f, "new frame {:.3} us after a reset", us(after))
            }
            Self::ShortRecoveryTooSlow { period } => write!(
                f,
                "clock period of {:.4} us is too long for the short recovery time",
                us(period)
            ),
        }
    }
}
