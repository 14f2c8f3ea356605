//! A drawing of a recording: positions counted on over turns, what is asked for beside them, and the faults as lanes below.

use super::count::Judge;
use super::layout::DerivedColumn;
use endat_draw::{series_svg, Lane, Series};
use endat_host::feed::Row;
use endat_host::motion::{Unwrap, Velocity};
use endat_host::units::Scale;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A channel of a row, as a drawing and counts want it.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// As the encoder sent it, if that is known.
    pub raw: Option<u64>,
    /// In its unit, counted on; only one that this trigger brought.
    pub position: Option<f64>,
    /// This trigger brought it.
    pub fresh: bool,
    /// The cause.
    pub cause: Cow<'static, str>,
}

/// A row, of the card or of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurement {
    /// It is the first row of a file.
    pub begins_file: bool,
    /// Number of the trigger; none of a running clock.
    pub trigger: Option<u64>,
    /// Seconds since the first row.
    pub time_s: f64,
    /// Triggers without a row just before.
    pub missing: u64,
    /// Number and missing triggers follow from the rows around it.
    pub fits: bool,
    /// Each channel.
    pub cells: Vec<Seen>,
    /// Each derived column.
    pub derived: Vec<Option<f64>>,
}

/// Makes measurements of rows: turns are counted on where it is known what a turn is.
pub struct Counter {
    scales: Vec<Scale>,
    turns: Vec<Unwrap>,
}

impl Counter {
    /// Of channels with these scales.
    pub fn new(scales: &[Scale]) -> Self {
        Self {
            scales: scales.to_vec(),
            turns: scales.iter().map(|s| Unwrap::new(s.range())).collect(),
        }
    }

    /// The position of a channel, counted on.
    pub fn position(&mut self, channel: usize, raw: u64) -> Option<f64> {
        let (scale, turns) = (self.scales.get(channel)?, self.turns.get_mut(channel)?);
        let fits = scale.fits(raw);
        fits.then(|| scale.value(turns.step(scale.steps(raw))))
    }

    /// A row.
    pub fn measurement(
        &mut self,
        row: &Row,
        time_s: f64,
        derived: Vec<Option<f64>>,
    ) -> Measurement {
        let cells = row.cells.iter().enumerate().map(|(n, cell)| Seen {
            raw: cell.position,
            position: (cell.position.filter(|_| cell.fresh)).and_then(|raw| self.position(n, raw)),
            fresh: cell.fresh,
            cause: cell.cause.into(),
        });
        Measurement {
            begins_file: false,
            trigger: row.run.is_none().then_some(row.trigger),
            time_s,
            missing: row.missing,
            fits: true,
            cells: cells.collect(),
            derived,
        }
    }
}

/// A drawing, and what it is drawn from.
pub struct Drawing {
    /// The drawing.
    pub picture: Picture,
    /// Counts turns on.
    pub counter: Counter,
}

/// What is drawn beside positions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extras {
    /// Channel 0 minus channel 1.
    pub difference: bool,
    /// How fast each channel moves.
    pub velocity: bool,
}

/// A drawing that grows; its memory does not.
pub struct Picture {
    judge: Judge,
    positions: Vec<Series>,
    velocities: Vec<(Velocity<f64>, Series)>,
    difference: Option<Series>,
    derived: Vec<Series>,
    lanes: BTreeMap<(usize, Cow<'static, str>), Lane>,
    missing: Option<Lane>,
    /// Time between rows, mostly: the mean of some.
    step_s: Option<f64>,
    last_s: Option<f64>,
}

/// Rows are missing where nothing came for so many times as long as usual.
const PAUSE: f64 = 5.0;

impl Picture {
    /// Of channels with these units.
    pub fn new(units: &[String], derived: &[DerivedColumn], judge: Judge, extras: Extras) -> Self {
        let each = || units.iter().enumerate();
        let has_difference = extras.difference && units.len() > 1 && units[0] == units[1];
        Self {
            judge,
            positions: each()
                .map(|(n, unit)| Series::new(format!("channel {n}"), unit.clone()))
                .collect(),
            velocities: each()
                .filter(|_| extras.velocity)
                .map(|(n, unit)| {
                    let series = Series::new(format!("velocity {n}"), format!("{unit}/s"));
                    (Velocity::default(), series)
                })
                .collect(),
            difference: has_difference
                .then(|| Series::new("channel 0 minus channel 1", units[0].clone())),
            derived: (derived.iter())
                .map(|one| Series::new(one.name.clone(), one.unit.clone()))
                .collect(),
            lanes: BTreeMap::new(),
            missing: None,
            step_s: None,
            last_s: None,
        }
    }

