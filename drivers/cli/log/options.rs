//! Arguments of `log`, and what they mean.

use crate::port::{scales, told, AnyCard, RangedPort};
use clap::Args;
use endat_console::error::CommandError;
use endat_console::number::number_if;
use endat_recording::about::About;
use endat_recording::count::Judge;
use endat_recording::derive::Derivation;
use endat_recording::files::Target;
use endat_recording::keep::{Faults, Keep};
use endat_recording::layout::Layout;
use endat_recording::picture::{Counter, Drawing, Extras, Picture};
use endat_recording::recorder::{Limits, Wishes};
use endat_recording::sheet::Format;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Arguments of `log`.
#[derive(Args)]
pub struct LogArgs {
    #[command(flatten)]
    pub port: RangedPort,
    /// Stop after so many sample sets [default: until Ctrl-C]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub samples: Option<String>,
    /// Stop after so many seconds
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seconds: Option<String>,
    /// Write into this file [default: to stdout]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Replace the file if it is there
    #[arg(long, requires = "out")]
    pub force: bool,
    /// Draw the positions over time, at the end
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Form of the file [default: by its suffix, .csv, .jsonl or .parquet; CSV without one]
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// CSV for a spreadsheet where the comma is in numbers: fields apart by semicolons
    #[arg(long)]
    pub decimal_comma: bool,
    /// Let CSV and JSON lines begin with what they are of: units, clock, encoders, start; Parquet always does
    #[arg(long)]
    pub about: bool,
    /// Begin another file, with the next number, when one has so many megabytes
    #[arg(
        long,
        value_name = "N",
        requires = "out",
        allow_negative_numbers = true
    )]
    pub file_mb: Option<String>,
    /// The same when it has so many minutes, of the card's clock
    #[arg(
        long,
        value_name = "N",
        requires = "out",
        allow_negative_numbers = true
    )]
    pub file_minutes: Option<String>,
    /// Go on behind the numbered files that are there, in a new one
    #[arg(long, requires = "out", conflicts_with = "force")]
    pub resume: bool,
    /// Keep one of N rows, and every row with a fault
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub every: Option<String>,
    /// Calculate a column: NAME=0 or NAME=0-1 (a difference), then steps such as :unwrap:zero:scale=2, done from left to right
    #[arg(long, value_name = "NAME=SOURCE[:STEP...]")]
    pub derive: Vec<String>,
    /// Write only what is around a fault of one of these causes; any: whatever it is, missing: triggers without a row
    #[arg(
        long,
        value_name = "NAME,...",
        value_delimiter = ',',
        conflicts_with = "every"
    )]
    pub on_cause: Vec<String>,
    /// Rows before the fault [default: 1000]
    #[arg(
        long,
        value_name = "N",
        requires = "on_cause",
        allow_negative_numbers = true
    )]
    pub before: Option<String>,
    /// Rows behind it [default: 1000]
    #[arg(
        long,
        value_name = "N",
        requires = "on_cause",
        allow_negative_numbers = true
    )]
    pub after: Option<String>,
    /// End after so many faults; from 2 on each has a file of its own, numbered [default: 1]
    #[arg(
        long,
        value_name = "N",
        requires = "on_cause",
        allow_negative_numbers = true
    )]
    pub events: Option<String>,
    /// Read results one after the other, even if the card can stream
    #[arg(long)]
    pub poll: bool,
    /// Exit with 1 if more than this share of the rows is bad, in per cent [default: 1]
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true)]
    pub bad_max: Option<String>,
}

/// Rows around a fault, unless told otherwise.
const AROUND: u64 = 1_000;
/// Most rows before it: they are in memory.
const BEFORE_MAX: u64 = 1_000_000;
/// Bytes of a megabyte.
const MB: u64 = 1_000_000;

/// The form that a suffix means: CSV where there is none.
fn of_suffix(path: &Path) -> Result<Format, CommandError> {
    let suffix = path
        .extension()
        .map(|s| s.to_string_lossy().to_ascii_lowercase());
    match suffix.as_deref() {
        None | Some("csv") => Ok(Format::Csv),
        Some("jsonl" | "ndjson") => Ok(Format::Jsonl),
        Some("parquet" | "pq") => Ok(Format::Parquet),
        Some(other) => Err(CommandError::input(format!(
            "--out = {}: .{other} is no form of a recording; give a name that ends in .csv, .jsonl, .ndjson, .parquet or .pq, or say --format",
            path.display()
        ))),
    }
}

