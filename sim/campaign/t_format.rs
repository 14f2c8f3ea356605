//! Upsets of the T-format port of a card, in lanes: an exchange with request 3 in which a flip-flop is inverted, and those that follow.

use super::port::{Mark, Outcome, Reading};
use super::upsets::{Draw, Flops};
use super::work::{digest, Campaign};
use super::{CampaignError, Row, Tally};
use crate::{
    encoder::Drive,
    rng::Rng,
    t_format::{Encoder, EncoderConfig},
    Time,
};
use endat_hdl::protocols::t_format::port::TFormatPort;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::{Keep, LaneWords, Lanes, PortId};
use rust_hdl::prelude::Block;
use std::ops::Range;

/// Its name in tables.
pub const SUBJECT: &str = "t_format_port";
const KIND: &str = "exchange";
const SYSTEM_MHZ: u64 = 20;
const CYCLE: Time = 1_000_000 / SYSTEM_MHZ;
const BIT_CYCLES: u64 = 8;
const LANES: usize = 128;
/// From one trigger to the next: request 3, its reply, and the line at rest.
const SPAN_CYCLES: u64 = 80 * SYSTEM_MHZ;
/// Longer than all that a port may wait for; a timer of 7 bits that counts round.
const HANG_CYCLES: u64 = 500 * SYSTEM_MHZ;
/// The counter of time is free-running; only its bits that the port keeps are compared.
const STAMP_MASK: u64 = 0xFFFF_FFFF;

/// The campaign.
pub struct TFormatUpsets {
    flops: Flops,
    draw: Draw,
    seed: u64,
    bench: Bench,
    stamp_after: u64,
    digest: u64,
}

#[derive(Clone)]
struct Bench {
    engine: Lanes,
    encoders: Vec<Encoder>,
    due: Vec<Time>,
    data: [u64; 2],
    /// Driver and level as the encoders know them.
    pins: [[u64; 2]; 2],
    ids: Ids,
    cycle: u64,
    /// Lanes with a result since they were asked.
    results: [u64; 2],
}

