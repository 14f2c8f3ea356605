//! Takes rows, and gives those that are wanted to one file after the other.

use super::about::About;
use super::derive::Derivation;
use super::files::{Open, Target};
use super::keep::{Entry, Keep, Kept};
use super::layout::Layout;
use super::parquet::{GROUPS, GROUPS_MAX};
use super::picture::{Drawing, Picture};
use super::sheet::Format;
use endat_console::error::CommandError;
use endat_host::feed::Row;
use endat_host::range;
use std::io;

/// When a file is ended and the next one begun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// When it has so many bytes.
    pub bytes: Option<u64>,
    /// When its rows are so many cycles of the card's clock.
    pub cycles: Option<u64>,
    /// When it has so many groups of rows, if it has groups.
    pub groups: Option<u32>,
}

impl Limits {
    /// Another file begins at so many bytes, or cycles, and before any file has too many groups.
    pub fn of(bytes: Option<u64>, cycles: Option<u64>) -> Self {
        let is_said = bytes.is_some() || cycles.is_some();
        Self {
            bytes,
            cycles,
            groups: Some(if is_said { GROUPS_MAX } else { GROUPS }),
        }
    }
}

/// What is wanted.
pub struct Wishes {
    /// Where rows go.
    pub target: Target,
    /// In which form.
    pub format: Format,
    /// What is in them.
    pub layout: Layout,
    /// What they are of.
    pub about: About,
    /// Text begins with that.
    pub about_in_text: bool,
    /// What is calculated.
    pub derivation: Derivation,
    /// Which rows.
    pub keep: Keep,
    /// When files end.
    pub limits: Limits,
    /// A drawing.
    pub drawing: Option<Drawing>,
}

/// Writes a recording.
pub struct Recorder {
    wishes: Wishes,
    system_hz: f64,
    open: Option<Open>,
    /// Number of the file that is open or comes next, and of how many there have been.
    number: u32,
    parts: u32,
    /// Cycles of the first row of the file.
    begin: Option<u64>,
    written: u64,
    span_s: f64,
    /// Positions of each channel with more bits than its scale has.
    impossible: Vec<u64>,
}

impl Recorder {
    /// Begins; makes the first file unless it waits for an event.
    pub fn begin(wishes: Wishes) -> Result<Self, CommandError> {
        let mut new = Self {
            system_hz: f64::from(wishes.about.identity.system_hz.max(1)),
            number: wishes.target.first()?,
            impossible: vec![0; wishes.layout.scales.len()],
            wishes,
            open: None,
            parts: 0,
            begin: None,
            written: 0,
            span_s: 0.0,
        };
        if new.wishes.keep.waits() {
            // It is made when there is something to be in it.
            new.wishes
                .target
                .check()
                .map_err(|e| new.cannot_begin(&e))?;
        } else {
            new.next().map_err(|e| new.cannot_begin(&e))?;
        }
        Ok(new)
    }

    fn cannot_begin(&self, error: &io::Error) -> CommandError {
        let name = self.name();
        match error.kind() {
            io::ErrorKind::AlreadyExists => CommandError::input(format!(
                "--out = {name}: is there already; give another file with --out, or replace it with --force"
            )),
            _ => CommandError::io("write", name.as_ref(), error, "give another file with --out"),
        }
    }

    /// What the file is called.
    pub fn name(&self) -> String {
        self.wishes.target.name(self.number)
    }

    /// Files until now.
    pub fn parts(&self) -> u32 {
        self.parts
    }

    /// Rows in them.
    pub fn written(&self) -> u64 {
        self.written
    }

    /// Time of the last row that came.
    pub fn span_s(&self) -> f64 {
        self.span_s
    }

    /// Messages about positions with more bits than their scale has.
    pub fn impossible(&self) -> impl Iterator<Item = String> + '_ {
        let counts = self.impossible.iter().enumerate();
        counts
            .filter(|(_, count)| **count > 0)
            .map(|(n, count)| range::too_small(n, *count, &self.wishes.layout.scales[n]))
    }

    /// The drawing.
    pub fn picture(&self) -> Option<&Picture> {
        self.wishes.drawing.as_ref().map(|d| &d.picture)
    }

    /// Nothing more is wanted.
    pub fn is_over(&self) -> bool {
        self.wishes.keep.is_over()
    }

    /// Only some rows are written.
    pub fn is_selective(&self) -> bool {
        !matches!(self.wishes.keep, Keep::All)
    }

    /// Begins the next file.
    fn next(&mut self) -> io::Result<()> {
        if self.parts > 0 {
            self.number = self.wishes.target.following(self.number);
        }
        let wishes = &self.wishes;
        let is_text = wishes.format != Format::Parquet;
        let about = (wishes.about).json(&wishes.layout, is_text, self.parts + 1);
        self.open = Some(Open::new(
            &wishes.target,
            &mut self.number,
            wishes.format,
            &wishes.layout,
            self.system_hz,
            (&about, wishes.about_in_text),
        )?);
        self.parts += 1;
        self.begin = None;
        Ok(())
    }

    /// The file is whole; what comes goes into another one.
    pub fn end(&mut self) -> io::Result<()> {
        self.open.take().map_or(Ok(()), |mut open| open.end())
    }

    fn is_full(&self, open: &Open, cycles: u64) -> bool {
        let limits = self.wishes.limits;
        let since = cycles.saturating_sub(self.begin.unwrap_or(cycles));
        limits.bytes.is_some_and(|most| open.bytes() >= most)
            || limits.cycles.is_some_and(|most| since >= most)
            || limits.groups.is_some_and(|most| open.groups() >= most)
    }

    fn put(&mut self, entry: &Entry) -> io::Result<()> {
        let cycles = entry.row.cycles;
        if self
            .open
            .as_ref()
            .is_some_and(|open| self.is_full(open, cycles))
        {
            self.end()?;
        }
        if self.open.is_none() {
            self.next()?;
        }
        self.begin.get_or_insert(cycles);
        if let Some(open) = &mut self.open {
            open.row(entry)?;
            self.written += 1;
        }
        Ok(())
    }

    /// A row of the card.
    pub fn row(&mut self, row: Row) -> io::Result<()> {
        self.span_s = row.cycles as f64 / self.system_hz;
        let cells = row.cells.iter().zip(&self.wishes.layout.scales);
        for ((cell, scale), count) in cells.zip(&mut self.impossible) {
            let is_impossible = |position: u64| cell.fresh && !scale.fits(position);
            *count += u64::from(cell.position.is_some_and(is_impossible));
        }
        let values = self.wishes.derivation.values(&row, self.span_s);
        if let Some(Drawing { picture, counter }) = &mut self.wishes.drawing {
            picture.push(&counter.measurement(&row, self.span_s, values.clone()));
        }
        match self.wishes.keep.take(Entry { row, values }) {
            Kept::None => return Ok(()),
            Kept::One(entry) => self.put(&entry)?,
            Kept::Event(entries) => entries.iter().try_for_each(|entry| self.put(entry))?,
        }
        match self.wishes.keep.is_between() {
            true => self.end(),
            false => Ok(()),
        }
    }

    /// Gives away what has waited for long enough.
    pub fn tick(&mut self) -> io::Result<()> {
        self.open.as_mut().map_or(Ok(()), Open::tick)
    }
}

#[cfg(test)]
mod tests;
