//! An encoder port with its service on a bench, and a host at its memory.

pub use super::waits::{quick, times, SYSTEM_HZ};
use endat_hdl::{
    config::LIST,
    encoder_port::EncoderPort,
    endat::{
        channel::FixedTimes,
        service::{
            map::{request_state, state, word},
            program::ServiceTimes,
        },
    },
    protocol::ModeCommand,
};
use endat_sim::{
    bench::{Bench, ChannelSettings, Link},
    campaign::ABORT_US,
    encoder::EncoderConfig,
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

/// EnDat clock.
pub const ENDAT_HZ: u64 = 2_000_000;
/// More than any request or initialisation.
const LIMIT: Time = 2_000 * MS;

/// Parameters of a port.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Make {
    pub system_hz: u64,
    pub initialise: bool,
    pub wants_short: bool,
    pub infos: [u8; LIST],
    /// Waiting times as short as an encoder of [`hasty`] allows.
    pub is_hasty: bool,
}

impl Make {
    pub fn usual(initialise: bool) -> Self {
        Self {
            system_hz: SYSTEM_HZ,
            initialise,
            wants_short: false,
            infos: [0; LIST],
            is_hasty: false,
        }
    }

    /// Initialises an encoder of [`hasty`] in a third of the time.
    pub fn hasty() -> Self {
        Self {
            is_hasty: true,
            ..Self::usual(true)
        }
    }

    fn engine(self) -> Compiled {
        let mut fixed = FixedTimes {
            abort_us: ABORT_US,
            ..FixedTimes::at(self.system_hz)
        };
        let mut times = ServiceTimes {
            system_khz: (self.system_hz / 1_000) as u32,
            infos: self.infos,
            ..times(self.initialise)
        };
        if self.is_hasty {
            fixed.parameter_timeout_us = 1_000;
            (times.power_up_ms, times.after_pulse_ms, times.reset_ms) = (1, 1, 1);
            (times.write_ms, times.gap_ms, times.request_ms) = (0, 0, 20);
        }
        let mut block = EncoderPort::new(fixed, Some(&times), self.wants_short);
        block.connect_all();
        let design = elaborate(&block, "encoder_port").expect("the port elaborates");
        Compiled::new(&design).expect("the port has no loop")
    }
}

/// A port after power-up; elaborated once for each kind.
fn engine(make: Make) -> Compiled {
    static MADE: OnceLock<Mutex<BTreeMap<Make, Compiled>>> = OnceLock::new();
    let mut made = MADE
        .get_or_init(Mutex::default)
        .lock()
        .unwrap_or_else(PoisonError::into_inner);
    made.entry(make).or_insert_with(|| make.engine()).clone()
}

/// An encoder with short times, even between two parameters.
pub fn hasty(mut encoder: EncoderConfig) -> EncoderConfig {
    encoder.tac = 0..=20 * US;
    encoder.write_time = 0..=20 * US;
    encoder.reset_time = MS;
    encoder.parameter_gap = 0;
    encoder
}

/// Port, line, encoder, host.
pub struct Rig {
    pub bench: Bench<Compiled>,
}

impl Rig {
    /// After reset, not initialised yet.
    pub fn new(initialise: bool, encoder: EncoderConfig, position_bits: u32) -> Self {
        Self::with(Make::usual(initialise), ENDAT_HZ, encoder, position_bits)
    }

    pub fn with(make: Make, endat_hz: u64, encoder: EncoderConfig, position_bits: u32) -> Self {
        let settings = ChannelSettings::new(
            make.system_hz,
            endat_hz,
            ModeCommand::SendPositionAddInfo,
            position_bits,
        );
        let link = Link::new(LineConfig::cable(20.0), encoder);
        let mut bench = Bench::channel(engine(make), make.system_hz, &settings, link);
        bench.run_for(MS / 10);
        Self { bench }
    }

    /// The host reads a word.
    pub fn read(&mut self, word: u8) -> u32 {
        self.bench.set("host_address", word.into());
        self.bench.set("host_read", 1);
        self.bench.tick();
        self.bench.set("host_read", 0);
        self.bench.run_cycles(8);
        self.bench.get("host_word") as u32
    }

