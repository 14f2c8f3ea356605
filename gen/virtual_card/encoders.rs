//! The encoders of a virtual card, and how they move.

use super::sets::Motion;
use super::{VirtualConfig, SECOND};
use crate::config::Project;
use crate::encoders;
use crate::error::{shown, GenError};
use endat_sim::bench::{TFormatLink, TFormatMotion};
use endat_sim::encoder::{EncoderConfig, DEVICES};
use endat_sim::t_format;
use endat_sim::{Time, MS, NS};
use std::sync::Arc;

/// The T-format encoder: single-turn position of 17 bits, multi-turn of 16.
const T_FORMAT_DEVICE: &str = "TS5700N8401";
/// An open plug, as `--encoder` calls it.
pub(super) const NO_DEVICE: &str = "none";
const T_FORMAT_SINGLE_BITS: u32 = 17;
/// Delay of a metre of cable, in nanoseconds.
const NS_PER_M: f64 = 5.0;

/// A name as people write it: without spaces, dashes and case.
fn plain(name: &str) -> String {
    let kept = name.chars().filter(|c| c.is_ascii_alphanumeric());
    kept.map(|c| c.to_ascii_lowercase()).collect()
}

fn is_t_format_device(name: &str) -> bool {
    plain(name) == plain(T_FORMAT_DEVICE)
}

/// The device that `--encoder` asks for on a channel. One for all is one for those that speak its protocol.
pub(super) fn wanted<'a>(
    project: &Project,
    channel: usize,
    devices: &'a [String],
) -> Option<&'a str> {
    let is_t_format = |n: usize| !project.card.channels[n].is_endat();
    match devices {
        [one] if one != NO_DEVICE => {
            let is_of = |n: usize| is_t_format(n) == is_t_format_device(one);
            let takes = is_of(channel) || !(0..project.card.channels.len()).any(is_of);
            takes.then_some(one.as_str())
        }
        _ => (devices.get(channel).or(devices.first())).map(String::as_str),
    }
}

/// The encoder called `name`; of the width and command that the channel is configured for when nobody says which.
pub(super) fn encoder(
    project: &Project,
    channel: usize,
    wanted: Option<&str>,
) -> Result<EncoderConfig, GenError> {
    let name = wanted.unwrap_or(&project.encoders[channel]);
    if let Some(device) = DEVICES.iter().find(|d| plain(d.name) == plain(name)) {
        let encoder = device.encoder();
        let (asked, own) = (
            project.card.channels[channel].position_bits,
            encoder.position_bits,
        );
        if wanted.is_some() && asked != own && !project.card.service.initialise {
            return Err(GenError::input(format!(
                "--encoder = {}: has positions of {own} bits, and channel {channel} asks for {asked}; take another one, or a card with \"initialise\" in service.parts, which asks the encoder",
                shown(name)
            )));
        }
        return Ok(encoder);
    }
    let known: Vec<&str> = DEVICES.iter().map(|d| d.name).collect();
    if wanted.is_some() {
        return Err(GenError::input(format!(
            "--encoder = {}: channel {channel} speaks EnDat; the devices there are {}, {NO_DEVICE}",
            shown(name),
            known.join(", ")
        )));
    }
    Ok(encoders::fitting(&project.card.channels[channel]))
}

/// A shaft that turns evenly, with a slow swing on top; a carriage that goes to and fro.
pub(super) fn motion(encoder: &EncoderConfig, channel: usize, speed: f64) -> Motion {
    let bits = encoder.position_bits;
    let (steps, is_rotary) = (
        f64::from(encoder.plate.measuring_steps),
        encoder.plate.rotary,
    );
    // Each channel at a pace of its own, so that nobody mistakes one for the other.
    let speed = speed * (1.0 + 0.5 * channel as f64);
    let start = 0.1 * (channel + 1) as f64;
    Arc::new(move |time: Time| {
        let s = time as f64 / SECOND;
        let swing = (s * 2.0).sin();
        let position = if is_rotary {
            (start + speed * s + 0.002 * swing) * steps
        } else {
            // Nanometres by nanometres per step: 10 mm to and fro around 100 mm.
            (1e8 + 1e7 * (speed * s).sin()) / steps.max(1.0)
        };
        position.max(0.0) as u64 & ((1u64 << bits) - 1)
    })
}

/// Single-turn and multi-turn position of a T-format encoder that turns evenly.
pub(super) fn t_format_motion(channel: usize, speed: f64) -> TFormatMotion {
    let speed = speed * (1.0 + 0.5 * channel as f64);
    let start = 100.1 * (channel + 1) as f64;
    Arc::new(move |time: Time| {
        let turns = start + speed * time as f64 / SECOND;
        let steps = (turns * f64::from(1 << T_FORMAT_SINGLE_BITS)).max(0.0) as u64;
        let single = steps & ((1 << T_FORMAT_SINGLE_BITS) - 1);
        (single as u32, (steps >> T_FORMAT_SINGLE_BITS) as u16 as u32)
    })
}

/// A T-format encoder on its line, turning as others do. `none` is an open plug; there is one device only.
pub(super) fn t_format_link(
    bit_hz: u64,
    channel: usize,
    wanted: Option<&str>,
    config: &VirtualConfig,
) -> Result<TFormatLink, GenError> {
    if let Some(name) = wanted.filter(|n| *n != NO_DEVICE && !is_t_format_device(n)) {
        return Err(GenError::input(format!(
            "--encoder = {}: channel {channel} speaks T-format; the devices there are {T_FORMAT_DEVICE} and {NO_DEVICE}",
            shown(name)
        )));
    }
    let encoder = t_format::EncoderConfig {
        bit_hz,
        // A battery that is full: otherwise every result would have that alarm.
        status: 0,
        alarm: 0,
        jitter: config.jitter_ns as Time * NS,
        write_time: MS,
        seed: config.seed.wrapping_add(channel as u64),
        ..t_format::EncoderConfig::default()
    };
    let mut link = TFormatLink::new(encoder, (config.cable_m * NS_PER_M * NS as f64) as Time);
    link.set_motion(t_format_motion(channel, config.speed));
    if wanted == Some(NO_DEVICE) {
        link.unplug();
    }
    Ok(link)
}
