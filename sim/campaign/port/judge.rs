//! What became of one flip, from what the reader and the encoder saw in the frame and in those that follow.

use crate::encoder::{FrameEnd, FrameLog, Violation};

/// Triggers after which a port that has not given a good position counts as hung.
pub const TRIGGERS_MAX: u32 = 8;

/// What became of a case: the worst that was seen, each case in one class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Every result is as without the upset.
    #[default]
    Masked,
    /// A cause was told, or a position that is not fresh.
    Detected,
    /// A trigger has no result, and no cause says so.
    Lost,
    /// Good position, but time stamp, additional information or answer are wrong, without a cause.
    SilentOther,
    /// A wrong position is told as good.
    Silent,
    /// Busy for ever, or no good position in [`TRIGGERS_MAX`] triggers.
    Hang,
}

impl Class {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Masked,
        Self::Detected,
        Self::Lost,
        Self::SilentOther,
        Self::Silent,
        Self::Hang,
    ];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Masked => "masked",
            Self::Detected => "detected",
            Self::Lost => "lost",
            Self::SilentOther => "silent_other",
            Self::Silent => "silent",
            Self::Hang => "hang",
        }
    }
}

/// What may be seen besides, in any class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mark {
    /// A wrong number of clock pulses, and no cause in that frame or the next.
    Pulses,
    /// Another rule of the encoder broken, and no cause.
    Rules,
    /// The driver is against the encoder's for more than a bit time after the frame.
    Conflict,
    /// The next frame is not good.
    Next,
    /// With a cause: the position that is held is none that the encoder sent.
    HeldWrong,
    /// The second trigger after the frame is the first that is good.
    Triggers2,
    /// The third one.
    Triggers3,
    /// A later one.
    TriggersMore,
    /// Busy for longer than the timers allow, but not for ever.
    Slow,
}

impl Mark {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Pulses,
        Self::Rules,
        Self::Conflict,
        Self::Next,
        Self::HeldWrong,
        Self::Triggers2,
        Self::Triggers3,
        Self::TriggersMore,
        Self::Slow,
    ];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pulses => "pulses",
            Self::Rules => "rules",
            Self::Conflict => "conflict",
            Self::Next => "next",
            Self::HeldWrong => "held_wrong",
            Self::Triggers2 => "triggers_2",
            Self::Triggers3 => "triggers_3",
            Self::TriggersMore => "triggers_more",
            Self::Slow => "slow",
        }
    }
}

/// What a reader sees between two triggers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reading {
    /// A result has come since the trigger.
    pub has_result: bool,
    /// Its cause, or the one that took its place; 0 = none.
    pub cause: u64,
    /// Position and `fresh` with `valid`.
    pub position: u64,
    pub valid: bool,
    pub fresh: bool,
    /// What the encoder sent in this frame; none = no frame.
    pub sent: Option<u64>,
    /// The position is one that the encoder has sent before.
    pub was_sent: bool,
    /// Time stamp, informations and answer are right.
    pub others_right: bool,
    /// What the encoder complains of, since the trigger.
    pub pulses: bool,
    pub rules: bool,
    pub conflict: bool,
}

impl Reading {
    fn is_good(&self) -> bool {
        self.has_result && self.cause == 0 && self.fresh && self.is_right() && self.others_right
    }

    fn is_right(&self) -> bool {
        self.valid && Some(self.position) == self.sent
    }

    fn class(&self) -> Class {
        if self.cause != 0 {
            return Class::Detected;
        }
        match (self.has_result, self.valid, self.fresh) {
            (true, true, true) if !self.is_right() => Class::Silent,
            (true, true, true) if self.others_right => Class::Masked,
            (true, true, true) => Class::SilentOther,
            (_, true, _) if !self.was_sent && !self.is_right() => Class::Silent,
            (false, _, _) => Class::Lost,
            (true, _, _) => Class::Detected,
        }
    }
}

/// The judge of one lane.
#[derive(Clone, Debug, Default)]
pub(in crate::campaign) struct Outcome {
    pub class: Class,
    found: [bool; Mark::ALL.len()],
    /// The cause that was told first; 0 = none.
    pub cause: u64,
    rounds: u32,
    good_in_row: u32,
    /// The last reading had such an error, without a cause.
    open_pulses: bool,
    open_rules: bool,
}

impl Outcome {
    pub fn mark(&mut self, mark: Mark) {
        self.found[mark as usize] = true;
    }

    pub fn marks(&self) -> impl Iterator<Item = Mark> + '_ {
        Mark::ALL.into_iter().filter(|m| self.found[*m as usize])
    }

    /// Whether nothing has been read so far.
    pub fn is_first(&self) -> bool {
        self.rounds == 0
    }

    /// Takes a reading. Whether all has been seen: two good ones after the frame, or too many that are not.
    pub(super) fn read(&mut self, reading: &Reading) -> bool {
        let is_silent = reading.cause == 0;
        if is_silent && self.open_pulses {
            self.mark(Mark::Pulses);
        }
        if is_silent && self.open_rules {
            self.mark(Mark::Rules);
        }
        self.open_pulses = is_silent && reading.pulses;
        self.open_rules = is_silent && reading.rules;
        if reading.conflict {
            self.mark(Mark::Conflict);
        }
        self.class = self.class.max(reading.class());
        if !is_silent && reading.valid && !reading.was_sent && !reading.is_right() {
            self.mark(Mark::HeldWrong);
        }
        if self.cause == 0 {
            self.cause = reading.cause;
        }
        self.rounds += 1;
        if self.rounds == 1 {
            return false;
        }
        self.good_in_row = match reading.is_good() {
            true => self.good_in_row + 1,
            false => 0,
        };
        let trigger = self.rounds - 1;
        if trigger == 1 && self.good_in_row == 0 {
            self.mark(Mark::Next);
        }
        if self.good_in_row == 2 {
            match trigger - 1 {
                1 => {}
                2 => self.mark(Mark::Triggers2),
                3 => self.mark(Mark::Triggers3),
                _ => self.mark(Mark::TriggersMore),
            }
            self.close();
            return true;
        }
        if trigger == TRIGGERS_MAX {
            self.hang();
            return true;
        }
        false
    }

    /// It stays busy, or its results stay bad.
    pub fn hang(&mut self) {
        self.class = Class::Hang;
        self.close();
    }

    fn close(&mut self) {
        if self.open_pulses {
            self.mark(Mark::Pulses);
        }
        if self.open_rules {
            self.mark(Mark::Rules);
        }
    }
}

/// Whether the encoder saw another number of pulses than there should be.
pub(super) fn is_count(violation: &Violation) -> bool {
    matches!(
        violation,
        Violation::TooFewPulses { .. }
            | Violation::TooManyPulses { .. }
            | Violation::StoppedBeforeAnswer { .. }
            | Violation::NoSupplement { .. }
    )
}

/// Whether a frame has all its pulses, and no more.
pub(super) fn is_whole(frame: &FrameLog) -> bool {
    frame.end == FrameEnd::Complete && frame.expected_rising_edges() == Some(frame.rising_edges)
}
