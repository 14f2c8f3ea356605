//! The table `[stream]`.

use super::reader::{At, Table};
use endat_hdl::config::{limits, StreamParts, StreamStart};
use endat_hdl::stream::buffer::BUFFER_BYTES;

/// What was written for the stream; what could not be read is missing, and has been complained about.
pub struct Written {
    pub fifo_bytes: Option<At<u64>>,
    pub start: Option<At<String>>,
    pub informations: Option<At<bool>>,
    /// As far as it could be read.
    pub parts: StreamParts,
}

/// Words for what a stream does after reset.
const STARTS: [(&str, StreamStart); 3] = [
    ("off", StreamStart::Off),
    ("collect", StreamStart::Collect),
    ("push", StreamStart::Push),
];

/// What a stream does after reset, as it is written.
pub fn start_name(start: StreamStart) -> &'static str {
    let found = STARTS.iter().find(|(_, s)| *s == start);
    found.map_or("", |(name, _)| name)
}

/// Reads the table; everything in it may be left out.
pub fn read(table: &Table<'_, '_>) -> Written {
    let fifo_bytes = table.integer("fifo_bytes", &limits("fifo_bytes", None));
    table.offer([0].iter().chain(&BUFFER_BYTES));
    let informations = table.boolean("informations");
    let start = table.string("start");
    table.offer(STARTS.map(|(name, _)| name));
    let mut parts = StreamParts {
        fifo_bytes: fifo_bytes.as_ref().map_or(0, |b| b.value),
        start: StreamStart::Off,
        informations: informations.as_ref().is_some_and(|i| i.value),
    };
    if let Some(word) = &start {
        match STARTS.iter().find(|(name, _)| *name == word.value) {
            Some((_, start)) => parts.start = *start,
            None => table.complain(
                word.line,
                "start",
                &format!("{:?}", word.value),
                "unknown; use off, collect, push",
            ),
        }
    }
    // A size that could not be read has its complaint; the start would only repeat it.
    if table.has("fifo_bytes") && fifo_bytes.is_none() {
        parts.start = StreamStart::Off;
    }
    Written {
        fifo_bytes,
        start,
        informations,
        parts,
    }
}
