//! Recordings as Parquet: integers as deltas, so that an hour of two channels at 10 kHz is some hundred megabytes.
//!
//! Rows are collected into groups. Behind each group stands what makes the file whole, and the next group takes its place: whatever ends
//! the program, all but the last group is there.

use super::about::KEY;
use super::keep::Entry;
use super::layout::{of_channel, DerivedColumn, Layout, INFOS};
use parquet::basic::Encoding;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::{FileMetaData, KeyValue, ParquetMetaData, ParquetMetaDataWriter};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::parser::parse_message_type;
use serde_json::Value;
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Rows of a group: 13 s at 10 kHz.
pub const GROUP_ROWS: usize = 131_072;
/// A group is not kept in memory for longer than this.
const GROUP_TIME: Duration = Duration::from_secs(60);

/// Values of a column; where a column may have none, which rows have one.
enum Store {
    Long(Vec<i64>),
    Int(Vec<i32>),
    Double(Vec<f64>),
    Flag(Vec<bool>),
    Word(Vec<ByteArray>),
}

struct Column {
    name: String,
    store: Store,
    /// 1 where there is a value; none of a column that always has one.
    levels: Option<Vec<i16>>,
}

/// A value of a row.
enum Item {
    Long(Option<u64>),
    Int(Option<u16>),
    Double(Option<f64>),
    Flag(bool),
    Word(&'static str),
}

impl Column {
    fn new(name: impl Into<String>, store: Store, may_lack: bool) -> Self {
        Self {
            name: name.into(),
            store,
            levels: may_lack.then(Vec::new),
        }
    }

    /// As the parser of schemas reads it.
    fn schema(&self) -> String {
        let (kind, means) = match self.store {
            Store::Long(_) => ("INT64", ""),
            Store::Int(_) => ("INT32", ""),
            Store::Double(_) => ("DOUBLE", ""),
            Store::Flag(_) => ("BOOLEAN", ""),
            Store::Word(_) => ("BYTE_ARRAY", " (STRING)"),
        };
        let presence = if self.levels.is_some() {
            "OPTIONAL"
        } else {
            "REQUIRED"
        };
        format!("{presence} {kind} {}{means};", self.name)
    }

    fn encoding(&self) -> Option<Encoding> {
        match self.store {
            Store::Long(_) | Store::Int(_) => Some(Encoding::DELTA_BINARY_PACKED),
            Store::Flag(_) => Some(Encoding::RLE),
            Store::Double(_) => Some(Encoding::PLAIN),
            // A dictionary: a name stands once in a group.
            Store::Word(_) => None,
        }
    }

    fn push(&mut self, item: Item, words: &mut Vec<(&'static str, ByteArray)>) {
        let is_there = match (&mut self.store, item) {
            // Positions and counts have 48 bits, or less than 63.
            (Store::Long(all), Item::Long(value)) => value.map(|v| all.push(v as i64)).is_some(),
            (Store::Int(all), Item::Int(value)) => value.map(|v| all.push(v.into())).is_some(),
            (Store::Double(all), Item::Double(value)) => value.map(|v| all.push(v)).is_some(),
            (Store::Flag(all), Item::Flag(value)) => {
                all.push(value);
                true
            }
            (Store::Word(all), Item::Word(value)) => {
                all.push(word(value, words));
                true
            }
            _ => unreachable!("the columns are those of the items"),
        };
        if let Some(levels) = &mut self.levels {
            levels.push(i16::from(is_there));
        }
    }

    fn write(&mut self, to: &mut SerializedColumnWriter<'_>) -> Result<(), ParquetError> {
        let levels = self.levels.as_deref();
        match &mut self.store {
            Store::Long(all) => {
                to.typed::<Int64Type>().write_batch(all, levels, None)?;
                all.clear();
            }
            Store::Int(all) => {
                to.typed::<Int32Type>().write_batch(all, levels, None)?;
                all.clear();
            }
            Store::Double(all) => {
                to.typed::<DoubleType>().write_batch(all, levels, None)?;
                all.clear();
            }
            Store::Flag(all) => {
                to.typed::<BoolType>().write_batch(all, levels, None)?;
                all.clear();
            }
            Store::Word(all) => {
                to.typed::<ByteArrayType>().write_batch(all, levels, None)?;
                all.clear();
            }
        }
        if let Some(levels) = &mut self.levels {
            levels.clear();
        }
        Ok(())
    }
}

/// The bytes of a name are there once, however many rows have it.
fn word(name: &'static str, words: &mut Vec<(&'static str, ByteArray)>) -> ByteArray {
    if let Some((_, known)) = words.iter().find(|(known, _)| std::ptr::eq(*known, name)) {
        return known.clone();
    }
    let new = ByteArray::from(name);
    words.push((name, new.clone()));
    new
}

fn columns(layout: &Layout) -> Vec<Column> {
    let long = || Store::Long(Vec::new());
    let mut all = vec![
        Column::new("trigger", long(), true),
        Column::new("cycles", long(), false),
        Column::new("missing", long(), false),
    ];
    for n in 0..layout.scales.len() {
        all.extend([
            Column::new(of_channel(n, "raw"), long(), true),
            Column::new(of_channel(n, "fresh"), Store::Flag(Vec::new()), false),
            Column::new(of_channel(n, "cause"), Store::Word(Vec::new()), false),
        ]);
        let infos = layout.infos();
        all.extend(
            infos.map(|name| Column::new(of_channel(n, name), Store::Int(Vec::new()), true)),
        );
    }
    let derived = layout.derived.iter().map(DerivedColumn::column);
    all.extend(derived.map(|name| Column::new(name, Store::Double(Vec::new()), true)));
    all
}

/// A file that is being written.
pub struct ParquetFile {
    file: File,
    writer: SerializedFileWriter<Vec<u8>>,
    columns: Vec<Column>,
    words: Vec<(&'static str, ByteArray)>,
    about: Vec<KeyValue>,
    has_infos: bool,
    /// Rows in memory, since when, and those in the file.
    waiting: usize,
    since: Instant,
    rows: i64,
    /// Where the last group ends.
    end: u64,
    /// What makes the file whole, behind it.
    footer: Vec<u8>,
}

fn broken(error: ParquetError) -> io::Error {
    io::Error::other(error.to_string())
}

impl ParquetFile {
    /// Begins, in an empty file.
    pub fn new(file: File, layout: &Layout, about: &Value) -> io::Result<Self> {
        let columns = columns(layout);
        let schema: String = columns.iter().map(Column::schema).collect();
        let schema =
            parse_message_type(&format!("message endat {{ {schema} }}")).map_err(broken)?;
        let mut properties = WriterProperties::builder()
            .set_created_by(concat!("endat-gen ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_offset_index_disabled(true);
        for column in &columns {
            let path = parquet::schema::types::ColumnPath::from(column.name.as_str());
            let is_word = column.encoding().is_none();
            properties = properties.set_column_dictionary_enabled(path.clone(), is_word);
            if let Some(encoding) = column.encoding() {
                properties = properties.set_column_encoding(path, encoding);
            }
        }
        let writer =
            SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties.build()))
                .map_err(broken)?;
        let mut new = Self {
            file,
            writer,
            columns,
            words: Vec::new(),
            about: vec![KeyValue::new(KEY.to_owned(), about.to_string())],
            has_infos: layout.additional_data,
            waiting: 0,
            since: Instant::now(),
            rows: 0,
            end: 0,
            footer: Vec::new(),
        };
        new.give()?;
        Ok(new)
    }

