//! What a channel that speaks SSI becomes.

use crate::explain::rate::{rate, us_of, Rate};
use crate::protocols::OtherReport;
use endat_draw::decimal;
use endat_hdl::config::{CardConfig, ChannelConfig, DELAY_NS_PER_M};
use endat_hdl::protocols::ssi::protocol::bit_delay_most_ns;
use endat_hdl::protocols::ssi::specials::Special;
use endat_hdl::protocols::SsiSpec;
use endat_regs::Protocol;
use serde::Serialize;
use serde_json::json;
use std::fmt::{self, Write};

/// One SSI channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SsiReport {
    /// Encoder, for people.
    pub encoder: String,
    /// Protocol.
    pub protocol: &'static str,
    /// Clock on the line.
    pub clock: Rate,
    /// Its period in system clock cycles.
    pub period_cycles: u64,
    /// Width of the position.
    pub position_bits: u32,
    /// It comes in Gray code.
    pub gray: bool,
    /// A bit behind it: none, even, odd.
    pub parity: String,
    /// It comes twice, and both are compared.
    pub twice: bool,
    /// Special bits before the position.
    pub bits_before: Vec<&'static str>,
    /// Bits after it.
    pub bits_after: Vec<&'static str>,
    /// DATA is LOW after the last bit.
    pub end_low: bool,
    /// Falling edges of the clock in a frame.
    pub clocks: u64,
    /// From its first edge to the result, in microseconds.
    pub frame_us: f64,
    /// Longest time from a clock edge to its bit that the port takes, both ways along the cable included, in ns.
    pub bit_delay_max_ns: u64,
    /// How much of it the encoder needs, in ns.
    pub bit_delay_ns: u64,
    /// And the longest cable, both ways, in ns.
    pub cable_ns: u64,
    /// Longest recovery time (monoflop time), in microseconds.
    pub recovery_max_us: f64,
    /// Both, and the cable: what the configuration is checked against, in microseconds.
    pub cycle_us: f64,
    /// Sampling rate that it allows, in hertz.
    pub worst_case_sampling_hz: f64,
    /// Pulses up to this are ignored, in ns.
    pub filter_ns: f64,
}

impl SsiReport {
    pub(super) fn new(
        card: &CardConfig,
        config: &ChannelConfig,
        asked: &SsiSpec,
        encoder: &str,
    ) -> Self {
        let us = |cycles: u64| us_of(cycles, card.system_hz);
        let cycles = config.cycle_max_cycles(card.system_hz);
        let cycle_us = us(cycles);
        Self {
            encoder: encoder.into(),
            protocol: Protocol::Ssi.row().word,
            clock: Rate::new(config.spec.clock_hz, config.actual_hz(card.system_hz)),
            period_cycles: config.period_cycles,
            position_bits: config.position_bits,
            gray: asked.gray,
            parity: format!("{:?}", asked.parity).to_lowercase(),
            twice: asked.twice,
            bits_before: asked.before.iter().map(Special::word).collect(),
            bits_after: asked.after.iter().map(Special::word).collect(),
            end_low: !asked.holds_end,
            clocks: asked.clocks(config.position_bits),
            frame_us: us(cycles - config.recovery_limit_cycles),
            bit_delay_max_ns: bit_delay_most_ns(
                config.period_cycles,
                config.filter_cycles,
                card.system_hz,
            ),
            bit_delay_ns: asked.bit_delay_ns,
            cable_ns: DELAY_NS_PER_M * config.spec.cable_m,
            recovery_max_us: config.spec.recovery_max_ns as f64 / 1e3,
            cycle_us,
            worst_case_sampling_hz: 1e6 / cycle_us,
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

    /// Whether a special bit checks the position.
    fn has_check(&self) -> bool {
        let is_check = |word: &&str| {
            let row = Special::ALL.iter().find(|(_, is, _)| is == word);
            row.is_some_and(|(special, ..)| special.is_check())
        };
        self.bits_after.iter().any(is_check)
    }

    /// The lines of channel `index`.
    fn write(&self, f: &mut String, index: usize) -> fmt::Result {
        let encoder = match self.encoder.as_str() {
            "" => String::new(),
            encoder => format!(", {encoder}"),
        };
        writeln!(f, "{:<18} SSI{encoder}", format!("channel {index}"))?;
        writeln!(
            f,
            "  clock            {}; {} cycles in a period",
            rate(&self.clock, "Hz"),
            self.period_cycles
        )?;
        let code = if self.gray { " in Gray code" } else { "" };
        let twice = match self.twice {
            true => ", sent twice and compared",
            false if self.parity != "none" || self.has_check() => "",
            false => ", nothing to check it by: see twice and parity",
        };
        let parity = match self.parity.as_str() {
            "none" => String::new(),
            parity => format!(", {parity} parity"),
        };
        writeln!(
            f,
            "  position         {} bits{code}{parity}{twice}; {} clocks, {} us to the result",
            self.position_bits,
            self.clocks,
            decimal(self.frame_us, 1)
        )?;
        for (place, bits) in [("before", &self.bits_before), ("after", &self.bits_after)] {
            if !bits.is_empty() {
                writeln!(f, "  {:<16} {}", format!("bits {place}"), bits.join(" "))?;
            }
        }
        if !self.end_low {
            writeln!(
                f,
                "  end              DATA keeps the last bit: a wrong width is not seen, and each frame waits for the whole recovery time"
            )?;
        }
        writeln!(
            f,
            "  bits             taken up to {} ns after their clock edge; {} ns in the encoder and {} ns in the cable, both ways, are needed",
            self.bit_delay_max_ns, self.bit_delay_ns, self.cable_ns
        )?;
        writeln!(
            f,
            "  longest cycle    {} us with a recovery time of {} us: {} Hz",
            decimal(self.cycle_us, 1),
            decimal(self.recovery_max_us, 1),
            decimal(self.worst_case_sampling_hz.floor(), 0)
        )?;
        writeln!(f, "  input filter     {} ns", decimal(self.filter_ns, 1))
    }
}
