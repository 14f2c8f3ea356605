//! Axes of a map, and the conditions of a cell.

use crate::{
    campaign::Case,
    line::{GlitchRate, Jitter, Wire},
    Time, MS, NS,
};
use endat_hdl::endat::{channel::DELAY_OFFSET_CYCLES, line_delay::mode, timing};
use endat_hdl::{config::PERIOD_BITS, protocol::ModeCommand};

/// A property of line, encoder or channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Length of the cable.
    Cable,
    /// EnDat clock.
    Clock,
    /// Delay of the encoder from clock edge to DATA edge.
    Delay,
    /// Peak jitter of every DATA edge at the receiver.
    Jitter,
    /// Delay of falling DATA edges against rising ones.
    Distortion,
    /// Glitches on DATA at the receiver, of up to `GLITCH_MAX`.
    Noise,
    /// Input filter.
    Filter,
    /// Distance of the sample from the middle of the bit (phase from a register).
    Offset,
}

/// Longest glitch of the noise.
const GLITCH_MAX: Time = 40 * NS;
/// Longest cable: the delay must stay below the period of the clock that measures it, 10 us.
const CABLE_MAX_M: f64 = 800.0;
/// Longest input filter.
const FILTER_MAX: f64 = 15.0;

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 8] = [
        Self::Cable,
        Self::Clock,
        Self::Delay,
        Self::Jitter,
        Self::Distortion,
        Self::Noise,
        Self::Filter,
        Self::Offset,
    ];

    /// Name on the command line and in tables, with the unit.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cable => "cable_m",
            Self::Clock => "clock_mhz",
            Self::Delay => "delay_ns",
            Self::Jitter => "jitter_ns",
            Self::Distortion => "distortion_ns",
            Self::Noise => "noise_khz",
            Self::Filter => "filter_cycles",
            Self::Offset => "offset_percent",
        }
    }

    /// Title of an axis.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Cable => "cable in m",
            Self::Clock => "EnDat clock in MHz",
            Self::Delay => "clock edge to DATA edge in the encoder, in ns",
            Self::Jitter => "peak jitter of DATA edges, in ns",
            Self::Distortion => "falling edges later than rising ones, in ns",
            Self::Noise => "glitches of 2 to 40 ns on DATA, in thousands per second",
            Self::Filter => "input filter in system clock cycles",
            Self::Offset => {
                "sample before (-) or after (+) the middle of the bit, in percent of the bit"
            }
        }
    }

    /// The smallest and the largest value.
    pub fn range(self, system_hz: u64, receiver: ReceiverKind) -> (f64, f64) {
        let clock_mhz = |cycles: u64| system_hz as f64 / cycles as f64 / 1e6;
        let shortest = match receiver.double_edge {
            true => timing::PERIOD_CYCLES_MIN_DOUBLE,
            false => timing::PERIOD_CYCLES_MIN,
        };
        let fastest = clock_mhz(shortest).min(timing::ENDAT_HZ_MAX as f64 / 1e6);
        match self {
            Self::Cable => (0.0, CABLE_MAX_M),
            Self::Clock => (clock_mhz((1 << PERIOD_BITS) - 1), fastest),
            Self::Delay => (0.0, 2_000.0),
            Self::Jitter => (0.0, 1_000.0),
            Self::Distortion => (-1_000.0, 1_000.0),
            Self::Noise => (0.0, 10_000.0),
            Self::Filter => (0.0, FILTER_MAX),
            Self::Offset => (-100.0, 100.0),
        }
    }
}

/// Source of a receiver's sampling phase.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// One cycle for each frame towards its start bit: a channel without alignment.
    Step,
    /// The mean of many edges.
    #[default]
    Tracked,
    /// The start bit of each frame.
    Frame,
    /// A register, set to the nominal delay of the line.
    Fixed,
}

/// Kind of receiver.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReceiverKind {
    /// Source of its phase.
    pub phase: Phase,
    /// Samples DATA on both edges of its clock.
    pub double_edge: bool,
    /// Majority of three samples.
    pub majority: bool,
}

/// Conditions of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// System clock in hertz.
    pub system_hz: u64,
    /// Mode command.
    pub command: ModeCommand,
    /// Width of the position.
    pub position_bits: u32,
    /// The receiver.
    pub receiver: ReceiverKind,
    values: [f64; Quantity::ALL.len()],
}

