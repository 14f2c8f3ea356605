//! `sim`: runs a named scenario of the bench on the channel, as elaborated for emission.

use super::pictures::{draw, Drawn, Pictures};
use super::{to_json, Outcome};
use clap::Args;
use endat_console::error::{shown, CommandError};
use endat_hdl::encoder_port::EncoderPort;
use endat_hdl::endat::channel::{Channel, FixedTimes};
use endat_hdl::endat::service::program::ServiceTimes;
use endat_regs::Protocol;
use endat_sim::bench::Bench;
use endat_sim::scenario::{
    self, t_format, t_format::TFormatReport, ChannelReport, FrameReport, Report, RunOptions,
    Scenario,
};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;
use serde_json::{json, Value};
use std::path::PathBuf;

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
    /// Write CLOCK and DATA as they are at the encoder, for logic analysers' programs: scalars, in nanoseconds
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    wires: Option<PathBuf>,
    /// Draw a frame as a timing diagram
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    svg: Option<PathBuf>,
    /// Draw this frame of the encoder, 0 = the one that measures the delay; all = all frames, in an overview [default: 1]
    #[arg(
        long,
        value_name = "N",
        requires = "svg",
        conflicts_with = "list",
        allow_negative_numbers = true
    )]
    frame: Option<String>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Cycles from the pin to the register that takes a sample, without the filter: synchroniser and level.
const SAMPLE_LATENCY_CYCLES: u64 = 3;

