//! Recordings as Parquet: integers as deltas, so that an hour of two channels at 10 kHz is some hundred megabytes.
//!
//! Rows are collected into groups. Behind each group stands what makes the file whole, and the next group takes its place. The old end is
//! written once more behind the place of the new one, and cut off when that is there: whatever ends the program, and whenever, all but the
//! last group is there.

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

/// Rows of a group: 13 s at 10 kHz.
pub const GROUP_ROWS: usize = 131_072;
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
    /// Rows in memory, since when, and those in the file.
    waiting: usize,
    since: Instant,
    rows: i64,
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
mod tests {
    use super::super::layout::DerivedColumn;
    use super::super::picture::Measurement;
    use super::super::read::read_all;
    use super::*;
    use endat_driver::AdditionalData as Info;
    use endat_host::feed::{Cell, Row};
    use endat_host::units::Scale;
    use serde_json::json;
    use std::io::Cursor;

    fn about() -> Value {
        let channel = json!({"unit": "deg", "steps_per_turn": 1u64 << 48, "range": 1u64 << 48});
        json!({"system_hz": 1_000, "channels": [channel], "columns": {"v_deg": {"unit": "deg"}}})
    }

    fn layout() -> Layout {
        Layout {
            scales: vec![Scale::singleturn(48)],
            additional_data: true,
            derived: vec![DerivedColumn {
                name: "v".into(),
                unit: "deg".into(),
                digits: None,
            }],
        }
    }

    fn entry(n: u64) -> Entry {
        let info = Info {
            content: n as u16,
            ..Info::default()
        };
        let is_good = n % 7 != 3;
        Entry {
            row: Row {
                run: (n == 5).then_some(0),
                trigger: n + 1_000,
                cycles: n * 10,
                missing: n % 3,
                cells: vec![Cell {
                    position: is_good.then_some((1 << 48) - 50 + n),
                    fresh: is_good,
                    cause: if is_good { "none" } else { "crc" },
                    infos: [Some(info), None],
                }],
            },
            values: vec![is_good.then_some(n as f64 / 8.0)],
        }
    }

    fn read(bytes: &[u8]) -> Vec<Measurement> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        let mut rows = Vec::new();
        read_all(&[file.path().to_owned()], &mut |_, row| rows.push(row)).unwrap();
        rows
    }

    /// The same of what may have none.
    fn rows_of(bytes: &[u8]) -> Option<Vec<Measurement>> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        let mut rows = Vec::new();
        read_all(&[file.path().to_owned()], &mut |_, row| rows.push(row)).ok()?;
        Some(rows)
    }

    fn assert_rows(rows: &[Measurement], count: u64) {
        assert_eq!(rows.len() as u64, count);
        for (n, row) in rows.iter().enumerate() {
            let Entry {
                row: wanted,
                values,
            } = entry(n as u64);
            let trigger = wanted.run.is_none().then_some(wanted.trigger);
            assert_eq!((row.trigger, row.missing), (trigger, wanted.missing));
            assert!((row.time_s - n as f64 * 0.01).abs() < 1e-12);
            let (cell, other) = (&row.cells[0], &wanted.cells[0]);
            assert_eq!((cell.raw, cell.fresh), (other.position, other.fresh));
            assert_eq!((&*cell.cause, &row.derived), (other.cause, &values));
        }
    }

    /// A disk with room for so many bytes.
    #[derive(Clone)]
    struct Small(Cursor<Vec<u8>>, usize);

    impl Write for Small {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let room = self.1.saturating_sub(self.0.position() as usize);
            match bytes.len().min(room) {
                0 => Err(io::ErrorKind::StorageFull.into()),
                count => self.0.write(&bytes[..count]),
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Small {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.0.seek(to)
        }
    }

    impl Disk for Small {
        fn cut(&mut self, bytes: u64) -> io::Result<()> {
            self.0.get_mut().truncate(bytes as usize);
            Ok(())
        }
    }

    /// A disk of a computer on which the program is killed behind so many writes.
    #[derive(Clone)]
    struct Killed(Cursor<Vec<u8>>, usize);

    impl Killed {
        fn is_alive(&mut self) -> bool {
            let alive = self.1 > 0;
            self.1 = self.1.saturating_sub(1);
            alive
        }
    }

    impl Write for Killed {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            match self.is_alive() {
                true => self.0.write(bytes),
                false => Ok(bytes.len()),
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Killed {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.0.seek(to)
        }
    }

    impl Disk for Killed {
        fn cut(&mut self, bytes: u64) -> io::Result<()> {
            if self.is_alive() {
                self.0.get_mut().truncate(bytes as usize);
            }
            Ok(())
        }
    }

    /// Catches a file that is lost as a whole because its end is written over while the program is killed.
    #[test]
    fn a_program_that_is_killed_at_any_write_loses_the_last_group_only() {
        for writes in 3..30 {
            let disk = Killed(Cursor::default(), writes);
            let mut file = ParquetFile::new(disk, &layout(), &about()).unwrap();
            let mut wanted = 0;
            for n in 0..500 {
                file.row(&entry(n)).unwrap();
                if n % 100 == 99 {
                    file.flush().unwrap();
                    // What was alive behind it has all of it.
                    wanted = if file.file.1 > 0 { n + 1 } else { wanted };
                }
            }
            let bytes = file.file.0.get_ref();
            let state = seal::state(&mut Cursor::new(bytes)).unwrap();
            assert_eq!(state, seal::State::Whole, "{writes}");
            let kept = rows_of(bytes).map_or(0, |rows| rows.len() as u64);
            assert!(
                (wanted..=wanted + 100).contains(&kept),
                "{writes}: {kept} of {wanted}"
            );
        }
    }

    /// Catches a file that is lost with its disk, or with the program, and not only with its last group.
    #[test]
    fn a_file_is_whole_behind_every_group_and_on_a_full_disk() {
        let whole = {
            let disk = Small(Cursor::default(), usize::MAX);
            let mut file = ParquetFile::new(disk, &layout(), &about()).unwrap();
            for n in 0..300 {
                file.row(&entry(n)).unwrap();
                if n % 100 == 99 {
                    file.flush().unwrap();
                    assert_rows(&read(file.file.0.get_ref()), n + 1);
                }
            }
            file.file.0.into_inner().len()
        };
        for room in (whole / 2..whole).step_by(97) {
            let disk = Small(Cursor::default(), room);
            let mut file = ParquetFile::new(disk, &layout(), &about()).unwrap();
            let mut kept = 0;
            let full = (0..300).try_for_each(|n| {
                file.row(&entry(n))?;
                if n % 100 == 99 {
                    file.flush()?;
                    kept = n + 1;
                }
                Ok::<(), io::Error>(())
            });
            assert_eq!(
                full.map_err(|e| e.kind()),
                Err(io::ErrorKind::StorageFull),
                "{room}"
            );
            if kept > 0 {
                assert_rows(&read(file.file.0.get_ref()), kept);
            }
        }
    }
}
