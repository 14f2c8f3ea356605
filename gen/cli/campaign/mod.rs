//! `campaign`: thousands of cases in lanes; one of them again, alone, with waveforms and a drawing.

mod options;
mod tallies;

use crate::cli::pictures::{draw, Drawn, Pictures};
use clap::{Args, ValueEnum};
use endat_console::error::CommandError;
use endat_console::number::number;
use endat_sim::campaign::{self, Case, RunOptions, Traces};
use endat_terminal::outcome::{to_json, Outcome};
use endat_terminal::work::{progress, ThreadsArgs};
use rtl_design::engine::{Compiled, LaneWords};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

/// Arguments of `campaign`.
#[derive(Args)]
pub struct CampaignArgs {
    /// What to run
    name: Name,
    /// Of merge: files that --out has written
    #[arg(value_name = "PART")]
    parts: Vec<PathBuf>,
    /// Number of random cases [default: random 10000; upsets: every flip-flop in turn; garbage 1000000; configurations 5000, and 2000 spoilt ones]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    cases: Option<String>,
    /// Of upsets: moments of each kind of frame at which every flip-flop is inverted [default: 65]
    #[arg(
        long,
        value_name = "N",
        allow_negative_numbers = true,
        conflicts_with = "cases"
    )]
    moments: Option<String>,
    /// Of faults: at every N-th quarter of a bit [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    step: Option<String>,
    /// Of upsets, faults, garbage: only this port, t_format_port and ssi_port among them; of upsets also ssi_port_special, card, card_safety [default: all]
    #[arg(long, value_name = "NAME")]
    subject: Option<String>,
    /// Of upsets: only registers whose hierarchical name begins so, or so (a.b,a.c)
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Seed of the random cases [default: 1]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    seed: Option<String>,
    /// Of those that count: a small part of the cases, in seconds
    #[arg(long, conflicts_with_all = ["cases", "moments", "step"])]
    quick: bool,
    /// Of those that count: only part I of N equal ones
    #[arg(long, value_name = "I/N")]
    shard: Option<String>,
    /// Of those that count, and merge: write the counts as CSV
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    threads: ThreadsArgs,
    /// Run only this case, alone
    #[arg(long, value_name = "INDEX", allow_negative_numbers = true)]
    case: Option<String>,
    /// With --case: write the waveforms, and a GTKWave layout beside them
    #[arg(long, value_name = "FILE", requires = "case")]
    vcd: Option<PathBuf>,
    /// With --case: draw a frame as a timing diagram
    #[arg(long, value_name = "FILE", requires = "case")]
    svg: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Name {
    /// Every width, position command, rate and cable
    Sweep,
    /// Random jitter, distortion, cable, encoder times, filter and window, within their limits
    Random,
    /// Every flip-flop inverted at every moment of a frame
    Upsets,
    /// Every fault of the line, on and off at every quarter bit, with every recovery time and cable
    Faults,
    /// Random answers, jitter, noise, settings that change in a frame
    Garbage,
    /// Every word of encoders up to 13 bits, against a reference
    Accept,
    /// Random configurations: every emission linted in both languages, some benches run; and spoilt ones
    Configurations,
    /// Put the parts of one campaign together
    Merge,
}

/// Random cases, if not told.
const CASES_USUAL: &str = "10000";
/// Most random cases: all are made before the first one runs.
const CASES_MAX: u64 = 1_000_000;
/// Failures that are shown.
const SHOWN: usize = 10;

impl CampaignArgs {
    fn cases(&self) -> &str {
        self.cases.as_deref().unwrap_or(CASES_USUAL)
    }

    fn seed(&self) -> &str {
        self.seed.as_deref().unwrap_or("1")
    }
}

