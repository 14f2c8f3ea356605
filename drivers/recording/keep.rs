//! Which rows go into the file: all, every nth, or those around a fault. A fault is never left out.

use super::count::Judge;
use endat_console::did_you_mean::closest;
use endat_console::error::{shown, CommandError};
use endat_host::feed::{cause_codes, Row};
use std::collections::VecDeque;

/// A row with what was calculated.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The row.
    pub row: Row,
    /// One for each derived column.
    pub values: Vec<Option<f64>>,
}

/// Any fault.
pub const ANY: &str = "any";
/// Triggers without a row.
pub const MISSING: &str = "missing";

/// What is waited for.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults {
    names: Vec<&'static str>,
    judge: Judge,
}

impl Faults {
    /// Those of these names.
    pub fn named(names: &[String], judge: Judge) -> Result<Self, CommandError> {
        let none = endat_host::causes::name(0);
        let causes = cause_codes().map(|(_, name)| name).filter(|n| *n != none);
        let known: Vec<&'static str> = [ANY, MISSING].into_iter().chain(causes).collect();
        let find = |name: &String| match known.iter().find(|k| **k == name) {
            Some(known) => Ok(*known),
            None => {
                let near = closest(name, known.iter().copied(), |n| n);
                let remedy = match near[..] {
                    [] => format!("use one of {}", known.join(", ")),
                    _ => format!("did you mean {}?", near.join(" or ")),
                };
                let text = format!(
                    "--on-cause = {}: there is no such cause; {remedy}",
                    shown(name)
                );
                Err(CommandError::input(text))
            }
        };
        let names = names.iter().map(find).collect::<Result<_, _>>()?;
        Ok(Self { names, judge })
    }

    /// The names.
    pub fn names(&self) -> Vec<String> {
        self.names.iter().map(|n| (*n).to_owned()).collect()
    }

    fn is_in(&self, row: &Row) -> bool {
        self.names.iter().any(|name| match *name {
            ANY => is_remarkable(row, self.judge),
            MISSING => row.missing > 0,
            name => row.cells.iter().any(|cell| cell.cause == name),
        })
    }
}

/// Whether something is not as it should be in a row.
fn is_remarkable(row: &Row, judge: Judge) -> bool {
    row.missing > 0 || row.cells.iter().any(|cell| judge.is_remarkable(cell))
}

/// Rows before a fault, and behind it.
#[derive(Debug)]
pub struct Ring {
    faults: Faults,
    before: usize,
    after: u64,
    /// Events that are still wanted.
    events: u64,
    last: VecDeque<Entry>,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Armed,
    /// So many rows are still written.
    Behind(u64),
    /// The fault of the last event has not gone yet.
    Lasting,
}

/// What becomes of an entry.
#[derive(Debug, PartialEq)]
pub enum Kept {
    /// Nothing.
    None,
    /// It is written.
    One(Entry),
    /// An event begins: all these are written, into a file of its own.
    Event(Vec<Entry>),
}

/// Which rows are kept.
#[derive(Debug)]
pub enum Keep {
    /// All.
    All,
    /// One of so many, and each that is remarkable.
    Every {
        /// Of so many.
        every: u64,
        /// Rows since the last that was kept for being the nth.
        since: u64,
        /// What is remarkable.
        judge: Judge,
    },
    /// Around faults.
    Ring(Ring),
}

impl Keep {
    /// One of `every` rows.
    pub fn every(every: u64, judge: Judge) -> Self {
        match every {
            0 | 1 => Self::All,
            every => Self::Every {
                every,
                since: 0,
                judge,
            },
        }
    }

    /// `before` rows, the fault, and `after` rows; so many times.
    pub fn around(faults: Faults, before: usize, after: u64, events: u64) -> Self {
        Self::Ring(Ring {
            faults,
            before,
            after,
            events,
            last: VecDeque::new(),
            state: State::Armed,
        })
    }

    /// Nothing more is wanted.
    pub fn is_over(&self) -> bool {
        matches!(self, Self::Ring(ring) if ring.events == 0)
    }

    /// Whether each event has a file.
    pub fn waits(&self) -> bool {
        matches!(self, Self::Ring(_))
    }

    /// Between two events nothing is written.
    pub fn is_between(&self) -> bool {
        matches!(self, Self::Ring(ring) if !matches!(ring.state, State::Behind(_)))
    }