#[derive(Clone, Copy)]
struct Ids {
    data_i: PortId,
    data_o: PortId,
    data_oe: PortId,
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

fn design() -> Result<Design, CampaignError> {
    let mut block = TFormatPort::default();
    block.connect_all();
    Ok(elaborate(&block, "t_format_port")?)
}

/// The position of a lane's shaft in a round.
fn shaft(seed: u64, round: u32) -> (u32, u32) {
    let mixed = Rng::new(seed ^ u64::from(round)).next_u64();
    (mixed as u32 & 0xFF_FFFF, (mixed >> 32) as u32 & 0xFF_FFFF)
}

impl Bench {
    fn new(mut engine: Lanes) -> Self {
        let settings = [
            ("bit_cycles", BIT_CYCLES),
            ("request_id", 3),
            ("reply_gap_us", 4),
            ("field_gap_us", 1),
            ("filter_cycles", 1),
            ("data_i", 1),
        ];
        for (name, value) in settings {
            let port = engine.port(name);
            engine.set_all(port, value.into());
        }
        let id = |name: &str| engine.port(name);
        let ids = Ids {
            data_i: id("data_i"),
            data_o: id("data_o"),
            data_oe: id("data_oe"),
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
        let config = EncoderConfig {
            status: 0,
            ..EncoderConfig::default()
        };
        Self {
            engine,
            encoders: vec![Encoder::new(config); LANES],
            due: vec![0; LANES],
            data: [u64::MAX; 2],
            pins: [[0; 2]; 2],
            ids,
            cycle: 0,
            results: [0; 2],
        }
    }

    fn tick(&mut self) {
        self.cycle += 1;
        let now = self.cycle * CYCLE;
        for lane in 0..LANES {
            if self.due[lane] <= now {
                self.act(lane, now);
            }
        }
        let tick = self.cycle.is_multiple_of(SYSTEM_MHZ);
        self.engine.set_all(self.ids.tick_us, tick.into());
        let time = u128::from(self.cycle & STAMP_MASK);
        self.engine.set_all(self.ids.timestamp, time);
        for (part, data) in self.data.into_iter().enumerate() {
            self.engine.set_word(self.ids.data_i, 0, part, data);
        }
        self.engine.tick();
        self.take_pins(now);
        for part in 0..2 {
            self.results[part] |= self.engine.word(self.ids.strobe, 0, part);
        }
    }

    /// What the ports do to their lines.
    fn take_pins(&mut self, now: Time) {
        for part in 0..2 {
            let driven = self.engine.word(self.ids.data_oe, 0, part);
            let level = self.engine.word(self.ids.data_o, 0, part) & driven;
            let before = std::mem::replace(&mut self.pins[part], [driven, level]);
            let mut changed = driven ^ before[0] | level ^ before[1];
            while changed != 0 {
                let bit = changed.trailing_zeros();
                changed &= changed - 1;
                let drive = match driven >> bit & 1 == 1 {
                    true => Drive::level(level >> bit & 1 == 1),
                    false => Drive::Released,
                };
                let lane = 64 * part + bit as usize;
                self.encoders[lane].receiver(now, drive);
                self.act(lane, now);
            }
        }
    }

    /// An encoder does what is due.
    fn act(&mut self, lane: usize, now: Time) {
        let encoder = &mut self.encoders[lane];
        encoder.advance(now);
        let level = encoder.output() != Drive::Low;
        let (part, bit) = (lane / 64, 1 << (lane % 64));
        self.data[part] = self.data[part] & !bit | if level { bit } else { 0 };
        self.due[lane] = encoder.next_event().unwrap_or(Time::MAX);
    }

    fn busy(&mut self, lane: usize) -> bool {
        self.engine.get(self.ids.busy, lane) != 0
    }

    fn set_trigger(&mut self, part: usize, lanes: u64) {
        self.engine.set_word(self.ids.trigger, 0, part, lanes);
    }

    fn trigger_all(&mut self, round: u32) {
        for lane in 0..LANES {
            let config = &mut self.encoders[lane].config;
            (config.single_turn, config.multi_turn) = shaft(0, round);
        }
        (0..2).for_each(|part| self.set_trigger(part, u64::MAX));
        self.tick();
        (0..2).for_each(|part| self.set_trigger(part, 0));
        (0..SPAN_CYCLES).for_each(|_| self.tick());
    }
}

/// What has been seen of a lane.
#[derive(Clone, Default)]
struct Lane {
    outcome: Outcome,
    round: u32,
    begun: u64,
    violations: usize,
    /// Cycles in which the driver was on without an exchange, in a row.
    driven: u64,
    conflict: bool,
}

/// Rounds before the one that is upset.
const WARM_UP: u32 = 3;

impl TFormatUpsets {
    /// Upsets of registers [that are asked for](super::upsets::is_asked).
    ///
    /// # Errors
    /// If the design cannot be made.
    pub fn new(draw: Draw, seed: u64, only: &str) -> Result<Self, CampaignError> {
        let design = design()?;
        let engine = Lanes::new(&design, Keep::Registers, LaneWords::Two)?;
        let flops = Flops::new(&engine, only);
        let mut bench = Bench::new(engine);
        (0..100 * SYSTEM_MHZ).for_each(|_| bench.tick());
        for round in 1..WARM_UP {
            bench.trigger_all(round);
        }
        let from = bench.cycle;
        bench.trigger_all(WARM_UP);
        let stamp = bench.engine.get(bench.ids.stamp, 0) as u64;
        assert_eq!(bench.engine.get(bench.ids.fresh, 0), 1, "a good exchange");
        bench.results = [0; 2];
        Ok(Self {
            flops,
            draw,
            seed,
            stamp_after: stamp.wrapping_sub(from) & STAMP_MASK,
            digest: digest(&design),
            bench,
        })
    }

    fn case(&self, number: u64) -> (usize, u64) {
        let label = format!("{SUBJECT} {KIND}");
        self.flops
            .case(self.draw, self.seed, &label, SPAN_CYCLES, number)
    }

