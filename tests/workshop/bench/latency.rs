//! Latencies of the core in simulation: from the trigger to the first clock edge, from the deciding sample to the result, and from the
//! result to the words that a host reads over each link.
//!
//! ```text
//! trigger -> first falling clock edge ... level at the pin -> sample of the bit after the CRC -> result -> words at the host
//! ```

use super::{fault, preset_run};
use endat_config::{load_preset, Project, DEFAULT_PRESET, PRESETS};
use endat_console::error::CommandError;
use endat_emit::buses::front;
use endat_emit::encoders;
use endat_emit::front::{design_of, Controller};
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::direct::CROP_CYCLES;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_hdl::endat::channel::{Channel, FixedTimes};
use endat_hdl::regs::{Block, RESULT};
use endat_regs::Protocol;
use endat_sim::bench::{Bench, Link, PinNames, Uart};
use endat_sim::campaign::{Case, SAMPLE_LATENCY_CYCLES};
use endat_sim::line::LineConfig;
use endat_sim::{Time, MS, US};
use rtl_design::elaborate::Design;
use rtl_design::engine::Compiled;
use serde::Serialize;
use std::fmt;

/// Cable between card and encoder, in metres.
const CABLE_M: f64 = 1.0;
/// Frames of a channel that are triggered; the first one measures the line delay before it.
const FRAMES: usize = 4;
/// Good frames that a figure takes.
const FRAMES_MIN: usize = 2;
/// Longer than any frame.
const FRAME_LIMIT: Time = 5 * MS;
/// Frames of a card before the measured one, and the time of each.
const WARM_UPS: usize = 2;
const WARM_UP: Time = 600 * US;
/// Words that the host reads: status and both words of the position.
const WORDS: usize = 3;
/// No read over a link takes longer, in system clock cycles.
const READ_CYCLES_MAX: u64 = 1_000_000;
/// UARTBone: read words of addresses that rise.
const UART_READ: u8 = 2;

/// A time in cycles of a system clock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Span {
    /// System clock cycles; a sample on the falling edge of the system clock counts half a cycle.
    pub cycles: f64,
    /// The same in ns.
    pub ns: f64,
}

impl Span {
    fn of_halves(halves: u64, system_hz: u64) -> Self {
        let cycles = halves as f64 / 2.0;
        Self {
            cycles,
            ns: cycles * 1e9 / system_hz as f64,
        }
    }

    fn of(cycles: u64, system_hz: u64) -> Self {
        Self::of_halves(2 * cycles, system_hz)
    }
}

impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{} ({:.1} ns)", self.cycles, self.ns);
        f.pad(&text)
    }
}

/// Latencies of the first EnDat channel of a preset.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelLatency {
    /// Preset.
    pub preset: &'static str,
    /// System clock.
    pub system_hz: u64,
    /// EnDat clock.
    pub clock_hz: u64,
    /// From the trigger strobe to the first falling clock edge.
    pub trigger_to_fall: Span,
    /// From the level at the pin to its sample: synchroniser, filter and majority.
    pub pin_to_sample: Span,
    /// From the sample of the bit that follows the last CRC bit to the result strobe.
    pub sample_to_result: Span,
    /// Sum of the last two.
    pub pin_to_result: Span,
}

/// Latencies of the card of the default preset with a link.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkLatency {
    /// Bus, as in a configuration.
    pub bus: &'static str,
    /// System clock.
    pub system_hz: u64,
    /// From the edge at the trigger pin to the first falling clock edge.
    pub trigger_pin_to_fall: Span,
    /// From the result strobe until the host has status and position.
    pub result_to_host: Span,
    /// Why the figure does not hold, if it does not.
    pub failure: Option<String>,
}

/// All latencies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Latencies {
    /// Channels.
    pub channels: Vec<ChannelLatency>,
    /// Presets with an EnDat channel for which the bench has no figures.
    pub not_measured: Vec<&'static str>,
    /// Links.
    pub links: Vec<LinkLatency>,
}

/// Cycle of an edge of the system clock.
fn cycle_at(time: Time, system_hz: u64) -> u64 {
    let picoseconds = 1_000_000_000_000;
    ((u128::from(time) * u128::from(system_hz) + picoseconds / 2) / picoseconds) as u64
}

