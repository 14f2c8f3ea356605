//! The encoder at the far end of the cable, written from the encoder's side of the interface description.
//!
//! It works in picoseconds and only at edges: [`Encoder::clock_edge`] tells it of the clock, [`Encoder::next_event`] says when it
//! wants to act by itself, [`Encoder::advance`] lets it act, [`Encoder::output`] is what it does to DATA.
//!
//! ```text
//!          F1   R1 F2 R2 F3 R3      F8 R8 F9 R9 F10 R10 F11 R11       R(s)      R(s+L-1) R(s+L)
//! CLOCK ~~~~|____|~~|__|~~|__|~ .. ~|__|~~|__|~~~|___|~~~|___|~ .. ~|__|~ .. ~|__|~~~~~~~~|__|~~~~~~~~~~~~~~~~~~~~~~~
//! DATA  idle| released      | command bits | released|  LOW            | S  ..   | CRC0     | HIGH for tm | LOW = idle
//! ```
//!
//! It is strict: what the receiver does wrong is noted as a [`Violation`]. It shares no code with the core.

mod config;
mod log;
mod protocol;
#[cfg(test)]
mod tests;

pub use config::{Defect, EncoderConfig, PositionSource};
pub use log::{FrameEnd, FrameLog, Violation};

use crate::{rng::Rng, Time};
use std::collections::VecDeque;

/// What a driver does to DATA.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// Nothing: the driver is off.
    Released,
    /// Drives LOW.
    Low,
    /// Drives HIGH.
    High,
}

impl Drive {
    /// Driving this level.
    pub fn level(high: bool) -> Self {
        if high {
            Self::High
        } else {
            Self::Low
        }
    }

    fn inverted(self) -> Self {
        match self {
            Self::High => Self::Low,
            Self::Low | Self::Released => Self::High,
        }
    }
}

/// What the encoder means by its output. It travels along the line with the level, so that a test can tell which bit
/// the receiver sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// LOW: ready for a frame.
    Idle,
    /// Released from the first falling edge until after the mode command.
    Listening,
    /// LOW between the mode command and the start bit.
    Lead,
    /// A bit of the answer, 0 = start bit.
    Bit(u8),
    /// HIGH for the recovery time.
    Tail,
    /// Not there: unplugged, or without supply.
    Absent,
}

impl std::fmt::Display for Symbol {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Idle => f.write_str("idle"),
            Self::Listening => f.write_str("listening"),
            Self::Lead => f.write_str("lead"),
            Self::Bit(i) => write!(f, "bit {i}"),
            Self::Tail => f.write_str("tail"),
            Self::Absent => f.write_str("absent"),
        }
    }
}

/// Drive and meaning together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// What the driver does.
    pub drive: Drive,
    /// What it means.
    pub symbol: Symbol,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum State {
    /// Waits for the first falling edge.
    Idle,
    /// From there to the edge after the last answer bit.
    Frame,
    /// DATA HIGH for tm.
    Recovery,
    /// Lost in the protocol: waits until the clock has been HIGH for long.
    Deaf,
    /// Without supply or plug.
    Off,
}

/// Working data of the frame in progress.
#[derive(Default)]
struct Work {
    /// Falling edges as counted, and as they came.
    falls: u32,
    true_falls: u32,
    command: u8,
    request: Option<protocol::Request>,
    nominal: Time,
    last_high: Time,
    missed: bool,
    next_bit: Option<u32>,
    tcal: Time,
    tm: Time,
    defects: Vec<Defect>,
}

/// The first entry of a queue if its time has come.
fn take_due<T>(queue: &mut VecDeque<(Time, T)>, time: Time) -> Option<(Time, T)> {
    if queue.front()?.0 > time {
        return None;
    }
    queue.pop_front()
}

/// An encoder. See the module's text.
pub struct Encoder {
    config: EncoderConfig,
    rng: Rng,
    state: State,
    work: Work,
    clock: bool,
    last_edge: Time,
    ready_at: Time,
    output: Output,
    glitching: bool,
    pending: VecDeque<(Time, Output)>,
    glitch_ends: VecDeque<(Time, bool)>,
    /// Supply or plug going off and on, in order of time.
    supply: VecDeque<(Time, bool)>,
    /// End of the recovery time.
    recovery_end: Option<Time>,
    /// When the clock will have kept its level for too long.
    watchdog: Option<Time>,
    frames: Vec<FrameLog>,
    violations: Vec<(Time, Violation)>,
}

impl Encoder {
    /// An encoder, ready at time 0 with CLOCK HIGH.
    pub fn new(config: EncoderConfig) -> Self {
        let supply = config
            .unplugged
            .iter()
            .flat_map(|r| [(r.start, false), (r.end, true)]);
        Self {
            rng: Rng::new(config.seed),
            state: State::Idle,
            work: Work::default(),
            clock: true,
            last_edge: 0,
            ready_at: 0,
            output: Output {
                drive: Drive::Low,
                symbol: Symbol::Idle,
            },
            glitching: false,
            pending: VecDeque::new(),
            glitch_ends: VecDeque::new(),
            supply: supply.collect(),
            recovery_end: None,
            watchdog: None,
            frames: Vec::new(),
            violations: Vec::new(),
            config,
        }
    }

    /// Its type plate.
    pub fn config(&self) -> &EncoderConfig {
        &self.config
    }

