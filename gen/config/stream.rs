//! The table `[stream]`.

use super::keys::{ADDITIONAL_DATA, FIFO_BYTES, STREAM_START};
use super::reader::{At, Table};
use super::words;
use endat_hdl::config::{StreamParts, StreamStart};

/// What was written for the stream; what could not be read is missing, and has been complained about.
pub struct Written {
    pub fifo_bytes: Option<At<u64>>,
    pub start: Option<At<String>>,
    pub additional_data: Option<At<bool>>,
    /// As far as it could be read.
    pub parts: StreamParts,
}

/// Reads the table; everything in it may be left out.
pub fn read(table: &Table<'_, '_>) -> Written {
    let fifo_bytes = table.integer(&FIFO_BYTES, &FIFO_BYTES.limits(None));
    let additional_data = table.boolean(&ADDITIONAL_DATA);
    let start = table.string(&STREAM_START);
    let mut parts = StreamParts {
        fifo_bytes: fifo_bytes
            .as_ref()
            .map_or(FIFO_BYTES.usual_number(), |b| b.value),
        start: StreamStart::Off,
        additional_data: additional_data.as_ref().is_some_and(|i| i.value),
    };
    if let Some(word) = &start {
        match words::start(&word.value) {
            Some(start) => parts.start = start,
            None => {
                let text = format!("unknown; use {}", STREAM_START.words().join(", "));
                let shown = format!("{:?}", word.value);
                table.complain(word.line, STREAM_START.name, &shown, &text);
            }
        }
    }
    // A size that could not be read has its complaint; the start would only repeat it.
    if table.has(FIFO_BYTES.name) && fifo_bytes.is_none() {
        parts.start = StreamStart::Off;
    }
    Written {
        fifo_bytes,
        start,
        additional_data,
        parts,
    }
}
