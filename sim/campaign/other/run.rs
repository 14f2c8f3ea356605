//! One batch: the frame with the faults, one in each lane, and as many frames after it as needed.

use super::{Device, LineFault, Mishap, Plan, LANES, LEAD_US};
use crate::campaign::port::{Outcome, Reading};
use crate::{rng::Rng, Time};
use rtl_design::engine::{Lanes, PortId};

/// The time counter is free-running; only its bits stored by the port are compared.
const STAMP_MASK: u64 = 0xFFFF_FFFF;
/// Rounds before the one with the fault.
const WARM_UP: u32 = 3;
/// From power-up until a trigger is accepted, in microseconds.
const READY_US: u64 = 120;

#[derive(Clone, Copy)]
struct Ids {
    data_i: PortId,
    tick_us: PortId,
    timestamp: PortId,
    trigger: PortId,
    busy: PortId,
    strobe: PortId,
    position: PortId,
    valid: PortId,
    fresh: PortId,
    cause: PortId,
    stamp: PortId,
}

/// A disturbance of a lane's line.
#[derive(Clone)]
struct Disturbance {
    lane: usize,
    fault: LineFault,
    from: u64,
    until: u64,
    rng: Rng,
    /// For glitches: DATA is inverted up to this cycle.
    inverted: u64,
}

/// The ports in all lanes, with an encoder each.
#[derive(Clone)]
pub(super) struct Bench<D: Device> {
    engine: Lanes,
    devices: Vec<D>,
    due: Vec<Time>,
    data: [u64; 2],
    /// Pins for the encoders.
    pins: Vec<[u64; 2]>,
    pin_ids: Vec<PortId>,
    ids: Ids,
    cycle: u64,
    cycle_ps: Time,
    system_mhz: u64,
    bit_cycles: u64,
    /// Lanes with a new result.
    results: [u64; 2],
    disturbances: Vec<Disturbance>,
    /// Lanes whose plug is off.
    deaf: [u64; 2],
}

fn place(lane: usize) -> (usize, u64) {
    (lane / 64, 1 << (lane % 64))
}

impl<D: Device> Bench<D> {
    fn new(plan: &Plan, mut engine: Lanes) -> Self {
        for (name, value) in plan.settings.iter().chain(&[("data_i", 1)]) {
            let port = engine.port(name);
            engine.set_all(port, (*value).into());
        }
        let id = |name: &str| engine.port(name);
        let ids = Ids {
            data_i: id("data_i"),
            tick_us: id("tick_us"),
            timestamp: id("timestamp"),
            trigger: id("trigger"),
            busy: id("busy"),
            strobe: id("result_strobe"),
            position: id("position"),
            valid: id("position_valid"),
            fresh: id("fresh"),
            cause: id("cause"),
            stamp: id("first_fall_timestamp"),
        };
        let pin_ids: Vec<PortId> = D::PINS.iter().map(|name| id(name)).collect();
        let mut bench = Self {
            engine,
            devices: vec![D::new(plan); LANES],
            due: vec![0; LANES],
            data: [u64::MAX; 2],
            pins: vec![[0; 2]; pin_ids.len()],
            pin_ids,
            ids,
            cycle: 0,
            cycle_ps: plan.cycle_ps(),
            system_mhz: plan.system_mhz,
            bit_cycles: 4 * plan.quarter_cycles,
            results: [0; 2],
            disturbances: vec![],
            deaf: [0; 2],
        };
        bench.take_pins();
        bench
    }

    fn now(&self) -> Time {
        self.cycle * self.cycle_ps
    }

