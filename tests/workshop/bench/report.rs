//! The table.

use super::frames::Frames;
use super::instructions::Instructions;
use super::Measured;
use serde::Serialize;
use std::fmt;

/// A line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Engine.
    pub name: &'static str,
    /// With encoders and lines.
    pub has_models: bool,
    /// Cycles per second, summed over copies.
    pub cycles_per_s: f64,
    /// The same as a part of Verilator's, if that is there.
    pub of_verilator: Option<f64>,
    /// Frames per second that the encoders saw.
    pub frames_per_s: Option<f64>,
    /// From the design to the first cycle, in seconds.
    pub ready_s: f64,
    /// Bytes of state of a copy.
    pub state_bytes: Option<u64>,
    /// Its outputs were those of the compiled engine in every cycle.
    pub is_equal: bool,
    /// Cycles that were compared.
    pub compared_cycles: u64,
}

/// All figures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Verilator's version.
    pub verilator: Option<String>,
    /// Engines, the card alone first.
    pub rows: Vec<Row>,
    /// Checked frames in lanes.
    pub frames: Frames,
    /// Instructions, where they were counted.
    pub instructions: Vec<Instructions>,
}

const VERILATOR: &str = "Verilator -O3";

impl Report {
    pub(super) fn new(verilator: Option<String>, frames: Frames) -> Self {
        Self {
            verilator,
            rows: vec![],
            frames,
            instructions: vec![],
        }
    }

    pub(super) fn add(&mut self, measured: &Measured, has_models: bool, is_equal: bool) {
        let per_s = |count: u64| count as f64 / measured.seconds;
        self.rows.push(Row {
            name: measured.name,
            has_models,
            cycles_per_s: per_s(measured.cycles),
            of_verilator: None,
            frames_per_s: (measured.frames > 0).then(|| per_s(measured.frames)),
            ready_s: measured.ready_s,
            state_bytes: measured.state_bytes,
            is_equal,
            compared_cycles: measured.compared_cycles,
        });
        for models in [false, true] {
            let of = |row: &&Row| row.has_models == models && row.name == VERILATOR;
            let Some(base) = self.rows.iter().find(of).map(|r| r.cycles_per_s) else {
                continue;
            };
            for row in self.rows.iter_mut().filter(|r| r.has_models == models) {
                row.of_verilator = Some(row.cycles_per_s / base);
            }
        }
    }

    /// Whether all engines gave the same outputs.
    pub fn is_equal(&self) -> bool {
        self.rows.iter().all(|row| row.is_equal)
    }
}

/// A number of cycles per second, as people read it.
fn rate(per_s: f64) -> String {
    if per_s >= 1e6 {
        format!("{:.2} M", per_s / 1e6)
    } else {
        format!("{:.1} k", per_s / 1e3)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for has_models in [false, true] {
            let title = if has_models {
                "the card with an encoder and a line on each channel"
            } else {
                "the card alone, recorded inputs"
            };
            writeln!(f, "{title}")?;
            writeln!(
                f,
                "  {:<24} {:>10} {:>10} {:>10} {:>9}  outputs",
                "", "cycles/s", "Verilator", "frames/s", "ready"
            )?;
            for row in self.rows.iter().filter(|r| r.has_models == has_models) {
                let ratio = row
                    .of_verilator
                    .map_or(String::new(), |r| format!("{r:.2}"));
                let frames = row
                    .frames_per_s
                    .map_or(String::new(), |r| format!("{r:.0}"));
                let equal = if row.is_equal { "equal" } else { "DIFFERENT" };
                writeln!(
                    f,
                    "  {:<24} {:>10} {ratio:>10} {frames:>10} {:>7.3} s  {equal} in {} cycles",
                    row.name,
                    rate(row.cycles_per_s),
                    row.ready_s,
                    row.compared_cycles,
                )?;
            }
        }
        let frames = &self.frames;
        writeln!(
            f,
            "{:.0} checked frames/s: {} cases of a channel side by side, {} frames of 29 bits at 16 MHz, {} lane-cycles/s",
            frames.frames as f64 / frames.seconds,
            frames.cases,
            frames.frames,
            rate(frames.cycles as f64 / frames.seconds),
        )?;
        for row in self.rows.iter() {
            if let Some(bytes) = row.state_bytes {
                writeln!(f, "{}: {bytes} bytes of state for each card", row.name)?;
            }
        }
        for line in &self.instructions {
            writeln!(
                f,
                "{}: {:.0} instructions per cycle",
                line.name, line.per_cycle
            )?;
        }
        match &self.verilator {
            Some(version) => writeln!(f, "compared with {version}"),
            None => Ok(()),
        }
    }
}
