//! Whether the rows of a recording follow each other. Text has no check sum: a row that was deleted, doubled or damaged is found by its
//! neighbours. Each row says how many triggers are missing before it, so that its number follows from that of the row before.

/// Steps of the same length that are a clock, from which a time that is off can be told.
const STEADY: u32 = 16;
/// Text rounds to nanoseconds; a time is a whole number of cycles of the card's clock.
const TIME_OFF_S: f64 = 150e-9;
/// The part of a step that a time may be off besides.
const TIME_OFF: f64 = 1e-3;
/// No card takes more triggers in a second.
const TRIGGERS_HZ: f64 = 2e6;
/// Rows that are named.
const NAMED: usize = 5;

/// Rows that do not fit those around them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Misfits {
    /// How many.
    pub rows: u64,
    /// Triggers that are neither rows nor counted as missing.
    pub triggers: u64,
    /// The first of them, with what is wrong.
    pub named: Vec<String>,
}

impl Misfits {
    fn add(&mut self, place: &str, what: &str) {
        self.rows += 1;
        if self.named.len() < NAMED {
            self.named.push(format!("{place}: {what}"));
        }
    }

    /// What is to be told; nothing if all rows fit.
    pub fn told(&self) -> Vec<String> {
        let mut told = self.named.clone();
        let more = self.rows - told.len() as u64;
        if more > 0 {
            told.push(format!("{more} more rows do not fit those around them"));
        }
        if self.rows > 0 {
            told.push(format!(
                "rows that do not fit = {}: the recording has been changed or is damaged; record it again, or take figures of the files that fit (rows that `log --every` or `--on-cause` left out are known with --about, and else with `stats --sparse`)",
                self.rows
            ));
        }
        told
    }
}

/// What a row says of its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Number of its trigger.
    pub trigger: u64,
    /// Its time.
    pub time_s: f64,
    /// Triggers without a row just before it.
    pub missing: u64,
}

/// Looks at one row after the other.
#[derive(Clone, Debug, Default)]
pub struct Order {
    /// The last row that fits.
    good: Option<Mark>,
    /// The last row, if it does not, and how many such there are behind the good one.
    suspect: Option<Mark>,
    suspects: u64,
    clock: Clock,
    misfits: Misfits,
}

/// How many triggers are not accounted for between two rows; none if the second one is not behind the first.
fn gap(before: &Mark, row: &Mark) -> Option<u64> {
    let steps = row.trigger.checked_sub(before.trigger)?;
    steps.checked_sub(1)?.checked_sub(row.missing)
}

/// The clock that triggers come with, if there is one: a single time that is off it has been changed. A pause or another clock is none.
#[derive(Clone, Debug, Default)]
struct Clock {
    /// The last row on time.
    last: Option<Mark>,
    /// Time of a step, and how many were as long.
    step_s: f64,
    steady: u32,
    /// A row that is off, and where it stands.
    off: Option<(Mark, String)>,
}

impl Clock {
    /// Takes a row; the one before it, if that was off.
    fn step(&mut self, row: &Mark, place: &dyn Fn() -> String) -> Option<(String, String)> {
        let last = self.last.replace(*row)?;
        let steps = row.trigger.saturating_sub(last.trigger).max(1) as f64;
        let expected = last.time_s + self.step_s * steps;
        let allowed = TIME_OFF_S + TIME_OFF * self.step_s * steps;
        let off = self.off.take();
        if (row.time_s - expected).abs() <= allowed {
            self.steady = self.steady.saturating_add(1);
            return off.map(|(mark, place)| {
                let what = format!(
                    "time_s = {}: is off the clock of the rows before and behind it, whose triggers are {} s apart",
                    mark.time_s, self.step_s
                );
                (place, what)
            });
        }
        if self.steady >= STEADY && off.is_none() {
            self.off = Some((*row, place()));
            self.last = Some(last);
            return None;
        }
        let from = off.map_or(last, |(mark, _)| mark);
        let steps = row.trigger.saturating_sub(from.trigger).max(1) as f64;
        self.step_s = (row.time_s - from.time_s) / steps;
        self.steady = 0;
        None
    }
}

impl Order {
    /// What does not fit until now.
    pub fn misfits(&self) -> &Misfits {
        &self.misfits
    }

    /// The next row has nothing to do with those before it.
    pub fn interrupt(&mut self) {
        self.good = None;
        self.suspect = None;
        self.suspects = 0;
        self.clock = Clock::default();
    }

