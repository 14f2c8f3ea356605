//! Ports in lanes: up to the frame that is upset, and on from there.

use super::judge::{is_count, is_whole, Mark, Outcome, Reading};
use super::Flip;
use crate::{
    bench::{ChannelSettings, LaneBench, Link, PinNames},
    campaign::{CampaignError, ABORT_US},
    encoder::{EncoderConfig, LatchEdge},
    engine::{Keep, LaneWords, Lanes, PortId},
    line::LineConfig,
    Time, NS, US,
};
use endat_hdl::{
    channel::{Channel, Features, FixedTimes},
    elaborate::{elaborate, Design},
    protocol::ModeCommand,
};
use rust_hdl::prelude::Block;

/// System clock: eight cycles to a bit.
const SYSTEM_HZ: u64 = 32_000_000;
const ENDAT_HZ: u64 = 4_000_000;
const BIT: Time = 250 * NS;
const POSITION_BITS: u32 = 25;
const CABLE_M: f64 = 20.0;
const LANES: usize = 128;
/// Longest answer to a command with a parameter.
const PARAMETER_TIMEOUT_US: u64 = 200;
/// What a port may take for a frame, its time-outs and its quiet time.
const SLOW_US: u64 = 4_000;
/// What a timer takes that has been taken past its limit, and what follows it: 2^16 microseconds.
const HANG_US: u64 = 72_000;
/// Positions of a continuous run in which a flip falls.
const RUN_FRAMES: u64 = 3;

/// A port whose flip-flops are inverted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Port {
    /// Triggered positions only.
    Position,
    /// All parts: requests, diagnosis, continuous clock, alignment.
    AllParts,
    /// Alignment and double edge.
    DoubleEdge,
}

/// The frame in which it is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    /// At the calibration clock.
    Calibration,
    /// 111000.
    Position,
    /// 000111.
    Position21,
    /// 111000 with both additional informations.
    Informations,
    /// 001001: both informations and a supplement.
    Supplement,
    /// 001110, in a frame of its own.
    Request,
    /// A run with 000111.
    Continuous,
}

impl FrameKind {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Calibration => "calibration",
            Self::Position => "position",
            Self::Position21 => "position_21",
            Self::Informations => "informations",
            Self::Supplement => "supplement",
            Self::Request => "request",
            Self::Continuous => "continuous",
        }
    }

    fn command(self) -> ModeCommand {
        match self {
            Self::Position21 | Self::Continuous => ModeCommand::SendPosition,
            _ => ModeCommand::SendPositionAddInfo,
        }
    }
}

impl Port {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Position, Self::AllParts, Self::DoubleEdge];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "port",
            Self::AllParts => "port_all",
            Self::DoubleEdge => "port_double_edge",
        }
    }

    /// The frames that it can send.
    pub fn kinds(self) -> &'static [FrameKind] {
        use FrameKind::*;
        match self {
            Self::Position | Self::DoubleEdge => &[Calibration, Position, Position21],
            Self::AllParts => &[
                Calibration,
                Position,
                Position21,
                Informations,
                Supplement,
                Request,
                Continuous,
            ],
        }
    }

    fn features(self) -> Features {
        match self {
            Self::Position => Features::NONE,
            Self::AllParts => Features {
                alignment: true,
                ..Features::PROTOCOL
            },
            Self::DoubleEdge => Features {
                alignment: true,
                double_edge: true,
                ..Features::NONE
            },
        }
    }

    /// Its design.
    ///
    /// # Errors
    /// If it cannot be elaborated: a fault of this program.
    pub fn design(self) -> Result<Design, CampaignError> {
        let times = FixedTimes {
            abort_us: ABORT_US,
            parameter_timeout_us: PARAMETER_TIMEOUT_US,
            ..FixedTimes::at(SYSTEM_HZ)
        };
        let mut block = Channel::with(times, self.features());
        block.connect_all();
        Ok(elaborate(&block, "channel")?)
    }

    pub(super) fn engine(self) -> Result<Lanes, CampaignError> {
        let design = self.design()?;
        Ok(Lanes::new(&design, Keep::Registers, LaneWords::Two)?)
    }
}

