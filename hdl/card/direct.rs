//! Direct outputs: the position of a channel for logic in the same device, such as a current loop, without a bus.
//!
//! ```text
//! result's position --(one bit a cycle, from first_bit on)--> shift register --(32 cycles later)--> position, fresh
//! result's cause, alarm --(error_causes)--> error
//! ```
//!
//! The bits are taken one after the other, because a shifter for any number of bits takes as much logic as the rest of the block. A
//! frame takes longer than 32 cycles, so the next result always comes later.

use crate::regs::{DIRECT, ERROR_CAUSES};
use endat_macros::kernel;
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;

/// Cycles from a result's strobe to its cropped position.
pub const CROP_CYCLES: u64 = 33;

/// Direct outputs of one channel.
#[derive(LogicBlock, Block)]
pub struct DirectOutput {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: a new result is valid.
    pub result_strobe: Signal<In, Bit>,
    /// Last good position.
    pub position: Signal<In, Bits<48>>,
    /// The last result brought the position.
    pub fresh: Signal<In, Bit>,
    /// Primary cause of the last result.
    pub cause: Signal<In, Bits<5>>,
    /// The channel's alarm.
    pub alarm: Signal<In, Bit>,
    /// Word address of an access.
    pub word_address: Signal<In, Bits<11>>,
    /// The front's address fits `word_address`.
    pub in_range: Signal<In, Bit>,
    /// Byte of the word, 0 = most significant.
    pub lane: Signal<In, Bits<2>>,
    /// One-cycle strobe: write the word.
    pub write: Signal<In, Bit>,
    /// Word to write.
    pub write_data: Signal<In, Bits<32>>,
    /// Byte of the word, a cycle after its address; 0 for words of other blocks.
    pub read_byte: Signal<Out, Bits<8>>,
    /// Cropped position, zeros above its length.
    pub direct_position: Signal<Out, Bits<32>>,
    /// `direct_position` belongs to the last result; low from a result until its position is cropped, and after a bad one.
    pub direct_valid: Signal<Out, Bit>,
    /// Strobe: `direct_position` is new.
    pub direct_fresh: Signal<Out, Bit>,
    /// The cause of the last result is selected, or the alarm is selected and set.
    pub direct_error: Signal<Out, Bit>,
    /// Lowest bit of the cropped position; written by the host.
    first_bit: Reg<Bits<6>>,
    /// Length of the cropped position; written by the host.
    #[given]
    length_bits: Reg<Bits<6>>,
    /// Causes that raise the error output, bit 0 the alarm; written by the host.
    #[start(u64::from(ERROR_CAUSES).into())]
    error_causes: Reg<Bits<32>>,
    /// Byte for the host; 0 for words of other blocks.
    byte_read: Reg<Bits<8>>,
    /// Bits of the cropped position so far; they enter at the top.
    bits: Reg<Bits<32>>,
    /// Cropped position at the output.
    shown: Reg<Bits<32>>,
    /// Bit of the position that is taken next; stops at 63.
    at: Reg<Bits<6>>,
    /// Bits of the cropped position taken so far.
    taken: Reg<Bits<6>>,
    /// High while a position is cropped.
    running: Reg<Bit>,
    /// High if the cropped position belongs to the last result; cleared by a result.
    cropped: Reg<Bit>,
    /// High for one cycle when the cropped position is new.
    strobe: Reg<Bit>,
    /// High if the last result counts as an error.
    error: Reg<Bit>,
    /// Position, with zeros up to bit 63.
    wide: Signal<Local, Bits<64>>,
    /// Bit that is taken; 0 beyond the length.
    next_bit: Signal<Local, Bit>,
    /// `bits` with the bit that is taken.
    shifted: Signal<Local, Bits<32>>,
    /// High if the address is one of this channel's words.
    selected: Signal<Local, Bit>,
    /// Word that the address selects.
    word: Signal<Local, Bits<32>>,
    /// Address of the two words, divided by 2.
    pair: Constant<Bits<10>>,
}

impl DirectOutput {
    /// Direct outputs of channel `channel`, whose positions have `position_bits` bits.
    pub fn new(channel: usize, position_bits: u32) -> Self {
        let first_word = DIRECT.base + DIRECT.stride * channel as u16;
        Self::from_parts(DirectOutputParts {
            length_bits: Reg::new(u64::from(position_bits.min(32)).into()),
            pair: Constant::new(u64::from(first_word >> 1).into()),
        })
    }
}

#[kernel]
impl Logic for DirectOutput {
    fn update(&mut self) {
        // Two words: bits of the position, and selection of errors.
        self.selected.next =
            self.in_range.val() & (self.word_address.val().get_bits::<10>(1) == self.pair.val());
        self.word.next = place!(self.first_bit.q.val(), direct.crop.first_bit)
            | place!(self.length_bits.q.val(), direct.crop.length_bits);
        if self.word_address.val().get_bit(0) {
            self.word.next = self.error_causes.q.val();
        }
        if self.selected.val() & self.write.val() {
            if self.word_address.val().get_bit(0) {
                self.error_causes.d.next = self.write_data.val();
            } else {
                self.first_bit.d.next = field!(self.write_data.val(), direct.crop.first_bit);
                self.length_bits.d.next = field!(self.write_data.val(), direct.crop.length_bits);
            }
        }
        // A reset by deselection takes no logic.
        self.byte_read.reset.next = !self.selected.val();
        match self.lane.val().index() {
            0 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(24);
            }
            1 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(16);
            }
            2 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(8);
            }
            _ => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(0);
            }
        }
        self.read_byte.next = self.byte_read.q.val();

        // The lowest bit first: after 32 bits it is in place.
        self.wide.next = bit_cast::<64, 48>(self.position.val());
        self.next_bit.next = self.wide.val().get_bit(self.at.q.val().index())
            & (self.taken.q.val() < self.length_bits.q.val());
        self.shifted.next =
            (self.bits.q.val() >> 1) | (bit_cast::<32, 1>(self.next_bit.val().into()) << 31);
        self.strobe.d.next = false;
        if self.running.q.val() {
            self.bits.d.next = self.shifted.val();
            self.at.d.next = self.at.q.val() + 1;
            self.taken.d.next = self.taken.q.val() + 1;
            if self.at.q.val().all() {
                // No bits above 63; the index does not wrap.
                self.at.d.next = self.at.q.val();
            }
            if self.taken.q.val() == 31 {
                self.running.d.next = false;
                self.cropped.d.next = true;
                self.strobe.d.next = true;
                self.shown.d.next = self.shifted.val();
            }
        }
        if self.result_strobe.val() {
            self.running.d.next = self.fresh.val();
            self.cropped.d.next = false;
            self.at.d.next = self.first_bit.q.val();
            self.taken.d.next = 0.into();
        }
        self.direct_position.next = self.shown.q.val();
        self.direct_valid.next = self.cropped.q.val() & self.fresh.val();
        self.direct_fresh.next = self.strobe.q.val();

        self.error.d.next = self.error_causes.q.val().get_bit(self.cause.val().index());
        if !self.cause.val().any() {
            self.error.d.next = false;
        }
        if self.alarm.val() & self.error_causes.q.val().get_bit(0) {
            self.error.d.next = true;
        }
        self.direct_error.next = self.error.q.val();
    }
}
