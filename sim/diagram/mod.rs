//! Draws a recorded frame as a timing diagram.
//!
//! CLOCK with its rising edges counted, DATA coloured by driver and divided into its fields, the important times, and an axis in
//! microseconds. Long quiet spans are shortened and marked. If the cable is long, both ends are drawn.

mod groups;
mod map;
mod overview;
mod rows;
mod scale;
#[cfg(test)]
mod tests;
mod times;

use crate::{
    bench::Link,
    encoder::FrameLog,
    line::End,
    segments::{data_segments, first_falls, By, Level, Meaning, Segment},
    Time, US,
};
pub use map::map_svg;
pub use overview::overview_svg;

use endat_draw::{text_width, Anchor, Svg};
use groups::{bit_name, fill, groups, is_wrong, segment_fill, stroke};
use scale::Scale;
use std::ops::Range;

const STYLE: &str = "\
text{font-family:'DejaVu Sans',Verdana,Helvetica,sans-serif;fill:#1f2937}\
.title{font-size:19px;font-weight:bold}.sub{font-size:12.5px;fill:#4b5563}.name{font-size:13px;font-weight:bold}\
.end{font-size:10.5px;fill:#6b7280}.bit{font-size:9px;fill:#374151}.count{font-size:8.5px;fill:#9ca3af}\
.mark{font-size:9.5px;font-weight:bold;fill:#111827}.field{font-size:11px;fill:#111827}.tick{font-size:10.5px;fill:#4b5563}\
.dim{font-size:11px;fill:#7c2d12}.legend{font-size:11.5px;fill:#374151}\
path{fill:none}.clock{stroke:#111827;stroke-width:1.4}.grid{stroke:#e5e7eb;stroke-width:0.8}\
.receiver{stroke:#1d4ed8;stroke-width:1.8}.encoder{stroke:#b45309;stroke-width:1.8}.nobody{stroke:#9ca3af;stroke-width:1.4;stroke-dasharray:4 3}\
.both,.glitch{stroke:#dc2626;stroke-width:2.2}.axis{stroke:#6b7280;stroke-width:1}.dimline{stroke:#c2410c;stroke-width:1}\
.bracket{stroke:#9ca3af;stroke-width:1}.cell{stroke:#ffffff;stroke-width:1.2}.gap{fill:#ffffff;stroke:none}.gapline{stroke:#9ca3af;stroke-width:1.1}\
.f-receiver{fill:#dbeafe}.f-encoder{fill:#fef3c7}.f-nobody{fill:#f3f4f6}.f-both{fill:#fecaca}.f-start{fill:#fcd34d}.f-crc{fill:#fde68a}.f-wrong{fill:#f87171}\
.f-idle{fill:#fffbeb}.f-address{fill:#fdba74}.f-data{fill:#ffedd5}.f-info{fill:#dfb8d3}\
.f-sent-zero{fill:#eff6ff}.f-sent-start{fill:#60a5fa}.f-sent-address{fill:#93c5fd}.f-sent-data{fill:#bfdbfe}";

/// Space between rows.
const ROW_GAP: f64 = 26.0;
/// Horizontal position of the first time.
const LEFT: f64 = 118.0;
const RIGHT: f64 = 40.0;
const PERIOD_PIXELS: f64 = 27.0;
const CLOCK_HEIGHT: f64 = 24.0;
const DATA_HEIGHT: f64 = 34.0;
/// A quiet span is shortened to this many clock periods.
const QUIET_PERIODS: Time = 4;
/// Both ends of a long wait are drawn to this length; the middle is shortened.
const WAIT_PERIODS: Time = 6;
const LONG_PERIODS: Time = 32;
/// Both ends are drawn if the delay of cable and transceivers exceeds this part of a period.
const BOTH_ENDS_PART: Time = 3;

/// Frame number `index` (0 = first) of a link as SVG; `None` if it was not recorded.
pub fn frame_svg(link: &Link, index: usize, title: &str) -> Option<String> {
    let frame = link.encoder().frames().get(index)?;
    Some(Diagram::new(link, frame)?.draw(title))
}

