//! A simple behavioural EnDat receiver with the ports of the block `Channel`, for tests of the bench without the core.
//!
//! It is independent of the core and uses lists instead of counters. In addition to the block's ports it
//! has inputs `address` and `parameter` for the commands that send them, `infos` (bit 0: additional data 1 is expected, bit 1: 2),
//! and outputs `reply`, `info_1`, `info_2` (24 covered bits each) and `info_errors` (CRC errors, bits as in `infos`).

mod command;
mod decode;
mod supplement;

use crate::bench::ChannelSettings;
use rtl_design::engine::{Engine, Port, PortId};

/// Faults of the receiver that the bench must detect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bug {
    #[default]
    None,
    /// Sends additional clock pulses.
    ExtraPulses(i64),
    /// Keeps its driver on for one more falling edge (or more).
    LateRelease(u32),
    /// Ignores the recovery time.
    NoRecovery,
    /// Samples this many cycles too late.
    LateSample(u64),
    /// Sends another command.
    Command(u8),
}

const INPUTS: [(&str, usize); 8] = [
    ("address", 8),
    ("parameter", 16),
    ("infos", 2),
    ("reset", 1),
    ("tick_us", 1),
    ("timestamp", 32),
    ("trigger", 1),
    ("data_i", 1),
];
const OUTPUTS: [(&str, usize); 22] = [
    ("reply", 24),
    ("info_1", 24),
    ("info_2", 24),
    ("info_errors", 2),
    ("endat_clk", 1),
    ("data_o", 1),
    ("data_oe", 1),
    ("busy", 1),
    ("result_strobe", 1),
    ("sample_strobe", 1),
    ("position", 48),
    ("position_valid", 1),
    ("fresh", 1),
    ("sequence", 16),
    ("first_fall_timestamp", 32),
    ("age_us", 16),
    ("cause", 4),
    ("flags", 12),
    ("crc_received", 5),
    ("crc_computed", 5),
    ("recovery_cycles", 16),
    ("delay_cycles", 11),
];
const CALIBRATION_HZ: u64 = 200_000;
/// Cycles from the pin to the sampled register.
pub const LATENCY: u64 = 2;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Phase {
    Idle,
    Run,
    /// CLOCK is LOW until then, before a supplement.
    Park {
        until: u64,
    },
    Supplement,
    Recover {
        since: u64,
    },
    Abort {
        until: u64,
    },
    Settle {
        low_since: u64,
    },
}

pub struct TestReceiver {
    ports: Vec<Port>,
    values: Vec<u128>,
    system_hz: u64,
    bug: Bug,
    phase: Phase,
    cycle: u64,
    sync: [bool; 3],
    /// Cycle of the next clock edge.
    next_edge: u64,
    falls: u32,
    supplement_edges: u32,
    rises: Vec<u64>,
    period: u64,
    start: Option<u64>,
    start_edge: usize,
    bits: Vec<bool>,
    delay: Option<u64>,
    calibrating: bool,
    position: u128,
    overrun: bool,
    /// A frame that measures the delay brings no position; another one follows automatically.
    measures_apart: bool,
    once_more: bool,
}

impl TestReceiver {
    pub fn new(system_hz: u64) -> Self {
        let s = ChannelSettings::new(
            system_hz,
            1_000_000,
            endat_hdl::protocol::ModeCommand::SendPosition,
            1,
        );
        let settings = s.ports().map(|(name, _)| (name, 16));
        let inputs = INPUTS.into_iter().chain(settings).map(|p| (p, true));
        let ports: Vec<Port> = inputs
            .chain(OUTPUTS.map(|p| (p, false)))
            .map(|((name, width_bits), is_input)| Port {
                name: name.into(),
                width_bits,
                is_input,
            })
            .collect();
        let mut this = Self {
            values: vec![0; ports.len()],
            ports,
            system_hz,
            bug: Bug::None,
            phase: Phase::Idle,
            cycle: 0,
            sync: [false; 3],
            next_edge: 0,
            falls: 0,
            supplement_edges: 0,
            rises: Vec::new(),
            period: 0,
            start: None,
            start_edge: 0,
            bits: Vec::new(),
            delay: None,
            calibrating: true,
            position: 0,
            overrun: false,
            measures_apart: false,
            once_more: false,
        };
        this.put("endat_clk", 1);
        this
    }

    pub fn with_bug(system_hz: u64, bug: Bug) -> Self {
        Self {
            bug,
            ..Self::new(system_hz)
        }
    }

    /// As in the core: a frame that measures the delay brings no position.
    pub fn measuring_apart(mut self) -> Self {
        self.measures_apart = true;
        self
    }

    fn at(&self, name: &str) -> u64 {
        self.values[self.port(name).0] as u64
    }

    fn put(&mut self, name: &str, value: u128) {
        let id = self.port(name).0;
        self.values[id] = value;
    }

