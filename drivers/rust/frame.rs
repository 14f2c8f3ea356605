//! Check sums, bit by bit: without tables, to save memory.

/// First value of [`crc16`].
pub(crate) const CRC16_START: u16 = 0xFFFF;

/// CRC-16/CCITT-FALSE, for SPI frames and sets of the stream.
pub(crate) fn crc16(start: u16, bytes: &[u8]) -> u16 {
    let bit = |sum: u16, _| match sum & 0x8000 {
        0 => sum << 1,
        _ => sum << 1 ^ 0x1021,
    };
    let byte = |sum: u16, byte: &u8| (0..8).fold(sum ^ u16::from(*byte) << 8, bit);
    bytes.iter().fold(start, byte)
}

/// CRC5 of EnDat over bits in the order received; answers need not be whole bytes.
pub(crate) fn crc5(bits: impl Iterator<Item = bool>) -> u32 {
    let step = |register: u32, bit: bool| {
        let feedback = (register >> 4 & 1 == 1) != bit;
        (register << 1 & 0x1F) ^ if feedback { 0x0B } else { 0 }
    };
    bits.fold(0x1F, step) ^ 0x1F
}
