//! Effects of a cable and its transceivers on edges.

use crate::{rng::Rng, Time, NS};

/// Random variation of a delay, drawn for each edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Jitter {
    /// None.
    #[default]
    None,
    /// Uniform, up to this much earlier or later.
    Uniform(Time),
    /// Normal with this deviation, cut off at the peak.
    Normal {
        /// Standard deviation.
        rms: Time,
        /// Largest value.
        peak: Time,
    },
}

impl Jitter {
    pub(super) fn draw(self, rng: &mut Rng) -> i64 {
        match self {
            Self::None => 0,
            Self::Uniform(peak) => rng.around_zero(peak),
            Self::Normal { rms, peak } => rng.normal(rms, peak),
        }
    }
}

/// One direction of a pair: driver, cable, receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathConfig {
    /// Delay of both transceivers, without the cable.
    pub transceivers: Time,
    /// Additional delay of falling edges over rising ones (duty distortion); negative = earlier.
    pub fall_later: i64,
    /// Drift of the delay (temperature), in picoseconds per microsecond; negative = shrinks.
    pub drift: i64,
    /// From this time on the delay is longer by this amount; negative = shorter.
    pub step: Option<(Time, i64)>,
    /// Variation from edge to edge.
    pub jitter: Jitter,
    /// Shorter pulses are suppressed.
    pub shortest_pulse: Time,
}

impl Default for PathConfig {
    fn default() -> Self {
        Self {
            transceivers: 25 * NS,
            fall_later: 0,
            drift: 0,
            step: None,
            jitter: Jitter::None,
            shortest_pulse: 2 * NS,
        }
    }
}

/// A wire at its receiving end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wire {
    /// CLOCK, at the encoder.
    Clock,
    /// DATA, at the receiver.
    Data,
}

/// The level of a wire is inverted briefly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Glitch {
    /// Wire.
    pub wire: Wire,
    /// Start.
    pub at: Time,
    /// Duration.
    pub width: Time,
}

/// Glitches at random times (a Poisson process).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlitchRate {
    /// Wire.
    pub wire: Wire,
    /// Mean time from the end of one to the start of the next.
    pub mean_gap: Time,
    /// Shortest glitch.
    pub shortest: Time,
    /// Longest glitch.
    pub longest: Time,
}

/// DATA at the receiver's pin keeps a level, for any level on the cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stuck {
    /// Start.
    pub from: Time,
    /// End.
    pub until: Time,
    /// Level.
    pub level: bool,
}

/// Cable and transceivers between a receiver and an encoder.
#[derive(Clone, Debug, PartialEq)]
pub struct LineConfig {
    /// Length of the cable in metres.
    pub cable_m: f64,
    /// One-way delay of the cable in nanoseconds per metre (6 typical, 10 at most).
    pub ns_per_m: f64,
    /// CLOCK, to the encoder.
    pub clock: PathConfig,
    /// DATA, to the encoder.
    pub data_out: PathConfig,
    /// DATA, from the encoder.
    pub data_in: PathConfig,
    /// Glitches at given times, in order and without overlap.
    pub glitches: Vec<Glitch>,
    /// Glitches at random times.
    pub random_glitches: Option<GlitchRate>,
    /// The line is stuck for a while.
    pub stuck: Option<Stuck>,
    /// Delay of an echo of the receiver's output, which overrides the encoder.
    pub echo_after: Option<Time>,
    /// Seed of all random values.
    pub seed: u64,
}

/// Longest delay from clock edge to DATA edge in an encoder that a receiver must support, with margin.
const ENCODER_DELAY_MAX: Time = 200 * NS;

impl LineConfig {
    /// A good cable of `cable_m` metres with standard transceivers.
    pub fn cable(cable_m: f64) -> Self {
        Self {
            cable_m,
            ns_per_m: 6.0,
            clock: PathConfig::default(),
            data_out: PathConfig::default(),
            data_in: PathConfig::default(),
            glitches: Vec::new(),
            random_glitches: None,
            stuck: None,
            echo_after: None,
            seed: 1,
        }
    }

    /// Sets the jitter of all three paths.
    pub fn jitter(mut self, jitter: Jitter) -> Self {
        self.clock.jitter = jitter;
        self.data_out.jitter = jitter;
        self.data_in.jitter = jitter;
        self
    }

    /// Sets the seed.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// One-way delay of the cable alone.
    pub fn flight(&self) -> Time {
        (self.cable_m * self.ns_per_m * NS as f64).round() as Time
    }

    /// The longest delay tD that a receiver must support with this line, in nanoseconds.
    pub fn delay_most_ns(&self) -> u64 {
        (self.round_trip() + ENCODER_DELAY_MAX).div_ceil(NS)
    }

    /// Time from a CLOCK edge at the receiver's pin to the resulting DATA edge there, without the encoder's delay (part of tD).
    pub fn round_trip(&self) -> Time {
        2 * self.flight() + self.clock.transceivers + self.data_in.transceivers
    }
}
