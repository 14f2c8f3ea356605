//! Columns of a group of rows, in memory.

use super::super::layout::{of_channel, DerivedColumn, Layout};
use parquet::basic::Encoding;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::writer::SerializedColumnWriter;

/// Values of a column; where a column may have none, which rows have one.
pub(super) enum Store {
    Long(Vec<i64>),
    Int(Vec<i32>),
    Double(Vec<f64>),
    Flag(Vec<bool>),
    /// Places in the list of names.
    Word(Vec<u8>),
}

pub(super) struct Column {
    pub(super) name: String,
    store: Store,
    /// 1 where there is a value; none of a column that always has one.
    levels: Option<Vec<i16>>,
}

/// A value of a row.
pub(super) enum Item {
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

    /// Bytes of a row in memory.
    pub(super) fn row_bytes(&self) -> usize {
        let value = match self.store {
            Store::Long(_) | Store::Double(_) => 8,
            Store::Int(_) => 4,
            Store::Flag(_) | Store::Word(_) => 1,
        };
        value + if self.levels.is_some() { 2 } else { 0 }
    }

    /// Room for so many rows, so that memory does not grow later.
    pub(super) fn reserve(&mut self, rows: usize) {
        match &mut self.store {
            Store::Long(all) => all.reserve_exact(rows),
            Store::Int(all) => all.reserve_exact(rows),
            Store::Double(all) => all.reserve_exact(rows),
            Store::Flag(all) => all.reserve_exact(rows),
            Store::Word(all) => all.reserve_exact(rows),
        }
        if let Some(levels) = &mut self.levels {
            levels.reserve_exact(rows);
        }
    }

    /// As the parser of schemas reads it.
    pub(super) fn schema(&self) -> String {
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

    pub(super) fn encoding(&self) -> Option<Encoding> {
        match self.store {
            Store::Long(_) | Store::Int(_) => Some(Encoding::DELTA_BINARY_PACKED),
            Store::Flag(_) => Some(Encoding::RLE),
            Store::Double(_) => Some(Encoding::PLAIN),
            // A dictionary: a name stands once in a group.
            Store::Word(_) => None,
        }
    }

    pub(super) fn push(&mut self, item: Item, words: &mut Words) {
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

    pub(super) fn write(
        &mut self,
        to: &mut SerializedColumnWriter<'_>,
        words: &Words,
    ) -> Result<(), ParquetError> {
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
                for some in all.chunks(WORDS_AT_ONCE) {
                    let some = some
                        .iter()
                        .map(|place| words[usize::from(*place)].1.clone());
                    let some: Vec<ByteArray> = some.collect();
                    to.typed::<ByteArrayType>().write_batch(&some, None, None)?;
                }
                all.clear();
            }
        }
        if let Some(levels) = &mut self.levels {
            levels.clear();
        }
        Ok(())
    }
}

/// Names that have come, and their bytes.
pub(super) type Words = Vec<(&'static str, ByteArray)>;

/// Names are written in pieces of so many rows.
const WORDS_AT_ONCE: usize = 8_192;

/// The place of a name in the list; there are fewer than a byte tells apart.
fn word(name: &'static str, words: &mut Words) -> u8 {
    let known = words.iter().position(|(known, _)| *known == name);
    let place = known.unwrap_or_else(|| {
        words.push((name, ByteArray::from(name)));
        words.len() - 1
    });
    place.min(u8::MAX.into()) as u8
}

/// The columns of a recording.
pub(super) fn columns(layout: &Layout) -> Vec<Column> {
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