impl Conditions {
    /// A good line: 8 MHz, or the fastest supported clock, over 10 m.
    pub fn new(system_hz: u64, command: ModeCommand, position_bits: u32) -> Self {
        let (_, fastest) = Quantity::Clock.range(system_hz, ReceiverKind::default());
        let mut conditions = Self {
            system_hz,
            command,
            position_bits,
            receiver: ReceiverKind::default(),
            values: [0.0; Quantity::ALL.len()],
        };
        conditions.set(Quantity::Cable, 10.0);
        conditions.set(Quantity::Clock, fastest.min(8.0));
        conditions.set(Quantity::Delay, 50.0);
        conditions
    }

    /// Sets one quantity.
    pub fn set(&mut self, quantity: Quantity, value: f64) {
        self.values[quantity as usize] = value;
    }

    /// Value of one quantity.
    pub fn get(&self, quantity: Quantity) -> f64 {
        self.values[quantity as usize]
    }

    /// The delay of a line for mode `fixed`: the mean place of edges, in sixteenths of a cycle.
    fn fixed_delay(&self, delay: Time) -> u64 {
        let places = if self.receiver.double_edge { 2 } else { 1 };
        let majority = u64::from(self.receiver.majority) * 16 / places;
        let filter = 16 * self.get(Quantity::Filter).round() as u64;
        let seen = (delay as f64 * self.system_hz as f64 * 16.0 / 1e12).round() as u64;
        16 * DELAY_OFFSET_CYCLES + seen + filter + majority + 8 / places
    }

    /// A channel, an encoder and a line under these conditions.
    pub fn case(&self, frames: usize, seed: u64) -> Case {
        let time = |quantity| (self.get(quantity) * NS as f64).round();
        let clock_hz = (self.get(Quantity::Clock) * 1e6).round() as u64;
        let rates = (self.system_hz, clock_hz);
        let cable_m = self.get(Quantity::Cable);
        let mut case = Case::new(rates, self.command, self.position_bits, cable_m);
        case.features.alignment = self.receiver.phase != Phase::Step;
        case.features.double_edge = self.receiver.double_edge;
        case.settings.majority = self.receiver.majority;
        case.settings.phase_mode = match self.receiver.phase {
            Phase::Step | Phase::Tracked => mode::TRACKED,
            Phase::Frame => mode::FRAME,
            Phase::Fixed => mode::FIXED,
        };
        case.frames = case.calibration_frames() + frames;
        case.settings.start_window_cycles = (case.settings.period_cycles / 2).clamp(1, 63);
        case.settings.filter_cycles = self.get(Quantity::Filter).round() as u64;
        case.encoder.clock_to_data = time(Quantity::Delay) as Time;
        case.encoder.seed = seed;
        case.line.seed = seed;
        case.line.data_in.jitter = Jitter::Uniform(time(Quantity::Jitter) as Time);
        case.line.data_in.fall_later = time(Quantity::Distortion) as i64;
        let delay = case.line.round_trip() + case.encoder.clock_to_data;
        let offset = self.get(Quantity::Offset) / 100.0 * 16.0 * case.settings.period_cycles as f64;
        case.settings.fixed_delay = self
            .fixed_delay(delay)
            .saturating_add_signed(offset.round() as i64);
        let noise = self.get(Quantity::Noise);
        if noise > 0.0 {
            case.line.random_glitches = Some(GlitchRate {
                wire: Wire::Data,
                mean_gap: (MS as f64 / noise).round() as Time,
                shortest: 2 * NS,
                longest: GLITCH_MAX,
            });
        }
        case
    }
}

/// An axis of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity.
    pub quantity: Quantity,
    /// Values, in order.
    pub values: Vec<f64>,
}

impl Axis {
    /// Position of a value, in steps from the first one: interpolated between two values, and half a step outside if it
    /// is beyond all of them.
    pub fn place(&self, value: f64) -> f64 {
        let steps = self.values.windows(2).enumerate();
        for (index, pair) in steps {
            let part = (value - pair[0]) / (pair[1] - pair[0]);
            if (0.0..=1.0).contains(&part) {
                return index as f64 + part;
            }
        }
        let (first, last) = (self.values[0], self.values[self.values.len() - 1]);
        match (value - first).abs() < (value - last).abs() {
            true => -0.5,
            false => self.values.len() as f64 - 0.5,
        }
    }
}
