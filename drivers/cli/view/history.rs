//! What a page can look back at: every row for a while, the extremes of blocks of rows for hours.
//!
//! A plot has fewer points than rows. Each of its buckets has the least and the greatest value in it, so that nothing that was measured
//! is left out of the picture.

use endat_host::causes;
use endat_host::feed::{cause_codes, Cell, Row};
use endat_host::motion::{Unwrap, Velocity};
use endat_host::units::Scale;
use std::collections::VecDeque;

/// Rows that are kept as they came: 100 s at 10 kHz.
const FINE_ROWS: usize = 1_000_000;
/// Rows of a block.
const BLOCK_ROWS: usize = 256;
/// Blocks that are kept: two and a half hours at 10 kHz.
const BLOCKS: usize = 350_000;

/// What is drawn over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// `position0`, `velocity0`, `difference`.
    pub name: String,
    /// Unit of its values.
    pub unit: String,
    /// Where a position is 0 again; it is counted on here.
    pub wraps_at: Option<f64>,
}

/// Positions counted on over turns, and their velocity.
#[derive(Clone, Debug)]
struct Motion {
    scale: Scale,
    turns: Unwrap,
    velocity: Velocity<i128>,
}

impl Motion {
    /// Takes a position; gives it counted on, and the velocity.
    fn step(&mut self, time_s: f64, position: u64) -> (f64, f64) {
        if !self.scale.fits(position) {
            return (f64::NAN, f64::NAN);
        }
        let total = self.turns.step(self.scale.steps(position));
        let velocity = self.velocity.step(time_s, total);
        let velocity = velocity.filter(|_| self.scale.is_known());
        let velocity = velocity.map_or(f64::NAN, |steps| steps * self.scale.step());
        (self.scale.value(total), velocity)
    }
}

/// The extremes of some rows.
#[derive(Clone, Debug)]
struct Block {
    from_s: f64,
    to_s: f64,
    /// Least and greatest value of each trace, NaN if there is none.
    extremes: Vec<[f64; 2]>,
    /// Causes of each channel, a bit for each.
    causes: Vec<u64>,
}

impl Block {
    fn new(at_s: f64, traces: usize, channels: usize) -> Self {
        Self {
            from_s: at_s,
            to_s: at_s,
            extremes: vec![[f64::NAN; 2]; traces],
            causes: vec![0; channels],
        }
    }

    fn take(&mut self, values: impl Iterator<Item = [f64; 2]>, causes: impl Iterator<Item = u64>) {
        for (mine, [least, greatest]) in self.extremes.iter_mut().zip(values) {
            // NaN is no value: `min` and `max` take the other one.
            *mine = [mine[0].min(least), mine[1].max(greatest)];
        }
        for (mine, new) in self.causes.iter_mut().zip(causes) {
            *mine |= new;
        }
    }
}

/// A plot: buckets of the same length.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Begin of the first bucket.
    pub from_s: f64,
    /// End of the last one.
    pub to_s: f64,
    /// Least and greatest value in each bucket, for each trace; NaN where there is none.
    pub extremes: Vec<Vec<[f64; 2]>>,
    /// Causes in each bucket, for each channel; a bit for each.
    pub causes: Vec<Vec<u64>>,
}

/// The memory of a view.
pub struct History {
    scales: Vec<Scale>,
    motions: Vec<Motion>,
    traces: Vec<Trace>,
    has_difference: bool,
    times: VecDeque<f64>,
    values: Vec<VecDeque<f64>>,
    causes: Vec<VecDeque<u64>>,
    blocks: VecDeque<Block>,
    /// The block that is being filled, and its rows.
    block: Option<(Block, usize)>,
}

/// The bit of a code of a cause; 0 for none, which nearly all cells have.
fn bit(cell: &Cell) -> u64 {
    if cell.cause == causes::name(0) {
        return 0;
    }
    let code = cell.cause_code();
    let place = cause_codes().position(|(known, _)| known == code);
    place.map_or(0, |n| 1 << n)
}

/// Names of the causes whose bits are set.
pub fn names(bits: u64) -> Vec<&'static str> {
    let all = cause_codes().enumerate();
    all.filter(|(n, _)| bits >> n & 1 == 1)
        .map(|(_, (_, name))| name)
        .collect()
}

impl History {
    /// Keeps channels with these scales. Velocity and difference need a known range.
    pub fn new(scales: &[Scale]) -> Self {
        let mut traces = Vec::new();
        for (n, scale) in scales.iter().enumerate() {
            let unit = scale.convert(0).unit;
            traces.push(Trace {
                name: format!("position{n}"),
                unit: unit.into(),
                wraps_at: scale.wraps_at(),
            });
            traces.push(Trace {
                name: format!("velocity{n}"),
                unit: format!("{unit}/s"),
                wraps_at: None,
            });
        }
        let unit = |n: usize| scales[n].convert(0).unit;
        let are_known = scales.iter().take(2).all(Scale::is_known);
        let has_difference = scales.len() > 1 && unit(0) == unit(1) && are_known;
        if has_difference {
            traces.push(Trace {
                name: "difference".into(),
                unit: unit(0).into(),
                wraps_at: None,
            });
        }
        Self {
            scales: scales.to_vec(),
            motions: (scales.iter())
                .map(|scale| Motion {
                    scale: *scale,
                    turns: Unwrap::new(scale.range()),
                    velocity: Velocity::default(),
                })
                .collect(),
            values: vec![VecDeque::new(); traces.len()],
            causes: vec![VecDeque::new(); scales.len()],
            traces,
            has_difference,
            times: VecDeque::new(),
            blocks: VecDeque::new(),
            block: None,
        }
    }

