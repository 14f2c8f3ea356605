//! A card without hardware: the core as it is emitted, in the compiled engine, with an encoder on a cable at each port and a host at
//! its UART.
//!
//! ```text
//! host's bytes <-> Uart <-> Card (compiled) <-> line <-> encoder model, turning
//! ```
//!
//! Time is simulated time. In the same process ([`VirtualCard`] is a [`Transport`]) a host waits for nothing; behind a port
//! ([`serve`]) the card keeps real time as well as it can.

mod faults;
mod serve;

pub use faults::{Fault, FAULTS};
pub use serve::{serve, Door, Pace, CONTROL};

use faults::PortOf;

use crate::config::{load_file, load_preset, preset_of, Project, DEFAULT_PRESET};
use crate::encoders;
use crate::error::{shown, GenError};
use endat_hdl::card::{service_times, Card};
use endat_hdl::endat::service::program::ServiceTimes;
use endat_host::owner::AnyCard;
use endat_host::transport::Port;
use endat_host::{Bridge, HostError, Transport};
use endat_sim::bench::{Bench, Link, PinNames, TFormatLink, Uart};
use endat_sim::encoder::{EncoderConfig, LatchEdge, PositionSource, DEVICES};
use endat_sim::line::{Jitter, LineConfig};
use endat_sim::t_format;
use endat_sim::{Time, MS, NS, US};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Cable between card and encoders, unless told otherwise.
pub const CABLE_M: f64 = 10.0;
/// A half-sent command is forgotten after this; real cards take 100 ms, which would be seconds of simulation.
const LINK_TIMEOUT_US: u64 = 5_000;
/// Waits of the initialisation, for the same reason; real ones add up to 1.9 s.
const POWER_UP_MS: u16 = 2;
const RESET_MS: u16 = 3;
const WRITE_MS: u16 = 2;

/// The T-format encoder: single-turn position of 17 bits, multi-turn of 16.
const T_FORMAT_DEVICE: &str = "TS5700N8401";
/// An open plug, as `--encoder` calls it.
const NO_DEVICE: &str = "none";
const T_FORMAT_SINGLE_BITS: u32 = 17;
/// Delay of a metre of cable, in nanoseconds.
const NS_PER_M: f64 = 5.0;

/// A second of simulated time.
const SECOND: f64 = 1_000.0 * MS as f64;

/// What a virtual card is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct VirtualConfig {
    /// Device at each port, `none` for an open plug; one for all, or one for each. Empty: what the configuration names.
    pub encoders: Vec<String>,
    /// Cable to each encoder in metres.
    pub cable_m: f64,
    /// DATA edges come up to so much earlier or later, in nanoseconds.
    pub jitter_ns: u64,
    /// How fast shafts turn, in turns per second (linear encoders: hundredths of a metre per second).
    pub speed: f64,
    /// Seed of everything random.
    pub seed: u64,
}

impl Default for VirtualConfig {
    fn default() -> Self {
        Self {
            encoders: Vec::new(),
            cable_m: CABLE_M,
            jitter_ns: 0,
            speed: 0.25,
            seed: 1,
        }
    }
}

/// A simulated card.
pub struct VirtualCard {
    bench: Bench<Compiled>,
    uart: Uart,
    /// Cycles that a wait of a host takes here, per microsecond.
    cycles_per_us: u64,
    /// Where the link of each channel is.
    ports: Vec<PortOf>,
    /// What it is where nobody has made it worse.
    jitter: Jitter,
}

/// A name as people write it: without spaces, dashes and case.
fn plain(name: &str) -> String {
    let kept = name.chars().filter(|c| c.is_ascii_alphanumeric());
    kept.map(|c| c.to_ascii_lowercase()).collect()
}

fn is_t_format_device(name: &str) -> bool {
    plain(name) == plain(T_FORMAT_DEVICE)
}

