//! Result of a campaign: the number of cases in each class, and the evaluated part of the campaign.

use std::collections::BTreeMap;
use std::ops::Range;

/// A kind of case with its class.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Row {
    /// Design.
    pub subject: String,
    /// Kind of frame or of fault.
    pub kind: String,
    /// Register, or conditions.
    pub place: String,
    /// Class.
    pub class: String,
}

/// Number of cases in each class.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    rows: BTreeMap<Row, u64>,
}

impl Tally {
    /// Adds `count` cases of this class.
    pub fn add(&mut self, row: Row, count: u64) {
        *self.rows.entry(row).or_default() += count;
    }

    /// Adds the counts of another tally.
    pub fn merge(&mut self, other: Tally) {
        for (row, count) in other.rows {
            self.add(row, count);
        }
    }

    /// The rows in order.
    pub fn rows(&self) -> impl Iterator<Item = (&Row, u64)> {
        self.rows.iter().map(|(row, count)| (row, *count))
    }

    /// Number of cases in the selected rows.
    pub fn count(&self, choose: impl Fn(&Row) -> bool) -> u64 {
        let chosen = self.rows().filter(|(row, _)| choose(row));
        chosen.map(|(_, count)| count).sum()
    }
}

/// One of several equal parts of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shard {
    /// Number of the part, 1..=of.
    pub index: u64,
    /// Number of parts.
    pub of: u64,
}

impl Shard {
    /// The whole campaign.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// The cases of this part of `count`.
    pub fn cases(self, count: u64) -> Range<u64> {
        let border =
            |index: u64| (u128::from(count) * u128::from(index) / u128::from(self.of)) as u64;
        border(self.index - 1)..border(self.index)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_campaign_are_all_of_it_once() {
        for (count, of) in [(10, 3), (2, 5), (1_000_000_000_000, 7), (0, 2)] {
            let mut next = 0;
            for index in 1..=of {
                let cases = Shard { index, of }.cases(count);
                assert_eq!(cases.start, next);
                next = cases.end;
            }
            assert_eq!(next, count);
        }
    }
}
