//! The encoder alone, with an ideal receiver at its pins.

mod continuous;
mod devices;
mod infos;
mod memory;
mod parameter;
mod position;
mod restart;
mod supplement;
mod vectors;

use super::*;
use crate::{
    frame::{crc5, Parameter},
    MS, NS, US,
};

/// An ideal receiver directly at the encoder.
struct Master {
    encoder: Encoder,
    now: Time,
    half: Time,
    /// LOW pause before a supplement.
    pause: Time,
    /// LOW bits of a supplement.
    zeros: u32,
    /// Additional data that it expects.
    infos: u32,
    /// Outputs of the encoder, with the times of their changes.
    outputs: Vec<(Time, Output)>,
}

impl Master {
    fn new(config: EncoderConfig, hz: u64) -> Self {
        let encoder = Encoder::new(config);
        Self {
            outputs: vec![(0, encoder.output())],
            encoder,
            now: 10 * US,
            half: 500_000_000_000 / hz,
            pause: 2 * US,
            zeros: 7,
            infos: 0,
        }
    }

    fn wait(&mut self, span: Time) {
        let end = self.now + span;
        while let Some(t) = self.encoder.next_event().filter(|t| *t <= end) {
            self.encoder.advance(t);
            self.note(t);
        }
        self.now = end;
    }

    fn note(&mut self, time: Time) {
        let output = self.encoder.output();
        if self.outputs.last().is_none_or(|o| o.1 != output) {
            self.outputs.push((time, output));
        }
    }

    fn edge(&mut self, level: bool, data: Drive) {
        self.encoder.clock_edge(self.now, level, data);
        self.note(self.now);
    }

    fn command_bit(command: u8, rise: u32) -> Drive {
        match rise {
            2 => Drive::Low,
            3..=8 => Drive::level(command >> (8 - rise) & 1 != 0),
            _ => Drive::Released,
        }
    }

    /// The drive with a parameter after the mode command.
    fn parameter_bit(command: u8, fields: Parameter, rise: u32) -> Drive {
        match rise {
            9..=32 => Drive::level(fields.word() >> (32 - rise) & 1 != 0),
            _ => Self::command_bit(command, rise),
        }
    }

    /// One pulse, LOW for `low`; returns the line just before the next falling edge.
    fn pulse(&mut self, data: Drive, low: Time) -> Output {
        self.edge(false, data);
        self.wait(low);
        self.edge(true, data);
        self.wait(self.half);
        self.encoder.output()
    }

    /// Gives `pulses` clock pulses, the first LOW for `first_low`, and returns the bits seen just before each falling edge.
    fn pulses(&mut self, command: u8, first_low: Time, pulses: u32) -> Vec<Output> {
        let data = |rise| Self::command_bit(command, rise);
        self.pulses_with(data, first_low, pulses)
    }

    fn pulses_with(
        &mut self,
        data: impl Fn(u32) -> Drive,
        first_low: Time,
        pulses: u32,
    ) -> Vec<Output> {
        let half = self.half;
        let low = |rise| if rise == 1 { first_low } else { half };
        (1..=pulses)
            .map(|rise| self.pulse(data(rise), low(rise)))
            .collect()
    }

    /// A whole exchange: `fields` follow the mode command or are in the supplement. Returns the answer from the start bit on, or
    /// `None` after 20 ms without one.
    fn exchange(&mut self, code: u8, fields: Parameter) -> Option<Vec<bool>> {
        let command = Command::ALL.iter().find(|c| c.0 == code).unwrap().1;
        let (data, sent): (Box<dyn Fn(u32) -> Drive>, u32) = if command.has_parameter() {
            (
                Box::new(move |rise| Self::parameter_bit(code, fields, rise)),
                34,
            )
        } else {
            (Box::new(move |rise| Self::command_bit(code, rise)), 10)
        };
        self.pulses_with(data, self.half, sent);
        let limit = self.now + 20 * MS;
        let mut bit = self.pulse(Drive::Released, self.half);
        while bit.symbol != Symbol::Bit(0) {
            bit = self.pulse(Drive::Released, self.half);
            if self.now > limit {
                self.wait(50 * US);
                return None;
            }
        }
        let width = self.encoder.config().position_bits;
        let length = match command {
            Command::SendPosition => width + 7,
            Command::SendTestValues => 47,
            _ if command.has_parameter() => 30,
            _ => width + 8 + 30 * self.infos,
        };
        let mut bits = vec![bit.drive == Drive::High];
        for _ in 1..length {
            bits.push(self.pulse(Drive::Released, self.half).drive == Drive::High);
        }
        if command.has_supplement() {
            self.supplement(fields, None);
        } else {
            self.pulse(Drive::Released, self.half);
        }
        self.wait(40 * US);
        Some(bits)
    }

