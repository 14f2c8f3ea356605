//! Rows of positions, one for each trigger: from the stream if the card has one, else from its result registers.

mod clock;

use crate::card::Card;
use crate::causes;
use crate::registers::Place;
use crate::stream::{Sample, SampleSet};
use crate::transport::Transport;
use crate::witness::Witness;
use crate::HostError;
use clock::Clock;
use endat_driver::AdditionalData as Info;
use endat_driver::Reading;
use endat_regs::{Part, Protocol};
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Instead of a cause: the channel did not take the trigger.
pub const NOT_TAKEN: &str = "not_taken";
/// Instead of a cause: the result was not ready in time.
pub const TOO_LATE: &str = "too_late";
/// The position for the last [`TOO_LATE`].
pub const LATE: &str = "late";

/// Texts in a row instead of a cause, with their meaning.
pub const NO_CAUSES: [(&str, &str); 3] = [
    (
        NOT_TAKEN,
        "the channel took no part in this trigger: it was busy, ignores the trigger, or pauses for 30 ms after an aborted frame \
         or a reset. The row where that began has the cause; service<n>.frames_... counts it",
    ),
    (
        TOO_LATE,
        "the result was not ready at the next trigger: the frame took longer than the trigger period, for example because it measured \
         the line delay",
    ),
    (LATE, "the position for the last too_late, at least one trigger after its own"),
];

/// Code of an unknown name.
pub const UNKNOWN_CODE: u8 = u8::MAX;
/// Code of the first of [`NO_CAUSES`], after the numbers of all causes.
const NO_CAUSE_CODES: u8 = 128;

/// Codes and names of all causes and of [`NO_CAUSES`].
pub fn cause_codes() -> impl Iterator<Item = (u8, &'static str)> {
    let known = causes::ALL.iter().map(|c| (c.number as u8, c.name));
    let others = NO_CAUSES.iter().enumerate();
    let others = others.map(|(n, (name, _))| (NO_CAUSE_CODES + n as u8, *name));
    known.chain(others).chain([(UNKNOWN_CODE, "unknown")])
}

/// A channel of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Last good position, if valid.
    pub position: Option<u64>,
    /// This trigger brought it.
    pub fresh: bool,
    /// Name of the cause, or [`NOT_TAKEN`], [`TOO_LATE`], [`LATE`].
    pub cause: &'static str,
    /// Additional data 1 and 2 of the same frame, if received with a right CRC.
    pub infos: [Option<Info>; 2],
}

impl Cell {
    /// Code of the cause, see [`cause_codes`].
    pub fn cause_code(&self) -> u8 {
        let found = cause_codes().find(|(_, name)| *name == self.cause);
        found.map_or(UNKNOWN_CODE, |(code, _)| code)
    }

    /// Cell from a channel's part of a stream set, in a channel with this protocol.
    fn of(sample: &Sample, protocol: Protocol) -> Self {
        let named = sample.cause_name(protocol);
        let cause = match (sample.taken, sample.missing) {
            // A fault is reported, even if late.
            _ if sample.is_late() && !sample.fresh && sample.cause != 0 => named,
            _ if sample.is_late() => LATE,
            (false, _) => NOT_TAKEN,
            (_, true) => TOO_LATE,
            _ => named,
        };
        Self {
            position: sample.valid.then_some(sample.position),
            fresh: sample.fresh && !sample.is_late(),
            cause,
            infos: sample.infos.map_or([None; 2], |i| i.map(Info::good)),
        }
    }
}

/// Result of a trigger, or a position of a running clock.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The channel whose running clock brought the position; `trigger` is the last one before it.
    pub run: Option<usize>,
    /// Number of the trigger, not wrapping.
    pub trigger: u64,
    /// System clock cycles since the first row, not wrapping.
    pub cycles: u64,
    /// Triggers without a row just before this one.
    pub missing: u64,
    /// One for each channel.
    pub cells: Vec<Cell>,
}

/// Bits of `card.stream_control`: collect and push.
const COLLECT_AND_PUSH: u32 = 0b11;

/// Source of rows.
pub struct Feed {
    streams: bool,
    clock: Clock,
    lost_in_card: u64,
    heard: Instant,
    /// The state of the card when last asked; `None` after an error.
    witness: Option<Witness>,
    /// Its trigger count at that time, until compared with the rows.
    count: Option<u32>,
    /// A question to the card is still unanswered.
    in_doubt: bool,
    /// How often the link had been lost at that time.
    reopened: u64,
    /// Sequence numbers of the last row, if results are read.
    sequences: Vec<u16>,
}

