//! Ports in lanes: all equal up to one frame, in which each has another fault, and the frames after it.
//!
//! Each lane triggers when it is idle and its time has come, so no case depends on other lanes. The result is read just before the
//! next trigger, as by a slow host.

mod judge;
mod run;

pub use judge::{is_count, Class, Mark, TRIGGERS_MAX};
pub(super) use judge::{Outcome, Reading};

use crate::{
    bench::{ChannelSettings, LaneBench, Link, PinNames},
    campaign::{CampaignError, ABORT_US},
    encoder::{Defect, EncoderConfig, LatchEdge},
    line::{FaultKind, Jitter, LineConfig},
    Time, NS, US,
};
use endat_hdl::endat::channel::{Channel, Features, FixedTimes};
use endat_hdl::protocol::ModeCommand;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::{Keep, LaneWords, Lanes, PortId};
use rust_hdl::prelude::Block;
use std::sync::{Mutex, PoisonError};

/// System clock: eight cycles to a bit.
const SYSTEM_HZ: u64 = 32_000_000;
const ENDAT_HZ: u64 = 4_000_000;
const BIT: Time = 250 * NS;
/// Time before the frame, for faults that exist when it begins.
const LEAD: Time = 2 * US;
const LANES: usize = 128;
/// Longest answer to a command with a parameter.
const PARAMETER_TIMEOUT_US: u64 = 200;
/// Longest time of a port for a frame, its time-outs and its quiet time.
const SLOW_US: u64 = 4_000;
/// Longest time of a timer upset past its limit, and of the following actions: 2^16 microseconds.
const HANG_US: u64 = 72_000;
/// The line and the encoder of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Recovery time of the encoder; `None` = a short one that is legal for the command.
    pub tm: Option<Time>,
    /// Cable in metres.
    pub cable_m: f64,
    /// Width of the position.
    pub position_bits: u32,
}

impl Default for Conditions {
    fn default() -> Self {
        Self {
            tm: None,
            cable_m: 20.0,
            position_bits: 25,
        }
    }
}

/// A fault in a frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Mishap {
    /// A flip-flop is inverted.
    Flip {
        /// Index of its register's output.
        register: usize,
        /// Bit of the register.
        bit: usize,
        /// System clock cycles after the trigger.
        cycle: u64,
    },
    /// A fault of the line during a time span; times count from [`LEAD_PS`] before the trigger.
    Fault {
        /// Kind of fault.
        kind: FaultKind,
        /// Start.
        from: Time,
        /// End.
        until: Time,
        /// Seed of its random values.
        seed: u64,
    },
    /// The encoder's answer is wrong.
    Answer(Defect, u64),
    /// Edges vary in this frame.
    Jitter(Jitter, u64),
    /// A configuration input of the port has another value from a cycle on, to the end of the frame.
    Setting {
        /// Input.
        name: &'static str,
        /// Value.
        value: u128,
        /// System clock cycles after the trigger.
        cycle: u64,
    },
}

/// Time from the origin of line fault times to the trigger.
pub const LEAD_PS: Time = LEAD;

/// Number of positions of a continuous run in which a flip may occur.
const RUN_FRAMES: u64 = 3;

/// A port whose flip-flops are inverted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Port {
    /// Triggered positions only.
    Position,
    /// All features: requests, diagnosis, continuous clock, alignment.
    AllParts,
    /// Alignment and double edge.
    DoubleEdge,
    /// All features, and a second receiver.
    SecondReceiver,
    /// Triggered positions only, without guards against upsets.
    Unguarded,
}

/// The frame with the fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    /// At the calibration clock.
    Calibration,
    /// 111000.
    Position,
    /// 000111.
    Position21,
    /// 111000 with additional data 1 and 2.
    AdditionalData,
    /// 001001: additional data 1 and 2 and a supplement.
    Supplement,
    /// 001110, in a separate frame.
    Request,
    /// A run with 000111.
    Continuous,
}

impl FrameKind {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Calibration => "calibration",
            Self::Position => "position",
            Self::Position21 => "position_21",
            Self::AdditionalData => "additional_data",
            Self::Supplement => "supplement",
            Self::Request => "request",
            Self::Continuous => "continuous",
        }
    }

    /// Label for the random numbers of its cases. It does not change with the name, so that counted results belong to the same cases.
    pub(super) fn drawn_by(self) -> &'static str {
        match self {
            Self::AdditionalData => "informations",
            _ => self.name(),
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
    /// Ports of the committed campaigns.
    pub const ALL: [Self; 3] = [Self::Position, Self::AllParts, Self::DoubleEdge];

    /// Ports that can be selected by name: these, one with a second receiver, and one without guards.
    pub fn named() -> impl Iterator<Item = Self> {
        let others = [Self::SecondReceiver, Self::Unguarded];
        Self::ALL.into_iter().chain(others)
    }

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "port",
            Self::AllParts => "port_all",
            Self::DoubleEdge => "port_double_edge",
            Self::SecondReceiver => "port_second_receiver",
            Self::Unguarded => "port_unguarded",
        }
    }

    /// The frames that it supports.
    pub fn kinds(self) -> &'static [FrameKind] {
        use FrameKind::*;
        match self {
            Self::Position | Self::DoubleEdge | Self::Unguarded => {
                &[Calibration, Position, Position21]
            }
            Self::AllParts | Self::SecondReceiver => &[
                Calibration,
                Position,
                Position21,
                AdditionalData,
                Supplement,
                Request,
                Continuous,
            ],
        }
    }

    fn features(self) -> Features {
        match self {
            Self::Position => Features::GUARDED,
            Self::AllParts => Features {
                requests: true,
                diagnosis: true,
                continuous: true,
                alignment: true,
                ..Features::GUARDED
            },
            Self::SecondReceiver => Features {
                second_receiver: true,
                ..Self::AllParts.features()
            },
            Self::Unguarded => Features::CARD,
            Self::DoubleEdge => Features {
                alignment: true,
                double_edge: true,
                ..Features::GUARDED
            },
        }
    }

    /// Its design.
    ///
    /// # Errors
    /// If it cannot be elaborated: a bug in this program.
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

    /// The port in native code, after reset. Each process compiles each port once.
    pub(in crate::campaign) fn engine(self) -> Result<Lanes, CampaignError> {
        static ENGINES: Mutex<Vec<(Port, Lanes)>> = Mutex::new(Vec::new());
        let lock = || ENGINES.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, engine)) = lock().iter().find(|(port, _)| *port == self) {
            return Ok(engine.clone());
        }
        let engine = Lanes::new(&self.design()?, Keep::Registers, LaneWords::Two)?;
        lock().push((self, engine.clone()));
        Ok(engine)
    }
}