    fn all(&mut self) -> impl Iterator<Item = &mut Series> {
        let velocities = self.velocities.iter_mut().map(|v| &mut v.1);
        (self.positions.iter_mut())
            .chain(velocities)
            .chain(&mut self.difference)
            .chain(&mut self.derived)
    }

    /// Whether rows are missing just before a row, or are in no file. A card that is read one by one misses some all the time: only a pause
    /// is a gap there.
    fn is_gap(&mut self, row: &Measurement) -> bool {
        let last = self.last_s.replace(row.time_s);
        let since = last.map(|last| row.time_s - last);
        let Some(since) = since.filter(|s| *s > 0.0) else {
            return false;
        };
        let usual = self.step_s.unwrap_or(since);
        let is_pause = since > PAUSE * usual;
        if !is_pause {
            self.step_s = Some(usual + (since - usual) / 16.0);
        }
        is_pause && (row.missing > 0 || row.begins_file)
    }

    /// A row.
    pub fn push(&mut self, row: &Measurement) {
        let time_s = row.time_s;
        if self.is_gap(row) {
            self.all().for_each(Series::gap);
        }
        let none = endat_host::causes::name(0);
        for (n, cell) in row.cells.iter().enumerate() {
            // Beside a running clock's position the other channels have nothing to do.
            if row.trigger.is_none() && !cell.fresh && cell.cause == none {
                continue;
            }
            if let Some(series) = self.positions.get_mut(n) {
                series.push(time_s, cell.position);
                if self.judge.misses(cell.fresh, &cell.cause) {
                    series.mark(time_s);
                }
            }
            if let Some((velocity, series)) = self.velocities.get_mut(n) {
                let now = cell.position.map(|p| velocity.step(time_s, p));
                match now {
                    // The first one has none, and is no gap.
                    Some(None) => {}
                    other => series.push(time_s, other.flatten()),
                }
            }
            if cell.cause != none {
                let key = (n, cell.cause.clone());
                let new = || self.positions[n].lane(format!("channel {n} {}", cell.cause));
                self.lanes.entry(key).or_insert_with(new).push(time_s, 1);
            }
        }
        if row.missing > 0 {
            let new = || {
                self.positions
                    .first()
                    .map(|s| s.lane("triggers without a row"))
            };
            self.missing = self.missing.take().or_else(new);
            if let Some(lane) = &mut self.missing {
                lane.push(time_s, row.missing);
            }
        }
        let position = |n: usize| row.cells.get(n).and_then(|c| c.position);
        if let Some(series) = &mut self.difference {
            let both = position(0).zip(position(1));
            series.push(time_s, both.map(|(one, other)| one - other));
        }
        for (series, value) in self.derived.iter_mut().zip(&row.derived) {
            series.push(time_s, *value);
        }
    }

    /// Whether the difference is drawn.
    pub fn has_difference(&self) -> bool {
        self.difference.is_some()
    }

    /// The drawing.
    pub fn svg(&self, title: &str, subtitle: &str) -> String {
        let velocities = self.velocities.iter().map(|v| &v.1);
        let all = (self.positions.iter())
            .chain(&self.difference)
            .chain(velocities)
            .chain(&self.derived);
        let series: Vec<Series> = all.cloned().collect();
        let mut lanes: Vec<Lane> = self.lanes.values().cloned().collect();
        lanes.extend(self.missing.clone());
        series_svg(&series, &lanes, title, subtitle)
    }
}

#[cfg(test)]
mod tests {
    use super::super::count::Judge;
    use super::*;

    /// Catches a curve that is drawn through rows that are in no file.
    #[test]
    fn a_pause_is_a_gap_between_files_only() {
        let drawn = |begins_file: bool| {
            let units = ["deg".to_owned()];
            let mut picture = Picture::new(&units, &[], Judge::default(), Extras::default());
            for n in 0..40 {
                let is_behind = n >= 20;
                picture.push(&Measurement {
                    begins_file: begins_file && n == 20,
                    trigger: Some(n),
                    time_s: n as f64 * 0.01 + if is_behind { 5.0 } else { 0.0 },
                    missing: 0,
                    fits: true,
                    cells: vec![Seen {
                        raw: None,
                        position: Some(1.0),
                        fresh: true,
                        cause: endat_host::causes::name(0).into(),
                    }],
                    derived: Vec::new(),
                });
            }
            picture.svg("", "")
        };
        assert_ne!(drawn(true), drawn(false));
    }
}
