//! Reads recordings, in every form that `log` and the live page write, row by row.

mod order;
mod parquet;
mod parts;
mod text;
mod turns;

pub use order::Misfits;

use super::count::Judge;
use super::files::is_next;
use super::layout::DerivedColumn;
use super::picture::{Measurement, Seen};
use endat_console::error::CommandError;
use endat_host::range::{self, Ranges};
use endat_host::units::Scale;
use order::{Mark, Order};
use serde_json::Value;
use std::borrow::Cow;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// What a file says before its rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Head {
    /// Unit of each channel.
    pub units: Vec<String>,
    /// Calculated columns; their names are whole.
    pub derived: Vec<DerivedColumn>,
    /// What it is of; null if it does not say.
    pub about: Value,
    /// The scale of every channel, if it is known.
    pub scales: Vec<Option<Scale>>,
}

impl Head {
    /// The scale of a channel that the file gives.
    fn own_scale(&self, channel: usize) -> Option<Scale> {
        super::about::scale_of(&self.about["channels"][channel])
    }

    /// The scale of a channel, if it is known.
    pub fn scale(&self, channel: usize) -> Option<Scale> {
        self.scales.get(channel).copied().flatten()
    }

    /// Why positions of a channel are not counted on, and the remedy; none if they are.
    pub fn unknown(&self, channel: usize) -> Option<String> {
        let is_known = match self.scale(channel) {
            Some(scale) => scale.is_known(),
            // Who gave them another unit knew.
            None => self.units.get(channel).is_some_and(|unit| unit != "counts"),
        };
        (!is_known).then(|| range::refusal(channel))
    }

    /// Which cells are bad.
    pub fn judge(&self) -> Judge {
        Judge {
            own_triggers: self.about["own_triggers"].as_bool().unwrap_or(false),
        }
    }

    /// When it began, by the clock of its host.
    pub fn start(&self) -> Option<SystemTime> {
        humantime::parse_rfc3339(self.about["start_time"].as_str()?).ok()
    }

    /// Only one of so many rows is in it.
    pub fn every(&self) -> u64 {
        self.about["every"].as_u64().unwrap_or(1)
    }

    /// Rows were left out on purpose.
    fn is_sparse(&self) -> bool {
        let events = self.about["events"].as_array();
        self.every() > 1 || events.is_some_and(|names| !names.is_empty())
    }
}

/// A channel as a file has it.
#[derive(Clone, Debug, Default, PartialEq)]
struct Cell {
    raw: Option<u64>,
    /// Within the turn, and turns.
    value: Option<f64>,
    turns: Option<u64>,
    fresh: bool,
    cause: Cow<'static, str>,
}

/// Most triggers that a row can tell to be missing: the card's own count has 32 bits.
const MISSING_MAX: u64 = u32::MAX as u64;

/// A row as a file has it.
#[derive(Clone, Debug, Default, PartialEq)]
struct Parsed {
    /// Line, or number of the row.
    line: u64,
    trigger: Option<u64>,
    time_s: f64,
    missing: u64,
    cells: Vec<Cell>,
    derived: Vec<Option<f64>>,
}

/// Something wrong at a line, 0: with the whole file.
#[derive(Debug, PartialEq)]
struct Wrong {
    line: u64,
    text: String,
}

impl Wrong {
    fn at(line: u64, text: impl Into<String>) -> Self {
        let text = text.into();
        Self { line, text }
    }
}

/// Text that says nothing of its time.
const NO_START: &str = "does not say when it was begun, and is put right behind the file before it: the pause between is not in any figure; `log --about` lets text say so";
/// The clock of a host was set back, or a card made its rows faster than they happen.
const BEGUN_TOO_EARLY: &str = "was begun before the last row of the file before it by the clock of the host, and is put right behind it";

type Take<'a> = &'a mut dyn FnMut(&Head, &mut Parsed) -> Result<(), Wrong>;
/// What takes the rows of a recording.
pub type Rows<'a> = &'a mut dyn FnMut(&Head, &Measurement);

