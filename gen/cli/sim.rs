//! `sim`: runs a named scenario of the bench on the channel, as elaborated for emission.

use super::{to_json, Outcome};
use crate::artifact::{self, Artifact};
use crate::error::{shown, GenError};
use clap::Args;
use endat_hdl::channel::{Channel, FixedTimes};
use endat_hdl::elaborate::elaborate;
use endat_sim::bench::Bench;
use endat_sim::diagram::frame_svg;
use endat_sim::engine::Interpreter;
use endat_sim::scenario::{self, ChannelReport, FrameReport, Report, RunOptions, Scenario};
use endat_sim::wave::Wave;
use rust_hdl::prelude::Block;
use serde_json::{json, Value};
use std::path::{Path, PathBuf};

/// Arguments of `sim`.
#[derive(Args)]
pub struct SimArgs {
    /// Scenario to run
    #[arg(required_unless_present = "list", conflicts_with = "list")]
    name: Option<String>,
    /// List the scenarios
    #[arg(long)]
    list: bool,
    /// Run only this channel of the scenario [default: all; waveforms and drawing are of the first one run]
    #[arg(
        long,
        value_name = "N",
        conflicts_with = "list",
        allow_negative_numbers = true
    )]
    channel: Option<String>,
    /// Write the waveforms, and a GTKWave layout beside them
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    vcd: Option<PathBuf>,
    /// Draw a frame as a timing diagram
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    svg: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Cycles from the pin to the register that takes a sample, without the filter: synchroniser and level.
const SAMPLE_LATENCY_CYCLES: u64 = 3;
/// The frame that is drawn: the first at the full clock.
const DRAWN_FRAME: usize = 1;

/// Runs the command.
pub fn run(arguments: &SimArgs) -> Result<Outcome, GenError> {
    let Some(name) = &arguments.name else {
        return list(arguments.json);
    };
    let known = || {
        scenario::all()
            .iter()
            .map(|s| s.name)
            .collect::<Vec<_>>()
            .join(", ")
    };
    let Some(scenario) = scenario::named(name) else {
        return Err(GenError::input(format!(
            "scenario = {}: unknown scenario; known scenarios: {}",
            shown(name),
            known()
        )));
    };
    let channels = chosen(arguments, &scenario)?;
    let mut outcome = Outcome::default();
    let mut reports = Vec::new();
    for (order, index) in channels.into_iter().enumerate() {
        let (bench, report) = run_channel(&scenario, index)?;
        if order == 0 {
            outcome.messages.extend(draw(arguments, &bench, &scenario)?);
        }
        if !report.complaints().is_empty() {
            outcome.exit_code = 1;
        }
        reports.push(report);
    }
    outcome.stdout = match arguments.json {
        true => to_json(
            &reports
                .iter()
                .map(|r| as_json(&scenario, r))
                .collect::<Vec<_>>(),
        )?,
        false => reports
            .iter()
            .map(Report::to_string)
            .collect::<Vec<_>>()
            .join("\n"),
    };
    Ok(outcome)
}

fn list(as_data: bool) -> Result<Outcome, GenError> {
    let all = scenario::all();
    if as_data {
        let objects = all
            .iter()
            .map(|s| json!({"name": s.name, "summary": s.summary}));
        return Ok(Outcome::good(to_json(&objects.collect::<Vec<_>>())?));
    }
    Ok(Outcome::good(
        all.iter()
            .map(|s| format!("{:<20} {}\n", s.name, s.summary))
            .collect::<String>(),
    ))
}

/// Which channels of the scenario to run.
fn chosen(arguments: &SimArgs, scenario: &Scenario) -> Result<Vec<usize>, GenError> {
    let count = scenario.channels.len();
    match &arguments.channel {
        None => Ok((0..count).collect()),
        Some(text) => match text.parse::<usize>() {
            Ok(index) if index < count => Ok(vec![index]),
            _ => Err(GenError::input(format!(
                "--channel = {}: outside 0..{}; choose a channel of {}",
                shown(text),
                count - 1,
                scenario.name
            ))),
        },
    }
}

fn run_channel(
    scenario: &Scenario,
    index: usize,
) -> Result<(Bench<Interpreter>, Report), GenError> {
    let fault = |e: &dyn std::fmt::Display| {
        GenError::input(format!(
            "design: {e}; this is a fault of endat-gen, please report it"
        ))
    };
    let settings = &scenario.channels[index].settings;
    let mut block = Channel::new(FixedTimes {
        abort_us: settings.abort_us,
        ready_low_cycles: settings.ready_low_cycles,
        ..FixedTimes::at(scenario.system_hz)
    });
    block.connect_all();
    let design = elaborate(&block, "channel").map_err(|e| fault(&e))?;
    let engine = Interpreter::new(&design).map_err(|e| fault(&e))?;
    let options = RunOptions {
        record: true,
        sample_latency_cycles: SAMPLE_LATENCY_CYCLES + settings.filter_cycles,
    };
    Ok(scenario.run_channel(index, engine, options))
}

