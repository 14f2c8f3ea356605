//! Many benches in parallel: one pass of the engine for all, with a line and an encoder for each.
//!
//! All times equal those on a [`super::Bench`] with the same settings: a lane gives the same results as the case alone.

use super::pins::{find, Pins, TimeBase};
use super::record::ResultPorts;
use super::sampler::Sampler;
use super::{edge_time, half_time, is_tick_us, ChannelResult, ChannelSettings, Link, PinNames};
use crate::{encoder::Drive, Time};
use rtl_design::engine::{Lanes, PortId};

/// One EnDat port in all lanes.
#[derive(Clone)]
struct Port {
    links: Vec<Link>,
    /// Next event time of each link.
    due: Vec<Time>,
    ids: Pins,
    /// DATA at the designs' pins.
    data: Vec<u64>,
    /// CLOCK, driver and level as applied to the lines.
    pins: Vec<[u64; 3]>,
    samplers: Vec<Sampler>,
}

/// Designs with their benches.
#[derive(Clone)]
pub struct LaneBench {
    engine: Lanes,
    system_hz: u64,
    cycle: u64,
    ports: Vec<Port>,
    base: TimeBase,
    busy: Option<PortId>,
    results: Option<ResultPorts>,
    /// The causes at the end of the last cycle, by bit.
    causes: Vec<u64>,
    delivered: Vec<Vec<ChannelResult>>,
    delivered_count: usize,
    keeps_samples: bool,
    is_double: bool,
}

/// The indices of the set bits.
pub(crate) fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (word != 0).then(|| word.trailing_zeros() as usize);
        word &= word.wrapping_sub(1);
        bit
    })
}

impl LaneBench {
    /// Benches with the system clock `system_hz`; for each named set of pins the links of all lanes.
    ///
    /// # Panics
    /// If the numbers of links and lanes differ.
    pub fn new(engine: Lanes, system_hz: u64, links: Vec<(PinNames, Vec<Link>)>) -> Self {
        let words = engine.lanes() / 64;
        let port = |(names, links): (PinNames, Vec<Link>)| {
            assert_eq!(links.len(), engine.lanes(), "one link for each lane");
            Port {
                due: vec![0; links.len()],
                samplers: vec![Sampler::default(); links.len()],
                links,
                ids: Pins::find(&names, engine.ports()),
                data: vec![0; words],
                // Initial state of links: CLOCK HIGH, DATA released.
                pins: vec![[u64::MAX, 0, 0]; words],
            }
        };
        let ports = links.into_iter().map(port).collect();
        let results = ResultPorts::find(engine.ports());
        Self {
            system_hz,
            cycle: 0,
            ports,
            base: TimeBase::find(engine.ports()),
            busy: find(engine.ports(), "busy"),
            causes: vec![0; results.as_ref().map_or(0, ResultPorts::cause_bits) * words],
            results,
            delivered: vec![vec![]; engine.lanes()],
            delivered_count: 0,
            engine,
            keeps_samples: false,
            is_double: false,
        }
    }

    /// Drives the configuration inputs of one lane.
    pub fn configure(&mut self, lane: usize, settings: &ChannelSettings) {
        for (name, value) in settings.ports() {
            if let Some(port) = find(self.engine.ports(), name) {
                self.engine.set(port, lane, value);
            }
        }
    }

    /// Drives an input of all lanes.
    pub fn set_all(&mut self, name: &str, value: u128) {
        let id = self.engine.port(name);
        self.engine.set_all(id, value);
    }

    /// The designs sample DATA on both edges of their clock.
    pub fn set_double_edge(&mut self) {
        self.is_double = true;
    }

    /// From now on every sample of DATA is evaluated. The level is that of so many half cycles before the strobe, for each lane
    /// (synchroniser and filter).
    pub fn keep_samples(&mut self, latency_halves: impl Fn(usize) -> u64) {
        self.keeps_samples = true;
        for port in &mut self.ports {
            for (lane, sampler) in port.samplers.iter_mut().enumerate() {
                sampler.latency_halves = latency_halves(lane);
            }
        }
    }