    /// Takes a row; whether it fits. `is_sparse`: rows may have been left out on purpose.
    pub fn step(&mut self, row: Mark, is_sparse: bool, place: &dyn Fn() -> String) -> bool {
        let Some(good) = self.good else {
            self.good = Some(row);
            return true;
        };
        let is_possible = |before: &Mark, open: u64| {
            let most = (row.time_s - before.time_s) * TRIGGERS_HZ + 2.0;
            open == 0 || is_sparse && open as f64 <= most
        };
        let from_good = gap(&good, &row);
        // One between that does not fit is a row all the same, or was one too many.
        let fits = from_good.is_some_and(|open| {
            is_possible(&good, open) || open == self.suspects && self.suspects > 0
        });
        if fits {
            if let Some((place, what)) = self.clock.step(&row, place) {
                self.misfits.add(&place, &what);
            }
            self.settle(row);
            return true;
        }
        if let Some(suspect) = self.suspect {
            if gap(&suspect, &row).is_some_and(|open| is_possible(&suspect, open)) {
                // Two that fit each other: what is between them and the good one is not there.
                self.misfits.triggers += gap(&good, &suspect).unwrap_or(0);
                self.clock = Clock::default();
                self.settle(row);
                return true;
            }
        }
        let what = match (row.trigger.checked_sub(good.trigger), from_good) {
            (Some(_), Some(open)) => format!(
                "trigger = {}: {open} triggers before it are neither rows nor counted as missing (the last row that fits has {})",
                row.trigger, good.trigger
            ),
            (Some(1..), None) => format!(
                "missing = {}: does not fit trigger = {} behind {}",
                row.missing, row.trigger, good.trigger
            ),
            _ => format!(
                "trigger = {}: comes behind {}, is there twice or damaged",
                row.trigger, good.trigger
            ),
        };
        self.misfits.add(&place(), &what);
        self.suspect = Some(row);
        self.suspects += 1;
        false
    }

    fn settle(&mut self, row: Mark) {
        self.good = Some(row);
        self.suspect = None;
        self.suspects = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows at 10 kHz, of which some are changed.
    fn misfits(change: impl Fn(&mut Vec<Mark>), is_sparse: bool) -> Misfits {
        let row = |n: u64| Mark {
            trigger: 70 + n,
            time_s: (n as f64 * 1e5).round() * 1e-9,
            missing: 0,
        };
        let mut rows: Vec<Mark> = (0..200).map(row).collect();
        change(&mut rows);
        let mut order = Order::default();
        for (n, row) in rows.into_iter().enumerate() {
            order.step(row, is_sparse, &|| n.to_string());
        }
        order.misfits
    }

    #[test]
    fn each_kind_of_damage_is_counted_once_and_named_where_it_is() {
        type Change = fn(&mut Vec<Mark>);
        for (change, place, triggers, what) in [
            (
                (|rows| drop(rows.drain(50..61))) as Change,
                50,
                11,
                "trigger = 131: 11 triggers before it are neither",
            ),
            (
                |rows| rows.insert(50, rows[49]),
                50,
                0,
                "trigger = 119: comes behind 119, is there twice",
            ),
            (
                |rows| rows[50].trigger = 1_900_000_000_000,
                50,
                0,
                "neither rows nor counted",
            ),
            (
                |rows| rows[50].trigger = 20,
                50,
                0,
                "trigger = 20: comes behind 119",
            ),
            (
                |rows| rows[50].missing = 4,
                50,
                0,
                "missing = 4: does not fit trigger = 120 behind 119",
            ),
            (|rows| rows[50].time_s += 5e-5, 50, 0, "is off the clock"),
            (
                |rows| rows.swap(50, 51),
                50,
                1,
                "trigger = 121: 1 triggers before it",
            ),
        ] {
            let found = misfits(change, false);
            let named = &found.named[0];
            assert!(
                named.starts_with(&format!("{place}: ")) && named.contains(what),
                "{named}"
            );
            assert!(found.rows <= 2 && found.triggers == triggers, "{found:?}");
        }
    }

    #[test]
    fn what_a_card_does_is_no_damage() {
        // A gap that is counted; a pause; another clock; a jitter; rows that were left out on purpose.
        type Change = fn(&mut Vec<Mark>);
        let none = Misfits::default();
        for change in [
            (|rows| {
                rows.drain(50..61);
                rows[50].missing = 11;
            }) as Change,
            |rows| rows[50..].iter_mut().for_each(|r| r.time_s += 3.0),
            |rows| {
                rows.iter_mut()
                    .for_each(|r| r.time_s += (r.trigger.max(150) - 150) as f64 * 1e-3)
            },
            |rows| rows[80].time_s += 1e-7,
        ] {
            assert_eq!(misfits(change, false), none);
        }
        let every = |rows: &mut Vec<Mark>| rows.retain(|r| r.trigger % 10 == 0);
        assert_eq!(misfits(every, true), none);
        assert!(misfits(every, false).rows > 5);
    }
}