    /// Parks the clock LOW and sends a supplement. Returns the bits before each falling edge from `F'1` on.
    fn supplement(&mut self, fields: Parameter, block: Option<u8>) -> Vec<Output> {
        let mut bits = vec![false; self.zeros as usize];
        bits.push(true);
        bits.extend((0..24).rev().map(|i| fields.word() >> i & 1 != 0));
        bits.extend(
            block
                .into_iter()
                .flat_map(|b| (0..8).rev().map(move |i| b >> i & 1 != 0)),
        );
        let mut seen = vec![self.pulse(Drive::Released, self.half.max(self.pause))];
        for bit in bits {
            seen.push(self.pulse(Drive::level(bit), self.half));
        }
        seen.push(self.pulse(Drive::Released, self.half));
        seen.push(self.pulse(Drive::Released, self.half));
        seen
    }

    /// An EnDat 2.1 command with a parameter, and the checked fields of its answer.
    fn ask(&mut self, code: u8, address: u8, data: u16) -> Option<Parameter> {
        let bits = self.exchange(code, Parameter { address, data })?;
        assert_eq!(crc5(bits[1..25].iter().copied()), number(&bits[25..]) as u8);
        Some(Parameter::from_word(number(&bits[1..25])))
    }

    /// An EnDat 2.2 command, and the checked additional data of its answer.
    fn position22(&mut self, code: u8, address: u8, data: u16) -> Vec<Parameter> {
        let bits = self.exchange(code, Parameter { address, data }).unwrap();
        let width = self.encoder.config().position_bits as usize;
        assert_eq!(bits[1..3], [false, true], "F1, F2");
        let (head, infos) = bits.split_at(width + 8);
        let crc = crc5(head[1..width + 3].iter().copied());
        assert_eq!(crc, number(&head[width + 3..]) as u8);
        infos
            .chunks(30)
            .map(|info| {
                assert!(!info[0], "a block begins LOW");
                assert_eq!(crc5(info[1..25].iter().copied()), number(&info[25..]) as u8);
                Parameter::from_word(number(&info[1..25]))
            })
            .collect()
    }

    /// F1 and F2 of an EnDat 2.2 command.
    fn position22_with_alarm(&mut self, code: u8) -> [bool; 2] {
        let bits = self.exchange(code, Parameter::default()).unwrap();
        [bits[1], bits[2]]
    }

    /// Selects additional data; `infos` is the number of blocks from now on.
    fn select(&mut self, code: u8, infos: u32) {
        self.position22(SELECT_22, code, 0);
        self.infos = infos;
    }

    fn last(&self) -> &FrameLog {
        self.encoder.frames().last().unwrap()
    }

    fn violations(&self) -> Vec<Violation> {
        self.encoder.violations().iter().map(|v| v.1).collect()
    }

    fn drives(&self, symbol: Symbol) -> Time {
        let found = self.outputs.iter().rfind(|o| o.1.symbol == symbol);
        found.expect("the symbol was on the line").0
    }
}

fn number(bits: &[bool]) -> u32 {
    bits.iter().fold(0, |n, b| n << 1 | u32::from(*b))
}

const POSITION_21: u8 = 0b000_111;
const SELECT: u8 = 0b001_110;
const WRITE: u8 = 0b011_100;
const READ: u8 = 0b100_011;
const RESET: u8 = 0b101_010;
const TEST_VALUES: u8 = 0b010_101;
const TEST: u8 = 0b110_001;
const POSITION_22: u8 = 0b111_000;
const SELECT_22: u8 = 0b001_001;
const WRITE_22: u8 = 0b011_011;
const READ_22: u8 = 0b100_100;
const ERROR_RESET: u8 = 0b101_101;
const TEST_22: u8 = 0b110_110;
const COMMUNICATION: u8 = 0b010_010;

/// 13 bits, so that frames are short; memory without access time.
fn quick() -> EncoderConfig {
    let mut config = EncoderConfig::endat22(13).position(PositionSource::Fixed(0x1234));
    (config.tac, config.tcal) = (0..=0, 2 * US);
    config
}
