//! Properties of each mode command for the receiver.

use crate::frame::crc5;

const PARAMETER_COMMANDS: [u8; 6] = [
    0b001_110, 0b011_100, 0b100_011, 0b101_010, 0b110_001, 0b010_010,
];
const SUPPLEMENT_COMMANDS: [u8; 5] = [0b001_001, 0b011_011, 0b100_100, 0b101_101, 0b110_110];
const TEST_VALUES: u8 = 0b010_101;

/// True if 8 and 16 bits follow the six of the command.
pub fn has_parameter(code: u64) -> bool {
    PARAMETER_COMMANDS.contains(&(code as u8))
}

/// True if 8 and 16 bits follow the answer.
pub fn has_supplement(code: u64) -> bool {
    SUPPLEMENT_COMMANDS.contains(&(code as u8))
}

pub fn has_f2(code: u64) -> bool {
    code == 0b111_000 || has_supplement(code)
}

/// Bits of the answer before additional data, without start bit and CRC.
pub fn payload_bits(code: u64, position_bits: usize) -> usize {
    match code as u8 {
        TEST_VALUES => 41,
        _ if has_parameter(code) => 24,
        _ => 1 + usize::from(has_f2(code)) + position_bits,
    }
}

/// Level of DATA after falling edge `k` of a supplement (1 = first); `None` = released.
pub fn supplement_bit(k: u32, address: u64, parameter: u64) -> Option<bool> {
    let fields = address << 16 | parameter;
    match k {
        1..=7 => Some(false),
        8 => Some(true),
        9..=32 => Some(fields >> (32 - k) & 1 != 0),
        _ => None,
    }
}

/// Covered bits as a number, MSB first, and whether the five bits after them are their CRC.
pub fn block(bits: &[bool]) -> (u128, bool) {
    let number = |bits: &[bool]| bits.iter().fold(0u128, |n, b| n << 1 | u128::from(*b));
    let (covered, crc) = bits.split_at(bits.len() - 5);
    let computed = crc5(covered.iter().copied());
    (number(covered), u128::from(computed) == number(crc))
}