    /// What can be drawn.
    pub fn traces(&self) -> &[Trace] {
        &self.traces
    }

    /// The first and the last moment that are known.
    pub fn span_s(&self) -> Option<(f64, f64)> {
        let first = self.blocks.front().map(|b| b.from_s);
        let first = first.or(self.times.front().copied())?;
        Some((first, *self.times.back()?))
    }

    /// The position of a channel, counted on over turns; none if the last row brought none.
    pub fn position(&self, channel: usize) -> Option<f64> {
        let value = self.values.get(2 * channel)?.back()?;
        (!value.is_nan()).then_some(*value)
    }

    /// Takes a row.
    pub fn push(&mut self, time_s: f64, row: &Row) {
        let mut values = Vec::with_capacity(self.traces.len());
        for (cell, motion) in row.cells.iter().zip(&mut self.motions) {
            let position = cell.position.filter(|_| cell.fresh);
            let (value, velocity) = match position {
                Some(position) => motion.step(time_s, position),
                None => (f64::NAN, f64::NAN),
            };
            values.extend([value, velocity]);
        }
        if self.has_difference {
            values.push(values[0] - values[2]);
        }
        let causes: Vec<u64> = row.cells.iter().map(bit).collect();
        if self.times.len() == FINE_ROWS {
            self.times.pop_front();
            for values in &mut self.values {
                values.pop_front();
            }
            for causes in &mut self.causes {
                causes.pop_front();
            }
        }
        self.times.push_back(time_s);
        for (to, value) in self.values.iter_mut().zip(&values) {
            to.push_back(*value);
        }
        for (to, bits) in self.causes.iter_mut().zip(&causes) {
            to.push_back(*bits);
        }
        let begin = || (Block::new(time_s, values.len(), causes.len()), 0);
        let (block, rows) = self.block.get_or_insert_with(begin);
        block.to_s = time_s;
        block.take(values.iter().map(|v| [*v; 2]), causes.iter().copied());
        *rows += 1;
        if *rows == BLOCK_ROWS {
            if self.blocks.len() == BLOCKS {
                self.blocks.pop_front();
            }
            self.blocks
                .extend(self.block.take().map(|(block, _)| block));
        }
    }

