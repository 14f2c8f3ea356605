//! Values over time, reduced to the number of columns of a drawing, for any number of values and any duration.

/// Most columns; above this, pairs are merged, so at least half as many remain.
pub(super) const COLUMNS_MAX: usize = 1640;

/// Content of a column, and its merging.
pub trait Column: Clone + Default {
    /// Adds the content of the next column.
    fn join(&mut self, next: &Self);
}

/// Columns of equal duration, from the first time on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns<T> {
    first_s: Option<f64>,
    width_s: f64,
    all: Vec<T>,
}

impl<T: Column> Columns<T> {
    /// The column of a time. Earlier times belong to the first column.
    pub fn at(&mut self, time_s: f64) -> &mut T {
        let first = *self.first_s.get_or_insert(time_s);
        let since = (time_s - first).max(0.0);
        if self.width_s == 0.0 && since > 0.0 {
            // Narrow enough for separate columns at this rate.
            self.width_s = since / 2.0;
        }
        let place = loop {
            let place = match self.width_s > 0.0 {
                true => (since / self.width_s) as usize,
                false => 0,
            };
            if place < COLUMNS_MAX {
                break place;
            }
            self.halve();
        };
        if self.all.len() <= place {
            self.all.resize(place + 1, T::default());
        }
        &mut self.all[place]
    }

    /// Empty columns of the same times.
    pub(super) fn like<U: Column>(&self) -> Columns<U> {
        Columns {
            first_s: self.first_s,
            width_s: self.width_s,
            all: Vec::new(),
        }
    }

    /// Duration of a row, or of two columns if longer.
    pub(super) fn row_s(&self) -> f64 {
        2.0 * self.width_s
    }

    fn halve(&mut self) {
        let joined = self.all.chunks(2).map(|two| {
            let mut one = two[0].clone();
            two[1..].iter().for_each(|next| one.join(next));
            one
        });
        self.all = joined.collect();
        self.width_s *= 2.0;
    }

    /// The middle of each column, and its content.
    pub fn iter(&self) -> impl Iterator<Item = (f64, &T)> + '_ {
        let first = self.first_s.unwrap_or(0.0);
        let middle = move |n: usize| first + self.width_s * (n as f64 + 0.5);
        self.all
            .iter()
            .enumerate()
            .map(move |(n, t)| (middle(n), t))
    }
}

/// The numbers of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Times and values of the first and the last value.
    pub(super) ends: Option<[(f64, f64); 2]>,
    /// Minimum and maximum.
    pub(super) least: f64,
    pub(super) greatest: f64,
    /// Gaps before the first value, between two values, and after the last.
    pub(super) gaps: [bool; 3],
    /// Number of missing values.
    pub(super) bad: u64,
}

impl Default for Extremes {
    fn default() -> Self {
        Self {
            ends: None,
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
            gaps: [false; 3],
            bad: 0,
        }
    }
}

impl Extremes {
    /// Adds a value, or a gap.
    pub(super) fn take(&mut self, time_s: f64, value: Option<f64>) {
        let next = match value {
            Some(value) => Self {
                ends: Some([(time_s, value); 2]),
                least: value,
                greatest: value,
                ..Self::default()
            },
            None => Self {
                gaps: [true, false, true],
                ..Self::default()
            },
        };
        self.join(&next);
    }
}

impl Column for Extremes {
    fn join(&mut self, next: &Self) {
        let [before, between, behind] = next.gaps;
        self.gaps = match (self.ends, next.ends) {
            (None, None) => {
                let any = self.gaps[0] || before;
                [any, false, any]
            }
            (None, Some(_)) => [self.gaps[0] || before, between, behind],
            (Some(_), None) => [self.gaps[0], self.gaps[1], self.gaps[2] || before],
            (Some(_), Some(_)) => {
                let here = self.gaps[1] || self.gaps[2] || before || between;
                [self.gaps[0], here, behind]
            }
        };
        self.ends = match (self.ends, next.ends) {
            (Some(mine), Some(other)) => Some([mine[0], other[1]]),
            (mine, other) => mine.or(other),
        };
        self.least = self.least.min(next.least);
        self.greatest = self.greatest.max(next.greatest);
        self.bad += next.bad;
    }
}

/// Number of events in a column.
impl Column for u64 {
    fn join(&mut self, next: &Self) {
        *self += next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a decimation that keeps every nth value, and unlimited memory.
    #[test]
    fn one_value_of_a_million_is_in_the_columns() {
        let mut all: Columns<Extremes> = Columns::default();
        for n in 0..1_000_000u32 {
            let value = if n == 654_321 { 9.0 } else { 1.0 };
            let time_s = f64::from(n) * 1e-4;
            let there = (n != 777_777).then_some(value);
            all.at(time_s).take(time_s, there);
        }
        let count = all.iter().count();
        assert!((COLUMNS_MAX / 2..=COLUMNS_MAX).contains(&count), "{count}");
        let high: Vec<f64> = all
            .iter()
            .filter(|c| c.1.greatest > 8.0)
            .map(|c| c.0)
            .collect();
        assert!(
            high.len() == 1 && (high[0] - 65.4321).abs() < 0.1,
            "{high:?}"
        );
        assert!(all.iter().all(|c| c.1.least == 1.0));
        assert_eq!(all.iter().filter(|c| c.1.gaps[1]).count(), 1);
    }

    #[test]
    fn a_long_pause_is_empty_columns() {
        let mut all: Columns<u64> = Columns::default();
        for time_s in [0.0, 1e-4, 2e-4, 3_600.0] {
            *all.at(time_s) += 1;
        }
        let counts: Vec<u64> = all.iter().map(|c| *c.1).filter(|n| *n > 0).collect();
        assert_eq!(counts, [3, 1]);
        // Rare events have the same time resolution.
        let mut seldom: Columns<u64> = Columns::default();
        (0..1_000).for_each(|n| *seldom.at(f64::from(n)) += 0);
        let mut seldom: Columns<u64> = seldom.like();
        *seldom.at(100.0) += 1;
        *seldom.at(900.0) += 1;
        let times = seldom.iter().filter(|c| *c.1 > 0).map(|c| c.0.floor());
        assert_eq!(times.collect::<Vec<_>>(), [100.0, 900.0]);
        // Before the first, as for positions of a running clock.
        *all.at(-1.0) += 1;
        assert_eq!(all.iter().next().map(|c| *c.1), Some(4));
    }
}