    fn tick(&mut self) {
        self.cycle += 1;
        let now = self.now();
        for lane in 0..LANES {
            if self.due[lane] <= now {
                self.act(lane);
            }
        }
        let tick = self.cycle.is_multiple_of(self.system_mhz);
        self.engine.set_all(self.ids.tick_us, tick.into());
        let time = u128::from(self.cycle & STAMP_MASK);
        self.engine.set_all(self.ids.timestamp, time);
        let seen = self.disturbed();
        for (part, data) in seen.into_iter().enumerate() {
            self.engine.set_word(self.ids.data_i, 0, part, data);
        }
        self.engine.tick();
        self.take_pins();
        for part in 0..2 {
            self.results[part] |= self.engine.word(self.ids.strobe, 0, part);
        }
    }

    /// DATA as it arrives at the receivers.
    fn disturbed(&mut self) -> [u64; 2] {
        let (mut seen, cycle) = (self.data, self.cycle);
        let was_deaf = std::mem::take(&mut self.deaf);
        for fault in &mut self.disturbances {
            if !(fault.from..fault.until).contains(&cycle) {
                continue;
            }
            let (part, bit) = place(fault.lane);
            let level = seen[part] & bit != 0;
            let level = match fault.fault {
                LineFault::StuckLow | LineFault::PlugLow => false,
                LineFault::StuckHigh | LineFault::PlugHigh => true,
                LineFault::Noise => fault.rng.in_range(0, 1) == 1,
                LineFault::Glitches => {
                    if fault.inverted < cycle && fault.rng.in_range(0, 60) == 0 {
                        fault.inverted = cycle + fault.rng.in_range(1, 16);
                    }
                    level ^ (fault.inverted >= cycle)
                }
            };
            if matches!(fault.fault, LineFault::PlugLow | LineFault::PlugHigh) {
                self.deaf[part] |= bit;
            }
            seen[part] = seen[part] & !bit | if level { bit } else { 0 };
        }
        for (lane, (part, bit)) in (0..LANES).map(place).enumerate() {
            // The plug is in again: the encoder receives the present levels.
            if was_deaf[part] & !self.deaf[part] & bit != 0 {
                let levels: Vec<bool> = self.pins.iter().map(|p| p[part] & bit != 0).collect();
                let now = self.now();
                self.devices[lane].hear(now, &levels);
                self.act(lane);
            }
        }
        seen
    }

    /// Applies the outputs of the ports to their lines.
    fn take_pins(&mut self) {
        let now = self.now();
        for part in 0..2 {
            let words = self.pin_ids.iter().map(|id| self.engine.word(*id, 0, part));
            let words: Vec<u64> = words.collect();
            let mut changed = 0;
            for (pins, word) in self.pins.iter_mut().zip(&words) {
                changed |= pins[part] ^ word;
                pins[part] = *word;
            }
            changed &= !self.deaf[part];
            while changed != 0 {
                let bit = changed.trailing_zeros() as usize;
                changed &= changed - 1;
                let levels: Vec<bool> = words.iter().map(|word| word >> bit & 1 == 1).collect();
                let lane = 64 * part + bit;
                self.devices[lane].hear(now, &levels);
                self.act(lane);
            }
        }
    }

    /// Lets an encoder process its due events.
    fn act(&mut self, lane: usize) {
        let now = self.now();
        let device = &mut self.devices[lane];
        device.advance(now);
        let (part, bit) = place(lane);
        self.data[part] = self.data[part] & !bit | if device.data() { bit } else { 0 };
        self.due[lane] = device.next_event().unwrap_or(Time::MAX);
    }

    fn busy(&mut self, lane: usize) -> bool {
        self.engine.get(self.ids.busy, lane) != 0
    }

    fn set_triggers(&mut self, lanes: [u64; 2]) {
        for (part, lanes) in lanes.into_iter().enumerate() {
            self.engine.set_word(self.ids.trigger, 0, part, lanes);
        }
    }

    fn trigger_all(&mut self, round: u32, cycles: u64) {
        self.devices.iter_mut().for_each(|device| {
            device.turn(round);
        });
        self.set_triggers([u64::MAX; 2]);
        self.tick();
        self.set_triggers([0; 2]);
        (0..cycles).for_each(|_| self.tick());
    }
}