/// Refuses a value that is not what its raw position is in units: one of the two has been changed.
fn check_value(line: u64, channel: usize, cell: &Cell, scale: Option<&Scale>) -> Result<(), Wrong> {
    let (Some(scale), Some(raw), Some(value)) = (scale, cell.raw, cell.value) else {
        return Ok(());
    };
    let units = scale.convert(raw);
    // What is written ends behind the digits of a measuring step; the last of a turn may be rounded to a whole one.
    let off = (value - units.value).abs();
    let is_near = off <= scale.step()
        || scale
            .wraps_at()
            .is_some_and(|turn| off >= turn - scale.step());
    let turns = cell.turns.zip(units.turns);
    if let Some((told, known)) = turns.filter(|(told, known)| told != known) {
        return Err(Wrong::at(
            line,
            format!(
                "ch{channel}_turns = {told}: does not fit ch{channel}_raw = {raw}, which is in turn {known}; delete the line if it is damaged"
            ),
        ));
    }
    match is_near {
        true => Ok(()),
        false => Err(Wrong::at(
            line,
            format!(
                "ch{channel}_{} = {value}: does not fit ch{channel}_raw = {raw}, which is {}; delete the line if it is damaged",
                units.unit, units.value
            ),
        )),
    }
}

/// The name of a cause, of those that there are.
fn known_cause(line: u64, channel: usize, name: &str) -> Result<Cow<'static, str>, Wrong> {
    match cause(name) {
        known @ Cow::Borrowed(_) => Ok(known),
        Cow::Owned(name) => Err(Wrong::at(
            line,
            format!(
                "ch{channel}_cause = {}: is no cause; `endat explain NAME` knows those that there are; delete the line if it is damaged",
                endat_console::error::shown(&name)
            ),
        )),
    }
}

/// A name as rows of a card have it, so that millions of them cost nothing.
fn cause(name: &str) -> Cow<'static, str> {
    // Mostly it is this one.
    let none = endat_host::causes::name(0);
    if name == none {
        return none.into();
    }
    let known = endat_host::feed::cause_codes().find(|(_, known)| *known == name);
    known.map_or_else(|| name.to_owned().into(), |(_, known)| known.into())
}

/// Files of a recording, one after the other.
#[derive(Default)]
pub struct Reader {
    head: Option<Head>,
    /// Rows were left out on purpose, whatever the files say.
    is_sparse: bool,
    order: Order,
    /// The row that is taken.
    now: Measurement,
    /// Ranges given by the user; they win over those of the files.
    said: Ranges,
    channels: Vec<turns::Channel>,
    /// Scales in the first file, which its columns were written with.
    own_scales: Vec<Option<Scale>>,
    /// Units of the first file.
    units: Vec<String>,
    /// Times of the last two rows of a trigger.
    last_s: Option<f64>,
    before_s: Option<f64>,
    /// The file that was read last.
    last: Option<PathBuf>,
    /// Why a file may be put right behind the last one, if its time is before the end of that.
    follows: Option<&'static str>,
    /// It was, and why.
    is_closed_up: Option<&'static str>,
    offset_s: f64,
    /// The next row is the first one of its file.
    begins_file: bool,
    start: Option<SystemTime>,
    notes: Vec<String>,
}

