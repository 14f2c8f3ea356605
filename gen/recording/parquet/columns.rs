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
    Word(Vec<ByteArray>),
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

/// Names that have come, and their bytes.
pub(super) type Words = Vec<(&'static str, ByteArray)>;

/// The bytes of a name are there once, however many rows have it.
fn word(name: &'static str, words: &mut Words) -> ByteArray {
    if let Some((_, known)) = words.iter().find(|(known, _)| std::ptr::eq(*known, name)) {
        return known.clone();
    }
    let new = ByteArray::from(name);
    words.push((name, new.clone()));
    new
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
