//! Figures of a recording, in one pass and constant memory.

use super::count::Tally;
use super::histogram::Histogram;
use super::picture::Measurement;
use super::read::Head;

/// What a column of numbers has shown.
#[derive(Clone, Debug)]
pub struct Track {
    /// What it is, and its unit.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Values.
    pub count: u64,
    /// Least and greatest.
    pub range: Option<(f64, f64)>,
    /// First and last.
    pub ends: Option<(f64, f64)>,
    line: Line,
    window: Vec<(f64, f64)>,
    window_rows: usize,
    squares: f64,
    in_windows: u64,
    windows: u64,
    worst: f64,
    /// The range is known, so values are counted on.
    is_counted: bool,
    /// Distances from the parabola of each window.
    pub histogram: Histogram,
}

/// A straight line through what has come, least squares.
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    count: f64,
    mean_t: f64,
    mean_x: f64,
    tt: f64,
    tx: f64,
}

impl Line {
    fn push(&mut self, t: f64, x: f64) {
        self.count += 1.0;
        let (dt, dx) = (t - self.mean_t, x - self.mean_x);
        self.mean_t += dt / self.count;
        self.mean_x += dx / self.count;
        self.tt += dt * (t - self.mean_t);
        self.tx += dt * (x - self.mean_x);
    }

    fn slope(&self) -> Option<f64> {
        (self.tt > 0.0).then(|| self.tx / self.tt)
    }
}

/// Values that a parabola takes away.
const PARABOLA_PARAMETERS: f64 = 3.0;

/// Leaves of values what is left without the parabola that is nearest to them: position, speed and acceleration are no noise. The times are
/// changed, too.
fn leave_rest_of_parabola(points: &mut [(f64, f64)]) {
    let count = points.len() as f64;
    let middle = points.iter().map(|p| p.0).sum::<f64>() / count;
    let first = points.first().map_or(0.0, |p| p.1);
    let reach = points.iter().map(|p| (p.0 - middle).abs());
    let reach = Some(reach.fold(0.0, f64::max)).filter(|r| *r > 0.0);
    let scale = reach.map_or(1.0, |r| 1.0 / r);
    let mean = points.iter().map(|p| p.1 - first).sum::<f64>() / count;
    for (t, x) in points.iter_mut() {
        *t = (*t - middle) * scale;
        *x -= first + mean;
    }
    // The slope, and then the square: upright to those before it, so that each can be taken away alone.
    let [mut square, mut cube, mut product] = [0.0; 3];
    for (t, x) in points.iter() {
        square += t * t;
        cube += t * t * t;
        product += t * x;
    }
    if square == 0.0 {
        return;
    }
    let (slope, even, odd) = (product / square, square / count, cube / square);
    let bend = |t: f64| t * t - even - odd * t;
    let [mut size, mut product] = [0.0; 2];
    for (t, x) in points.iter_mut() {
        *x -= slope * *t;
        let bend = bend(*t);
        size += bend * bend;
        product += bend * *x;
    }
    if size > 0.0 {
        let part = product / size;
        points.iter_mut().for_each(|(t, x)| *x -= part * bend(*t));
    }
}

impl Track {
    fn new(name: String, unit: String, window_rows: usize, step: Option<f64>) -> Self {
        Self {
            name,
            unit,
            count: 0,
            range: None,
            ends: None,
            line: Line::default(),
            window: Vec::new(),
            window_rows,
            squares: 0.0,
            in_windows: 0,
            windows: 0,
            worst: 0.0,
            is_counted: true,
            histogram: step.map_or_else(Histogram::default, Histogram::of_width),
        }
    }

    fn push(&mut self, time_s: f64, value: Option<f64>) {
        let Some(value) = value else {
            // A parabola does not lead over a gap.
            self.window.clear();
            return;
        };
        self.count += 1;
        let (low, high) = self.range.unwrap_or((value, value));
        self.range = Some((low.min(value), high.max(value)));
        self.ends = Some((self.ends.map_or(value, |e| e.0), value));
        if !self.is_counted {
            return;
        }
        self.line.push(time_s, value);
        self.window.push((time_s, value));
        if self.window.len() == self.window_rows {
            self.end_window();
        }
    }