/// The part of a wait that is shortened while the clock continues, until the end of the wait or `last_edge`.
fn long_wait(s: &Segment, last_edge: Time, period: Time) -> Option<(Time, Time)> {
    let until = s.until.min(last_edge).saturating_sub(WAIT_PERIODS * period);
    let from = s.from + WAIT_PERIODS * period;
    (s.meaning == Meaning::Wait && until > from + LONG_PERIODS * period).then_some((from, until))
}

/// One row of the drawing.
enum Row {
    Clock(End),
    Data(End),
}

struct Diagram<'a> {
    link: &'a Link,
    frame: &'a FrameLog,
    scale: Scale,
    /// First falling clock edge at the receiver: zero of the axis.
    zero: Time,
    begin: Time,
    rows: Vec<Range<Time>>,
    /// The current row, and its start on a page without rows.
    row: Range<Time>,
    shift: f64,
    segments: Vec<Segment>,
    far_segments: Vec<Segment>,
    both_ends: bool,
    svg: Svg,
}

impl<'a> Diagram<'a> {
    fn new(link: &'a Link, frame: &'a FrameLog) -> Option<Self> {
        let trace = link.trace()?;
        let zero = *first_falls(&trace.clock_at_receiver)
            .iter()
            .rfind(|t| **t <= frame.first_fall)?;
        let period = if frame.period > 0 { frame.period } else { US };
        let last = frame.data_fall.unwrap_or(frame.last_rise);
        let trip = (link.line().config().round_trip() / 2).max(frame.first_fall - zero);
        let begin = zero.saturating_sub(2 * period);
        let end = last + trip + 3 * period;
        let inside = |s: &Segment| s.until > begin && s.from < end;
        let cut = |end_of_line| -> Vec<Segment> {
            let all = data_segments(link, end_of_line, end);
            all.into_iter().filter(inside).collect()
        };
        let (segments, far_segments) = (cut(End::Receiver), cut(End::Encoder));
        let both_ends = trip * BOTH_ENDS_PART > period;
        let waits: Vec<(Time, Time)> = segments
            .iter()
            .filter_map(|s| long_wait(s, frame.last_rise, period))
            .collect();
        let is_shown = |t: &Time| waits.iter().all(|w| *t <= w.0 || w.1 <= *t);
        let clocks = [&trace.clock_at_receiver, &trace.clock_at_encoder];
        let edges = clocks.iter().flat_map(|c| c.iter().map(|e| e.0));
        let cuts = segments.iter().chain(&far_segments).map(|s| s.from);
        let ends = waits.iter().flat_map(|w| [w.0, w.1]);
        let events = edges.filter(is_shown).chain(cuts).chain(ends);
        let events = events.filter(|t| (begin..=end).contains(t));
        let events = events.chain([begin, end]).collect();
        let scale = Scale::new(events, LEFT, period, PERIOD_PIXELS, QUIET_PERIODS * period);
        let cells: Vec<Time> = segments.iter().map(|s| s.from).collect();
        Some(Self {
            rows: rows::cut(&scale, &cells, begin, end),
            row: begin..end,
            shift: 0.0,
            scale,
            link,
            frame,
            zero,
            begin,
            segments,
            far_segments,
            both_ends,
            svg: Svg::new(),
        })
    }

    fn draw(mut self, title: &str) -> String {
        let subtitle = self.subtitle();
        let mut right = self.svg.head(title, &subtitle).max(self.legend(24.0, 78.0));
        let mut y = 112.0;
        for row in self.rows.clone() {
            self.begin_row(&row);
            y = self.draw_row(y) + ROW_GAP;
            right = right.max(self.x(row.end));
        }
        let height = y - ROW_GAP + 16.0;
        self.svg.finish(right + RIGHT, height, title, STYLE)
    }

    /// CLOCK, DATA, axis and times of a row; returns its height.
    fn draw_row(&mut self, mut y: f64) -> f64 {
        let tracks = match self.both_ends {
            false => vec![Row::Clock(End::Receiver), Row::Data(End::Receiver)],
            true => vec![
                Row::Clock(End::Receiver),
                Row::Clock(End::Encoder),
                Row::Data(End::Encoder),
                Row::Data(End::Receiver),
            ],
        };
        for track in &tracks {
            match track {
                Row::Clock(end) => {
                    self.clock_row(*end, y + 12.0);
                    self.break_marks(y + 7.0, y + 17.0 + CLOCK_HEIGHT);
                    y += CLOCK_HEIGHT + 32.0;
                }
                Row::Data(end) => {
                    self.field_brackets(*end, y);
                    self.data_row(*end, y + 22.0);
                    self.break_marks(y + 20.0, y + 24.0 + DATA_HEIGHT);
                    y += DATA_HEIGHT + 42.0;
                }
            }
        }
        self.axis(y);
        self.break_marks(y - 5.0, y + 5.0);
        self.dimensions(y + 44.0)
    }