    fn has_f2(&self) -> bool {
        command::has_f2(self.at("command"))
    }

    fn has_supplement(&self) -> bool {
        command::has_supplement(self.at("command"))
    }

    /// Bits of the answer before additional data.
    fn head_bits(&self) -> usize {
        let position_bits = self.at("position_bits") as usize;
        6 + command::payload_bits(self.at("command"), position_bits)
    }

    fn answer_bits(&self) -> usize {
        let infos = match self.has_f2() {
            true => self.at("infos").count_ones() as usize,
            false => 0,
        };
        self.head_bits() + 30 * infos
    }

    /// Converts an edge of a frame without parameter to this frame.
    fn later(&self, edge: u32) -> u32 {
        match command::has_parameter(self.at("command")) {
            true => edge + 24,
            false => edge,
        }
    }

    fn begin(&mut self) {
        if self.sync[1] && self.bug != Bug::NoRecovery {
            self.abort();
            return self.finish(1);
        }
        self.calibrating = self.delay.is_none();
        self.period = match self.delay {
            None => self.system_hz / CALIBRATION_HZ,
            Some(_) => self.at("period_cycles"),
        };
        let extra = match self.delay {
            None => 0,
            Some(_) => self.at("first_low_extra_cycles"),
        };
        self.put("endat_clk", 0);
        self.put("busy", 1);
        self.put("first_fall_timestamp", u128::from(self.at("timestamp")));
        self.next_edge = self.cycle + self.period / 2 + extra;
        self.falls = 1;
        self.rises.clear();
        self.bits.clear();
        self.start = None;
        self.phase = Phase::Run;
    }

    fn clock_edge(&mut self) {
        if self.at("endat_clk") == 0 {
            if !self.may_rise() {
                return;
            }
            self.put("endat_clk", 1);
            self.rises.push(self.cycle);
            self.next_edge = self.cycle + self.period - self.period / 2;
            return;
        }
        if self.start.is_some() && self.rises.len() as i64 >= self.last_rise() {
            if self.has_supplement() {
                self.put("endat_clk", 0);
                let until = self.cycle + supplement::PAUSE_US * self.system_hz / 1_000_000;
                self.phase = Phase::Park { until };
            }
            return;
        }
        self.put("endat_clk", 0);
        self.next_edge = self.cycle + self.period / 2;
        self.falls += 1;
        let command = match self.bug {
            Bug::Command(c) => u64::from(c),
            _ => self.at("command"),
        };
        let release = match self.bug {
            Bug::LateRelease(n) => self.later(9) + n,
            _ => self.later(9),
        };
        let fields = self.at("address") << 16 | self.at("parameter");
        match self.falls {
            2 => {
                self.put("data_oe", 1);
                self.put("data_o", 0);
            }
            3..=8 => self.put("data_o", u128::from(command >> (8 - self.falls) & 1)),
            n @ 9..=32 if n < release && self.later(0) > 0 => {
                self.put("data_o", u128::from(fields >> (32 - n) & 1));
            }
            n if n == release => self.put("data_oe", 0),
            _ => {}
        }
    }

    /// The number of the last rising edge of the frame.
    fn last_rise(&self) -> i64 {
        let extra = match self.bug {
            Bug::ExtraPulses(n) if !self.calibrating => n,
            _ => 0,
        };
        (self.start_edge + self.edges_from_start()) as i64 + extra
    }

    /// Edges from that of the start bit to the last one; a supplement replaces the edge that ends other frames.
    fn edges_from_start(&self) -> usize {
        self.answer_bits() - usize::from(self.has_supplement())
    }

    /// True if the encoder needs another edge even if it has begun its answer at the earliest possible time.
    fn may_rise(&self) -> bool {
        let (None, Some(delay)) = (self.start, self.delay) else {
            return true;
        };
        let excluded = |t: &u64| t + delay + self.period / 2 < self.cycle;
        let possible = self.rises.iter().take_while(|t| excluded(t)).count() + 1;
        // Hold the last edge of the frame back: after it the clock must stay HIGH.
        self.rises.len() + 1 < possible.max(self.later(11) as usize) + self.edges_from_start()
    }

    fn look_for_start(&mut self) {
        let before = self.later(10);
        let armed = self.falls > before
            && self
                .rises
                .get(before as usize - 1)
                .is_some_and(|t| self.cycle > t + self.delay.unwrap_or(self.period));
        if armed && self.sync[1] && !self.sync[2] {
            let c = self.cycle;
            self.start = Some(c);
            let delay = *self
                .delay
                .get_or_insert(c - self.rises.last().unwrap_or(&c));
            self.start_edge = 1
                + (0..self.rises.len())
                    .min_by_key(|i| (self.rises[*i] + delay).abs_diff(c))
                    .unwrap_or(0);
            self.put("delay_cycles", u128::from(delay - LATENCY));
        }
        let limit = self.at("start_timeout_us") * self.system_hz / 1_000_000;
        let earliest = self.rises.get(before as usize);
        let late = earliest.is_some_and(|t| self.cycle - t > limit);
        if self.start.is_none() && late {
            self.abort();
            self.finish(2);
        }
    }

