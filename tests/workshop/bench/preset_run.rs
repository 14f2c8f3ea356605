//! A preset's card as it is emitted, with encoders on cables, triggered at its pin; what its direct outputs show is compared with the
//! encoders.

use super::fault;
use endat_config::{load_preset, Project};
use endat_console::error::CommandError;
use endat_emit::encoders;
use endat_hdl::config::TriggerSources;
use endat_hdl::protocol::ModeCommand;
use endat_sim::bench::{Bench, Link, PinNames};
use endat_sim::line::LineConfig;
use endat_sim::{Time, US};
use rtl_design::engine::Compiled;

/// Triggers before the measured ones: with alignment four frames measure the delay.
const WARM_UPS: usize = 5;
/// Time between them: a frame at the clock that measures the delay is shorter.
const WARM_UP: Time = 600 * US;

/// What is put at a preset's ports.
#[derive(Clone, Copy, Debug)]
pub struct Conditions {
    /// Cable to each encoder, in metres.
    pub cable_m: f64,
    /// Recovery time of EnDat 2.2 frames above 1 MHz; others have 10 us.
    pub short_tm: Time,
    /// Time between two triggers.
    pub period: Time,
    /// Measured triggers.
    pub triggers: usize,
}

/// What one channel did.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelRun {
    /// EnDat clock, in hertz.
    pub clock_hz: f64,
    /// Position bits.
    pub position_bits: u32,
    /// Mode command.
    pub command: ModeCommand,
    /// Rising clock edges of a frame.
    pub pulses: u32,
    /// Longest time from the first falling to the last rising clock edge.
    pub frame: Time,
    /// Longest time from the trigger's edge to the position at the direct output.
    pub position: Time,
    /// Positions that came out right.
    pub good: usize,
}

/// The project of a preset without what the runs leave out: the initialisation, which waits for 2 s, and triggers of its own.
pub fn project(name: &str) -> Result<Project, CommandError> {
    let mut project = load_preset(name)?;
    project.card.service.initialise = false;
    project.card.sources = TriggerSources {
        pin: true,
        ..TriggerSources::default()
    };
    Ok(project)
}

/// Runs a card with direct outputs.
pub fn run(project: &Project, conditions: Conditions) -> Result<Vec<ChannelRun>, CommandError> {
    let design = endat_emit::design(project)?;
    let engine = Compiled::new(&design).map_err(|e| fault(&e))?;
    let card = &project.card;
    let link = |n: usize| {
        let channel = &card.channels[n];
        let mut encoder = encoders::turning(channel, n);
        encoder.tcal = 5 * US;
        let is_short = channel.command.has_f2() && channel.spec.clock_hz > 1_000_000;
        let tm = if is_short {
            conditions.short_tm
        } else {
            10 * US
        };
        encoder.tm = tm..=tm;
        let line = LineConfig::cable(conditions.cable_m).seed(n as u64 + 1);
        (PinNames::card(n), Link::new(line, encoder))
    };
    let links = (0..card.channels.len()).map(link).collect();
    let mut bench = Bench::new(engine, card.system_hz, links);
    bench.power_up();
    let names = |what: &str| -> Vec<String> {
        let name = |channel| format!("direct_{what}{channel}_o");
        (0..card.channels.len()).map(name).collect()
    };
    let (fresh, shown, error) = (names("fresh"), names("position"), names("error"));
    let mut position: Vec<Time> = vec![0; card.channels.len()];
    let mut good: Vec<usize> = vec![0; card.channels.len()];
    for trigger in 0..WARM_UPS + conditions.triggers {
        let is_measured = trigger >= WARM_UPS;
        let span = if is_measured {
            conditions.period
        } else {
            WARM_UP
        };
        let start = bench.now();
        bench.set("trigger_i", 1);
        while bench.now() < start + span {
            bench.run_cycles(1);
            if bench.now() > start + US {
                bench.set("trigger_i", 0);
            }
            for channel in 0..card.channels.len() {
                if !is_measured || bench.get(&fresh[channel]) == 0 {
                    continue;
                }
                position[channel] = position[channel].max(bench.now() - start);
                let seen = bench.get(&shown[channel]) as u64;
                let bits = card.channels[channel].position_bits.min(32);
                let sent = bench.frames(channel).last().map(|f| f.position);
                let is_sent = sent.is_some_and(|sent| seen == sent & ((1 << bits) - 1));
                let is_well = bench.get(&error[channel]) == 0;
                good[channel] += usize::from(is_sent && is_well);
            }
        }
    }
    let channels = card.channels.iter().enumerate();
    Ok(channels
        .map(|(n, channel)| {
            let frames = bench.frames(n);
            let frames = &frames[frames.len().saturating_sub(conditions.triggers)..];
            let frame = |f: &endat_sim::encoder::FrameLog| f.last_rise - f.first_fall;
            ChannelRun {
                clock_hz: card.system_hz as f64 / channel.period_cycles as f64,
                position_bits: channel.position_bits,
                command: channel.command,
                pulses: frames.iter().map(|f| f.rising_edges).max().unwrap_or(0),
                frame: frames.iter().map(frame).max().unwrap_or(0),
                position: position[n],
                good: good[n],
            }
        })
        .collect())
}
