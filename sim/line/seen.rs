//! Observations of a line: driver, changes, samples, conflicts.

use crate::encoder::Symbol;
use crate::Time;

/// An end of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The receiver's.
    Receiver,
    /// The encoder's.
    Encoder,
}

/// Both drivers were received at one end at the same time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Conflict {
    /// End of the line.
    pub end: End,
    /// Start.
    pub from: Time,
    /// Duration.
    pub length: Time,
    /// They drove different levels.
    pub opposing: bool,
    /// Both drivers were on at once. Otherwise the other driver was already off, and its last edge was still in the cable.
    pub both_on: bool,
}

impl std::fmt::Display for Conflict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "DATA driven from both ends at the {} for {:.3} us, {}, {}",
            match self.end {
                End::Receiver => "receiver",
                End::Encoder => "encoder",
            },
            self.length as f64 / 1e6,
            if self.opposing {
                "to different levels"
            } else {
                "to the same level"
            },
            if self.both_on {
                "both drivers on"
            } else {
                "one only by its echo in the cable"
            },
        )
    }
}

/// Driver of DATA at the receiver's pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// None: it floats, and reads HIGH.
    Nobody,
    /// The receiver itself.
    Receiver,
    /// The encoder, with the meaning of its output.
    Encoder(Symbol),
    /// Both.
    Both,
}

/// A change of DATA at the receiver's pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataChange {
    /// Time.
    pub time: Time,
    /// Level from then on.
    pub level: bool,
    /// Driver.
    pub who: Who,
    /// True for a glitch.
    pub glitch: bool,
}

/// DATA at the receiver's pin at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Time.
    pub time: Time,
    /// Level.
    pub level: bool,
    /// Driver.
    pub who: Who,
    /// True for a glitch.
    pub glitch: bool,
    /// Time since the last change.
    pub since: Time,
    /// Time until the next change; `None` = not known yet.
    pub until: Option<Time>,
}

impl Sample {
    /// The number of the answer bit on the line (0 = start bit), if any.
    pub fn answer_bit(&self) -> Option<u8> {
        match self.who {
            Who::Encoder(Symbol::Bit(i)) => Some(i),
            _ => None,
        }
    }

    /// Driven by the encoder alone, with or without a glitch.
    pub fn is_encoders(&self) -> bool {
        matches!(self.who, Who::Encoder(s) if s != Symbol::Absent)
    }

    /// Driven by the encoder alone, without a glitch, and stable for `guard` before and after.
    pub fn is_defined(&self, guard: Time) -> bool {
        self.is_encoders()
            && !self.glitch
            && self.since >= guard
            && self.until.is_none_or(|u| u >= guard)
    }
}

/// An arrival at an end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// CLOCK at the encoder has this level now.
    Clock(bool),
    /// DATA at one end may have changed.
    Data(End),
}