/// Cycles in which a watched port changed to this level.
fn changes_to(bench: &Bench<Compiled>, name: &str, level: u128) -> Vec<u64> {
    let port = bench.watched().iter().find(|port| port.name() == name);
    let changes = port.into_iter().flat_map(|port| port.changes());
    changes
        .filter(|(_, value)| *value == level)
        .map(|(time, _)| cycle_at(*time, bench.system_hz()))
        .collect()
}

/// A channel with the settings of a card's channel.
fn case(card: &CardConfig, channel: &ChannelConfig) -> Case {
    let (hz, spec) = (card.system_hz, &channel.spec);
    let rates = (hz, spec.clock_hz);
    let mut case = Case::new(rates, channel.command, channel.position_bits, CABLE_M);
    case.features.alignment = card.line.alignment;
    case.features.double_edge = card.line.double_edge;
    case.settings = case.settings.start_time_ns(spec.tst_ns, hz);
    case.settings.filter_cycles = channel.filter_cycles;
    case.settings.filter_half = channel.filter_half;
    case.settings.majority = card.line.samples == 3;
    case
}

/// The block of a card's channel, with its clock for frames that measure the line delay.
fn design(case: &Case, card: &CardConfig, channel: &ChannelConfig) -> Result<Design, CommandError> {
    let times = FixedTimes {
        abort_us: case.settings.abort_us,
        ready_low_cycles: case.settings.ready_low_cycles,
        calibration_period_cycles: channel.calibration_period_cycles(card.system_hz),
        ..FixedTimes::at(card.system_hz)
    };
    design_of(Channel::with(times, case.features), "channel")
}

/// Half cycles from the level at the pin to its sample.
fn pin_halves(case: &Case) -> u64 {
    let settings = &case.settings;
    let majority = match (settings.majority, case.features.double_edge) {
        (false, _) => 0,
        (true, false) => 2,
        (true, true) => 1,
    };
    let filter = 2 * settings.filter_cycles + u64::from(settings.filter_half);
    2 * SAMPLE_LATENCY_CYCLES + filter + majority
}

/// The one figure that all frames have.
fn constant(figures: &[u64], what: &str) -> Result<u64, CommandError> {
    match figures {
        [first, rest @ ..] if rest.iter().all(|figure| figure == first) => Ok(*first),
        _ => Err(fault(&format!(
            "{what} is not the same in every frame: {figures:?}"
        ))),
    }
}

/// Measures a channel of a preset; none if the encoder of the bench gives no position at these clocks.
fn channel(
    preset: &'static str,
    card: &CardConfig,
    channel: &ChannelConfig,
) -> Result<Option<ChannelLatency>, CommandError> {
    let case = case(card, channel);
    let design = design(&case, card, channel)?;
    let engine = Compiled::new(&design).map_err(|e| fault(&e))?;
    let mut bench = case.bench(engine);
    bench.configure(&case.settings);
    bench.power_up();
    let (clock, strobe) = ("endat_clk", "sample_strobe");
    bench.watch(clock);
    bench.watch(strobe);
    let (mut to_fall, mut to_result) = (vec![], vec![]);
    for _ in 0..FRAMES {
        if !bench.run_until_done(FRAME_LIMIT, |b| b.get("busy") == 0) {
            return Err(fault(&format!("{preset}: the channel stays busy")));
        }
        let triggered = bench.cycle();
        let result = bench.frame(FRAME_LIMIT);
        let result = result.filter(|result| result.fresh && result.position_valid);
        let Some(result) = result else { continue };
        let falls = changes_to(&bench, clock, 0);
        let fall = falls.iter().find(|cycle| **cycle > triggered);
        let samples = changes_to(&bench, strobe, 1);
        // The presets have four cycles or more in a bit: no cell ends between the deciding sample and its result.
        let sample = samples.iter().rfind(|cycle| **cycle <= result.cycle);
        to_fall.extend(fall.map(|fall| fall - triggered));
        to_result.extend(sample.map(|sample| result.cycle - sample));
    }
    if to_result.len() < FRAMES_MIN {
        return Ok(None);
    }
    let hz = card.system_hz;
    let to_result = constant(&to_result, "the time from sample to result")?;
    Ok(Some(ChannelLatency {
        preset,
        system_hz: hz,
        clock_hz: channel.spec.clock_hz,
        trigger_to_fall: Span::of(constant(&to_fall, "the time from trigger to edge")?, hz),
        pin_to_sample: Span::of_halves(pin_halves(&case), hz),
        sample_to_result: Span::of(to_result, hz),
        pin_to_result: Span::of_halves(pin_halves(&case) + 2 * to_result, hz),
    }))
}

