//! The encoder of hdl and the simulation's encoder model at one receiver, which breaks rules now and then: both do the same to DATA, frame
//! by frame and edge by edge.
//!
//! Three differences are intended. The model has all fourteen mode commands, so a frame with one that the block refuses ends before its answer.
//! A model that is out of step with the receiver keeps DATA as it was; the block switches its driver off. A model of EnDat 2.1 does not
//! know that a parameter follows 010010; the block does, and waits for its end.

use super::frame::{Error, Frame, CYCLE, POSITION_22};
use super::{BLOCK, CLOCK_LOW_MAX_US, WRONG_BLOCK};
use endat_sim::encoder::{
    Defect, Drive, Encoder, EncoderConfig, FrameEnd, PositionSource, Symbol, Violation,
};
use endat_sim::rng::Rng;
use endat_sim::{Time, NS, US};
use rtl_design::engine::{Compiled, Engine, PortId};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Cycles of a microsecond.
const US_CYCLES: u64 = US / CYCLE;
/// A change of DATA by the model, and whether the block comes up to a microsecond later.
#[derive(Clone, Copy, Debug)]
struct Change {
    time: Time,
    drive: Drive,
    is_loose: bool,
}

struct Ports {
    endat_clk: PortId,
    data_i: PortId,
    tick_us: PortId,
    position: PortId,
    data_o: PortId,
    data_oe: PortId,
    latch: PortId,
    command_strobe: PortId,
    command: PortId,
    answered: PortId,
    busy: PortId,
}

/// Both encoders.
struct Twin<'a> {
    block: &'a mut Compiled,
    /// The block makes errors on command.
    errors: bool,
    position_bits: u32,
    ports: Ports,
    model: Encoder,
    seed: u64,
    /// The next edge of the block's clock.
    edge: Time,
    cycle: u64,
    clock: bool,
    receiver: Drive,
    latches: u64,
    answers: usize,
    commands: Vec<u8>,
    /// The block was busy and the model was not, or the other way round, when a frame began.
    is_other_busy: bool,
    of_block: Vec<(Time, Drive)>,
    of_model: Vec<Change>,
    /// The model is out of step with the receiver.
    is_lost: bool,
    violations: usize,
}

/// Position of a frame.
fn position(seed: u64, frame: u64) -> u64 {
    Rng::new(seed ^ frame << 32).next_u64() & (u64::MAX >> 16)
}

/// A frame is prepared so long before it begins.
const PREPARED: Time = 200 * NS;

/// How long both start up.
const START: Time = 20 * US;

impl<'a> Twin<'a> {
    fn new(
        block: &'a mut Compiled,
        errors: bool,
        position_bits: u32,
        endat22: bool,
        seed: u64,
    ) -> Self {
        let mut config = match endat22 {
            true => EncoderConfig::endat22(position_bits),
            false => EncoderConfig::endat21(position_bits),
        };
        (config.tcal, config.tm) = (0, 0..=0);
        (config.clock_to_data, config.release, config.ready_low) = (0, 0, 0);
        config.max_clock_low = CLOCK_LOW_MAX_US * US;
        config.position = PositionSource::Function(Arc::new(move |frame, _| position(seed, frame)));
        let port = |name| block.port(name);
        let ports = Ports {
            endat_clk: port("endat_clk"),
            data_i: port("data_i"),
            tick_us: port("tick_us"),
            position: port("position"),
            data_o: port("data_o"),
            data_oe: port("data_oe"),
            latch: port("latch"),
            command_strobe: port("command_strobe"),
            command: port("command"),
            answered: port("answered"),
            busy: port("busy"),
        };
        let mut twin = Self {
            block,
            errors,
            position_bits,
            ports,
            model: Encoder::new(config),
            seed,
            edge: seed % CYCLE,
            cycle: 0,
            clock: true,
            receiver: Drive::Released,
            latches: 0,
            answers: 0,
            commands: vec![],
            is_other_busy: false,
            of_block: vec![],
            of_model: vec![Change {
                time: 0,
                drive: Drive::Low,
                is_loose: false,
            }],
            is_lost: false,
            violations: 0,
        };
        twin.set("position_bits", position_bits.into());
        twin.set("endat22", endat22.into());
        twin.set("plugged", 1);
        twin.advance(START);
        twin.of_block.clear();
        twin
    }

    fn set(&mut self, name: &str, value: u64) {
        let port = self.block.port(name);
        self.block.set(port, value.into());
    }

    fn block_drive(&mut self) -> Drive {
        match self.block.get(self.ports.data_oe) {
            0 => Drive::Released,
            _ => Drive::level(self.block.get(self.ports.data_o) == 1),
        }
    }

