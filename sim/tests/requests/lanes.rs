//! Channels with requests in parallel, each with another encoder, line and fault, in the longest frame:
//! additional data 1 and 2 and a supplement.

use endat_hdl::endat::{
    channel::{Channel, Features, FixedTimes},
    transaction::cause,
};
use endat_hdl::protocol::ModeCommand::{self, *};
use endat_sim::{
    bench::{ChannelResult, ChannelSettings, LaneBench, Link, PinNames},
    campaign::{ABORT_US, SAMPLE_LATENCY_CYCLES},
    encoder::{EncoderConfig, FrameLog},
    line::LineConfig,
    Time, NS, US,
};
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::{Keep, LaneWords, Lanes};
use rust_hdl::prelude::Block;
use std::sync::OnceLock;

pub const SYSTEM_HZ: u64 = 16_000_000;
pub const ENDAT_HZ: u64 = 2_000_000;
pub const HALF_PERIOD: Time = 250 * NS;
pub const POSITION_BITS: u32 = 13;
/// The frame with the fault, as counted by the encoder.
pub const FRAME: u64 = 4;
/// First falling to last rising clock edge of that frame: tST, then 10 pulses to the start bit, 21 bits, 60 of the additional data, the
/// park time, 35 pulses.
pub const FRAME_TIME: Time = 67_500 * NS;
/// Its recovery time.
pub const RECOVERY: Time = 12 * US;
/// Cycle of its trigger.
const TRIGGER_CYCLE: u64 = 16_000;
/// Longest answer to a command with a parameter.
const PARAMETER_TIMEOUT_US: u64 = 200;
/// More than any part of a frame, also at the calibration clock.
pub const FRAME_US: u64 = 512;

pub fn design() -> Design {
    let fixed = FixedTimes {
        abort_us: ABORT_US,
        parameter_timeout_us: PARAMETER_TIMEOUT_US,
        frame_us: FRAME_US,
        ..FixedTimes::at(SYSTEM_HZ)
    };
    let mut block = Channel::with(fixed, Features::PROTOCOL);
    block.connect_all();
    elaborate(&block, "channel").expect("the channel elaborates")
}

/// Channels after power-up.
pub fn engine() -> Lanes {
    static MADE: OnceLock<Lanes> = OnceLock::new();
    let make = || Lanes::new(&design(), Keep::Registers, LaneWords::Two).expect("no loop");
    MADE.get_or_init(make).clone()
}

/// An encoder with short times.
pub fn encoder() -> EncoderConfig {
    let mut encoder = EncoderConfig::endat22(POSITION_BITS);
    encoder.tm = 10 * US..=RECOVERY;
    encoder.tac = 0..=0;
    encoder.write_time = 0..=0;
    encoder.reset_time = 0;
    encoder
}

pub fn line() -> LineConfig {
    LineConfig::cable(20.0)
}

pub fn settings() -> ChannelSettings {
    ChannelSettings::new(SYSTEM_HZ, ENDAT_HZ, SendPositionAddInfo, POSITION_BITS)
}

pub const LANES: usize = 128;

pub struct Rig {
    pub bench: LaneBench,
    /// Lanes with a case; the others repeat the first one.
    pub used: usize,
    /// Evaluated lanes, a bit for each.
    live: [u64; 2],
}

impl Rig {
    /// Designs in any state, each with an encoder and a line.
    pub fn on(engine: Lanes, cases: &[(EncoderConfig, LineConfig)]) -> Self {
        let links = (0..LANES).map(|lane| {
            let (encoder, line) = cases.get(lane).unwrap_or(&cases[0]).clone();
            Link::new(line, encoder)
        });
        let links = vec![(PinNames::channel(), links.collect())];
        let mut bench = LaneBench::new(engine, SYSTEM_HZ, links);
        (0..LANES).for_each(|lane| bench.configure(lane, &settings()));
        let used = cases.len().min(LANES);
        let mut live = [0; 2];
        (0..used).for_each(|lane| live[lane / 64] |= 1 << (lane % 64));
        Self { bench, used, live }
    }

    pub fn reset(&mut self) {
        self.bench.set_all("reset", 1);
        (0..8).for_each(|_| self.bench.tick());
        self.bench.set_all("reset", 0);
    }

    /// Runs up to the trigger of the frame with the fault: line delay measured, additional data 1 and 2 selected, supplement pending.
    pub fn new(cases: &[(EncoderConfig, LineConfig)]) -> Self {
        let mut rig = Self::on(engine(), cases);
        rig.bench.keep_samples(|_| 2 * SAMPLE_LATENCY_CYCLES);
        rig.reset();
        rig.settle(100);
        rig.position(400);
        for code in [0x4C, 0x5B] {
            rig.put(PositionSelectMemory, code, 0);
            rig.position(400);
        }
        for lane in 0..rig.used {
            let result = rig.bench.results(lane).last().expect("a result");
            assert_eq!((result.cause, result.fresh), (cause::NONE, true));
        }
        rig.put(PositionSelectMemory, 0x4D, 0);
        assert!(rig.bench.cycle() < TRIGGER_CYCLE, "{}", rig.bench.cycle());
        while rig.bench.cycle() < TRIGGER_CYCLE {
            rig.bench.tick();
        }
        rig
    }

