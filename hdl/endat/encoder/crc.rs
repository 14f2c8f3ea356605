//! Serial CRC5 of an answer (x^5+x^3+x+1, preset 11111, inverted), formed bit by bit as the answer is sent.
//!
//! The receiver's CRC ([`crate::endat::crc5`]) is parallel and shares only the polynomial, so that each checks the other.
//!
//! Ref: TI motor-control SDK (polynomial, order of the bits).

use crate::protocol::{CRC5_POLYNOMIAL, CRC5_PRESET};
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// CRC5 of the bits that an encoder sends, and its shift register.
#[derive(LogicBlock, Block)]
pub struct SerialCrc {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: a new answer begins.
    pub clear: Signal<In, Bit>,
    /// Strobe: the CRC covers `bit`.
    pub covers: Signal<In, Bit>,
    /// The bit that is sent.
    pub bit: Signal<In, Bit>,
    /// Strobe: `crc_bit` is sent; the next one follows.
    pub shift: Signal<In, Bit>,
    /// Next bit of the CRC, the most significant one first.
    pub crc_bit: Signal<Out, Bit>,
    /// Remainder of the bits so far; while the CRC is sent its bits that are still to come.
    #[given]
    remainder: Reg<Bits<5>>,
    /// Remainder before the first bit.
    preset: Constant<Bits<5>>,
    /// Generator polynomial without its leading term.
    polynomial: Constant<Bits<5>>,
    /// Remainder times x.
    shifted: Signal<Local, Bits<5>>,
}

impl Default for SerialCrc {
    fn default() -> Self {
        let preset: Bits<5> = u64::from(CRC5_PRESET).into();
        Self::from_parts(SerialCrcParts {
            remainder: Reg::new(preset),
            preset: Constant::new(preset),
            polynomial: Constant::new(u64::from(CRC5_POLYNOMIAL).into()),
        })
    }
}

#[kernel]
impl Logic for SerialCrc {
    fn update(&mut self) {
        self.shifted.next = self.remainder.q.val() << 1;
        if self.shift.val() {
            self.remainder.d.next = self.shifted.val();
        }
        if self.covers.val() {
            self.remainder.d.next = self.shifted.val();
            if self.remainder.q.val().get_bit(4) ^ self.bit.val() {
                self.remainder.d.next = self.shifted.val() ^ self.polynomial.val();
            }
        }
        if self.clear.val() {
            self.remainder.d.next = self.preset.val();
        }
        self.crc_bit.next = !self.remainder.q.val().get_bit(4);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::tick;

    /// Sends these bits and their CRC.
    fn crc_of(block: &mut SerialCrc, bits: &[bool]) -> u8 {
        let step = |block: &mut SerialCrc| tick(block, |b, level| b.clock.next = level.into());
        block.clear.next = true;
        step(block);
        block.clear.next = false;
        for bit in bits {
            block.covers.next = true;
            block.bit.next = *bit;
            step(block);
        }
        block.covers.next = false;
        block.shift.next = true;
        (0..5).fold(0, |crc, _| {
            let bit = block.crc_bit.val();
            step(block);
            crc << 1 | u8::from(bit)
        })
    }

    /// A frame of a real encoder (TI's capture): F1, F2 and 37 bits have the CRC 11001.
    #[test]
    fn crc_is_that_of_a_captured_frame() {
        let mut block = SerialCrc::default();
        block.connect_all();
        let position = 0x7_5006_84EF_u64;
        let mut bits = vec![false, true];
        bits.extend((0..37).map(|i| position >> i & 1 == 1));
        assert_eq!(crc_of(&mut block, &bits), 0b11001);
        // The next answer begins anew.
        assert_eq!(crc_of(&mut block, &bits), 0b11001);
    }

    #[test]
    fn crc_is_that_of_an_independent_program() {
        const ENDAT: crc::Algorithm<u8> = crc::Algorithm {
            width: 5,
            poly: CRC5_POLYNOMIAL,
            init: CRC5_PRESET,
            refin: false,
            refout: false,
            xorout: 0x1F,
            check: 0,
            residue: 0,
        };
        let whole = crc::Crc::<u8>::new(&ENDAT);
        let mut block = SerialCrc::default();
        block.connect_all();
        for seed in 0..40u64 {
            let bytes = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).to_be_bytes();
            let bits: Vec<bool> = (0..64)
                .map(|i| bytes[i / 8] >> (7 - i % 8) & 1 == 1)
                .collect();
            assert_eq!(crc_of(&mut block, &bits), whole.checksum(&bytes), "{seed}");
        }
    }
}