    /// The host writes a word, the high half first.
    pub fn write(&mut self, word: u8, value: u32) {
        self.bench.set("host_address", word.into());
        for half in [1, 0] {
            self.bench.set("host_half", half);
            let data = value >> (16 * half) & 0xFFFF;
            self.bench.set("host_data", data.into());
            self.bench.set("host_write", 1);
            self.bench.tick();
            self.bench.set("host_write", 0);
            self.bench.run_cycles(8);
        }
    }

    /// Runs until a word satisfies a condition.
    pub fn wait_for(&mut self, word: u8, done: impl Fn(u32) -> bool) -> u32 {
        let end = self.bench.now() + LIMIT;
        loop {
            let value = self.read(word);
            if done(value) {
                return value;
            }
            assert!(self.bench.now() < end, "word {word} stays {value:#010x}");
            self.bench.run_cycles(500);
        }
    }

    /// Runs to the end of the initialisation; returns the failed step, 0 = none.
    pub fn initialised(&mut self) -> u32 {
        let under_way = u32::from(state::INITIALISING);
        self.wait_for(word::STATE, |s| s & under_way != 0);
        self.wait_for(word::STATE, |s| s & under_way == 0);
        let progress = self.read(word::PROGRESS);
        assert_eq!(progress & 0xFFFF, 0);
        progress >> 16
    }

    /// State bits.
    pub fn state(&mut self) -> u16 {
        self.read(word::STATE) as u16
    }

    /// True if the encoder has been initialised.
    pub fn is_initialised(&mut self) -> bool {
        self.state() & state::INITIALISED != 0
    }

    /// Sends a request and runs to its end, with a trigger every 200 us for attached requests; returns error and answer.
    pub fn request(&mut self, command: ModeCommand, address: u8, data: u16) -> (u16, u32) {
        self.request_code(command.code(), address, data)
    }

    pub fn request_code(&mut self, code: u8, address: u8, data: u16) -> (u16, u32) {
        let rides = ModeCommand::from_code(code).is_some_and(ModeCommand::has_f2);
        let before = self.read(word::REQUEST_STATE) >> 16;
        let fields = u32::from(address) << 16 | u32::from(data);
        self.write(word::REQUEST, u32::from(code) << 24 | fields);
        let end = self.bench.now() + LIMIT;
        loop {
            let state = self.read(word::REQUEST_STATE);
            if state >> 16 != before {
                assert_eq!(state as u16 & request_state::BUSY, 0);
                let error = state as u16 >> request_state::ERROR_SHIFT;
                return (error, self.read(word::ANSWER));
            }
            assert!(self.bench.now() < end, "the request does not end");
            if rides {
                self.bench.trigger();
            }
            self.bench.run_cycles(self.bench.system_hz() / 5_000);
        }
    }

    /// A request that must succeed; returns its answer.
    pub fn good(&mut self, command: ModeCommand, address: u8, data: u16) -> u32 {
        let (error, answer) = self.request(command, address, data);
        assert_eq!(request_state::name(error), "fulfilled", "{command:?}");
        answer
    }

    /// A triggered position, which must be right.
    pub fn good_position(&mut self) {
        let result = self.bench.frame(LIMIT).expect("a result");
        let frame = self.bench.frames(0).last().expect("a frame");
        assert_eq!(result.cause_name(), "none", "{result:?} {frame:?}");
        assert_eq!(result.position, frame.position, "{result:?} {frame:?}");
        assert!(self.bench.run_until_done(LIMIT, |b| b.get("busy") == 0));
    }

    /// Triggers `frames` frames, 200 us apart.
    pub fn frames(&mut self, frames: usize) {
        for _ in 0..frames {
            self.bench.trigger();
            self.bench.run_cycles(self.bench.system_hz() / 5_000);
        }
    }

    /// The encoder has noted no violation.
    pub fn assert_clean(&self) {
        assert_eq!(self.bench.violations(0), []);
        assert_eq!(self.bench.conflicts(0), []);
    }
}
