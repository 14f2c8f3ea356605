//! Speed of the simulators: the card with its encoders, the same stimulus everywhere, results compared, all in one run. And the
//! speed of the core itself, [`cycle_times`] and [`latencies`].

mod comparison;
mod comparison_t_format;
mod comparison_table;
mod cycle_time;
mod design;
mod frames;
mod instructions;
mod latency;
mod measured;
mod outside;
mod preset_run;
mod report;
mod rust_engines;
mod stimulus;

pub use comparison::{comparison, comparison_sample};
pub use cycle_time::{cycle_times, CycleTime, CycleTimeOptions, CycleTimes, Published};
pub use latency::{latencies, ChannelLatency, Latencies, LinkLatency, Span};
pub use report::{Report, Row};
pub use rust_engines::card_kernels;

use design::CardDesign;
use endat_console::error::CommandError;
use outside::Verilator;
use rtl_design::engine::LaneWords;
use stimulus::{Digest, Stimulus};

fn fault(e: &dyn std::fmt::Display) -> CommandError {
    CommandError::input(format!(
        "bench: {e}; this is a fault of this program or of a tool, please report it"
    ))
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Cycles for the fast engines; the slow ones run a part of them.
    pub cycles: usize,
    /// Run outside simulators as well.
    pub outside: bool,
    /// Count instructions, with valgrind.
    pub instructions: bool,
}

/// One engine on one stimulus.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Measured {
    name: &'static str,
    /// Clock cycles, summed over all copies.
    cycles: u64,
    seconds: f64,
    /// From the design to the first cycle.
    ready_s: f64,
    /// Frames that encoders saw.
    frames: u64,
    digest: Option<Digest>,
    /// Cycles that the digest is of.
    compared_cycles: u64,
    /// Bytes that a copy takes.
    state_bytes: Option<u64>,
}

/// Measures; `progress` is told what comes next.
pub fn run(options: Options, progress: &dyn Fn(&str)) -> Result<Report, CommandError> {
    let card = CardDesign::new()?;
    let cycles = options.cycles;
    // So that the slow engines take about as long as the fast ones.
    let (slowest, slow) = ((cycles / 200).max(1), (cycles / 20).max(1));
    progress("recording the stimulus");
    let stimulus = Stimulus::record(&card, cycles)?;
    let scratch = endat_tools::scratch::folder()?;
    let mut alone = vec![];
    let mut models = vec![];
    progress("rust-hdl kernels");
    alone.push(rust_engines::kernels(&stimulus, slowest)?);
    progress("plain engine");
    alone.push(rust_engines::plain(&card, &stimulus, slow)?);
    progress("compiled engine");
    alone.push(rust_engines::compiled(&card, &stimulus, cycles)?);
    models.push(rust_engines::compiled_with_models(&card, cycles)?);
    for words in [LaneWords::One, LaneWords::Two] {
        progress("lane engine");
        models.push(rust_engines::lanes(&card, words, slow)?);
    }
    let mut version = None;
    if options.outside {
        progress("iverilog");
        alone.push(outside::iverilog(
            &card,
            &stimulus,
            slowest,
            &scratch.path().join("iverilog"),
        )?);
        match Verilator::find() {
            None => progress("Verilator is not there"),
            Some(verilator) => {
                progress("Verilator, the card alone");
                let folder = scratch.path().join("verilator");
                alone.push(verilator.play(&card, &stimulus, cycles, &folder)?);
                progress("Verilator with models in C++");
                let folder = scratch.path().join("verilator-models");
                models.push(verilator.with_models(&card, cycles, &folder)?);
                version = Some(verilator.version.clone());
            }
        }
    }
    progress("checked frames in lanes");
    let frames = frames::measure((cycles / 2000).max(1))?;
    let mut report = Report::new(version, frames);
    for (row, has_models) in alone
        .iter()
        .map(|r| (r, false))
        .chain(models.iter().map(|r| (r, true)))
    {
        let length = row.compared_cycles as usize;
        let reference = if has_models {
            rust_engines::compiled_with_models(&card, length)?
        } else {
            rust_engines::compiled(&card, &stimulus, length)?
        };
        report.add(row, has_models, row.digest == reference.digest);
    }
    if options.instructions {
        progress("instructions, with valgrind");
        report.instructions = instructions::measure()?;
    }
    Ok(report)
}

/// Runs one engine alone for a number of cycles, for [`Options::instructions`].
pub fn run_one(engine: &str, cycles: usize) -> Result<(), CommandError> {
    if engine == "frames" {
        return frames::measure(cycles).map(drop);
    }
    let card = CardDesign::new()?;
    match engine {
        "plain" => rust_engines::plain(&card, &Stimulus::record(&card, cycles)?, cycles)?,
        "compiled" => rust_engines::compiled(&card, &Stimulus::record(&card, cycles)?, cycles)?,
        "models" => rust_engines::compiled_with_models(&card, cycles)?,
        "lanes" => rust_engines::lanes_on(&card, LaneWords::Two, cycles, 1)?,
        other => {
            return Err(CommandError::input(format!(
            "--only = {other:?}: unknown engine; choose plain, compiled, models, lanes or frames"
        )))
        }
    };
    Ok(())
}
