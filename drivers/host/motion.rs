//! Unwrapped positions and their velocity: exact, in measuring steps.

use std::collections::VecDeque;

/// A velocity is computed over at least this time, so that the encoder's steps are small against it.
pub const VELOCITY_OVER_S: f64 = 1e-3;

/// Unwraps positions: each position continues from the nearest turn of the last one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unwrap {
    range: Option<u64>,
    last: Option<(u64, i128)>,
}

impl Unwrap {
    /// For positions that wrap after `range` steps.
    pub fn new(range: Option<u64>) -> Self {
        Self {
            range: range.filter(|r| *r > 0),
            last: None,
        }
    }

    /// Processes a position; returns it unwrapped.
    pub fn step(&mut self, position: u64) -> i128 {
        let total = match self.last {
            None => position.into(),
            Some((last, total)) => {
                let change = i128::from(position) - i128::from(last);
                total + self.range.map_or(change, |range| nearest(change, range))
            }
        };
        self.last = Some((position, total));
        total
    }
}

/// The equivalent change, modulo `range`, with the smallest size; half a range counts as forwards.
pub fn nearest(change: i128, range: u64) -> i128 {
    let range = i128::from(range.max(1));
    let forwards = match change {
        // A 128-bit division costs more than the rest of a row.
        change if (0..range).contains(&change) => change,
        change if (-range..0).contains(&change) => change + range,
        change => change.rem_euclid(range),
    };
    match 2 * forwards > range {
        true => forwards - range,
        false => forwards,
    }
}

/// Unit in which positions are counted.
pub trait Place: Copy {
    /// Distance from another position.
    fn since(self, other: Self) -> f64;
}

impl Place for i128 {
    fn since(self, other: Self) -> f64 {
        (self - other) as f64
    }
}

impl Place for f64 {
    fn since(self, other: Self) -> f64 {
        self - other
    }
}

/// Velocity, averaged over a time.
#[derive(Clone, Debug)]
pub struct Velocity<T> {
    over_s: f64,
    recent: VecDeque<(f64, T)>,
}

impl<T: Place> Default for Velocity<T> {
    fn default() -> Self {
        Self::over(VELOCITY_OVER_S)
    }
}

impl<T: Place> Velocity<T> {
    /// Averages over at least this time.
    pub fn over(over_s: f64) -> Self {
        Self {
            over_s,
            recent: VecDeque::new(),
        }
    }

    /// Processes an unwrapped position; returns its change per second, `None` for the first one.
    pub fn step(&mut self, time_s: f64, place: T) -> Option<f64> {
        while self.recent.len() > 1 && time_s - self.recent[1].0 >= self.over_s {
            self.recent.pop_front();
        }
        let from = self.recent.front().filter(|from| time_s > from.0);
        let velocity = from.map(|(t, x)| place.since(*x) / (time_s - t));
        self.recent.push_back((time_s, place));
        velocity
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Scale;

    #[test]
    fn positions_of_48_bits_are_counted_on_without_losing_a_step() {
        let range = 1u64 << 48;
        let mut unwrap = Unwrap::new(Some(range));
        let step = range / 2 - 1;
        let mut position = 5;
        unwrap.step(position);
        for n in 1..1_000i128 {
            position = (position + step) % range;
            assert_eq!(unwrap.step(position), 5 + n * i128::from(step));
        }
        let mut back = Unwrap::new(Some(1_000));
        assert_eq!([10, 990, 10, 510].map(|p| back.step(p)), [10, -10, 10, 510]);
        // A scale does not wrap.
        let mut scale = Unwrap::new(None);
        assert_eq!([10, 990, 10].map(|p| scale.step(p)), [10, 990, 10]);
    }

    #[test]
    fn nearest_change_is_whole_ranges_away_and_at_most_half_a_one() {
        for range in [1, 2, 7, 1_000, u64::MAX] {
            let wide = i128::from(range);
            let near_ends = (-3..=3).flat_map(|n| (-4..=4).map(move |off| n * wide / 2 + off));
            for change in near_ends {
                let near = nearest(change, range);
                assert_eq!((near - change) % wide, 0, "{change} of {range}");
                assert!(-wide < 2 * near && 2 * near <= wide, "{change} of {range}");
            }
        }
    }

    #[test]
    fn a_velocity_is_that_of_a_while() {
        let mut velocity = Velocity::over(1.0);
        assert_eq!(velocity.step(0.0, 0i128), None);
        assert_eq!(velocity.step(0.5, 10), Some(20.0));
        assert_eq!(velocity.step(1.0, 0), Some(0.0));
        // The oldest position that is old enough.
        assert_eq!(velocity.step(2.0, 100), Some(100.0));
        assert_eq!(velocity.step(2.0, 100), Some(100.0));
    }

    /// Forwards over a turn and over all 4096, and back: no step exceeds the real 1000.
    #[test]
    fn turns_and_the_end_of_their_count_are_passed_in_both_directions() {
        const STEP: i128 = 1_000;
        for (single, multi, turns_at) in [(25, 12, None), (12, 13, None), (17, 16, Some(24))] {
            let scale = Scale::of_bits(single, multi, turns_at);
            let range = i128::from(scale.range().unwrap());
            // As the encoder sends it.
            let sent = |steps: i128| {
                let steps = steps.rem_euclid(range) as u64;
                let (turn, within) = (steps >> single, steps & ((1 << single) - 1));
                turn << turns_at.unwrap_or(single) | within
            };
            for begin in [(1 << single) - 5 * STEP, range - 5 * STEP] {
                let mut unwrap = Unwrap::new(scale.range());
                let there = (0..10).map(|n| begin + n * STEP);
                let back = (0..10).map(|n| begin + (9 - n) * STEP);
                let first = unwrap.step(scale.steps(sent(begin)));
                for wanted in there.chain(back) {
                    let counted = unwrap.step(scale.steps(sent(wanted)));
                    assert_eq!(counted - first, wanted - begin, "{single}+{multi}");
                }
            }
        }
        let mut scale = Unwrap::new(Scale::Counted.range());
        assert_eq!([5, 1 << 40, 5].map(|p| scale.step(p)), [5, 1 << 40, 5]);
    }
}
