//! What became of a flip in a card, from what its host has seen and what the encoders have sent.

use super::second::Controller;
use super::told::{Round, Seen, Verdict, What};
use super::CHANNELS;
use endat_driver::Reading;
use endat_host::stream::{Sample, SampleSet};
use endat_sim::campaign::port::{Class, Mark, TRIGGERS_MAX};

/// Triggers without two good ones in a row after which the host opens the connection anew.
const REOPEN_AFTER: u32 = 4;

/// A position that an encoder has sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shot {
    /// First falling edge of the first frame for this trigger, and of the one with the position, in system clock cycles.
    pub first: u32,
    /// See `first`.
    pub fall: u32,
    /// The position.
    pub position: u64,
}

/// What the encoders have noted since they were asked.
#[derive(Clone, Debug, Default)]
pub struct Noted {
    /// Positions of each channel.
    pub shots: [Vec<Shot>; CHANNELS],
    /// Answers that the second controller has read.
    pub answers: Vec<Vec<u8>>,
    /// They complain of a wrong number of clock pulses, or of something else.
    pub pulses: bool,
    /// See `pulses`.
    pub rules: bool,
}

/// What was seen of something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum View {
    Good,
    Told,
    Lost,
    Other,
    Wrong,
}

/// The judge of one lane.
#[derive(Clone, Debug, Default)]
pub struct Judge {
    /// The worst class so far.
    pub class: Class,
    found: [bool; Mark::ALL.len()],
    shots: [Vec<Shot>; CHANNELS],
    sequences: [u16; CHANNELS],
    positions: [u64; CHANNELS],
    /// From the falling edge to the time stamp, of results and of sets.
    result_after: [u32; CHANNELS],
    set_after: u32,
    second: Controller,
    triggers: u32,
    good_in_row: u32,
    is_reopened: bool,
    has_rested: bool,
    is_ever_told: bool,
    /// What the encoders have noted since the last results.
    pending: Noted,
    open_lost: bool,
    open_pulses: bool,
    open_rules: bool,
}

