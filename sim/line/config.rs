//! What a cable and its transceivers do to edges.

use crate::{rng::Rng, Time, NS};

/// Random variation of a delay, drawn for each edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Jitter {
    /// None.
    #[default]
    None,
    /// Anything up to this much earlier or later, equally likely.
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
    /// How much later falling edges arrive than rising ones (duty distortion); negative = earlier.
    pub fall_later: i64,
    /// How much the delay grows with time (temperature), in picoseconds per microsecond; negative = shrinks.
    pub drift: i64,
    /// From a moment on the delay is longer by so much; negative = shorter.
    pub step: Option<(Time, i64)>,
    /// Variation from edge to edge.
    pub jitter: Jitter,
    /// Pulses shorter than this do not get through.
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

/// A wire at the end where it is listened to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wire {
    /// CLOCK, at the encoder.
    Clock,
    /// DATA, at the receiver.
    Data,
}

/// The level of a wire is inverted for a moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Glitch {
    /// Which wire.
    pub wire: Wire,
    /// From when.
    pub at: Time,
    /// For how long.
    pub width: Time,
}

/// Glitches at random moments (a Poisson process).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlitchRate {
    /// Which wire.
    pub wire: Wire,
    /// Mean time from the end of one to the start of the next.
    pub mean_gap: Time,
    /// Shortest.
    pub shortest: Time,
    /// Longest.
    pub longest: Time,
}

/// DATA at the receiver's pin keeps a level, whatever is on the cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stuck {
    /// From when.
    pub from: Time,
    /// Until when.
    pub until: Time,
    /// The level.
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
    /// Glitches at given moments, in order of time and not overlapping.
    pub glitches: Vec<Glitch>,
    /// Glitches at random moments.
    pub random_glitches: Option<GlitchRate>,
    /// The line is stuck for a while.
    pub stuck: Option<Stuck>,
    /// What the receiver sends comes back to it after this, over whatever the encoder does.
    pub echo_after: Option<Time>,
    /// Seed of everything random in it.
    pub seed: u64,
}

/// Longest delay from clock edge to DATA edge in an encoder that a receiver allows for, and what is on top of it.
const ENCODER_DELAY_MAX: Time = 200 * NS;

impl LineConfig {
    /// A sound cable of `cable_m` metres with ordinary transceivers.
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

    /// The longest delay tD that a receiver must take for possible behind this line, in nanoseconds.
    pub fn delay_most_ns(&self) -> u64 {
        (self.round_trip() + ENCODER_DELAY_MAX).div_ceil(NS)
    }

    /// CLOCK edge at the receiver's pin to the DATA edge it causes, there, without the encoder's own delay (part of tD).
    pub fn round_trip(&self) -> Time {
        2 * self.flight() + self.clock.transceivers + self.data_in.transceivers
    }
}
