//! The CRC of EnDat, one bit at a time, as an explanation: shares no code with the core or the bench.
//!
//! ```text
//!        +-----------------+--------+--------- e = ff4 xor bit
//!        v                 v        |
//! ff4 <- ff3 <- (+) <- ff2 <- ff1 <- (+) <- ff0 <- e        (+ = xor e), preset 11111, result inverted
//! ```

use serde::Serialize;
use std::fmt;

/// Most bits that a block may have; the longest EnDat block has 50.
pub const BITS_MAX: usize = 128;

/// One covered bit with its name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CoveredBit {
    /// `F1`, `F2`, `D0` (position LSB) or a number.
    pub name: String,
    /// Its value.
    pub value: u8,
}

/// One step of the register.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Step {
    /// The bit that goes in.
    pub bit: CoveredBit,
    /// `ff4 xor bit`.
    pub feedback: u8,
    /// Register after the step, ff4 first.
    pub register: String,
}

/// How the CRC of a block comes about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Explanation {
    /// Covered bits in the order of transmission.
    pub covered: String,
    /// All steps.
    pub steps: Vec<Step>,
    /// The CRC as a number, ff4 = bit 4.
    pub crc: u8,
    /// The CRC as it is transmitted, first bit first.
    pub crc_bits: String,
    /// Start bit, covered bits and CRC as they stand on the line.
    pub frame: String,
    /// The CRC that was received, if one was given.
    pub received: Option<u8>,
    /// Register after the received CRC has gone through it too; 01000 = good.
    pub residue: String,
}

/// Register after one bit; bit 4 is ff4.
fn step(register: u8, bit: u8) -> u8 {
    let e = (register >> 4 & 1) ^ (bit & 1);
    let shifted = register << 1 & 0b11110;
    shifted ^ (e << 3) ^ (e << 1) ^ e
}

/// Bits of a position block in the order of transmission.
pub fn position_bits(f1: u8, f2: Option<u8>, position: u64, width: u32) -> Vec<CoveredBit> {
    let flag = |name: &str, value: u8| CoveredBit {
        name: name.into(),
        value: value & 1,
    };
    let mut bits = vec![flag("F1", f1)];
    bits.extend(f2.map(|f2| flag("F2", f2)));
    bits.extend((0..width.min(64)).map(|n| flag(&format!("D{n}"), (position >> n & 1) as u8)));
    bits
}

/// Bits written as `0` and `1`, numbered from 1.
pub fn raw_bits(values: &[u8]) -> Vec<CoveredBit> {
    let numbered = values.iter().enumerate();
    numbered
        .map(|(n, value)| CoveredBit {
            name: (n + 1).to_string(),
            value: value & 1,
        })
        .collect()
}

/// Computes the CRC of a block, with every step.
pub fn explain(bits: Vec<CoveredBit>, received: Option<u8>) -> Explanation {
    let covered: String = bits.iter().map(|b| char::from(b'0' + b.value)).collect();
    let mut register = 0b11111;
    let mut steps = Vec::new();
    for bit in bits {
        let feedback = (register >> 4 & 1) ^ bit.value;
        register = step(register, bit.value);
        steps.push(Step {
            bit,
            feedback,
            register: format!("{register:05b}"),
        });
    }
    let crc = !register & 0b11111;
    let crc_bits = format!("{crc:05b}");
    let last = received.unwrap_or(crc);
    let residue = (0..5).rev().fold(register, |r, n| step(r, last >> n & 1));
    Explanation {
        frame: format!("1{covered}{crc_bits}"),
        covered,
        steps,
        crc,
        crc_bits,
        received,
        residue: format!("{residue:05b}"),
    }
}

