//! The report as text.

use super::rate::rate;
use super::{AnyChannelReport, ChannelReport, Report};
use endat_draw::decimal;
use std::fmt;

/// One row of the channel table: heading, and the cell of a channel.
type Row = (&'static str, fn(&ChannelReport) -> String);

const ROWS: [Row; 18] = [
    ("encoder", |c| {
        if c.encoder.is_empty() {
            "-".into()
        } else {
            c.encoder.clone()
        }
    }),
    ("mode command", |c| c.command.clone()),
    ("position", |c| {
        let unit = if c.position_bits == 1 { "bit" } else { "bits" };
        format!("{} {unit}", c.position_bits)
    }),
    ("clock asked", |c| format!("{} Hz", c.clock.requested_hz)),
    ("clock made", |c| {
        format!("{} Hz", decimal(c.clock.actual_hz, 1))
    }),
    ("deviation", |c| {
        format!("{:+.0} ppm", c.clock.deviation_ppm)
    }),
    ("period", |c| format!("{} cycles", c.period_cycles)),
    ("first low phase", |c| {
        format!("{} ns (tST {})", decimal(c.first_low_ns, 1), c.tst_ns)
    }),
    ("pulses per frame", |c| {
        format!("{} = {}+{}+1", c.pulses, c.lead_pulses, c.answer_bits)
    }),
    ("frame time", |c| format!("{} us", decimal(c.frame_us, 3))),
    ("with infos", |c| match c.longest_frame_us {
        None => String::new(),
        Some(us) => {
            let recovery = |cycle_us: f64| cycle_us - c.frame_us;
            let hz = |cycle_us| decimal(1e6 / (us + recovery(cycle_us)), 0);
            format!(
                "{} us, supplement too: {}..{} Hz",
                decimal(us, 1),
                hz(c.cycle_max_us),
                hz(c.cycle_min_us)
            )
        }
    }),
    ("frame + tm", |c| {
        format!(
            "{}..{} us",
            decimal(c.cycle_min_us, 2),
            decimal(c.cycle_max_us, 2)
        )
    }),
    ("highest sampling", |c| {
        format!(
            "{}..{} Hz",
            decimal(c.sure_sampling_hz, 0),
            decimal(c.highest_sampling_hz, 0)
        )
    }),
    ("worst case", |c| {
        format!(
            "{} Hz (tD {} ns)",
            decimal(c.worst_case_sampling_hz.floor(), 0),
            c.delay_max_ns
        )
    }),
    ("input filter", |c| {
        format!(
            "{} ns, at most {} recommended",
            decimal(c.filter_ns, 1),
            decimal(c.filter_recommended_ns, 1)
        )
    }),
    ("start window", |c| {
        format!("+-{} ns", decimal(c.start_window_ns, 1))
    }),
    ("start time-out", |c| format!("{} us", c.start_timeout_us)),
    ("calibration frame", |c| {
        format!(
            "{} us at {} Hz",
            decimal(c.calibration_us, 1),
            decimal(c.calibration_hz, 0)
        )
    }),
];

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, configuration {}", self.name, self.config_hash)?;
        match &self.board {
            Some(board) => writeln!(f, ", board {board}")?,
            None => writeln!(f)?,
        }
        write!(f, "system clock       {} Hz", self.system_hz)?;
        match (self.oscillator_hz, self.clock_manager) {
            (Some(hz), Some([multiply, divide, output])) => {
                writeln!(f, " = {hz} Hz * {multiply} / {divide} / {output}")?;
            }
            _ => writeln!(f, ", from outside")?,
        }
        writeln!(
            f,
            "sampling           {}, triggers: {}",
            rate(&self.sampling, "Hz"),
            list(&self.sources)
        )?;
        for (n, own) in self.own_triggers.iter().enumerate() {
            writeln!(f, "  of channel {n}     {own}")?;
        }
        for (n, range) in self.ranges.iter().enumerate() {
            if let Some(range) = range {
                writeln!(f, "turns of port {n}    {range}")?;
            }
        }
        if let Some(link) = &self.link {
            writeln!(f, "host link          {}", rate(&link.baud, "bit/s"))?;
            writeln!(
                f,
                "reading            {} bytes, {} times a second: {} bit/s, {} % of the link; at most {} a second",
                link.bytes_per_read,
                link.read_hz,
                link.needed_baud,
                decimal(link.used_percent, 1),
                decimal(link.highest_read_hz.floor(), 0)
            )?;
        } else {
            writeln!(f, "host bus           {}", self.bus)?;
        }
        if let Some(stream) = &self.stream {
            write!(f, "{stream}")?;
        }
        writeln!(f)?;
        let heads: Vec<String> = self
            .endat_channels()
            .map(|(n, _)| format!("channel {n}"))
            .collect();
        let cells: Vec<Vec<String>> = ROWS
            .iter()
            .map(|(_, cell)| self.endat_channels().map(|(_, c)| cell(c)).collect())
            .collect();
        let widest = cells.iter().flatten().map(|cell| cell.chars().count());
        let width = widest.max().unwrap_or(0).max(COLUMN_MIN);
        if !heads.is_empty() {
            line(f, "", &heads, width)?;
        }
        for ((head, _), cells) in ROWS.iter().zip(&cells) {
            if cells.iter().any(|cell| !cell.is_empty()) {
                line(f, head, cells, width)?;
            }
        }
        for channel in &self.channels {
            if let AnyChannelReport::Other(channel) = channel {
                write!(f, "\n{}", channel.text)?;
            }
        }
        writeln!(f)?;
        if !self.outputs.is_empty() {
            writeln!(f, "outputs: {}", list(&self.outputs))?;
        }
        if !self.safety.is_empty() {
            write!(f, "safety: {}", list(&self.safety))?;
            match self.error_test_ms {
                Some(ms) => writeln!(f, ", one forced error each {ms} ms")?,
                None => writeln!(f)?,
            }
        }
        if !self.service.is_empty() {
            writeln!(
                f,
                "service: {}; `with infos` is the longest frame, with additional data 1 and 2 and a supplement.",
                list(&self.service)
            )?;
            if self.service.contains(&"initialise") {
                writeln!(f, "initialisation: triggers are lost until about 2 s after reset, and after a plug; it measures the delay, too.")?;
            }
        }
        if heads.is_empty() {
            return Ok(());
        }
        let first = match self.line.is_empty() {
            true => "frame, the first after reset, measures",
            false => {
                let phase = self.phase.unwrap_or_default();
                writeln!(f, "line: {}; phase after reset: {phase}", list(&self.line))?;
                "frames, the first four after reset, measure"
            }
        };
        writeln!(
            f,
            "tm is the recovery time; the calibration {first} the delay of the cable."
        )
    }
}

pub(super) fn list(words: &[&str]) -> String {
    if words.is_empty() {
        "none".into()
    } else {
        words.join(", ")
    }
}

/// Narrowest column of a channel.
const COLUMN_MIN: usize = 24;

fn line(f: &mut fmt::Formatter<'_>, head: &str, cells: &[String], width: usize) -> fmt::Result {
    let mut text = format!("{head:<18}");
    for cell in cells {
        text.push_str(&format!(" {cell:<width$}"));
    }
    writeln!(f, "{}", text.trim_end())
}