    /// Bytes until now, without the rows in memory.
    pub fn bytes(&self) -> u64 {
        self.end + self.footer.len() as u64
    }

    /// A row.
    pub fn row(&mut self, Entry { row, values }: &Entry) -> io::Result<()> {
        if self.waiting == 0 {
            self.since = Instant::now();
        }
        let words = &mut self.words;
        let mut columns = self.columns.iter_mut();
        let mut put = |item| {
            if let Some(column) = columns.next() {
                column.push(item, words);
            }
        };
        put(Item::Long(row.run.is_none().then_some(row.trigger)));
        put(Item::Long(Some(row.cycles)));
        put(Item::Long(Some(row.missing)));
        for cell in &row.cells {
            put(Item::Long(cell.position));
            put(Item::Flag(cell.fresh));
            put(Item::Word(cell.cause));
            let infos = cell
                .infos
                .iter()
                .take(if self.has_infos { INFOS.len() / 2 } else { 0 });
            for info in infos {
                put(Item::Int(info.map(|i| i.content)));
                put(Item::Int(info.map(|i| i.status.into())));
            }
        }
        values.iter().for_each(|value| put(Item::Double(*value)));
        self.waiting += 1;
        match self.waiting == GROUP_ROWS {
            true => self.flush(),
            false => Ok(()),
        }
    }

    /// Ends the group if it has waited for long.
    pub fn tick(&mut self) -> io::Result<()> {
        match self.waiting > 0 && self.since.elapsed() > GROUP_TIME {
            true => self.flush(),
            false => Ok(()),
        }
    }

    /// Ends the group: all rows are in the file, and it is whole.
    pub fn flush(&mut self) -> io::Result<()> {
        if self.waiting == 0 {
            return Ok(());
        }
        let mut group = self.writer.next_row_group().map_err(broken)?;
        let mut columns = self.columns.iter_mut();
        while let Some(mut to) = group.next_column().map_err(broken)? {
            let column = columns.next().expect("as many as the schema has");
            column.write(&mut to).map_err(broken)?;
            to.close().map_err(broken)?;
        }
        group.close().map_err(broken)?;
        self.rows += self.waiting as i64;
        self.waiting = 0;
        self.give()
    }

    /// What stands behind the groups that there are.
    fn footer_now(&self) -> io::Result<Vec<u8>> {
        let schema = self.writer.schema_descr().clone();
        let by = self.writer.properties().created_by().to_owned();
        let head = FileMetaData::new(
            1,
            self.rows,
            Some(by),
            Some(self.about.clone()),
            Arc::new(schema),
            None,
        );
        let all = ParquetMetaData::new(head, self.writer.flushed_row_groups().to_vec());
        let mut bytes = Vec::new();
        let writer = ParquetMetaDataWriter::new(&mut bytes, &all);
        writer.finish().map_err(broken)?;
        Ok(bytes)
    }

    /// Gives what the writer has, and what makes it whole, to the file; where it does not fit, the file is as it was before.
    fn give(&mut self) -> io::Result<()> {
        SerializedFileWriter::flush(&mut self.writer)?;
        let group = std::mem::take(self.writer.inner_mut());
        let footer = self.footer_now()?;
        let mut put = |at: u64, parts: [&[u8]; 2]| -> io::Result<()> {
            self.file.seek(SeekFrom::Start(at))?;
            parts
                .iter()
                .try_for_each(|part| self.file.write_all(part))?;
            self.file
                .set_len(at + parts.iter().map(|p| p.len() as u64).sum::<u64>())
        };
        if let Err(error) = put(self.end, [&group, &footer]) {
            // What is cut off makes room for what stood there.
            let _ = self.file.set_len(self.end);
            let mut put = |at: u64| -> io::Result<()> {
                self.file.seek(SeekFrom::Start(at))?;
                self.file.write_all(&self.footer)
            };
            let _ = put(self.end);
            return Err(error);
        }
        self.end += group.len() as u64;
        self.footer = footer;
        Ok(())
    }
}
