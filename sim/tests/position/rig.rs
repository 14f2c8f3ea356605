//! Benches of one elaborated channel, and checks for a fault-free run.

use endat_hdl::endat::channel::{Channel, Features, FixedTimes};
use endat_hdl::protocol::ModeCommand;
pub use endat_sim::campaign::{ABORT_US, RATES};
use endat_sim::{
    bench::{Bench, ChannelResult, ChannelSettings, Link},
    campaign::{Case, Traces, SAMPLE_LATENCY_CYCLES},
    encoder::{Defect, EncoderConfig, FrameLog},
    frame::{crc5, CRC_BITS},
    line::LineConfig,
    Time, MS, US,
};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;
use std::{
    collections::BTreeMap,
    sync::{Mutex, OnceLock, PoisonError},
};

/// System clock and EnDat clock, in hertz.
pub type Rates = (u64, u64);

/// Rates of the acquisition card.
pub const CARD: Rates = (100_000_000, 3_125_000);

/// More than any frame with its time-outs.
pub const FRAME_LIMIT: Time = 5 * MS;

/// A channel on its bench.
pub type Rig = Bench<Compiled>;

/// The fixed times of the channels in these tests.
fn fixed_times(system_hz: u64) -> FixedTimes {
    FixedTimes {
        abort_us: ABORT_US,
        ..FixedTimes::at(system_hz)
    }
}

/// A channel after power-up. The design is elaborated once for each system clock and set of features.
pub fn engine(system_hz: u64, features: Features) -> Compiled {
    static MADE: OnceLock<Mutex<BTreeMap<(u64, Features), Compiled>>> = OnceLock::new();
    let mut made = MADE
        .get_or_init(Mutex::default)
        .lock()
        .unwrap_or_else(PoisonError::into_inner);
    let make = || {
        let mut block = Channel::with(fixed_times(system_hz), features);
        block.connect_all();
        let design = elaborate(&block, "channel").expect("the channel elaborates");
        Compiled::new(&design).expect("the channel has no loop")
    };
    made.entry((system_hz, features))
        .or_insert_with(make)
        .clone()
}

/// Environment of a channel.
#[derive(Clone, Debug)]
pub struct Setup {
    /// System clock.
    pub system_hz: u64,
    /// Features of the channel.
    pub features: Features,
    /// Configuration.
    pub settings: ChannelSettings,
    /// The encoder.
    pub encoder: EncoderConfig,
    /// The line.
    pub line: LineConfig,
}

impl Setup {
    /// A good encoder on a good cable, with suitable settings. The recovery time is short, if allowed.
    pub fn new(rates: Rates, command: ModeCommand, position_bits: u32, cable_m: f64) -> Self {
        let case = Case::new(rates, command, position_bits, cable_m);
        Self {
            system_hz: case.system_hz,
            features: case.features,
            settings: case.settings,
            encoder: case.encoder,
            line: case.line,
        }
    }

    /// The 29-bit encoder of the acquisition card on 10 m of cable.
    pub fn card() -> Self {
        Self::new(CARD, ModeCommand::SendPositionAddInfo, 29, 10.0)
    }

    /// The setup with other features.
    pub fn with(self, features: Features) -> Self {
        Self { features, ..self }
    }

    /// Adds a defect to one frame (0 = first).
    pub fn defect(mut self, frame: u64, defect: Defect) -> Self {
        self.encoder = self.encoder.defect(frame, defect);
        self
    }

    /// Bits from the start bit to the last CRC bit.
    pub fn answer_bits(&self) -> u32 {
        ModeCommand::from_code(self.settings.command)
            .expect("a known command")
            .answer_bits(self.settings.position_bits)
    }

    /// True if sampled levels, from the first HIGH on, form an answer without alarm and with a right CRC.
    pub fn believes(&self, levels: &[bool]) -> bool {
        let f2 = self.settings.command >> 5 != 0;
        believes(levels, self.answer_bits(), f2, true)
    }

    fn link(&self) -> Link {
        Link::new(self.line.clone(), self.encoder.clone())
    }

    fn prepared(&self, mut rig: Rig) -> Rig {
        rig.set_sample_latency(SAMPLE_LATENCY_CYCLES + self.settings.filter_cycles);
        rig
    }

