//! One case: a channel, an encoder and a line, and the checks for a fault-free run.

use crate::{
    bench::{Bench, ChannelResult, ChannelSettings, Link},
    encoder::{EncoderConfig, FrameEnd, FrameLog, Symbol, Violation},
    frame::CRC_BITS,
    line::{Conflict, LineConfig, Sample, Who},
    Time, MS,
};
use endat_hdl::endat::{
    channel::{Channel, Features, FixedTimes, CALIBRATION_FRAMES},
    line_delay::mode,
    timing,
    transaction::cause,
};
use endat_hdl::protocol::ModeCommand;
use rtl_design::elaborate::{elaborate, Design, ElaborateError};
use rtl_design::engine::Engine;
use rust_hdl::prelude::Block;

/// From the pin to the register that takes a sample, without filter.
pub const SAMPLE_LATENCY_CYCLES: u64 = 3;
/// More than any frame with its time-outs.
const FRAME_LIMIT: Time = 5 * MS;
/// Cycles in reset, and after it, before the first trigger.
pub(super) const RESET_CYCLES: u64 = 8;

/// A channel with its encoder. After reset it is triggered whenever it is idle, until it has delivered its frames; the first
/// one measures the delay.
#[derive(Clone, Debug)]
pub struct Case {
    /// Short description.
    pub title: String,
    /// System clock in hertz.
    pub system_hz: u64,
    /// Features of the channel.
    pub features: Features,
    /// Configuration of the channel.
    pub settings: ChannelSettings,
    /// The encoder.
    pub encoder: EncoderConfig,
    /// The line.
    pub line: LineConfig,
    /// Results to wait for.
    pub frames: usize,
}

/// The parts of a case that are fixed in its design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct DesignKey {
    pub system_hz: u64,
    pub features: Features,
    calibration_period_cycles: u64,
    abort_us: u64,
    ready_low_cycles: u64,
}

impl DesignKey {
    /// The channel with these times.
    pub fn design(&self) -> Result<Design, ElaborateError> {
        let times = FixedTimes {
            abort_us: self.abort_us,
            ready_low_cycles: self.ready_low_cycles,
            calibration_period_cycles: self.calibration_period_cycles,
            ..FixedTimes::at(self.system_hz)
        };
        let mut block = Channel::with(times, self.features);
        block.connect_all();
        elaborate(&block, "channel")
    }
}

/// Records of a case.
#[derive(Clone, Debug)]
pub struct Traces<'a> {
    /// Results of the channel.
    pub results: &'a [ChannelResult],
    /// Frames, as seen by the encoder.
    pub frames: &'a [FrameLog],
    /// Violations noted by the encoder.
    pub violations: &'a [(Time, Violation)],
    /// Times when both ends drove DATA.
    pub conflicts: Vec<Conflict>,
    /// The samples of DATA that the channel took.
    pub samples: &'a [Sample],
}

impl<'a> Traces<'a> {
    /// Records of the bench of one channel.
    pub fn of<E: Engine>(bench: &'a Bench<E>) -> Self {
        Self {
            results: bench.results(),
            frames: bench.frames(0),
            violations: bench.violations(0),
            conflicts: bench.conflicts(0),
            samples: bench.samples(0),
        }
    }

    /// The frames after those that measured the delay for the first result: one for each result in a fault-free run.
    /// # Errors
    /// An earlier frame that did not measure.
    pub fn positions(&self) -> Result<&'a [FrameLog], String> {
        let measuring = self.frames.len().saturating_sub(self.results.len());
        let (first, frames) = self.frames.split_at(measuring);
        let measures = |f: &FrameLog| frames.first().is_some_and(|next| f.measures_for(next));
        match first.iter().find(|f| !f.is_whole() || !measures(f)) {
            Some(f) => Err(format!("frame {}: does not measure: {f:?}", f.index)),
            None => Ok(frames),
        }
    }
}

impl Case {
    pub(super) fn key(&self) -> DesignKey {
        DesignKey {
            system_hz: self.system_hz,
            features: self.features,
            calibration_period_cycles: timing::calibration_period_cycles(
                self.line.delay_most_ns(),
                self.system_hz,
            ),
            abort_us: self.settings.abort_us,
            ready_low_cycles: self.settings.ready_low_cycles,
        }
    }

    /// Design of the case.
    ///
    /// # Errors
    /// If the channel cannot be elaborated: a bug in this program.
    pub fn design(&self) -> Result<Design, ElaborateError> {
        self.key().design()
    }

    pub(super) fn link(&self) -> Link {
        Link::new(self.line.clone(), self.encoder.clone())
    }

    /// From the pin to the register that takes a sample, in half cycles.
    pub(super) fn latency_halves(&self) -> u64 {
        let majority = match (self.settings.majority, self.features.double_edge) {
            (false, _) => 0,
            (true, false) => 2,
            (true, true) => 1,
        };
        let filter = 2 * self.settings.filter_cycles + u64::from(self.settings.filter_half);
        2 * SAMPLE_LATENCY_CYCLES + filter + majority
    }

    /// Number of first frames that run at the calibration clock.
    pub fn calibration_frames(&self) -> usize {
        match self.features.alignment {
            true if self.settings.phase_mode == mode::FIXED => 0,
            true => CALIBRATION_FRAMES,
            false => 1,
        }
    }