    /// Time of the frame's first falling edge at the channel.
    pub fn trigger_time() -> Time {
        (TRIGGER_CYCLE + 3) * 1_000_000 * US / SYSTEM_HZ
    }

    /// A request for the next trigger.
    pub fn put(&mut self, command: ModeCommand, address: u8, data: u16) {
        let word = u128::from(address) << 16 | u128::from(data);
        self.bench.set_all("request_command", command.code().into());
        self.bench.set_all("request_parameter", word);
        self.bench.set_all("request_ride", 1);
        self.bench.tick();
        self.bench.set_all("request_ride", 0);
        (0..4).for_each(|_| self.bench.tick());
    }

    pub fn trigger(&mut self) {
        for lanes in [u64::MAX, 0] {
            (0..2).for_each(|part| self.bench.set_trigger(part, lanes));
            self.bench.tick();
        }
    }

    /// Stops evaluating this lane.
    pub fn give_up(&mut self, lane: usize) {
        self.live[lane / 64] &= !(1 << (lane % 64));
    }

    fn is_live(&self, lane: usize) -> bool {
        self.live[lane / 64] >> (lane % 64) & 1 == 1
    }

    fn busy(&mut self) -> [u64; 2] {
        [0, 1].map(|part| self.bench.busy(part) & self.live[part])
    }

    /// Runs until no lane is busy. Returns the lanes that are still busy after `limit_us`.
    pub fn idle(&mut self, limit_us: u64) -> Vec<usize> {
        let end = self.bench.cycle() + limit_us * SYSTEM_HZ / 1_000_000;
        self.bench.tick();
        while self.bench.cycle() < end && self.busy() != [0, 0] {
            self.bench.tick();
        }
        let busy = self.busy();
        let is_busy = |lane: &usize| busy[lane / 64] >> (lane % 64) & 1 == 1;
        (0..LANES).filter(is_busy).collect()
    }

    pub fn settle(&mut self, limit_us: u64) {
        let busy = self.idle(limit_us);
        assert!(busy.is_empty(), "busy after {limit_us} us: {busy:?}");
    }

    pub fn run_for(&mut self, span: Time) {
        let end = self.bench.now() + span;
        while self.bench.now() < end {
            self.bench.tick();
        }
    }

    /// A triggered frame in all lanes.
    pub fn position(&mut self, limit_us: u64) {
        self.trigger();
        self.settle(limit_us);
    }

    pub fn last_frame(&self, lane: usize) -> &FrameLog {
        let frames = self.bench.link(0, lane).encoder().frames();
        frames.last().expect("a frame")
    }

    /// True if the last result is good, with the encoder's position.
    pub fn is_good(&self, lane: usize) -> bool {
        let good = |r: &ChannelResult| {
            let fine = (r.last_cause(), r.fresh, r.position_valid) == (cause::NONE, true, true);
            fine && r.position == self.last_frame(lane).position
        };
        self.bench.results(lane).last().is_some_and(good)
    }

    /// Triggers until every lane has had one good result for each of two triggers, with a limited number of bad ones before; every position reported as good on the way
    /// is right. Returns the failing lanes with their results, and the most triggers of the other lanes.
    pub fn recovered(
        &mut self,
        most: usize,
        what: &dyn Fn(usize) -> String,
    ) -> (Vec<String>, usize) {
        let mut needed = vec![0; self.used];
        for round in 0..most + 2 {
            let before: Vec<usize> = (0..self.used)
                .map(|lane| self.bench.results(lane).len())
                .collect();
            self.trigger();
            let busy = self.idle(1_000);
            assert!(busy.is_empty(), "busy for 1 ms: {}", what(busy[0]));
            for (lane, before) in before.iter().enumerate().filter(|(l, _)| self.is_live(*l)) {
                let results = &self.bench.results(lane)[*before..];
                let position = self.last_frame(lane).position;
                let right = |r: &ChannelResult| !r.fresh || r.position == position;
                assert!(results.iter().all(right), "wrong position: {}", what(lane));
                if results.len() != 1 || !self.is_good(lane) {
                    needed[lane] = round + 1;
                }
            }
        }
        let lost = (0..self.used).filter(|lane| needed[*lane] > most);
        let told = |r: &ChannelResult| (r.cause_name(), r.flags, r.fresh, r.delay_cycles);
        let lost = lost.map(|lane| {
            let results = self.bench.results(lane).iter().skip(FRAME as usize);
            let results: Vec<_> = results.map(told).collect();
            format!("{}: {results:?}", what(lane))
        });
        let found = needed.iter().filter(|n| **n <= most).max();
        (lost.collect(), *found.unwrap_or(&0))
    }
}