    /// After power-up and reset: the first frame measures the delay.
    pub fn fresh(&self) -> Rig {
        let engine = engine(self.system_hz, self.features);
        let rig = Bench::channel(engine, self.system_hz, &self.settings, self.link());
        self.prepared(rig)
    }

    /// A channel that continues from an idle state, with a new line and encoder.
    pub fn on(&self, engine: Compiled) -> Rig {
        let pins = endat_sim::bench::PinNames::channel();
        let mut rig = Bench::new(engine, self.system_hz, vec![(pins, self.link())]);
        rig.configure(&self.settings);
        self.prepared(rig)
    }

    /// An idle channel that has measured the delay of this line, with a good position.
    pub fn measured(&self) -> Compiled {
        let mut sound = self.clone();
        sound.encoder.defects.clear();
        let mut rig = sound.fresh();
        good_frame(&mut rig);
        settle(&mut rig);
        assert_sound(&sound, &rig);
        rig.engine().clone()
    }

    /// As [`Setup::ready`], for an encoder whose recovery time would be a fault in the measuring frame.
    pub fn ready_with_other_recovery(&self) -> Rig {
        let mut usual = self.clone();
        usual.encoder.tm = 2 * US..=2 * US;
        self.on(usual.measured())
    }

    /// A channel that has measured the delay of this line. The next frame runs at the full clock and is the
    /// encoder's frame 0.
    pub fn ready(&self) -> Rig {
        self.on(self.measured())
    }
}

/// True if sampled levels, from the first HIGH on, form an answer of `answer_bits` bits without alarm, with a right CRC and the level `behind` after it.
pub fn believes(levels: &[bool], answer_bits: u32, f2: bool, behind: bool) -> bool {
    let start = levels.iter().position(|level| *level);
    let answer = &levels[start.unwrap_or(levels.len())..];
    let end = answer_bits as usize;
    let covered_end = end - CRC_BITS as usize;
    if answer.get(end) != Some(&behind) {
        return false;
    }
    let sent = answer[covered_end..end].iter();
    let crc = sent.fold(0, |crc, bit| crc << 1 | u8::from(*bit));
    let no_alarm = !answer[1] && (!f2 || answer[2]);
    no_alarm && crc5(answer[1..covered_end].iter().copied()) == crc
}

/// Runs until the channel is idle and the latest samples have been evaluated.
pub fn settle(rig: &mut Rig) {
    assert!(
        rig.run_until_done(FRAME_LIMIT, |b| b.get("busy") == 0),
        "the channel stays busy"
    );
}

/// Triggers a frame and runs to its result.
pub fn any_frame(rig: &mut Rig) -> ChannelResult {
    rig.frame(FRAME_LIMIT).expect("every trigger has a result")
}

/// Triggers a frame, which must be good and bring the encoder's position.
pub fn good_frame(rig: &mut Rig) -> ChannelResult {
    let result = any_frame(rig);
    let frame = rig.frames(0).last().expect("the encoder received a frame");
    assert_eq!(
        (result.cause_name(), result.fresh, result.position_valid),
        ("none", true, true),
        "{result:?} {frame:?}"
    );
    assert_eq!(
        result.position, frame.position,
        "wrong position: {result:?} {frame:?}"
    );
    result
}

/// The CRC at the end of an answer.
pub fn crc_sent(frame: &FrameLog) -> u64 {
    let bit = |i| u64::from(frame.answer.get(frame.answer.len - CRC_BITS + i));
    (0..CRC_BITS).fold(0, |crc, i| crc << 1 | bit(i))
}

/// Checks that all frames so far were good and followed the rules. The channel must be idle.
pub fn assert_sound(setup: &Setup, rig: &Rig) {
    let case = Case {
        features: setup.features,
        title: String::new(),
        system_hz: setup.system_hz,
        settings: setup.settings,
        encoder: setup.encoder.clone(),
        line: setup.line.clone(),
        frames: rig.results().len(),
    };
    let traces = Traces::of(rig);
    if let Err(what) = case.check(&traces) {
        panic!("{what}\n{setup:?}");
    }
}
