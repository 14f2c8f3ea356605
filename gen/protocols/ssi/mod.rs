//! SSI, as a channel of a card speaks it: keys, report, bench, encoder of a virtual card.

mod bench_parts;
mod channel_report;
mod encoder;
pub mod keys;
pub(crate) mod protocol;
mod reading;