    fn tick(&mut self) {
        self.cycle += 1;
        let drive = self.block_drive();
        let line = match (drive, self.receiver) {
            (Drive::Released, receiver) => receiver != Drive::Low,
            (encoder, _) => encoder == Drive::High,
        };
        self.block.set(self.ports.endat_clk, self.clock.into());
        self.block.set(self.ports.data_i, line.into());
        let tick = self.cycle.is_multiple_of(US_CYCLES);
        self.block.set(self.ports.tick_us, tick.into());
        let next = position(self.seed, self.latches);
        self.block.set(self.ports.position, next.into());
        self.latches += self.block.get(self.ports.latch) as u64;
        self.answers += self.block.get(self.ports.answered) as usize;
        if self.block.get(self.ports.command_strobe) == 1 {
            let command = self.block.get(self.ports.command);
            self.commands.push(command as u8);
        }
        self.block.tick();
        let now = self.block_drive();
        if now != drive {
            self.of_block.push((self.edge, now));
        }
        self.edge += CYCLE;
    }

    /// Notes what the model does to DATA.
    fn note(&mut self, time: Time) {
        let log = self.model.frames().last();
        let end = log.map(|f| f.end);
        let fresh = &self.model.violations()[self.violations..];
        self.is_lost |= fresh.iter().any(|v| v.1 == Violation::ClockLowTooLong);
        self.violations += fresh.len();
        let output = self.model.output();
        self.is_lost |= end == Some(FrameEnd::Overrun) && output.symbol == Symbol::Tail;
        let was_lost = self.is_lost;
        if self.model.is_ready(time) {
            self.is_lost = false;
        }
        let drive = match self.is_lost {
            true => Drive::Released,
            false => output.drive,
        };
        if self.of_model.last().is_none_or(|last| last.drive != drive) {
            let is_loose = was_lost && !self.is_lost
                || output.symbol == Symbol::Idle && end != Some(FrameEnd::Complete)
                || self.is_lost && end != Some(FrameEnd::Overrun);
            self.of_model.push(Change {
                time,
                drive,
                is_loose,
            });
        }
    }

    /// Runs both up to `time`.
    fn advance(&mut self, time: Time) {
        while let Some(next) = self.model.next_event().filter(|next| *next <= time) {
            self.model.advance(next);
            self.note(next);
        }
        while self.edge < time {
            self.tick();
        }
    }

    fn clock_edge(&mut self, time: Time, level: bool, data: Drive) {
        self.advance(time);
        (self.clock, self.receiver) = (level, data);
        self.model.clock_edge(time, level, data);
        self.note(time);
        self.advance(time);
    }

    /// Settings and errors of a frame.
    fn prepare(&mut self, frame: &Frame) {
        let reply = frame.reply;
        let (alarm_1, alarm_2) = reply.alarms;
        let (invert_1, invert_2) = match reply.error {
            Error::Alarms(invert_1, invert_2) => (invert_1, invert_2),
            _ => (false, false),
        };
        let tcal = Defect::LateStart(reply.tcal_cycles * CYCLE);
        let tm = Defect::LateFall(reply.tm_cycles * CYCLE);
        let error_bits = Defect::ErrorBits {
            f1: alarm_1 ^ invert_1,
            f2: !alarm_2 ^ invert_2,
        };
        let all = [Some(tcal), Some(tm), Some(error_bits), reply.error.defect()];
        all.into_iter()
            .flatten()
            .for_each(|d| self.model.spoil_next(d));
        // Only one of them counts.
        let tm_22 = frame.command == POSITION_22;
        let is_wrong = self.errors && reply.error != Error::None;
        let of = |counts: bool, cycles: u64| match counts {
            true => cycles,
            false => cycles ^ 0x1000,
        };
        self.set("tcal_cycles", of(!is_wrong, reply.tcal_cycles));
        self.set("error_tcal_cycles", of(is_wrong, reply.tcal_cycles));
        self.set("tm_cycles", of(!is_wrong && !tm_22, reply.tm_cycles));
        self.set("tm_22_cycles", of(!is_wrong && tm_22, reply.tm_cycles));
        self.set("error_tm_cycles", of(is_wrong, reply.tm_cycles));
        self.set("alarm_1", alarm_1.into());
        self.set("alarm_2", alarm_2.into());
        for (name, value) in reply.error.inputs(self.position_bits) {
            self.set(name, value);
        }
        self.set("error_frames", is_wrong.into());
        self.set("arm", 1);
        self.tick();
        self.set("arm", 0);
    }

