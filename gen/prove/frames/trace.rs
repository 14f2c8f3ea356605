//! A run as a waveform.

use std::io::{self, Write};
use vcd::{IdCode, TimescaleUnit, Value, VarType};

/// A signal in every cycle of a run.
#[derive(Clone, Debug)]
pub struct Signal {
    /// Its name.
    pub name: &'static str,
    /// Its width.
    pub width_bits: usize,
    /// Its levels, the first cycle first.
    pub levels: Vec<u64>,
}

/// Signals of a run.
#[derive(Clone, Debug)]
pub struct Trace {
    /// System clock.
    pub system_hz: u64,
    /// They.
    pub signals: Vec<Signal>,
}

impl Trace {
    /// Writes it as VCD.
    pub fn write_vcd(&self, out: impl Write) -> io::Result<()> {
        let mut vcd = vcd::Writer::new(out);
        vcd.timescale(1, TimescaleUnit::PS)?;
        vcd.add_module("frames")?;
        let mut ids: Vec<IdCode> = vec![];
        for signal in &self.signals {
            ids.push(vcd.add_var(VarType::Wire, signal.width_bits as u32, signal.name, None)?);
        }
        vcd.upscope()?;
        vcd.enddefinitions()?;
        let cycles = self.signals.iter().map(|s| s.levels.len()).max();
        for cycle in 0..cycles.unwrap_or(0) {
            vcd.timestamp(cycle as u64 * 1_000_000_000_000 / self.system_hz)?;
            for (signal, id) in self.signals.iter().zip(&ids) {
                let now = signal.levels.get(cycle);
                if cycle > 0 && now == signal.levels.get(cycle - 1) {
                    continue;
                }
                let level = now.copied().unwrap_or(0);
                match signal.width_bits {
                    1 => vcd.change_scalar(*id, level == 1)?,
                    width => {
                        let bits = (0..width).rev();
                        let bits = bits.map(|bit| Value::from(level >> bit & 1 == 1));
                        vcd.change_vector(*id, bits)?;
                    }
                }
            }
        }
        vcd.flush()
    }
}