impl Reader {
    /// Reads a file, as long as rows are taken.
    fn rows(
        &mut self,
        path: &Path,
        take: &mut dyn FnMut(&Head, &Measurement) -> Result<(), Wrong>,
    ) -> Result<(), CommandError> {
        let at = |wrong: Wrong| {
            let place = match wrong.line {
                0 => path.display().to_string(),
                line => format!("{}:{line}", path.display()),
            };
            CommandError::input(format!("{place}: {}", wrong.text))
        };
        let io = |e| CommandError::io("read", path, &e, "give a file of `log` or of the live page");
        if path.is_dir() {
            return Err(at(Wrong::at(
                0,
                "is a folder; give a file of `log` or of the live page",
            )));
        }
        let mut file = File::open(path).map_err(io)?;
        let mut begin = [0; 4];
        let mut count = 0;
        // A pipe may give less at a time.
        while count < begin.len() {
            match file.read(&mut begin[count..]).map_err(io)? {
                0 => break,
                more => count += more,
            }
        }
        if count == 0 {
            return Err(at(Wrong::at(
                0,
                "is empty; give a file of `log` or of the live page",
            )));
        }
        let is_next = (self.last.as_deref()).is_some_and(|last| is_next(path, last));
        self.follows = is_next.then_some(NO_START);
        let mut is_first = true;
        let mut notes = Vec::new();
        let mut next = |head: &Head, row: &mut Parsed| {
            if std::mem::take(&mut is_first) {
                self.begin(head)?;
            }
            self.measure(path, row)?;
            take(self.head.as_ref().unwrap_or(head), &self.now)
        };
        let read = match &begin[..count] == b"PAR1" {
            true => parquet::read(file, &mut next),
            false => {
                // Not every file can be wound back.
                let rest = match file.rewind() {
                    Ok(()) => Box::new(file) as Box<dyn Read>,
                    Err(_) => Box::new(std::io::Cursor::new(begin[..count].to_vec()).chain(file)),
                };
                text::read(
                    BufReader::with_capacity(1 << 16, rest),
                    &mut next,
                    &mut notes,
                )
            }
        };
        let head = read.map_err(at)?;
        if is_first {
            self.begin(&head).map_err(at)?;
        }
        if let Some(why) = self.is_closed_up.take() {
            notes.push(format!(": {why}"));
        }
        let notes = notes
            .into_iter()
            .map(|note| format!("{}{note}", path.display()));
        self.notes.extend(notes);
        self.last = Some(path.to_owned());
        Ok(())
    }

    /// Another file begins.
    fn begin(&mut self, head: &Head) -> Result<(), Wrong> {
        self.begins_file = true;
        self.is_sparse |= head.is_sparse();
        let Some(first) = &self.head else {
            self.channels = turns::channels(head, &self.said)?;
            self.units.clone_from(&head.units);
            self.own_scales = (0..head.units.len()).map(|n| head.own_scale(n)).collect();
            self.start = head.start();
            let mut head = head.clone();
            head.scales = self.channels.iter().map(turns::Channel::scale).collect();
            for (unit, scale) in head.units.iter_mut().zip(&head.scales) {
                if let Some(scale) = scale {
                    *unit = scale.convert(0).unit.to_owned();
                }
            }
            self.head = Some(head);
            return Ok(());
        };
        if (&self.units, &first.derived) != (&head.units, &head.derived) {
            let text = "has other columns than the file before it; give files of one recording";
            return Err(Wrong::at(0, text));
        }
        let offset_s = self.offset_s;
        let (Some(begin), Some(now)) = (self.start, head.start()) else {
            // Nobody knows how long nothing was recorded.
            self.order.interrupt();
            return Ok(());
        };
        // A recording that was begun again later has a time of its own.
        let since = now.duration_since(begin);
        let since = since.map_err(|_| {
            Wrong::at(
                0,
                "was begun before the first file; give the older one first",
            )
        })?;
        self.offset_s = since.as_secs_f64();
        let is_begun_again = self.offset_s != offset_s;
        if is_begun_again {
            self.order.interrupt();
        }
        self.follows = (self.follows.filter(|_| is_begun_again)).map(|_| BEGUN_TOO_EARLY);
        Ok(())
    }

