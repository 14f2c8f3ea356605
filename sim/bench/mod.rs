//! Runs a design against encoders and lines, in real time.
//!
//! Edge `k` of the system clock is at `k / system_hz`, rounded to the picosecond. At each edge the bench advances the links up to it, gives
//! the design the DATA levels of that time, ticks it, and applies its outputs to the lines at the same time. Pins of the
//! design have no delay; model it in the line's transceivers.

#[cfg(test)]
mod command_tests;
mod lane_uart;
mod lanes;
mod link;
mod other;
mod pair;
mod pins;
mod record;
mod sampler;
mod settings;
mod t_format;
#[cfg(test)]
mod tests;
mod uart;

pub use lane_uart::LaneUart;
pub(crate) use lanes::bits;
pub use lanes::LaneBench;
pub use link::{Link, LinkTrace};
pub use other::OtherEncoder;
pub use pair::Pair;
pub use pins::PinNames;
pub use record::{ChannelResult, Cycles, Watched};
pub use settings::ChannelSettings;
pub use t_format::{TFormatLink, TFormatMotion};
pub use uart::Uart;

use crate::{
    encoder::{Drive, FrameLog, Violation},
    line::{Conflict, Sample},
    Time,
};
use other::OtherPort;
use pins::{Pins, TimeBase};
use record::ResultPorts;
use rtl_design::engine::Engine;
use sampler::Sampler;

struct Port {
    link: Link,
    ids: Pins,
    data: Option<bool>,
    /// Next event time of the link.
    due: Time,
    /// The pins as applied to the line.
    pins: Option<(bool, Drive)>,
    sampler: Sampler,
}

/// Cycles of the reset, and of a pulse on the trigger pin.
const PULSE_CYCLES: u64 = 8;

/// End of a half cycle of a clock; the even ones are edges.
fn half_time(half: u64, hz: u64) -> Time {
    let after = edge_time(half.div_ceil(2), hz);
    match half % 2 {
        0 => after,
        _ => (edge_time(half / 2, hz) + after) / 2,
    }
}

/// Time of an edge of a clock, rounded to the picosecond.
fn edge_time(cycle: u64, hz: u64) -> Time {
    let hz = u128::from(hz);
    ((u128::from(cycle) * 1_000_000_000_000 + hz / 2) / hz) as Time
}

/// True if a microsecond ends with this cycle.
fn is_tick_us(cycle: u64, hz: u64) -> bool {
    let us = |cycle: u64| u128::from(cycle) * 1_000_000 / u128::from(hz);
    us(cycle) != us(cycle - 1)
}

/// A design on its bench.
pub struct Bench<E> {
    engine: E,
    system_hz: u64,
    cycle: u64,
    ports: Vec<Port>,
    others: Vec<OtherPort>,
    base: TimeBase,
    trigger_until: u64,
    trigger_level: bool,
    results: Vec<ChannelResult>,
    result_ports: Option<ResultPorts>,
    watched: Vec<Watched>,
    cycles: Option<Cycles>,
    is_double: bool,
}

impl<E: Engine> Bench<E> {
    /// A bench with the system clock `system_hz`, and a link on each named set of pins.
    pub fn new(engine: E, system_hz: u64, links: Vec<(PinNames, Link)>) -> Self {
        let base = TimeBase::find(engine.ports());
        let result_ports = ResultPorts::find(engine.ports());
        let mut bench = Self {
            engine,
            system_hz,
            cycle: 0,
            ports: Vec::with_capacity(links.len()),
            others: Vec::new(),
            base,
            trigger_until: 0,
            trigger_level: false,
            results: Vec::new(),
            result_ports,
            watched: Vec::new(),
            cycles: None,
            is_double: false,
        };
        for (names, link) in links {
            bench.add_endat(&names, link);
        }
        bench
    }

    /// Adds a link to a set of pins; returns its number.
    pub fn add_endat(&mut self, names: &PinNames, link: Link) -> usize {
        self.ports.push(Port {
            link,
            ids: Pins::find(names, self.engine.ports()),
            data: None,
            due: 0,
            pins: None,
            sampler: Sampler::default(),
        });
        self.ports.len() - 1
    }

    /// The design samples DATA on both edges of its clock.
    pub fn set_double_edge(&mut self) {
        self.is_double = true;
    }

    /// A bench for the block `Channel` with one link, configured and powered up.
    pub fn channel(engine: E, system_hz: u64, settings: &ChannelSettings, link: Link) -> Self {
        let mut bench = Self::new(engine, system_hz, vec![(PinNames::channel(), link)]);
        bench.configure(settings);
        bench.power_up();
        bench
    }

    /// Drives the configuration inputs of the design.
    pub fn configure(&mut self, settings: &ChannelSettings) {
        for (name, value) in settings.ports() {
            if self.has_port(name) {
                self.set(name, value);
            }
        }
    }

