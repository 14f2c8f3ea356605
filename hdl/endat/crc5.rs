//! CRC5 of EnDat (x^5+x^3+x+1, preset 11111, inverted), parallel: of an answer while it is received, of the stored word, and of a fixed length.
//!
//! Every form derives from one definition, the residues of powers of x. The order of x modulo the generator is 15,
//! so the contribution of a bit depends only on its distance from the last covered bit, modulo 15. Zeros above the frame
//! contribute nothing. The preset contributes one of 15 constants, chosen by the number of covered bits modulo 15.
//! So a run-time length costs hardly more than a fixed one.
//!
//! Ref: TI motor-control SDK (polynomial, order of the bits); Liu et al., "Angle encoder data acquisition system
//! based on FPGA", 2024 (five equations for 31 bits, equal to the result of this block for that length).

use crate::protocol::{CRC5_POLYNOMIAL, CRC5_PRESET};
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
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

/// Contribution of a covered bit to the CRC when `distance` more covered bits follow it.
pub const fn contribution(distance: usize) -> u8 {
    times_x_power(CRC5_POLYNOMIAL, distance)
}

/// Contribution of preset and inversion to the CRC of `covered_bits` bits.
pub const fn constant_term(covered_bits: usize) -> u8 {
    times_x_power(CRC5_PRESET, covered_bits) ^ 0x1F
}

/// The bits of a word of `width` bits that bit `crc_bit` of the CRC depends on; the top bit of the word was received last.
pub fn parity_mask(crc_bit: usize, width: usize) -> u128 {
    (0..width)
        .filter(|i| contribution(width - 1 - i) >> crc_bit & 1 == 1)
        .fold(0, |mask, i| mask | 1 << i)
}

/// Parallel CRC5 of a word whose last bit has just entered at place 4, 19, 34 or 49, with zeros below its first bit.
///
/// The contribution of a bit depends on its distance from the last one, modulo 15; the last bit is at place 4, modulo 15. So the word folded to
/// 15 bits gives five parities, equal for every width, and preset and inversion add one of 15 constants.
#[derive(LogicBlock, Block)]
pub struct Crc5Word {
    /// The word, its last bit at one of the four places.
    pub word: Signal<In, Bits<50>>,
    /// Number of its bits modulo 15, 0..=14.
    pub covered: Signal<In, Bits<4>>,
    /// The CRC as transmitted; bit 4 goes first.
    pub crc: Signal<Out, Bits<5>>,
    mask: Vec<Constant<Bits<15>>>,
    weight: Vec<Constant<Bits<5>>>,
    constant: Vec<Constant<Bits<5>>>,
    /// The word folded to 15 bits.
    folded: Signal<Local, Bits<15>>,
    /// Partial sum of the CRC.
    sum: Signal<Local, Bits<5>>,
}

/// Place where a word's last bit enters, modulo the order of x.
const LAST_PLACE: usize = 4;

impl Default for Crc5Word {
    fn default() -> Self {
        let distance = |place: usize| (LAST_PLACE + ORDER_OF_X - place) % ORDER_OF_X;
        let mask = |crc_bit: usize| {
            let bits = (0..ORDER_OF_X).filter(|i| contribution(distance(*i)) >> crc_bit & 1 == 1);
            Constant::new(bits.fold(0u64, |mask, i| mask | 1 << i).into())
        };
        Self::from_parts(Crc5WordParts {
            mask: (0..5).map(mask).collect(),
            weight: crc_bit_weights(),
            constant: (0..ORDER_OF_X)
                .map(|covered| Constant::new(u64::from(constant_term(covered)).into()))
                .collect(),
        })
    }
}

