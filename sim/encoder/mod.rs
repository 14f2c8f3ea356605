//! The encoder at the far end of the cable, written from the encoder's side of the interface description.
//!
//! It works in picoseconds and only at edges: [`Encoder::clock_edge`] receives the clock, [`Encoder::next_event`] returns the time of its
//! next action, [`Encoder::advance`] executes it, [`Encoder::output`] is its drive on DATA.
//!
//! ```text
//!          F1   R1 F2 R2 F3 R3      F8 R8 F9 R9 F10 R10 F11 R11       R(s)      R(s+L-1) R(s+L)
//! CLOCK ~~~~|____|~~|__|~~|__|~ .. ~|__|~~|__|~~~|___|~~~|___|~ .. ~|__|~ .. ~|__|~~~~~~~~|__|~~~~~~~~~~~~~~~~~~~~~~~
//! DATA  idle| released      | command bits | released|  LOW            | S  ..   | CRC0     | HIGH for tm | LOW = idle
//! ```
//!
//! An EnDat 2.1 command with a parameter has 24 more bits after the mode command, and everything after them is 24 edges later. After
//! the EnDat 2.2 commands with a supplement the clock is parked LOW after the last bit:
//!
//! ```text
//!       R(c) F(c+1)     R'1 F'1 R'2 F'2      F'8 R'9 F'9 R'10     F'32 R'33 F'33 R'34 F'34 R'35
//! CLOCK _|~~~|____________|~~|__|~~|__|~ .. ~|__|~~|__|~~|__|~ .. ~|__|~~~|___|~~~|___|~~~~~~~~~~~~~~~
//! DATA   CRC0 ..| released  | 0     ..   0   | 1   | 8 and 16 bits        | LOW | HIGH for tm    | LOW = idle
//! ```
//!
//! It is strict: every error of the receiver is noted as a [`Violation`]. It shares no code with the core.

mod answer;
mod clock_check;
mod command;
mod config;
mod content;
mod continuous;
mod defect;
mod device;
mod infos;
mod jobs;
mod listen;
mod log;
mod memory;
mod recovery;
mod status;
mod supplement;
#[cfg(test)]
mod tests;
mod violation;
mod words;

pub use command::Command;
pub use config::{EncoderConfig, LatchEdge, PositionSource};
pub use content::{Cause, InfoValues, TypePlate, LONG_RECOVERY, SHORT_RECOVERY};
pub use defect::Defect;
pub use device::{
    Device, DEVICES, ECI_1119, ECN_113, EQN_1337, LC_416, LIC_4117, RCN_8510, ROQ_437,
};
pub use log::{AnswerKind, FrameEnd, FrameLog, Supplement};
pub use memory::{area, status_word};
pub use status::ErrorSource;
pub use violation::Violation;

use crate::{rng::Rng, Journal, Time};
use infos::{Parts, Selection};
use memory::Memory;
use status::Status;
use std::collections::VecDeque;

/// Drive of a driver on DATA.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// The driver is off.
    Released,
    /// Drives LOW.
    Low,
    /// Drives HIGH.
    High,
}

impl Drive {
    /// Drives this level.
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

/// Meaning of the encoder's output. It travels along the line with the level, so that a test knows which bit
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
    /// No encoder: unplugged, or without supply.
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
    /// Drive.
    pub drive: Drive,
    /// Meaning.
    pub symbol: Symbol,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum State {
    /// Waits for the first falling edge.
    Idle,
    /// From there to the edge after the last bit of answer and supplement.
    Frame,
    /// Continuous clock mode: from the edge after an answer to the one that latches the next position.
    Gap,
    /// DATA HIGH for tm.
    Recovery,
    /// Out of step: waits until the clock has been HIGH for long.
    Deaf,
    /// Without supply or plug.
    Off,
}

/// Progress of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
enum Phase {
    /// Receives the command.
    #[default]
    Listen,
    /// LOW until the answer is ready.
    Wait,
    /// Sends the answer; this bit is next.
    Answer(u32),
    /// CLOCK LOW between answer and supplement.
    Park {
        /// Time when DATA is released.
        release: Time,
    },
    /// Receives the supplement.
    Supplement,
}

/// Working data of the frame in progress.
#[derive(Clone, Default)]
struct Work {
    /// Falling edges as counted, and as received.
    falls: u32,
    true_falls: u32,
    phase: Phase,
    /// Bits of command, parameter or supplement so far.
    shift: u64,
    command: Option<Command>,
    /// Earliest time of the answer.
    ready: Time,
    /// Rising edges and bits of the supplement so far.
    supplement: supplement::Progress,
    nominal: Time,
    last_high: Time,
    missed: bool,
    tcal: Time,
    tm: Time,
    tm_short: Time,
    defects: Vec<Defect>,
}

/// Removes and returns the first entry of a queue if it is due.
fn take_due<T>(queue: &mut VecDeque<(Time, T)>, time: Time) -> Option<(Time, T)> {
    if queue.front()?.0 > time {
        return None;
    }
    queue.pop_front()
}

/// Data acknowledged by additional data.
#[derive(Clone, Copy, Debug, Default)]
struct Registers {
    /// Selected area and block (0x47).
    mrs: (u8, u8),
    /// Last address and word (0x45, 0x46).
    memory: crate::frame::Parameter,
    /// Last test command (0x48).
    test: crate::frame::Parameter,
}

/// An encoder; see the module documentation.
#[derive(Clone)]
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
    /// Switching of supply or plug, in order of time.
    supply: VecDeque<(Time, bool)>,
    /// End of the recovery time.
    recovery_end: Option<Time>,
    /// Restart after a reset command: start and end.
    reset: Option<(Time, Time)>,
    memory: Memory,
    status: Status,
    selection: Selection,
    registers: Registers,
    parts: Parts,
    /// A memory request in progress, and its end.
    job: Option<(Time, jobs::Work)>,
    /// Time when the clock has kept its level for too long.
    watchdog: Option<Time>,
    frames: Journal<FrameLog>,
    violations: Journal<(Time, Violation)>,
}

