//! Draws values over time, one panel for each series, and below them a lane for each kind of event.

use super::columns::{Columns, Extremes};
use super::svg::{text_width, Anchor, Svg};
use std::cmp::Ordering;
use std::collections::BTreeSet;

/// Values over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    values: Columns<Extremes>,
    bad_count: u64,
    last_s: Option<f64>,
}

impl Series {
    /// An empty series.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            ..Self::default()
        }
    }

    /// Adds a value, or a gap.
    pub fn push(&mut self, time_s: f64, value: Option<f64>) {
        self.values.at(time_s).take(time_s, value);
        self.last_s = Some(time_s);
    }

    /// Adds a gap before the next value.
    pub fn gap(&mut self) {
        if let Some(time_s) = self.last_s {
            self.values.at(time_s).take(time_s, None);
        }
    }

    /// Notes a missing value: marked at the bottom of the panel, never thinned out.
    pub fn mark(&mut self, time_s: f64) {
        self.values.at(time_s).bad += 1;
        self.bad_count += 1;
    }

    /// A lane below it, with the same times.
    pub fn lane(&self, name: impl Into<String>) -> Lane {
        Lane {
            name: name.into(),
            count: 0,
            times: self.values.like(),
        }
    }

    /// Minimum and maximum.
    fn range(&self) -> Option<(f64, f64)> {
        let all = self.values.iter().filter(|c| c.1.ends.is_some());
        range(all.flat_map(|c| [c.1.least, c.1.greatest]))
    }

    fn times(&self) -> impl Iterator<Item = f64> + '_ {
        let ends = self.values.iter().filter_map(|c| c.1.ends);
        let first = self.values.iter().next().map(|c| c.0);
        ends.flat_map(|e| e.map(|(time, _)| time))
            .chain(first)
            .chain(self.last_s)
    }

    /// Lines between gaps, as (seconds, value): each column from its first value over its extremes to its last.
    fn lines(&self) -> Vec<Vec<(f64, f64)>> {
        let mut lines = vec![Vec::new()];
        let mut is_broken = false;
        for (middle, column) in self.values.iter() {
            let [before, between, behind] = column.gaps;
            if let Some([first, last]) = column.ends {
                if is_broken || before {
                    lines.push(Vec::new());
                }
                let line = lines.last_mut().expect("a line exists");
                line.push(first);
                let is_flat = column.least == column.greatest;
                if !is_flat {
                    let (low, high) = ((middle, column.least), (middle, column.greatest));
                    match last.1 >= first.1 {
                        true => line.extend([low, high]),
                        false => line.extend([high, low]),
                    }
                }
                if between {
                    // Draw the column's content, and interrupt the line.
                    lines.push(Vec::new());
                }
                let line = lines.last_mut().expect("a line exists");
                line.push(last);
                is_broken = behind;
            } else {
                is_broken |= before;
            }
        }
        lines.retain(|line| !line.is_empty());
        lines
    }
}

/// Events over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lane {
    /// Name.
    pub name: String,
    /// Number of events.
    pub count: u64,
    times: Columns<u64>,
}

impl Lane {
    /// Adds `count` events.
    pub fn push(&mut self, time_s: f64, count: u64) {
        self.count += count;
        *self.times.at(time_s) += count;
    }
}

const STYLE: &str = "\
text{font-family:'DejaVu Sans',Verdana,Helvetica,sans-serif;fill:#1f2937}\
.title{font-size:19px;font-weight:bold}.sub{font-size:12.5px;fill:#4b5563}.name{font-size:13px;font-weight:bold}\
.tick{font-size:11px;fill:#374151}path{fill:none}.axis{stroke:#374151;stroke-width:1}.grid{stroke:#e5e7eb;stroke-width:0.8}\
.series-0{stroke:#0072b2;stroke-width:1.4}.series-1{stroke:#d55e00;stroke-width:1.4}.series-2{stroke:#009e73;stroke-width:1.4}\
.series-3{stroke:#cc79a7;stroke-width:1.4}.bad{stroke:#b91c1c;stroke-width:1}.lane{fill:#b91c1c}.floor{fill:#f3f4f6}";

const LEFT: f64 = 110.0;
const TOP: f64 = 92.0;
const WIDTH: f64 = 820.0;
const HEIGHT: f64 = 170.0;
const GAP: f64 = 54.0;
const COLOURS: usize = 4;
/// Height of a mark.
const MARK: f64 = 9.0;
/// Height of a lane, and distance between lanes.
const LANE: f64 = 12.0;
const LANE_PITCH: f64 = 20.0;
/// Widest mark in a lane.
const LANE_MARK_MAX: f64 = 6.0;
/// Width of a single value.
const DOT: f64 = 1.0;
/// Space above and below the values: part of their range.
const HEADROOM: f64 = 0.08;

