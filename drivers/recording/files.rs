//! Names of the files of a recording, and the file that is being written. Nothing that is there is ever replaced, unless it is asked for.

use super::keep::Entry;
use super::layout::Layout;
use super::lines::Lines;
use super::parquet::ParquetFile;
use super::sheet::{Format, Sheet, Text};
use endat_console::error::CommandError;
use serde_json::Value;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Where rows go.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// To stdout.
    Stdout,
    /// Into one file, which may be replaced; into numbered ones behind it where it may not be longer.
    One {
        /// Which.
        path: PathBuf,
        /// It may.
        force: bool,
    },
    /// Into numbered files: `night-0001.csv`.
    Numbered {
        /// The name without a number.
        path: PathBuf,
        /// There may be some.
        resume: bool,
    },
}

/// Digits of a number, with zeros before it.
const DIGITS: usize = 4;

/// Name of the file of a number.
pub fn numbered(path: &Path, number: u32) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let suffix = path
        .extension()
        .map(|s| format!(".{}", s.to_string_lossy()));
    let suffix = suffix.unwrap_or_default();
    path.with_file_name(format!("{stem}-{number:0DIGITS$}{suffix}"))
}

/// The name without a number and the number, of a file that has one.
fn unnumbered(path: &Path) -> Option<(PathBuf, u32)> {
    let stem = path.file_stem()?.to_string_lossy();
    let (name, digits) = stem.rsplit_once('-')?;
    let number = Some(digits).filter(|d| d.len() >= DIGITS)?.parse().ok()?;
    let mut plain = path.with_file_name(name);
    if let Some(suffix) = path.extension() {
        plain.as_mut_os_string().push(".");
        plain.as_mut_os_string().push(suffix);
    }
    Some((plain, number))
}

/// Numbers of the files of this name in its folder, in no order.
fn numbers(path: &Path) -> impl Iterator<Item = u32> + use<'_> {
    let name = |path: &Path| Some(path.file_name()?.to_string_lossy().into_owned());
    let entries = fs::read_dir(folder(path)).into_iter().flatten().flatten();
    entries.filter_map(move |entry| {
        let (plain, number) = unnumbered(&entry.path())?;
        (name(&plain) == name(path)).then_some(number)
    })
}

/// The highest number that is there; 0 if there is none.
pub fn highest(path: &Path) -> u32 {
    numbers(path).max().unwrap_or(0)
}

/// Finds the numbered files of a name that has no number itself, in the order of their numbers.
pub fn behind(path: &Path) -> Vec<PathBuf> {
    let mut found: Vec<u32> = match unnumbered(path) {
        Some(_) => Vec::new(),
        None => numbers(path).collect(),
    };
    found.sort_unstable();
    found.into_iter().map(|n| numbered(path, n)).collect()
}

/// Finds the files before a numbered one: those of lower numbers, the highest first, and the one without a number.
pub fn before(path: &Path) -> Vec<PathBuf> {
    let Some((plain, number)) = unnumbered(path) else {
        return Vec::new();
    };
    let mut lower: Vec<u32> = numbers(&plain).filter(|other| *other < number).collect();
    lower.sort_unstable_by(|a, b| b.cmp(a));
    let mut found: Vec<PathBuf> = lower.into_iter().map(|n| numbered(&plain, n)).collect();
    found.extend(plain.is_file().then_some(plain));
    found
}

/// Sorts files of one name by their numbers; the file without a number is the first. Names keep the order in which they were given.
pub fn in_order(files: &[PathBuf]) -> Vec<PathBuf> {
    let part = |file: &PathBuf| unnumbered(file).unwrap_or_else(|| (file.clone(), 0));
    let names: Vec<PathBuf> = files.iter().map(|file| part(file).0).collect();
    let mut order = files.to_vec();
    order.sort_by_cached_key(|file| {
        let (name, number) = part(file);
        (names.iter().position(|other| *other == name), number)
    });
    order
}

/// True for a name with a number.
pub fn is_numbered(path: &Path) -> bool {
    unnumbered(path).is_some()
}

/// The name of the file that a recording goes on in behind this one.
pub fn next(path: &Path) -> PathBuf {
    match unnumbered(path) {
        Some((plain, number)) => numbered(&plain, number.saturating_add(1)),
        None => numbered(path, 2),
    }
}

/// Whether a file is the one of the next number behind another one that has a number, too.
pub fn is_next(path: &Path, before: &Path) -> bool {
    is_numbered(before) && next(before) == path
}

/// The folder that a file is in.
fn folder(path: &Path) -> &Path {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
    parent.unwrap_or(Path::new("."))
}

impl Target {
    /// Refuses what cannot be begun; the number of the first file.
    pub fn first(&self) -> Result<u32, CommandError> {
        let Self::Numbered { path, resume } = self else {
            return Ok(1);
        };
        let highest = highest(path);
        match highest == 0 || *resume {
            true => Ok(highest + 1),
            false => Err(CommandError::input(format!(
                "--out = {}: {} is there already; give another file with --out, or go on behind it with --resume",
                path.display(),
                numbered(path, highest).display()
            ))),
        }
    }

    /// What the next file is called.
    pub fn name(&self, number: u32) -> String {
        match self {
            Self::Stdout => "stdout".into(),
            Self::One { path, .. } if number == 1 => path.display().to_string(),
            Self::One { path, .. } => numbered(path, number).display().to_string(),
            Self::Numbered { path, .. } => numbered(path, number).display().to_string(),
        }
    }

