//! One block of configuration words on the ring: three words; each step moves a byte out at the front and another in at the end.
//!
//! ```text
//!             +--------------------------- byte ring, one step in each cycle with `turn` ---------------------------+
//!             v                                                                                                     |
//! head <- [card block: word 0 .. 2] <- [channel 0: word 0 .. 2] <- ... <- [last channel] <- head, or a written byte +
//! ```
//!
//! A turn moves every byte past the one head that reads and writes, so there is no read multiplexer and no write decoder. The words are
//! in place only while the ring is at rest, so the blocks use copies that are taken then.
//! <!-- with has_guards -->
//!
//! Each byte is stored with its parity from the write: a bit inverted by an upset is detected until the byte is written again.
//! <!-- end -->

use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Words in a block.
pub const RING_WORDS: usize = 3;
/// Bytes in a block, most significant byte of word 0 first.
pub const RING_BYTES: usize = 4 * RING_WORDS;

/// Three configuration words on the byte ring.
#[derive(LogicBlock, Block)]
pub struct ConfigRing {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset: the words return to their start values.
    pub reset: Signal<In, Bit>,
    /// The ring advances by one byte.
    pub turn: Signal<In, Bit>,
    /// Byte from the following block, its parity in bit 8.
    pub byte_in: Signal<In, Bits<9>>,
    /// Byte to the previous block: the most significant one of word 0.
    pub byte_out: Signal<Out, Bits<9>>,
    /// Word 0, while the ring is at rest.
    pub word0: Signal<Out, Bits<32>>,
    /// Word 1, while the ring is at rest.
    pub word1: Signal<Out, Bits<32>>,
    /// Word 2, while the ring is at rest.
    pub word2: Signal<Out, Bits<32>>,
    /// The words differ from the written ones, as of the last cycle in which the ring was at rest.
    pub is_damaged: Signal<Out, Bit>,
    /// Word 0 while the ring is at rest; its top byte leaves first.
    #[given]
    w0: Reg<Bits<32>>,
    /// Word 1 while the ring is at rest.
    #[given]
    w1: Reg<Bits<32>>,
    /// Word 2 while the ring is at rest; bytes enter at its low end.
    #[given]
    w2: Reg<Bits<32>>,
    /// Parity of each of the twelve bytes, in the same order; 0 without guards.
    #[given]
    parities: Reg<Bits<12>>,
    /// High if the words do not match their parities; computed while the ring is at rest.
    damaged: Reg<Bit>,
    /// 1 if each byte has a parity.
    has_guards: Constant<Bit>,
}

impl ConfigRing {
    /// A block that holds `start` after reset.
    pub fn new(start: [u32; RING_WORDS], guards: bool) -> Self {
        let word = |value: u32| Reg::new(u64::from(value).into());
        let bytes = start.into_iter().flat_map(u32::to_be_bytes);
        let parities = bytes.fold(0, |all, byte| all << 1 | u64::from(byte.count_ones() & 1));
        Self::from_parts(ConfigRingParts {
            has_guards: Constant::new(guards),
            parities: Reg::new(if guards { parities } else { 0 }.into()),
            w0: word(start[0]),
            w1: word(start[1]),
            w2: word(start[2]),
        })
    }
}

#[kernel]
impl Logic for ConfigRing {
    fn update(&mut self) {
        if self.turn.val() {
            self.w0.d.next =
                (self.w0.q.val() << 8) | bit_cast::<32, 8>(self.w1.q.val().get_bits::<8>(24));
            self.w1.d.next =
                (self.w1.q.val() << 8) | bit_cast::<32, 8>(self.w2.q.val().get_bits::<8>(24));
            self.w2.d.next =
                (self.w2.q.val() << 8) | bit_cast::<32, 8>(self.byte_in.val().get_bits::<8>(0));
            if self.has_guards.val() {
                self.parities.d.next = (self.parities.q.val() << 1)
                    | bit_cast::<12, 1>(self.byte_in.val().get_bits::<1>(8));
            }
        } else if self.has_guards.val() {
            self.damaged.d.next = self.w0.q.val().xor()
                ^ self.w1.q.val().xor()
                ^ self.w2.q.val().xor()
                ^ self.parities.q.val().xor();
        }
        self.is_damaged.next = self.damaged.q.val();
        self.byte_out.next = bit_cast::<9, 8>(self.w0.q.val().get_bits::<8>(24))
            | (bit_cast::<9, 1>(self.parities.q.val().get_bits::<1>(11)) << 8);
        self.word0.next = self.w0.q.val();
        self.word1.next = self.w1.q.val();
        self.word2.next = self.w2.q.val();
    }
}