fn cycles(us: u64) -> u64 {
    us * (SYSTEM_HZ / 1_000_000)
}

fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (word != 0).then(|| word.trailing_zeros() as usize);
        word &= word.wrapping_sub(1);
        bit
    })
}

/// Outputs that a reader looks at.
#[derive(Clone)]
struct Outputs {
    position: PortId,
    valid: PortId,
    fresh: PortId,
    cause: PortId,
    stamp: PortId,
    /// With requests: both informations, which are good; answer, whether it is.
    infos: [PortId; 3],
    reply: [PortId; 2],
}

/// Lanes that are all about to begin the frame.
pub(super) struct Ready {
    pub port: Port,
    pub kind: FrameKind,
    /// From the trigger to the next one.
    pub span_cycles: u64,
    bench: LaneBench,
    outputs: Outputs,
    /// From the trigger's cycle to the time stamp.
    stamp_after: u64,
}

/// What has been seen of a lane.
#[derive(Clone, Debug, Default)]
struct Lane {
    outcome: Outcome,
    begun: u64,
    due: u64,
    idle_since: u64,
    results: usize,
    frames: usize,
    violations: usize,
}

impl Ready {
    pub fn new(port: Port, kind: FrameKind, engine: Lanes) -> Self {
        let mut encoder = EncoderConfig::endat22(POSITION_BITS).continuous(LatchEdge::AfterLow);
        let tm = match kind.command().has_f2() {
            true => 1_500 * NS,
            false => 10 * US,
        };
        encoder.tm = tm..=tm;
        encoder.tac = 0..=0;
        encoder.write_time = 0..=0;
        encoder.reset_time = 0;
        let links = (0..LANES).map(|_| Link::new(LineConfig::cable(CABLE_M), encoder.clone()));
        let find = |name: &str| engine.port(name);
        let outputs = Outputs {
            position: find("position"),
            valid: find("position_valid"),
            fresh: find("fresh"),
            cause: find("cause"),
            stamp: find("first_fall_timestamp"),
            infos: ["info_1", "info_2", "info_good"].map(find),
            reply: ["reply", "reply_good"].map(find),
        };
        let pins = (PinNames::channel(), links.collect());
        let mut bench = LaneBench::new(engine, SYSTEM_HZ, vec![pins]);
        if port.features().double_edge {
            bench.set_double_edge();
        }
        let settings = ChannelSettings {
            abort_us: ABORT_US,
            ..ChannelSettings::new(SYSTEM_HZ, ENDAT_HZ, kind.command(), POSITION_BITS)
        };
        (0..LANES).for_each(|lane| bench.configure(lane, &settings));
        bench.set_all("reset", 1);
        (0..8).for_each(|_| bench.tick());
        bench.set_all("reset", 0);
        (0..cycles(ABORT_US + 10)).for_each(|_| bench.tick());
        let mut ready = Self {
            port,
            kind,
            span_cycles: 0,
            bench,
            outputs,
            stamp_after: 0,
        };
        ready.prepare();
        ready
    }

