//! Rows of Parquet, a group at a time.

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

fn foreign(why: &str) -> Wrong {
    Wrong::at(0, format!("{why}; give a file of `log --format parquet`"))
}

fn broken(error: ParquetError) -> Wrong {
    foreign(&format!("cannot be read as Parquet: {error}"))
}

/// Values of a column of a group, none where a row has none.
enum Values {
    Long(Vec<Option<i64>>),
    Double(Vec<Option<f64>>),
    Flag(Vec<Option<bool>>),
    Word(Vec<Option<Cow<'static, str>>>),
}

/// Each row's value, of those that are there and of where they are.
fn spread<T>(values: Vec<T>, levels: &[i16], rows: usize) -> Result<Vec<Option<T>>, Wrong> {
    let mut values = values.into_iter();
    let all: Vec<Option<T>> = match levels.is_empty() {
        true => values.map(Some).collect(),
        false => (levels.iter())
            .map(|level| (*level > 0).then(|| values.next()).flatten())
            .collect(),
    };
    match all.len() == rows {
        true => Ok(all),
        false => Err(foreign(
            "is damaged: a column has another number of rows than the others",
        )),
    }
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
        spread(values, &levels, $rows)?
    }};
}

fn values(group: &dyn RowGroupReader, column: usize, rows: usize) -> Result<Values, Wrong> {
    Ok(match group.get_column_reader(column).map_err(broken)? {
        ColumnReader::Int64ColumnReader(mut reader) => Values::Long(column!(reader, rows)),
        ColumnReader::Int32ColumnReader(mut reader) => {
            let all: Vec<Option<i32>> = column!(reader, rows);
            Values::Long(all.into_iter().map(|v| v.map(i64::from)).collect())
        }
        ColumnReader::DoubleColumnReader(mut reader) => Values::Double(column!(reader, rows)),
        ColumnReader::BoolColumnReader(mut reader) => Values::Flag(column!(reader, rows)),
        ColumnReader::ByteArrayColumnReader(mut reader) => {
            let all: Vec<Option<ByteArray>> = column!(reader, rows);
            let word = |w: ByteArray| w.as_utf8().map(cause).unwrap_or("unknown".into());
            Values::Word(all.into_iter().map(|w| w.map(word)).collect())
        }
        _ => return Err(foreign("has a column of another kind than a recording")),
    })
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

fn long(values: &Values, row: usize) -> Result<Option<u64>, Wrong> {
    match values {
        Values::Long(all) => Ok(all[row].and_then(|v| u64::try_from(v).ok())),
        _ => Err(foreign("is no recording: a column of numbers is none")),
    }
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
    let meta = reader.metadata().file_metadata();
    let said = meta.key_value_metadata().into_iter().flatten();
    let said = said
        .filter(|kv| kv.key == KEY)
        .find_map(|kv| kv.value.as_deref());
    let about: Option<Value> = said.and_then(|text| serde_json::from_str(text).ok());
    let mut head = Head {
        about: about.ok_or_else(|| foreign("is no recording of `log`"))?,
        ..Head::default()
    };
    let units = head.about["channels"].as_array().into_iter().flatten();
    let units = units.map(|c| c["unit"].as_str().unwrap_or_default().to_owned());
    head.units = units.collect();
    let system_hz = head.about["system_hz"].as_f64().filter(|hz| *hz > 0.0);
    let system_hz = system_hz.ok_or_else(|| foreign("is no recording: it has no system_hz"))?;
    let columns = meta.schema_descr().columns().iter();
    let names: Vec<String> = columns.map(|c| c.name().to_owned()).collect();
    let columns = Columns::of(&names, &mut head)?;
    let mut line = 0;
    for n in 0..reader.num_row_groups() {
        let group = reader.get_row_group(n).map_err(broken)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or_default();
        let all: Vec<Values> = (0..names.len())
            .map(|column| values(group.as_ref(), column, rows))
            .collect::<Result<_, _>>()?;
        for row in 0..rows {
            line += 1;
            take(&head, parsed(&columns, &all, row, line, system_hz)?)?;
        }
    }
    Ok(head)
}

fn parsed(
    columns: &Columns,
    all: &[Values],
    row: usize,
    line: u64,
    system_hz: f64,
) -> Result<Parsed, Wrong> {
    let cells = columns.channels.iter().map(|[raw, fresh, cause]| {
        let (Values::Flag(fresh), Values::Word(cause)) = (&all[*fresh], &all[*cause]) else {
            return Err(foreign("is no recording: a column is of another kind"));
        };
        Ok(Cell {
            raw: long(&all[*raw], row)?,
            value: None,
            turns: None,
            fresh: fresh[row].unwrap_or(false),
            cause: cause[row].clone().unwrap_or_default(),
        })
    });
    let derived = columns.derived.iter().map(|n| match &all[*n] {
        Values::Double(all) => all[row],
        Values::Long(all) => all[row].map(|v| v as f64),
        _ => None,
    });
    let cycles = long(&all[columns.cycles], row)?;
    Ok(Parsed {
        line,
        trigger: long(&all[columns.trigger], row)?,
        time_s: cycles.unwrap_or(0) as f64 / system_hz,
        missing: long(&all[columns.missing], row)?.unwrap_or(0),
        cells: cells.collect::<Result<_, _>>()?,
        derived: derived.collect(),
    })
}