impl Judge {
    /// Marks that were found.
    pub fn marks(&self) -> impl Iterator<Item = Mark> + '_ {
        Mark::ALL.into_iter().filter(|m| self.found[*m as usize])
    }

    fn mark(&mut self, mark: Mark) {
        self.found[mark as usize] = true;
    }

    /// All that was before the flip counts for nothing.
    pub fn begin(&mut self) {
        *self = Self {
            shots: std::mem::take(&mut self.shots),
            sequences: self.sequences,
            positions: self.positions,
            result_after: self.result_after,
            set_after: self.set_after,
            pending: std::mem::take(&mut self.pending),
            second: std::mem::take(&mut self.second),
            ..Self::default()
        };
        self.shots
            .iter_mut()
            .for_each(|s| drop(s.drain(..s.len().saturating_sub(4))));
    }

    /// It stays dead.
    pub fn hang(&mut self) {
        self.class = Class::Hang;
        self.close();
    }

    /// Takes what the host has seen.
    pub fn take(&mut self, seen: &Seen, noted: Noted) -> Verdict {
        match &seen.what {
            What::Round(round) => return self.round(seen.is_told, round, noted, false),
            What::Acted(Some(round)) => {
                self.round(seen.is_told, round, noted, true);
                return Verdict::Again;
            }
            What::Acted(None) | What::Ready(_) | What::Begun | What::Note => {}
            What::Reopened => self.reopen(),
            What::WrongAnswer => self.class = self.class.max(Class::SilentOther),
            What::Slow => self.mark(Mark::Slow),
            What::Stuck => self.class = Class::Hang,
            What::End(is_same) => {
                self.told(seen.is_told);
                self.close();
                if !is_same && !self.is_ever_told {
                    self.class = self.class.max(Class::SilentOther);
                    self.mark(Mark::Config);
                }
            }
        }
        // What the encoders noted belongs to the next round.
        self.pending = self.with_pending(noted);
        self.told(seen.is_told);
        Verdict::Again
    }

    fn with_pending(&mut self, noted: Noted) -> Noted {
        let mut all = std::mem::take(&mut self.pending);
        for (all, new) in all.shots.iter_mut().zip(noted.shots) {
            all.extend(new);
        }
        all.answers.extend(noted.answers);
        all.pulses |= noted.pulses;
        all.rules |= noted.rules;
        all
    }

    fn told(&mut self, is_told: bool) {
        if is_told {
            self.class = self.class.max(Class::Detected);
            self.is_ever_told = true;
        }
    }

    fn reopen(&mut self) {
        self.is_reopened = true;
        self.mark(Mark::Reopened);
        self.told(true);
        (self.triggers, self.good_in_row) = (0, 0);
    }

    fn round(&mut self, is_told: bool, round: &Round, noted: Noted, is_act: bool) -> Verdict {
        let noted = self.with_pending(noted);
        let mut views = vec![];
        let before = self.shots.each_ref().map(Vec::len);
        for (all, new) in self.shots.iter_mut().zip(&noted.shots) {
            all.extend(new);
        }
        match &round.results {
            Some(results) => {
                for (channel, reading) in results.iter().enumerate() {
                    views.push(self.result(channel, reading, &noted.shots[channel]));
                }
            }
            None => views.push(View::Told),
        }
        if self.second.has_begun() && noted.answers.is_empty() {
            views.push(View::Told);
        }
        for answer in &noted.answers {
            let results = self.second.take(answer).into_iter().zip(&noted.shots);
            views.extend(results.map(|(reading, new)| match reading {
                None => View::Told,
                Some(reading) if new.iter().any(|s| s.position == reading.position) => View::Good,
                Some(_) => View::Wrong,
            }));
        }
        for set in &round.sets {
            self.set(set, before, &mut views);
        }
        if round.sets.is_empty() {
            views.push(View::Lost);
        }
        let is_told = is_told || views.contains(&View::Told);
        self.told(is_told);
        let was_lost = std::mem::take(&mut self.open_lost);
        if was_lost && !is_told {
            self.class = self.class.max(Class::Lost);
        }
        self.open_lost = !is_told && views.contains(&View::Lost);
        for (view, class) in [
            (View::Other, Class::SilentOther),
            (View::Wrong, Class::Silent),
        ] {
            if views.contains(&view) {
                self.class = self.class.max(class);
            }
        }
        for (open, now, mark) in [
            (&mut self.open_pulses, noted.pulses, Mark::Pulses),
            (&mut self.open_rules, noted.rules, Mark::Rules),
        ] {
            let was_open = std::mem::replace(open, now && !is_told);
            if was_open && !is_told {
                self.found[mark as usize] = true;
            }
        }
        if is_act {
            return Verdict::Again;
        }
        self.count(!is_told && views.iter().all(|v| *v == View::Good), round)
    }

    /// Counts a trigger.
    fn count(&mut self, is_good: bool, round: &Round) -> Verdict {
        self.triggers += 1;
        self.good_in_row = if is_good { self.good_in_row + 1 } else { 0 };
        if self.triggers == 1 && !is_good && !self.is_reopened {
            self.mark(Mark::Next);
        }
        if self.good_in_row == 2 {
            match self.triggers - 1 {
                _ if self.is_reopened => {}
                1 => {}
                2 => self.mark(Mark::Triggers2),
                3 => self.mark(Mark::Triggers3),
                _ => self.mark(Mark::TriggersMore),
            }
            return Verdict::End;
        }
        let is_dead = round.results.is_none() || self.triggers >= REOPEN_AFTER;
        match self.is_reopened {
            false if is_dead && self.good_in_row == 0 => Verdict::Reopen,
            true if self.triggers == TRIGGERS_MAX && !self.has_rested => {
                self.has_rested = true;
                (self.triggers, self.good_in_row) = (0, 0);
                Verdict::Rest
            }
            true if self.triggers == TRIGGERS_MAX => {
                self.hang();
                Verdict::GiveUp
            }
            _ => Verdict::Again,
        }
    }

    /// A channel's result as it was read.
    fn result(&mut self, channel: usize, reading: &Reading, new: &[Shot]) -> View {
        let last = std::mem::replace(&mut self.sequences[channel], reading.sequence);
        let position = std::mem::replace(&mut self.positions[channel], reading.position);
        let is_good = reading.cause == 0 && reading.valid && reading.fresh && !reading.stale;
        if !is_good {
            let mut sent = self.shots[channel].iter();
            if reading.valid && !sent.any(|s| s.position == reading.position) {
                self.mark(Mark::HeldWrong);
            }
            return View::Told;
        }
        let steps = reading.sequence.wrapping_sub(last);
        let shot = new.iter().rev().find(|s| s.position == reading.position);
        match (steps, shot) {
            (0, None) if reading.position == position => View::Lost,
            (0, Some(_)) => View::Lost,
            (_, None) => View::Wrong,
            (_, Some(shot)) => {
                let after = reading.timestamp.wrapping_sub(shot.fall);
                let is_same = std::mem::replace(&mut self.result_after[channel], after) == after;
                match (is_same, steps) {
                    (false, _) => View::Other,
                    // The number says that some are missing.
                    (true, 1) => View::Good,
                    (true, _) => View::Told,
                }
            }
        }
    }

    fn set(&mut self, set: &SampleSet, before: [usize; CHANNELS], views: &mut Vec<View>) {
        if set.channels.len() != CHANNELS || set.lost > 0 {
            views.push(View::Told);
            return;
        }
        let mut after = self.set_after;
        for (channel, sample) in set.channels.iter().enumerate() {
            views.push(self.sample(channel, sample, set.timestamp, before[channel], &mut after));
        }
        self.set_after = after;
    }

    fn sample(
        &mut self,
        channel: usize,
        sample: &Sample,
        timestamp: u32,
        before: usize,
        after: &mut u32,
    ) -> View {
        let shots = &self.shots[channel];
        let is_good =
            sample.cause == 0 && sample.valid && sample.fresh && sample.taken && !sample.missing;
        if !is_good {
            let is_sent = shots.iter().any(|s| s.position == sample.position);
            if sample.valid && !is_sent {
                self.mark(Mark::HeldWrong);
            }
            return View::Told;
        }
        // A trigger may have several frames: those that measure the delay come first.
        let moment = |s: &&Shot| s.first.wrapping_add(self.set_after) == timestamp;
        let mut of_moment = shots.iter().filter(moment).peekable();
        let is_known = of_moment.peek().is_some();
        let is_right = of_moment.any(|s| s.position == sample.position);
        let mut new = shots[before..].iter();
        match new.find(|s| s.position == sample.position) {
            _ if is_right => View::Good,
            Some(shot) if !is_known => {
                *after = timestamp.wrapping_sub(shot.first);
                View::Other
            }
            _ => View::Wrong,
        }
    }

    fn close(&mut self) {
        if std::mem::take(&mut self.open_lost) {
            self.class = self.class.max(Class::Lost);
        }
        for (open, mark) in [
            (std::mem::take(&mut self.open_pulses), Mark::Pulses),
            (std::mem::take(&mut self.open_rules), Mark::Rules),
        ] {
            if open {
                self.mark(mark);
            }
        }
    }
}