    /// Number of lanes.
    pub fn lanes(&self) -> usize {
        self.engine.lanes()
    }

    /// Disturbs the link of a lane on pin set `port`.
    pub fn disturb(&mut self, port: usize, lane: usize, change: impl FnOnce(&mut Link)) {
        let port = &mut self.ports[port];
        change(&mut port.links[lane]);
        // Check at once: its next event may be earlier now.
        port.due[lane] = 0;
    }

    /// Inverts a bit of a register in one lane, as an upset does: the pins that it drives change at once, until the next clock edge.
    pub fn upset(&mut self, register: usize, bit: usize, lane: usize) {
        self.engine.flip(register, bit, lane);
        let now = self.now();
        for port in &mut self.ports {
            port.take_pins(&mut self.engine, now);
        }
    }

    /// Drives an input of one lane.
    pub fn set(&mut self, name: &str, lane: usize, value: u128) {
        let id = self.engine.port(name);
        self.engine.set(id, lane, value);
    }

    /// The designs.
    pub fn engine(&mut self) -> &mut Lanes {
        &mut self.engine
    }

    /// System clock edges so far.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Time of the latest edge of the system clock.
    pub fn now(&self) -> Time {
        edge_time(self.cycle, self.system_hz)
    }

    /// The link of a lane on pin set `port`.
    pub fn link(&self, port: usize, lane: usize) -> &Link {
        &self.ports[port].links[lane]
    }

    /// The samples that a lane took on pin set `port`.
    pub fn samples(&self, port: usize, lane: usize) -> &[crate::line::Sample] {
        &self.ports[port].samplers[lane].samples
    }

    /// The results that a lane delivered (block `Channel` only).
    pub fn results(&self, lane: usize) -> &[ChannelResult] {
        &self.delivered[lane]
    }

    /// Number of results that all lanes together delivered.
    pub fn delivered(&self) -> usize {
        self.delivered_count
    }

    /// Busy lanes among `64 * part` to `64 * part + 63`.
    pub fn busy(&mut self, part: usize) -> u64 {
        self.busy.map_or(0, |id| self.engine.word(id, 0, part))
    }

    /// Drives the trigger of the lanes `64 * part` to `64 * part + 63`.
    pub fn set_trigger(&mut self, part: usize, lanes: u64) {
        if let Some(id) = self.base.trigger {
            self.engine.set_word(id, 0, part, lanes);
        }
    }

    /// Runs one cycle: the next edge of the system clock.
    pub fn tick(&mut self) {
        self.cycle += 1;
        let now = self.now();
        let last = self.cycle - 1;
        if let Some(id) = self.base.timestamp {
            self.engine.set_all(id, u128::from(last & 0xFFFF_FFFF));
        }
        if let Some(id) = self.base.tick_us {
            let tick = is_tick_us(self.cycle, self.system_hz);
            self.engine.set_all(id, u128::from(tick));
        }
        if self.is_double {
            let middle = half_time(2 * self.cycle - 1, self.system_hz);
            for port in &mut self.ports {
                port.advance(&mut self.engine, middle);
            }
            self.engine.fall();
        }
        for port in &mut self.ports {
            port.advance(&mut self.engine, now);
        }
        self.engine.tick();
        for port in &mut self.ports {
            port.take_pins(&mut self.engine, now);
            if self.keeps_samples {
                port.take_samples(&mut self.engine, self.cycle, self.system_hz, self.is_double);
            }
        }
        self.note_results(now);
    }