    /// Everything up to the frame: delay measured, informations selected, the run begun.
    fn prepare(&mut self) {
        let bench = &mut self.bench;
        // With alignment several frames measure.
        (0..6).for_each(|_| {
            trigger_all(bench);
            settle(bench);
        });
        let selects = matches!(self.kind, FrameKind::Informations | FrameKind::Supplement);
        if selects {
            for code in [0x4C, 0x5B] {
                put(
                    bench,
                    ModeCommand::PositionSelectMemory,
                    code,
                    "request_ride",
                );
                trigger_all(bench);
                settle(bench);
            }
        }
        let from = bench.cycle();
        trigger_all(bench);
        settle(bench);
        let result = bench.results(0).last().expect("a result");
        assert!(
            result.fresh && result.last_cause() == 0,
            "{} {}: {result:?}",
            self.port.name(),
            self.kind.name()
        );
        self.stamp_after = result.first_fall_timestamp.wrapping_sub(from);
        match self.kind {
            FrameKind::Supplement => {
                put(
                    bench,
                    ModeCommand::PositionSelectMemory,
                    0x4D,
                    "request_ride",
                );
            }
            FrameKind::Calibration => {
                bench.set_all("calibrate", 1);
                bench.tick();
                bench.set_all("calibrate", 0);
                bench.tick();
            }
            FrameKind::Continuous => {
                bench.set_all("continuous", 1);
                trigger_all(bench);
                let results = bench.results(0).len() + 4;
                while bench.results(0).len() < results {
                    bench.tick();
                }
                let times = bench.results(0)[results - 2..].iter().map(|r| r.cycle);
                let times: Vec<u64> = times.collect();
                self.span_cycles = RUN_FRAMES * (times[1] - times[0]);
            }
            _ => {}
        }
        if self.kind != FrameKind::Continuous {
            let mut trial = self.bench.clone();
            let from = trial.cycle();
            begin(&mut trial, self.kind);
            settle(&mut trial);
            let frame = trial.cycle() - from;
            self.span_cycles = frame + frame / 8 + 32;
        }
    }

    /// Runs the frame with these flips, one in each lane, and as many frames after it as it takes.
    pub fn run(&self, flips: &[Flip]) -> Vec<Outcome> {
        let mut run = Run {
            ready: self,
            bench: self.bench.clone(),
            lanes: vec![],
            waiting: [0; 2],
            running: [0; 2],
            busy: [0; 2],
            next_due: 0,
        };
        let link = run.bench.link(0, 0).encoder();
        let (frames, violations) = (link.frames().len(), link.violations().len());
        let first = Lane {
            begun: run.bench.cycle(),
            due: run.bench.cycle() + self.span_cycles,
            results: run.bench.results(0).len(),
            frames,
            violations,
            ..Lane::default()
        };
        run.lanes = vec![first; flips.len()];
        run.all(flips)
    }
}

/// The frame that is upset begins, in all lanes.
fn begin(bench: &mut LaneBench, kind: FrameKind) {
    match kind {
        FrameKind::Continuous => {}
        FrameKind::Request => put(bench, ModeCommand::SelectMemory, 0xA1, "request_own"),
        _ => trigger_all(bench),
    }
}

fn trigger_all(bench: &mut LaneBench) {
    for lanes in [u64::MAX, 0] {
        (0..2).for_each(|part| bench.set_trigger(part, lanes));
        if lanes != 0 {
            bench.tick();
        }
    }
}

/// A request in all lanes.
fn put(bench: &mut LaneBench, command: ModeCommand, address: u8, strobe: &str) {
    bench.set_all("request_command", command.code().into());
    bench.set_all("request_parameter", u128::from(address) << 16);
    bench.set_all(strobe, 1);
    bench.tick();
    bench.set_all(strobe, 0);
    (0..4).for_each(|_| bench.tick());
}

/// Until no lane is busy.
fn settle(bench: &mut LaneBench) {
    (0..4).for_each(|_| bench.tick());
    let end = bench.cycle() + cycles(SLOW_US);
    while bench.busy(0) | bench.busy(1) != 0 {
        assert!(bench.cycle() < end, "a port without upset stays busy");
        bench.tick();
    }
}

/// A batch on its way.
struct Run<'a> {
    ready: &'a Ready,
    bench: LaneBench,
    lanes: Vec<Lane>,
    /// Lanes whose time has come, as soon as they are idle.
    waiting: [u64; 2],
    /// Lanes of which not all has been seen.
    running: [u64; 2],
    busy: [u64; 2],
    /// When the time of the next lane comes.
    next_due: u64,
}

