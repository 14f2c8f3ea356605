//! What is seen on a line: who drives it, changes, samples, conflicts.

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

/// Both drivers were heard at one end at the same time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Conflict {
    /// At which end.
    pub end: End,
    /// Since when.
    pub from: Time,
    /// For how long.
    pub length: Time,
    /// They wanted different levels.
    pub opposing: bool,
    /// Both drivers were on at once. If not, the other end had already let go and its last edge was still in the cable.
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

/// Who determines DATA at the receiver's pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// Nobody: it floats, and reads HIGH.
    Nobody,
    /// The receiver itself.
    Receiver,
    /// The encoder, meaning this.
    Encoder(Symbol),
    /// Both.
    Both,
}

/// A change of DATA at the receiver's pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataChange {
    /// When.
    pub time: Time,
    /// Level from then on.
    pub level: bool,
    /// Who makes it.
    pub who: Who,
    /// Whether it is a glitch.
    pub glitch: bool,
}

/// DATA at the receiver's pin at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// The moment.
    pub time: Time,
    /// Its level.
    pub level: bool,
    /// Who makes it.
    pub who: Who,
    /// Whether it is a glitch.
    pub glitch: bool,
    /// How long it has been so.
    pub since: Time,
    /// How long it will be so; none = no change known yet.
    pub until: Option<Time>,
}

impl Sample {
    /// The number of the answer bit that is on the line (0 = start bit), if it is one.
    pub fn answer_bit(&self) -> Option<u8> {
        match self.who {
            Who::Encoder(Symbol::Bit(i)) => Some(i),
            _ => None,
        }
    }

    /// Driven by the encoder alone, whether a glitch disturbs it or not.
    pub fn is_encoders(&self) -> bool {
        matches!(self.who, Who::Encoder(s) if s != Symbol::Absent)
    }

    /// Driven by the encoder alone, undisturbed, and not changing within `guard` before or after.
    pub fn is_defined(&self, guard: Time) -> bool {
        self.is_encoders()
            && !self.glitch
            && self.since >= guard
            && self.until.is_none_or(|u| u >= guard)
    }
}

/// What has arrived at an end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// CLOCK at the encoder has this level now.
    Clock(bool),
    /// DATA at one end may have changed.
    Data(End),
}
