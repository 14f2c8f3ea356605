//! One batch: the frame with the faults, one in each lane, and as many frames after it as needed.

use super::judge::{are_needed, are_whole, is_count, Mark, Outcome, Reading};
use super::{begin, cycles, FrameKind, Mishap, Ready, BIT, HANG_US, LEAD, SLOW_US, SYSTEM_HZ};
use crate::{
    bench::{bits, ChannelResult, LaneBench, Link},
    line::{Conflict, Jitter, LineFault},
    US,
};
use rtl_design::engine::PortId;

/// Units of time in a second.
const PER_SECOND: u64 = 1_000_000 * US;
const LEAD_CYCLES: u64 = LEAD * (SYSTEM_HZ / 1_000_000) / US;

impl Mishap {
    /// Cycle in which the bench applies it, if it has to.
    fn cycle(&self) -> Option<u64> {
        match self {
            Self::Flip { cycle, .. } | Self::Setting { cycle, .. } => Some(*cycle),
            _ => None,
        }
    }
}

/// State of a lane.
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
    /// Runs the frame with these faults, one in each lane.
    pub fn run(&self, mishaps: &[Mishap]) -> Vec<Outcome> {
        let mut run = self.start(mishaps);
        run.all();
        run.lanes.into_iter().map(|lane| lane.outcome).collect()
    }

    fn start<'a>(&'a self, mishaps: &'a [Mishap]) -> Run<'a> {
        let bench = self.bench.clone();
        let encoder = bench.link(0, 0).encoder();
        let first = Lane {
            results: bench.results(0).len(),
            frames: encoder.frames().len(),
            violations: encoder.violations().len(),
            ..Lane::default()
        };
        Run {
            ready: self,
            bench,
            lanes: vec![first; mishaps.len()],
            waiting: [0; 2],
            running: [0; 2],
            busy: [0; 2],
            next_due: 0,
            mishaps,
            is_alone: false,
        }
    }

    /// Runs only the frame: returns the reports to the reader, and the answer of the encoder.
    pub fn answers(&self, mishaps: &[Mishap]) -> Vec<Told> {
        let mut run = self.start(mishaps);
        run.is_alone = true;
        run.all();
        let outputs = &self.outputs;
        let told = |lane: usize| {
            let mut get = |port: PortId| run.bench.engine().get(port, lane) as u64;
            let is_good = (get(outputs.cause), get(outputs.fresh), get(outputs.valid)) == (0, 1, 1);
            let position = is_good.then(|| get(outputs.position));
            let frame = run.bench.link(0, lane).encoder().frames().last();
            Told {
                position,
                answer: frame.map_or(vec![], |f| f.answer.iter().collect()),
            }
        };
        (0..mishaps.len()).map(told).collect()
    }
}

/// Outcome of one frame.
pub(in crate::campaign) struct Told {
    /// The position, if reported as good.
    pub position: Option<u64>,
    /// Start bit to the last bit of the CRC.
    pub answer: Vec<bool>,
}

/// A running batch.
struct Run<'a> {
    ready: &'a Ready,
    bench: LaneBench,
    lanes: Vec<Lane>,
    /// Lanes whose time has come, waiting to become idle.
    waiting: [u64; 2],
    /// Unfinished lanes.
    running: [u64; 2],
    busy: [u64; 2],
    /// Time of the next lane.
    next_due: u64,
    mishaps: &'a [Mishap],
    /// Only the frame is evaluated.
    is_alone: bool,
}