/// Runs the command.
pub fn run(arguments: &CampaignArgs) -> Result<Outcome, CommandError> {
    arguments.check_options()?;
    let seed = number("--seed", arguments.seed(), 0..=u64::MAX)?;
    if !matches!(arguments.name, Name::Sweep | Name::Random) {
        return tallies::run(arguments, seed);
    }
    let count = number("--cases", arguments.cases(), 1..=CASES_MAX)?;
    let cases = match arguments.name {
        Name::Random => campaign::random(count as usize, seed),
        _ => campaign::sweep(),
    };
    match &arguments.case {
        Some(index) => {
            let index = number("--case", index, 0..=cases.len() as u64 - 1)? as usize;
            alone(arguments, &cases[index], index)
        }
        None => all(arguments, &cases),
    }
}

fn fault(e: &dyn std::fmt::Display) -> CommandError {
    CommandError::fault("campaign", e)
}

/// What to type to see one case alone.
fn replay(arguments: &CampaignArgs, index: usize) -> String {
    let random = format!(" --cases {} --seed {}", arguments.cases(), arguments.seed());
    let (name, random) = match arguments.name {
        Name::Random => ("random", random.as_str()),
        _ => ("sweep", ""),
    };
    let program = super::emit::program();
    format!("{program} campaign {name}{random} --case {index} --vcd case.vcd --svg case.svg")
}

fn all(arguments: &CampaignArgs, cases: &[Case]) -> Result<Outcome, CommandError> {
    let options = RunOptions {
        threads: arguments.threads.count()?,
        lanes: LaneWords::Two,
        samples: true,
    };
    let start = Instant::now();
    let progress = progress(cases.len(), "cases");
    let outcomes = campaign::run(cases, options, Case::check, progress).map_err(|e| fault(&e))?;
    let seconds = start.elapsed().as_secs_f64();
    let frames: usize = outcomes.iter().map(|o| o.frames).sum();
    let cycles: u64 = outcomes.iter().map(|o| o.cycles).sum();
    let failed: Vec<(usize, &str)> = outcomes
        .iter()
        .enumerate()
        .filter_map(|(index, o)| Some((index, o.verdict.as_ref().err()?.as_str())))
        .collect();
    let stdout = if arguments.json {
        let failures = failed.iter().map(|(index, what)| {
            json!({"case": index, "title": cases[*index].title, "failure": what, "replay": replay(arguments, *index)})
        });
        to_json(&json!({
            "cases": cases.len(),
            "frames": frames,
            "cycles": cycles,
            "seconds": seconds,
            "failures": failures.collect::<Vec<_>>(),
        }))?
    } else {
        let mut text = format!(
            "{} cases, {frames} frames checked, {cycles} system clock cycles in {seconds:.1} s: {} failed\n",
            cases.len(),
            failed.len()
        );
        for (index, what) in failed.iter().take(SHOWN) {
            text += &format!(
                "case {index} ({}): {what}\n    {}\n",
                cases[*index].title,
                replay(arguments, *index)
            );
        }
        text
    };
    Ok(Outcome {
        stdout,
        exit_code: u8::from(!failed.is_empty()),
        ..Outcome::default()
    })
}

fn alone(arguments: &CampaignArgs, case: &Case, index: usize) -> Result<Outcome, CommandError> {
    let design = case.design().map_err(|e| fault(&e))?;
    let engine = Compiled::new(&design).map_err(|e| fault(&e))?;
    let bench = case.run_alone(engine, true);
    let traces = Traces::of(&bench);
    let failure = case.check(&traces).err();
    let files = Pictures {
        vcd: arguments.vcd.as_deref(),
        wires: None,
        svg: arguments.svg.as_deref(),
        frame: Drawn::First,
    };
    let messages = draw(&files, &bench, &case.title)?;
    let stdout = if arguments.json {
        to_json(&json!({
            "case": index,
            "title": case.title,
            "frames": traces.frames.len(),
            "failure": failure,
        }))?
    } else {
        let verdict = failure.as_deref().unwrap_or("good");
        format!("case {index} ({}): {verdict}\n", case.title)
    };
    Ok(Outcome {
        stdout,
        messages,
        exit_code: u8::from(failure.is_some()),
    })
}
