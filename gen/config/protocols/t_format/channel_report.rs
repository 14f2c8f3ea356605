//! What a channel that speaks T-format becomes.

use crate::explain::rate::{rate, us_of, Rate};
use crate::protocols::OtherReport;
use endat_draw::decimal;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_hdl::protocols::t_format::protocol::{REST_US, WAIT_GRACE_US};
use endat_hdl::protocols::TFormatSpec;
use endat_regs::Protocol;
use serde::Serialize;
use serde_json::json;
use std::fmt::{self, Write};

/// One T-format channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TFormatReport {
    /// Encoder, for people.
    pub encoder: String,
    /// Protocol.
    pub protocol: &'static str,
    /// Bit rate.
    pub bit_rate: Rate,
    /// A bit in system clock cycles.
    pub bit_cycles: u64,
    /// Request ID of a trigger.
    pub request: u8,
    /// Fields sent and received.
    pub fields: [usize; 2],
    /// Both on the line, without the pause between them, in microseconds.
    pub wire_us: f64,
    /// Longest pause before a reply, in microseconds.
    pub reply_gap_us: u64,
    /// Longest pause between fields, in microseconds.
    pub field_gap_us: u64,
    /// The longest exchange within these pauses, with the rest behind it, in microseconds: what the configuration is checked against.
    pub exchange_us: f64,
    /// Sampling rate that it allows, in hertz.
    pub worst_case_sampling_hz: f64,
    /// Pulses up to this are ignored, in ns.
    pub filter_ns: f64,
}

impl TFormatReport {
    pub(super) fn new(
        card: &CardConfig,
        config: &ChannelConfig,
        t_format: &TFormatSpec,
        encoder: &str,
    ) -> Self {
        let us = |cycles: u64| us_of(cycles, card.system_hz);
        let request = t_format.request;
        let exchange_us = us(config.cycle_max_cycles(card.system_hz));
        Self {
            encoder: encoder.into(),
            protocol: Protocol::TFormat.row().word,
            bit_rate: Rate::new(t_format.bit_hz, config.actual_hz(card.system_hz)),
            bit_cycles: config.period_cycles,
            request: request.id(),
            fields: [request.sent().len(), request.reply().len()],
            wire_us: us(request.wire_bits() * config.period_cycles),
            reply_gap_us: t_format.reply_gap_us,
            field_gap_us: t_format.field_gap_us,
            exchange_us,
            worst_case_sampling_hz: 1e6 / exchange_us,
            filter_ns: us(config.filter_cycles) * 1e3,
        }
    }

    /// The same for a report of all channels.
    pub(super) fn as_channel(&self, index: usize) -> OtherReport {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = self.write(&mut text, index);
        OtherReport {
            data: json!(self),
            text,
        }
    }

    /// The lines of channel `index`.
    fn write(&self, f: &mut String, index: usize) -> fmt::Result {
        let encoder = match self.encoder.as_str() {
            "" => String::new(),
            encoder => format!(", {encoder}"),
        };
        writeln!(f, "{:<18} T-format{encoder}", format!("channel {index}"))?;
        writeln!(
            f,
            "  bit rate         {}; {} cycles in a bit",
            rate(&self.bit_rate, "bit/s"),
            self.bit_cycles
        )?;
        writeln!(
            f,
            "  request          {:X}: {} fields out, {} in, {} us on the line",
            self.request,
            self.fields[0],
            self.fields[1],
            decimal(self.wire_us, 1)
        )?;
        writeln!(
            f,
            "  pauses           reply taken up to {} us after the request, refused from {} us on; fields apart by up to {} us",
            self.reply_gap_us,
            self.reply_gap_us + WAIT_GRACE_US,
            self.field_gap_us
        )?;
        writeln!(
            f,
            "  longest exchange {} us with a rest of {REST_US} us: {} Hz",
            decimal(self.exchange_us, 1),
            decimal(self.worst_case_sampling_hz.floor(), 0)
        )?;
        writeln!(f, "  input filter     {} ns", decimal(self.filter_ns, 1))
    }
}
