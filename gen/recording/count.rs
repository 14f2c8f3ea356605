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
    /// Cells without a position of their own, by channel and cause.
    causes: BTreeMap<(usize, &'static str), u64>,
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
        let bad = row.cells.iter().enumerate();
        let mut bad = bad.filter(|(_, c)| self.judge.is_bad(c)).peekable();
        self.bad += u64::from(bad.peek().is_some());
        for (channel, cell) in bad {
            *self.causes.entry((channel, cell.cause)).or_default() += 1;
        }
    }

    /// Share of bad rows in per cent.
    pub fn bad_percent(&self) -> f64 {
        self.bad as f64 * 100.0 / self.rows.max(1) as f64
    }

    /// Channel, cause and number of its bad cells.
    pub fn causes(&self) -> impl Iterator<Item = (usize, &'static str, u64)> + '_ {
        let all = self.causes.iter();
        all.map(|((channel, cause), count)| (*channel, *cause, *count))
    }

    /// `787 of 800 rows bad (98.4 %): channel 0 crc 780, no_start_bit 7`.
    pub fn told(&self) -> String {
        if self.bad == 0 {
            return "no row bad".into();
        }
        let mut text = format!(
            "{} of {} rows bad ({:.1} %)",
            self.bad,
            self.rows,
            self.bad_percent()
        );
        let mut last = None;
        for ((channel, cause), count) in &self.causes {
            let _ = match last {
                Some(before) if before == channel => write!(text, ", {cause} {count}"),
                _ => write!(text, "; channel {channel}: {cause} {count}"),
            };
            last = Some(channel);
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
                "2 of 4 rows bad (50.0 %); channel 0: crc 2; channel 1: no_start_bit 1",
            ),
            (
                false,
                "3 of 4 rows bad (75.0 %); channel 0: crc 2; channel 1: late 1, no_start_bit 1, not_taken 1",
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
