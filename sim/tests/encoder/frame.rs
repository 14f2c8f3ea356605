//! Random frames: what a receiver does, which breaks rules now and then, and what is wrong with the answer.

use endat_hdl::endat::encoder::bit_error;
use endat_sim::encoder::{Defect, Drive};
use endat_sim::rng::Rng;
use endat_sim::{Time, NS, US};

/// Period of the block's system clock: 64 MHz.
pub const CYCLE: Time = 15_625;
/// CLOCK HIGH after which a frame is over.
const HIGH_MAX: Time = 10 * US;
/// Mode commands whose answer is a position.
const POSITION_21: u8 = 0b000_111;
pub const POSITION_22: u8 = 0b111_000;
/// Mode commands that the receiver sends with a parameter.
const PARAMETER: [u8; 6] = [
    0b001_110, 0b011_100, 0b100_011, 0b101_010, 0b110_001, 0b010_010,
];

/// What an encoder sends and when, in one frame.
#[derive(Clone, Copy, Debug)]
pub struct Reply {
    pub tcal_cycles: u64,
    pub tm_cycles: u64,
    pub alarms: (bool, bool),
    pub error: Error,
}

/// What is wrong with an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Error {
    /// Nothing.
    None,
    /// Inverted bits of the CRC.
    Crc(u8),
    /// Inverted error bits.
    Alarms(bool, bool),
    /// One bit, and what is wrong with it.
    Bit(u32, u64),
    /// So many bits less.
    Narrower(u32),
    NoStart,
    /// The start bit comes so many clocks too early.
    Early(u32),
}

impl Error {
    /// One of an answer of so many bits.
    pub fn random(rng: &mut Rng, position_bits: u32, answer_bits: u32) -> Self {
        let bit = rng.in_range(0, u64::from(answer_bits) - 1) as u32;
        // The HIGH after the answer, too.
        let from = bit + rng.in_range(0, 1) as u32;
        match rng.in_range(0, 9) {
            0 => Self::Crc(rng.in_range(1, 31) as u8),
            1 => Self::Alarms(rng.in_range(0, 1) == 0, rng.in_range(0, 1) == 0),
            2 => Self::Bit(bit, bit_error::INVERT),
            3 => Self::Bit(from, bit_error::LOW),
            4 => Self::Bit(from, bit_error::HIGH),
            5 => Self::Bit(from, bit_error::OFF),
            6 => Self::Narrower(rng.in_range(0, u64::from(position_bits) - 1) as u32),
            7 => Self::NoStart,
            8 => Self::Early(rng.in_range(1, 2) as u32),
            _ => Self::None,
        }
    }

    /// As the model makes it.
    pub fn defect(self) -> Option<Defect> {
        Some(match self {
            Self::Crc(xor) => Defect::CrcXor(xor),
            Self::Bit(bit, bit_error::INVERT) => Defect::FlipBits(1 << bit),
            Self::Bit(bit, bit_error::OFF) => Defect::OpenFrom(bit),
            Self::Bit(bit, error) => Defect::StuckFrom {
                bit,
                level: error == bit_error::HIGH,
            },
            Self::Narrower(bits) => Defect::WiderBy(-(bits as i32)),
            Self::NoStart => Defect::NoStartBit,
            Self::Early(clocks) => Defect::StartAtEdge(11 - clocks),
            Self::None | Self::Alarms(..) => return None,
        })
    }

    /// The inputs of the block that have it.
    pub fn inputs(self, position_bits: u32) -> [(&'static str, u64); 8] {
        let of = |error: Self, value: u64| match self == error {
            true => value,
            false => 0,
        };
        let (mut crc, mut alarms, mut bit, mut width, mut early) = (0, [0; 2], [0; 2], 0, 0);
        match self {
            Self::Crc(xor) => crc = xor.into(),
            Self::Alarms(f1, f2) => alarms = [f1.into(), f2.into()],
            Self::Bit(number, error) => bit = [number.into(), error],
            Self::Narrower(bits) => width = position_bits ^ (position_bits - bits),
            Self::Early(clocks) => early = clocks.into(),
            Self::NoStart | Self::None => {}
        }
        [
            ("crc_xor", crc),
            ("invert_f1", alarms[0]),
            ("invert_f2", alarms[1]),
            ("bit_number", bit[0]),
            ("bit_error", bit[1]),
            ("width_xor", width.into()),
            ("no_start", of(Self::NoStart, 1)),
            ("early_clocks", early),
        ]
    }
}

/// What the receiver does in one frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub command: u8,
    pub parameter: u32,
    pub half: Time,
    pub first_low: Time,
    pub pulses: u32,
    /// Pulse before which CLOCK is LOW for longer, and by how much.
    pub park: Option<(u32, Time)>,
    /// From the last rising edge to the next frame.
    pub pause: Time,
    pub reply: Reply,
}

