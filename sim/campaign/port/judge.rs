//! Classifies a flip by the observations of the reader and the encoder in the frame and in the following ones.

use crate::encoder::{FrameLog, Violation};

/// Triggers after which a port that has not given a good position counts as hung.
pub const TRIGGERS_MAX: u32 = 8;

/// Class of a case: the worst observation, one class for each case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Every result is as without the upset.
    #[default]
    Masked,
    /// A cause was reported, or a position that is not fresh.
    Detected,
    /// A trigger has no result, and neither this nor the next result has a cause.
    Lost,
    /// Good position, but wrong time stamp, additional data or answer, without a cause.
    SilentOther,
    /// A wrong position is reported as good.
    Silent,
    /// Busy forever, or no good position in [`TRIGGERS_MAX`] triggers.
    Hang,
}

impl Class {
    /// All classes.
    pub const ALL: [Self; 6] = [
        Self::Masked,
        Self::Detected,
        Self::Lost,
        Self::SilentOther,
        Self::Silent,
        Self::Hang,
    ];

    /// Name in tables.
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

/// Additional observations, in any class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mark {
    /// A wrong number of clock pulses, and no cause in that frame or the next.
    Pulses,
    /// One frame more than the trigger needs, without a cause.
    Again,
    /// Another violation of the encoder's rules, without a cause.
    Rules,
    /// The driver conflicts with the encoder's for more than a bit time after the frame.
    Conflict,
    /// The next frame is not good.
    Next,
    /// With a cause: the held position was never sent by the encoder.
    HeldWrong,
    /// The second trigger after the frame is the first of two good ones in a row.
    Triggers2,
    /// The third one.
    Triggers3,
    /// A later one.
    TriggersMore,
    /// Busy for longer than the timers allow, but not forever.
    Slow,
    /// For a card: its configuration differs from the written one, without a report.
    Config,
    /// For a card: the host had to reopen the connection.
    Reopened,
}

impl Mark {
    /// All marks.
    pub const ALL: [Self; 12] = [
        Self::Pulses,
        Self::Again,
        Self::Rules,
        Self::Conflict,
        Self::Next,
        Self::HeldWrong,
        Self::Triggers2,
        Self::Triggers3,
        Self::TriggersMore,
        Self::Slow,
        Self::Config,
        Self::Reopened,
    ];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pulses => "pulses",
            Self::Again => "again",
            Self::Rules => "rules",
            Self::Conflict => "conflict",
            Self::Next => "next",
            Self::HeldWrong => "held_wrong",
            Self::Triggers2 => "triggers_2",
            Self::Triggers3 => "triggers_3",
            Self::TriggersMore => "triggers_more",
            Self::Slow => "slow",
            Self::Config => "config",
            Self::Reopened => "reopened",
        }
    }
}

/// Observations of a reader between two triggers.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::campaign) struct Reading {
    /// A result has come since the trigger.
    pub has_result: bool,
    /// Its cause, or the late one; 0 = none.
    pub cause: u64,
    /// A request was not answered, and its mailbox reports it.
    pub is_refused: bool,
    /// Position and `fresh` with `valid`.
    pub position: u64,
    pub valid: bool,
    pub fresh: bool,
    /// Position that the encoder sent in this frame; `None` = no frame.
    pub sent: Option<u64>,
    /// The encoder has sent the position before.
    pub was_sent: bool,
    /// Time stamp, additional data and answer are right.
    pub others_right: bool,
    /// Complaints of the encoder since the trigger.
    pub pulses: bool,
    pub again: bool,
    pub rules: bool,
    pub conflict: bool,
}

impl Reading {
    fn is_good(&self) -> bool {
        self.has_result && self.fresh && self.is_right() && self.others_right
    }

    fn is_right(&self) -> bool {
        self.valid && Some(self.position) == self.sent
    }

    /// True if no fault was reported.
    fn is_silent(&self) -> bool {
        self.cause == 0 && !self.is_refused
    }