#[kernel]
impl Logic for Crc5Word {
    fn update(&mut self) {
        self.folded.next = self.word.val().get_bits::<15>(0)
            ^ self.word.val().get_bits::<15>(15)
            ^ self.word.val().get_bits::<15>(30)
            ^ bit_cast::<15, 5>(self.word.val().get_bits::<5>(45));
        match self.covered.val().index() {
            0 => {
                self.sum.next = self.constant[0].val();
            }
            1 => {
                self.sum.next = self.constant[1].val();
            }
            2 => {
                self.sum.next = self.constant[2].val();
            }
            3 => {
                self.sum.next = self.constant[3].val();
            }
            4 => {
                self.sum.next = self.constant[4].val();
            }
            5 => {
                self.sum.next = self.constant[5].val();
            }
            6 => {
                self.sum.next = self.constant[6].val();
            }
            7 => {
                self.sum.next = self.constant[7].val();
            }
            8 => {
                self.sum.next = self.constant[8].val();
            }
            9 => {
                self.sum.next = self.constant[9].val();
            }
            10 => {
                self.sum.next = self.constant[10].val();
            }
            11 => {
                self.sum.next = self.constant[11].val();
            }
            12 => {
                self.sum.next = self.constant[12].val();
            }
            13 => {
                self.sum.next = self.constant[13].val();
            }
            _ => {
                self.sum.next = self.constant[14].val();
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

/// Parallel CRC5 check of the stored word, first bit at bit 0, of any width: the guard in addition to [`Crc5Word`].
///
/// A CRC counts distances from the last bit, the stored word from the first one. So both sides of the equation are divided by the power of x
/// between the two. The word's side becomes five fixed parities (folded to 15 bits, the order of x). The received CRC bits
/// are added as they arrive, each with its power of 1/x, which advances with each bit of the answer.
#[derive(LogicBlock, Block)]
pub struct Crc5Check {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: a new answer begins.
    pub clear: Signal<In, Bit>,
    /// Strobe: a bit of the word has been sampled.
    pub word_bit: Signal<In, Bit>,
    /// Strobe: `bit` is the next one of the received CRC.
    pub crc_bit: Signal<In, Bit>,
    /// The sample.
    pub bit: Signal<In, Bit>,
    /// The word, bit 0 = the bit received first, zeros above its width.
    pub word: Signal<In, Bits<48>>,
    /// The answer begins with F1.
    pub has_f1: Signal<In, Bit>,
    /// F2 follows it.
    pub has_f2: Signal<In, Bit>,
    /// Error bit 1.
    pub f1: Signal<In, Bit>,
    /// Error bit 2.
    pub f2: Signal<In, Bit>,
    /// Word, error bits and received CRC are consistent.
    pub is_ok: Signal<Out, Bit>,
    /// Power of 1/x for the next bit of the answer; 1 at the beginning of an answer.
    #[start(1.into())]
    power: Reg<Bits<5>>,
    /// Sum of the received CRC bits, each times its power of 1/x.
    received: Reg<Bits<5>>,
    mask: Vec<Constant<Bits<15>>>,
    weight: Vec<Constant<Bits<5>>>,
    term: Vec<Constant<Bits<5>>>,
    /// Contribution of a set error bit next to the word.
    first: Constant<Bits<5>>,
    /// Contribution of a set F1 if F2 follows.
    second: Constant<Bits<5>>,
    /// 1/x modulo the generator.
    step: Constant<Bits<5>>,
    /// Power of 1/x for the first bit of an answer.
    one: Constant<Bits<5>>,
    /// The word folded to 15 bits.
    folded: Signal<Local, Bits<15>>,
    /// Sum over preset, error bits and word; equal to `received` if they are consistent.
    sum: Signal<Local, Bits<5>>,
}

/// `value / x^power` modulo the generator.
const fn divided_by_x_power(value: u8, power: usize) -> u8 {
    times_x_power(value, ORDER_OF_X - power % ORDER_OF_X)
}

impl Default for Crc5Check {
    fn default() -> Self {
        let mask = |crc_bit: usize| {
            let bits = (0..ORDER_OF_X).filter(|i| divided_by_x_power(1, *i) >> crc_bit & 1 == 1);
            Constant::new(bits.fold(0u64, |mask, i| mask | 1 << i).into())
        };
        let constant = |value: u8| Constant::new(u64::from(value).into());
        Self::from_parts(Crc5CheckParts {
            mask: (0..5).map(mask).collect(),
            weight: crc_bit_weights(),
            // The preset in front of 0, 1 or 2 error bits.
            term: (0..3)
                .map(|error_bits| constant(divided_by_x_power(CRC5_PRESET, 4 - error_bits)))
                .collect(),
            first: constant(times_x_power(1, 1)),
            second: constant(times_x_power(1, 2)),
            step: constant(divided_by_x_power(1, 1)),
            one: constant(1),
        })
    }
}

#[kernel]
impl Logic for Crc5Check {
    fn update(&mut self) {
        if self.word_bit.val() | self.crc_bit.val() {
            self.power.d.next = self.power.q.val() >> 1;
            if self.power.q.val().get_bit(0) {
                self.power.d.next = (self.power.q.val() >> 1) ^ self.step.val();
            }
        }
        // The CRC is sent inverted.
        if self.crc_bit.val() & !self.bit.val() {
            self.received.d.next = self.received.q.val() ^ self.power.q.val();
        }
        if self.clear.val() {
            self.power.d.next = self.one.val();
            self.received.d.next = 0.into();
        }

        self.folded.next = self.word.val().get_bits::<15>(0)
            ^ self.word.val().get_bits::<15>(15)
            ^ self.word.val().get_bits::<15>(30)
            ^ bit_cast::<15, 3>(self.word.val().get_bits::<3>(45));
        self.sum.next = self.term[0].val();
        if self.has_f1.val() {
            self.sum.next = self.term[1].val();
            if self.f1.val() {
                self.sum.next = self.term[1].val() ^ self.first.val();
            }
            if self.has_f2.val() {
                self.sum.next = self.term[2].val();
                if self.f1.val() {
                    self.sum.next = self.term[2].val() ^ self.second.val();
                }
                if self.f2.val() {
                    self.sum.next = self.sum.val() ^ self.first.val();
                }
            }
        }
        for i in 0..5 {
            if (self.folded.val() & self.mask[i].val()).xor() {
                self.sum.next = self.sum.val() ^ self.weight[i].val();
            }
        }
        self.is_ok.next = self.sum.val() == self.received.q.val();
    }
}

fn crc_bit_weights() -> Vec<Constant<Bits<5>>> {
    (0..5).map(|i| Constant::new((1u64 << i).into())).collect()
}

/// Parallel CRC5 of exactly `N` bits: five XOR equations.
#[derive(LogicBlock, Block)]
pub struct Crc5Fixed<const N: usize> {
    /// The covered bits; the top one was received first, as in the published equations.
    pub word: Signal<In, Bits<N>>,
    /// The CRC as transmitted; bit 4 goes first.
    pub crc: Signal<Out, Bits<5>>,
    mask: Vec<Constant<Bits<N>>>,
    weight: Vec<Constant<Bits<5>>>,
    /// Contribution of preset and inversion.
    constant: Constant<Bits<5>>,
    /// Partial sum of the CRC.
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
        Self::from_parts(Crc5FixedParts {
            mask: (0..5).map(mask).collect(),
            weight: crc_bit_weights(),
            constant: Constant::new(u64::from(constant_term(N)).into()),
        })
    }
}

#[kernel]
impl<const N: usize> Logic for Crc5Fixed<N> {
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