fn cycles(us: u64) -> u64 {
    us * (SYSTEM_HZ / 1_000_000)
}

/// Outputs for the reader.
#[derive(Clone)]
struct Outputs {
    position: PortId,
    valid: PortId,
    fresh: PortId,
    cause: PortId,
    stamp: PortId,
    /// With requests: additional data 1 and 2 with their validity; answer, its validity, and the outcome of its frame.
    infos: [PortId; 3],
    reply: [PortId; 3],
}

/// Lanes that are about to begin the frame.
pub(in crate::campaign) struct Ready {
    pub port: Port,
    pub kind: FrameKind,
    settings: ChannelSettings,
    /// Cycles from a trigger to the next.
    pub span_cycles: u64,
    bench: LaneBench,
    outputs: Outputs,
    /// Cycles from the trigger to the time stamp.
    stamp_after: u64,
}

impl Ready {
    pub fn new(port: Port, kind: FrameKind, conditions: Conditions, engine: Lanes) -> Self {
        let position_bits = conditions.position_bits;
        let mut encoder = EncoderConfig::endat22(position_bits).continuous(LatchEdge::AfterLow);
        let usual = match kind.command().has_f2() {
            true => 1_500 * NS,
            false => 10 * US,
        };
        let tm = conditions.tm.unwrap_or(usual);
        encoder.tm = tm..=tm;
        encoder.tac = 0..=0;
        encoder.write_time = 0..=0;
        encoder.reset_time = 0;
        let line = LineConfig::cable(conditions.cable_m);
        let links = (0..LANES).map(|_| Link::new(line.clone(), encoder.clone()));
        let find = |name: &str| engine.port(name);
        let outputs = Outputs {
            position: find("position"),
            valid: find("position_valid"),
            fresh: find("fresh"),
            cause: find("cause"),
            stamp: find("first_fall_timestamp"),
            infos: ["info_1", "info_2", "info_good"].map(find),
            reply: ["reply", "reply_good", "over_cause"].map(find),
        };
        let pins = (PinNames::channel(), links.collect());
        let mut bench = LaneBench::new(engine, SYSTEM_HZ, vec![pins]);
        if port.features().double_edge {
            bench.set_double_edge();
        }
        let settings = ChannelSettings {
            abort_us: ABORT_US,
            ..ChannelSettings::new(SYSTEM_HZ, ENDAT_HZ, kind.command(), position_bits)
        };
        (0..LANES).for_each(|lane| bench.configure(lane, &settings));
        bench.set_all("reset", 1);
        (0..8).for_each(|_| bench.tick());
        bench.set_all("reset", 0);
        (0..cycles(ABORT_US + 10)).for_each(|_| bench.tick());
        let mut ready = Self {
            port,
            kind,
            settings,
            span_cycles: 0,
            bench,
            outputs,
            stamp_after: 0,
        };
        ready.prepare();
        ready
    }

    /// Everything up to the frame: measures the delay, selects additional data, starts the run.
    fn prepare(&mut self) {
        let bench = &mut self.bench;
        // With alignment several frames measure.
        (0..6).for_each(|_| {
            trigger_all(bench);
            settle(bench);
        });
        let selects = matches!(self.kind, FrameKind::AdditionalData | FrameKind::Supplement);
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
}

/// Begins the frame with the fault in all lanes.
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

/// Sends a request in all lanes.
fn put(bench: &mut LaneBench, command: ModeCommand, address: u8, strobe: &str) {
    bench.set_all("request_command", command.code().into());
    bench.set_all("request_parameter", u128::from(address) << 16);
    bench.set_all(strobe, 1);
    bench.tick();
    bench.set_all(strobe, 0);
    (0..4).for_each(|_| bench.tick());
}

/// Runs until no lane is busy.
fn settle(bench: &mut LaneBench) {
    (0..4).for_each(|_| bench.tick());
    let end = bench.cycle() + cycles(SLOW_US);
    while bench.busy(0) | bench.busy(1) != 0 {
        assert!(bench.cycle() < end, "a port without upset stays busy");
        bench.tick();
    }
}