    /// The number of the file behind this one; those that are there are of other recordings.
    pub fn following(&self, number: u32) -> u32 {
        match self {
            Self::One { path, .. } => number.max(highest(path)) + 1,
            _ => number + 1,
        }
    }

    /// Whether the first file can be made, without making it.
    pub fn check(&self) -> io::Result<()> {
        match self {
            Self::One { path, force: false } if path.exists() && !is_device(path) => {
                Err(io::ErrorKind::AlreadyExists.into())
            }
            _ => Ok(()),
        }
    }

    fn is_numbered(&self, number: u32) -> bool {
        match self {
            Self::Stdout => false,
            Self::One { .. } => number > 1,
            Self::Numbered { .. } => true,
        }
    }

    /// Makes a file; of numbered ones the first number from `number` on that is free, which it raises to that.
    fn open(&self, number: &mut u32) -> io::Result<Option<File>> {
        let path = match self {
            Self::Stdout => return Ok(None),
            Self::One { path, .. } | Self::Numbered { path, .. } => path,
        };
        fs::create_dir_all(folder(path))?;
        match self {
            Self::Numbered { .. } | Self::One { .. } if self.is_numbered(*number) => loop {
                match File::create_new(numbered(path, *number)) {
                    Err(e) if e.kind() == io::ErrorKind::AlreadyExists => *number += 1,
                    other => return other.map(Some),
                }
            },
            _ if is_device(path) => File::options().write(true).open(path).map(Some),
            Self::One { force: true, .. } => File::create(path).map(Some),
            _ => File::create_new(path).map(Some),
        }
    }
}

/// Nothing is lost on a device.
fn is_device(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|m| !m.is_file())
}

/// A file that is being written.
pub enum Open {
    /// Text into a file.
    File(Sheet<Lines<File>>),
    /// Text to stdout.
    Stdout(Sheet<Lines<Box<dyn Write + Send>>>),
    /// Columns.
    Parquet(Box<ParquetFile>),
}

impl Open {
    /// Makes the file `number`, or the next one that is free.
    pub fn new(
        target: &Target,
        number: &mut u32,
        format: Format,
        layout: &Layout,
        system_hz: f64,
        about: (&Value, bool),
    ) -> io::Result<Self> {
        let file = target.open(number)?;
        let (about, in_text) = about;
        let head = in_text.then_some(about);
        let layout = layout.clone();
        let form = match format {
            Format::Csv => Text::Csv,
            Format::Jsonl => Text::Jsonl,
            Format::Parquet => {
                let file = file.ok_or_else(|| io::Error::other("Parquet needs a file"))?;
                return Ok(Self::Parquet(
                    ParquetFile::new(file, &layout, about)?.into(),
                ));
            }
        };
        Ok(match file {
            Some(file) => Self::File(Sheet::new(
                form,
                Lines::file(file),
                layout,
                system_hz,
                head,
            )?),
            None => {
                let lines = Lines::to(Box::new(io::stdout()));
                Self::Stdout(Sheet::new(form, lines, layout, system_hz, head)?)
            }
        })
    }

    /// A row.
    pub fn row(&mut self, entry: &Entry) -> io::Result<()> {
        match self {
            Self::File(sheet) => sheet.row(entry),
            Self::Stdout(sheet) => sheet.row(entry),
            Self::Parquet(file) => file.row(entry),
        }
    }

    /// Gives away what has waited for long enough.
    pub fn tick(&mut self) -> io::Result<()> {
        match self {
            Self::File(sheet) => sheet.out.flush(),
            Self::Stdout(sheet) => sheet.out.flush(),
            Self::Parquet(file) => file.tick(),
        }
    }

    /// The file is whole.
    pub fn end(&mut self) -> io::Result<()> {
        match self {
            Self::File(sheet) => sheet.out.flush(),
            Self::Stdout(sheet) => sheet.out.flush(),
            Self::Parquet(file) => file.flush(),
        }
    }

    /// Groups of rows until now; text has none.
    pub fn groups(&self) -> u32 {
        match self {
            Self::File(_) | Self::Stdout(_) => 0,
            Self::Parquet(file) => file.groups(),
        }
    }

    /// Bytes until now, as far as it is known.
    pub fn bytes(&self) -> u64 {
        match self {
            Self::File(sheet) => sheet.out.bytes(),
            Self::Stdout(sheet) => sheet.out.bytes(),
            Self::Parquet(file) => file.bytes(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a night that is written over, and numbers that begin again.
    #[test]
    fn what_is_there_is_never_replaced() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("night.csv");
        let target = |resume| Target::Numbered {
            path: path.clone(),
            resume,
        };
        assert_eq!(target(false).first(), Ok(1));
        for name in [
            "night-0007.csv",
            "night-0009.parquet",
            "night-day.csv",
            "night-12.csv",
        ] {
            fs::write(dir.path().join(name), name).unwrap();
        }
        let told = target(false).first().unwrap_err();
        assert!(
            told.messages()[0].contains("night-0007.csv is there already"),
            "{told:?}"
        );
        assert_eq!(target(true).first(), Ok(8));
        // Somebody else was faster.
        fs::write(dir.path().join("night-0008.csv"), "other").unwrap();
        let mut number = 8;
        target(true).open(&mut number).unwrap().unwrap();
        assert_eq!(number, 9);
        let other = fs::read_to_string(dir.path().join("night-0008.csv")).unwrap();
        assert_eq!(other, "other");
    }
}
