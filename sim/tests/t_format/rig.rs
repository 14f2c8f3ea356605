//! The receiver with its bus, a signal processor and an encoder on its line.

use crate::three_way::Stimulus;
use endat_hdl::protocols::t_format::dsp::{AsyncDsp, TFormatStart};
use endat_sim::encoder::Drive;
use endat_sim::t_format::{Encoder, EncoderConfig};
use endat_sim::Time;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::{Compiled, Engine, PortId};
use rust_hdl::prelude::Block;
use std::sync::OnceLock;

/// After power-up no request is sent for the longest pause before a reply.
const READY_US: u64 = 70;

/// The inputs, as [`Inputs::row`] lists them.
pub const INPUTS: [&str; 9] = [
    "rst_i",
    "clk_select_i",
    "trigger_i",
    "bus_cs_n_i",
    "bus_rd_n_i",
    "bus_wr_n_i",
    "bus_address_i",
    "bus_data_i",
    "encoder_data_i",
];

/// The pins that the rig drives.
#[derive(Clone, Copy)]
pub struct Inputs {
    pub reset: bool,
    pub select: bool,
    pub trigger: bool,
    pub cs_n: bool,
    pub rd_n: bool,
    pub wr_n: bool,
    pub address: u8,
    pub data: u16,
    rx: bool,
}

impl Inputs {
    fn row(&self) -> [u128; 9] {
        [
            self.reset.into(),
            self.select.into(),
            self.trigger.into(),
            self.cs_n.into(),
            self.rd_n.into(),
            self.wr_n.into(),
            self.address.into(),
            self.data.into(),
            self.rx.into(),
        ]
    }
}

/// The design of the receiver with its bus.
pub fn design() -> &'static Design {
    static DESIGN: OnceLock<Design> = OnceLock::new();
    DESIGN.get_or_init(|| {
        let mut block = AsyncDsp::new(&TFormatStart::default(), true);
        block.connect_all();
        elaborate(&block, "async_dsp").unwrap()
    })
}

fn compiled() -> Compiled {
    static ENGINE: OnceLock<Compiled> = OnceLock::new();
    ENGINE
        .get_or_init(|| Compiled::new(design()).unwrap())
        .clone()
}

/// Content of the seven addresses and the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Map {
    pub request_id: u16,
    pub reply_id: u8,
    pub repeats: bool,
    pub alarmed: bool,
    pub fresh: bool,
    pub single_turn: u32,
    pub encoder_id: u8,
    pub multi_turn: u32,
    pub alarm: u8,
    pub status: u8,
    pub crc: u8,
    pub communication: u8,
    pub memory: u8,
    pub cause: u64,
    pub single_valid: bool,
    pub multi_valid: bool,
    pub overrun: bool,
    pub busy: bool,
}

/// Receiver, processor and encoder.
pub struct Rig {
    engine: Compiled,
    inputs: [PortId; 9],
    outputs: [PortId; 4],
    pub pins: Inputs,
    pub encoder: Encoder,
    /// No encoder is on the line.
    pub unplugged: bool,
    pub time: Time,
    period: Time,
    recorded: Option<Stimulus>,
}

impl Rig {
    /// A receiver at 20 or 60 MHz, and an encoder.
    pub fn new(system_mhz: u64, config: EncoderConfig) -> Self {
        let engine = compiled();
        let mut rig = Self {
            inputs: INPUTS.map(|name| engine.port(name)),
            outputs: [
                "encoder_data_o",
                "encoder_data_oe",
                "bus_data_o",
                "bus_data_oe",
            ]
            .map(|name| engine.port(name)),
            engine,
            pins: Inputs {
                reset: false,
                select: system_mhz == 60,
                trigger: false,
                cs_n: true,
                rd_n: true,
                wr_n: true,
                address: 0,
                data: 0,
                rx: true,
            },
            encoder: Encoder::new(config),
            unplugged: false,
            time: 0,
            period: 1_000_000 / system_mhz,
            recorded: None,
        };
        // After power-up no request is sent before the line has been at rest.
        rig.wait_us(READY_US);
        rig
    }

    /// Records the pins from here on.
    pub fn record(&mut self) {
        self.recorded = Some(Stimulus {
            inputs: INPUTS.map(String::from).to_vec(),
            ..Stimulus::default()
        });
    }

