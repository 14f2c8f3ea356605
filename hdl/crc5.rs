//! CRC5 of EnDat (x^5+x^3+x+1, preset 11111, inverted): parallel in two forms, and serial as the cross-check.
//!
//! Every form comes from one definition, the residues of powers of x. The order of x modulo the generator is 15,
//! so what a bit contributes depends only on its distance from the last covered bit, modulo 15; zeros above the frame
//! contribute nothing; and the preset contributes one of 15 constants, chosen by the number of covered bits modulo 15.
//! That makes the run-time length nearly as cheap as a fixed one.
//!
//! Ref: TI motor-control SDK (polynomial, order of the bits); Liu et al., "Angle encoder data acquisition system
//! based on FPGA", 2024 (five equations for 31 bits, equal to [`Crc5Fixed`] of that length).

use crate::protocol::{CRC5_POLYNOMIAL, CRC5_PRESET};
use crate::reg::Reg;
use rust_hdl::prelude::*;

/// The smallest `k > 0` with `x^k = 1` modulo the generator.
pub const ORDER_OF_X: usize = 15;
/// Covered bits of the widest frame: F1, F2 and 48 position bits.
pub const MAX_COVERED_BITS: usize = 50;

/// `register * x` modulo the generator.
const fn times_x(register: u8) -> u8 {
    let shifted = (register << 1) & 0x1F;
    if register & 0x10 != 0 {
        shifted ^ CRC5_POLYNOMIAL
    } else {
        shifted
    }
}

/// `register * x^power` modulo the generator.
pub const fn times_x_power(register: u8, power: usize) -> u8 {
    let mut r = register;
    let mut i = 0;
    while i < power % ORDER_OF_X {
        r = times_x(r);
        i += 1;
    }
    r
}

/// What a covered bit adds to the CRC when `distance` more covered bits follow it.
pub const fn contribution(distance: usize) -> u8 {
    times_x_power(CRC5_POLYNOMIAL, distance)
}

/// What preset and inversion add to the CRC of `covered_bits` bits.
pub const fn constant_term(covered_bits: usize) -> u8 {
    times_x_power(CRC5_PRESET, covered_bits) ^ 0x1F
}

/// The bits of a word of `width` bits that bit `crc_bit` of the CRC depends on; the top bit of the word was received last.
pub fn parity_mask(crc_bit: usize, width: usize) -> u128 {
    (0..width)
        .filter(|i| contribution(width - 1 - i) >> crc_bit & 1 == 1)
        .fold(0, |mask, i| mask | 1 << i)
}

/// Parallel CRC5 of up to 50 bits, the number of which is known at run time only.
///
/// Bits 15 places apart contribute the same, so the word is folded to 15 bits before the five parities.
#[derive(LogicBlock)]
pub struct Crc5Parallel {
    /// The covered bits, the last received one at the top or a multiple of 15 places below it, zeros elsewhere.
    pub word: Signal<In, Bits<50>>,
    /// Number of covered bits, modulo 15.
    pub covered_mod_15: Signal<In, Bits<4>>,
    /// The CRC as transmitted; bit 4 goes first.
    pub crc: Signal<Out, Bits<5>>,
    mask: Vec<Constant<Bits<15>>>,
    weight: Vec<Constant<Bits<5>>>,
    length: Vec<Constant<Bits<4>>>,
    term: Vec<Constant<Bits<5>>>,
    folded: Signal<Local, Bits<15>>,
    sum: Signal<Local, Bits<5>>,
}

impl Default for Crc5Parallel {
    fn default() -> Self {
        let mask = |crc_bit| Constant::new((parity_mask(crc_bit, ORDER_OF_X) as u64).into());
        Self {
            word: Default::default(),
            covered_mod_15: Default::default(),
            crc: Default::default(),
            mask: (0..5).map(mask).collect(),
            weight: crc_bit_weights(),
            length: (0..ORDER_OF_X)
                .map(|n| Constant::new((n as u64).into()))
                .collect(),
            term: (0..ORDER_OF_X)
                .map(|n| Constant::new(u64::from(constant_term(n)).into()))
                .collect(),
            folded: Default::default(),
            sum: Default::default(),
        }
    }
}