/// Minimum and maximum of some numbers, widened slightly if they are equal.
fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    match low.total_cmp(&high) {
        Ordering::Less => Some((low, high)),
        Ordering::Equal => Some((low - 0.5, high + 0.5)),
        Ordering::Greater => None,
    }
}

/// Steps of 1, 2 or 5 times a power of ten, about five of them.
pub(super) fn ticks(low: f64, high: f64) -> (Vec<f64>, usize) {
    let rough = (high - low) / 5.0;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|m| m * power)
        .into_iter()
        .find(|s| *s >= rough)
        .unwrap_or(power);
    let digits = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    ((first..=last).map(|n| n as f64 * step).collect(), digits)
}

/// Draws a panel whose top is at `top`.
fn panel(svg: &mut Svg, one: &Series, index: usize, top: f64, x: &dyn Fn(f64) -> f64) {
    let bottom = top + HEIGHT;
    let mut label = format!("{} ({})", one.name, one.unit);
    if one.bad_count > 0 {
        label += &format!(": {} bad, marked at the foot", one.bad_count);
    }
    let values = one.range();
    if values.is_none() {
        label += "; no value";
    }
    svg.text(LEFT, top - 9.0, Anchor::Start, "name", &label);
    let has_values = values.is_some();
    let (low, high) = values.unwrap_or((0.0, 1.0));
    let room = (high - low) * HEADROOM;
    let (low, high) = (low - room, high + room);
    let y = |value: f64| bottom - HEIGHT * (value - low) / (high - low);
    let (values, digits) = ticks(low, high);
    // No axis without values.
    for value in values.into_iter().filter(|_| has_values) {
        svg.line(&[(LEFT, y(value)), (LEFT + WIDTH, y(value))], "grid");
        let text = format!("{value:.digits$}");
        svg.text(
            LEFT - 8.0 - text_width(&text, 11.0),
            y(value) + 4.0,
            Anchor::Start,
            "tick",
            &text,
        );
    }
    let class = format!("series-{}", index % COLOURS);
    for line in one.lines() {
        let mut points: Vec<(f64, f64)> = line.iter().map(|(t, v)| (x(*t), y(*v))).collect();
        points
            .dedup_by_key(|p| (10.0 * p.0).round() as i64 * 100_000 + (10.0 * p.1).round() as i64);
        if let [only] = points[..] {
            points = vec![(only.0 - DOT / 2.0, only.1), (only.0 + DOT / 2.0, only.1)];
        }
        svg.line(&points, &class);
    }
    // At most one mark for each pixel.
    let marks = one.values.iter().filter(|c| c.1.bad > 0);
    let marks: BTreeSet<i64> = marks.map(|c| x(c.0).round() as i64).collect();
    for x in marks.into_iter().map(|x| x as f64) {
        svg.line(&[(x, bottom), (x, bottom - MARK)], "bad");
    }
    svg.line(
        &[(LEFT, top), (LEFT, bottom), (LEFT + WIDTH, bottom)],
        "axis",
    );
}