    /// One frame from `time` on; gives the time of the next one.
    fn frame(&mut self, mut time: Time, frame: &Frame) -> Time {
        self.advance(time - PREPARED);
        if self.model.is_ready(time - PREPARED) {
            self.prepare(frame);
        }
        self.advance(time);
        let busy = self.block.get(self.ports.busy) == 1;
        self.is_other_busy |= busy == self.model.is_ready(time);
        for pulse in 1..=frame.pulses {
            let park = frame.park.filter(|park| park.0 == pulse);
            let low = match pulse {
                1 => frame.first_low,
                _ => frame.half + park.map_or(0, |park| park.1),
            };
            self.clock_edge(time, false, frame.data(pulse));
            time += low;
            self.clock_edge(time, true, frame.data(pulse));
            time += frame.half;
        }
        let rise = time - frame.half;
        self.advance(rise + frame.half.min(frame.pause - PREPARED));
        self.receiver = Drive::Released;
        rise + frame.pause
    }

    /// The first difference.
    fn compare(&self) -> Result<(), String> {
        let mut of_block = self.of_block.iter();
        // Both rest LOW at first.
        for change in &self.of_model[1..] {
            let Some(&(time, drive)) = of_block.next() else {
                return Err(format!("the block does not do {change:?}"));
            };
            let late = time as i64 - change.time as i64;
            let most = match change.is_loose {
                true => US + 4 * CYCLE,
                false => 3 * CYCLE,
            };
            if drive != change.drive || !(2 * CYCLE as i64..=most as i64).contains(&late) {
                return Err(format!(
                    "{change:?}: the block does {drive:?} {late} ps later"
                ));
            }
        }
        if let Some(more) = of_block.next() {
            return Err(format!("the block does {more:?}, and the model nothing"));
        }
        let frames = self.model.frames();
        let commands: Vec<u8> = frames.iter().filter_map(|f| f.command).collect();
        let ends = [FrameEnd::Complete, FrameEnd::Overrun];
        let answers = frames.iter().filter(|f| ends.contains(&f.end)).count();
        match () {
            () if self.latches != frames.len() as u64 => Err("another number of positions".into()),
            () if self.commands != commands => Err(format!(
                "{:?} of the block, {commands:?} of the model",
                self.commands
            )),
            () if self.answers != answers => Err(format!(
                "{} answers of the block, {answers} of the model",
                self.answers
            )),
            () if self.is_other_busy => Err("only one of them is busy".into()),
            () => Ok(()),
        }
    }
}

/// Random frames with one encoder; how often each end of a frame came.
///
/// # Errors
/// The first difference.
pub fn random_frames(
    block: &mut Compiled,
    errors: bool,
    seed: u64,
    frames: usize,
) -> Result<BTreeMap<String, u64>, String> {
    let mut rng = Rng::new(seed);
    let position_bits = rng.in_range(1, 52).min(48) as u32;
    let endat22 = rng.in_range(0, 3) != 0;
    let mut twin = Twin::new(block, errors, position_bits, endat22, rng.next_u64() >> 16);
    let mut time = START + 5 * US;
    for number in 0..frames {
        let frame = Frame::random(&mut rng, position_bits, endat22, errors);
        time = twin.frame(time, &frame);
        twin.advance(time - PREPARED);
        twin.compare().map_err(|what| {
            let log = twin.model.frames().last();
            format!("seed {seed}, frame {number}, {position_bits} bits, endat22 = {endat22}: {what}\n{frame:?}\n{log:?}")
        })?;
    }
    twin.advance(time + 60 * US);
    twin.compare()
        .map_err(|what| format!("seed {seed}: {what}"))?;
    let mut ends = BTreeMap::new();
    for frame in twin.model.frames() {
        *ends.entry(format!("{:?}", frame.end)).or_default() += 1;
    }
    Ok(ends)
}

/// Encoders with these seeds, so many frames each; every second one makes errors on command.
fn agree(seeds: std::ops::Range<u64>, frames: usize) -> BTreeMap<String, u64> {
    let mut all = BTreeMap::new();
    for seed in seeds {
        let (block, errors) = match seed % 2 {
            0 => (&BLOCK, false),
            _ => (&WRONG_BLOCK, true),
        };
        let ends = random_frames(&mut (*block).clone(), errors, seed, frames);
        for (end, count) in ends.unwrap_or_else(|e| panic!("{e}")) {
            *all.entry(end).or_default() += count;
        }
    }
    all
}

#[test]
fn encoder_and_model_agree_on_random_frames() {
    let ends = agree(0..40, 30);
    for (end, at_least) in [("Complete", 500), ("Stopped", 100), ("Overrun", 30)] {
        assert!(ends[end] >= at_least, "{ends:?}");
    }
}

#[test]
#[ignore = "slow: a million random frames"]
fn encoder_and_model_agree_on_a_million_random_frames() {
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get) as u64;
    let encoders = 34_000 / threads;
    std::thread::scope(|scope| {
        for thread in 0..threads {
            scope.spawn(move || agree(thread * encoders..(thread + 1) * encoders, 30));
        }
    });
}