/// The device that `--encoder` asks for on a channel. One for all is one for those that speak its protocol.
fn wanted<'a>(project: &Project, channel: usize, devices: &'a [String]) -> Option<&'a str> {
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
fn encoder(
    project: &Project,
    channel: usize,
    wanted: Option<&str>,
) -> Result<EncoderConfig, GenError> {
    let name = wanted.unwrap_or(&project.encoders[channel]);
    if let Some(device) = DEVICES.iter().find(|d| plain(d.name) == plain(name)) {
        return Ok(device.encoder());
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
fn motion(encoder: &EncoderConfig, channel: usize, speed: f64) -> PositionSource {
    let bits = encoder.position_bits;
    let (steps, is_rotary) = (
        f64::from(encoder.plate.measuring_steps),
        encoder.plate.rotary,
    );
    // Each channel at a pace of its own, so that nobody mistakes one for the other.
    let speed = speed * (1.0 + 0.5 * channel as f64);
    let start = 0.1 * (channel + 1) as f64;
    PositionSource::Function(Arc::new(move |_, time: Time| {
        let s = time as f64 / SECOND;
        let swing = (s * 2.0).sin();
        let position = if is_rotary {
            (start + speed * s + 0.002 * swing) * steps
        } else {
            // Nanometres by nanometres per step: 10 mm to and fro around 100 mm.
            (1e8 + 1e7 * (speed * s).sin()) / steps.max(1.0)
        };
        position.max(0.0) as u64 & ((1u64 << bits) - 1)
    }))
}

/// A T-format encoder on its line, turning as others do. `none` is an open plug; there is one device only.
fn t_format_link(
    project: &Project,
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
    let request = project.card.channels[channel].t_format.unwrap_or_default();
    let encoder = t_format::EncoderConfig {
        bit_hz: request.bit_hz,
        // A battery that is full: otherwise every result would have that alarm.
        status: 0,
        alarm: 0,
        jitter: config.jitter_ns as Time * NS,
        write_time: MS,
        seed: config.seed.wrapping_add(channel as u64),
        ..t_format::EncoderConfig::default()
    };
    let mut link = TFormatLink::new(encoder, (config.cable_m * NS_PER_M * NS as f64) as Time);
    let speed = config.speed * (1.0 + 0.5 * channel as f64);
    let start = 100.1 * (channel + 1) as f64;
    link.set_motion(Arc::new(move |time: Time| {
        let turns = start + speed * time as f64 / SECOND;
        let steps = (turns * f64::from(1 << T_FORMAT_SINGLE_BITS)).max(0.0) as u64;
        let single = steps & ((1 << T_FORMAT_SINGLE_BITS) - 1);
        (single as u32, (steps >> T_FORMAT_SINGLE_BITS) as u16 as u32)
    }));
    if wanted == Some(NO_DEVICE) {
        link.unplug();
    }
    Ok(link)
}

/// What is behind `virtual` in the name of a port: a preset or a file; none for other ports.
fn behind_virtual(port: &str) -> Option<&str> {
    match port.strip_prefix("virtual")? {
        "" => Some(DEFAULT_PRESET),
        rest => rest.strip_prefix(':'),
    }
}

/// Whether the port is a card simulated in this process, whose time goes on only while somebody waits for it.
pub fn is_virtual(port: &str) -> bool {
    behind_virtual(port).is_some()
}

/// The card of a port called `virtual`, `virtual:PRESET` or `virtual:FILE.toml`; none for other ports.
pub fn virtual_card_at(port: &str) -> Result<Option<VirtualCard>, GenError> {
    let project = match behind_virtual(port) {
        None => return Ok(None),
        Some(file) if file.ends_with(".toml") => load_file(Path::new(file))?,
        Some(name) => {
            preset_of("virtual:PRESET in --port", name)?;
            load_preset(name)?
        }
    };
    VirtualCard::new(&project, &VirtualConfig::default()).map(Some)
}

/// Finds the card of a port, real or simulated. What is wrong with the configuration of a simulated one is told as a wrong name.
pub fn card_at(port: &str, baud: u32) -> Result<AnyCard, HostError> {
    let virtual_card = virtual_card_at(port);
    let virtual_card = virtual_card.map_err(|e| HostError::Name(e.messages().join("\n")))?;
    let transport: Box<dyn Transport> = match virtual_card {
        Some(card) => Box::new(card),
        None => Box::new(Port::open(port, baud)?),
    };
    AnyCard::find(Bridge::new(transport))
}

impl VirtualCard {
    /// The card of a configuration.
    pub fn new(project: &Project, config: &VirtualConfig) -> Result<Self, GenError> {
        let fault = |e: &dyn std::fmt::Display| {
            GenError::input(format!(
                "design: {e}; this is a fault of endat-gen, please report it"
            ))
        };
        let card = &project.card;
        if ![0, 1, card.channels.len()].contains(&config.encoders.len()) {
            return Err(GenError::input(format!(
                "--encoder: given {} times; the card has {} channels: give one for all, or one for each",
                config.encoders.len(),
                card.channels.len()
            )));
        }
        let service = ServiceTimes {
            power_up_ms: POWER_UP_MS,
            after_pulse_ms: POWER_UP_MS,
            reset_ms: RESET_MS,
            write_ms: WRITE_MS,
            ..service_times(card)
        };
        let mut block = Card::with_times(card, LINK_TIMEOUT_US, &service);
        block.connect_all();
        let design = elaborate(&block, "card").map_err(|e| fault(&e))?;
        let engine = Compiled::new(&design).map_err(|e| fault(&e))?;
        let jitter = match config.jitter_ns {
            0 => Jitter::None,
            ns => Jitter::Uniform(ns as Time * NS),
        };
        let mut ports = Vec::new();
        let mut links = Vec::new();
        let mut t_format = Vec::new();
        for channel in 0..card.channels.len() {
            let wanted = wanted(project, channel, &config.encoders);
            if !card.channels[channel].is_endat() {
                let link = t_format_link(project, channel, wanted, config)?;
                ports.push(PortOf::TFormat(t_format.len()));
                t_format.push((PinNames::card(channel), link));
                continue;
            }
            let is_open = wanted == Some(NO_DEVICE);
            let mut encoder = encoder(project, channel, wanted.filter(|_| !is_open))?;
            encoder.position = motion(&encoder, channel, config.speed);
            encoder.seed = config.seed.wrapping_add(channel as u64);
            // As short as the card's waits.
            encoder.reset_time = encoder.reset_time.min(Time::from(RESET_MS) * MS);
            encoder.write_time = MS..=MS;
            encoder.tac = 50 * US..=100 * US;
            // They know the continuous clock, as the host may ask for it.
            encoder.continuous = Some(LatchEdge::AfterLow);
            if is_open {
                encoder.unplugged.push(0..Time::MAX);
            }
            let mut line =
                LineConfig::cable(config.cable_m).seed(config.seed.wrapping_add(channel as u64));
            line.data_in.jitter = jitter;
            ports.push(PortOf::Endat(links.len()));
            links.push((PinNames::card(channel), Link::new(line, encoder)));
        }
        let mut bench = Bench::new(engine, card.system_hz, links);
        for (names, link) in t_format {
            bench.add_t_format(&names, link);
        }
        if card.line.double_edge {
            bench.set_double_edge();
        }
        let uart = Uart::new(&mut bench, card.uart_bit_cycles);
        bench.power_up();
        Ok(Self {
            bench,
            uart,
            cycles_per_us: (card.system_hz / 1_000_000).max(1),
            ports,
            jitter,
        })
    }

    /// Runs for some system clock cycles.
    pub fn run(&mut self, cycles: u64) {
        for _ in 0..cycles {
            self.uart.tick(&mut self.bench);
        }
    }

    /// Simulated time since power-up.
    pub fn now(&self) -> Time {
        self.bench.now()
    }

    /// Bytes for the card.
    pub fn send_bytes(&mut self, bytes: &[u8]) {
        self.uart.send(bytes);
    }

    /// Bytes that have come from it.
    pub fn take_bytes(&mut self) -> Vec<u8> {
        self.uart.received().drain(..).collect()
    }

    /// Bytes that the card has not taken yet.
    pub fn unsent(&self) -> usize {
        self.uart.unsent()
    }

    /// The host has gone: whole commands that it has sent are carried out if they are few, half a one is forgotten, answers are nobody's.
    pub fn forget_host(&mut self) {
        let timeout = LINK_TIMEOUT_US * self.cycles_per_us;
        let end = self.bench.cycle() + timeout;
        while self.uart.unsent() > 0 && self.bench.cycle() < end {
            self.run(STEP_CYCLES);
        }
        self.uart.forget();
        // A little longer than the card waits for the rest of a command; the byte under way comes before that.
        self.run(timeout + timeout / 8);
        self.uart.received().clear();
    }

    /// Its bench, to make something wrong.
    pub fn bench(&mut self) -> &mut Bench<Compiled> {
        &mut self.bench
    }

    /// Rising edge at the trigger pin.
    pub fn trigger(&mut self) {
        self.bench.trigger();
    }
}

/// A host takes this long for anything.
const HOST_US: u64 = 20;
/// Cycles between two looks at whether an answer has come.
const STEP_CYCLES: u64 = 64;

impl Transport for VirtualCard {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.uart.send(bytes);
        Ok(())
    }

    /// A wait is simulated time; waits of a host that would be long are cut, since this card has shorter ones itself.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let us = (wait.as_micros() as u64).clamp(HOST_US, 4 * LINK_TIMEOUT_US);
        let end = self.bench.cycle() + us * self.cycles_per_us;
        while self.uart.received().is_empty() && self.bench.cycle() < end {
            self.run(STEP_CYCLES);
        }
        let count = buffer.len().min(self.uart.received().len());
        for (to, from) in buffer.iter_mut().zip(self.uart.received().drain(..count)) {
            *to = from;
        }
        Ok(count)
    }
}