impl Frame {
    /// A random one for an encoder of so many bits.
    pub fn random(rng: &mut Rng, position_bits: u32, endat22: bool, errors: bool) -> Self {
        // From 16 MHz to 100 kHz, each decade as likely as the other.
        let half = (31_250.0 * 160f64.powf(rng.in_range(0, 1000) as f64 / 1000.0)) as Time;
        let first_low = match rng.in_range(0, 1) {
            0 => half,
            _ => half.max(rng.in_range(2, 10) * US),
        };
        let command = match rng.in_range(0, 9) {
            0 => random_command(rng, endat22),
            1..=4 => POSITION_21,
            _ => POSITION_22,
        };
        let is_known = command == POSITION_21 || endat22 && command == POSITION_22;
        let error = match errors && is_known {
            true => Error::random(
                rng,
                position_bits,
                position_bits + 7 + u32::from(command == POSITION_22),
            ),
            false => Error::None,
        };
        // The next frame comes too soon: its clock may be another one, and it continues a frame that was cut.
        let is_hurried = is_known && rng.in_range(0, 19) == 0;
        // Between two rising edges, so that no rounding decides.
        let (edge, tcal) = match (rng.in_range(2, 40), error) {
            (_, Error::Early(_)) => (2, 0),
            _ if is_hurried => (2, 0),
            (edge, _) => (edge, first_low + (edge - 1) * 2 * half - half),
        };
        let (start, bits) = match error {
            Error::Early(clocks) => (11 - clocks, position_bits),
            Error::Narrower(bits) => ((edge as u32).max(11), position_bits - bits),
            _ => ((edge as u32).max(11), position_bits),
        };
        let answer = bits + 7 + u32::from(command == POSITION_22);
        let lead = match PARAMETER.contains(&command) {
            true => 34,
            false => 10,
        };
        let whole = start + answer;
        let (pulses, is_cut) = match rng.in_range(0, 19) {
            _ if !is_known => (lead, true),
            _ if error == Error::NoStart => (whole, true),
            0 => (rng.in_range(1, u64::from(whole) - 1) as u32, true),
            1 => (whole + rng.in_range(1, 9) as u32, true),
            _ => (whole, false),
        };
        // Longer than a pulse of any clock, where one may follow.
        let tm = match rng.in_range(0, 1) {
            0 if !is_hurried => rng.in_range(1_250, 3_750) * NS,
            _ => rng.in_range(10, 30) * US,
        };
        let longer = rng.in_range(600, 20_000) * NS;
        let pause = match rng.in_range(0, 19) {
            _ if is_hurried => rng.in_range(300, 9_000) * NS,
            _ if is_cut => HIGH_MAX + 2 * US + longer,
            1 => (tm / 2).max(300 * NS),
            _ => tm + longer,
        };
        // Neither while the block counts its last microsecond nor while tm ends.
        let pause = match pause {
            9_500_000..12_000_000 => pause + 2_500 * NS,
            _ => pause,
        };
        let pause = match pause.abs_diff(tm) {
            0..300_000 => pause.max(12 * US) + US,
            _ => pause,
        };
        // Whole periods: edges stay where they are.
        let low = rng.in_range(5, 40) * US / (2 * half) * 2 * half;
        let park = (rng.in_range(0, 19) == 0 && !(29..=31).contains(&((low + half) / US)))
            .then_some((rng.in_range(2, pulses.into()) as u32, low));
        Self {
            command,
            parameter: rng.next_u64() as u32 & 0xFF_FFFF,
            half,
            first_low,
            pulses,
            park,
            pause,
            reply: Reply {
                tcal_cycles: tcal / CYCLE,
                tm_cycles: tm / CYCLE,
                alarms: (rng.in_range(0, 7) == 0, rng.in_range(0, 7) == 0),
                error,
            },
        }
    }

    /// DATA from falling edge `fall` on (1 = first).
    pub fn data(&self, fall: u32) -> Drive {
        let (bits, count) = match PARAMETER.contains(&self.command) {
            true => (
                u64::from(self.command) << 24 | u64::from(self.parameter),
                30,
            ),
            false => (self.command.into(), 6),
        };
        match fall {
            2 => Drive::Low,
            n if (3..3 + count).contains(&n) => Drive::level(bits >> (2 + count - n) & 1 == 1),
            _ => Drive::Released,
        }
    }
}

/// Any code; a parameter only to an encoder that has the command.
fn random_command(rng: &mut Rng, endat22: bool) -> u8 {
    match rng.in_range(0, 63) as u8 {
        0b010_010 if !endat22 => 0,
        code => code,
    }
}
