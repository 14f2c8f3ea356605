//! Factory content of an encoder, and sensor values: plain data of its configuration.

use crate::Time;
use std::ops::Range;

/// Data written by the manufacturer, except those that follow from times and widths.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TypePlate {
    /// Rotary or angle encoder; otherwise linear (word 14, bit 15).
    pub rotary: bool,
    /// Distinguishable revolutions, 0 = singleturn (word 17).
    pub revolutions: u16,
    /// Signal periods per revolution, or the signal period in nm (words 15, 16).
    pub signal_periods: u32,
    /// Measuring steps per revolution, or the measuring step in nm (words 20, 21).
    pub measuring_steps: u32,
    /// Letters of the ID number (word 24).
    pub id_letters: [u8; 2],
    /// ID number (words 25, 26).
    pub id_number: u32,
    /// Letters before and after the serial number (words 27, 29).
    pub serial_letters: [u8; 2],
    /// Serial number (words 27 to 29).
    pub serial_number: u32,
    /// Supported alarms (word 35).
    pub alarms: u16,
    /// Supported warnings (word 36).
    pub warnings: u16,
    /// Supported additional data 1, bit n = code 0x40 + n (0xBD word 0: the bits are an assumption).
    pub infos_1: u16,
    /// Supported additional data 2, bit n = code 0x50 + n (0xBD word 1).
    pub infos_2: u16,
    /// For functional safety (word 37).
    pub safety: bool,
}

impl TypePlate {
    /// A singleturn encoder with 2^`bits` measuring steps per revolution and all additional data.
    pub fn rotary(bits: u32) -> Self {
        Self {
            rotary: true,
            revolutions: 0,
            signal_periods: 2048,
            measuring_steps: 1 << bits,
            id_letters: *b"  ",
            id_number: 123_456,
            serial_letters: *b"  ",
            serial_number: 1,
            alarms: 0x007F,
            warnings: 0x001F,
            infos_1: 0x7FFF,
            infos_2: 0x0BFF, // 0x5A, 0x5C to 0x5E are not assigned
            safety: false,
        }
    }

    /// A rotary encoder with `position_bits` bits: above 31 bits the upper ones count revolutions.
    pub fn of_width(position_bits: u32) -> Self {
        let turn_bits = match position_bits {
            0..32 => 0,
            _ => (position_bits - 31).clamp(12, 15),
        };
        Self {
            revolutions: if turn_bits > 0 { 1 << turn_bits } else { 0 },
            ..Self::rotary((position_bits - turn_bits).min(31))
        }
    }

    /// A rotary encoder with these bits of angle and of revolutions.
    pub fn of_turns(single_turn_bits: u32, multi_turn_bits: u32) -> Self {
        Self {
            revolutions: if multi_turn_bits > 0 {
                1 << multi_turn_bits
            } else {
                0
            },
            ..Self::rotary(single_turn_bits)
        }
    }

    /// A linear encoder with this measuring step.
    pub fn linear(step_nm: u32) -> Self {
        Self {
            rotary: false,
            signal_periods: 20_000,
            measuring_steps: step_nm,
            ..Self::rotary(0)
        }
    }

    /// Number of the `position_bits` that count revolutions.
    pub fn multiturn_bits(&self) -> u32 {
        u32::from(self.revolutions).checked_ilog2().unwrap_or(0)
    }
}

/// Content of the additional data, except protocol data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InfoValues {
    /// RM: the reference run is done.
    pub reference_done: bool,
    /// Valuation numbers, one per frame in turn (0x41), once operating parameter word 3 is not 0.
    pub diagnostics: Vec<u16>,
    /// Position value 2 minus position value 1, in measuring steps (0x42 to 0x44).
    pub position_2_offset: i64,
    /// Temperatures 1 and 2 in 0.1 K (0x4C, 0x4D).
    pub temperatures: [u16; 2],
    /// Additional sensors (0x4E).
    pub sensors: u16,
    /// Commutation (0x51; its high byte in 0x53).
    pub commutation: u16,
    /// Acceleration (0x52; its high byte in 0x53 and 0x55).
    pub acceleration: u16,
    /// Limit position signals (0x54; their low byte in 0x55).
    pub limits: u16,
    /// Asynchronous position minus position value 1, in measuring steps (0x56 to 0x58).
    pub asynchronous_offset: i64,
    /// The 40 bits of the test values (010101; 0x49 to 0x4B).
    pub test_values: u64,
}

impl Default for InfoValues {
    fn default() -> Self {
        Self {
            reference_done: false,
            diagnostics: vec![0x6400, 0x5001, 0x3202],
            position_2_offset: 0,
            temperatures: [2954, 2982], // 22.2 and 25.0 degrees C
            sensors: 0,
            commutation: 0,
            acceleration: 0,
            limits: 0,
            asynchronous_offset: 0,
            test_values: 0x01_2345_6789,
        }
    }
}

/// Function initialisation after power-up: recovery time 10 to 30 us.
pub const LONG_RECOVERY: u16 = 0b10;
/// Function initialisation for a recovery time of 1.25 to 3.75 us.
pub const SHORT_RECOVERY: u16 = 0b01;

/// A real fault for some time. It sets its bits; they stay until they are cleared, and return if the fault lasts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cause {
    /// Time span.
    pub during: Range<Time>,
    /// Bits of the alarm word (0xB9 word 0): 0 light source, 1 signal amplitude, 2 position value, 3 overvoltage, 4 undervoltage,
    /// 5 overcurrent, 6 battery.
    pub alarms: u16,
    /// Bits of the warning word (0xB9 word 1).
    pub warnings: u16,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a wide encoder with the type singleturn, and steps that do not make a turn.
    #[test]
    fn wide_positions_count_revolutions() {
        for (bits, revolutions, steps) in [
            (25, 0, 1 << 25),
            (31, 0, 1 << 31),
            (32, 1 << 12, 1 << 20),
            (37, 1 << 12, 1 << 25),
            (46, 1 << 15, 1 << 31),
        ] {
            let plate = TypePlate::of_width(bits);
            let told = (u32::from(plate.revolutions), plate.measuring_steps);
            assert_eq!(told, (revolutions, steps), "{bits}");
        }
    }
}