    fn end_window(&mut self) {
        leave_rest_of_parabola(&mut self.window);
        let count = self.window.len() as f64;
        let mut squares = 0.0;
        for (_, x) in self.window.drain(..) {
            squares += x * x;
            self.histogram.push(x);
        }
        self.squares += squares;
        self.in_windows += count as u64;
        self.windows += 1;
        let deviation = (squares / (count - PARABOLA_PARAMETERS)).sqrt();
        self.worst = self.worst.max(deviation);
    }

    /// Standard deviation about the parabolas of windows: of all, and of the worst window. None without a whole window.
    pub fn noise(&self) -> Option<(f64, f64)> {
        let free = self.in_windows as f64 - PARABOLA_PARAMETERS * self.windows as f64;
        (free > 0.0).then(|| ((self.squares / free).sqrt(), self.worst))
    }

    /// Slope of the straight line through all, per second.
    pub fn drift_per_s(&self) -> Option<f64> {
        self.line.slope()
    }
}

/// A channel.
#[derive(Clone, Debug)]
pub struct ChannelStats {
    /// Its positions, counted on.
    pub track: Track,
    /// Rows by what became of them.
    pub tally: Tally,
    /// One measuring step in its unit, if the file says so.
    pub step: Option<f64>,
    /// The reason why drift and noise are missing, and the remedy.
    pub unknown: Option<String>,
}

/// All figures.
#[derive(Clone, Debug)]
pub struct Stats {
    /// Rows.
    pub rows: u64,
    /// Triggers without a row.
    pub missing: u64,
    /// How many times rows were missing.
    pub gaps: u64,
    /// Rows in which a channel is bad.
    pub bad_rows: u64,
    /// Times of the first and the last row.
    pub times_s: Option<(f64, f64)>,
    /// How many came behind the first one, and the last one.
    triggers: Option<(u64, u64)>,
    /// Channels.
    pub channels: Vec<ChannelStats>,
    /// Calculated columns.
    pub derived: Vec<Track>,
    judge: super::count::Judge,
}

impl Stats {
    /// Of a recording that begins so; noise is that of windows of so many rows.
    pub fn new(head: &Head, window_rows: usize) -> Self {
        let channels = head.units.iter().enumerate().map(|(n, unit)| {
            let step = head.scale(n).map(|scale| scale.step());
            let unknown = head.unknown(n);
            let track = Track::new(format!("channel {n}"), unit.clone(), window_rows, step);
            ChannelStats {
                track: Track {
                    is_counted: unknown.is_none(),
                    ..track
                },
                tally: Tally::default(),
                step,
                unknown,
            }
        });
        let derived = head.derived.iter();
        Self {
            rows: 0,
            missing: 0,
            gaps: 0,
            bad_rows: 0,
            times_s: None,
            triggers: None,
            channels: channels.collect(),
            derived: derived
                .map(|d| Track::new(d.name.clone(), d.unit.clone(), window_rows, None))
                .collect(),
            judge: head.judge(),
        }
    }

    /// Takes a row.
    pub fn push(&mut self, row: &Measurement) {
        self.rows += 1;
        // What a row says of its place is not taken where that does not fit.
        let missing = if row.fits { row.missing } else { 0 };
        self.missing += missing;
        self.gaps += u64::from(missing > 0);
        let first = self.times_s.map_or(row.time_s, |t| t.0);
        self.times_s = Some((first, row.time_s));
        if let Some(trigger) = row.trigger.filter(|_| row.fits) {
            // A recording that was gone on with may count from the beginning again.
            let steps = |(count, last): (u64, u64)| {
                count.saturating_add(trigger.checked_sub(last).unwrap_or(1))
            };
            self.triggers = Some((self.triggers.map_or(0, steps), trigger));
        }
        if row.begins_file {
            // What came between the files is in none of them.
            let channels = self.channels.iter_mut().map(|channel| &mut channel.track);
            let tracks = channels.chain(&mut self.derived);
            tracks.for_each(|track| track.window.clear());
        }
        let none = endat_host::causes::name(0);
        let mut is_bad = false;
        for (channel, cell) in self.channels.iter_mut().zip(&row.cells) {
            // Beside a running clock's position the other channels have nothing to do.
            if row.trigger.is_none() && !cell.fresh && cell.cause == none {
                continue;
            }
            channel.track.push(row.time_s, cell.position);
            is_bad |= channel.tally.note(self.judge, cell.fresh, &cell.cause);
        }
        self.bad_rows += u64::from(is_bad);
        for (track, value) in self.derived.iter_mut().zip(&row.derived) {
            track.push(row.time_s, *value);
        }
    }