/// Longest silence. After it the card may have restarted, and have stopped its stream. A polled card is asked with this period.
const SILENCE: Duration = Duration::from_secs(1);
/// Most results between two reads. After more the card may have restarted and count from zero.
const LEAP: u16 = 256;

impl Feed {
    /// Begins: from the stream if the card has one, unless `polls`.
    pub fn begin<T: Transport>(card: &mut Card<T>, polls: bool) -> Result<Self, HostError> {
        let streams = card.identity().has(Part::Stream) && !polls;
        let witness = Witness::new(card)?;
        let mut clock = Clock::default();
        clock.counted(witness.triggers(), &[]);
        let reopened = card.bridge().transport().state().reopened;
        if streams {
            let at = |register| Place::at("card", register, 0);
            card.write(&at("stream_clear"), 1)?;
            card.write(&at("stream_control"), COLLECT_AND_PUSH)?;
            card.bridge().set_pushes(true);
        }
        Ok(Self {
            streams,
            clock,
            lost_in_card: 0,
            heard: Instant::now(),
            witness: Some(witness),
            count: None,
            in_doubt: false,
            reopened,
            sequences: Vec::new(),
        })
    }

    /// Asks the card for its state after a doubt, or after a long time; false if there is no answer. An error ends the feed, because later data
    /// belong to another card.
    fn is_the_same<T: Transport>(
        &mut self,
        card: &mut Card<T>,
        doubt: bool,
    ) -> Result<bool, HostError> {
        let link = card.bridge().transport().state();
        let is_back = link.reopened != self.reopened;
        if !link.is_open || !doubt && !is_back && self.heard.elapsed() <= SILENCE {
            return Ok(link.is_open);
        }
        let Some(mut witness) = self.witness.take() else {
            return Ok(false);
        };
        let has_answered = witness.ask(card)?;
        self.witness = Some(witness);
        self.heard = Instant::now();
        self.in_doubt = !has_answered;
        if has_answered {
            self.reopened = link.reopened;
            self.count = Some(witness.triggers());
        }
        Ok(has_answered)
    }

    /// True if every trigger has a row, except those counted as missing.
    pub fn streams(&self) -> bool {
        self.streams
    }

    /// Sample sets that the card has dropped.
    pub fn lost_in_card(&self) -> u64 {
        self.lost_in_card
    }

    /// Ends: restores the earlier state of the link.
    pub fn end<T: Transport>(self, card: &mut Card<T>) -> Result<(), HostError> {
        // If the card is now another one, leave its settings unchanged.
        match self.streams && self.witness.is_some() {
            true => card.bridge().end_push(),
            false => Ok(()),
        }
    }

    fn row(&mut self, sequence: u16, timestamp: u32, cells: Vec<Cell>) -> Row {
        let missing = self.clock.step(sequence, timestamp);
        Row {
            run: None,
            trigger: self.clock.trigger,
            cycles: self.clock.cycles,
            missing,
            cells,
        }
    }

    /// The row of a running clock's position; the other channels are not part of it.
    fn of_run(&mut self, set: &SampleSet, channel: usize, channels: usize) -> Option<Row> {
        let sample = set.channels.first()?;
        let cells = (0..channels).map(|n| match n == channel {
            true => Cell {
                position: sample.valid.then_some(sample.position),
                fresh: sample.fresh,
                cause: sample.cause_name(Protocol::Endat),
                infos: [None; 2],
            },
            false => Cell {
                position: None,
                fresh: false,
                cause: causes::name(0),
                infos: [None; 2],
            },
        });
        Some(Row {
            run: Some(channel),
            trigger: self.clock.trigger,
            cycles: self.clock.pass(set.timestamp),
            missing: 0,
            cells: cells.collect(),
        })
    }

    /// The row of these results; `None` if no channel has a new result since the last one. With separate channel triggers the
    /// channel with the most results counts them, and the latest time is that of the row.
    fn polled(&mut self, results: &[Reading]) -> Option<Row> {
        let steps: Vec<u16> = match self.sequences.is_empty() {
            true => results.iter().map(|r| r.sequence).collect(),
            false => {
                let both = results.iter().zip(&self.sequences);
                both.map(|(r, last)| r.sequence.wrapping_sub(*last))
                    .collect()
            }
        };
        let most = steps.iter().copied().max().unwrap_or_default();
        if most == 0 && !self.sequences.is_empty() {
            return None;
        }
        self.sequences = results.iter().map(|r| r.sequence).collect();
        let (sequence, timestamp) = self.clock.last.unwrap_or((0, results[0].timestamp));
        let since = |r: &Reading| r.timestamp.wrapping_sub(timestamp) as i32;
        let later = results.iter().map(since).max().unwrap_or_default().max(0);
        let cells = results.iter().zip(steps).map(|(r, steps)| Cell {
            position: r.valid.then_some(r.position),
            fresh: r.fresh && steps > 0,
            cause: match steps {
                0 => NOT_TAKEN,
                _ => causes::name(r.cause),
            },
            infos: match steps {
                0 => [None; 2],
                _ => r.infos.map(Info::good),
            },
        });
        let cells = cells.collect();
        let moment = timestamp.wrapping_add(later as u32);
        Some(self.row(sequence.wrapping_add(most), moment, cells))
    }