/// State of a lane.
#[derive(Clone, Default)]
struct Lane {
    outcome: Outcome,
    round: u32,
    begun: u64,
    complaints: usize,
    sent: u64,
    /// Consecutive cycles with the driver on and no frame.
    driven: u64,
    conflict: bool,
}

/// Lanes that are about to begin the frame.
pub(super) struct Ready<D: Device> {
    pub plan: Plan,
    bench: Bench<D>,
    /// Positions of the rounds so far, in the format of results.
    before: Vec<u64>,
    stamp_after: u64,
}

impl<D: Device> Ready<D> {
    pub fn new(plan: Plan, engine: Lanes) -> Self {
        let mut bench = Bench::<D>::new(&plan, engine);
        (0..READY_US * plan.system_mhz).for_each(|_| bench.tick());
        for round in 1..WARM_UP {
            bench.trigger_all(round, plan.span_cycles);
        }
        let from = bench.cycle;
        bench.trigger_all(WARM_UP, plan.span_cycles);
        let stamp = bench.engine.get(bench.ids.stamp, 0) as u64;
        assert_eq!(bench.engine.get(bench.ids.fresh, 0), 1, "a good frame");
        bench.results = [0; 2];
        let mut device = D::new(&plan);
        Self {
            before: (1..=WARM_UP).map(|round| device.turn(round)).collect(),
            stamp_after: stamp.wrapping_sub(from) & STAMP_MASK,
            bench,
            plan,
        }
    }

    /// Runs the frame with these faults, one in each lane.
    pub fn run(&self, mishaps: &[Mishap]) -> Vec<Outcome> {
        let mut bench = self.bench.clone();
        let is_line = |m: &Mishap| matches!(m, Mishap::Line { .. });
        let lead = match mishaps.iter().any(is_line) {
            true => LEAD_US * self.plan.system_mhz,
            false => 0,
        };
        let start = bench.cycle + lead;
        let mut order = prepare(&mut bench, mishaps, start);
        (0..lead).for_each(|_| bench.tick());
        order.sort_unstable();
        let mut next = order.into_iter().peekable();
        let mut lanes = vec![Lane::default(); mishaps.len()];
        let mut running: Vec<usize> = (0..mishaps.len()).collect();
        let mut triggers = [0u64; 2];
        for (lane, state) in lanes.iter_mut().enumerate() {
            state.complaints = bench.devices[lane].complaints();
            begin(&mut bench, state, lane, &mut triggers);
        }
        while !running.is_empty() {
            let cycle = bench.cycle;
            while let Some((_, lane)) = next.next_if(|(at, _)| *at <= cycle) {
                match mishaps[lane] {
                    Mishap::Flip { register, bit, .. } => {
                        bench.engine.flip(register, bit, lane);
                        // A driven pin changes at once, until the next clock edge.
                        bench.take_pins();
                    }
                    Mishap::Setting { name, value, .. } => bench.set(name, lane, value),
                    _ => {}
                }
            }
            running.retain(|lane| {
                let state = &mut lanes[*lane];
                let waited = cycle - state.begun;
                if waited < self.plan.span_cycles {
                    return true;
                }
                if state.round == 1 {
                    self.restore(&mut bench, *lane, &mishaps[*lane]);
                }
                if bench.busy(*lane) {
                    if waited >= self.plan.hang_cycles {
                        state.outcome.hang();
                    }
                    return waited < self.plan.hang_cycles;
                }
                let reading = self.reading(&mut bench, state, *lane);
                if state.outcome.read(&reading) {
                    return false;
                }
                begin(&mut bench, state, *lane, &mut triggers);
                true
            });
            bench.set_triggers(std::mem::take(&mut triggers));
            bench.tick();
            note_driver(&mut bench, &mut lanes, &running);
        }
        lanes.into_iter().map(|lane| lane.outcome).collect()
    }

