//! What a stream makes of the line.

use crate::start_name;
use endat_draw::decimal;
use endat_hdl::card::stream::buffer::frame_bytes;
use endat_hdl::config::{stream_baud, CardConfig};
use serde::Serialize;
use std::fmt;

/// The stream of sample sets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StreamReport {
    /// Bytes of the buffer.
    pub fifo_bytes: u64,
    /// Bytes of a frame on the line.
    pub frame_bytes: u64,
    /// Whole frames that the buffer holds.
    pub buffered_sets: u64,
    /// What it does after reset.
    pub start: &'static str,
    /// Sets per second: the sampling rate.
    pub sets_per_second: f64,
    /// On the UART, if there is one.
    pub line: Option<StreamLine>,
}

/// A stream on a UART.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StreamLine {
    /// Bits per second that pushing takes.
    pub needed_baud: u64,
    /// Share of the line.
    pub used_percent: f64,
    /// Most sets per second that the line carries.
    pub highest_hz: f64,
}

impl StreamReport {
    /// That of a card, if it has a stream; `has_uart`: its host is behind a UART.
    pub fn of(card: &CardConfig, has_uart: bool) -> Option<Self> {
        let bytes = card.stream.fifo_bytes;
        let channels = card.channels.len();
        let sets_per_second = card.actual_sample_hz();
        let additional_data = card.stream.additional_data;
        let set_bits = stream_baud(1, channels, additional_data) as f64;
        let frame_bytes = frame_bytes(channels, additional_data);
        (bytes != 0).then(|| Self {
            fifo_bytes: bytes,
            frame_bytes,
            buffered_sets: (bytes - 1) / frame_bytes,
            start: start_name(card.stream.start),
            sets_per_second,
            line: has_uart.then(|| StreamLine {
                needed_baud: (sets_per_second * set_bits).ceil() as u64,
                used_percent: 100.0 * sets_per_second * set_bits / card.actual_baud(),
                highest_hz: card.actual_baud() / set_bits,
            }),
        })
    }
}

impl fmt::Display for StreamReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "stream             {} bytes a set, {} sets in {} bytes, start: {}",
            self.frame_bytes, self.buffered_sets, self.fifo_bytes, self.start
        )?;
        match &self.line {
            Some(line) => writeln!(
                f,
                "; pushed at {} Hz: {} bit/s, {} % of the link; at most {} a second",
                decimal(self.sets_per_second, 0),
                line.needed_baud,
                decimal(line.used_percent, 1),
                decimal(line.highest_hz.floor(), 0)
            ),
            None => writeln!(f, "; read from stream_data"),
        }
    }
}
