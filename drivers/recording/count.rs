//! Which rows of a log are bad, counted by cause.

use endat_host::feed::{Cell, Row, LATE, NOT_TAKEN};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Which cells are bad.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Judge {
    /// Triggers may be for some channels only: a channel that took none has done nothing wrong.
    pub own_triggers: bool,
}

impl Judge {
    /// Whether the trigger should have brought a position, and did not.
    pub fn is_bad(self, cell: &Cell) -> bool {
        self.misses(cell.fresh, cell.cause)
    }

    /// The same of what a file says.
    pub fn misses(self, fresh: bool, cause: &str) -> bool {
        // Without a cause it is an answer that has no position, to a request of the host.
        let is_excused = match cause {
            "none" => true,
            NOT_TAKEN | LATE => self.own_triggers,
            _ => false,
        };
        !fresh && !is_excused
    }

    /// Whether something is to be told of it, and be it a warning beside a good position.
    pub fn is_remarkable(self, cell: &Cell) -> bool {
        self.is_bad(cell) || cell.fresh && cell.cause != endat_host::causes::name(0)
    }
}

/// What became of a channel, row by row: one concept for a log that runs and for a recording that is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rows in which it should have brought a position, and did not, by cause.
    pub bad: BTreeMap<String, u64>,
    /// What was noticed beside a good position, or where none was due, by cause.
    pub beside: BTreeMap<String, u64>,
}

impl Tally {
    /// Takes a cell; whether it is bad.
    pub fn note(&mut self, judge: Judge, fresh: bool, cause: &str) -> bool {
        let is_bad = judge.misses(fresh, cause);
        let counts = match is_bad {
            true => &mut self.bad,
            false if cause == endat_host::causes::name(0) => return false,
            false => &mut self.beside,
        };
        match counts.get_mut(cause) {
            Some(count) => *count += 1,
            None => {
                counts.insert(cause.to_owned(), 1);
            }
        }
        is_bad
    }

    /// Rows in which it was bad.
    pub fn bad_rows(&self) -> u64 {
        self.bad.values().sum()
    }
}

/// `crc 780, no_start_bit 7`.
fn named(counts: &BTreeMap<String, u64>) -> String {
    let each = counts
        .iter()
        .map(|(cause, count)| format!("{cause} {count}"));
    each.collect::<Vec<_>>().join(", ")
}

/// What became of the rows.
#[derive(Default)]
pub struct Count {
    judge: Judge,
    /// Rows.
    pub rows: u64,
    /// Triggers without a row.
    pub missing: u64,
    /// Rows in which a channel is bad.
    pub bad: u64,
    channels: Vec<Tally>,
}

impl Count {
    /// No rows yet.
    pub fn new(judge: Judge) -> Self {
        Self {
            judge,
            ..Self::default()
        }
    }

    /// Takes a row.
    pub fn note(&mut self, row: &Row) {
        self.rows += 1;
        self.missing += row.missing;
        if self.channels.len() < row.cells.len() {
            self.channels.resize(row.cells.len(), Tally::default());
        }
        let mut is_bad = false;
        for (tally, cell) in self.channels.iter_mut().zip(&row.cells) {
            is_bad |= tally.note(self.judge, cell.fresh, cell.cause);
        }
        self.bad += u64::from(is_bad);
    }

    /// Share of bad rows in per cent.
    pub fn bad_percent(&self) -> f64 {
        self.bad as f64 * 100.0 / self.rows.max(1) as f64
    }

    /// Channel, cause and number of its bad cells.
    pub fn causes(&self) -> impl Iterator<Item = (usize, &str, u64)> + '_ {
        let all = self.channels.iter().enumerate();
        all.flat_map(|(n, tally)| {
            tally
                .bad
                .iter()
                .map(move |(cause, count)| (n, cause.as_str(), *count))
        })
    }

    /// `787 of 800 rows bad (98.4 %); channel 0: crc 780, no_start_bit 7; beside good positions: channel 1: trigger_overrun 3`.
    pub fn told(&self) -> String {
        let of = |counts: fn(&Tally) -> &BTreeMap<String, u64>| {
            let all = self.channels.iter().enumerate();
            let all = all.filter(|(_, tally)| !counts(tally).is_empty());
            let all = all.map(|(n, tally)| format!("; channel {n}: {}", named(counts(tally))));
            all.collect::<String>()
        };
        let mut text = match self.bad {
            0 => "no row bad".to_owned(),
            bad => format!(
                "{bad} of {} rows bad ({:.1} %)",
                self.rows,
                self.bad_percent()
            ),
        };
        text += &of(|tally| &tally.bad);
        let beside = of(|tally| &tally.beside);
        if !beside.is_empty() {
            let _ = write!(
                text,
                "; beside good positions{}",
                beside.replacen(';', ":", 1)
            );
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_counted_once_and_cells_by_cause() {
        let cell = |cause, fresh| Cell {
            position: Some(5),
            fresh,
            cause,
            infos: [None; 2],
        };
        for (own_triggers, told) in [
            (
                true,
                "2 of 4 rows bad (50.0 %); channel 0: crc 2; channel 1: no_start_bit 1; beside good positions: channel 0: recovery_too_short 1; channel 1: late 1, not_taken 1",
            ),
            (
                false,
                "3 of 4 rows bad (75.0 %); channel 0: crc 2; channel 1: late 1, no_start_bit 1, not_taken 1; beside good positions: channel 0: recovery_too_short 1",
            ),
        ] {
            let mut count = Count::new(Judge { own_triggers });
            for cells in [
                vec![cell("none", true), cell("none", true)],
                vec![cell("crc", false), cell("no_start_bit", false)],
                vec![cell("crc", false), cell("not_taken", false)],
                // A good position with a warning; a result of the row before.
                vec![cell("recovery_too_short", true), cell("late", false)],
            ] {
                count.note(&Row {
                    run: None,
                    trigger: 0,
                    cycles: 0,
                    missing: 0,
                    cells,
                });
            }
            assert_eq!(count.told(), told);
        }
    }
}
