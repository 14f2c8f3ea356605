//! Which answers a receiver must take, from the description of the frame and a CRC that shares no code with the core.

use crc::{Algorithm, Crc};

/// x^5 + x^3 + x + 1, begun with ones, inverted at the end. This table takes bytes; the bits that a frame has beyond them are in front,
/// so the register begins where they leave it.
const ENDAT: Algorithm<u8> = Algorithm {
    width: 5,
    poly: 0x0B,
    init: 0x1F,
    refin: false,
    refout: false,
    xorout: 0x1F,
    check: 0,
    residue: 0,
};

/// The CRC of these bits, the first one first.
fn crc(bits: &[bool]) -> u8 {
    let (head, tail) = bits.split_at(bits.len() % 8);
    let step = |register: u8, bit: &bool| {
        let feeds = (register >> 4 & 1 == 1) != *bit;
        (register << 1 & 0x1F) ^ if feeds { ENDAT.poly } else { 0 }
    };
    let begun = head.iter().fold(ENDAT.init, step);
    let byte = |bits: &[bool]| bits.iter().fold(0, |byte, bit| byte << 1 | u8::from(*bit));
    let bytes: Vec<u8> = tail.chunks(8).map(byte).collect();
    let crc = Crc::<u8>::new(&ENDAT);
    // The register is begun at the left end of its byte, as the bits come.
    let mut digest = crc.digest_with_initial(begun);
    digest.update(&bytes);
    digest.finalize()
}

/// The position that must be taken from an answer, from F1 to the last bit of the CRC: no alarm, and a CRC that fits.
pub fn position(answer: &[bool], has_f2: bool) -> Option<u64> {
    let errors = 1 + usize::from(has_f2);
    let (covered, sent) = answer.split_at_checked(answer.len().checked_sub(5)?)?;
    let sent = sent.iter().fold(0, |crc, bit| crc << 1 | u8::from(*bit));
    let no_alarm = !*covered.first()? && (!has_f2 || *covered.get(1)?);
    let data = covered.get(errors..)?;
    let value = |data: &[bool]| {
        let bits = data.iter().rev();
        bits.fold(0, |value, bit| value << 1 | u64::from(*bit))
    };
    (no_alarm && crc(covered) == sent).then(|| value(data))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The frame that a published card shows: 37 bits, F1 0, F2 1, CRC 0x19.
    #[test]
    fn the_captured_frame_is_taken_and_no_neighbour_of_it() {
        let mut answer = vec![false, true];
        answer.extend((0..37).map(|i| 0x07_5006_84EFu64 >> i & 1 == 1));
        answer.extend((0..5).rev().map(|i| 0x19 >> i & 1 == 1));
        assert_eq!(position(&answer, true), Some(0x07_5006_84EF));
        for bit in 0..answer.len() {
            let mut other = answer.clone();
            other[bit] = !other[bit];
            assert_eq!(position(&other, true), None, "{bit}");
        }
    }
}
