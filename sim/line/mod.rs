//! The two pairs between receiver and encoder: CLOCK one way, DATA both ways.
//!
//! ```text
//! receiver pin --transceiver--cable--transceiver-- encoder pin       CLOCK
//! receiver pin --transceiver--cable--transceiver-- encoder pin       DATA: each end receives the other after the path's delay
//! ```
//!
//! An undriven DATA pair reads HIGH (fail-safe transceivers). A driver acts at its own end at once; times
//! of an end refer to its pins.

mod config;
mod fault;
mod path;
mod seen;
#[cfg(test)]
mod tests;

pub use config::{Glitch, GlitchRate, Jitter, LineConfig, PathConfig, Stuck, Wire};
pub use fault::{FaultKind, LineFault};
pub use seen::{Arrival, Conflict, DataChange, End, Sample, Who};

use crate::{
    encoder::{Drive, Output},
    rng::Rng,
    Journal, Time,
};
use path::Path;
use std::collections::VecDeque;

/// The line. Calls must be in order of time.
#[derive(Clone)]
pub struct Line {
    config: LineConfig,
    clock: Path<bool>,
    data_out: Path<Drive>,
    data_in: Path<Output>,
    echo: Option<Path<Drive>>,
    /// Future or present stuck level.
    stuck: Option<Stuck>,
    is_stuck: bool,
    fault: Option<LineFault>,
    /// CLOCK as driven by the receiver.
    clock_sent: bool,
    receiver: Drive,
    encoder: Output,
    glitches: VecDeque<Glitch>,
    /// The present glitch, and its end.
    glitch: Option<(Wire, Time)>,
    rng: Rng,
    history: VecDeque<DataChange>,
    conflicts: Journal<Conflict>,
    open_conflicts: [Option<Conflict>; 2],
}

impl Line {
    /// A line with CLOCK HIGH, the receiver's driver off and the encoder driving `encoder`.
    pub fn new(config: LineConfig, encoder: Output) -> Self {
        let mut rng = Rng::new(config.seed);
        let flight = config.flight();
        let mut line = Self {
            clock: Path::new(config.clock, flight, rng.next_u64(), true),
            data_out: Path::new(config.data_out, flight, rng.next_u64(), Drive::Released),
            data_in: Path::new(config.data_in, flight, rng.next_u64(), encoder),
            echo: config.echo_after.map(|delay| {
                let path = PathConfig {
                    transceivers: delay,
                    ..PathConfig::default()
                };
                Path::new(path, 0, 0, Drive::Released)
            }),
            stuck: config.stuck,
            is_stuck: false,
            fault: None,
            clock_sent: true,
            receiver: Drive::Released,
            encoder,
            glitches: config.glitches.iter().copied().collect(),
            glitch: None,
            rng,
            history: VecDeque::new(),
            conflicts: Journal::default(),
            open_conflicts: [None; 2],
            config,
        };
        line.plan_glitch(0);
        line.note_data(0);
        line
    }

    /// Configuration.
    pub fn config(&self) -> &LineConfig {
        &self.config
    }

    /// Sets a future fault, replacing the previous one.
    pub fn set_fault(&mut self, fault: LineFault) {
        self.fault = Some(fault);
    }

    /// Removes faults and random glitches.
    pub fn heal(&mut self, time: Time) {
        self.fault = None;
        self.set_random_glitches(time, None);
        self.changed(time);
    }

    /// From now on glitches occur at this rate.
    pub fn set_random_glitches(&mut self, time: Time, rate: Option<GlitchRate>) {
        self.config.random_glitches = rate;
        self.glitches.clear();
        self.plan_glitch(time);
    }

    /// From now on the edges of all three paths have this jitter.
    pub fn set_jitter(&mut self, jitter: Jitter, seed: u64) {
        let mut rng = Rng::new(seed);
        self.clock.set_jitter(jitter, rng.next_u64());
        self.data_out.set_jitter(jitter, rng.next_u64());
        self.data_in.set_jitter(jitter, rng.next_u64());
    }

    /// The receiver sets CLOCK.
    pub fn set_clock(&mut self, time: Time, level: bool) {
        self.clock.send(time, level);
        self.clock_sent = level;
        if self.fault.is_some() {
            self.note_data(time);
        }
    }

    /// The receiver drives DATA.
    pub fn set_receiver(&mut self, time: Time, drive: Drive) {
        if drive != self.receiver {
            self.receiver = drive;
            self.data_out.send(time, drive);
            if let Some(echo) = &mut self.echo {
                echo.send(time, drive);
            }
            self.changed(time);
        }
    }

