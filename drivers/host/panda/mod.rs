//! The TCP protocol of PandABlocks, as far as clients need it to find, arm and record a card.
//!
//! ```text
//! control port   *IDN?  *BLOCKS?  *DESC.X?  X.*?  *CAPTURE?  *PCAP.ARM=  *PCAP.DISARM= ...     one line, or lines after '!'
//! data port      XML FRAMED RAW -> OK, <header>, BIN <length> <samples> ..., END <count> <reason>
//! ```
//!
//! Ref: PandABlocks-server, `docs/capture.rst` and `docs/commands.rst`; the client `pandablocks` reads little-endian data.

mod client;
mod control;
mod data;
mod server;

pub use server::{Ports, Server, CONTROL_PORT, DATA_PORT};

use crate::causes;
use crate::feed::{Row, LATE, NOT_TAKEN, TOO_LATE};
use crate::units::Scale;

/// A column of the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name, as `BLOCK.FIELD`.
    pub name: String,
    /// Factor of a raw number.
    pub scale: f64,
    /// Unit of the scaled number.
    pub unit: &'static str,
    /// One sentence.
    pub meaning: &'static str,
    what: What,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Time,
    Trigger,
    Position(usize, Scale),
    Fresh(usize),
    Cause(usize),
    Info(usize, usize),
}

/// Texts of a feed instead of a cause, after the causes of the protocols.
const OF_ROWS: [&str; 3] = [NOT_TAKEN, TOO_LATE, LATE];
const OF_ROWS_FIRST: usize = 2 * causes::CODES as usize;

fn code(cause: &str) -> i64 {
    let of_row = OF_ROWS.iter().position(|name| *name == cause);
    match of_row {
        Some(index) => (OF_ROWS_FIRST + index) as i64,
        None => causes::number(cause).map_or(0, i64::from),
    }
}

impl Column {
    /// The columns of a card; `additional_data` adds the columns for these.
    pub fn all(system_hz: u32, scales: &[Scale], additional_data: bool) -> Vec<Self> {
        let mut columns = vec![
            Self {
                name: "PCAP.TS_TRIG".into(),
                scale: 1.0 / f64::from(system_hz.max(1)),
                unit: "s",
                meaning: "Time of the trigger since the first one of the acquisition, in the card's clock",
                what: What::Time,
            },
            Self {
                name: "TRIGGER.COUNT".into(),
                scale: 1.0,
                unit: "",
                meaning: "Number of the trigger",
                what: What::Trigger,
            },
        ];
        for (channel, scale) in scales.iter().enumerate() {
            let one = scale.convert(1);
            columns.push(Self {
                name: format!("INENC{}.VAL", channel + 1),
                // The number includes whole turns.
                scale: scale.step(),
                unit: one.unit,
                meaning: "Last good position",
                what: What::Position(channel, *scale),
            });
            columns.push(Self {
                name: format!("INENC{}.FRESH", channel + 1),
                scale: 1.0,
                unit: "",
                meaning:
                    "1: this trigger brought the position; 0: it is an older one, or there is none",
                what: What::Fresh(channel),
            });
            columns.push(Self {
                name: format!("INENC{}.CAUSE", channel + 1),
                scale: 1.0,
                unit: "",
                meaning: "Cause of a missing position, as in the register map, 0 = none; 32: trigger not taken, 33: result too late, 34: the late result of an earlier trigger",
                what: What::Cause(channel),
            });
            let infos = if additional_data { 2 } else { 0 };
            columns.extend((0..infos).map(|info| Self {
                name: format!("INENC{}.INFO{}", channel + 1, info + 1),
                scale: 1.0,
                unit: "",
                meaning: "Additional data of the same frame: bits 23..16 WRN, RM, Busy, I4..I0, bits 15..0 content; -1: none received with a right CRC",
                what: What::Info(channel, info),
            }));
        }
        columns
    }

    fn raw(&self, row: &Row) -> i64 {
        let cell = |channel: usize| row.cells.get(channel);
        match self.what {
            What::Time => row.cycles as i64,
            What::Trigger => row.trigger as i64,
            What::Position(n, scale) => {
                let position = cell(n).and_then(|c| c.position).unwrap_or(0);
                (if scale.is_known() {
                    scale.steps(position)
                } else {
                    position
                }) as i64
            }
            What::Fresh(n) => cell(n).is_some_and(|c| c.fresh).into(),
            What::Cause(n) => cell(n).map_or(0, |c| code(c.cause)),
            What::Info(n, info) => {
                let good = cell(n).and_then(|c| c.infos[info]);
                good.map_or(-1, |i| i64::from(i.status) << 16 | i64::from(i.content))
            }
        }
    }
}
