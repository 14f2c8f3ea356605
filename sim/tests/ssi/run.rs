//! A bare SSI port with an encoder, cycle by cycle, with access to its registers.

use endat_hdl::protocols::ssi::port::SsiPort;
use endat_hdl::protocols::SsiSpec;
use endat_sim::ssi::{Encoder, EncoderConfig};
use endat_sim::US;
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, Engine, Keep};
use rust_hdl::prelude::Block;
use std::sync::OnceLock;

pub const SYSTEM_MHZ: u64 = 20;
/// The longest wait, also after an upset: a 13-bit timer.
const LIMIT_CYCLES: u64 = 10_000;

/// Settings of the port except the width, which is that of the encoder unless a test changes it.
#[derive(Clone, Copy)]
pub struct Settings {
    pub frame: u128,
    pub period_cycles: u64,
    pub recovery_limit_cycles: u64,
}

/// A port with its encoder.
#[derive(Clone)]
pub struct Run {
    pub engine: Compiled,
    pub encoder: Encoder,
    cycle: u64,
    /// The line is broken: DATA is at this level, and the encoder has no clock.
    pub broken: Option<bool>,
}

fn engine() -> Compiled {
    static ENGINE: OnceLock<Compiled> = OnceLock::new();
    let make = || engine_for(&SsiSpec::default());
    ENGINE.get_or_init(make).clone()
}

/// A port with this request.
pub fn engine_for(asked: &SsiSpec) -> Compiled {
    let mut block = SsiPort::new(asked, true);
    block.connect_all();
    let design = elaborate(&block, "port").unwrap();
    Compiled::keeping(&design, Keep::Registers).unwrap()
}

impl Run {
    /// A port that is ready for its first trigger.
    pub fn new(settings: Settings, encoder: EncoderConfig) -> Self {
        Self::of(engine(), settings, encoder)
    }

    /// As [`Run::new`], with an existing engine.
    pub fn of(engine: Compiled, settings: Settings, encoder: EncoderConfig) -> Self {
        let mut run = Self::powered(engine, settings, encoder);
        run.cycles(40);
        assert!(run.ends());
        run
    }

    /// A port at power-up.
    pub fn powered(mut engine: Compiled, settings: Settings, encoder: EncoderConfig) -> Self {
        for (name, value) in [
            ("data_i", 1),
            ("period_cycles", settings.period_cycles.into()),
            ("position_bits", encoder.position_bits.into()),
            ("filter_cycles", 1),
            (
                "recovery_limit_cycles",
                settings.recovery_limit_cycles.into(),
            ),
            ("frame", settings.frame),
        ] {
            let port = engine.port(name);
            engine.set(port, value);
        }
        Self {
            engine,
            encoder: Encoder::new(encoder),
            cycle: 0,
            broken: None,
        }
    }

    pub fn get(&mut self, name: &str) -> u128 {
        let port = self.engine.port(name);
        self.engine.get(port)
    }

    pub fn set(&mut self, name: &str, value: u128) {
        let port = self.engine.port(name);
        self.engine.set(port, value);
    }

    pub fn cycles(&mut self, count: u64) {
        for _ in 0..count {
            let now = self.cycle * US / SYSTEM_MHZ;
            let clk = self.get("ssi_clk") == 1;
            match self.broken {
                Some(_) => self.encoder.advance(now),
                None => self.encoder.clock(now, clk),
            }
            let data = self.broken.unwrap_or_else(|| self.encoder.data());
            self.set("data_i", data.into());
            self.set("timestamp", self.cycle.into());
            self.engine.tick();
            self.cycle += 1;
        }
    }

    pub fn trigger(&mut self) {
        self.set("trigger", 1);
        self.cycles(1);
        self.set("trigger", 0);
    }

    /// A reset of a few cycles.
    pub fn reset(&mut self) {
        self.set("reset", 1);
        self.cycles(3);
        self.set("reset", 0);
    }

    /// Waits for the end of the present activity; false if there is no end.
    pub fn ends(&mut self) -> bool {
        let last = self.cycle + LIMIT_CYCLES;
        while self.get("busy") == 1 {
            if self.cycle > last {
                return false;
            }
            self.cycles(10);
        }
        true
    }

    /// Number of cycles until it is no longer busy.
    pub fn waits(&mut self) -> u64 {
        let start = self.cycle;
        while self.get("busy") == 1 && self.cycle < start + LIMIT_CYCLES {
            self.cycles(1);
        }
        self.cycle - start
    }

    /// The position if it belongs to the last trigger.
    pub fn fresh(&mut self) -> Option<u64> {
        let [valid, fresh, position] =
            ["position_valid", "fresh", "position"].map(|name| self.get(name));
        (valid == 1 && fresh == 1).then_some(position as u64)
    }

    /// One trigger; true if its result is good.
    pub fn is_good(&mut self) -> bool {
        self.trigger();
        let ends = self.ends();
        self.cycles(600);
        let is = self.encoder.config.position;
        ends && self.fresh() == Some(is) && self.get("cause") == 0
    }
}
