//! `margin`: where the edges of DATA are, as the card itself has measured it.

use crate::port::{channel, needs_trigger, settled, told, AnyCard, PortArgs};
use clap::Args;
use endat_console::error::CommandError;
use endat_console::number::number_if;
use endat_draw::{edges_svg, is_drawing, Edges};
use endat_host::registers::Place;
use endat_host::HostError;
use endat_regs::{Part, Protocol};
use endat_terminal::files::{write_all, File};
use endat_terminal::outcome::{to_json, Outcome};
use serde_json::json;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Arguments of `margin`.
#[derive(Args)]
pub struct MarginArgs {
    #[command(flatten)]
    port: PortArgs,
    /// Channel [default: 0]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    channel: Option<String>,
    /// Clear first, and count this many frames [default: what has been counted]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    frames: Option<String>,
    /// Draw the histogram
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Bins of the histogram.
const BINS: usize = 32;
/// Longest wait for a frame.
const WAIT: Duration = Duration::from_secs(20);

/// Refuses a channel whose margin the card does not measure; `what` is how the user named it.
pub fn needs(what: &str, card: &AnyCard, channel: usize) -> Result<(), HostError> {
    let why = match channel < card.identity().channels {
        true => match card.identity().protocol(channel) {
            Protocol::Endat => None,
            other => Some(format!("speaks {}", other.name())),
        },
        false => Some("the card has none".into()),
    };
    if let Some(why) = why {
        return Err(HostError::Name(format!(
            "{what} = {channel}: {why}; the margin is measured on EnDat channels, give one of those"
        )));
    }
    if !card.identity().has(Part::Margin) {
        return Err(HostError::Part {
            what: "margin",
            part: "margin",
            remedy: "[line] parts = [\"alignment\", \"margin\"]",
        });
    }
    card.place(&format!("line{channel}.frames")).map(|_| ())
}

/// What the card has measured.
pub fn edges(card: &mut AnyCard, channel: usize) -> Result<Edges, HostError> {
    let first = card.place(&format!("line{channel}.edges_0"))?;
    let bins = card.bridge().read(first.address(), BINS)?;
    let mut field = |name: &str| card.read_named(&format!("line{channel}.{name}"));
    let shift = field("alignment.bin_shift")?;
    let (earliest, latest) = (
        field("worst.earliest")? as u8 as i8,
        field("worst.latest")? as u8 as i8,
    );
    let has_edges = field("worst.valid")? == 1;
    let (tracked, reference) = (field("phase.tracked")?, field("phase.reference")?);
    let (glitches, bad_frames) = (field("counts.glitches")?, field("counts.bad_frames")?);
    let frames = field("frames")?;
    let period = card.read_named(&format!("config{channel}.frame.period_cycles"))?;
    let identity = card.identity();
    let places_per_cycle = if identity.has(Part::DoubleEdge) { 2 } else { 1 };
    let place_ns = 1e9 / f64::from(identity.system_hz.max(1)) / f64::from(places_per_cycle);
    let cycle_ns = place_ns * f64::from(places_per_cycle);
    Ok(Edges {
        bins,
        places_per_bin: 1 << shift,
        half_bit_places: f64::from(period * places_per_cycle) / 2.0,
        place_ns,
        extremes: has_edges.then_some((earliest, latest)),
        frames,
        bad_frames,
        glitches,
        drift_ns: (f64::from(tracked) - f64::from(reference)) / 16.0 * cycle_ns,
        delay_ns: f64::from(tracked) / 16.0 * cycle_ns,
    })
}

/// Runs the command.
pub fn run(arguments: &MarginArgs) -> Result<Outcome, CommandError> {
    let frames = number_if("--frames", &arguments.frames, 1..=u64::from(u32::MAX))?;
    let frames = frames.map(|n| n as u32);
    let mut card = arguments.port.open()?;
    let channel = channel(&card, arguments.channel.as_deref())?;
    needs("--channel", &card, channel).map_err(told)?;
    let at = |register: &str| {
        Place::named(&format!("line{channel}.{register}"), channel + 1).map_err(told)
    };
    if let Some(frames) = frames {
        settled(&mut card)?;
        needs_trigger(&mut card, &arguments.port)?;
        card.write(&at("clear.clear")?, 1).map_err(told)?;
        let place = at("frames")?;
        let (mut counted, mut heard) = (0, Instant::now());
        while counted < frames {
            let now = card.read(&place).map_err(told)?;
            if now != counted {
                (counted, heard) = (now, Instant::now());
            }
            if heard.elapsed() > WAIT {
                return Err(CommandError::CheckFailed(vec![format!(
                    "--frames = {frames}: no frame for {} s, {counted} were counted; does the trigger come, is the encoder plugged in?",
                    WAIT.as_secs()
                )]));
            }
        }
    }
    let edges = edges(&mut card, channel).map_err(told)?;
    let mut outcome = Outcome::good(if arguments.json {
        to_json(&json!({
            "channel": channel,
            "frames": edges.frames,
            "bad_frames": edges.bad_frames,
            "glitches": edges.glitches,
            "place_ns": edges.place_ns,
            "half_bit_places": edges.half_bit_places,
            "places_per_bin": edges.places_per_bin,
            "earliest_places": edges.extremes.map(|(earliest, _)| earliest),
            "latest_places": edges.extremes.map(|(_, latest)| latest),
            "margin_ns": edges.margin_ns(),
            "delay_ns": edges.delay_ns,
            "drift_ns": edges.drift_ns,
            "edges": edges.bins,
        }))?
    } else {
        edges.to_string()
    });
    if edges.bad_frames > 0 {
        let (bad, counted) = (edges.bad_frames, edges.frames);
        outcome.messages.push(format!(
            "{bad} of {counted} frames were bad: where their edges are says nothing about the margin; `endat monitor` shows the causes"
        ));
        outcome.exit_code = 1;
    }
    if let Some(path) = &arguments.svg {
        let title = format!("Edges of DATA, channel {channel}");
        let file = File {
            option: "--svg",
            path: path.clone(),
            text: edges_svg(&edges, &title),
            is_ours: is_drawing,
        };
        outcome.messages.extend(write_all(&[file])?);
    }
    Ok(outcome)
}