impl Logic for Crc5Parallel {
    #[hdl_gen]
    fn update(&mut self) {
        self.folded.next = self.word.val().get_bits::<15>(35)
            ^ self.word.val().get_bits::<15>(20)
            ^ self.word.val().get_bits::<15>(5)
            ^ (bit_cast::<15, 5>(self.word.val().get_bits::<5>(0)) << 10);
        self.sum.next = 0.into();
        for i in 0..15 {
            if self.covered_mod_15.val() == self.length[i].val() {
                self.sum.next = self.term[i].val();
            }
        }
        for i in 0..5 {
            if (self.folded.val() & self.mask[i].val()).xor() {
                self.sum.next = self.sum.val() ^ self.weight[i].val();
            }
        }
        self.crc.next = self.sum.val();
    }
}

fn crc_bit_weights() -> Vec<Constant<Bits<5>>> {
    (0..5).map(|i| Constant::new((1u64 << i).into())).collect()
}

/// Parallel CRC5 of exactly `N` bits: five XOR equations.
#[derive(LogicBlock)]
pub struct Crc5Fixed<const N: usize> {
    /// The covered bits; the top one was received first, as the published equations have it.
    pub word: Signal<In, Bits<N>>,
    /// The CRC as transmitted; bit 4 goes first.
    pub crc: Signal<Out, Bits<5>>,
    mask: Vec<Constant<Bits<N>>>,
    weight: Vec<Constant<Bits<5>>>,
    constant: Constant<Bits<5>>,
    sum: Signal<Local, Bits<5>>,
}

impl<const N: usize> Default for Crc5Fixed<N> {
    fn default() -> Self {
        let mask = |crc_bit: usize| {
            let mut bits = Bits::<N>::default();
            for i in 0..N {
                bits = bits.replace_bit(i, contribution(i) >> crc_bit & 1 == 1);
            }
            Constant::new(bits)
        };
        Self {
            word: Default::default(),
            crc: Default::default(),
            mask: (0..5).map(mask).collect(),
            weight: crc_bit_weights(),
            constant: Constant::new(u64::from(constant_term(N)).into()),
            sum: Default::default(),
        }
    }
}

impl<const N: usize> Logic for Crc5Fixed<N> {
    #[hdl_gen]
    fn update(&mut self) {
        self.sum.next = self.constant.val();
        for i in 0..5 {
            if (self.word.val() & self.mask[i].val()).xor() {
                self.sum.next = self.sum.val() ^ self.weight[i].val();
            }
        }
        self.crc.next = self.sum.val();
    }
}

/// Serial CRC5 register: takes the covered bits and then the received CRC itself.
#[derive(LogicBlock)]
pub struct Crc5Serial {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: back to the preset.
    pub clear: Signal<In, Bit>,
    /// Strobe: take `bit`.
    pub enable: Signal<In, Bit>,
    /// The next bit, in the order received.
    pub bit: Signal<In, Bit>,
    /// The frame taken so far ends in its own, right CRC.
    pub residue_ok: Signal<Out, Bit>,
    register: Reg<Bits<5>>,
    shifted: Signal<Local, Bits<5>>,
    polynomial: Constant<Bits<5>>,
    residue: Constant<Bits<5>>,
}

impl Default for Crc5Serial {
    fn default() -> Self {
        Self {
            clock: Default::default(),
            reset: Default::default(),
            clear: Default::default(),
            enable: Default::default(),
            bit: Default::default(),
            residue_ok: Default::default(),
            register: Reg::new(u64::from(CRC5_PRESET).into()),
            shifted: Default::default(),
            polynomial: Constant::new(u64::from(CRC5_POLYNOMIAL).into()),
            residue: Constant::new(u64::from(crate::protocol::CRC5_RESIDUE).into()),
        }
    }
}

impl Logic for Crc5Serial {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, register);
        self.register.reset.next = self.reset.val();
        self.shifted.next = self.register.q.val() << 1;
        if self.enable.val() {
            self.register.d.next = self.shifted.val();
            if self.register.q.val().get_bit(4) ^ self.bit.val() {
                self.register.d.next = self.shifted.val() ^ self.polynomial.val();
            }
        }
        if self.clear.val() {
            self.register.d.next = 31.into();
        }
        self.residue_ok.next = self.register.q.val() == self.residue.val();
    }
}
