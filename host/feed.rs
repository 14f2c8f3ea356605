//! Rows of positions, one for each trigger: from the stream if the card has one, else from its result registers.

use crate::card::Card;
use crate::causes;
use crate::registers::Place;
use crate::transport::Transport;
use crate::HostError;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// A channel of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Last good position, if there is one.
    pub position: Option<u64>,
    /// This trigger brought it.
    pub fresh: bool,
    /// Name of the cause; `not_taken` and `too_late` if the channel took no part.
    pub cause: &'static str,
}

/// What a trigger brought.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of the trigger, not wrapping.
    pub trigger: u64,
    /// System clock cycles since the first row, not wrapping.
    pub cycles: u64,
    /// Triggers without a row just before this one.
    pub missing: u64,
    /// One for each channel.
    pub cells: Vec<Cell>,
}

/// Makes numbers that wrap into numbers that do not: two rows must be less than 2^16 triggers and 2^32 cycles apart.
#[derive(Clone, Debug, Default)]
struct Clock {
    last: Option<(u16, u32)>,
    trigger: u64,
    cycles: u64,
}

impl Clock {
    /// Takes a trigger's number and moment; gives how many were missing before it.
    fn step(&mut self, sequence: u16, timestamp: u32) -> u64 {
        let missing = match self.last {
            None => {
                self.trigger = sequence.into();
                0
            }
            Some((last_sequence, last_timestamp)) => {
                let steps = u64::from(sequence.wrapping_sub(last_sequence));
                self.trigger += steps;
                self.cycles += u64::from(timestamp.wrapping_sub(last_timestamp));
                steps.saturating_sub(1)
            }
        };
        self.last = Some((sequence, timestamp));
        missing
    }
}

/// Bits of `card.stream_control`: collect and push.
const COLLECT_AND_PUSH: u32 = 0b11;

/// Where rows come from.
pub struct Feed {
    streams: bool,
    clock: Clock,
    lost_in_card: u64,
    heard: Instant,
}

/// Nothing for so long: perhaps the card has begun anew, and does not stream any more.
const SILENCE: Duration = Duration::from_secs(1);

impl Feed {
    /// Begins: from the stream if the card has one and `polls` does not forbid it.
    pub fn begin<T: Transport>(card: &mut Card<T>, polls: bool) -> Result<Self, HostError> {
        let streams = card.identity().has("stream") && !polls;
        if streams {
            let at = |register| Place::at("card", register, 0);
            card.write(&at("stream_clear"), 1)?;
            card.write(&at("stream_control"), COLLECT_AND_PUSH)?;
            card.bridge().set_pushes(true);
        }
        Ok(Self {
            streams,
            clock: Clock::default(),
            lost_in_card: 0,
            heard: Instant::now(),
        })
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
        match self.streams {
            true => card.bridge().end_push(),
            false => Ok(()),
        }
    }

    fn row(&mut self, sequence: u16, timestamp: u32, cells: Vec<Cell>) -> Row {
        let missing = self.clock.step(sequence, timestamp);
        Row {
            trigger: self.clock.trigger,
            cycles: self.clock.cycles,
            missing,
            cells,
        }
    }

    /// Takes what has come, after waiting at most `wait`.
    pub fn fill<T: Transport>(
        &mut self,
        card: &mut Card<T>,
        rows: &mut VecDeque<Row>,
        wait: Duration,
    ) -> Result<(), HostError> {
        if self.streams {
            let sets = card.bridge().pushed(wait)?;
            if !sets.is_empty() {
                self.heard = Instant::now();
            } else if self.heard.elapsed() > SILENCE {
                self.heard = Instant::now();
                let control = Place::at("card", "stream_control", 0);
                card.write(&control, COLLECT_AND_PUSH)?;
            }
            for set in sets {
                self.lost_in_card += u64::from(set.lost);
                let cells = set.channels.iter().map(|s| Cell {
                    position: s.valid.then_some(s.position),
                    fresh: s.fresh,
                    cause: match (s.taken, s.missing) {
                        (false, _) => "not_taken",
                        (_, true) => "too_late",
                        _ => s.cause_name(),
                    },
                });
                let cells = cells.collect();
                rows.push_back(self.row(set.sequence, set.timestamp, cells));
            }
            return Ok(());
        }
        let results = card.results()?.channels;
        let first = results[0];
        let has_begun = results.iter().any(|r| r.has_come());
        if has_begun && self.clock.last.map(|(sequence, _)| sequence) != Some(first.sequence) {
            let cells = results.iter().map(|r| Cell {
                position: r.valid.then_some(r.position),
                fresh: r.fresh,
                cause: causes::name(r.cause),
            });
            rows.push_back(self.row(first.sequence, first.timestamp, cells.collect()));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_wrap_go_on() {
        let mut clock = Clock::default();
        let steps = [(0xFFFE, 0xFFFF_FFF0), (0xFFFF, 0x10), (2, 0x30)];
        let missing = steps.map(|(sequence, timestamp)| {
            let missing = clock.step(sequence, timestamp);
            (clock.trigger, clock.cycles, missing)
        });
        assert_eq!(
            missing,
            [(0xFFFE, 0, 0), (0xFFFF, 0x20, 0), (0x1_0002, 0x40, 2)]
        );
    }
}