    pub fn recorded(self) -> Stimulus {
        self.recorded.unwrap()
    }

    /// One clock.
    pub fn step(&mut self) {
        let drive = match (self.output(1), self.output(0)) {
            (0, _) => Drive::Released,
            (_, level) => Drive::level(level == 1),
        };
        self.encoder.receiver(self.time, drive);
        self.time += self.period;
        self.encoder.advance(self.time);
        // The transceiver does not receive its own output.
        self.pins.rx = self.unplugged || self.encoder.output() != Drive::Low;
        let row = self.pins.row();
        for (port, value) in self.inputs.iter().zip(row) {
            self.engine.set(*port, value);
        }
        if let Some(stimulus) = &mut self.recorded {
            stimulus.cycles.push(row.to_vec());
        }
        self.engine.tick();
    }

    pub fn steps(&mut self, n: u64) {
        (0..n).for_each(|_| self.step());
    }

    /// Runs for some microseconds.
    pub fn wait_us(&mut self, us: u64) {
        self.steps(us * 1_000_000 / self.period);
    }

    fn output(&mut self, index: usize) -> u128 {
        self.engine.get(self.outputs[index])
    }

    pub fn bus(&mut self) -> (u16, bool) {
        (self.output(2) as u16, self.output(3) == 1)
    }

    pub fn write(&mut self, address: u8, data: u16) {
        (self.pins.address, self.pins.data) = (address, data);
        (self.pins.cs_n, self.pins.wr_n) = (false, false);
        self.steps(4);
        (self.pins.cs_n, self.pins.wr_n) = (true, true);
        self.steps(4);
    }

    pub fn read(&mut self, address: u8) -> u16 {
        self.pins.address = address;
        (self.pins.cs_n, self.pins.rd_n) = (false, false);
        self.steps(4);
        let (data, drives) = self.bus();
        assert!(drives);
        (self.pins.cs_n, self.pins.rd_n) = (true, true);
        self.step();
        data
    }

    /// Sets the longest reply gap; the rest as at the start.
    pub fn set_gap(&mut self, reply_gap_us: u64) {
        let start = TFormatStart {
            reply_gap_us,
            ..TFormatStart::default()
        };
        self.write(6, start.word() as u16);
    }

    /// Reads all addresses.
    pub fn map(&mut self) -> Map {
        let word: Vec<u16> = (0..8).map(|address| self.read(address)).collect();
        let [low, high] = [|w: u16| w as u8, |w: u16| (w >> 8) as u8];
        let bytes = |a: u8, b: u8, c: u8| u32::from_le_bytes([a, b, c, 0]);
        let bit = |w: u16, i: u32| w >> i & 1 == 1;
        Map {
            request_id: word[0],
            reply_id: low(word[1]) & 15,
            repeats: bit(word[1], 4),
            alarmed: bit(word[1], 5),
            fresh: bit(word[1], 7),
            single_turn: bytes(high(word[1]), low(word[2]), high(word[2])),
            encoder_id: low(word[3]),
            multi_turn: bytes(high(word[3]), low(word[4]), high(word[4])),
            alarm: low(word[5]),
            status: high(word[5]),
            crc: low(word[6]),
            communication: high(word[6]),
            memory: low(word[7]),
            cause: u64::from(word[7] >> 8 & 15),
            single_valid: bit(word[7], 12),
            multi_valid: bit(word[7], 13),
            overrun: bit(word[7], 14),
            busy: bit(word[7], 15),
        }
    }

    /// Waits until the exchange has ended.
    pub fn finish(&mut self) -> Map {
        let limit = self.time + 400_000_000;
        while self.read(7) >> 15 == 1 {
            assert!(self.time < limit, "the exchange does not end");
        }
        self.map()
    }

    /// Sends a request and waits for its end; then the line rests.
    pub fn exchange(&mut self, id: u8) -> Map {
        self.write(0, id.into());
        let map = self.finish();
        self.wait_us(20);
        map
    }

    /// A request to the EEPROM.
    pub fn memory(&mut self, id: u8, address: u8, data: u8) -> Map {
        self.write(7, u16::from(address) | u16::from(data) << 8);
        self.exchange(id)
    }
}
