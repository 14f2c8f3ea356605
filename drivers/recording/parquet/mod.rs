//! Recordings as Parquet: integers as deltas, so that an hour of two channels at 10 kHz is some hundred megabytes.
//!
//! Rows are collected into groups. Behind each group stands what makes the file whole, and the next group takes its place. The old end is
//! written once more behind the place of the new one, and cut off when that is there: whatever ends the program, and whenever, all but the
//! last group is there.
//!
//! What makes a file whole tells of each of its groups: a file of very many of them is written for that most of the time, and kept in memory.
//! So groups are large, and after [`GROUPS`] of them another file begins.

mod columns;
pub mod seal;

use super::about::KEY;
use super::keep::Entry;
use super::layout::{Layout, INFOS};
use columns::{columns, Column, Item, Words};
use parquet::errors::ParquetError;
use parquet::file::metadata::{FileMetaData, KeyValue, ParquetMetaData, ParquetMetaDataWriter};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use serde_json::Value;
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Bytes of a group in memory: 524 288 rows of two channels, 52 s at 10 kHz.
const GROUP_BYTES: usize = 26_214_400;
/// Groups of a file, unless another end of it is wanted.
pub const GROUPS: u32 = 16;
/// Groups of a file at most.
pub const GROUPS_MAX: u32 = 256;
/// A group is not kept in memory for longer than this.
const GROUP_TIME: Duration = Duration::from_secs(60);

/// What a file can do.
pub trait Disk: Write + Seek {
    /// It ends here.
    fn cut(&mut self, bytes: u64) -> io::Result<()>;
}

impl Disk for File {
    fn cut(&mut self, bytes: u64) -> io::Result<()> {
        self.set_len(bytes)
    }
}

/// A file that is being written.
pub struct ParquetFile<D = File> {
    file: D,
    writer: SerializedFileWriter<Vec<u8>>,
    columns: Vec<Column>,
    words: Words,
    about: Vec<KeyValue>,
    has_infos: bool,
    /// Rows of a whole group, those in memory, since when, and those in the file.
    group_rows: usize,
    waiting: usize,
    since: Instant,
    rows: i64,
    groups: u32,
    /// Where the last group ends.
    end: u64,
    /// Check sum of what is before that.
    sum: seal::Sum,
    /// What makes the file whole, behind it.
    footer: Vec<u8>,
}

fn broken(error: ParquetError) -> io::Error {
    io::Error::other(error.to_string())
}

impl<D: Disk> ParquetFile<D> {
    /// Begins, in an empty file.
    pub fn new(file: D, layout: &Layout, about: &Value) -> io::Result<Self> {
        let mut columns = columns(layout);
        let group_rows = GROUP_BYTES / columns.iter().map(Column::row_bytes).sum::<usize>();
        columns.iter_mut().for_each(|c| c.reserve(group_rows));
        let schema: String = columns.iter().map(Column::schema).collect();
        let schema =
            parse_message_type(&format!("message endat {{ {schema} }}")).map_err(broken)?;
        let mut properties = WriterProperties::builder()
            .set_created_by(concat!("endat ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_statistics_enabled(EnabledStatistics::None)
            .set_offset_index_disabled(true);
        // A reader that looks for a time need not read all groups; of positions the least and the greatest are of no use.
        for column in ["trigger", "cycles"] {
            let all = EnabledStatistics::Chunk;
            properties = properties.set_column_statistics_enabled(column.into(), all);
        }
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
            group_rows,
            waiting: 0,
            since: Instant::now(),
            rows: 0,
            groups: 0,
            end: 0,
            sum: seal::sum(),
            footer: Vec::new(),
        };
        new.give()?;
        Ok(new)
    }

    /// Bytes until now, without the rows in memory.
    pub fn bytes(&self) -> u64 {
        self.end + self.footer.len() as u64
    }

    /// Groups until now.
    pub fn groups(&self) -> u32 {
        self.groups
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
        match self.waiting == self.group_rows {
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
            column.write(&mut to, &self.words).map_err(broken)?;
            to.close().map_err(broken)?;
        }
        group.close().map_err(broken)?;
        self.rows += self.waiting as i64;
        self.groups += 1;
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
        let mut sum = self.sum.clone();
        sum.update(&group);
        let groups = self.end + group.len() as u64;
        let footer = seal::seal(sum.clone(), groups, &self.footer_now()?);
        let whole = self.end + (group.len() + footer.len()) as u64;
        let spare = whole.max(self.end + self.footer.len() as u64);
        let mut put = || -> io::Result<()> {
            if !self.footer.is_empty() {
                self.file.seek(SeekFrom::Start(spare))?;
                self.file.write_all(&self.footer)?;
            }
            self.file.seek(SeekFrom::Start(self.end))?;
            self.file.write_all(&group)?;
            self.file.write_all(&footer)?;
            self.file.cut(whole)
        };
        if let Err(error) = put() {
            // What is cut off makes room for what stood there.
            let _ = self.file.cut(self.end);
            let mut put = |at: u64| -> io::Result<()> {
                self.file.seek(SeekFrom::Start(at))?;
                self.file.write_all(&self.footer)
            };
            let _ = put(self.end);
            return Err(error);
        }
        self.end += group.len() as u64;
        self.footer = footer;
        self.sum = sum;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