    /// The encoder drives DATA.
    pub fn set_encoder(&mut self, time: Time, output: Output) {
        if output != self.encoder {
            self.encoder = output;
            self.data_in.send(time, output);
            self.changed(time);
        }
    }

    /// Time of the next arrival; [`Time::MAX`] if there is none.
    pub fn next_event(&self) -> Time {
        let glitch = match self.glitch {
            Some((_, end)) => end,
            None => self.glitches.front().map_or(Time::MAX, |g| g.at),
        };
        let data = self.data_out.next().min(self.data_in.next());
        let echo = self.echo.as_ref().map_or(Time::MAX, Path::next);
        let stuck = self.stuck.map_or(Time::MAX, |s| match self.is_stuck {
            true => s.until,
            false => s.from,
        });
        let edges = glitch.min(self.clock.next()).min(data);
        let fault = self.fault.as_ref().map_or(Time::MAX, LineFault::next_event);
        edges.min(echo).min(stuck).min(fault)
    }

    /// Processes one arrival that is due at `time`.
    pub fn advance(&mut self, time: Time) -> Option<Arrival> {
        if self.data_out.arrive(time).is_some() {
            self.changed(time);
            return Some(Arrival::Data(End::Encoder));
        }
        if self.clock.arrive(time).is_some() {
            return Some(Arrival::Clock(self.clock_at_encoder()));
        }
        if self.data_in.arrive(time).is_some() {
            self.changed(time);
            return Some(Arrival::Data(End::Receiver));
        }
        if let Some((changed, is_over)) = self.fault.as_mut().map(|f| f.advance(time)) {
            if is_over {
                self.fault = None;
            }
            if changed {
                self.changed(time);
                return Some(Arrival::Data(End::Receiver));
            }
        }
        let echo_arrived = self.echo.as_mut().and_then(|echo| echo.arrive(time));
        if echo_arrived.is_some() || self.switch_stuck(time) {
            self.changed(time);
            return Some(Arrival::Data(End::Receiver));
        }
        let wire = self.switch_glitch(time)?;
        self.changed(time);
        Some(match wire {
            Wire::Clock => Arrival::Clock(self.clock_at_encoder()),
            Wire::Data => Arrival::Data(End::Receiver),
        })
    }

    /// CLOCK at the encoder's pin.
    pub fn clock_at_encoder(&self) -> bool {
        self.clock.arrived() ^ self.in_glitch(Wire::Clock)
    }

    /// The receiver's drive on DATA, as it arrives at the encoder.
    pub fn receiver_at_encoder(&self) -> Drive {
        let drive = self.data_out.arrived();
        let faulty = |f: &LineFault| f.at_encoder(drive, self.clock_at_encoder());
        self.fault.as_ref().map_or(drive, faulty)
    }

    /// The encoder's drive on DATA, as it arrives at the receiver.
    pub fn encoder_at_receiver(&self) -> Output {
        self.data_in.arrived()
    }

    /// The receiver's drive on DATA.
    pub fn receiver(&self) -> Drive {
        self.receiver
    }

    /// The encoder's drive on DATA.
    pub fn encoder(&self) -> Output {
        self.encoder
    }

    /// DATA at the receiver's pin.
    pub fn data_at_receiver(&self) -> bool {
        self.history.back().is_none_or(|c| c.level)
    }

    /// Driver of DATA at the receiver's pin.
    pub fn who_at_receiver(&self) -> Who {
        let remote = self.data_in.arrived();
        match (self.receiver, remote.drive) {
            (Drive::Released, Drive::Released) => Who::Nobody,
            (_, Drive::Released) => Who::Receiver,
            (Drive::Released, _) => Who::Encoder(remote.symbol),
            _ => Who::Both,
        }
    }

    /// DATA at the encoder's pin.
    pub fn data_at_encoder(&self) -> bool {
        match (self.encoder.drive, self.data_out.arrived()) {
            (Drive::Released, remote) => remote != Drive::Low,
            (local, _) => local == Drive::High,
        }
    }

    /// Keeps only the last `most` conflicts.
    pub fn keep(&mut self, most: usize) {
        self.conflicts.keep(most);
    }

    /// The conflicts so far; unfinished ones end at `now`.
    pub fn conflicts(&self, now: Time) -> Vec<Conflict> {
        let ended = |c: &Conflict| Conflict {
            length: now - c.from,
            ..*c
        };
        let open = self.open_conflicts.iter().flatten().map(ended);
        let all = self.conflicts.iter().copied().chain(open);
        all.filter(|c| c.length > 0).collect()
    }