    /// Upper limit of the case in system clock cycles.
    pub(super) fn limit_cycles(&self) -> u64 {
        let limit = u128::from(FRAME_LIMIT) * (self.frames as u128 + 1);
        (limit * u128::from(self.system_hz) / 1_000_000_000_000) as u64
    }

    /// Bits from the start bit to the last CRC bit.
    pub fn answer_bits(&self) -> Option<u32> {
        let command = ModeCommand::from_code(self.settings.command)?;
        Some(command.answer_bits(self.settings.position_bits))
    }

    /// Runs the case alone, on an engine for [`Case::design`]; `is_recorded` keeps the data for waveforms and drawings.
    pub fn run_alone<E: Engine>(&self, engine: E, is_recorded: bool) -> Bench<E> {
        let mut bench = self.bench(engine);
        if is_recorded {
            bench.record_links();
            for name in crate::scenario::WATCHED {
                if bench.has_port(name) {
                    bench.watch(name);
                }
            }
        }
        self.drive(&mut bench);
        bench
    }

    /// The bench of the case in its initial state.
    pub fn bench<E: Engine>(&self, engine: E) -> Bench<E> {
        let pins = crate::bench::PinNames::channel();
        let mut bench = Bench::new(engine, self.system_hz, vec![(pins, self.link())]);
        bench.set_sample_latency_halves(self.latency_halves());
        if self.features.double_edge {
            bench.set_double_edge();
        }
        bench
    }

    /// Powers the bench up and triggers until all frames are complete.
    pub fn drive<E: Engine>(&self, bench: &mut Bench<E>) {
        bench.configure(&self.settings);
        bench.power_up();
        let end = self.limit_cycles();
        loop {
            let is_idle = bench.get("busy") == 0;
            let is_done = bench.results().len() >= self.frames;
            if is_idle && is_done || bench.cycle() >= end {
                break;
            }
            if is_idle && !is_done {
                bench.trigger();
            }
            bench.tick();
        }
    }

    /// Checks that all frames were good and followed the rules.
    ///
    /// # Errors
    /// The first fault.
    pub fn check(&self, traces: &Traces<'_>) -> Result<(), String> {
        if let Some((time, violation)) = traces.violations.first() {
            return Err(format!("{violation}, at {:.3} us", *time as f64 / 1e6));
        }
        if let Some(conflict) = traces.conflicts.first() {
            return Err(format!(
                "{conflict}, at {:.3} us",
                conflict.from as f64 / 1e6
            ));
        }
        // The first position follows the measuring frames, unless the delay was known before.
        let counts = (traces.results.len(), traces.frames.len());
        let measuring = counts.1.saturating_sub(counts.0);
        if counts.0 != self.frames || ![0, self.calibration_frames()].contains(&measuring) {
            return Err(format!(
                "{} results of {} frames instead of {}",
                counts.0, counts.1, self.frames
            ));
        }
        for (frame, result) in traces.positions()?.iter().zip(traces.results) {
            self.check_frame(frame, result)
                .map_err(|what| format!("frame {}: {what}", frame.index))?;
        }
        self.check_samples(traces.samples)
    }

    fn check_frame(&self, frame: &FrameLog, result: &ChannelResult) -> Result<(), String> {
        let bit = |i| u64::from(frame.answer.get(frame.answer.len - CRC_BITS + i));
        let crc_sent = (0..CRC_BITS).fold(0, |crc, i| crc << 1 | bit(i));
        let edges = frame.expected_rising_edges();
        let checks = [
            (
                frame.end == FrameEnd::Complete,
                "is not complete at the encoder",
            ),
            (
                Some(frame.rising_edges) == edges,
                "has not exactly its clock pulses",
            ),
            (
                frame.command == Some(self.settings.command),
                "has another mode command",
            ),
            (
                Some(frame.answer.len) == self.answer_bits(),
                "has another length",
            ),
            (
                frame.is_true_answer(self.settings.position_bits, frame.has_f2),
                "is not what the encoder should send",
            ),
            (
                (result.last_cause(), result.flags) == (cause::NONE, 0),
                "is refused",
            ),
            (
                result.fresh && result.position_valid,
                "gives no fresh position",
            ),
            (result.position == frame.position, "gives another position"),
            (
                (result.crc_received, result.crc_computed) == (crc_sent, crc_sent),
                "gives another CRC",
            ),
        ];
        match checks.iter().find(|(is_good, _)| !is_good) {
            Some((_, what)) => Err(format!("{what}: {result:?}, {frame:?}")),
            None => Ok(()),
        }
    }

    /// Checks that every sample belongs to the encoder's LOW, to the answer bits in order, or to the HIGH after them.
    fn check_samples(&self, samples: &[Sample]) -> Result<(), String> {
        let mut next = 0;
        for sample in samples {
            let wrong = |what: &str| Err(format!("a sample {what}: {sample:?}"));
            match sample.who {
                Who::Encoder(Symbol::Lead) if next == 0 => {}
                Who::Encoder(Symbol::Bit(i)) if u32::from(i) == next => next += 1,
                Who::Encoder(Symbol::Tail) if Some(next) == self.answer_bits() => next = 0,
                _ => return wrong("is not of the bit that comes next"),
            }
            if sample.glitch {
                return wrong("is of a glitch");
            }
        }
        match next {
            0 => Ok(()),
            _ => Err("samples are missing at the end of a frame".into()),
        }
    }
}
