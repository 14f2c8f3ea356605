//! What kind of encoder it is and how it is wrong.

use crate::{rng::Rng, Time, MS, NS, US};
use std::{
    ops::{Range, RangeInclusive},
    sync::Arc,
};

/// Where an encoder takes its positions from; they are cut to its width.
#[derive(Clone)]
pub enum PositionSource {
    /// Always the same.
    Fixed(u64),
    /// `start`, then `step` more in every frame.
    Ramp {
        /// Position in the first frame.
        start: u64,
        /// Added from frame to frame, with wrap-around.
        step: u64,
    },
    /// A random one in every frame, from the encoder's seed.
    Random,
    /// A function of the frame number and the moment of the first falling clock edge.
    Function(Arc<dyn Fn(u64, Time) -> u64 + Send + Sync>),
}

impl PositionSource {
    pub(super) fn at(&self, frame: u64, time: Time, rng: &mut Rng) -> u64 {
        match self {
            Self::Fixed(p) => *p,
            Self::Ramp { start, step } => start.wrapping_add(step.wrapping_mul(frame)),
            Self::Random => rng.next_u64(),
            Self::Function(f) => f(frame, time),
        }
    }
}

impl std::fmt::Debug for PositionSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Fixed(p) => write!(f, "Fixed({p:#X})"),
            Self::Ramp { start, step } => write!(f, "Ramp({start:#X} + {step} per frame)"),
            Self::Random => f.write_str("Random"),
            Self::Function(_) => f.write_str("Function"),
        }
    }
}

/// Something wrong with one frame, to be noticed by the receiver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Defect {
    /// Stays LOW instead of answering.
    NoStartBit,
    /// Needs this much longer for its calculation.
    LateStart(Time),
    /// Answers at this rising edge (1 = first), however early that is.
    StartAtEdge(u32),
    /// Sends these error bits (with a CRC that fits them); good are F1 = 0, F2 = 1.
    ErrorBits {
        /// First error bit, 1 = error.
        f1: bool,
        /// Second error bit, 0 = error.
        f2: bool,
    },
    /// Sends the CRC with these bits inverted.
    CrcXor(u8),
    /// Inverts the answer bits whose number (0 = start bit) is set in the mask.
    FlipBits(u128),
    /// From this answer bit to the end of the recovery time the line is held at `level`.
    StuckFrom {
        /// First wrong bit, 0 = start bit.
        bit: u32,
        /// The level.
        level: bool,
    },
    /// From this answer bit (0 = start bit) to the end of the recovery time nobody drives the line.
    OpenFrom(u32),
    /// Does not drive the line from the first falling edge to the end of the recovery time.
    Open,
    /// Holds the line HIGH this much longer than the recovery time.
    LateFall(Time),
    /// Goes HIGH again, 1 us after the recovery time, for this long.
    HighWhenIdle(Time),
    /// Sends a position this many bits wider (or narrower).
    WiderBy(i32),
    /// Answers as an EnDat 2.1 encoder: without F2.
    WithoutF2,
    /// Does not see the clock pulse that ends in this rising edge.
    MissEdge(u32),
    /// Takes this rising edge for two.
    DoubleEdge(u32),
    /// Drives the wrong level for a moment.
    Glitch {
        /// From the first falling edge.
        after: Time,
        /// How long.
        width: Time,
    },
    /// Goes dead (as after a loss of supply) this long after the first falling edge, for this long.
    BrownOut {
        /// From the first falling edge.
        after: Time,
        /// How long until it is ready again.
        length: Time,
    },
}

/// An encoder: its type plate, its times and its defects.
#[derive(Clone, Debug)]
pub struct EncoderConfig {
    /// Width of the position in bits, 1..=48.
    pub position_bits: u32,
    /// Understands the EnDat 2.2 commands.
    pub endat22: bool,
    /// Where positions come from.
    pub position: PositionSource,
    /// Calculation time tcal: first falling edge to the earliest start bit.
    pub tcal: Time,
    /// Up to this is added to tcal, at random in each frame.
    pub tcal_jitter: Time,
    /// Recovery time tm: drawn from this range in each frame.
    pub tm: RangeInclusive<Time>,
    /// Clock edge at the encoder's pin to DATA edge at its pin.
    pub clock_to_data: Time,
    /// First falling clock edge to the release of DATA (at most 0.2 us).
    pub release: Time,
    /// Fastest clock it takes, in hertz.
    pub max_clock_hz: u64,
    /// Longest clock LOW it takes (50 ms; 30 us for LC linear encoders).
    pub max_clock_low: Time,
    /// Longest clock HIGH within a frame before it gives the frame up.
    pub max_clock_high: Time,
    /// DATA must have been LOW for this long before the next frame (tR).
    pub ready_low: Time,
    /// Largest deviation of a HIGH or LOW phase from half a period, as a part of the period.
    pub pulse_variation: f64,
    /// Defects, each with the frames (0 = first) that have it.
    pub defects: Vec<(RangeInclusive<u64>, Defect)>,
    /// When the encoder is not connected.
    pub unplugged: Vec<Range<Time>>,
    /// Seed of everything random in it.
    pub seed: u64,
}

impl EncoderConfig {
    /// A sound EnDat 2.2 encoder with a 16 MHz clock, tcal 5 us and the default recovery time.
    pub fn endat22(position_bits: u32) -> Self {
        Self {
            position_bits,
            endat22: true,
            position: PositionSource::Random,
            tcal: 5 * US,
            tcal_jitter: 0,
            tm: 10 * US..=30 * US,
            clock_to_data: 50 * NS,
            release: 100 * NS,
            max_clock_hz: 16_000_000,
            max_clock_low: 50 * MS,
            max_clock_high: 10 * US,
            ready_low: 500 * NS,
            pulse_variation: 0.1,
            defects: Vec::new(),
            unplugged: Vec::new(),
            seed: 1,
        }
    }

    /// An encoder that knows only EnDat 2.1, with tcal 9 us.
    pub fn endat21(position_bits: u32) -> Self {
        Self {
            endat22: false,
            tcal: 9 * US,
            ..Self::endat22(position_bits)
        }
    }

    /// Sets the source of positions.
    pub fn position(mut self, source: PositionSource) -> Self {
        self.position = source;
        self
    }

    /// Adds a defect to one frame (0 = first).
    pub fn defect(self, frame: u64, defect: Defect) -> Self {
        self.defects(frame..=frame, defect)
    }

    /// Adds a defect to some frames.
    pub fn defects(mut self, frames: RangeInclusive<u64>, defect: Defect) -> Self {
        self.defects.push((frames, defect));
        self
    }

    /// Sets the seed.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    pub(super) fn defects_of(&self, frame: u64) -> Vec<Defect> {
        let mine = |(frames, _): &&(RangeInclusive<u64>, Defect)| frames.contains(&frame);
        self.defects
            .iter()
            .filter(mine)
            .map(|(_, d)| d.clone())
            .collect()
    }
}