    /// Some cycles without a reset: registers have their start values, and no frame can be under way. After [`Bench::reset`] a channel
    /// is quiet for as long as after an aborted frame.
    pub fn power_up(&mut self) {
        self.run_cycles(PULSE_CYCLES + 1);
    }

    /// Holds the reset input (`reset` or `rst_i`), if the design has one, for a few cycles.
    pub fn reset(&mut self) {
        let Some(name) = ["reset", "rst_i"].into_iter().find(|n| self.has_port(n)) else {
            return;
        };
        self.set(name, 1);
        self.run_cycles(PULSE_CYCLES);
        self.set(name, 0);
        self.run_cycles(1);
    }

    /// Sets the latency from pin to sample strobe in cycles (synchroniser and filter).
    pub fn set_sample_latency(&mut self, cycles: u64) {
        self.set_sample_latency_halves(2 * cycles);
    }

    /// Sets this latency in half cycles.
    pub fn set_sample_latency_halves(&mut self, halves: u64) {
        for port in &mut self.ports {
            port.sampler.latency_halves = halves;
        }
    }

    /// From now on every change of this port of the design is recorded.
    pub fn watch(&mut self, name: &str) {
        let id = self.engine.port(name);
        let port = &self.engine.ports()[id.0];
        let mut watched = Watched::new(name, id, port.width_bits as u32);
        watched.note(self.now(), self.engine.get(id));
        self.watched.push(watched);
    }

    /// The watched ports.
    pub fn watched(&self) -> &[Watched] {
        &self.watched
    }

    /// From now on the values of all ports are recorded for every cycle, as a stimulus for other executions of the design.
    pub fn record_cycles(&mut self) {
        self.cycles = Some(Cycles::new(self.engine.ports()));
    }

    /// The recorded cycles.
    pub fn cycles(&self) -> Option<&Cycles> {
        self.cycles.as_ref()
    }

    /// From now on everything on the links is recorded.
    pub fn record_links(&mut self) {
        self.ports.iter_mut().for_each(|p| p.link.record());
    }

    /// The design.
    pub fn engine(&mut self) -> &mut E {
        &mut self.engine
    }

    /// True if the design has a port of this name.
    pub fn has_port(&self, name: &str) -> bool {
        self.engine.ports().iter().any(|p| p.name == name)
    }

    /// Drives an input of the design.
    pub fn set(&mut self, name: &str, value: u128) {
        let id = self.engine.port(name);
        self.engine.set(id, value);
    }

    /// Reads a port of the design.
    pub fn get(&mut self, name: &str) -> u128 {
        let id = self.engine.port(name);
        self.engine.get(id)
    }

    /// System clock in hertz.
    pub fn system_hz(&self) -> u64 {
        self.system_hz
    }

    /// System clock edges so far.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Time of an edge of the system clock.
    pub fn time_of(&self, cycle: u64) -> Time {
        edge_time(cycle, self.system_hz)
    }

    /// Time of the latest edge of the system clock.
    pub fn now(&self) -> Time {
        self.time_of(self.cycle)
    }

    /// The link on pin set `index`.
    pub fn link(&self, index: usize) -> &Link {
        &self.ports[index].link
    }

    /// A link, to disturb its encoder.
    pub fn link_mut(&mut self, index: usize) -> &mut Link {
        let port = &mut self.ports[index];
        // The caller may change it, so it may have an event at once.
        port.due = 0;
        &mut port.link
    }

    /// Number of links.
    pub fn link_count(&self) -> usize {
        self.ports.len()
    }

    /// Links and encoders keep only the last `most` entries of each kind: for a bench that runs for days.
    pub fn keep(&mut self, most: usize) {
        self.ports.iter_mut().for_each(|port| port.link.keep(most));
        (0..self.others.len()).for_each(|n| self.other_mut(n).keep(most));
    }

    /// Frame logs of encoder `index`.
    pub fn frames(&self, index: usize) -> &[FrameLog] {
        self.link(index).encoder().frames()
    }

    /// Violations by the design, according to encoder `index`.
    pub fn violations(&self, index: usize) -> &[(Time, Violation)] {
        self.link(index).encoder().violations()
    }

    /// Times when both ends drove DATA of link `index`.
    pub fn conflicts(&self, index: usize) -> Vec<Conflict> {
        self.link(index).line().conflicts(self.now())
    }

    /// The samples of the design on link `index`, with the line's content; the latest ones appear after 20 us.
    pub fn samples(&self, index: usize) -> &[Sample] {
        &self.ports[index].sampler.samples
    }

    /// The results that the design delivered (block `Channel` only).
    pub fn results(&self) -> &[ChannelResult] {
        &self.results
    }