    fn run_batch(&self, flips: &[(usize, u64)]) -> Vec<Outcome> {
        let mut bench = self.bench.clone();
        let start = bench.cycle;
        let mut lanes = vec![Lane::default(); flips.len()];
        let mut running: Vec<usize> = (0..flips.len()).collect();
        let mut order: Vec<(u64, usize)> = (flips.iter().enumerate())
            .map(|(lane, flip)| (start + 1 + flip.1, lane))
            .collect();
        order.sort_unstable();
        let mut next = order.into_iter().peekable();
        let mut triggers = [0u64; 2];
        for (lane, state) in lanes.iter_mut().enumerate() {
            state.violations = bench.encoders[lane].violations().len();
            begin(&mut bench, state, lane, &mut triggers);
        }
        while !running.is_empty() {
            let cycle = bench.cycle;
            while let Some((_, lane)) = next.next_if(|(at, _)| *at <= cycle) {
                let (register, bit) = self.flops.bits[flips[lane].0];
                bench.engine.flip(register, bit, lane);
                // A pin that it drives changes at once, up to the next clock edge.
                bench.take_pins(cycle * CYCLE);
            }
            running.retain(|lane| {
                let state = &mut lanes[*lane];
                let waited = cycle - state.begun;
                if waited < SPAN_CYCLES {
                    return true;
                }
                if bench.busy(*lane) {
                    if waited >= HANG_CYCLES {
                        state.outcome.hang();
                    }
                    return waited < HANG_CYCLES;
                }
                let reading = self.reading(&mut bench, state, *lane);
                if state.outcome.read(&reading) {
                    return false;
                }
                begin(&mut bench, state, *lane, &mut triggers);
                true
            });
            (0..2).for_each(|part| bench.set_trigger(part, std::mem::take(&mut triggers[part])));
            bench.tick();
            note_driver(&mut bench, &mut lanes, &running);
        }
        lanes.into_iter().map(|lane| lane.outcome).collect()
    }

    fn reading(&self, bench: &mut Bench, state: &mut Lane, lane: usize) -> Reading {
        let ids = bench.ids;
        let mut get = |port: PortId| bench.engine.get(port, lane) as u64;
        let stamp = (state.begun + self.stamp_after) & STAMP_MASK;
        let position = get(ids.position);
        let sent = |round: u32| {
            let (single, multi) = shaft(0, round);
            u64::from(multi) << 24 | u64::from(single)
        };
        let now = WARM_UP + state.round;
        let mut reading = Reading {
            cause: get(ids.cause),
            position,
            valid: get(ids.valid) != 0,
            fresh: get(ids.fresh) != 0,
            sent: Some(sent(now)),
            was_sent: (1..now).any(|round| sent(round) == position),
            others_right: get(ids.stamp) == stamp,
            conflict: std::mem::take(&mut state.conflict),
            ..Reading::default()
        };
        let (part, bit) = (lane / 64, 1 << (lane % 64));
        reading.has_result = bench.results[part] & bit != 0;
        bench.results[part] &= !bit;
        let violations = bench.encoders[lane].violations().len();
        reading.rules = violations > std::mem::replace(&mut state.violations, violations);
        reading
    }
}

/// The next exchange of a lane.
fn begin(bench: &mut Bench, state: &mut Lane, lane: usize, triggers: &mut [u64; 2]) {
    state.round += 1;
    state.begun = bench.cycle;
    let config = &mut bench.encoders[lane].config;
    (config.single_turn, config.multi_turn) = shaft(0, WARM_UP + state.round);
    triggers[lane / 64] |= 1 << (lane % 64);
}

/// A driver that is on although no exchange is under way.
fn note_driver(bench: &mut Bench, lanes: &mut [Lane], running: &[usize]) {
    let driven = bench.pins.map(|pins| pins[0]);
    if driven == [0; 2] {
        lanes.iter_mut().for_each(|lane| lane.driven = 0);
        return;
    }
    for lane in running {
        let is_on = driven[lane / 64] >> (lane % 64) & 1 == 1;
        let is_wrong = is_on && !bench.busy(*lane);
        let state = &mut lanes[*lane];
        state.driven = if is_wrong { state.driven + 1 } else { 0 };
        if state.driven > BIT_CYCLES {
            state.conflict = true;
        }
    }
}

impl Campaign for TFormatUpsets {
    fn digest(&self) -> u64 {
        self.digest
    }

    fn groups(&self) -> Vec<u64> {
        vec![self.flops.cases(self.draw)]
    }

    fn run(&self, _: usize, cases: Range<u64>) -> Tally {
        let flips: Vec<(usize, u64)> = cases.map(|number| self.case(number)).collect();
        let mut tally = Tally::default();
        for ((index, _), outcome) in flips.iter().zip(self.run_batch(&flips)) {
            let mut add = |class: &str| {
                let row = Row {
                    subject: SUBJECT.into(),
                    kind: KIND.into(),
                    place: self.flops.names[*index].clone(),
                    class: class.into(),
                };
                tally.add(row, 1);
            };
            add(outcome.class.name());
            outcome.marks().map(Mark::name).for_each(add);
        }
        tally
    }
}