    /// Results since the last row, in the channel with the most; 0 before the first row.
    fn leap(&self, results: &[Reading]) -> u16 {
        let both = results.iter().zip(&self.sequences);
        let steps = both.map(|(r, last)| r.sequence.wrapping_sub(*last));
        steps.max().unwrap_or_default()
    }

    /// Reads received rows, after waiting at most `wait`.
    pub fn fill<T: Transport>(
        &mut self,
        card: &mut Card<T>,
        rows: &mut VecDeque<Row>,
        wait: Duration,
    ) -> Result<(), HostError> {
        if self.streams {
            let mut sets = card.bridge().pushed(wait)?;
            // After a silence the count may have advanced by more than a 16-bit number shows.
            let was_silent = !sets.is_empty() && (self.in_doubt || self.heard.elapsed() > SILENCE);
            if !sets.is_empty() {
                self.heard = Instant::now();
            }
            self.is_the_same(card, was_silent)?;
            // Sets received before the answer.
            sets.extend(card.bridge().decoded());
            if let Some(count) = self.count.take() {
                let triggers = sets.iter().filter(|set| set.run.is_none());
                let before: Vec<_> = triggers.map(|s| (s.sequence, s.timestamp)).collect();
                self.clock.counted(count, &before);
            }
            for set in sets {
                self.lost_in_card += u64::from(set.lost);
                if let Some(channel) = set.run {
                    rows.extend(self.of_run(&set, channel, card.identity().channels));
                    continue;
                }
                let identity = card.identity();
                let samples = set.channels.iter().enumerate();
                let cells = samples.map(|(n, s)| Cell::of(s, identity.protocol(n)));
                let cells = cells.collect();
                rows.push_back(self.row(set.sequence, set.timestamp, cells));
            }
            return Ok(());
        }
        if !self.is_the_same(card, false)? {
            std::thread::sleep(wait);
            // Reopens the link when it is back.
            card.bridge().pushed(Duration::ZERO)?;
            return Ok(());
        }
        let results = card.results()?.channels;
        let is_leap = self.leap(&results) > LEAP;
        if is_leap && !self.is_the_same(card, true)? {
            return Ok(());
        }
        if results.iter().any(|r| r.has_come()) {
            rows.extend(self.polled(&results));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_result_says_what_was_wrong_with_it() {
        let sample = |fresh, cause| Sample {
            missing: true,
            taken: true,
            valid: true,
            fresh,
            cause,
            ..Sample::default()
        };
        let crc = causes::number("crc").expect("a cause");
        for (sample, cause) in [(sample(true, 0), LATE), (sample(false, crc), "crc")] {
            let cell = Cell::of(&sample, Protocol::Endat);
            assert_eq!((cell.cause, cell.fresh), (cause, false), "{sample:?}");
        }
    }

    #[test]
    fn a_channel_that_takes_no_trigger_does_not_stop_the_others() {
        let mut feed = Feed {
            streams: false,
            clock: Clock::default(),
            lost_in_card: 0,
            heard: Instant::now(),
            witness: None,
            count: None,
            in_doubt: false,
            reopened: 0,
            sequences: Vec::new(),
        };
        let result = |sequence, timestamp| Reading {
            sequence,
            timestamp,
            valid: sequence > 0,
            fresh: sequence > 0,
            ..Reading::default()
        };
        let mut row = |sequences: [u16; 2], timestamps: [u32; 2]| {
            let results = [0, 1].map(|i| result(sequences[i], timestamps[i]));
            let row = feed.polled(&results)?;
            let fresh = [0, 1].map(|i| row.cells[i].fresh);
            Some((row.trigger, row.missing, row.cycles, fresh))
        };
        // Channel 0 is disabled, or takes one of four.
        assert_eq!(row([0, 3], [0, 5]), Some((3, 0, 0, [false, true])));
        assert_eq!(row([0, 3], [0, 5]), None);
        assert_eq!(row([0, 4], [0, 25]), Some((4, 0, 20, [false, true])));
        assert_eq!(row([1, 7], [45, 85]), Some((7, 2, 80, [true, true])));
        assert_eq!(row([1, 8], [45, 105]), Some((8, 0, 100, [false, true])));
    }
}