impl Run<'_> {
    fn all(mut self, flips: &[Flip]) -> Vec<Outcome> {
        let start = self.bench.cycle();
        let mut order: Vec<usize> = (0..flips.len()).collect();
        order.sort_by_key(|lane| flips[*lane].cycle);
        let mut next = order.iter().copied().peekable();
        (0..flips.len()).for_each(|lane| self.running[lane / 64] |= 1 << (lane % 64));
        // What begins the frame takes a few cycles; flips that fall into them come right after.
        begin(&mut self.bench, self.ready.kind);
        self.busy = [0, 1].map(|part| self.bench.busy(part));
        while self.running != [0, 0] {
            let cycle = self.bench.cycle();
            while let Some(lane) = next.next_if(|lane| start + flips[*lane].cycle <= cycle) {
                let flip = &flips[lane];
                self.bench.engine().flip(flip.register, flip.bit, lane);
            }
            self.time_passes(cycle);
            self.bench.tick();
            (0..2).for_each(|part| self.note_idle(part));
        }
        self.lanes.into_iter().map(|lane| lane.outcome).collect()
    }

    fn note_idle(&mut self, part: usize) {
        let busy = self.bench.busy(part);
        let before = std::mem::replace(&mut self.busy[part], busy);
        let fallen = before & !busy & self.running[part];
        for lane in bits(fallen).map(|bit| 64 * part + bit) {
            self.lanes[lane].idle_since = self.bench.cycle();
        }
    }

    /// Reads the lanes that are idle when their time has come, and triggers them again.
    fn time_passes(&mut self, cycle: u64) {
        if cycle >= self.next_due {
            self.next_due = u64::MAX;
            for lane in 0..self.lanes.len() {
                let (part, bit) = (lane / 64, 1 << (lane % 64));
                if self.running[part] & !self.waiting[part] & bit == 0 {
                    continue;
                }
                if self.lanes[lane].due <= cycle {
                    self.waiting[part] |= bit;
                    self.leave_run(lane);
                } else {
                    self.next_due = self.next_due.min(self.lanes[lane].due);
                }
            }
        }
        for part in 0..2 {
            let mut triggers = 0;
            let idle = self.waiting[part] & !self.bench.busy(part);
            for bit in bits(idle) {
                if self.read(64 * part + bit) {
                    self.running[part] &= !(1 << bit);
                } else {
                    triggers |= 1 << bit;
                }
                self.waiting[part] &= !(1 << bit);
            }
            for bit in bits(self.waiting[part]) {
                let lane = &mut self.lanes[64 * part + bit];
                let waited = cycle - lane.due;
                if waited == cycles(SLOW_US) {
                    lane.outcome.mark(Mark::Slow);
                }
                if waited >= cycles(HANG_US) {
                    lane.outcome.hang();
                    self.waiting[part] &= !(1 << bit);
                    self.running[part] &= !(1 << bit);
                }
            }
            self.bench.set_trigger(part, triggers);
        }
    }

    /// A continuous run ends when it is asked to.
    fn leave_run(&mut self, lane: usize) {
        if self.ready.kind == FrameKind::Continuous && self.lanes[lane].outcome.is_first() {
            let port = self.bench.engine().port("continuous");
            self.bench.engine().set(port, lane, 0);
        }
    }

    /// Reads a lane; whether all has been seen.
    fn read(&mut self, index: usize) -> bool {
        let reading = self.reading(index);
        let cycle = self.bench.cycle();
        let encoder = self.bench.link(0, index).encoder();
        let (frames, violations) = (encoder.frames().len(), encoder.violations().len());
        let results = self.bench.results(index).len();
        let lane = &mut self.lanes[index];
        (lane.frames, lane.violations, lane.results) = (frames, violations, results);
        let is_done = lane.outcome.read(&reading);
        lane.begun = cycle;
        lane.due = cycle + self.ready.span_cycles;
        self.next_due = self.next_due.min(lane.due);
        is_done
    }

    fn reading(&mut self, index: usize) -> Reading {
        let lane = self.lanes[index].clone();
        let outputs = &self.ready.outputs;
        let is_first = lane.outcome.is_first();
        let kind = self.ready.kind;
        let mut get = |port: PortId| self.bench.engine().get(port, index) as u64;
        let (position, cause) = (get(outputs.position), get(outputs.cause));
        let (valid, fresh) = (get(outputs.valid) == 1, get(outputs.fresh) == 1);
        let stamp = get(outputs.stamp);
        let has_requests = self.ready.port.features().requests;
        let [info_1, info_2, info_good] = outputs.infos.map(&mut get);
        let [reply, reply_good] = outputs.reply.map(&mut get);
        let link = self.bench.link(0, index);
        let (frames, all) = (
            &link.encoder().frames()[lane.frames..],
            link.encoder().frames(),
        );
        let results = &self.bench.results(index)[lane.results..];
        let is_run = is_first && kind == FrameKind::Continuous;
        let is_request = is_first && kind == FrameKind::Request;
        let told_wrong = |r: &crate::bench::ChannelResult| {
            let before: Vec<u64> = all
                .iter()
                .filter(|f| f.first_fall <= r.time)
                .map(|f| f.position)
                .collect();
            let latest = &before[before.len().saturating_sub(2)..];
            r.last_cause() == 0 && r.fresh && !latest.contains(&r.position)
        };
        let sent = match (is_run, is_request) {
            // The last of the run; a wrong one before it is as bad.
            (true, _) if results.iter().any(told_wrong) => None,
            (true, _) => {
                let latest = &all[all.len().saturating_sub(3)..];
                let matching = latest.iter().find(|f| f.position == position);
                matching.or(all.last()).map(|f| f.position)
            }
            // No result of its own: the position before it stays.
            (_, true) => all[..lane.frames].last().map(|f| f.position),
            _ => frames.last().map(|f| f.position),
        };
        let before = &all[..all.len() - usize::from(!frames.is_empty())];
        let mut others_right = true;
        if !is_run && !is_request {
            others_right &= stamp == (lane.begun + self.ready.stamp_after) & 0xFFFF_FFFF;
        }
        if let (true, Some(frame)) = (has_requests, frames.last()) {
            for (info, _) in &frame.infos {
                let (word, bit) = match info.code < 0x50 {
                    true => (info_1, 1),
                    false => (info_2, 2),
                };
                let is_right = word == u64::from(info.fields().word());
                others_right &= info_good & bit == 0 || is_right;
            }
            if let (true, Some(answer)) = (is_request, frame.reply) {
                others_right &= reply_good == 0 || reply == u64::from(answer.word());
            }
        }
        let violations = &link.encoder().violations()[lane.violations..];
        let counts = violations.iter().any(|v| is_count(&v.1));
        let is_one = is_run || frames.is_empty() || frames.len() == 1 && is_whole(&frames[0]);
        let system_ps = |cycle: u64| cycle * 1_000_000 * US / SYSTEM_HZ;
        let idle = system_ps(lane.idle_since.max(lane.begun));
        let conflicts = link.line().conflicts(self.bench.now());
        let outlasts = |c: &crate::line::Conflict| {
            let end = c.from + c.length;
            c.length > BIT && end > idle + BIT && end > system_ps(lane.begun)
        };
        Reading {
            has_result: is_request && !frames.is_empty() || !results.is_empty(),
            cause,
            position,
            valid,
            fresh,
            sent,
            was_sent: before.iter().any(|f| f.position == position),
            others_right,
            pulses: counts || !is_one,
            rules: violations.iter().any(|v| !is_count(&v.1)),
            conflict: conflicts.iter().any(outlasts),
        }
    }
}
