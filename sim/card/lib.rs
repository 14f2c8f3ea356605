//! A card without hardware: the core as it is emitted, in the compiled engine, with an encoder on a cable at each port and a host at
//! its UART, or at a controller on its bus.
//!
//! ```text
//! host's bytes <-> Uart, or Gateway <-> Words <-> card (compiled) <-> line <-> encoder model, turning
//! ```
//!
//! Time is simulated time. In the same process ([`VirtualCard`] is a [`Transport`]) a host waits for nothing; behind a port
//! ([`serve`]) the card keeps real time as well as it can.

mod deed;
mod encoders;
mod faults;
mod gateway;
mod host_end;
mod protocols;
mod serve;
pub mod sets;
pub mod settings;
mod tcp;

pub use faults::{Fault, FAULTS};
pub use serve::{serve, Door, Pace};
pub use settings::{VirtualConfig, CABLE_M};
pub use tcp::CONTROL;

use encoders::{check_device, encoder, motion, wanted};
use endat_emit::encoders::SECOND;
use faults::PortOf;
use gateway::Gateway;
use host_end::HostEnd;
use sets::{Motion, Sets};
use settings::NO_DEVICE;

use crate::protocols::other;
use crate::protocols::t_format::{self, TFormat};
use crate::protocols::OtherFaults;
use endat_config::{load_file, load_preset, preset_of, Project, Receiver, DEFAULT_PRESET};
use endat_console::error::CommandError;
use endat_emit::buses::front;
use endat_emit::buses::parallel::Dsp;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::service_times;
use endat_hdl::config::CardConfig;
use endat_hdl::endat::service::program::ServiceTimes;
use endat_hdl::protocols::t_format::protocol::SYSTEM_HZ as RECEIVER_HZ;
use endat_host::owner::AnyCard;
use endat_host::transport::Port;
use endat_host::{Bridge, HostError, Transport};
use endat_sim::bench::{Bench, Link, PinNames, Uart};
use endat_sim::encoder::{LatchEdge, PositionSource};
use endat_sim::line::{Jitter, LineConfig};
use endat_sim::{Time, MS, NS, US};
use rtl_design::elaborate::Design;
use rtl_design::engine::Compiled;
use std::borrow::Cow;
use std::collections::VecDeque;
use std::io;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Frames that its encoders note, at least: nobody asks for older ones.
const NOTES: usize = 1_000;
/// A half-sent command is forgotten after this; real cards take 100 ms, which would be seconds of simulation.
const LINK_TIMEOUT_US: u64 = 5_000;
/// Waits of the initialisation, for the same reason; real ones add up to 1.9 s.
const POWER_UP_MS: u16 = 2;
const RESET_MS: u16 = 3;
const WRITE_MS: u16 = 2;

/// What can be wrong with an encoder of another protocol.
type Faults = Box<dyn OtherFaults>;

/// A simulated card.
pub struct VirtualCard {
    bench: Bench<Compiled>,
    host: HostEnd,
    /// Cycles that a wait of a host takes here, per microsecond.
    cycles_per_us: u64,
    /// Where the link of each channel is.
    ports: Vec<PortOf>,
    /// What it is where nobody has made it worse.
    jitter: Jitter,
    /// What is wrong with each of the encoders of other protocols, and whether some of it ends by itself.
    others: Vec<Faults>,
    is_spoilt: bool,
}

/// What a port begins with that is simulated in this process; `load` is a card whose sets of the stream are made.
const VIRTUAL: [(&str, bool); 2] = [("virtual", false), ("load", true)];

/// What is behind `virtual` or `load` in the name of a port: a preset or a file, which of the two it was, and whether sets are made; none for other ports.
fn behind_virtual(port: &str) -> Option<(&str, &'static str, bool)> {
    let found = VIRTUAL
        .iter()
        .find_map(|(word, makes_sets)| Some((port.strip_prefix(word)?, *word, *makes_sets)));
    match found? {
        ("", word, makes_sets) => Some((DEFAULT_PRESET, word, makes_sets)),
        (rest, word, makes_sets) => Some((rest.strip_prefix(':')?, word, makes_sets)),
    }
}

/// Whether the port is a card simulated in this process, whose time goes on only while somebody waits for it.
pub fn is_virtual(port: &str) -> bool {
    behind_virtual(port).is_some()
}

