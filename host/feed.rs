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

/// Instead of a cause: the channel took no part in the trigger.
pub const NOT_TAKEN: &str = "not_taken";
/// Its result has not come in time.
pub const TOO_LATE: &str = "too_late";
/// This is what came for the last [`TOO_LATE`], with a position.
pub const LATE: &str = "late";

/// What stands in a row where a cause would, and what it means.
pub const NO_CAUSES: [(&str, &str); 3] = [
    (
        NOT_TAKEN,
        "the channel took no part in this trigger: it was busy, it is not for it, or it is quiet for 30 ms behind an aborted frame \
         or a reset. The row in which that began has the cause; service<n>.frames_... have counted it",
    ),
    (
        TOO_LATE,
        "the result had not come when the next trigger did: the frame took longer than the triggers are apart, as one that measures \
         the line delay does",
    ),
    (LATE, "the position that came for the last too_late, a trigger or more after its own"),
];

/// Code of a name that is unknown.
pub const UNKNOWN_CODE: u8 = u8::MAX;
/// Code of the first of [`NO_CAUSES`], behind the numbers of all causes.
const NO_CAUSE_CODES: u8 = 128;

/// A code for everything that stands where a cause would: the cause's number, or one of its own.
pub fn cause_codes() -> impl Iterator<Item = (u8, &'static str)> {
    let known = causes::ALL.iter().map(|c| (c.number as u8, c.name));
    let others = NO_CAUSES.iter().enumerate();
    let others = others.map(|(n, (name, _))| (NO_CAUSE_CODES + n as u8, *name));
    known.chain(others).chain([(UNKNOWN_CODE, "unknown")])
}

/// A channel of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Last good position, if there is one.
    pub position: Option<u64>,
    /// This trigger brought it.
    pub fresh: bool,
    /// Name of the cause, or [`NOT_TAKEN`], [`TOO_LATE`], [`LATE`].
    pub cause: &'static str,
    /// Additional data 1 and 2 of the same frame, those that came with a right CRC.
    pub infos: [Option<Info>; 2],
}

impl Cell {
    /// The code of its cause, see [`cause_codes`].
    pub fn cause_code(&self) -> u8 {
        let found = cause_codes().find(|(_, name)| *name == self.cause);
        found.map_or(UNKNOWN_CODE, |(code, _)| code)
    }

    /// What a set of the stream says of a channel that speaks this protocol.
    fn of(sample: &Sample, protocol: Protocol) -> Self {
        let named = sample.cause_name(protocol);
        let cause = match (sample.taken, sample.missing) {
            // What went wrong is told, however late.
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

/// What a trigger brought; or one position of a running clock.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The channel whose running clock brought the position; its `trigger` is the last one before it.
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

/// Where rows come from.
pub struct Feed {
    streams: bool,
    clock: Clock,
    lost_in_card: u64,
    heard: Instant,
    /// What the card was when it was last asked; none behind an error.
    witness: Option<Witness>,
    /// Its count of triggers then, until it has been compared with the rows.
    count: Option<u32>,
    /// It was asked, and has not answered yet.
    in_doubt: bool,
    /// How often the link had been lost by then.
    reopened: u64,
    /// Sequence numbers of the last row, where results are read.
    sequences: Vec<u16>,
}

/// Nothing for so long: perhaps the card has begun anew, and does not stream any more. A card that is read one by one is asked as often.
const SILENCE: Duration = Duration::from_secs(1);
/// More results than this between two looks: perhaps the card has begun anew, and counts from the beginning.
const LEAP: u16 = 256;

impl Feed {
    /// Begins: from the stream if the card has one and `polls` does not forbid it.
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

    /// Asks who is there if there is a doubt, or nobody was asked for long; false if nobody answers. What comes behind an error is not
    /// of the card that it was: this is the end.
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

    /// Whether every trigger has a row, unless it is counted as missing for a fault.
    pub fn streams(&self) -> bool {
        self.streams
    }

    /// Sample sets that the card itself has dropped.
    pub fn lost_in_card(&self) -> u64 {
        self.lost_in_card
    }

    /// Ends: the link is as it was before.
    pub fn end<T: Transport>(self, card: &mut Card<T>) -> Result<(), HostError> {
        // A card that is another one now is left as it is.
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

    /// The row of a running clock's position; the other channels have nothing to do with it.
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

    /// The row of these results; none if no channel has brought anything since the last one. Channels may take triggers of their own: the
    /// one with the most results counts them, the latest moment is that of the row.
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

    /// How many results there were since the last row, of the channel with the most; 0 before the first row.
    fn leap(&self, results: &[Reading]) -> u16 {
        let both = results.iter().zip(&self.sequences);
        let steps = both.map(|(r, last)| r.sequence.wrapping_sub(*last));
        steps.max().unwrap_or_default()
    }

    /// Takes what has come, after waiting at most `wait`.
    pub fn fill<T: Transport>(
        &mut self,
        card: &mut Card<T>,
        rows: &mut VecDeque<Row>,
        wait: Duration,
    ) -> Result<(), HostError> {
        if self.streams {
            let mut sets = card.bridge().pushed(wait)?;
            // Whoever was silent may have counted on meanwhile, further than a number of 16 bits tells.
            let was_silent = !sets.is_empty() && (self.in_doubt || self.heard.elapsed() > SILENCE);
            if !sets.is_empty() {
                self.heard = Instant::now();
            }
            self.is_the_same(card, was_silent)?;
            // Those that came before the answer.
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
            // Opens it again when it is back.
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
