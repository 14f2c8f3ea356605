//! Draws numbers over time, one panel for each series.

use super::svg::{text_width, Anchor, Svg};
use std::cmp::Ordering;
use std::collections::BTreeSet;

/// Numbers over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// What they are.
    pub name: String,
    /// Their unit.
    pub unit: String,
    /// Seconds and value; a gap where there was none.
    pub points: Vec<(f64, Option<f64>)>,
    /// The value that is 0 again, as 360 degrees are; none if there is none. A step over it is no line.
    pub wraps_at: Option<f64>,
    /// Seconds at which there should have been one: marked at the foot of the panel, never thinned out.
    pub bad: Vec<f64>,
}

impl Series {
    /// Whether the shorter way from one value to the next is over the wrap.
    fn is_wrapped(&self, before: Option<f64>, value: Option<f64>) -> bool {
        match (before, value, self.wraps_at) {
            (Some(a), Some(b), Some(turn)) => (b - a).abs() > turn / 2.0,
            _ => false,
        }
    }
}

const STYLE: &str = "\
text{font-family:'DejaVu Sans',Verdana,Helvetica,sans-serif;fill:#1f2937}\
.title{font-size:19px;font-weight:bold}.sub{font-size:12.5px;fill:#4b5563}.name{font-size:13px;font-weight:bold}\
.tick{font-size:11px;fill:#374151}path{fill:none}.axis{stroke:#374151;stroke-width:1}.grid{stroke:#e5e7eb;stroke-width:0.8}\
.series-0{stroke:#0072b2;stroke-width:1.4}.series-1{stroke:#d55e00;stroke-width:1.4}.series-2{stroke:#009e73;stroke-width:1.4}\
.series-3{stroke:#cc79a7;stroke-width:1.4}.bad{stroke:#b91c1c;stroke-width:1}";

const LEFT: f64 = 110.0;
const TOP: f64 = 92.0;
const WIDTH: f64 = 820.0;
const HEIGHT: f64 = 170.0;
const GAP: f64 = 54.0;
/// Columns of the drawing: more points than that are thinned out.
const POINTS_MAX: usize = 1640;
const COLOURS: usize = 4;
/// Height of a mark.
const MARK: f64 = 9.0;
/// Room above and below the values: part of their range.
const HEADROOM: f64 = 0.08;

/// Lowest and highest of some numbers; a little apart if they are all the same.
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

/// Steps of 1, 2 or 5 times a power of ten, some five of them.
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

/// The series as SVG.
pub fn series_svg(series: &[Series], title: &str, subtitle: &str) -> String {
    let mut svg = Svg::new();
    let head = svg.head(title, subtitle);
    let times = series.iter().flat_map(|s| s.points.iter().map(|p| p.0));
    let (begin, end) = range(times).unwrap_or((0.0, 1.0));
    let x = |time: f64| LEFT + WIDTH * (time - begin) / (end - begin);
    let mut top = TOP;
    for (index, one) in series.iter().enumerate() {
        let bottom = top + HEIGHT;
        let mut label = format!("{} ({})", one.name, one.unit);
        if !one.bad.is_empty() {
            label += &format!(": {} bad, marked at the foot", one.bad.len());
        }
        let values = range(one.points.iter().filter_map(|p| p.1));
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
        // Nothing has an axis where there is nothing.
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
        let every = one.points.len().div_ceil(POINTS_MAX).max(1);
        let mut line = Vec::new();
        let class = format!("series-{}", index % COLOURS);
        let mut before = None;
        for (time, value) in one.points.iter().step_by(every) {
            if value.is_none() || one.is_wrapped(before, *value) {
                svg.line(&line, &class);
                line.clear();
            }
            line.extend(value.map(|value| (x(*time), y(value))));
            before = *value;
        }
        svg.line(&line, &class);
        // One mark for each column, however many fall on it.
        let columns = one.bad.iter().map(|time| x(*time).round() as i64);
        for column in columns.collect::<BTreeSet<_>>() {
            let x = column as f64;
            svg.line(&[(x, bottom), (x, bottom - MARK)], "bad");
        }
        svg.line(
            &[(LEFT, top), (LEFT, bottom), (LEFT + WIDTH, bottom)],
            "axis",
        );
        top = bottom + GAP;
    }
    let bottom = top - GAP;
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
    svg.finish(
        (LEFT + WIDTH + 30.0).max(head + 24.0),
        bottom + 54.0,
        title,
        STYLE,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// Catches an axis of numbers that nobody has measured.
    #[test]
    fn a_series_without_values_has_no_axis_of_them() {
        let one = Series {
            name: "channel 0".into(),
            unit: "deg".into(),
            points: vec![(2.0, None), (3.0, None)],
            bad: vec![2.0, 3.0],
            ..Series::default()
        };
        let svg = series_svg(std::slice::from_ref(&one), "log", "");
        assert!(svg.contains("channel 0 (deg): 2 bad, marked at the foot; no value"));
        assert_eq!(svg.matches("class=\"grid\"").count(), 0);
        let with = Series {
            points: vec![(2.0, Some(0.0)), (3.0, None)],
            ..one
        };
        assert!(series_svg(&[with], "log", "").contains("class=\"grid\""));
    }

    #[test]
    fn a_gap_stays_a_gap_and_long_series_are_thinned_out() {
        let point = |n: usize| (n as f64, (n != 2).then_some(n as f64));
        let one = Series {
            name: "channel 0".into(),
            unit: "deg".into(),
            points: (0..5).map(point).collect(),
            ..Series::default()
        };
        let svg = series_svg(std::slice::from_ref(&one), "log", "");
        assert_eq!(svg.matches("class=\"series-0\"").count(), 2);
        let turning = Series {
            points: [350.0, 355.0, 1.0, 6.0, 359.0]
                .iter()
                .enumerate()
                .map(|(n, v)| (n as f64, Some(*v)))
                .collect(),
            wraps_at: Some(360.0),
            ..one.clone()
        };
        let svg = series_svg(std::slice::from_ref(&turning), "log", "");
        assert_eq!(svg.matches("class=\"series-0\"").count(), 3);
        // Nothing stands on the frame.
        let tops = svg.lines().filter(|l| l.contains("class=\"series-0\""));
        let tops = tops.flat_map(|l| l.split('"').nth(3).unwrap().split(" L"));
        let tops = tops.map(|p| p.split(' ').nth(1).unwrap().parse().unwrap());
        let (high, low) = range(tops).unwrap();
        assert!(
            high > TOP + 5.0 && low < TOP + HEIGHT - MARK,
            "{high} {low}"
        );
        let long = Series {
            points: (0..100_000).map(|n| (n as f64, Some(0.0))).collect(),
            ..one
        };
        assert!(series_svg(std::slice::from_ref(&long), "log", "").len() < 60_000);
        // Bad ones are seen however rare they are, and cost no more than the columns.
        let rare = Series {
            bad: vec![12_345.0],
            ..long.clone()
        };
        let svg = series_svg(&[rare], "log", "");
        assert_eq!(svg.matches("class=\"bad\"").count(), 1);
        assert!(svg.contains("channel 0 (deg): 1 bad"));
        let all = Series {
            bad: (0..100_000).map(f64::from).collect(),
            ..long
        };
        let svg = series_svg(&[all], "log", "");
        assert!(svg.matches("class=\"bad\"").count() <= 821);
    }
}