impl Run<'_> {
    fn all(&mut self) {
        let mishaps = self.mishaps;
        for (lane, mishap) in mishaps.iter().enumerate() {
            self.prepare(lane, mishap);
            self.running[lane / 64] |= 1 << (lane % 64);
        }
        if mishaps.iter().any(|m| matches!(m, Mishap::Fault { .. })) {
            (0..LEAD_CYCLES).for_each(|_| self.bench.tick());
        }
        let start = self.bench.cycle();
        for lane in &mut self.lanes {
            (lane.begun, lane.due) = (start, start + self.ready.span_cycles);
        }
        let mut order: Vec<(u64, usize)> = (mishaps.iter().enumerate())
            .filter_map(|(lane, mishap)| Some((start + mishap.cycle()?, lane)))
            .collect();
        order.sort_unstable();
        let mut next = order.into_iter().peekable();
        // Starting the frame takes a few cycles; faults during these are applied right after.
        begin(&mut self.bench, self.ready.kind);
        self.busy = [0, 1].map(|part| self.bench.busy(part));
        while self.running != [0, 0] {
            let cycle = self.bench.cycle();
            while let Some((_, lane)) = next.next_if(|(at, _)| *at <= cycle) {
                match &mishaps[lane] {
                    Mishap::Flip { register, bit, .. } => {
                        self.bench.upset(*register, *bit, lane);
                    }
                    Mishap::Setting { name, value, .. } => self.bench.set(name, lane, *value),
                    _ => {}
                }
            }
            self.time_passes(cycle);
            self.bench.tick();
            (0..2).for_each(|part| self.note_idle(part));
        }
    }

    /// Applies faults before the frame begins.
    fn prepare(&mut self, lane: usize, mishap: &Mishap) {
        let now = self.bench.now();
        let reseed = |link: &mut Link, seed: u64| link.encoder_mut().reseed(seed);
        self.bench.disturb(0, lane, |link| match mishap.clone() {
            Mishap::Flip { .. } | Mishap::Setting { .. } => {}
            Mishap::Fault {
                kind,
                from,
                until,
                seed,
            } => {
                reseed(link, seed);
                let (from, until) = (now + from, now + until);
                link.disturb(|line| line.set_fault(LineFault::new(kind, from, until, seed)));
                if kind.is_plug() {
                    link.encoder_mut().unplug(from, until);
                }
            }
            Mishap::Answer(defect, seed) => {
                reseed(link, seed);
                link.encoder_mut().spoil_next(defect);
            }
            Mishap::Jitter(jitter, seed) => {
                reseed(link, seed);
                link.disturb(|line| line.set_jitter(jitter, seed));
            }
        });
    }

    /// Removes faults after the frame.
    fn restore(&mut self, lane: usize) {
        if let Mishap::Setting { name, .. } = &self.mishaps[lane] {
            let before = self
                .ready
                .settings
                .ports()
                .into_iter()
                .find(|p| p.0 == *name);
            self.bench.set(name, lane, before.map_or(0, |p| p.1));
        }
        if let Mishap::Jitter(..) = self.mishaps[lane] {
            let quiet = |link: &mut Link| link.disturb(|line| line.set_jitter(Jitter::None, 0));
            self.bench.disturb(0, lane, quiet);
        }
    }

    fn note_idle(&mut self, part: usize) {
        let busy = self.bench.busy(part);
        let before = std::mem::replace(&mut self.busy[part], busy);
        let fallen = before & !busy & self.running[part];
        for lane in bits(fallen).map(|bit| 64 * part + bit) {
            self.lanes[lane].idle_since = self.bench.cycle();
        }
    }

    /// Reads the idle lanes when their time has come, and triggers them again.
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
                    if self.lanes[lane].outcome.is_first() {
                        self.leave_run(lane);
                        self.restore(lane);
                    }
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

    /// Ends a continuous run on request.
    fn leave_run(&mut self, lane: usize) {
        if self.ready.kind == FrameKind::Continuous {
            self.bench.set("continuous", lane, 0);
        }
    }

    /// Reads a lane; true if it is finished.
    fn read(&mut self, index: usize) -> bool {
        let reading = self.reading(index);
        let cycle = self.bench.cycle();
        let encoder = self.bench.link(0, index).encoder();
        let (frames, violations) = (encoder.frames().len(), encoder.violations().len());
        let results = self.bench.results(index).len();
        let lane = &mut self.lanes[index];
        (lane.frames, lane.violations, lane.results) = (frames, violations, results);
        let is_done = lane.outcome.read(&reading) | self.is_alone;
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
        let [reply, reply_good, over_cause] = outputs.reply.map(&mut get);
        let link = self.bench.link(0, index);
        let (frames, all) = (
            &link.encoder().frames()[lane.frames..],
            link.encoder().frames(),
        );
        let results = &self.bench.results(index)[lane.results..];
        let is_run = is_first && kind == FrameKind::Continuous;
        let is_request = is_first && kind == FrameKind::Request;
        let told_wrong = |r: &ChannelResult| {
            let before: Vec<u64> = all
                .iter()
                .filter(|f| f.first_fall <= r.time)
                .map(|f| f.position)
                .collect();
            let latest = &before[before.len().saturating_sub(2)..];
            r.last_cause() == 0 && r.fresh && !latest.contains(&r.position)
        };
        let sent = match (is_run, is_request) {
            // The last position of the run; a wrong one before it is as bad.
            (true, _) if results.iter().any(told_wrong) => None,
            (true, _) => {
                let latest = &all[all.len().saturating_sub(3)..];
                let matching = latest.iter().find(|f| f.position == position);
                matching.or(all.last()).map(|f| f.position)
            }
            // Without a new result the previous position remains.
            (_, true) => all[..lane.frames].last().map(|f| f.position),
            _ => frames.last().map(|f| f.position),
        };
        let before = &all[..all.len() - usize::from(!frames.is_empty())];
        let mut others_right = true;
        if !is_run && !is_request {
            // The position's frame may follow one that measured the delay.
            let later = match frames {
                [first, .., last] => (last.first_fall - first.first_fall) * SYSTEM_HZ / PER_SECOND,
                _ => 0,
            };
            others_right &= stamp == (lane.begun + self.ready.stamp_after + later) & 0xFFFF_FFFF;
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
        let is_jitter = matches!(self.mishaps[index], Mishap::Jitter(..));
        let violations = &link.encoder().violations()[lane.violations..];
        let counts = violations.iter().any(|v| is_count(&v.1));
        let system_ps = |cycle: u64| cycle * PER_SECOND / SYSTEM_HZ;
        let idle = system_ps(lane.idle_since.max(lane.begun));
        let conflicts = link.line().conflicts(self.bench.now());
        let outlasts = |c: &Conflict| {
            let end = c.from + c.length;
            c.length > BIT && end > idle + BIT && end > system_ps(lane.begun)
        };
        Reading {
            has_result: is_request && !frames.is_empty() || !results.is_empty(),
            cause,
            is_refused: is_request && (reply_good == 0 || over_cause != 0),
            position,
            valid,
            fresh,
            sent,
            was_sent: before.iter().any(|f| f.position == position),
            others_right,
            pulses: counts || !is_run && !are_whole(frames),
            again: !is_run && !are_needed(frames),
            // Jitter makes pulses that violate the encoder's rules without an error of the port.
            rules: !is_jitter && violations.iter().any(|v| !is_count(&v.1)),
            conflict: conflicts.iter().any(outlasts),
        }
    }
}