    /// From the first row to the last.
    pub fn duration_s(&self) -> f64 {
        self.times_s.map_or(0.0, |(first, last)| last - first)
    }

    /// Triggers per second of the card's time, and rows. None of a single row.
    pub fn rates_hz(&self) -> Option<(Option<f64>, f64)> {
        let span_s = Some(self.duration_s()).filter(|s| *s > 0.0)?;
        let triggers = self.triggers.map(|(count, _)| count);
        let rows = (self.rows - 1) as f64 / span_s;
        Some((triggers.map(|n| n as f64 / span_s), rows))
    }
}

#[cfg(test)]
mod tests {
    use super::super::picture::Seen;
    use super::*;

    fn stats(positions: impl Iterator<Item = Option<f64>>) -> Stats {
        in_two_files(positions, 0)
    }

    /// The second one begins with this row.
    fn in_two_files(positions: impl Iterator<Item = Option<f64>>, second: u64) -> Stats {
        let head = Head {
            units: vec!["deg".into()],
            ..Head::default()
        };
        let mut all = Stats::new(&head, 100);
        for (n, position) in positions.enumerate() {
            all.push(&Measurement {
                begins_file: n == 0 || n as u64 == second,
                trigger: Some(n as u64 + 7),
                time_s: n as f64 * 0.01,
                missing: 0,
                fits: true,
                cells: vec![Seen {
                    raw: None,
                    position,
                    fresh: position.is_some(),
                    cause: if position.is_some() { "none" } else { "crc" }.into(),
                }],
                derived: Vec::new(),
            });
        }
        all
    }

    /// Catches noise that has the movement in it, and a drift that is that of noise.
    #[test]
    fn noise_is_about_a_parabola_and_drift_is_the_slope() {
        let noise = |n: u32| if n & 1 == 0 { 0.01 } else { -0.01 };
        let all = stats((0..10_000).map(|n| {
            Some(5.0 + 0.03 * f64::from(n) + 3e-7 * f64::from(n) * f64::from(n) + noise(n))
        }));
        let track = &all.channels[0].track;
        let (deviation, worst) = track.noise().unwrap();
        assert!(
            (deviation - 0.01).abs() < 0.001 && (worst - 0.01).abs() < 0.001,
            "{deviation} {worst}"
        );
        assert!((track.drift_per_s().unwrap() - 3.3).abs() < 1e-3);
        let (triggers, rows) = all.rates_hz().unwrap();
        assert!((triggers.unwrap() - 100.0).abs() < 1e-9 && (rows - 100.0).abs() < 1e-9);
        assert_eq!(
            track.histogram.bins().iter().map(|b| b.1).sum::<u64>(),
            10_000
        );
    }

    /// Catches noise that is the way from one file to the next.
    #[test]
    fn no_window_leads_from_one_file_to_the_next() {
        let position = |n: u64| Some(if n < 1_550 { 0.0 } else { 10.0 });
        let all = in_two_files((0..3_000).map(position), 1_550);
        let worst = all.channels[0].track.noise().unwrap().1;
        assert!(worst < 1e-9, "{worst}");
    }

    #[test]
    fn faults_are_counted_and_no_window_leads_over_them() {
        // A step at each fault: noise of a window that has one in it.
        let position = |n: u64| (!n.is_multiple_of(150)).then_some((n / 150) as f64 * 10.0);
        let all = stats((0..3_000).map(position));
        assert_eq!((all.bad_rows, all.channels[0].tally.bad["crc"]), (20, 20));
        let worst = all.channels[0].track.noise().unwrap().1;
        assert!(worst < 1e-9, "{worst}");
    }
}
