//! A frame that is too long for the page continues in the next row.

use super::{scale::Scale, Diagram, LEFT};
use crate::Time;
use std::ops::Range;

/// Longest row in pixels.
const ROW_PIXELS: f64 = 1300.0;

/// Divides the page into rows of about equal length, at cell boundaries if possible.
pub(super) fn cut(scale: &Scale, cells: &[Time], begin: Time, end: Time) -> Vec<Range<Time>> {
    let mut rows = Vec::new();
    let mut from = begin;
    loop {
        let (left, rest) = (scale.x(from), scale.x(end) - scale.x(from));
        let count = (rest / ROW_PIXELS).ceil();
        let place = |t: &Time| scale.x(*t) - left;
        let may_be = |t: &Time| place(t) > rest / count / 2.0 && place(t) <= ROW_PIXELS;
        let off = |t: &Time| (place(t) - rest / count).abs();
        let nearest = |a: &Time, b: &Time| off(a).total_cmp(&off(b));
        let cells = cells.iter().copied().filter(|t| !scale.in_break(*t));
        let at = cells.filter(may_be).min_by(nearest);
        let at = at.or_else(|| scale.events().filter(may_be).min_by(nearest));
        match at.filter(|at| count > 1.0 && *at < end) {
            Some(at) => rows.push(std::mem::replace(&mut from, at)..at),
            None => {
                rows.push(from..end);
                return rows;
            }
        }
    }
}

impl Diagram<'_> {
    /// Selects the current row.
    pub(super) fn begin_row(&mut self, row: &Range<Time>) {
        self.row = row.clone();
        self.shift = self.scale.x(row.start) - LEFT;
    }

    /// Horizontal position of a time in this row, or the end of the row.
    pub(super) fn x(&self, time: Time) -> f64 {
        self.scale.x(time.clamp(self.row.start, self.row.end)) - self.shift
    }

    /// True if part of a span is in this row.
    pub(super) fn is_in_row(&self, span: &Range<Time>) -> bool {
        span.start < self.row.end && span.end > self.row.start
    }

    /// True if no row has a larger part of a span: this row has its labels.
    pub(super) fn is_home(&self, span: &Range<Time>) -> bool {
        let part = |row: &Range<Time>| {
            let (from, until) = (span.start.max(row.start), span.end.min(row.end));
            self.scale.x(until.max(from)) - self.scale.x(from)
        };
        let most = self.rows.iter().map(part).fold(0.0, f64::max);
        let first = self.rows.iter().find(|row| part(row) == most);
        first == Some(&self.row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_end_where_a_cell_begins_and_leave_nothing_out() {
        let scale = Scale::new((0..=4000).collect(), LEFT, 1, 1.0, 100);
        let cells: Vec<Time> = (0..4000).step_by(70).collect();
        let rows = cut(&scale, &cells, 0, 4000);
        assert_eq!(rows.len(), 4);
        assert_eq!((rows[0].start, rows[3].end), (0, 4000));
        for pair in rows.windows(2) {
            assert_eq!(pair[0].end, pair[1].start);
            assert_eq!(pair[1].start % 70, 0);
        }
        for row in &rows {
            assert!((500..=1300).contains(&(row.end - row.start)), "{row:?}");
        }
        // Without cells, at an event; and a short frame in one row.
        assert_eq!(cut(&scale, &[], 0, 2000), [0..1000, 1000..2000]);
        assert_eq!(cut(&scale, &cells, 0, 1300).len(), 1);
    }
}
