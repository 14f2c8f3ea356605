//! `bench`: measures the simulators, and the core in simulation.

use crate::bench::{self, CycleTimeOptions, Options};
use clap::{Args, Subcommand};
use endat_console::error::CommandError;
use endat_console::number::number;
use endat_hdl::config::CABLE_M_MAX;
use endat_hdl::endat::timing::RECOVERY_MAX_NS;
use endat_hdl::endat::timing::SHORT_RECOVERY_MIN_NS;
use endat_hdl::protocol::POSITION_BITS;
use endat_terminal::outcome::{to_json, Outcome};
use endat_terminal::work::Steps;

/// Arguments of `bench`.
#[derive(Args)]
pub struct BenchArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// The card on the same stimulus in every engine and in other simulators; results are compared
    Engines(EnginesArgs),
    /// Time from one position to the next, measured in simulation, beside the protocol's limit and published systems
    CycleTime(CycleTimeArgs),
    /// Times from trigger to clock edge, from the last sample to the result, and from the result to a host at each link but the parallel bus, measured in simulation
    Latency(LatencyArgs),
    /// The presets' runs beside what others have published, as the page docs/comparison.md
    Comparison,
}

#[derive(Args)]
struct EnginesArgs {
    /// Cycles for the fast engines; slow ones run a part of them
    #[arg(
        long,
        value_name = "N",
        default_value = "2000000",
        allow_negative_numbers = true
    )]
    cycles: String,
    /// Only this project's own engines
    #[arg(long)]
    own: bool,
    /// Count instructions with valgrind: takes minutes
    #[arg(long)]
    instructions: bool,
    /// Run one engine and print nothing
    #[arg(long, value_name = "ENGINE", hide = true)]
    only: Option<String>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct CycleTimeArgs {
    /// Width of the position [default: 25 and 37]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    bits: Option<String>,
    /// Length of the cable
    #[arg(
        long,
        value_name = "M",
        default_value = "1",
        allow_negative_numbers = true
    )]
    cable_m: String,
    /// Calculation time of the encoder
    #[arg(
        long,
        value_name = "NS",
        default_value = "5000",
        allow_negative_numbers = true
    )]
    tcal_ns: String,
    /// Recovery time of the encoder; below 10000 it holds only for 111000 above 1 MHz
    #[arg(
        long,
        value_name = "NS",
        default_value = "10000",
        allow_negative_numbers = true
    )]
    tm_ns: String,
    /// As JSON
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct LatencyArgs {
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Fewest cycles: the slow engines run a part of them.
const CYCLES_MIN: u64 = 1000;
/// Most cycles: a byte of stimulus is kept for each.
const CYCLES_MAX: u64 = 1_000_000_000;

/// Longest calculation time that is tried.
const TCAL_MAX_NS: u64 = 100_000;

/// Runs the command.
pub fn run(arguments: &BenchArgs) -> Result<Outcome, CommandError> {
    match &arguments.what {
        What::Engines(arguments) => engines(arguments),
        What::CycleTime(arguments) => cycle_time(arguments),
        What::Latency(arguments) => latency(arguments),
        What::Comparison => Ok(Outcome::good(bench::comparison()?)),
    }
}

fn cycle_time(arguments: &CycleTimeArgs) -> Result<Outcome, CommandError> {
    let bits = u64::from(*POSITION_BITS.start())..=u64::from(*POSITION_BITS.end());
    let bits = |text| number("--bits", text, bits);
    let recovery = SHORT_RECOVERY_MIN_NS..=RECOVERY_MAX_NS;
    let report = bench::cycle_times(CycleTimeOptions {
        position_bits: arguments
            .bits
            .as_deref()
            .map(bits)
            .transpose()?
            .map(|n| n as u32),
        cable_m: number("--cable-m", &arguments.cable_m, 0..=CABLE_M_MAX)?,
        tcal_ns: number("--tcal-ns", &arguments.tcal_ns, 0..=TCAL_MAX_NS)?,
        tm_ns: number("--tm-ns", &arguments.tm_ns, recovery)?,
    })?;
    Ok(Outcome {
        stdout: if arguments.json {
            to_json(&report)?
        } else {
            report.to_string()
        },
        exit_code: u8::from(!report.is_good()),
        ..Outcome::default()
    })
}

fn latency(arguments: &LatencyArgs) -> Result<Outcome, CommandError> {
    let report = bench::latencies()?;
    Ok(Outcome {
        stdout: if arguments.json {
            to_json(&report)?
        } else {
            report.to_string()
        },
        exit_code: u8::from(!report.is_good()),
        ..Outcome::default()
    })
}

fn engines(arguments: &EnginesArgs) -> Result<Outcome, CommandError> {
    let cycles = number("--cycles", &arguments.cycles, CYCLES_MIN..=CYCLES_MAX)? as usize;
    if let Some(engine) = &arguments.only {
        bench::run_one(engine, cycles)?;
        return Ok(Outcome::default());
    }
    let options = Options {
        cycles,
        outside: !arguments.own,
        instructions: arguments.instructions,
    };
    let steps = Steps::new(None);
    let progress = |what: &str| steps.begin(&format!("bench: {what}"));
    let report = bench::run(options, &progress)?;
    let mut outcome = Outcome::good(if arguments.json {
        to_json(&report)?
    } else {
        report.to_string()
    });
    if !report.is_equal() {
        outcome.exit_code = 1;
    }
    Ok(outcome)
}