    /// What there is from one moment to another, in so many buckets.
    pub fn plot(&self, from_s: f64, to_s: f64, buckets: usize) -> Plot {
        let length = (to_s - from_s) / buckets as f64;
        let mut all: Vec<Block> = (0..buckets)
            .map(|_| Block::new(from_s, self.traces.len(), self.scales.len()))
            .collect();
        let place = |time: f64| ((time - from_s) / length).floor();
        let last = buckets as f64 - 1.0;
        let fine_from = self.times.front().copied().unwrap_or(f64::INFINITY);
        // A block lies in every bucket that it touches.
        for block in self.blocks.iter().take_while(|b| b.from_s < fine_from) {
            if block.to_s < from_s || block.from_s > to_s {
                continue;
            }
            let first = place(block.from_s).clamp(0.0, last) as usize;
            for bucket in &mut all[first..=place(block.to_s).clamp(0.0, last) as usize] {
                bucket.take(block.extremes.iter().copied(), block.causes.iter().copied());
            }
        }
        let begin = self.times.partition_point(|t| *t < from_s);
        let end = self.times.partition_point(|t| *t <= to_s);
        for n in begin..end {
            let bucket = place(self.times[n]).clamp(0.0, last) as usize;
            let values = self.values.iter().map(|v| [v[n]; 2]);
            all[bucket].take(values, self.causes.iter().map(|c| c[n]));
        }
        Plot {
            from_s,
            to_s,
            extremes: (0..self.traces.len())
                .map(|t| all.iter().map(|b| b.extremes[t]).collect())
                .collect(),
            causes: (0..self.scales.len())
                .map(|c| all.iter().map(|b| b.causes[c]).collect())
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TURN: u64 = 1 << 20;

    fn row(position: Option<u64>, cause: &'static str) -> Row {
        let cell = Cell {
            position,
            fresh: position.is_some(),
            cause,
            infos: [None; 2],
        };
        Row {
            run: None,
            trigger: 0,
            cycles: 0,
            missing: 0,
            cells: vec![cell],
        }
    }

    /// Of an encoder that tells so many turns apart.
    fn history(turns: u64) -> History {
        let scale = Scale::Rotary {
            steps_per_turn: TURN,
            turns,
            turns_at: None,
        };
        History::new(&[scale])
    }

    /// Catches a decimation that takes every nth row, or means.
    #[test]
    fn one_row_that_is_far_off_is_in_the_plot_of_a_hundred_thousand() {
        let mut all = history(1);
        for n in 0..100_000u64 {
            let far = if n == 54_321 { TURN / 8 } else { 0 };
            let cause = if n == 77_777 { "crc" } else { "none" };
            all.push(n as f64 * 1e-4, &row(Some(TURN / 4 + far), cause));
        }
        let plot = all.plot(0.0, 10.0, 100);
        let high = plot.extremes[0].iter().filter(|e| e[1] > 134.9);
        assert_eq!(high.count(), 1);
        assert!(plot.extremes[0].iter().all(|e| e[0] == 90.0));
        let wrong: Vec<_> = plot.causes[0]
            .iter()
            .enumerate()
            .filter(|c| *c.1 != 0)
            .collect();
        assert_eq!((wrong.len(), wrong[0].0), (1, 77));
        assert_eq!(names(*wrong[0].1), ["crc"]);
        // Nothing before and behind.
        let empty = all.plot(20.0, 30.0, 10);
        assert!(empty.extremes[0]
            .iter()
            .all(|e| e[0].is_nan() && e[1].is_nan()));
    }

    #[test]
    fn what_is_older_than_the_rows_is_there_as_extremes() {
        let mut all = history(1);
        let count = FINE_ROWS as u64 + 10_000;
        for n in 0..count {
            let far = if n == 1_000 { TURN / 8 } else { 0 };
            all.push(n as f64, &row(Some(TURN / 4 + far), "none"));
        }
        assert_eq!(all.span_s(), Some((0.0, count as f64 - 1.0)));
        assert_eq!(all.times.len(), FINE_ROWS);
        let plot = all.plot(0.0, count as f64, 1_000);
        let high: Vec<usize> = (0..1_000)
            .filter(|n| plot.extremes[0][*n][1] > 134.9)
            .collect();
        // Where the block lies: one bucket, or two.
        assert!(matches!(high.as_slice(), [0] | [0, 1]), "{high:?}");
        assert!(plot.extremes[0].iter().all(|e| e[0] == 90.0));
    }

    #[test]
    fn turns_are_counted_and_velocity_does_not_jump_with_them() {
        let mut all = history(1);
        // A turn in 1000 rows of 0.1 ms: 3600 deg/s, ten turns backwards.
        for n in 0..10_000u64 {
            let position = (TURN * 20 - n * TURN / 1_000) % TURN;
            all.push(n as f64 * 1e-4, &row(Some(position), "none"));
        }
        let plot = all.plot(0.0, 1.0, 10);
        let last = plot.extremes[0][9];
        assert!((last[0] + 3600.0).abs() < 1.0, "{last:?}");
        for [least, greatest] in &plot.extremes[1] {
            assert!((least + 3600.0).abs() < 5.0 && (greatest + 3600.0).abs() < 5.0);
        }
    }

    #[test]
    fn a_multiturn_encoder_counts_itself_and_what_is_not_fresh_is_nothing() {
        let mut all = history(4_096);
        for (n, position) in [5 * TURN + 1, 9 * TURN + 1].into_iter().enumerate() {
            all.push(n as f64, &row(Some(position), "none"));
            all.push(n as f64 + 0.5, &row(None, "no_start_bit"));
        }
        let plot = all.plot(0.0, 2.0, 4);
        let at = |n: usize| plot.extremes[0][n][0];
        assert!((at(0) - 1800.0).abs() < 0.01 && at(1).is_nan());
        assert!((at(2) - 3240.0).abs() < 0.01 && at(3).is_nan());
    }

    /// Catches a velocity or a difference of positions with an unknown range.
    #[test]
    fn counts_that_nobody_explains_have_no_velocity_and_no_difference() {
        let row = |position: u64| {
            let one = row(Some(position), "none");
            Row {
                cells: [one.cells.clone(), one.cells].concat(),
                ..one
            }
        };
        for (scale, is_known) in [
            (Scale::Counts { turns_at: Some(24) }, false),
            (Scale::of_bits(17, 16, Some(24)), true),
        ] {
            let mut all = History::new(&[scale; 2]);
            let names: Vec<&str> = all.traces().iter().map(|t| t.name.as_str()).collect();
            assert_eq!(names.contains(&"difference"), is_known);
            // The last of a turn, and the first of the next one.
            all.push(0.0, &row(100 << 24 | 130_285));
            all.push(1.0, &row(101 << 24));
            let velocity = all.plot(0.5, 1.5, 1).extremes[1][0][0];
            let wanted = 787.0 * 360.0 / 131_072.0;
            assert_eq!(!velocity.is_nan(), is_known, "{velocity}");
            assert!(!is_known || (velocity - wanted).abs() < 1e-9, "{velocity}");
        }
    }
}
