//! Positions counted on over the place where they begin anew, and their velocity: exact, in measuring steps.

use crate::name_plate::NamePlate;
use crate::units::Scale;
use std::collections::VecDeque;

/// A velocity is that over this time at least: the steps of the encoder are small against it.
pub const VELOCITY_OVER_S: f64 = 1e-3;

/// How many positions there are until they begin anew: those of a turn, or of all turns that the encoder tells apart. None of a scale,
/// and where the encoder does not say.
pub fn range(scale: &Scale, plate: Option<&NamePlate>) -> Option<u64> {
    match scale {
        Scale::Rotary { steps_per_turn } => {
            let turns = plate.and_then(|p| p.revolutions).unwrap_or(1).max(1);
            steps_per_turn.checked_mul(turns.into())
        }
        Scale::Linear { .. } | Scale::Counts { .. } => None,
    }
}

/// The same of all channels.
pub fn ranges(scales: &[Scale], plates: &[Option<NamePlate>]) -> Vec<Option<u64>> {
    let plate = |n: usize| plates.get(n).and_then(Option::as_ref);
    let all = scales.iter().enumerate();
    all.map(|(n, scale)| range(scale, plate(n))).collect()
}

/// Counts on where positions begin anew: the next one is where it is nearer to the last one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unwrap {
    range: Option<u64>,
    last: Option<(u64, i128)>,
}

impl Unwrap {
    /// Of positions that begin anew after so many.
    pub fn new(range: Option<u64>) -> Self {
        Self {
            range: range.filter(|r| *r > 0),
            last: None,
        }
    }

    /// Takes a position; gives it counted on.
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

/// The change that is the same up to whole ranges, and the smallest; half a range is forwards.
pub fn nearest(change: i128, range: u64) -> i128 {
    let range = i128::from(range.max(1));
    let forwards = change.rem_euclid(range);
    match 2 * forwards > range {
        true => forwards - range,
        false => forwards,
    }
}

/// What a position can be counted in.
pub trait Place: Copy {
    /// How far it is from another one.
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

/// How fast a position changes, over a while.
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
    /// Over this time at least.
    pub fn over(over_s: f64) -> Self {
        Self {
            over_s,
            recent: VecDeque::new(),
        }
    }

    /// Takes a position that is counted on; gives its change per second, none for the first one.
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
        // A scale does not begin anew.
        let mut scale = Unwrap::new(None);
        assert_eq!([10, 990, 10].map(|p| scale.step(p)), [10, 990, 10]);
    }

    #[test]
    fn a_velocity_is_that_of_a_while() {
        let mut velocity = Velocity::over(1.0);
        assert_eq!(velocity.step(0.0, 0i128), None);
        assert_eq!(velocity.step(0.5, 10), Some(20.0));
        assert_eq!(velocity.step(1.0, 0), Some(0.0));
        // The oldest that is long enough ago.
        assert_eq!(velocity.step(2.0, 100), Some(100.0));
        assert_eq!(velocity.step(2.0, 100), Some(100.0));
    }

    #[test]
    fn a_range_is_that_of_all_turns_that_are_told_apart() {
        let scale = Scale::singleturn(25);
        let plate = |revolutions| NamePlate {
            revolutions,
            ..NamePlate::default()
        };
        for (revolutions, wanted) in [(None, 25), (Some(0), 25), (Some(4_096), 37)] {
            let found = range(&scale, Some(&plate(revolutions)));
            assert_eq!(found, Some(1 << wanted), "{revolutions:?}");
        }
        assert_eq!(range(&Scale::Linear { step_nm: 1.0 }, None), None);
    }
}