    fn note_results(&mut self, now: Time) {
        let Some(ports) = &self.results else {
            return;
        };
        let words = self.engine.lanes() / 64;
        for part in 0..words {
            let mut changed = 0;
            for (bit, place) in (0..ports.cause_bits()).map(|bit| (bit, bit * words + part)) {
                let Some(id) = ports.cause_port() else { break };
                let word = self.engine.word(id, bit, part);
                changed |= std::mem::replace(&mut self.causes[place], word) ^ word;
            }
            let strobes = self.engine.word(ports.strobe(), 0, part);
            for lane in bits(strobes).map(|bit| 64 * part + bit) {
                let value = |id: PortId| self.engine.get(id, lane);
                let result = ports.result(value, self.cycle, now);
                self.delivered[lane].push(result);
                self.delivered_count += 1;
                if !self.keeps_samples {
                    self.ports
                        .iter_mut()
                        .for_each(|p| p.links[lane].line_mut().forget_before(now));
                }
            }
            for lane in bits(changed & !strobes).map(|bit| 64 * part + bit) {
                let cause = ports.cause(|id| self.engine.get(id, lane));
                if let Some(last) = self.delivered[lane].last_mut() {
                    last.late_cause = Some(cause);
                }
            }
        }
    }

    /// Evaluates the open samples. The lines must have been quiet for a while.
    pub fn finish_samples(&mut self) {
        let now = self.now();
        for port in &mut self.ports {
            for (sampler, link) in port.samplers.iter_mut().zip(&mut port.links) {
                sampler.look_up(link, now);
            }
        }
    }
}

impl Port {
    /// Processes all due events, and drives DATA into the designs.
    fn advance(&mut self, engine: &mut Lanes, now: Time) {
        for (part, data) in self.data.iter_mut().enumerate() {
            let lanes = 64 * part..64 * part + 64;
            let mut due: u64 = 0;
            for (bit, time) in self.due[lanes.clone()].iter().enumerate() {
                due |= u64::from(*time <= now) << bit;
            }
            for bit in bits(due) {
                let link = &mut self.links[64 * part + bit];
                link.advance_to(now);
                *data = *data & !(1 << bit) | u64::from(link.data()) << bit;
                self.due[64 * part + bit] = link.next_event();
            }
            engine.set_word(self.ids.data.data_i, 0, part, *data);
        }
    }

    /// Applies changed pins to the lines.
    fn take_pins(&mut self, engine: &mut Lanes, now: Time) {
        for part in 0..self.data.len() {
            let clock = engine.word(self.ids.clock, 0, part);
            let driven = engine.word(self.ids.data.data_oe, 0, part);
            let level = engine.word(self.ids.data.data_o, 0, part) & driven;
            let before = std::mem::replace(&mut self.pins[part], [clock, driven, level]);
            let changed = clock ^ before[0] | driven ^ before[1] | level ^ before[2];
            for bit in bits(changed) {
                let is_set = |word: u64| word >> bit & 1 == 1;
                let drive = match is_set(driven) {
                    true => Drive::level(is_set(level)),
                    false => Drive::Released,
                };
                let link = &mut self.links[64 * part + bit];
                link.set_pins(now, is_set(clock), drive);
                // The receiver sees its own DATA output at its pin at once.
                let data = &mut self.data[part];
                *data = *data & !(1 << bit) | u64::from(link.data()) << bit;
                self.due[64 * part + bit] = link.next_event();
            }
        }
    }

    fn take_samples(&mut self, engine: &mut Lanes, cycle: u64, system_hz: u64, is_double: bool) {
        let Some(strobe) = self.ids.sample_strobe else {
            return;
        };
        for part in 0..self.data.len() {
            let second = self.ids.sample_second.filter(|_| is_double);
            let second = second.map_or(u64::MAX, |id| engine.word(id, 0, part));
            for lane in bits(engine.word(strobe, 0, part)).map(|bit| 64 * part + bit) {
                let sampler = &mut self.samplers[lane];
                sampler.strobe(cycle, system_hz, second >> (lane % 64) & 1 == 0);
                sampler.look_up(&mut self.links[lane], edge_time(cycle, system_hz));
            }
        }
    }
}