    /// Removes the fault after the frame.
    fn restore(&self, bench: &mut Bench<D>, lane: usize, mishap: &Mishap) {
        match mishap {
            Mishap::Encoder { .. } => {
                bench.devices[lane].mend();
                bench.act(lane);
            }
            Mishap::Setting { name, .. } => {
                let before = self.plan.settings.iter().find(|(n, _)| n == name);
                bench.set(name, lane, before.map_or(0, |(_, value)| *value));
            }
            _ => {}
        }
    }

    fn reading(&self, bench: &mut Bench<D>, state: &mut Lane, lane: usize) -> Reading {
        let ids = bench.ids;
        let mut get = |port: PortId| bench.engine.get(port, lane) as u64;
        let stamp = (state.begun + self.stamp_after) & STAMP_MASK;
        let position = get(ids.position);
        let mut device = D::new(&self.plan);
        let rounds = WARM_UP + 1..WARM_UP + state.round;
        let mut later = rounds.map(|round| device.turn(round));
        let mut reading = Reading {
            cause: get(ids.cause),
            position,
            valid: get(ids.valid) != 0,
            fresh: get(ids.fresh) != 0,
            sent: Some(state.sent),
            was_sent: self.before.contains(&position) || later.any(|at| at == position),
            others_right: get(ids.stamp) == stamp,
            conflict: std::mem::take(&mut state.conflict),
            ..Reading::default()
        };
        let (part, bit) = place(lane);
        reading.has_result = bench.results[part] & bit != 0;
        bench.results[part] &= !bit;
        let complaints = bench.devices[lane].complaints();
        reading.rules = complaints > std::mem::replace(&mut state.complaints, complaints);
        reading
    }
}

impl<D: Device> Bench<D> {
    fn set(&mut self, name: &str, lane: usize, value: u64) {
        let port = self.engine.port(name);
        self.engine.set(port, lane, value.into());
    }
}

/// Applies faults before the frame begins at `start`; returns the later ones, with cycle and lane.
fn prepare<D: Device>(bench: &mut Bench<D>, mishaps: &[Mishap], start: u64) -> Vec<(u64, usize)> {
    let mut order = vec![];
    let first = bench.cycle;
    for (lane, mishap) in mishaps.iter().enumerate() {
        match *mishap {
            Mishap::Flip { cycle, .. } => order.push((start + 1 + cycle, lane)),
            Mishap::Setting { cycle, .. } => order.push((start + 1 + cycle, lane)),
            Mishap::Encoder { way, seed } => {
                bench.devices[lane].spoil(way, &mut Rng::new(seed));
                bench.act(lane);
            }
            Mishap::Line {
                fault,
                from,
                until,
                seed,
            } => bench.disturbances.push(Disturbance {
                lane,
                fault,
                from: first + 1 + from,
                until: first + 1 + until,
                rng: Rng::new(seed),
                inverted: 0,
            }),
        }
    }
    order
}

/// Begins the next frame of a lane.
fn begin<D: Device>(bench: &mut Bench<D>, state: &mut Lane, lane: usize, triggers: &mut [u64; 2]) {
    state.round += 1;
    state.begun = bench.cycle;
    state.sent = bench.devices[lane].turn(WARM_UP + state.round);
    let (part, bit) = place(lane);
    triggers[part] |= bit;
}

/// Notes a driver that is on without a frame.
fn note_driver<D: Device>(bench: &mut Bench<D>, lanes: &mut [Lane], running: &[usize]) {
    let Some(driver) = D::DRIVER else {
        return;
    };
    let driven = bench.pins[driver];
    if driven == [0; 2] {
        lanes.iter_mut().for_each(|lane| lane.driven = 0);
        return;
    }
    let bit_cycles = bench.bit_cycles;
    for lane in running {
        let (part, bit) = place(*lane);
        let is_wrong = driven[part] & bit != 0 && !bench.busy(*lane);
        let state = &mut lanes[*lane];
        state.driven = if is_wrong { state.driven + 1 } else { 0 };
        state.conflict |= state.driven > bit_cycles;
    }
}
