//! Rows of Parquet. One thread decodes some thousand rows of every column while another one takes those before them.

use super::super::about::KEY;
use super::super::layout::{of_channel, DerivedColumn, INFOS};
use super::super::parquet::seal;
use super::{cause, Cell, Head, Parsed, Take, Wrong};
use parquet::column::reader::ColumnReader;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use serde_json::Value;
use std::borrow::Cow;
use std::fs::File;
use std::path::Path;
use std::sync::mpsc::{sync_channel, Receiver, SyncSender};
use std::thread;

fn foreign(why: &str) -> Wrong {
    Wrong::at(0, format!("{why}; give a file of `log --format parquet`"))
}

fn broken(error: ParquetError) -> Wrong {
    foreign(&format!("cannot be read as Parquet: {error}"))
}

/// Rows that are decoded at once, and how many times as many wait to be taken.
const BATCH: usize = 1 << 14;
const BATCHES: usize = 4;

/// Values of a column, of the rows that have one.
struct Cells<T> {
    values: Vec<T>,
    /// 1 where a row has one; empty if every row has.
    levels: Vec<i16>,
    /// The value of the next row that has one.
    at: usize,
}

impl<T: Clone> Cells<T> {
    /// The value of a row; rows are asked for one after the other.
    fn next(&mut self, row: usize) -> Option<T> {
        if !self.levels.is_empty() && self.levels[row] == 0 {
            return None;
        }
        self.at += 1;
        self.values.get(self.at - 1).cloned()
    }
}