    fn subtitle(&self) -> String {
        let f = self.frame;
        let config = self.link.line().config();
        let answer = match f.start_edge {
            Some(s) => format!(
                "{} answer bits from rising edge {s} on, {} rising edges in all",
                f.answer.len, f.rising_edges
            ),
            None => format!("no answer, {} rising edges", f.rising_edges),
        };
        format!(
            "mode command {} · {:.3} MHz · {} m of cable ({:.0} ns there and back) · {answer}",
            f.command.map_or("-".into(), |c| format!("{c:06b}")),
            1e6 / f.period.max(1) as f64,
            config.cable_m,
            config.round_trip() as f64 / 1e3,
        )
    }

    /// Draws the legend; returns its end.
    fn legend(&mut self, mut x: f64, y: f64) -> f64 {
        let entries = [
            (By::Receiver, "receiver drives"),
            (By::Encoder, "encoder drives"),
            (By::Nobody, "nobody drives"),
            (By::Both, "both drive: conflict"),
        ];
        for (by, text) in entries {
            if by == By::Both && !self.shown(|s| s.by == By::Both) {
                continue;
            }
            self.svg.rect(x, y - 10.0, 22.0, 12.0, fill(by));
            self.svg
                .line(&[(x, y - 4.0), (x + 22.0, y - 4.0)], stroke(by));
            self.svg.text(x + 29.0, y, Anchor::Start, "legend", text);
            x += 29.0 + text_width(text, 11.5) + 22.0;
        }
        if self.shown(|s| s.meaning == Meaning::Glitch) {
            self.svg
                .line(&[(x + 4.0, y - 9.0), (x + 4.0, y + 1.0)], "glitch");
            self.svg
                .text(x + 14.0, y, Anchor::Start, "legend", "glitch");
            x += 14.0 + text_width("glitch", 11.5) + 22.0;
        }
        if self.shown(|s| is_wrong(s, self.frame)) {
            let text = "arrives wrong";
            self.svg.rect(x, y - 10.0, 22.0, 12.0, "f-wrong");
            self.svg.text(x + 29.0, y, Anchor::Start, "legend", text);
            x += 29.0 + text_width(text, 11.5) + 22.0;
        }
        x
    }

    fn shown(&self, which: impl Fn(&Segment) -> bool) -> bool {
        self.segments.iter().any(which)
    }

    fn row_name(&mut self, name: &str, end: End, y: f64) {
        self.svg.text(24.0, y, Anchor::Start, "name", name);
        if self.both_ends {
            let end = match end {
                End::Receiver => "at the receiver",
                End::Encoder => "at the encoder",
            };
            self.svg.text(24.0, y + 14.0, Anchor::Start, "end", end);
        }
    }

    fn clock_row(&mut self, end: End, top: f64) {
        let Some(trace) = self.link.trace() else {
            return;
        };
        let (track, first) = match end {
            End::Receiver => (&trace.clock_at_receiver, self.zero),
            End::Encoder => (&trace.clock_at_encoder, self.frame.first_fall),
        };
        let bottom = top + CLOCK_HEIGHT;
        let level_y = |level: bool| if level { top } else { bottom };
        let before_row = track
            .iter()
            .rfind(|e| e.0 > self.begin && e.0 < self.row.start);
        let first_level = before_row.is_none_or(|e| e.1);
        let mut points = vec![(self.x(self.row.start), level_y(first_level))];
        let mut count = 0;
        let mut hidden = None;
        let mut labels = Vec::new();
        for (time, level) in track
            .iter()
            .filter(|e| e.0 > self.begin && e.0 < self.row.end)
        {
            let counts = *level && *time > first;
            count += u32::from(counts);
            if *time < self.row.start {
                continue;
            }
            if let Some(middle) = self.scale.middle_of_break(*time) {
                hidden = Some(middle);
                continue;
            }
            let x = self.x(*time);
            if let Some(middle) = hidden.take() {
                // The clock continues there; the marks cover the step.
                let before = points.last().map_or(top, |p| p.1);
                points.extend([(middle, before), (middle, level_y(!level))]);
            }
            points.push((x, level_y(!level)));
            points.push((x, level_y(*level)));
            if counts {
                labels.push((x, count));
            }
        }
        points.push((self.x(self.row.end), points.last().map_or(top, |p| p.1)));
        self.svg.line(&points, "clock");
        self.row_name("CLOCK", end, top + CLOCK_HEIGHT / 2.0 + 4.0);
        let marked = [
            Some(1),
            self.frame.start_edge,
            self.frame.expected_rising_edges(),
        ];
        for (x, n) in labels {
            let class = if marked.contains(&Some(n)) {
                "mark"
            } else {
                "count"
            };
            self.svg
                .text(x, top - 4.0, Anchor::Middle, class, &n.to_string());
        }
    }