impl Encoder {
    /// An encoder, ready at time 0 with CLOCK HIGH.
    pub fn new(config: EncoderConfig) -> Self {
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
            supply: config.supply().into(),
            recovery_end: None,
            reset: None,
            memory: Memory::new(&config),
            status: Status::default(),
            selection: Selection::default(),
            registers: Registers::default(),
            parts: Parts::default(),
            job: None,
            watchdog: None,
            frames: Journal::default(),
            violations: Journal::default(),
            config,
        }
    }

    /// Changes the seed of all random values, including positions.
    pub fn reseed(&mut self, seed: u64) {
        self.rng = Rng::new(seed);
    }

    /// Removes supply or plug for a while; only if it is on, and only in the future.
    pub fn unplug(&mut self, from: Time, until: Time) {
        let on = until + self.config.start_up;
        self.supply.extend([(from, false), (on, true)]);
        self.supply.make_contiguous().sort_by_key(|s| s.0);
    }

    /// Adds a defect to the next frame.
    pub fn spoil_next(&mut self, defect: Defect) {
        let frame = self.frames.count();
        self.config.defects.push((frame..=frame, defect));
    }

    /// Adds a defect to the next `frames` frames; it replaces one of the same kind.
    pub fn spoil(&mut self, frames: u64, defect: Defect) {
        let kind = std::mem::discriminant(&defect);
        let defects = &mut self.config.defects;
        defects.retain(|(_, other)| std::mem::discriminant(other) != kind);
        let first = self.frames.count();
        let last = first.saturating_add(frames.saturating_sub(1));
        self.config.defects.push((first..=last, defect));
    }

    /// Removes all faults from `time` on, and clears earlier reports.
    pub fn heal(&mut self, time: Time) {
        self.config.defects.clear();
        self.config.causes.clear();
        self.status.clear(time);
    }

    /// Unplugs it, or plugs it in, at `time`; cancels planned switching.
    pub fn switch_supply(&mut self, time: Time, on: bool) {
        let delay = if on { self.config.start_up } else { 0 };
        self.supply = VecDeque::from([(time + delay, on)]);
    }

    /// True if it has supply.
    pub fn is_on(&self) -> bool {
        self.state != State::Off
    }

    /// Configuration.
    pub fn config(&self) -> &EncoderConfig {
        &self.config
    }

    /// Keeps only the last `most` frames and violations: for an encoder that runs for days.
    pub fn keep(&mut self, most: usize) {
        self.frames.keep(most);
        self.violations.keep(most);
    }

    /// The frames so far.
    pub fn frames(&self) -> &[FrameLog] {
        &self.frames
    }

    /// Violations of the receiver so far, in order of time.
    pub fn violations(&self) -> &[(Time, Violation)] {
        &self.violations
    }

    /// Present drive on DATA.
    pub fn output(&self) -> Output {
        let mut output = self.output;
        if self.glitching {
            output.drive = output.drive.inverted();
        }
        output
    }

    /// True if ready for a frame: DATA has been LOW for tR, and no reset is under way.
    pub fn is_ready(&self, time: Time) -> bool {
        let in_reset = self.reset.is_some_and(|r| time < r.1);
        self.state == State::Idle && time >= self.ready_at && !in_reset
    }

    /// Adds a fault, from its time on.
    pub fn add_cause(&mut self, cause: Cause) {
        self.config.causes.push(cause);
    }

    /// A word of an existing area (block 0), independent of the selection, as of the last frame.
    pub fn word(&self, mrs: u8, address: u8) -> Option<u16> {
        self.memory.check_area(mrs, 0).ok()?;
        let place = self.memory.place_in(mrs, 0, address).ok()?;
        Some(self.memory.get(place, &self.status))
    }

    /// Time of its next action.
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

    /// Executes its action at `time`, which must be [`Encoder::next_event`].
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

    /// The clock at the encoder's pin changes to `level`, while the receiver drives DATA with `data`.
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
        self.watchdog = self.patience().map(|span| time + span);
    }

    /// Changes the output at `time`, subject to the frame's defects.
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
        // A delayed release must not come after the next output change.
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

    fn launch(&mut self, clock_edge: Time, drive: Drive, symbol: Symbol) {
        self.emit(clock_edge + self.config.clock_to_data, drive, symbol);
    }

    fn log(&mut self) -> &mut FrameLog {
        self.frames.last_mut().expect("a frame is running")
    }

    fn violate(&mut self, time: Time, violation: Violation) {
        self.violations.push((time, violation));
    }
}
