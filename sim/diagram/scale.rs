//! Converts picoseconds to pixels, with long quiet spans shortened.

use crate::Time;

/// A time span without an event, drawn shorter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Break {
    pub(super) from: Time,
    pub(super) until: Time,
}

/// Maps times to horizontal positions.
pub(super) struct Scale {
    /// Corner points of the map, in order of time.
    knots: Vec<(Time, f64)>,
    pub(super) breaks: Vec<Break>,
    pub(super) pixels_per_us: f64,
}

impl Scale {
    /// A map that begins at `x`, draws `period` as `period_pixels`, and every span between two `events` that is longer than
    /// `longest` as long as `longest`.
    pub(super) fn new(
        mut events: Vec<Time>,
        x: f64,
        period: Time,
        period_pixels: f64,
        longest: Time,
    ) -> Self {
        events.sort_unstable();
        events.dedup();
        let per_ps = period_pixels / period as f64;
        let mut knots: Vec<(Time, f64)> = Vec::new();
        let mut breaks = Vec::new();
        for time in events {
            let Some((last, place)) = knots.last().copied() else {
                knots.push((time, x));
                continue;
            };
            let span = time - last;
            if span > longest {
                breaks.push(Break {
                    from: last,
                    until: time,
                });
            }
            knots.push((time, place + span.min(longest) as f64 * per_ps));
        }
        Self {
            knots,
            breaks,
            pixels_per_us: per_ps * 1e6,
        }
    }

    /// Position of a time.
    pub(super) fn x(&self, time: Time) -> f64 {
        let next = self.knots.partition_point(|k| k.0 <= time);
        let before = self.knots[next.saturating_sub(1)];
        let Some(after) = self.knots.get(next) else {
            return before.1;
        };
        if time < before.0 {
            return before.1;
        }
        let part = (time - before.0) as f64 / (after.0 - before.0) as f64;
        before.1 + part * (after.1 - before.1)
    }

    /// True if a time is inside a shortened span, where positions are undefined.
    pub(super) fn in_break(&self, time: Time) -> bool {
        self.middle_of_break(time).is_some()
    }

    /// The middle of the shortened span around a time.
    pub(super) fn middle_of_break(&self, time: Time) -> Option<f64> {
        let inside = |b: &&Break| b.from < time && time < b.until;
        let found = self.breaks.iter().find(inside)?;
        Some((self.x(found.from) + self.x(found.until)) / 2.0)
    }

    /// The events outside of shortened spans.
    pub(super) fn events(&self) -> impl Iterator<Item = Time> + '_ {
        self.knots.iter().map(|k| k.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_quiet_spans_are_shortened_and_the_rest_is_true() {
        let s = Scale::new(vec![0, 100, 1100, 1200], 10.0, 100, 20.0, 300);
        assert_eq!(
            [0, 50, 100, 1100, 1200].map(|t| s.x(t)),
            [10.0, 20.0, 30.0, 90.0, 110.0]
        );
        assert_eq!(s.x(600), 60.0);
        assert!(s.in_break(600) && !s.in_break(100) && !s.in_break(1150));
        assert_eq!(s.x(9999), 110.0);
    }
}
