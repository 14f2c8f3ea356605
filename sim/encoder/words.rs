//! Memory words written by the manufacturer. Names of the words as in Beckhoff's object list of the AX8000.

use super::{EncoderConfig, ErrorSource};
use crate::US;

/// Words 0 to 47 of the encoder manufacturer's areas; 0 to 3 do not exist. Masks (4 to 7), memory allocation (9 to 12), the
/// encoder's own words (41 to 46) and the check sum (47) have no published content and are 0.
pub(super) fn manufacturer(config: &EncoderConfig) -> [u16; 48] {
    let plate = &config.plate;
    let mut w = [0; 48];
    w[8] = if config.endat22 { 2 } else { 1 }; // interface version: its coding is an assumption
    w[13] = 0x8000 | config.position_bits as u16; // real encoders have bit 15 set
    w[14] = u16::from(plate.rotary) << 15;
    let (periods_low, periods_high) = halves(plate.signal_periods);
    (w[15], w[16]) = (periods_low, periods_high);
    w[17] = plate.revolutions;
    let (steps_low, steps_high) = halves(plate.measuring_steps);
    (w[20], w[21]) = (steps_low, steps_high);
    w[24] = u16::from_be_bytes(plate.id_letters);
    (w[25], w[26]) = halves(plate.id_number);
    let serial = plate.serial_number.to_be_bytes();
    w[27] = u16::from_be_bytes([serial[0], plate.serial_letters[0]]);
    w[28] = u16::from_be_bytes([serial[1], serial[2]]);
    w[29] = u16::from_be_bytes([plate.serial_letters[1], serial[3]]);
    w[35] = plate.alarms;
    w[36] = plate.warnings;
    w[37] = u16::from(config.endat22) | u16::from(plate.safety) << 2;
    w[39] = config.tcal.div_ceil(US) as u16; // in us: the unit is not published
    w
}

/// The 64 words of the EnDat 2.2 area.
pub(super) fn manufacturer_22(config: &EncoderConfig) -> Vec<u16> {
    let plate = &config.plate;
    let mut w = vec![0; 64];
    (w[0], w[1]) = (plate.infos_1, plate.infos_2);
    (w[9], w[10]) = halves(plate.measuring_steps);
    w[15] = plate.revolutions;
    w[25] = (config.max_clock_hz / 1000) as u16;
    (w[28], w[29]) = halves(plate.measuring_steps);
    w[35] = ErrorSource::ALL.iter().fold(0, |all, s| all | s.bit());
    w[45] = 1; // time stamp in us: an assumption
    w
}

/// Low and high word.
fn halves(value: u32) -> (u16, u16) {
    (value as u16, (value >> 16) as u16)
}