/// Runs the command.
pub fn run(arguments: &SimArgs) -> Result<Outcome, CommandError> {
    let Some(name) = &arguments.name else {
        return list(arguments.json);
    };
    let known = || {
        scenario::all()
            .iter()
            .map(|s| s.name)
            .chain([t_format::NAME])
            .collect::<Vec<_>>()
            .join(", ")
    };
    if name == t_format::NAME {
        return run_t_format(arguments);
    }
    let Some(scenario) = scenario::named(name) else {
        return Err(CommandError::input(format!(
            "scenario = {}: unknown scenario; known scenarios: {}",
            shown(name),
            known()
        )));
    };
    let channels = chosen(arguments, &scenario)?;
    let frame = arguments.frame.as_ref().map(|text| {
        if text == "all" {
            return Ok(Drawn::All);
        }
        text.parse().map(Drawn::Frame).map_err(|_| {
            CommandError::input(format!(
                "--frame = {}: is not the number of a frame; give 0, 1, 2, ... or all",
                shown(text)
            ))
        })
    });
    let frame = frame.transpose()?.unwrap_or_default();
    let mut outcome = Outcome::default();
    let mut reports = Vec::new();
    for (order, index) in channels.into_iter().enumerate() {
        let (bench, report) = run_channel(&scenario, index)?;
        if order == 0 {
            let files = Pictures {
                vcd: arguments.vcd.as_deref(),
                wires: arguments.wires.as_deref(),
                svg: arguments.svg.as_deref(),
                frame,
            };
            let title = format!("{}: {}", scenario.name, scenario.summary);
            outcome.messages.extend(draw(&files, &bench, &title)?);
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

/// The story with a T-format encoder: one port, whose line can be written.
fn run_t_format(arguments: &SimArgs) -> Result<Outcome, CommandError> {
    if let Some(text) = arguments.channel.as_deref().filter(|text| *text != "0") {
        return Err(CommandError::input(format!(
            "--channel = {}: {} has one channel; leave it out",
            shown(text),
            t_format::NAME
        )));
    }
    let mut block = EncoderPort::speaking(Protocol::TFormat, false, false);
    block.connect_all();
    let design = elaborate(&block, "encoder_port").map_err(|e| fault(&e))?;
    let engine = Compiled::new(&design).map_err(|e| fault(&e))?;
    let (bench, report) = t_format::run(engine);
    let files = Pictures {
        vcd: arguments.vcd.as_deref(),
        wires: arguments.wires.as_deref(),
        svg: arguments.svg.as_deref(),
        frame: Drawn::default(),
    };
    let stdout = match arguments.json {
        true => to_json(&t_format_json(&report))?,
        false => report.to_string(),
    };
    Ok(Outcome {
        exit_code: u8::from(!report.complaints.is_empty()),
        messages: draw(&files, &bench, t_format::SUMMARY)?,
        stdout,
    })
}

fn t_format_json(report: &TFormatReport) -> Value {
    let exchanges = report.exchanges.iter().map(|e| {
        json!({
            "time_us": us(e.time),
            "id": e.request.id(),
            "request": e.sent,
            "reply": e.reply,
            "cause": e.cause_name(),
            "cause_code": e.cause(),
            "position": e.result.as_ref().filter(|r| r.fresh).map(|r| r.position),
        })
    });
    json!([{
        "scenario": t_format::NAME,
        "summary": t_format::SUMMARY,
        "system_hz": t_format::SYSTEM_HZ,
        "exchanges": exchanges.collect::<Vec<_>>(),
        "complaints": report.complaints,
    }])
}

/// What cannot go wrong has.
fn fault(e: &dyn std::fmt::Display) -> CommandError {
    CommandError::fault("design", e)
}

fn list(as_data: bool) -> Result<Outcome, CommandError> {
    let all: Vec<_> = scenario::all()
        .iter()
        .map(|s| (s.name, s.summary))
        .collect();
    let all = [all, vec![(t_format::NAME, t_format::SUMMARY)]].concat();
    if as_data {
        let objects = all
            .iter()
            .map(|(name, summary)| json!({"name": name, "summary": summary}));
        return Ok(Outcome::good(to_json(&objects.collect::<Vec<_>>())?));
    }
    Ok(Outcome::good(
        all.iter()
            .map(|(name, summary)| format!("{name:<20} {summary}\n"))
            .collect::<String>(),
    ))
}

/// Which channels of the scenario to run.
fn chosen(arguments: &SimArgs, scenario: &Scenario) -> Result<Vec<usize>, CommandError> {
    let count = scenario.channels.len();
    match &arguments.channel {
        None => Ok((0..count).collect()),
        Some(text) => match text.parse::<usize>() {
            Ok(index) if index < count => Ok(vec![index]),
            _ => Err(CommandError::input(format!(
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
) -> Result<(Bench<Compiled>, Report), CommandError> {
    let settings = &scenario.channels[index].settings;
    let times = FixedTimes {
        abort_us: settings.abort_us,
        ready_low_cycles: settings.ready_low_cycles,
        ..FixedTimes::at(scenario.system_hz)
    };
    let design = if scenario.initialisation > 0 {
        let service = ServiceTimes::at(scenario.system_hz);
        let mut block = EncoderPort::new(times, Some(&service), false);
        block.connect_all();
        elaborate(&block, "encoder_port")
    } else {
        let mut block = Channel::with(times, scenario.features());
        block.connect_all();
        elaborate(&block, "channel")
    };
    let design = design.map_err(|e| fault(&e))?;
    let engine = Compiled::new(&design).map_err(|e| fault(&e))?;
    let options = RunOptions {
        record: true,
        sample_latency_cycles: SAMPLE_LATENCY_CYCLES + settings.filter_cycles,
    };
    Ok(scenario.run_channel(index, engine, options))
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
        "answer": frame.answer.as_ref().map(|a| json!({
            "cause": endat_hdl::endat::transaction::cause::name(a.cause),
            "word": a.word,
            "crc_good": a.crc_good,
        })),
        "encoder": frame.frame.as_ref().map(|f| json!({
            "command": f.command,
            "position": f.position,
            "rising_edges": f.rising_edges,
            "expected_rising_edges": f.expected_rising_edges(),
            "frame_us": us(f.last_rise - f.first_fall),
            "recovery_us": f.data_fall.map(|t| us(t - f.last_rise)),
        })),
    })
}