    /// DATA at the receiver's pin at a time not before the last [`Line::forget_before`].
    pub fn sample(&self, time: Time) -> Sample {
        let next = self.history.partition_point(|c| c.time <= time);
        let change = self.history[next.saturating_sub(1)];
        Sample {
            time,
            level: change.level,
            who: change.who,
            glitch: change.glitch,
            since: time.saturating_sub(change.time),
            until: self.history.get(next).map(|c| c.time - time),
        }
    }

    /// The recorded changes of DATA at the receiver's pin.
    pub fn history(&self) -> impl Iterator<Item = &DataChange> {
        self.history.iter()
    }

    /// Drops the history of DATA before `time`, to limit memory in long runs.
    pub fn forget_before(&mut self, time: Time) {
        while self.history.len() > 1 && self.history[1].time <= time {
            self.history.pop_front();
        }
    }

    fn in_glitch(&self, wire: Wire) -> bool {
        self.glitch.is_some_and(|g| g.0 == wire)
    }

    fn switch_stuck(&mut self, time: Time) -> bool {
        match self.stuck {
            Some(s) if self.is_stuck && s.until <= time => {
                self.is_stuck = false;
                self.stuck = None;
                true
            }
            Some(s) if !self.is_stuck && s.from <= time => {
                self.is_stuck = true;
                true
            }
            _ => false,
        }
    }

    /// The level that overrides the drivers of the pair.
    fn overriding(&self) -> Option<bool> {
        if self.is_stuck {
            return self.stuck.map(|s| s.level);
        }
        let echo = self.echo.as_ref()?.arrived();
        (self.receiver == Drive::Released && echo != Drive::Released).then_some(echo == Drive::High)
    }

    fn switch_glitch(&mut self, time: Time) -> Option<Wire> {
        if let Some((wire, end)) = self.glitch {
            if end > time {
                return None;
            }
            self.glitch = None;
            self.plan_glitch(time);
            return Some(wire);
        }
        let next = *self.glitches.front()?;
        if next.at > time {
            return None;
        }
        self.glitches.pop_front();
        self.glitch = Some((next.wire, time + next.width));
        Some(next.wire)
    }

    fn plan_glitch(&mut self, now: Time) {
        let Some(rate) = self.config.random_glitches else {
            return;
        };
        if self.glitches.is_empty() {
            let uniform = (self.rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
            let gap = -(1.0 - uniform).ln() * rate.mean_gap as f64;
            self.glitches.push_back(Glitch {
                wire: rate.wire,
                at: now + gap as Time,
                width: self.rng.in_range(rate.shortest, rate.longest),
            });
        }
    }

    fn changed(&mut self, time: Time) {
        self.note_data(time);
        let receiver_end = (self.receiver, self.data_in.arrived().drive);
        let encoder_end = (self.encoder.drive, self.data_out.arrived());
        for (i, (end, drives)) in [(End::Receiver, receiver_end), (End::Encoder, encoder_end)]
            .into_iter()
            .enumerate()
        {
            self.note_conflict(time, i, end, drives);
        }
    }

    fn note_data(&mut self, time: Time) {
        let who = self.who_at_receiver();
        let level = match self.receiver {
            Drive::Released => self.data_in.arrived().drive != Drive::Low,
            local => local == Drive::High,
        };
        let glitch = self.in_glitch(Wire::Data);
        let level = self.overriding().unwrap_or(level) ^ glitch;
        let faulty = |f: &LineFault| f.at_receiver(level, self.receiver, self.clock_sent);
        let change = DataChange {
            time,
            level: self.fault.as_ref().map_or(level, faulty),
            who,
            glitch,
        };
        match self.history.back_mut() {
            Some(last) if last.time == time => *last = change,
            Some(last) if DataChange { time, ..*last } == change => {}
            _ => self.history.push_back(change),
        }
    }

    fn note_conflict(&mut self, time: Time, slot: usize, end: End, drives: (Drive, Drive)) {
        let (a, b) = drives;
        let both = a != Drive::Released && b != Drive::Released;
        if !both {
            if let Some(mut c) = self.open_conflicts[slot].take() {
                c.length = time - c.from;
                if c.length > 0 {
                    self.conflicts.push(c);
                }
            }
            return;
        }
        let both_on = self.receiver != Drive::Released && self.encoder.drive != Drive::Released;
        let c = self.open_conflicts[slot].get_or_insert(Conflict {
            end,
            from: time,
            length: 0,
            opposing: false,
            both_on: false,
        });
        c.opposing |= a != b;
        c.both_on |= both_on;
    }
}
