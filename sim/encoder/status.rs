//! Alarms, warnings and error sources: faults, their start, and their latching until cleared.

use super::{Cause, EncoderConfig};
use crate::Time;

/// Reasons of a refusal; the numbers are those of the ADDI-DATA driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorSource {
    /// Mode command that does not exist.
    ModeCommand = 1,
    /// MRS code that does not exist.
    MrsCode = 2,
    /// The transmission was not completed.
    NotCompleted = 3,
    /// MRS code that this encoder, or this command, does not allow.
    MrsNotAllowed = 7,
    /// Address outside the area, or memory accessed while busy.
    Address = 8,
    /// Write to a protected word.
    Protected = 9,
    /// Attempt to clear write protection.
    ClearProtection = 10,
    /// Block that the section 2 memory does not have.
    Block = 11,
    /// Additional data that this encoder does not support.
    InfoNotSupported = 13,
}

impl ErrorSource {
    /// All supported sources.
    pub const ALL: [Self; 9] = [
        Self::ModeCommand,
        Self::MrsCode,
        Self::NotCompleted,
        Self::MrsNotAllowed,
        Self::Address,
        Self::Protected,
        Self::ClearProtection,
        Self::Block,
        Self::InfoNotSupported,
    ];

    /// Bit in additional data 0x59. The bit positions are not published; number n is in bit n - 1 here.
    pub fn bit(self) -> u16 {
        1 << (self as u16 - 1)
    }
}

/// The latched words.
#[derive(Clone, Debug, Default)]
pub(super) struct Status {
    pub alarms: u16,
    pub warnings: u16,
    pub sources: u16,
    /// Causes have been evaluated up to this time.
    looked_at: Time,
}

impl Status {
    /// Latches faults between the last evaluation and now, if the encoder can report them.
    pub fn look(&mut self, time: Time, config: &EncoderConfig) {
        let active = |c: &&Cause| c.during.start <= time && c.during.end > self.looked_at;
        for cause in config.causes.iter().filter(active) {
            self.alarms |= cause.alarms & config.plate.alarms;
            self.warnings |= cause.warnings & config.plate.warnings;
        }
        self.looked_at = time;
    }

    /// Clears everything; causes before `time` no longer count.
    pub fn clear(&mut self, time: Time) {
        *self = Self {
            looked_at: time,
            ..Self::default()
        };
    }
}
