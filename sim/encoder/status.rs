//! Alarms, warnings and error sources: what is wrong, since when, and until somebody clears it.

use super::{Cause, EncoderConfig};
use crate::Time;

/// Why an encoder refuses something; the numbers are those of the ADDI-DATA driver.
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
    /// Additional data that do not exist here.
    InfoNotSupported = 13,
}

impl ErrorSource {
    /// All that this encoder tells.
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

    /// Its bit in additional data 0x59. Where the bits are is not published; number n stands in bit n - 1 here.
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
    /// Causes have been looked at up to here.
    looked_at: Time,
}

impl Status {
    /// Latches what was wrong between the last look and now, as far as the encoder can tell it.
    pub fn look(&mut self, time: Time, config: &EncoderConfig) {
        let active = |c: &&Cause| c.during.start <= time && c.during.end > self.looked_at;
        for cause in config.causes.iter().filter(active) {
            self.alarms |= cause.alarms & config.plate.alarms;
            self.warnings |= cause.warnings & config.plate.warnings;
        }
        self.looked_at = time;
    }

    /// Forgets everything; causes before `time` count no more.
    pub fn clear(&mut self, time: Time) {
        *self = Self {
            looked_at: time,
            ..Self::default()
        };
    }
}