/// Series and lanes as SVG.
pub fn series_svg(series: &[Series], lanes: &[Lane], title: &str, subtitle: &str) -> String {
    let mut svg = Svg::new();
    let head = svg.head(title, subtitle);
    let (begin, end) = range(series.iter().flat_map(Series::times)).unwrap_or((0.0, 1.0));
    let x = |time: f64| LEFT + WIDTH * ((time - begin) / (end - begin)).clamp(0.0, 1.0);
    let mut top = TOP;
    for (index, one) in series.iter().enumerate() {
        panel(&mut svg, one, index, top, &x);
        top += HEIGHT + GAP;
    }
    let mut bottom = top - GAP;
    if !lanes.is_empty() {
        bottom += GAP - LANE_PITCH;
    }
    let mut right = LEFT + WIDTH;
    // As wide as its row, and visible.
    let row_s = series.iter().map(|s| s.values.row_s()).fold(0.0, f64::max);
    let width = (WIDTH * row_s / (end - begin)).clamp(1.0, LANE_MARK_MAX);
    for lane in lanes {
        svg.rect(LEFT, bottom, WIDTH, LANE, "floor");
        let mut marks: Vec<(f64, f64)> = Vec::new();
        for (time, _) in lane.times.iter().filter(|c| *c.1 > 0) {
            let from = x(time) - width / 2.0;
            match marks.last_mut() {
                // A continuous event is one mark.
                Some(last) if from <= last.1 + width / 2.0 => last.1 = from + width,
                _ => marks.push((from, from + width)),
            }
        }
        for (from, to) in marks {
            svg.rect(from, bottom, to - from, LANE, "lane");
        }
        let text = format!("{}: {}", lane.name, lane.count);
        let place = LEFT + WIDTH + 8.0;
        svg.text(place, bottom + LANE - 2.0, Anchor::Start, "tick", &text);
        right = right.max(place + text_width(&text, 11.0));
        bottom += LANE_PITCH;
    }
    let (values, digits) = ticks(begin, end);
    for time in values {
        svg.line(&[(x(time), bottom), (x(time), bottom + 5.0)], "axis");
        svg.text(
            x(time),
            bottom + 18.0,
            Anchor::Middle,
            "tick",
            &format!("{time:.digits$}"),
        );
    }
    svg.text(
        LEFT + WIDTH / 2.0,
        bottom + 38.0,
        Anchor::Middle,
        "name",
        "time (s)",
    );
    svg.finish((right + 30.0).max(head + 24.0), bottom + 54.0, title, STYLE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(points: impl IntoIterator<Item = (f64, Option<f64>)>) -> Series {
        let mut one = Series::new("channel 0", "deg");
        for (time, value) in points {
            one.push(time, value);
        }
        one
    }

    fn drawn(one: &Series) -> String {
        series_svg(std::slice::from_ref(one), &[], "log", "")
    }

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        assert_eq!(
            ticks(0.0, 1.0),
            (vec![0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0], 1)
        );
        assert_eq!(ticks(36.0, 126.0).0, [40.0, 60.0, 80.0, 100.0, 120.0]);
        assert_eq!(range([3.0].into_iter()), Some((2.5, 3.5)));
        assert_eq!(range(std::iter::empty()), None);
    }

    /// Catches an axis for a series without values.
    #[test]
    fn a_series_without_values_has_no_axis_of_them() {
        let mut one = of([(2.0, None), (3.0, None)]);
        one.mark(2.0);
        one.mark(3.0);
        let svg = drawn(&one);
        assert!(svg.contains("channel 0 (deg): 2 bad, marked at the foot; no value"));
        assert_eq!(svg.matches("class=\"grid\"").count(), 0);
        assert!(drawn(&of([(2.0, Some(0.0)), (3.0, None)])).contains("class=\"grid\""));
    }

    #[test]
    fn a_gap_stays_a_gap_and_long_series_are_thinned_out() {
        let point = |n: usize| (n as f64, (n != 2).then_some(n as f64));
        let one = of((0..5).map(point));
        let svg = drawn(&one);
        assert_eq!(svg.matches("class=\"series-0\"").count(), 2);
        // Missing rows, too.
        let mut pause = of((0..5).map(|n| (f64::from(n), Some(1.0))));
        pause.gap();
        pause.push(900.0, Some(1.0));
        assert_eq!(drawn(&pause).matches("class=\"series-0\"").count(), 2);
        // Nothing is drawn on the frame.
        let tops = svg.lines().filter(|l| l.contains("class=\"series-0\""));
        let tops = tops.flat_map(|l| l.split('"').nth(3).unwrap().split(" L"));
        let tops = tops.map(|p| p.split(' ').nth(1).unwrap().parse().unwrap());
        let (high, low) = range(tops).unwrap();
        assert!(
            high > TOP + 5.0 && low < TOP + HEIGHT - MARK,
            "{high} {low}"
        );
        let mut long = of((0..100_000).map(|n| (f64::from(n), Some(0.0))));
        assert!(drawn(&long).len() < 60_000);
        // Rare marks are visible, and cost no more than the columns.
        long.mark(12_345.0);
        let svg = drawn(&long);
        assert_eq!(svg.matches("class=\"bad\"").count(), 1);
        assert!(svg.contains("channel 0 (deg): 1 bad"));
        (0..100_000).for_each(|n| long.mark(f64::from(n)));
        assert!(drawn(&long).matches("class=\"bad\"").count() <= 821);
    }

    /// Catches a peak that is thinned out, and a lane without a single event.
    #[test]
    fn a_peak_and_a_single_fault_of_a_hundred_thousand_are_drawn() {
        let value = |n: u32| if n == 54_321 { 10.0 } else { 0.0 };
        let one = of((0..100_000).map(|n| (f64::from(n), Some(value(n)))));
        let mut lane = one.lane("channel 0 crc");
        lane.push(54_321.0, 1);
        let svg = series_svg(&[one], &[lane], "log", "");
        let line = svg
            .lines()
            .find(|l| l.contains("class=\"series-0\""))
            .unwrap();
        let tops = line.split('"').nth(3).unwrap().split(" L");
        let tops = tops.map(|p| p.split(' ').nth(1).unwrap().parse::<f64>().unwrap());
        assert_eq!(tops.filter(|y| *y < TOP + 20.0).count(), 1);
        assert_eq!(svg.matches("class=\"lane\"").count(), 1);
        assert!(svg.contains("channel 0 crc: 1"));
    }
}