    fn take_bit(&mut self) {
        let Some(start) = self.start else { return };
        let late = match self.bug {
            Bug::LateSample(n) => n,
            _ => 0,
        };
        // The clock may have paused, so each bit is timed from the edge that launched it.
        let first = self.start_edge - 1;
        let Some(edge) = self.rises.get(first + self.bits.len()) else {
            return;
        };
        let due = edge + (start - self.rises[first]) + self.period / 2 + late;
        if self.cycle == due && self.bits.len() < self.answer_bits() {
            self.bits.push(self.sync[1]);
            self.put("sample_strobe", 1);
        }
    }

    fn abort(&mut self) {
        self.put("endat_clk", 1);
        self.put("data_oe", 0);
        self.put("busy", 1);
        let quiet = self.at("abort_us") * self.system_hz / 1_000_000;
        self.delay = None;
        self.phase = Phase::Abort {
            until: self.cycle + quiet,
        };
    }

    fn finish(&mut self, cause: u128) {
        let overrun = std::mem::take(&mut self.overrun);
        let shown = if cause == 0 && overrun { 8 } else { cause };
        self.put("cause", shown);
        self.put("fresh", u128::from(cause == 0));
        if cause == 0 {
            self.put("position", self.position);
            self.put("position_valid", 1);
        }
        let sequence = self.at("sequence") + 1;
        self.put("sequence", u128::from(sequence & 0xFFFF));
        self.put("result_strobe", 1);
    }

    fn run(&mut self) {
        if self.cycle >= self.next_edge {
            self.clock_edge();
        }
        if self.start.is_none() {
            self.look_for_start();
        }
        self.take_bit();
        if self.has_supplement() {
            return;
        }
        let all_bits = self.bits.len() == self.answer_bits();
        let all_edges = self.rises.len() as i64 >= self.last_rise();
        if self.phase == Phase::Run && self.start.is_some() && all_bits && all_edges {
            let cause = self.decode();
            self.once_more = cause == 0
                && self.calibrating
                && self.measures_apart
                && self.bug != Bug::NoRecovery;
            if !self.once_more {
                self.finish(cause);
            }
            self.phase = Phase::Recover { since: self.cycle };
            if self.bug == Bug::NoRecovery {
                self.put("busy", 0);
                self.phase = Phase::Idle;
            }
        }
    }
}

impl Engine for TestReceiver {
    fn ports(&self) -> &[Port] {
        &self.ports
    }

    fn set(&mut self, port: PortId, value: u128) {
        self.values[port.0] = value;
    }

    fn get(&mut self, port: PortId) -> u128 {
        self.values[port.0]
    }

    fn fall(&mut self) {}

    fn tick(&mut self) {
        self.cycle += 1;
        self.put("result_strobe", 0);
        self.put("sample_strobe", 0);
        let data = self.sync[1];
        self.overrun |= self.at("trigger") == 1 && self.phase != Phase::Idle;
        match self.phase {
            Phase::Idle if self.at("trigger") == 1 => self.begin(),
            Phase::Run => self.run(),
            Phase::Park { until } => self.park(until),
            Phase::Supplement => self.supplement(),
            Phase::Recover { since } => {
                // The tail comes one signal delay after the last edge: LOW before that is an answer bit.
                let waited = self.cycle - since;
                let tail = waited > self.delay.unwrap_or(0) + self.period;
                if tail && !data {
                    self.put("recovery_cycles", u128::from(waited));
                    self.phase = Phase::Settle {
                        low_since: self.cycle,
                    };
                } else if waited > self.at("recovery_limit_cycles") {
                    self.abort();
                    match std::mem::take(&mut self.once_more) {
                        true => self.finish(7),
                        false => self.put("cause", 7), // cause of the published result
                    }
                }
            }
            Phase::Abort { until } if self.cycle >= until => {
                self.phase = Phase::Settle {
                    low_since: self.cycle,
                };
            }
            Phase::Settle { .. } if data && self.at("trigger") == 1 => {
                self.overrun = false;
                self.abort();
                self.finish(1);
            }
            Phase::Settle { .. } if data => {
                self.phase = Phase::Settle {
                    low_since: self.cycle,
                }
            }
            Phase::Settle { low_since } if self.cycle - low_since > self.at("ready_low_cycles") => {
                self.put("busy", 0);
                self.phase = Phase::Idle;
                if std::mem::take(&mut self.once_more) {
                    self.begin();
                }
            }
            _ => {}
        }
        self.sync = [self.at("data_i") == 1, self.sync[0], self.sync[1]];
    }
}
