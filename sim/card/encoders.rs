//! The encoders of a virtual card, and how they move.

use super::sets::Motion;
use super::settings::NO_DEVICE;
use crate::protocols::OtherEncoders;
use crate::protocols::OTHERS;
use endat_config::Project;
use endat_console::error::{shown, CommandError};
use endat_emit::encoders;
use endat_emit::encoders::SECOND;
use endat_regs::Protocol;
use endat_sim::encoder::{EncoderConfig, DEVICES};
use endat_sim::Time;
use std::sync::Arc;

/// A name as people write it: without spaces, dashes and case.
fn plain(name: &str) -> String {
    let kept = name.chars().filter(|c| c.is_ascii_alphanumeric());
    kept.map(|c| c.to_ascii_lowercase()).collect()
}

fn has_device(other: &dyn OtherEncoders, name: &str) -> bool {
    let mut devices = other.devices().iter();
    devices.any(|device| plain(device) == plain(name))
}

/// What a device speaks.
fn protocol_of(name: &str) -> Protocol {
    let other = OTHERS.iter().find(|other| has_device(**other, name));
    other.map_or(Protocol::Endat, |other| other.protocol())
}

/// Refuses a device that speaks something else than the channel.
pub(super) fn check_device(
    other: &dyn OtherEncoders,
    channel: usize,
    wanted: Option<&str>,
) -> Result<(), CommandError> {
    let Some(name) = wanted.filter(|n| *n != NO_DEVICE && !has_device(other, n)) else {
        return Ok(());
    };
    Err(CommandError::input(format!(
        "--encoder = {}: channel {channel} speaks {}; the devices there are {} and {NO_DEVICE}",
        shown(name),
        other.protocol().name(),
        other.devices().join(", ")
    )))
}

/// The device that `--encoder` asks for on a channel. One for all is one for those that speak its protocol.
pub(super) fn wanted<'a>(
    project: &Project,
    channel: usize,
    devices: &'a [String],
) -> Option<&'a str> {
    match devices {
        [one] if one != NO_DEVICE => {
            let is_of = |n: usize| project.card.channels[n].protocol() == protocol_of(one);
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
) -> Result<EncoderConfig, CommandError> {
    let name = wanted.unwrap_or(&project.encoders[channel]);
    if let Some(device) = DEVICES.iter().find(|d| plain(d.name) == plain(name)) {
        let encoder = device.encoder();
        let (asked, own) = (
            project.card.channels[channel].position_bits,
            encoder.position_bits,
        );
        if wanted.is_some() && asked != own && !project.card.service.initialise {
            return Err(CommandError::input(format!(
                "--encoder = {}: has positions of {own} bits, and channel {channel} asks for {asked}; take another one, or a card with \"initialise\" in service.parts, which asks the encoder",
                shown(name)
            )));
        }
        return Ok(encoder);
    }
    let known: Vec<&str> = DEVICES.iter().map(|d| d.name).collect();
    if wanted.is_some() {
        return Err(CommandError::input(format!(
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