/// The card of a port called `virtual`, `virtual:PRESET` or `virtual:FILE.toml`, or the same with `load`; none for other ports.
pub fn virtual_card_at(port: &str) -> Result<Option<VirtualCard>, CommandError> {
    let Some((name, word, makes_sets)) = behind_virtual(port) else {
        return Ok(None);
    };
    let project = match name.ends_with(".toml") {
        true => load_file(Path::new(name))?,
        false => {
            preset_of(&format!("{word}:PRESET in --port"), name)?;
            load_preset(name)?
        }
    };
    let config = VirtualConfig {
        makes_sets,
        ..VirtualConfig::default()
    };
    VirtualCard::new(&project, &config).map(Some)
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

fn compiled(design: &Design) -> Result<Compiled, CommandError> {
    Compiled::new(design).map_err(|e| CommandError::fault("design", &e))
}

/// A compiled card, after reset, with the settings that it was made from.
type Kept = (HostBus, CardConfig, ServiceTimes, Compiled);

/// Cards that were compiled last: compiling takes longer than most simulations, and a process that opens one card often opens it again.
static KEPT: Mutex<VecDeque<Kept>> = Mutex::new(VecDeque::new());
const KEPT_CARDS: usize = 8;

/// The card of a project in native code.
fn compiled_card(project: &Project, times: ServiceTimes) -> Result<Compiled, CommandError> {
    let (bus, card) = (project.bus, &project.card);
    let is_it = |kept: &&Kept| kept.0 == bus && kept.1 == *card && kept.2 == times;
    let lock = || KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(kept) = lock().iter().find(is_it) {
        return Ok(kept.3.clone());
    }
    let new = compiled(&endat_emit::design_with(project, &times, LINK_TIMEOUT_US)?)?;
    let mut kept = lock();
    kept.push_front((bus, card.clone(), times, new.clone()));
    kept.truncate(KEPT_CARDS);
    Ok(new)
}

fn jitter(config: &VirtualConfig) -> Jitter {
    match config.jitter_ns {
        0 => Jitter::None,
        ns => Jitter::Uniform(ns as Time * NS),
    }
}

/// Plugs an encoder in at a channel; where its link is, and how it moves.
fn plug(
    bench: &mut Bench<Compiled>,
    project: &Project,
    channel: usize,
    config: &VirtualConfig,
) -> Result<(PortOf, Motion, Option<Faults>), CommandError> {
    let wanted = wanted(project, channel, &config.encoders);
    let settings = &project.card.channels[channel];
    let pins = PinNames::card(channel);
    if let Some(other) = other(settings.protocol()) {
        check_device(other, channel, wanted)?;
        let is_open = wanted == Some(NO_DEVICE);
        let plugged = other.plug(settings, channel, is_open, config);
        let port = PortOf::Other(bench.add_other(&pins, plugged.encoder));
        return Ok((port, plugged.motion, Some(plugged.faults)));
    }
    let is_open = wanted == Some(NO_DEVICE);
    let mut encoder = encoder(project, channel, wanted.filter(|_| !is_open))?;
    let motion = motion(&encoder, channel, config.speed);
    let at = motion.clone();
    encoder.position = PositionSource::Function(Arc::new(move |_, time| at(time)));
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
    let mut line = LineConfig::cable(config.cable_m).seed(config.seed.wrapping_add(channel as u64));
    line.data_in.jitter = jitter(config);
    let link = Link::new(line, encoder);
    Ok((PortOf::Endat(bench.add_endat(&pins, link)), motion, None))
}

impl VirtualCard {
    /// The card of a configuration.
    pub fn new(project: &Project, config: &VirtualConfig) -> Result<Self, CommandError> {
        let card = &project.card;
        if ![0, 1, card.channels.len()].contains(&config.encoders.len()) {
            return Err(CommandError::input(format!(
                "--encoder: given {} times; the card has {} channels: give one for all, or one for each",
                config.encoders.len(),
                card.channels.len()
            )));
        }
        if config.makes_sets && card.stream.fifo_bytes == 0 {
            return Err(CommandError::input(format!(
                "card {}: has no stream whose sets could be made; give stream.fifo_bytes in its configuration",
                project.name
            )));
        }
        let service = ServiceTimes {
            power_up_ms: POWER_UP_MS,
            after_pulse_ms: POWER_UP_MS,
            reset_ms: RESET_MS,
            write_ms: WRITE_MS,
            ..service_times(card)
        };
        let bus = match project.bus {
            // A port without a host has one here.
            HostBus::Bare => HostBus::Uart,
            // What is made does not come through the core's UART.
            HostBus::Uart if config.makes_sets => HostBus::Apb,
            bus => bus,
        };
        let mut project = Cow::Borrowed(project);
        if bus != project.bus {
            project.to_mut().bus = bus;
        }
        let mut bench = Bench::new(
            compiled_card(&project, service)?,
            card.system_hz,
            Vec::new(),
        );
        if card.line.double_edge {
            bench.set_double_edge();
        }
        let (mut ports, mut motions, mut others) = (Vec::new(), Vec::new(), Vec::new());
        for channel in 0..card.channels.len() {
            let (port, motion, faults) = plug(&mut bench, &project, channel, config)?;
            ports.push(port);
            motions.push(motion);
            others.extend(faults);
        }
        let sets = config.makes_sets.then(|| {
            Sets::new(
                motions,
                card.sample_period_cycles,
                card.system_hz,
                card.stream.additional_data,
            )
        });
        let host = match front(bus).controller {
            None => HostEnd::Uart(Uart::new(&mut bench, card.uart_bit_cycles)),
            Some(words) => HostEnd::Gateway(Gateway::new(words, &mut bench, LINK_TIMEOUT_US, sets)),
        };
        Ok(Self::powered(bench, host, (ports, others), jitter(config)))
    }

    /// A T-format receiver for a signal processor, which a controller sits at: its addresses, and no registers of a card.
    pub fn of_receiver(receiver: &Receiver, config: &VirtualConfig) -> Result<Self, CommandError> {
        if config.encoders.len() > 1 {
            return Err(CommandError::input(format!(
                "--encoder: given {} times; a receiver has one line: give one",
                config.encoders.len()
            )));
        }
        if config.makes_sets {
            return Err(CommandError::input(format!(
                "receiver {}: has no stream whose sets could be made; take the configuration of a card",
                receiver.name
            )));
        }
        let design = endat_emit::protocols::t_format::design(receiver)?;
        let mut bench = Bench::new(compiled(&design)?, RECEIVER_HZ[0], Vec::new());
        let wanted = config.encoders.first().map(String::as_str);
        check_device(&TFormat, 0, wanted)?;
        let is_open = wanted == Some(NO_DEVICE);
        let plugged = t_format::plug(receiver.bit_hz(), None, 0, is_open, config);
        bench.add_other(&PinNames::receiver(), plugged.encoder);
        let host = HostEnd::Gateway(Gateway::new(&Dsp, &mut bench, LINK_TIMEOUT_US, None));
        let ports = (vec![PortOf::Other(0)], vec![plugged.faults]);
        Ok(Self::powered(bench, host, ports, jitter(config)))
    }

    fn powered(
        mut bench: Bench<Compiled>,
        host: HostEnd,
        (ports, others): (Vec<PortOf>, Vec<Faults>),
        jitter: Jitter,
    ) -> Self {
        let cycles_per_us = (bench.system_hz() / 1_000_000).max(1);
        bench.power_up();
        bench.keep(NOTES);
        Self {
            others,
            is_spoilt: false,
            bench,
            host,
            cycles_per_us,
            ports,
            jitter,
        }
    }

    /// Runs for some system clock cycles.
    pub fn run(&mut self, cycles: u64) {
        let end = self.bench.cycle() + cycles;
        while self.bench.cycle() < end {
            self.host.step(&mut self.bench);
            if self.is_spoilt {
                self.mend();
            }
        }
    }

    /// Simulated time since power-up.
    pub fn now(&self) -> Time {
        self.bench.now()
    }

    /// Bytes for the card.
    pub fn send_bytes(&mut self, bytes: &[u8]) {
        self.host.send(bytes, self.bench.cycle());
    }

    /// Bytes that have come from it.
    pub fn take_bytes(&mut self) -> Vec<u8> {
        self.host.received().drain(..).collect()
    }

    /// Bytes that the card has not taken yet.
    pub fn unsent(&self) -> usize {
        self.host.unsent()
    }

    /// Bytes of the host that have not become a command yet, whether they ever do or not.
    pub fn untaken(&self) -> usize {
        self.host.untaken()
    }

    /// The host has gone: whole commands that it has sent are carried out if they are few, half a one is forgotten, answers are nobody's.
    pub fn forget_host(&mut self) {
        let timeout = LINK_TIMEOUT_US * self.cycles_per_us;
        let end = self.bench.cycle() + timeout;
        while self.host.unsent() > 0 && self.bench.cycle() < end {
            self.run(STEP_CYCLES);
        }
        self.host.forget();
        // A little longer than the card waits for the rest of a command; the byte under way comes before that.
        self.run(timeout + timeout / 8);
        self.host.received().clear();
    }

    /// What is not simulated comes in real time from now on.
    pub fn keep_time(&mut self) {
        self.host.keep_time();
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
        self.host.send(bytes, self.bench.cycle());
        Ok(())
    }

    /// Its own time: however long its simulation takes, no answer is late.
    fn elapsed(&self) -> Duration {
        Duration::from_nanos(self.bench.now() / 1_000)
    }

    /// A wait is simulated time; waits of a host that would be long are cut, since this card has shorter ones itself.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let us = (wait.as_micros() as u64).clamp(HOST_US, 4 * LINK_TIMEOUT_US);
        let end = self.bench.cycle() + us * self.cycles_per_us;
        while self.host.received().is_empty() && self.bench.cycle() < end {
            self.run(STEP_CYCLES);
        }
        let count = buffer.len().min(self.host.received().len());
        for (to, from) in buffer.iter_mut().zip(self.host.received().drain(..count)) {
            *to = from;
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a wait by the clock on the wall: beside other work the simulation is slow, and answers would come too late.
    #[test]
    fn a_wait_at_a_virtual_card_is_simulated_time() {
        let mut card = virtual_card_at("virtual:demo").unwrap().unwrap();
        let before = card.elapsed();
        assert_eq!(
            card.receive(&mut [0], Duration::from_millis(10)).unwrap(),
            0
        );
        let waited_us = (card.elapsed() - before).as_micros() as u64;
        // It looks every few cycles.
        assert!((10_000..10_100).contains(&waited_us), "{waited_us} us");
    }
}