/// What can be checked before there is a card.
pub struct Checked {
    target: Target,
    format: Format,
    minutes: Option<u64>,
    bytes: Option<u64>,
    every: u64,
    around: (usize, u64, u64),
}

impl LogArgs {
    /// Numbers and names, as they are meant.
    pub fn checked(&self) -> Result<Checked, CommandError> {
        let number = |flag, text: &Option<String>, range| number_if(flag, text, range);
        let bytes = number("--file-mb", &self.file_mb, 1..=1_000_000)?.map(|mb| mb * MB);
        let minutes = number("--file-minutes", &self.file_minutes, 1..=100_000)?;
        let every = number("--every", &self.every, 1..=1_000_000_000)?.unwrap_or(1);
        let before = number("--before", &self.before, 0..=BEFORE_MAX)?.unwrap_or(AROUND);
        let after = number("--after", &self.after, 0..=u64::from(u32::MAX))?.unwrap_or(AROUND);
        let events = number("--events", &self.events, 1..=1_000_000)?.unwrap_or(1);
        // Before a card is asked for anything.
        Faults::named(&self.on_cause, Judge::default())?;
        let is_numbered = self.resume || bytes.is_some() || minutes.is_some() || events > 1;
        let target = match &self.out {
            None if events > 1 => {
                return Err(CommandError::input(format!(
                    "--events = {events}: each has a file of its own; give its name with --out"
                )));
            }
            None => Target::Stdout,
            Some(path) if is_numbered && self.force => {
                return Err(CommandError::input(format!(
                    "--force: numbered files of {} are never replaced; go on behind them with --resume, or delete them",
                    path.display()
                )));
            }
            Some(path) if path.file_name().is_none() => {
                return Err(CommandError::input(format!(
                    "--out = {}: is not the name of a file; give one",
                    path.display()
                )));
            }
            Some(path) if is_numbered => Target::Numbered {
                path: path.clone(),
                resume: self.resume,
            },
            Some(path) => Target::One {
                path: path.clone(),
                force: self.force,
            },
        };
        let format = match (self.format, &self.out) {
            (Some(format), _) => format,
            (None, Some(path)) => of_suffix(path)?,
            (None, None) => Format::Csv,
        };
        let is_file = |path: &Path| path.metadata().map_or(true, |m| m.is_file());
        if format == Format::Parquet && !self.out.as_deref().is_some_and(is_file) {
            let text = "--format = parquet: needs a regular file; give one with --out, or take csv or jsonl";
            return Err(CommandError::input(text));
        }
        if self.decimal_comma && format != Format::Csv {
            return Err(CommandError::input(
                "--decimal-comma: is of CSV alone; leave it out, or take --format csv",
            ));
        }
        target.first()?;
        Ok(Checked {
            target,
            format,
            minutes,
            bytes,
            every,
            around: (before as usize, after, events),
        })
    }

    /// What is to be recorded of this card.
    pub fn wishes(
        &self,
        checked: Checked,
        card: &mut AnyCard,
        judge: Judge,
    ) -> Result<Wishes, CommandError> {
        let scales = scales(card)?;
        let plates = card.name_plates().map_err(told)?;
        let identity = *card.identity();
        let mut layout = Layout::of(scales.clone());
        layout.additional_data = identity.stream_additional_data;
        layout.decimal_comma = self.decimal_comma;
        let derivation = Derivation::parse(&self.derive, &scales, &layout.text())?;
        layout.derived = derivation.columns();
        let faults = Faults::named(&self.on_cause, judge)?;
        let events = faults.names();
        let (before, after, count) = checked.around;
        let keep = match self.on_cause.is_empty() {
            true => Keep::every(checked.every, judge),
            false => Keep::around(faults, before, after, count),
        };
        let drawing = self.svg.as_ref().map(|_| {
            let units = scales.iter().map(|s| s.convert(0).unit.to_owned());
            let units: Vec<String> = units.collect();
            Drawing {
                picture: Picture::new(&units, &layout.derived, judge, Extras::default()),
                counter: Counter::new(&scales),
            }
        });
        let minutes = |n| n * 60 * u64::from(identity.system_hz);
        Ok(Wishes {
            target: checked.target,
            format: checked.format,
            layout,
            about: About {
                port: self.port.name().to_owned(),
                identity,
                plates,
                every: checked.every,
                events,
                start: SystemTime::now(),
            },
            about_in_text: self.about,
            derivation,
            keep,
            limits: Limits::of(checked.bytes, checked.minutes.map(minutes)),
            drawing,
        })
    }
}