    /// The frames so far.
    pub fn frames(&self) -> &[FrameLog] {
        &self.frames
    }

    /// What the receiver did wrong so far, in order of time.
    pub fn violations(&self) -> &[(Time, Violation)] {
        &self.violations
    }

    /// What it does to DATA at present.
    pub fn output(&self) -> Output {
        let mut output = self.output;
        if self.glitching {
            output.drive = output.drive.inverted();
        }
        output
    }

    /// Ready for a frame: DATA has been LOW for tR.
    pub fn is_ready(&self, time: Time) -> bool {
        self.state == State::Idle && time >= self.ready_at
    }

    /// When it acts next without being asked.
    pub fn next_event(&self) -> Option<Time> {
        [
            self.pending.front().map(|p| p.0),
            self.glitch_ends.front().map(|g| g.0),
            self.supply.front().map(|s| s.0),
            self.recovery_end,
            self.watchdog,
        ]
        .into_iter()
        .flatten()
        .min()
    }

    /// Acts as it wants to at `time`, which must be [`Encoder::next_event`].
    pub fn advance(&mut self, time: Time) {
        if let Some((_, on)) = take_due(&mut self.supply, time) {
            self.switch(time, on);
        }
        if self.recovery_end.is_some_and(|t| t <= time) {
            self.end_recovery(time);
        }
        if self.watchdog.is_some_and(|t| t <= time) {
            self.watchdog = None;
            self.clock_stopped(time);
        }
        while let Some((_, on)) = take_due(&mut self.glitch_ends, time) {
            self.glitching = on;
        }
        while let Some((_, output)) = take_due(&mut self.pending, time) {
            self.output = output;
        }
    }

    /// The clock at the encoder's pin changes to `level`, while the receiver does `data` to DATA there.
    pub fn clock_edge(&mut self, time: Time, level: bool, data: Drive) {
        if level == self.clock {
            return;
        }
        let width = time - self.last_edge;
        self.last_edge = time;
        self.clock = level;
        if self.state == State::Off {
            return;
        }
        if level {
            self.rise(time, width, data);
        } else {
            self.fall(time, width);
        }
        self.watchdog = match self.state {
            State::Frame | State::Deaf if level => Some(time + self.config.max_clock_high),
            State::Frame => Some(time + self.config.max_clock_low),
            _ => None,
        };
    }

    fn clock_stopped(&mut self, time: Time) {
        let back_to_idle = |this: &mut Self| {
            this.state = State::Idle;
            this.ready_at = time + this.config.ready_low;
            this.emit(time, Drive::Low, Symbol::Idle);
        };
        match self.state {
            State::Frame => {
                let log = self.log();
                log.end = FrameEnd::Stopped;
                let seen = log.rising_edges;
                let violation = match log.expected_rising_edges() {
                    _ if !self.clock => Violation::ClockLowTooLong,
                    Some(expected) => Violation::TooFewPulses { seen, expected },
                    None => Violation::StoppedBeforeAnswer { seen },
                };
                self.violate(time, violation);
                back_to_idle(self);
                if !self.clock {
                    self.state = State::Deaf;
                }
            }
            State::Deaf => back_to_idle(self),
            _ => {}
        }
    }

    fn switch(&mut self, time: Time, on: bool) {
        self.pending.clear();
        self.recovery_end = None;
        self.watchdog = None;
        if let Some(f) = self.frames.last_mut() {
            if f.end == FrameEnd::Running {
                f.end = FrameEnd::Lost;
            }
        }
        self.work.defects.clear();
        if on {
            self.state = if self.clock { State::Idle } else { State::Deaf };
            self.ready_at = time + self.config.ready_low;
            self.output = Output {
                drive: Drive::Low,
                symbol: Symbol::Idle,
            };
        } else {
            self.state = State::Off;
            self.output = Output {
                drive: Drive::Released,
                symbol: Symbol::Absent,
            };
        }
    }

    /// Changes the output at `time`, as far as the frame's defects let it.
    fn emit(&mut self, time: Time, drive: Drive, symbol: Symbol) {
        let number = match symbol {
            Symbol::Bit(i) => Some(u32::from(i)),
            Symbol::Tail => Some(u32::MAX),
            _ => None,
        };
        let drive = self.work.defects.iter().fold(drive, |drive, d| match d {
            Defect::StuckFrom { bit, level } if number.is_some_and(|n| n >= *bit) => {
                Drive::level(*level)
            }
            Defect::OpenFrom(bit) if number.is_some_and(|n| n >= *bit) => Drive::Released,
            Defect::Open if symbol != Symbol::Idle => Drive::Released,
            _ => drive,
        });
        // A slow release must not come after the next thing the encoder wants to do.
        while self.pending.back().is_some_and(|p| p.0 >= time) {
            self.pending.pop_back();
        }
        self.pending.push_back((time, Output { drive, symbol }));
    }

    fn has(&self, which: impl Fn(&Defect) -> bool) -> bool {
        self.work.defects.iter().any(which)
    }

    fn sum_defects(&self, value: impl Fn(&Defect) -> u128) -> u128 {
        self.work.defects.iter().fold(0, |sum, d| sum ^ value(d))
    }

    fn log(&mut self) -> &mut FrameLog {
        self.frames.last_mut().expect("a frame is running")
    }

    fn violate(&mut self, time: Time, violation: Violation) {
        self.violations.push((time, violation));
    }
}