/// Values of a column of some rows.
enum Values {
    Long(Cells<i64>),
    Double(Cells<f64>),
    Flag(Cells<bool>),
    Word(Cells<Cow<'static, str>>),
}

/// Some rows.
struct Batch {
    rows: usize,
    columns: Vec<Values>,
}

macro_rules! column {
    ($reader:expr, $rows:expr) => {{
        let (mut values, mut levels) = (Vec::new(), Vec::new());
        let mut done = 0;
        while done < $rows {
            let read = $reader.read_records($rows - done, Some(&mut levels), None, &mut values);
            match read.map_err(broken)? {
                (0, ..) => break,
                (more, ..) => done += more,
            }
        }
        if done != $rows {
            return Err(foreign(
                "is damaged: a column has another number of rows than the others",
            ));
        }
        Cells {
            values,
            levels,
            at: 0,
        }
    }};
}

/// Names of a column: mostly the one that came before.
fn words(all: Cells<ByteArray>) -> Cells<Cow<'static, str>> {
    let mut last: Option<(ByteArray, Cow<'static, str>)> = None;
    let mut word = |bytes: ByteArray| match &last {
        Some((known, name)) if *known == bytes => name.clone(),
        _ => {
            let name: Cow<'static, str> = bytes.as_utf8().map_or("unknown".into(), cause);
            last = Some((bytes, name.clone()));
            name
        }
    };
    Cells {
        values: all.values.into_iter().map(&mut word).collect(),
        levels: all.levels,
        at: 0,
    }
}

fn values(reader: &mut ColumnReader, rows: usize) -> Result<Values, Wrong> {
    Ok(match reader {
        ColumnReader::Int64ColumnReader(reader) => Values::Long(column!(reader, rows)),
        ColumnReader::Int32ColumnReader(reader) => {
            let all: Cells<i32> = column!(reader, rows);
            Values::Long(Cells {
                values: all.values.into_iter().map(i64::from).collect(),
                levels: all.levels,
                at: 0,
            })
        }
        ColumnReader::DoubleColumnReader(reader) => Values::Double(column!(reader, rows)),
        ColumnReader::BoolColumnReader(reader) => Values::Flag(column!(reader, rows)),
        ColumnReader::ByteArrayColumnReader(reader) => Values::Word(words(column!(reader, rows))),
        _ => return Err(foreign("has a column of another kind than a recording")),
    })
}

/// Decodes all rows, as long as somebody takes them.
fn decode(reader: &dyn FileReader, give: &SyncSender<Result<Batch, Wrong>>) -> Result<(), Wrong> {
    let columns = reader
        .metadata()
        .file_metadata()
        .schema_descr()
        .num_columns();
    for n in 0..reader.num_row_groups() {
        let group: Box<dyn RowGroupReader + '_> = reader.get_row_group(n).map_err(broken)?;
        let mut left = usize::try_from(group.metadata().num_rows()).unwrap_or_default();
        let readers = (0..columns).map(|column| group.get_column_reader(column));
        let mut readers = readers.collect::<Result<Vec<_>, _>>().map_err(broken)?;
        while left > 0 {
            let rows = left.min(BATCH);
            let columns = readers.iter_mut().map(|reader| values(reader, rows));
            let columns = columns.collect::<Result<Vec<_>, _>>()?;
            if give.send(Ok(Batch { rows, columns })).is_err() {
                return Ok(());
            }
            left -= rows;
        }
    }
    Ok(())
}

/// Where columns are.
struct Columns {
    trigger: usize,
    cycles: usize,
    missing: usize,
    /// Raw, fresh, cause of each channel.
    channels: Vec<[usize; 3]>,
    derived: Vec<usize>,
}

impl Columns {
    fn of(names: &[String], head: &mut Head) -> Result<Self, Wrong> {
        let find = |name: &str| {
            let place = names.iter().position(|n| n == name);
            place.ok_or_else(|| foreign(&format!("is no recording: there is no column {name}")))
        };
        let (trigger, cycles, missing) = (find("trigger")?, find("cycles")?, find("missing")?);
        let mut known = vec![trigger, cycles, missing];
        let mut channels = Vec::new();
        for n in 0..head.units.len() {
            let of = |what: &str| find(&of_channel(n, what));
            let all = [of("raw")?, of("fresh")?, of("cause")?];
            known.extend(all);
            known.extend(INFOS.iter().filter_map(|name| of(name).ok()));
            channels.push(all);
        }
        let derived: Vec<usize> = (0..names.len()).filter(|n| !known.contains(n)).collect();
        head.derived = derived
            .iter()
            .map(|n| {
                let unit = head.about["columns"][&names[*n]]["unit"].as_str();
                DerivedColumn {
                    name: names[*n].clone(),
                    unit: unit.unwrap_or_default().to_owned(),
                    digits: None,
                }
            })
            .collect();
        Ok(Self {
            trigger,
            cycles,
            missing,
            channels,
            derived,
        })
    }
}

fn long(values: &mut Values, row: usize) -> Result<Option<u64>, Wrong> {
    match values {
        Values::Long(all) => Ok(all.next(row).and_then(|v| u64::try_from(v).ok())),
        _ => Err(foreign("is no recording: a column of numbers is none")),
    }
}

/// The description of its recording that a file carries.
fn about(file: &SerializedFileReader<File>) -> Option<Value> {
    let said = file.metadata().file_metadata().key_value_metadata()?;
    let said = said.iter().filter(|kv| kv.key == KEY);
    serde_json::from_str(said.filter_map(|kv| kv.value.as_deref()).next()?).ok()
}

/// Opens a file by its name; none if it is no such file.
fn open(path: &Path) -> Option<SerializedFileReader<File>> {
    SerializedFileReader::new(File::open(path).ok()?).ok()
}

/// The description of its recording that a file carries; none if it is no such file.
pub(super) fn about_of(path: &Path) -> Option<Value> {
    about(&open(path)?)
}

/// How many groups of rows a file has; none if it is no such file.
pub(super) fn groups_of(path: &Path) -> Option<usize> {
    Some(open(path)?.num_row_groups())
}

/// Reads a file; what it says before its rows.
pub(super) fn read(mut file: File, take: Take<'_>) -> Result<Head, Wrong> {
    let state = seal::state(&mut file);
    let state = state.map_err(|e| {
        foreign(&format!(
            "cannot be read: {e}; Parquet needs a file, no pipe"
        ))
    })?;
    match state {
        seal::State::Whole => {}
        seal::State::NoEnd => {
            return Err(foreign(
                "is cut off: the end of a Parquet file says where its rows are, and this has none; copy it again if it is a copy",
            ))
        }
        seal::State::Damaged => {
            return Err(foreign(
                "is damaged, or no recording of this program: its check sum is wrong or missing",
            ))
        }
    }
    let reader = SerializedFileReader::new(file).map_err(broken)?;
    let mut head = Head {
        about: about(&reader).ok_or_else(|| foreign("is no recording of `log`"))?,
        ..Head::default()
    };
    let units = head.about["channels"].as_array().into_iter().flatten();
    let units = units.map(|c| c["unit"].as_str().unwrap_or_default().to_owned());
    head.units = units.collect();
    let system_hz = head.about["system_hz"].as_f64().filter(|hz| *hz > 0.0);
    let system_hz = system_hz.ok_or_else(|| foreign("is no recording: it has no system_hz"))?;
    let meta = reader.metadata().file_metadata();
    let columns = meta.schema_descr().columns().iter();
    let names: Vec<String> = columns.map(|c| c.name().to_owned()).collect();
    let columns = Columns::of(&names, &mut head)?;
    let (give, batches) = sync_channel(BATCHES);
    thread::scope(|scope| {
        scope.spawn(move || {
            if let Err(wrong) = decode(&reader, &give) {
                // Where nobody takes rows any more, nobody wants to know.
                let _ = give.send(Err(wrong));
            }
        });
        rows(batches, &columns, &head, system_hz, take)
    })?;
    Ok(head)
}

/// Takes the rows of all batches.
fn rows(
    batches: Receiver<Result<Batch, Wrong>>,
    columns: &Columns,
    head: &Head,
    system_hz: f64,
    take: Take<'_>,
) -> Result<(), Wrong> {
    let mut parsed = Parsed::default();
    for batch in batches {
        let Batch {
            rows,
            columns: mut all,
        } = batch?;
        for row in 0..rows {
            parsed.line += 1;
            parse(columns, &mut all, row, system_hz, &mut parsed)?;
            take(head, &mut parsed)?;
        }
    }
    Ok(())
}

fn parse(
    columns: &Columns,
    all: &mut [Values],
    row: usize,
    system_hz: f64,
    parsed: &mut Parsed,
) -> Result<(), Wrong> {
    parsed.cells.clear();
    for [raw, fresh, cause] in &columns.channels {
        let raw = long(&mut all[*raw], row)?;
        let Values::Flag(fresh) = &mut all[*fresh] else {
            return Err(foreign("is no recording: a column is of another kind"));
        };
        let fresh = fresh.next(row).unwrap_or(false);
        let Values::Word(cause) = &mut all[*cause] else {
            return Err(foreign("is no recording: a column is of another kind"));
        };
        parsed.cells.push(Cell {
            raw,
            value: None,
            turns: None,
            fresh,
            cause: cause.next(row).unwrap_or_default(),
        });
    }
    parsed.derived.clear();
    for n in &columns.derived {
        parsed.derived.push(match &mut all[*n] {
            Values::Double(all) => all.next(row),
            Values::Long(all) => all.next(row).map(|v| v as f64),
            _ => None,
        });
    }
    parsed.trigger = long(&mut all[columns.trigger], row)?;
    parsed.time_s = long(&mut all[columns.cycles], row)?.unwrap_or(0) as f64 / system_hz;
    parsed.missing = long(&mut all[columns.missing], row)?.unwrap_or(0);
    Ok(())
}