/// Address of a word of channel 0.
fn at(block: &Block, name: &str) -> Result<u16, CommandError> {
    let register = block.register(name);
    let register = register.ok_or_else(|| fault(&format!("no register {name}")))?;
    Ok(block.address(register, 0))
}

/// A host at the pins of a card.
enum Host {
    Uart(Uart),
    Controller(&'static dyn Controller),
}

impl Host {
    /// Puts the pins of the link to rest.
    fn new(project: &Project, bench: &mut Bench<Compiled>) -> Self {
        match front(project.bus).controller {
            None => Self::Uart(Uart::new(bench, project.card.uart_bit_cycles)),
            Some(controller) => {
                controller.rest(bench);
                Self::Controller(controller)
            }
        }
    }

    /// Status and position of channel 0, from the cycle of the result on.
    fn read(&mut self, bench: &mut Bench<Compiled>) -> Result<Vec<u32>, CommandError> {
        let end = bench.cycle() + READ_CYCLES_MAX;
        let address = at(&RESULT, "status")?;
        let uart = match self {
            Self::Controller(controller) => {
                // Registers that follow the results show the position before at first.
                let Some(before) = controller.newest(bench) else {
                    return Ok(controller.read(bench, address, WORDS, true));
                };
                let mut words = before.clone();
                while words == before && bench.cycle() < end {
                    words = controller.newest(bench).unwrap_or_default();
                }
                return Ok(words);
            }
            Self::Uart(uart) => uart,
        };
        let [high, low] = address.to_be_bytes();
        uart.send(&[UART_READ, WORDS as u8, 0, 0, high, low]);
        while uart.received().len() < 4 * WORDS && bench.cycle() < end {
            uart.tick(bench);
        }
        let bytes: Vec<u8> = uart.received().drain(..).collect();
        let word = |b: &[u8]| u32::from_be_bytes([b[0], b[1], b[2], b[3]]);
        Ok(bytes.chunks_exact(4).map(word).collect())
    }
}

/// A card after its first frames, with its host, in the cycle before the measured trigger.
fn ready(project: &Project, engine: Compiled) -> (Bench<Compiled>, Host) {
    let card = &project.card;
    let link = |(n, channel): (usize, &ChannelConfig)| {
        let line = LineConfig::cable(CABLE_M).seed(n as u64 + 1);
        let mut encoder = encoders::turning(channel, n);
        encoder.tm = 10 * US..=12 * US;
        (PinNames::card(n), Link::new(line, encoder))
    };
    let links = card.channels.iter().enumerate().map(link).collect();
    let mut bench = Bench::new(engine, card.system_hz, links);
    let host = Host::new(project, &mut bench);
    bench.power_up();
    for _ in 0..WARM_UPS {
        bench.trigger();
        bench.run_for(WARM_UP);
    }
    (bench, host)
}

/// Runs to the cycle in which an output has this level; false if that never comes.
fn reaches(bench: &mut Bench<Compiled>, output: &str, level: u128) -> bool {
    bench.run_until_done(FRAME_LIMIT, |b| b.get(output) == level)
}

/// Why the words are not the last frame's position, if they are not.
fn wrong(bench: &Bench<Compiled>, words: &[u32]) -> Option<String> {
    let sent = bench.frames(0).last().map(|frame| frame.position);
    let read = match words {
        [_, low, high] => u64::from(*low) | u64::from(high & 0xFFFF) << 32,
        _ => return Some(format!("{} words instead of {WORDS}", words.len())),
    };
    (sent != Some(read)).then(|| format!("the host read {read:#x} instead of {sent:#x?}"))
}

/// Measures the card with a link: one run finds the cycle of the result, in the next one the host begins to read in that cycle.
fn link(project: &Project) -> Result<LinkLatency, CommandError> {
    let hz = project.card.system_hz;
    let engine = Compiled::new(&endat_emit::design(project)?).map_err(|e| fault(&e))?;
    let (mut bench, _) = ready(project, engine.clone());
    let triggered = bench.cycle();
    bench.trigger();
    let mut failure = None;
    if !reaches(&mut bench, "endat_clk0_o", 0) {
        failure = Some("no clock edge after the trigger".to_owned());
    }
    let fall = bench.cycle();
    if !reaches(&mut bench, "direct_fresh0_o", 1) {
        failure = Some("no position after the trigger".to_owned());
    }
    let result = bench.cycle() - CROP_CYCLES;
    let (mut bench, mut host) = ready(project, engine);
    bench.trigger();
    bench.run_cycles(result - bench.cycle());
    let words = host.read(&mut bench)?;
    Ok(LinkLatency {
        bus: project.bus.name(),
        system_hz: hz,
        trigger_pin_to_fall: Span::of(fall - triggered, hz),
        result_to_host: Span::of(bench.cycle() - result, hz),
        failure: failure.or_else(|| wrong(&bench, &words)),
    })
}

/// The card of the default preset without its stream, with outputs that show when a position is new.
fn card() -> Result<Project, CommandError> {
    let mut project = preset_run::project(DEFAULT_PRESET)?;
    project.card.stream = Default::default();
    project.card.outputs.position = true;
    Ok(project)
}

/// Measures the first EnDat channel of every preset, and every link.
pub fn latencies() -> Result<Latencies, CommandError> {
    let (mut channels, mut not_measured) = (vec![], vec![]);
    for (preset, _) in PRESETS {
        let card = load_preset(preset)?.card;
        let is_endat = |c: &&ChannelConfig| c.protocol() == Protocol::Endat;
        if let Some(first) = card.channels.iter().find(is_endat) {
            match channel(preset, &card, first)? {
                Some(row) => channels.push(row),
                None => not_measured.push(*preset),
            }
        }
    }
    let mut project = card()?;
    let mut links = vec![];
    for bus in HostBus::ALL {
        // A port without registers has no host.
        if bus != HostBus::Bare {
            project.bus = bus;
            links.push(link(&project)?);
        }
    }
    Ok(Latencies {
        channels,
        not_measured,
        links,
    })
}

impl Latencies {
    /// True if every host read the position of the frame.
    pub fn is_good(&self) -> bool {
        self.links.iter().all(|link| link.failure.is_none())
    }
}

impl fmt::Display for Latencies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "first EnDat channel of each preset, in system clock cycles"
        )?;
        writeln!(
            f,
            "{:<24} {:>9} {:>9}  {:<18} {:<18} {:<18} pin to result",
            "preset",
            "clock MHz",
            "EnDat MHz",
            "trigger to edge",
            "pin to sample",
            "sample to result",
        )?;
        for row in &self.channels {
            writeln!(
                f,
                "{:<24} {:>9.3} {:>9.3}  {:<18} {:<18} {:<18} {}",
                row.preset,
                row.system_hz as f64 / 1e6,
                row.clock_hz as f64 / 1e6,
                row.trigger_to_fall,
                row.pin_to_sample,
                row.sample_to_result,
                row.pin_to_result,
            )?;
        }
        if !self.not_measured.is_empty() {
            let names = self.not_measured.join(", ");
            writeln!(f, "not measured, no position at their clocks: {names}")?;
        }
        writeln!(
            f,
            "\ncard {DEFAULT_PRESET} without stream; the host reads status and position ({WORDS} words) from the cycle of the result on"
        )?;
        writeln!(
            f,
            "{:<24} {:>9}  {:<20} result to host",
            "link", "clock MHz", "trigger pin to edge"
        )?;
        for row in &self.links {
            writeln!(
                f,
                "{:<24} {:>9.3}  {:<20} {}",
                row.bus,
                row.system_hz as f64 / 1e6,
                row.trigger_pin_to_fall,
                row.result_to_host
            )?;
            if let Some(failure) = &row.failure {
                writeln!(f, "       ^ WRONG: {failure}")?;
            }
        }
        Ok(())
    }
}
