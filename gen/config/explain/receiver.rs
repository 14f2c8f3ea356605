//! What a receiver's configuration becomes, as text and as data.

use crate::Receiver;
use endat_draw::decimal;
use endat_hdl::protocols::t_format::protocol::{
    Request, BIT_HZ, FAST_BIT_HZ, FIELD_BITS, SYSTEM_HZ, WAIT_GRACE_US,
};
use endat_regs::Protocol;
use serde::Serialize;
use std::fmt;

/// What follows from one of the two clocks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClockReport {
    /// Level of `clk_select_i`.
    pub clk_select: bool,
    /// System clock, in hertz.
    pub system_hz: u64,
    /// Samples of a bit.
    pub bit_cycles: u64,
    /// Longest pulse that is ignored, in ns.
    pub filter_ns: f64,
}

/// A request.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RequestReport {
    /// ID.
    pub id: u8,
    /// Fields sent and received.
    pub fields: [usize; 2],
    /// Both on the line, without the pause between them, in microseconds.
    pub wire_us: f64,
    /// Exchanges in a second when the pause is as long as it may be, in hertz.
    pub sure_sampling_hz: f64,
}

/// Everything that `explain` shows of a receiver.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Name of the configuration.
    pub name: String,
    /// First 12 hexadecimal digits of the SHA-256 of the resolved configuration.
    pub config_hash: String,
    /// Protocol.
    pub protocol: &'static str,
    /// What stands between the results and the host.
    pub bus: &'static str,
    /// Encoder, for people.
    pub encoder: String,
    /// Bit rate, in bits per second.
    pub bit_hz: u64,
    /// What the two clocks give.
    pub clocks: Vec<ClockReport>,
    /// Request before one is written.
    pub request: u8,
    /// Longest pause before a reply, in microseconds.
    pub reply_gap_us: u64,
    /// Longest pause between fields, in microseconds.
    pub field_gap_us: u64,
    /// All requests.
    pub requests: Vec<RequestReport>,
}

/// The report of a receiver.
pub fn report(receiver: &Receiver) -> Report {
    let start = &receiver.start;
    let bit_hz = if start.fast { FAST_BIT_HZ } else { BIT_HZ };
    let us = |bits: u64| bits as f64 * 1e6 / bit_hz as f64;
    let request = |request: &Request| {
        let (sent, reply) = (request.sent().len(), request.reply().len());
        let wire_us = us(request.wire_bits());
        let gaps_us = start.reply_gap_us + start.field_gap_us * (reply as u64 - 1);
        RequestReport {
            id: request.id(),
            fields: [sent, reply],
            wire_us,
            // Half a bit passes before the start bit, and a microsecond for all that is synchronised.
            sure_sampling_hz: 1e6 / (wire_us + us(1) + gaps_us as f64 + 1.0),
        }
    };
    let clock = |(select, system_hz): (usize, &u64)| ClockReport {
        clk_select: select == 1,
        system_hz: *system_hz,
        bit_cycles: system_hz / bit_hz,
        filter_ns: start.filter_cycles as f64 * 1e9 / *system_hz as f64,
    };
    Report {
        name: receiver.name.clone(),
        config_hash: receiver.hash.clone(),
        protocol: Protocol::TFormat.row().word,
        bus: crate::RECEIVER_BUS,
        encoder: receiver.encoder.clone(),
        bit_hz,
        clocks: SYSTEM_HZ.iter().enumerate().map(clock).collect(),
        request: start.request_id,
        reply_gap_us: start.reply_gap_us,
        field_gap_us: start.field_gap_us,
        requests: Request::ALL.iter().map(request).collect(),
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{}: T-format receiver, configuration {}",
            self.name, self.config_hash
        )?;
        if !self.encoder.is_empty() {
            writeln!(f, "encoder        {}", self.encoder)?;
        }
        let field_us = FIELD_BITS as f64 * 1e6 / self.bit_hz as f64;
        let field_us = decimal(field_us, 1);
        writeln!(
            f,
            "line           {} bit/s, a field of 10 bits takes {field_us} us",
            self.bit_hz
        )?;
        for clock in &self.clocks {
            writeln!(
                f,
                "clk_select {}   {} MHz, {} samples in a bit, pulses up to {} ns are ignored",
                u8::from(clock.clk_select),
                clock.system_hz / 1_000_000,
                clock.bit_cycles,
                decimal(clock.filter_ns, 1)
            )?;
        }
        writeln!(
            f,
            "reply          taken up to {} us after the request, refused from {} us on",
            self.reply_gap_us,
            self.reply_gap_us + WAIT_GRACE_US
        )?;
        writeln!(f, "fields         apart by up to {} us", self.field_gap_us)?;
        writeln!(
            f,
            "trigger pin    sends request {:X} until another is written",
            self.request
        )?;
        writeln!(
            f,
            "\nrequest  fields out, in  on the line  exchanges a second, longest pauses"
        )?;
        for r in &self.requests {
            writeln!(
                f,
                "{:<8X} {:<15} {:<12} {}",
                r.id,
                format!("{}, {}", r.fields[0], r.fields[1]),
                format!("{} us", decimal(r.wire_us, 1)),
                r.sure_sampling_hz as u64
            )?;
        }
        Ok(())
    }
}
