//! The words of the encoder that the initialisation reads.

use super::words::word;

/// A word of the encoder in the name plate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlateEntry {
    /// Name.
    pub name: &'static str,
    /// Memory area.
    pub mrs: u8,
    /// Address in the memory area.
    pub address: u8,
    /// Meaning.
    pub meaning: &'static str,
}

const fn entry(name: &'static str, mrs: u8, address: u8, meaning: &'static str) -> PlateEntry {
    PlateEntry {
        name,
        mrs,
        address,
        meaning,
    }
}

/// Words that the initialisation reads, in order; areas one after the other (TI, ADDI-DATA drivers; Beckhoff object list).
pub const NAME_PLATE: [PlateEntry; 21] = [
    entry("alarms", 0xB9, 0, "Alarms before they were cleared"),
    entry("warnings", 0xB9, 1, "Warnings before they were cleared"),
    entry(
        "position_bits",
        0xA1,
        0x0D,
        "Word 13: clock pulses for the position in bits 5..0",
    ),
    entry(
        "encoder_type",
        0xA1,
        0x0E,
        "Word 14: bit 15: 1 = rotary, 0 = linear",
    ),
    entry(
        "signal_periods_low",
        0xA1,
        0x0F,
        "Word 15: signal periods per revolution, or in nm",
    ),
    entry(
        "signal_periods_high",
        0xA3,
        0x00,
        "Word 16: upper part of word 15",
    ),
    entry(
        "revolutions",
        0xA3,
        0x01,
        "Word 17: distinguishable revolutions",
    ),
    entry(
        "steps_low",
        0xA3,
        0x04,
        "Word 20: measuring steps per revolution, or step in nm",
    ),
    entry("steps_high", 0xA3, 0x05, "Word 21: upper part of word 20"),
    entry(
        "id_0",
        0xA3,
        0x08,
        "Word 24: ID number, two ASCII characters",
    ),
    entry("id_1", 0xA3, 0x09, "Word 25: ID number, low"),
    entry("id_2", 0xA3, 0x0A, "Word 26: ID number, high"),
    entry(
        "serial_0",
        0xA3,
        0x0B,
        "Word 27: serial number: high byte, ASCII character",
    ),
    entry("serial_1", 0xA3, 0x0C, "Word 28: serial number, middle"),
    entry(
        "serial_2",
        0xA3,
        0x0D,
        "Word 29: ASCII character, serial number low byte",
    ),
    entry(
        "commands",
        0xA5,
        0x05,
        "Word 37: bits 1..0 = 01: EnDat 2.2; bits 3..2 = 01: functional safety",
    ),
    entry("tcal", 0xA5, 0x07, "Word 39: longest calculation time"),
    entry(
        "infos_1",
        0xBD,
        0x00,
        "EnDat 2.2 word 0: supported additional data 1",
    ),
    entry(
        "infos_2",
        0xBD,
        0x01,
        "EnDat 2.2 word 1: supported additional data 2",
    ),
    entry(
        "clock_max_khz",
        0xBD,
        0x19,
        "EnDat 2.2 word 25: fastest clock, in kHz",
    ),
    entry(
        "recovery",
        0xB9,
        0x03,
        "Word 3 of the operating status as set: bits 1..0 = 10: 10 to 30 us, 01: 1.25 to 3.75 us",
    ),
];
/// Address of the tracked line delay, in system clock cycles; it follows the name plate.
pub const PLATE_DELAY: u8 = word::NAME_PLATE + NAME_PLATE.len() as u8;

/// Address of a name plate entry.
pub fn plate(name: &str) -> u8 {
    let index = NAME_PLATE.iter().position(|e| e.name == name);
    word::NAME_PLATE + index.expect("a name of the name plate") as u8
}

#[cfg(test)]
mod tests {
    use super::super::words::COUNTER_BAD_INFOS;
    use super::*;

    #[test]
    fn areas_of_the_name_plate_follow_each_other() {
        let mut areas: Vec<u8> = NAME_PLATE.iter().map(|e| e.mrs).collect();
        areas.dedup();
        assert_eq!(areas, [0xB9, 0xA1, 0xA3, 0xA5, 0xBD, 0xB9]);
        const { assert!(PLATE_DELAY < word::PRIVATE) };
        const { assert!(word::COUNTERS + COUNTER_BAD_INFOS < word::NAME_PLATE) };
    }
}
