//! Real encoders as data.
//!
//! The literature named at each device gives position bits, command sets and the LC's limit of the clock LOW time. Values
//! marked "assumed" are typical for that kind of device and must be read from a real one (words 13, 17, 20, 21, 39, and
//! word 25 of area 0xBD).

use super::{EncoderConfig, TypePlate};
use crate::{Time, MS, NS, US};

/// A commercial device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Device {
    /// Name.
    pub name: &'static str,
    /// Position bits.
    pub position_bits: u32,
    /// Supports EnDat 2.2.
    pub endat22: bool,
    /// Rotary or angle encoder.
    pub rotary: bool,
    /// Distinguishable revolutions, 0 = singleturn.
    pub revolutions: u16,
    /// Signal periods per revolution, or the signal period in nm.
    pub signal_periods: u32,
    /// Measuring steps per revolution, or the measuring step in nm.
    pub measuring_steps: u32,
    /// Calculation time tcal.
    pub tcal: Time,
    /// Fastest clock in hertz.
    pub max_clock_hz: u64,
    /// Longest clock LOW.
    pub max_clock_low: Time,
    /// For functional safety.
    pub safety: bool,
}

/// A rotary EnDat 2.2 encoder as a base for others.
const ROTARY: Device = Device {
    name: "",
    position_bits: 25,
    endat22: true,
    rotary: true,
    revolutions: 0,
    signal_periods: 2048,
    measuring_steps: 1 << 25,
    tcal: 5 * US,
    max_clock_hz: 16_000_000,
    max_clock_low: 50 * MS,
    safety: false,
};

/// Angle encoder of 29 bits, as in the card of Liu et al. (Spartan-6, two channels). tcal, clock and lines: assumed.
pub const RCN_8510: Device = Device {
    name: "RCN 8510",
    position_bits: 29,
    measuring_steps: 1 << 29,
    signal_periods: 32_768,
    ..ROTARY
};

/// Linear encoder with 36 bits of 10 nm at 2 MHz, as in Kim et al. (Electronics 2024, 13, 1101). The clock may be LOW for only
/// 30 us. tcal and signal period: assumed.
pub const LC_416: Device = Device {
    name: "LC 416",
    position_bits: 36,
    rotary: false,
    measuring_steps: 10,
    signal_periods: 20_000,
    max_clock_hz: 2_000_000,
    max_clock_low: 30 * US,
    ..ROTARY
};

/// Rotary encoder of 25 + 12 bits: the default of TI's driver. tcal as measured on a 37-bit encoder (4.55 us); clock: assumed.
pub const ROQ_437: Device = Device {
    name: "ROQ 437",
    position_bits: 37,
    revolutions: 4096,
    tcal: 4_550 * NS,
    ..ROTARY
};

/// Rotary encoder for motors, 25 + 12 bits, functional safety. tcal and clock: assumed.
pub const EQN_1337: Device = Device {
    name: "EQN 1337",
    position_bits: 37,
    revolutions: 4096,
    tcal: 7 * US,
    safety: true,
    ..ROTARY
};

/// Rotary encoder of 13 bits, EnDat 2.1 only, with 512 or 2048 periods and at most 2 MHz (AMK's and PWM 20's manuals).
/// tcal: assumed.
pub const ECN_113: Device = Device {
    name: "ECN 113",
    position_bits: 13,
    endat22: false,
    measuring_steps: 1 << 13,
    tcal: 9 * US,
    max_clock_hz: 2_000_000,
    ..ROTARY
};

/// Inductive rotary encoder of 19 bits (AMK's manual). tcal, clock and periods: assumed.
pub const ECI_1119: Device = Device {
    name: "ECI 1119",
    position_bits: 19,
    measuring_steps: 1 << 19,
    signal_periods: 32,
    tcal: 6 * US,
    max_clock_hz: 8_000_000,
    ..ROTARY
};

/// Open linear encoder with 36 bits of 1 nm (HEIDENHAIN's catalogue of the LIC 4100). tcal, clock and period: assumed.
pub const LIC_4117: Device = Device {
    name: "LIC 4117",
    position_bits: 36,
    rotary: false,
    measuring_steps: 1,
    signal_periods: 20_000,
    ..ROTARY
};

/// All devices.
pub const DEVICES: [Device; 7] = [
    RCN_8510, LC_416, ROQ_437, EQN_1337, ECN_113, ECI_1119, LIC_4117,
];

impl Device {
    /// A configurable encoder of this kind.
    pub fn encoder(&self) -> EncoderConfig {
        let generic = if self.endat22 {
            EncoderConfig::endat22(self.position_bits)
        } else {
            EncoderConfig::endat21(self.position_bits)
        };
        EncoderConfig {
            tcal: self.tcal,
            max_clock_hz: self.max_clock_hz,
            max_clock_low: self.max_clock_low,
            plate: TypePlate {
                rotary: self.rotary,
                revolutions: self.revolutions,
                signal_periods: self.signal_periods,
                measuring_steps: self.measuring_steps,
                safety: self.safety,
                ..generic.plate
            },
            ..generic
        }
    }
}
