//! The sampling phase: tolerated jitter, drift and noise, with both kinds of input, in all modes.

mod glitches;
mod recovery;
mod three_ways;
mod tolerance;
mod wander;

use endat_hdl::endat::line_delay::mode;
use endat_hdl::protocol::ModeCommand;
use endat_sim::{
    campaign::{self, Case, Outcome, RunOptions, Traces},
    encoder::FrameLog,
    line::Jitter,
    Time,
};
use rtl_design::engine::{Compiled, LaneWords};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Kind of input: system clock cycles in a bit, and sampling edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    /// System clock cycles in a bit.
    pub cycles: u64,
    /// Both edges of the system clock.
    pub double_edge: bool,
    /// The EnDat clock is slower than the fastest by this factor: frames that measure the delay take fewer cycles.
    pub slower: u64,
}

impl Kind {
    pub const fn single(cycles: u64) -> Self {
        Self {
            cycles,
            double_edge: false,
            slower: 1,
        }
    }

    pub const fn double(cycles: u64) -> Self {
        Self {
            cycles,
            double_edge: true,
            slower: 1,
        }
    }

    /// A quarter of the EnDat clock, for the quick tests. Not for delays of more than a few bits.
    pub const fn slower(self) -> Self {
        Self { slower: 4, ..self }
    }

    /// Samples of DATA in each bit.
    pub const fn places(self) -> u64 {
        self.cycles * (1 + self.double_edge as u64)
    }

    /// Peak jitter that a receiver with this many places tolerates, in bits.
    pub fn ideal_jitter(self) -> f64 {
        0.5 - 1.0 / self.places() as f64
    }

    /// EnDat clock in hertz, whose period is a whole number of picoseconds.
    fn clock_hz(self) -> u64 {
        let fastest = match self.cycles {
            0..=8 => 16_000_000,
            9..=16 => 8_000_000,
            _ => 4_000_000,
        };
        fastest / self.slower
    }

    /// A bit in picoseconds.
    pub fn bit(self) -> f64 {
        1e12 / self.clock_hz() as f64
    }

    /// A channel with alignment in mode `tracked` on a line with this jitter and additional delay, both in bits.
    pub fn case(self, jitter_bits: f64, delay_bits: f64, frames: usize, seed: u64) -> Case {
        let rates = (self.cycles * self.clock_hz(), self.clock_hz());
        let mut case = Case::new(rates, ModeCommand::SendPositionAddInfo, 25, 1.0);
        case.features.alignment = true;
        case.features.double_edge = self.double_edge;
        case.settings.phase_mode = mode::TRACKED;
        case.settings.start_window_cycles = (self.cycles / 2).clamp(1, 63);
        let span = |bits: f64| (bits * self.bit()).round() as Time;
        case.line.data_in.jitter = Jitter::Uniform(span(jitter_bits));
        case.line.data_in.transceivers += span(delay_bits);
        case.line.seed = seed;
        case.encoder.seed = seed;
        case.frames = case.calibration_frames() + frames;
        case
    }
}

/// Results of a case after the first frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// All frames.
    pub frames: usize,
    /// Reported as good, with the encoder's position, and exactly its pulses.
    pub good: usize,
    /// Reported as good, with another position.
    pub wrong: usize,
}

/// The compiled design of a case; shared by all cases with this design.
pub fn engine(case: &Case) -> Compiled {
    static MADE: Mutex<BTreeMap<u64, Compiled>> = Mutex::new(BTreeMap::new());
    let design = case.design().expect("a design");
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let make = || Compiled::new(&design).expect("no loop");
    (made.entry(campaign::digest(&design)))
        .or_insert_with(make)
        .clone()
}

/// Counts the frames of a case from frame `first` on.
pub fn count(case: &Case, traces: &Traces<'_>, first: usize) -> Count {
    let mut count = Count {
        frames: case.frames - first,
        ..Count::default()
    };
    for (index, result) in traces.results.iter().enumerate().skip(first) {
        let before = index.checked_sub(1).map_or(0, |i| traces.results[i].time);
        let mut frames: Vec<&FrameLog> = traces
            .frames
            .iter()
            .filter(|f| (before..result.time).contains(&f.first_fall))
            .collect();
        let frame = frames.pop();
        // If the width is in doubt, frames that measure the delay come before.
        let are_slow = frames
            .iter()
            .all(|f| frame.is_some_and(|last| f.measures_for(last)));
        let is_told_good = result.fresh && result.last_cause() == 0;
        let is_true = frame.is_some_and(|f| f.position == result.position);
        let is_exact = frame.is_some_and(FrameLog::is_whole);
        count.good += usize::from(is_told_good && is_true && is_exact && are_slow);
        count.wrong += usize::from(is_told_good && !is_true);
    }
    count
}

/// Runs cases and counts their frames after the calibration and `warm_up` more.
pub fn run(cases: &[Case], warm_up: usize) -> Vec<Count> {
    let options = RunOptions {
        threads: 2,
        samples: false,
        lanes: match cases.len() {
            0..=64 => LaneWords::One,
            _ => LaneWords::Two,
        },
    };
    let judge =
        |case: &Case, traces: &Traces<'_>| count(case, traces, case.calibration_frames() + warm_up);
    let outcomes: Vec<Outcome<Count>> =
        campaign::run(cases, options, judge, |_| {}).expect("a design");
    outcomes.into_iter().map(|o| o.verdict).collect()
}