    fn class(&self) -> Class {
        if !self.is_silent() {
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
    /// The first reported cause; 0 = none.
    pub cause: u64,
    rounds: u32,
    good_in_row: u32,
    /// The last reading had this error, without a cause.
    open_pulses: bool,
    open_rules: bool,
    /// The last reading had no result, without a cause.
    open_lost: bool,
}

impl Outcome {
    pub fn mark(&mut self, mark: Mark) {
        self.found[mark as usize] = true;
    }

    pub fn marks(&self) -> impl Iterator<Item = Mark> + '_ {
        Mark::ALL.into_iter().filter(|m| self.found[*m as usize])
    }

    /// True if nothing has been read so far.
    pub fn is_first(&self) -> bool {
        self.rounds == 0
    }

    /// Evaluates a reading. True when finished: two good ones after the frame, or too many bad ones.
    pub fn read(&mut self, reading: &Reading) -> bool {
        let is_silent = reading.is_silent();
        if is_silent && self.open_pulses {
            self.mark(Mark::Pulses);
        }
        if is_silent && self.open_rules {
            self.mark(Mark::Rules);
        }
        self.open_pulses = is_silent && reading.pulses;
        self.open_rules = is_silent && reading.rules;
        if is_silent && reading.again {
            self.mark(Mark::Again);
        }
        if reading.conflict {
            self.mark(Mark::Conflict);
        }
        let class = match (reading.class(), std::mem::take(&mut self.open_lost)) {
            (Class::Lost, _) => {
                self.open_lost = true;
                Class::Masked
            }
            (class, true) if is_silent => class.max(Class::Lost),
            (class, _) => class,
        };
        self.class = self.class.max(class);
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

    /// The port stays busy, or its results stay bad.
    pub fn hang(&mut self) {
        self.class = Class::Hang;
        self.close();
    }

    fn close(&mut self) {
        if self.open_lost {
            self.class = self.class.max(Class::Lost);
        }
        if self.open_pulses {
            self.mark(Mark::Pulses);
        }
        if self.open_rules {
            self.mark(Mark::Rules);
        }
    }
}

/// True if the encoder received a wrong number of pulses.
pub fn is_count(violation: &Violation) -> bool {
    matches!(
        violation,
        Violation::TooFewPulses { .. }
            | Violation::TooManyPulses { .. }
            | Violation::StoppedBeforeAnswer { .. }
            | Violation::NoSupplement { .. }
    )
}

/// True if each of these frames has all its pulses.
pub(super) fn are_whole(frames: &[FrameLog]) -> bool {
    frames.iter().all(FrameLog::is_whole)
}

/// True if a trigger needs these frames: none, or one at the full clock with the measuring ones before it.
pub(super) fn are_needed(frames: &[FrameLog]) -> bool {
    (frames.split_last()).is_none_or(|(last, before)| before.iter().all(|f| f.measures_for(last)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn good() -> Reading {
        Reading {
            has_result: true,
            position: 7,
            valid: true,
            fresh: true,
            sent: Some(7),
            others_right: true,
            ..Reading::default()
        }
    }

    fn judged(readings: &[Reading]) -> (Class, Vec<Mark>) {
        let mut outcome = Outcome::default();
        let ends = readings.iter().map(|r| outcome.read(r));
        let ends: Vec<bool> = ends.collect();
        let last = ends.len() - 1;
        assert!(ends[last] && !ends[..last].contains(&true), "{ends:?}");
        (outcome.class, outcome.marks().collect())
    }

    /// The frame with the fault, and two good ones after it.
    fn first(change: impl Fn(&mut Reading)) -> (Class, Vec<Mark>) {
        let mut reading = good();
        change(&mut reading);
        judged(&[reading, good(), good()])
    }

    #[test]
    fn a_case_is_in_the_worst_class_that_was_seen() {
        assert_eq!(first(|_| {}), (Class::Masked, vec![]));
        let wrong = |r: &mut Reading| r.position = 8;
        assert_eq!(first(wrong), (Class::Silent, vec![]));
        // It is reported with a cause, but held.
        let told = |r: &mut Reading| (r.position, r.cause) = (8, 7);
        assert_eq!(first(told), (Class::Detected, vec![Mark::HeldWrong]));
        let held = |r: &mut Reading| {
            (r.position, r.cause, r.fresh, r.was_sent) = (6, 4, false, true);
        };
        assert_eq!(first(held), (Class::Detected, vec![]));
        assert_eq!(first(|r| r.others_right = false).0, Class::SilentOther);
        assert_eq!(first(|r| r.fresh = false).0, Class::Detected);
        // Neither fresh nor the previous position.
        let spoilt = |r: &mut Reading| (r.position, r.fresh) = (8, false);
        assert_eq!(first(spoilt).0, Class::Silent);
        assert_eq!(first(|r| r.has_result = false).0, Class::Lost);
    }

    #[test]
    fn what_the_next_result_tells_is_told() {
        let mut lost = good();
        lost.has_result = false;
        let mut overrun = good();
        overrun.cause = 8;
        let told = judged(&[lost, overrun, good()]);
        assert_eq!(told, (Class::Detected, vec![]));
        let mut pulses = good();
        pulses.pulses = true;
        assert_eq!(judged(&[pulses, overrun, good()]).1, []);
        assert_eq!(judged(&[pulses, good(), good()]).1, [Mark::Pulses]);
        // In every frame.
        assert_eq!(judged(&[good(), pulses, pulses]).1, [Mark::Pulses]);
    }

    #[test]
    fn the_trigger_that_is_good_first_is_counted_and_too_many_are_a_hang() {
        let mut bad = good();
        (bad.cause, bad.fresh, bad.was_sent) = (4, false, true);
        for (lost, mark) in [
            (0, vec![]),
            (1, vec![Mark::Next, Mark::Triggers2]),
            (2, vec![Mark::Next, Mark::Triggers3]),
            (3, vec![Mark::Next, Mark::TriggersMore]),
        ] {
            let mut readings = vec![bad; 1 + lost];
            readings.extend([good(), good()]);
            assert_eq!(judged(&readings), (Class::Detected, mark), "{lost}");
        }
        let (class, _) = judged(&[bad; 1 + TRIGGERS_MAX as usize]);
        assert_eq!(class, Class::Hang);
    }
}