    /// Raises the trigger: a strobe of one cycle for the block, a pulse of a few cycles on the card's pin.
    pub fn trigger(&mut self) {
        let cycles = if self.has_port("trigger_i") {
            PULSE_CYCLES
        } else {
            1
        };
        self.trigger_until = self.cycle + cycles;
    }

    /// Runs one cycle: the next edge of the system clock.
    pub fn tick(&mut self) {
        self.cycle += 1;
        let now = self.now();
        self.drive_base();
        if self.is_double {
            self.drive_data(half_time(2 * self.cycle - 1, self.system_hz));
            if let Some(cycles) = &mut self.cycles {
                cycles.note_middle(&mut self.engine);
            }
            self.engine.fall();
        }
        self.drive_data(now);
        if let Some(cycles) = &mut self.cycles {
            cycles.note(&mut self.engine);
        }
        self.engine.tick();
        for port in &mut self.ports {
            let clock = self.engine.get(port.ids.clock) != 0;
            let drive = if self.engine.get(port.ids.data.data_oe) != 0 {
                Drive::level(self.engine.get(port.ids.data.data_o) != 0)
            } else {
                Drive::Released
            };
            if port.pins != Some((clock, drive)) {
                port.pins = Some((clock, drive));
                port.link.set_pins(now, clock, drive);
                port.due = port.link.next_event();
            }
        }
        for port in &mut self.others {
            port.take_pins(&mut self.engine, now);
        }
        self.note_outputs(now);
    }

    /// Processes all events on the links up to now, and drives DATA into the design.
    fn drive_data(&mut self, now: Time) {
        for port in &mut self.others {
            port.drive_data(&mut self.engine, now);
        }
        for port in &mut self.ports {
            if port.due <= now {
                port.link.advance_to(now);
                port.due = port.link.next_event();
                port.sampler.look_up(&mut port.link, now);
            }
            let data = port.link.data();
            if port.data != Some(data) {
                port.data = Some(data);
                self.engine.set(port.ids.data.data_i, u128::from(data));
            }
        }
    }

    /// Runs `cycles` cycles.
    pub fn run_cycles(&mut self, cycles: u64) {
        (0..cycles).for_each(|_| self.tick());
    }

    /// Runs until `time` is reached.
    pub fn run_until(&mut self, time: Time) {
        while self.now() < time {
            self.tick();
        }
    }

    /// Runs for a span of time.
    pub fn run_for(&mut self, span: Time) {
        self.run_until(self.now() + span);
    }

    /// Runs until `done` returns true; false if it does not within `span`.
    pub fn run_until_done(&mut self, span: Time, mut done: impl FnMut(&mut Self) -> bool) -> bool {
        let end = self.now() + span;
        while !done(self) {
            if self.now() >= end {
                return false;
            }
            self.tick();
        }
        true
    }

    /// Waits until the block `Channel` is not busy, triggers it and runs until it delivers a result; `None` if one of the two
    /// takes longer than `span`.
    pub fn frame(&mut self, span: Time) -> Option<ChannelResult> {
        if self.has_port("busy") && !self.run_until_done(span, |b| b.get("busy") == 0) {
            return None;
        }
        let before = self.results.len();
        self.trigger();
        self.run_until_done(span, |b| b.results.len() > before)
            .then(|| self.results[before].clone())
    }

    fn drive_base(&mut self) {
        self.base
            .drive(&mut self.engine, self.cycle, self.system_hz);
        let trigger = self.cycle - 1 < self.trigger_until;
        if trigger != self.trigger_level {
            self.trigger_level = trigger;
            if let Some(id) = self.base.trigger {
                self.engine.set(id, u128::from(trigger));
            }
        }
    }

    fn note_outputs(&mut self, now: Time) {
        if let Some(ports) = &self.result_ports {
            if self.engine.get(ports.strobe()) != 0 {
                let value = |id| self.engine.get(id);
                self.results.push(ports.result(value, self.cycle, now));
            } else if let Some(last) = self.results.last_mut() {
                let cause = ports.cause(|id| self.engine.get(id));
                if cause != last.cause {
                    last.late_cause = Some(cause);
                }
            }
        }
        for w in &mut self.watched {
            w.note(now, self.engine.get(w.port()));
        }
        for port in &mut self.ports {
            if let Some(strobe) = port.ids.sample_strobe {
                if self.engine.get(strobe) != 0 {
                    let second = port.ids.sample_second;
                    let is_first =
                        self.is_double && second.is_some_and(|id| self.engine.get(id) == 0);
                    port.sampler.strobe(self.cycle, self.system_hz, is_first);
                }
            }
            if port.sampler.is_open() {
                port.sampler.look_up(&mut port.link, now);
            }
        }
    }
}
