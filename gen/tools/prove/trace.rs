//! A run that breaks something, as waveform and as drawing.

use super::harness::TOP;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_draw::{waves_svg, Wave};
use std::io::{self, BufReader, Write};
use std::path::Path;
use vcd::{Command, IdCode, ScopeItem, TimescaleUnit, Value, VarType};

/// Signals of a run, one level for each cycle of the system clock.
#[derive(Clone, Debug)]
pub struct Trace {
    /// System clock.
    pub system_hz: u64,
    /// They.
    pub waves: Vec<Wave>,
}

impl Trace {
    /// Writes it as VCD.
    fn write_vcd(&self, out: impl Write) -> io::Result<()> {
        let mut vcd = vcd::Writer::new(out);
        vcd.timescale(1, TimescaleUnit::PS)?;
        vcd.add_module("frames")?;
        let mut ids: Vec<IdCode> = vec![];
        for wave in &self.waves {
            ids.push(vcd.add_var(VarType::Wire, wave.width_bits as u32, &wave.name, None)?);
        }
        vcd.upscope()?;
        vcd.enddefinitions()?;
        let cycles = self.waves.iter().map(|s| s.levels.len()).max();
        for cycle in 0..cycles.unwrap_or(0) {
            vcd.timestamp(cycle as u64 * 1_000_000_000_000 / self.system_hz)?;
            for (wave, id) in self.waves.iter().zip(&ids) {
                let now = wave.levels.get(cycle);
                if cycle > 0 && now == wave.levels.get(cycle - 1) {
                    continue;
                }
                let level = now.copied().unwrap_or(0);
                match wave.width_bits {
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

    /// Writes waveform and drawing, `name` with `.vcd` and `.svg`, into a folder.
    pub fn keep(
        &self,
        folder: &Path,
        name: &str,
        title: &str,
        said: &str,
    ) -> Result<(), CommandError> {
        let remedy = "give another folder with --out";
        let mut text = vec![];
        let path = folder.join(format!("{name}.vcd"));
        let written = self.write_vcd(&mut text);
        written.map_err(|e| CommandError::io("write", &path, &e, remedy))?;
        let files = [
            Artifact::new(format!("{name}.vcd"), String::from_utf8_lossy(&text)),
            Artifact::new(format!("{name}.svg"), waves_svg(&self.waves, title, said)),
        ];
        endat_console::artifact::write(folder, &files, remedy).map(drop)
    }
}

/// Widest word that is drawn.
const WIDTH_MAX: u32 = 64;

/// Ends of names of what only a reader of Verilog needs: enables of assertions, inputs of registers; and the clock, which is a cycle.
const UNINTERESTING: [&str; 4] = ["_EN", "_next", "_unused_ok", "clock"];
/// Time of a step in a solver's waveform; half of it later the clock falls.
const STEP: u64 = 10;

/// The signals of the block in which an assertion is, from a solver's waveform; bits that are not known are LOW.
pub(super) fn waves(text: &str, assertion: &str) -> io::Result<Vec<Wave>> {
    let mut parser = vcd::Parser::new(BufReader::new(text.as_bytes()));
    let header = parser.parse_header()?;
    let path: Vec<&str> = std::iter::once(TOP).chain(assertion.split('.')).collect();
    let Some(block) = header.find_scope(&path[..path.len() - 1]) else {
        return Ok(vec![]);
    };
    let vars = block.items.iter().filter_map(|item| match item {
        ScopeItem::Var(var) => Some(var),
        _ => None,
    });
    let is_wanted = |var: &&vcd::Var| {
        let name = var.reference.as_str();
        var.size <= WIDTH_MAX && !UNINTERESTING.iter().any(|end| name.ends_with(end))
    };
    let vars: Vec<&vcd::Var> = vars.filter(is_wanted).collect();
    let mut waves: Vec<Wave> = (vars.iter())
        .map(|var| Wave {
            name: var.reference.clone(),
            width_bits: var.size as usize,
            levels: vec![],
        })
        .collect();
    let mut now = vec![0; vars.len()];
    let mut time = None;
    let bit = |value: Value| u64::from(value == Value::V1);
    let mut step = |now: &[u64], time: Option<u64>| {
        if time.is_some_and(|time| time % STEP == 0) {
            for (wave, level) in waves.iter_mut().zip(now) {
                wave.levels.push(*level);
            }
        }
    };
    for command in parser {
        let (id, level) = match command? {
            Command::Timestamp(next) => {
                // The levels before belong to the step that ends here.
                step(&now, time);
                time = Some(next);
                continue;
            }
            Command::ChangeScalar(id, value) => (id, bit(value)),
            Command::ChangeVector(id, values) => {
                (id, values.iter().fold(0, |word, v| word << 1 | bit(v)))
            }
            _ => continue,
        };
        for (_, now) in vars.iter().zip(&mut now).filter(|(var, _)| var.code == id) {
            *now = level;
        }
    }
    Ok(waves)
}
