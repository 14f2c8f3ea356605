//! Kind of encoder.

use super::{Cause, Defect, InfoValues, TypePlate, LONG_RECOVERY};
use crate::{rng::Rng, Time, MS, NS, US};
use std::{
    ops::{Range, RangeInclusive},
    sync::Arc,
};

/// Source of the positions, which are cut to the encoder's width.
#[derive(Clone)]
pub enum PositionSource {
    /// Constant.
    Fixed(u64),
    /// `start`, then `step` more in every frame.
    Ramp {
        /// Position in the first frame.
        start: u64,
        /// Added from frame to frame, with wrap-around.
        step: u64,
    },
    /// Random in every frame, from the encoder's seed.
    Random,
    /// A function of the frame number and the time of the first falling clock edge.
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

/// The falling edge that latches the next position in continuous clock mode; descriptions allow both readings. `R(c)` launches
/// the last CRC bit, `R(c+1)` the HIGH cell, `R(c+2)` LOW.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LatchEdge {
    /// `F(c+2)`, in the HIGH cell.
    InHigh,
    /// `F(c+3)`, the first one after DATA has gone LOW.
    AfterLow,
}

/// An encoder: its type plate, its times and its defects.
#[derive(Clone, Debug)]
pub struct EncoderConfig {
    /// Width of the position in bits, 1..=48.
    pub position_bits: u32,
    /// Supports the EnDat 2.2 commands.
    pub endat22: bool,
    /// Source of the positions.
    pub position: PositionSource,
    /// Calculation time tcal: first falling edge to the earliest start bit.
    pub tcal: Time,
    /// Largest random addition to tcal in each frame.
    pub tcal_jitter: Time,
    /// Recovery time tm: drawn from this range in each frame.
    pub tm: RangeInclusive<Time>,
    /// Clock edge at the encoder's pin to DATA edge at its pin.
    pub clock_to_data: Time,
    /// First falling clock edge to the release of DATA (at most 0.2 us).
    pub release: Time,
    /// Fastest supported clock, in hertz.
    pub max_clock_hz: u64,
    /// Longest supported clock LOW (50 ms; 30 us for LC linear encoders).
    pub max_clock_low: Time,
    /// Longest clock HIGH within a frame before the encoder aborts it.
    pub max_clock_high: Time,
    /// DATA must have been LOW for this time before the next frame (tR).
    pub ready_low: Time,
    /// Largest deviation of a HIGH or LOW phase from half a period, as a part of the period.
    pub pulse_variation: f64,
    /// Recovery time of EnDat 2.2 commands with the short setting; `None` = it cannot be selected.
    pub tm_short: Option<RangeInclusive<Time>>,
    /// Access time tac of memory commands, from the last bit of the command to the answer or the end of Busy (at most 12 ms).
    pub tac: RangeInclusive<Time>,
    /// How long a write keeps the memory busy (at most 12 ms).
    pub write_time: RangeInclusive<Time>,
    /// Pause between two EnDat 2.1 commands with a parameter (old encoders: 1 ms).
    pub parameter_gap: Time,
    /// Time without receiving after a reset command.
    pub reset_time: Time,
    /// Time from plugging in until it is ready.
    pub start_up: Time,
    /// CLOCK LOW after the last bit of an answer until DATA is released for the supplement. Not published; it must hold the
    /// last bit until the receiver has sampled it.
    pub park_release: Time,
    /// Fewest LOW bits before the start bit of a supplement: as in TI's driver; the minimum is not published.
    pub supplement_zeros: u32,
    /// Continuous clock after an EnDat 2.1 position, with the edge that latches the next one; `None` = not supported.
    pub continuous: Option<LatchEdge>,
    /// True if the error reset 101101 also ends the additional data: HEIDENHAIN's FAQ states it, TI's driver does not
    /// rely on it.
    pub error_reset_stops_infos: bool,
    /// Function initialisation, word 3 of the operating status, after power-up: bits 1..0 are the recovery time, the others
    /// are defined by the manufacturer.
    pub function: u16,
    /// Data written by the manufacturer.
    pub plate: TypePlate,
    /// Content of the additional data.
    pub values: InfoValues,
    /// Faults of the encoder, with their times.
    pub causes: Vec<Cause>,
    /// Defects, each with the frames (0 = first) that have it.
    pub defects: Vec<(RangeInclusive<u64>, Defect)>,
    /// Times when the encoder is not connected.
    pub unplugged: Vec<Range<Time>>,
    /// Seed of everything random in it.
    pub seed: u64,
}

impl EncoderConfig {
    /// A good EnDat 2.2 encoder with a 16 MHz clock, tcal 5 us and the default recovery time.
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
            tm_short: Some(1_250 * NS..=3_750 * NS),
            tac: 100 * US..=MS,
            write_time: 12 * MS..=12 * MS,
            parameter_gap: 0,
            reset_time: 50 * MS,
            start_up: 0,
            park_release: 500 * NS,
            supplement_zeros: 7,
            continuous: None,
            error_reset_stops_infos: false,
            function: LONG_RECOVERY,
            plate: TypePlate::of_width(position_bits),
            values: InfoValues::default(),
            causes: Vec::new(),
            defects: Vec::new(),
            unplugged: Vec::new(),
            seed: 1,
        }
    }

    /// An EnDat 2.1 encoder, with tcal 9 us.
    pub fn endat21(position_bits: u32) -> Self {
        Self {
            endat22: false,
            tcal: 9 * US,
            tm_short: None,
            parameter_gap: MS,
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

    /// Adds a fault.
    pub fn cause(mut self, cause: Cause) -> Self {
        self.causes.push(cause);
        self
    }

    /// Allows continuous clock mode.
    pub fn continuous(mut self, edge: LatchEdge) -> Self {
        self.continuous = Some(edge);
        self
    }

    /// Sets the seed.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Switching of supply or plug. If the plug is pulled before the encoder has started, it stays off.
    pub(super) fn supply(&self) -> Vec<(Time, bool)> {
        let mut absent: Vec<Range<Time>> = Vec::new();
        for r in &self.unplugged {
            let end = r.end.saturating_add(self.start_up);
            match absent.last_mut() {
                Some(last) if last.end >= r.start => last.end = end,
                _ => absent.push(r.start..end),
            }
        }
        let events = absent
            .iter()
            .flat_map(|r| [(r.start, false), (r.end, true)]);
        events.collect()
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