impl Explanation {
    /// Whether the received CRC, if any, is right.
    pub fn is_good(&self) -> bool {
        self.received.is_none_or(|r| r == self.crc)
    }
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "CRC5 of EnDat: x^5 + x^3 + x + 1, register ff4..ff0 preset to 11111, result inverted."
        )?;
        writeln!(f, "e = ff4 xor bit; then ff4 = ff3, ff3 = ff2 xor e, ff2 = ff1, ff1 = ff0 xor e, ff0 = e.")?;
        writeln!(f)?;
        writeln!(f, "  bit  value  e  register")?;
        writeln!(f, "                 11111")?;
        for step in &self.steps {
            writeln!(
                f,
                "{:>5}      {}  {}  {}",
                step.bit.name, step.bit.value, step.feedback, step.register
            )?;
        }
        writeln!(f)?;
        writeln!(
            f,
            "covered bits       {} ({} bits, order of transmission; the start bit is not covered)",
            self.covered,
            self.steps.len()
        )?;
        writeln!(
            f,
            "CRC                0x{:02X} = inverted register",
            self.crc
        )?;
        writeln!(f, "transmitted        {} (ff4 first)", self.crc_bits)?;
        writeln!(f, "start bit to CRC   {}", self.frame)?;
        match self.received {
            None => writeln!(
                f,
                "receiver's check   register after the CRC itself: {} (01000 = good)",
                self.residue
            ),
            Some(received) => {
                let verdict = if self.is_good() { "good" } else { "WRONG" };
                writeln!(f, "received           0x{received:02X}: {verdict}; register after it: {} (01000 = good)", self.residue)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same CRC by the `crc` crate, which works on bytes: zeros in front, from the preset that they turn into 11111.
    fn by_crate(bits: &[CoveredBit]) -> u8 {
        let algorithm = crc::Algorithm::<u8> {
            width: 5,
            poly: 0x0B,
            init: 0x1F,
            refin: false,
            refout: false,
            xorout: 0x1F,
            check: 0,
            residue: 0,
        };
        // Leaked once for each call: the crate wants the algorithm to live for ever.
        let crc = crc::Crc::<u8>::new(Box::leak(Box::new(algorithm)));
        let pad = (8 - bits.len() % 8) % 8;
        let start = (0..32u8)
            .find(|s| (0..pad).fold(*s, |r, _| step(r, 0)) == 0x1F)
            .unwrap();
        let mut all = vec![0u8; pad];
        all.extend(bits.iter().map(|b| b.value));
        let bytes: Vec<u8> = all
            .chunks(8)
            .map(|c| c.iter().fold(0, |byte, bit| byte << 1 | bit))
            .collect();
        let mut digest = crc.digest_with_initial(start);
        digest.update(&bytes);
        digest.finalize()
    }

    proptest::proptest! {
        #[test]
        fn equals_the_crc_crate(f1 in 0u8..2, f2 in proptest::option::of(0u8..2), position: u64, width in 1u32..=64) {
            let bits = position_bits(f1, f2, position, width);
            let expected = by_crate(&bits);
            let got = explain(bits, None);
            proptest::prop_assert_eq!(got.crc, expected);
            proptest::prop_assert_eq!(got.residue, "01000");
        }

        #[test]
        fn every_wrong_crc_leaves_another_residue(position: u64, wrong in 1u8..32) {
            let good = explain(position_bits(0, Some(1), position, 37), None);
            let bad = explain(position_bits(0, Some(1), position, 37), Some(good.crc ^ wrong));
            proptest::prop_assert!(!bad.is_good());
            proptest::prop_assert_ne!(bad.residue, "01000");
        }
    }

    #[test]
    fn the_captured_frame_of_a_real_encoder_checks() {
        let real = explain(position_bits(0, Some(1), 0x7_5006_84EF, 37), Some(0x19));
        assert_eq!(real.frame, "101111101110010000101100000000010101110011001");
        assert!(real.is_good());
    }

    #[test]
    fn a_zero_word_of_31_bits_gives_01010() {
        assert_eq!(explain(raw_bits(&[0; 31]), None).crc_bits, "01010");
    }
}