    /// Takes the next row.
    pub fn take(&mut self, entry: Entry) -> Kept {
        match self {
            Self::All => Kept::One(entry),
            Self::Every {
                every,
                since,
                judge,
            } => {
                let is_nth = *since == 0;
                *since = (*since + 1) % *every;
                match is_nth || is_remarkable(&entry.row, *judge) {
                    true => Kept::One(entry),
                    false => Kept::None,
                }
            }
            Self::Ring(ring) => ring.take(entry),
        }
    }
}

impl Ring {
    fn take(&mut self, entry: Entry) -> Kept {
        let is_fault = self.faults.is_in(&entry.row);
        match self.state {
            State::Behind(left) => {
                if left > 1 {
                    self.state = State::Behind(left - 1);
                    return Kept::One(entry);
                }
                self.end(is_fault);
                Kept::One(entry)
            }
            State::Armed if is_fault => {
                let mut all: Vec<Entry> = self.last.drain(..).collect();
                all.push(entry);
                match self.after {
                    0 => self.end(true),
                    after => self.state = State::Behind(after),
                }
                Kept::Event(all)
            }
            state => {
                if state == State::Lasting && !is_fault {
                    self.state = State::Armed;
                }
                if self.last.len() == self.before {
                    self.last.pop_front();
                }
                if self.before > 0 {
                    self.last.push_back(entry);
                }
                Kept::None
            }
        }
    }

    fn end(&mut self, is_fault: bool) {
        self.events -= 1;
        self.state = match is_fault {
            true => State::Lasting,
            false => State::Armed,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use endat_host::feed::Cell;

    fn entry(trigger: u64, cause: &'static str, missing: u64) -> Entry {
        let cell = Cell {
            position: Some(trigger),
            fresh: cause == "none",
            cause,
            infos: [None; 2],
        };
        Entry {
            row: Row {
                run: None,
                trigger,
                cycles: 0,
                missing,
                cells: vec![cell],
            },
            values: Vec::new(),
        }
    }

    fn kept(keep: &mut Keep, rows: impl IntoIterator<Item = Entry>) -> Vec<Vec<u64>> {
        let mut files: Vec<Vec<u64>> = vec![Vec::new()];
        for row in rows {
            if keep.is_over() {
                break;
            }
            let entries = match keep.take(row) {
                Kept::None => continue,
                Kept::Event(entries) => {
                    files.push(Vec::new());
                    entries
                }
                Kept::One(entry) => vec![entry],
            };
            let triggers = entries.iter().map(|e| e.row.trigger);
            files.last_mut().unwrap().extend(triggers);
        }
        files
    }

    /// Catches a decimation in which a single fault is lost, or that counts from the fault on.
    #[test]
    fn every_tenth_row_and_every_fault_is_kept() {
        let rows = (0..40).map(|n| match n {
            7 => entry(n, "crc", 0),
            23 => entry(n, "none", 2),
            _ => entry(n, "none", 0),
        });
        let mut keep = Keep::every(10, Judge::default());
        assert_eq!(kept(&mut keep, rows), [[0, 7, 10, 20, 23, 30]]);
        // A channel that a trigger is not for is no fault where triggers are for some channels only.
        let own_triggers = Judge { own_triggers: true };
        let rows = (0..20).map(|n| entry(n, "not_taken", 0));
        assert_eq!(kept(&mut Keep::every(10, own_triggers), rows), [[0, 10]]);
    }

    /// Catches a ring that forgets what was before the fault, or is armed again while it lasts.
    #[test]
    fn what_was_before_a_fault_is_kept_and_a_lasting_one_is_one_event() {
        let rows = || {
            (0..60).map(|n| match n {
                10..25 | 40 => entry(n, "crc", 0),
                _ => entry(n, "none", 0),
            })
        };
        let faults = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|n| (*n).to_string()).collect();
            Faults::named(&names, Judge::default())
        };
        let mut keep = Keep::around(faults(&["crc"]).unwrap(), 3, 4, 2);
        let wanted: Vec<Vec<u64>> = vec![vec![], (7..15).collect(), (37..45).collect()];
        assert_eq!(kept(&mut keep, rows()), wanted);
        assert!(keep.is_over());
        let mut other = Keep::around(faults(&["no_start_bit"]).unwrap(), 3, 4, 1);
        assert_eq!(kept(&mut other, rows()), [[0u64; 0]]);
        let mut any = Keep::around(faults(&["any"]).unwrap(), 0, 0, 9);
        assert_eq!(kept(&mut any, rows()), [vec![], vec![10], vec![40]]);
        let error = faults(&["no_start"]).unwrap_err();
        assert!(
            error.messages()[0].contains("did you mean no_start_bit"),
            "{error:?}"
        );
    }
}
