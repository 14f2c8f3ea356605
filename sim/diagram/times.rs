//! The axis, the marks of shortened spans, and the important times.

use super::Diagram;
use crate::{Time, US};
use endat_draw::{text_width, Anchor};
use std::ops::Range;

impl Diagram<'_> {
    pub(super) fn break_marks(&mut self, top: f64, bottom: f64) {
        for b in self.scale.breaks.clone() {
            if !self.is_in_row(&(b.from..b.until)) {
                continue;
            }
            let x = (self.x(b.from) + self.x(b.until)) / 2.0;
            let wave = |x: f64| {
                let mut d = format!("M{x:.1} {top:.1}");
                let mut y = top;
                let mut side = 3.0;
                while y < bottom {
                    let next = (y + 12.0).min(bottom);
                    let turn = (y + next) / 2.0;
                    d += &format!(" Q{:.1} {turn:.1} {x:.1} {next:.1}", x + side);
                    side = -side;
                    y = next;
                }
                d
            };
            self.svg.rect(x - 2.5, top, 5.0, bottom - top, "gap");
            self.svg.path(&wave(x - 2.5), "gapline");
            self.svg.path(&wave(x + 2.5), "gapline");
        }
    }

    pub(super) fn axis(&mut self, y: f64) {
        let (from, until) = (self.x(self.row.start), self.x(self.row.end));
        self.svg.line(&[(from, y), (until, y)], "axis");
        self.svg
            .text(24.0, y + 4.0, Anchor::Start, "end", "time in us");
        let steps = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];
        let fits = |s: &f64| s * self.scale.pixels_per_us >= 48.0;
        let step_us: f64 = steps.into_iter().find(fits).unwrap_or(200.0);
        let step = (step_us * US as f64) as Time;
        let mut last_x = f64::MIN;
        let mut time = self.zero;
        while time < self.row.end {
            let x = self.x(time);
            if time >= self.row.start && !self.scale.in_break(time) && x - last_x > 34.0 {
                let value = (time - self.zero) as f64 / US as f64;
                let text = match step_us < 1.0 {
                    true => format!("{value:.1}"),
                    false => format!("{value:.0}"),
                };
                self.svg.line(&[(x, y - 3.0), (x, y + 4.0)], "axis");
                self.svg.text(x, y + 17.0, Anchor::Middle, "tick", &text);
                last_x = x;
            }
            time += step;
        }
    }

    /// Draws the important times; returns the height.
    pub(super) fn dimensions(&mut self, y: f64) -> f64 {
        let f = self.frame;
        let us = |t: Time| t as f64 / US as f64;
        // Times are the encoder's; positions are those of the drawn edges at the receiver.
        let flight = f.first_fall - self.zero;
        let at_receiver = |t: Time| t.saturating_sub(flight);
        let mut spans = vec![(
            f.first_fall,
            f.first_rise,
            format!("first LOW {:.3} us", us(f.first_rise - f.first_fall)),
        )];
        if f.start_edge.is_some() {
            let tcal = us(f.start_time - f.first_fall);
            spans.push((
                f.first_fall,
                f.start_time,
                format!("start bit launched {tcal:.3} us after the first edge"),
            ));
        }
        spans.push((
            f.first_fall,
            f.last_rise,
            format!("frame {:.3} us", us(f.last_rise - f.first_fall)),
        ));
        let mut place = y - 20.0;
        for (from, until, text) in spans {
            let span = at_receiver(from)..at_receiver(until);
            if self.is_in_row(&span) {
                place += 20.0;
                self.dimension(place, &span, &text);
            }
        }
        // Next to the frame that it follows.
        if let Some(fall) = f.data_fall {
            let text = format!("tm {:.3} us", us(fall - f.last_rise));
            let span = at_receiver(f.last_rise)..at_receiver(fall);
            if self.is_in_row(&span) {
                place = place.max(y);
                self.dimension(place, &span, &text);
            }
        }
        place + 20.0
    }

    /// A time with its arrows; open if it continues in another row.
    fn dimension(&mut self, y: f64, span: &Range<Time>, text: &str) {
        let (a, b) = (self.x(span.start), self.x(span.end));
        let ends = [(span.start, 5.0), (span.end, -5.0)];
        for (time, side) in ends {
            if !(self.row.start..=self.row.end).contains(&time) {
                continue;
            }
            let x = self.x(time);
            self.svg.line(&[(x, y - 5.0), (x, y + 5.0)], "dimline");
            self.svg.line(
                &[(x + side, y - 2.5), (x, y), (x + side, y + 2.5)],
                "dimline",
            );
        }
        self.svg.line(&[(a, y), (b, y)], "dimline");
        if !self.is_home(span) {
            return;
        }
        let width = text_width(text, 11.0);
        if width + 16.0 < b - a {
            let middle = (a + b) / 2.0;
            self.svg.rect(
                middle - width / 2.0 - 4.0,
                y - 7.0,
                width + 8.0,
                14.0,
                "gap",
            );
            self.svg.text(middle, y + 4.0, Anchor::Middle, "dim", text);
        } else {
            self.svg.text(b + 7.0, y + 4.0, Anchor::Start, "dim", text);
        }
    }
}