    /// Makes a measurement of a row.
    fn measure(&mut self, path: &Path, row: &mut Parsed) -> Result<(), Wrong> {
        let mut time_s = row.time_s + self.offset_s;
        if let (true, Some(why), Some(last)) = (self.begins_file, self.follows, self.last_s) {
            if time_s < last {
                let step = last - self.before_s.unwrap_or(last);
                self.offset_s = last + step - row.time_s;
                time_s = row.time_s + self.offset_s;
                self.is_closed_up = Some(why);
            }
        }
        if !time_s.is_finite() {
            return Err(Wrong::at(
                row.line,
                format!("time_s = {time_s}: is no time"),
            ));
        }
        if row.missing > MISSING_MAX {
            let text = format!(
                "missing = {}: a card counts triggers up to {MISSING_MAX}; is the file damaged?",
                row.missing
            );
            return Err(Wrong::at(row.line, text));
        }
        let mut fits = true;
        if let Some(trigger) = row.trigger {
            if let Some(last) = self.last_s.filter(|last| time_s < *last) {
                let text = format!(
                    "time_s = {time_s}: is before that of the row before it, {last}: another recording begins here; give files of one recording (text that `log --resume` goes on with needs its number, or --about)"
                );
                return Err(Wrong::at(row.line, text));
            }
            self.before_s = self.last_s.replace(time_s);
            let mark = Mark {
                trigger,
                time_s,
                missing: row.missing,
            };
            let place = || format!("{}:{}", path.display(), row.line);
            fits = self.order.step(mark, self.is_sparse, &place);
        }
        for (n, cell) in row.cells.iter().enumerate() {
            let own = self.own_scales.get(n).copied().flatten();
            check_value(row.line, n, cell, own.as_ref())?;
        }
        self.now.cells.clear();
        for (n, cell) in row.cells.drain(..).enumerate() {
            let position = match (self.channels.get_mut(n), self.units.get(n)) {
                (Some(channel), Some(unit)) if cell.fresh => channel.position(n, &cell, unit),
                _ => Ok(None),
            };
            let position = position.map_err(|why| Wrong::at(row.line, why))?;
            self.now.cells.push(Seen {
                raw: cell.raw,
                position,
                fresh: cell.fresh,
                cause: cell.cause,
            });
        }
        self.now.begins_file = std::mem::take(&mut self.begins_file);
        self.now.trigger = row.trigger;
        self.now.time_s = time_s;
        self.now.missing = row.missing;
        self.now.fits = fits;
        std::mem::swap(&mut self.now.derived, &mut row.derived);
        Ok(())
    }
}

/// What is wrong with a file that the recording has beside those that were given.
fn move_away(wrong: &CommandError) -> CommandError {
    let text = wrong.messages().join("; ");
    let problem = text.rsplit_once("; ").map_or(&*text, |(what, _)| what);
    CommandError::input(format!(
        "{problem}; copy it again, or move it away to read the others"
    ))
}

/// What a file says before its rows, and none of them; none if there is none.
pub fn first(path: &Path) -> Result<Option<Head>, CommandError> {
    let mut reader = Reader::default();
    let mut head = None;
    let read = reader.rows(path, &mut |found, _| {
        head = Some(found.clone());
        Err(Wrong::at(0, String::new()))
    });
    match head {
        Some(head) => Ok(Some(head)),
        None => read.map(|()| reader.head),
    }
}

/// What has been found in a recording beside its rows.
#[derive(Debug, Default)]
pub struct Found {
    /// What the first file says before its rows.
    pub head: Head,
    /// What is to be told.
    pub notes: Vec<String>,
    /// Rows that do not fit those around them.
    pub misfits: Misfits,
}

/// Reads all files; nothing is no recording. `is_sparse`: rows were left out on purpose, whatever the files say.
pub fn read_all(files: &[PathBuf], is_sparse: bool, take: Rows<'_>) -> Result<Found, CommandError> {
    read_as(files, is_sparse, Ranges::default(), take)
}

/// The same with what is said about positions, whatever the files say.
pub fn read_as(
    files: &[PathBuf],
    is_sparse: bool,
    said: Ranges,
    take: Rows<'_>,
) -> Result<Found, CommandError> {
    let mut reader = Reader {
        is_sparse,
        said,
        ..Reader::default()
    };
    let all = parts::all(files, &mut reader.notes);
    let mut rows = 0u64;
    for file in &all {
        let read = reader.rows(file, &mut |head, row| {
            rows += 1;
            take(head, row);
            Ok(())
        });
        // Nobody named it.
        let is_found = !files.contains(file);
        read.map_err(|wrong| match is_found {
            true => move_away(&wrong),
            false => wrong,
        })?;
    }
    if rows == 0 {
        let names: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
        return Err(CommandError::input(format!(
            "{}: has no rows; give a recording that has some",
            names.join(", ")
        )));
    }
    Ok(Found {
        head: reader.head.unwrap_or_default(),
        notes: reader.notes,
        misfits: reader.order.misfits().clone(),
    })
}