/// A file to be written: the option that asked for it, its place, its text.
type File = (&'static str, PathBuf, String);

/// Writes waveforms and drawing; returns one message for each file.
fn draw(
    arguments: &SimArgs,
    bench: &Bench<Interpreter>,
    scenario: &Scenario,
) -> Result<Vec<String>, GenError> {
    let mut files: Vec<File> = Vec::new();
    if let Some(path) = &arguments.vcd {
        let name = file_name("--vcd", path)?;
        let wave = Wave::of(bench);
        let mut bytes = Vec::new();
        wave.write_vcd(&mut bytes)
            .map_err(|e| GenError::io("write", path, &e, "give another file"))?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        files.push(("--vcd", path.clone(), text));
        let layout = path.with_extension("gtkw");
        files.push(("--vcd", layout, wave.gtkw(&name)));
    }
    if let Some(path) = &arguments.svg {
        let link = bench.link(0);
        let title = format!("{}: {}", scenario.name, scenario.summary);
        let drawing = frame_svg(link, DRAWN_FRAME, &title).or_else(|| frame_svg(link, 0, &title));
        let drawing = drawing.ok_or_else(|| {
            GenError::input(format!(
                "--svg = {}: this scenario has no frame to draw; leave it out",
                path.display()
            ))
        })?;
        files.push(("--svg", path.clone(), drawing));
    }
    check_places(&files)?;
    let mut written = Vec::new();
    for (option, path, text) in &files {
        written.extend(write(option, path, text)?);
    }
    Ok(written)
}

/// Refuses two files in one place: the layout of the waveforms, too, has one.
fn check_places(files: &[File]) -> Result<(), GenError> {
    for (index, (option, path, _)) in files.iter().enumerate() {
        for (other, taken, _) in &files[..index] {
            if place(path) == place(taken) {
                let text = if option == other {
                    "is the name of the layout beside it; give a name that ends in .vcd".into()
                } else {
                    format!("is the place of a file of {other}; give another file")
                };
                return Err(GenError::input(format!(
                    "{option} = {}: {text}",
                    path.display()
                )));
            }
        }
    }
    Ok(())
}

fn folder(path: &Path) -> &Path {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
    parent.unwrap_or(Path::new("."))
}

/// One spelling for all the ways to name a file.
fn place(path: &Path) -> PathBuf {
    let whole = std::fs::canonicalize(path);
    whole.unwrap_or_else(|_| {
        let folder = folder(path);
        let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
        folder.join(path.file_name().unwrap_or_default())
    })
}

fn file_name(option: &str, path: &Path) -> Result<String, GenError> {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
    name.ok_or_else(|| {
        GenError::input(format!(
            "{option} = {}: is not the name of a file; give one",
            shown(&path.display().to_string())
        ))
    })
}

fn write(option: &str, path: &Path, text: &str) -> Result<Vec<String>, GenError> {
    let artifact = Artifact::new(file_name(option, path)?, text);
    let files = artifact::write(folder(path), &[artifact], "give another file")?;
    Ok(files
        .iter()
        .map(|_| format!("wrote {}", path.display()))
        .collect())
}

fn us(time: endat_sim::Time) -> f64 {
    time as f64 / endat_sim::US as f64
}

fn as_json(scenario: &Scenario, report: &Report) -> Value {
    json!({
        "scenario": scenario.name,
        "summary": scenario.summary,
        "system_hz": scenario.system_hz,
        "endat_hz": scenario.endat_hz,
        "channels": report.channels.iter().map(channel_json).collect::<Vec<_>>(),
        "complaints": report.complaints(),
    })
}

fn channel_json(channel: &ChannelReport) -> Value {
    json!({
        "channel": channel.index,
        "frames": channel.frames.iter().map(frame_json).collect::<Vec<_>>(),
        "samples": channel.samples.count,
        "samples_undefined": channel.samples.undefined,
        "narrowest_margin_ns": channel.samples.narrowest as f64 / 1e3,
    })
}

fn frame_json(frame: &FrameReport) -> Value {
    json!({
        "trigger_us": frame.trigger.map(us),
        "result": frame.result.as_ref().map(|r| json!({
            "cause": r.cause_name(),
            "cause_code": r.last_cause(),
            "fresh": r.fresh,
            "position": r.position_valid.then_some(r.position),
            "crc_received": r.crc_received,
            "crc_computed": r.crc_computed,
        })),
        "encoder": frame.frame.as_ref().map(|f| json!({
            "position": f.position,
            "rising_edges": f.rising_edges,
            "expected_rising_edges": f.expected_rising_edges(),
            "frame_us": us(f.last_rise - f.first_fall),
            "recovery_us": f.data_fall.map(|t| us(t - f.last_rise)),
        })),
    })
}