    fn data_row(&mut self, end: End, top: f64) {
        let bottom = top + DATA_HEIGHT;
        let middle = top + DATA_HEIGHT / 2.0;
        let segments = self.segments_at(end).to_vec();
        let segments: Vec<Segment> = segments
            .into_iter()
            .filter(|s| self.is_in_row(&(s.from..s.until)))
            .collect();
        let y_of = |level: Level| match level {
            Level::High => top + 3.0,
            Level::Low => bottom - 3.0,
            Level::Floating | Level::Conflict => middle,
        };
        for s in &segments {
            let (a, b) = (self.x(s.from), self.x(s.until));
            let class = match is_wrong(s, self.frame) {
                true => "f-wrong",
                false => segment_fill(s),
            };
            self.svg.rect(a, top, b - a, DATA_HEIGHT, class);
        }
        let mut before: Option<f64> = None;
        let mut named = None;
        for s in &segments {
            let (a, b, y) = (self.x(s.from), self.x(s.until), y_of(s.level));
            let name = bit_name(s.meaning);
            if name.is_some() && before == Some(y) {
                self.svg.line(&[(a, top + 9.0), (a, bottom - 9.0)], "cell");
            }
            let mut points = vec![(a, y), (b, y)];
            if let Some(from) = before.filter(|from| *from != y) {
                points.insert(0, (a, from));
            }
            let class = match s.meaning {
                Meaning::Glitch => "glitch",
                _ => stroke(s.by),
            };
            self.svg.line(&points, class);
            before = Some(y);
            let is_home = self.is_home(&(s.from..s.until));
            if let Some(label) = name.filter(|_| is_home && named != Some(s.meaning)) {
                // A piece cut by a row has the same space.
                if text_width(&label, 9.0) < self.scale.x(s.until) - self.scale.x(s.from) {
                    named = Some(s.meaning);
                    self.svg
                        .text((a + b) / 2.0, middle + 3.2, Anchor::Middle, "bit", &label);
                }
            }
        }
        self.row_name("DATA", end, middle + 4.0);
    }

    fn segments_at(&self, end: End) -> &[Segment] {
        match end {
            End::Receiver => &self.segments,
            End::Encoder => &self.far_segments,
        }
    }

    /// Draws the fields above the cells.
    fn field_brackets(&mut self, end: End, y: f64) {
        for group in groups(self.segments_at(end), self.frame) {
            let span = group.from..group.until;
            if !self.is_in_row(&span) {
                continue;
            }
            let (a, b) = (self.x(group.from), self.x(group.until));
            let fits = |t: &String| text_width(t, 11.0) < b - a - 2.0;
            let Some(text) = group.texts(self.frame).into_iter().find(fits) else {
                continue;
            };
            let (top, bottom) = (y + 10.0, y + 18.0);
            let (l, r) = (a + 1.5, b - 1.5);
            let mut bracket = vec![(l, top + 4.0), (r, top + 4.0)];
            // Open if it continues in another row.
            if group.from >= self.row.start {
                bracket.insert(0, (l, bottom));
            }
            if group.until <= self.row.end {
                bracket.push((r, bottom));
            }
            self.svg.line(&bracket, "bracket");
            if self.is_home(&span) {
                self.svg
                    .text((a + b) / 2.0, top, Anchor::Middle, "field", &text);
            }
        }
    }
}
