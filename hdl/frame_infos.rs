//! Informations of a result: what the frame of a channel's result brought besides the position, as words of the result and for the stream.
//!
//! ```text
//! frame       command  position  info 2  info 1 ~~~tm~~~\_________ next one
//! result      _______________/\___________________________________
//! is_open     _______________/~~~~~~~~~~~~~~~~~~~~~~~~~~~~\_______
//! over        ____________________________________________/\______    captured here, once
//! word_1, 2   before         |0                            this frame's
//! ```
//!
//! The words are 0 from the result on and are filled when its frame is over, so whoever takes result and words in one cycle never mixes two
//! frames: `due` says that they may still come. Frames that measure the delay and frames of requests end without a result of their own, and fill nothing.
//!
//! The held words follow with the words of [`crate::channel_registers`], by the same signal.

use crate::reg::Reg;
use crate::regs::{BLOCK_STRIDE, RESULT_BASE};
use rust_hdl::prelude::*;

/// Place of the first of the two words in a result.
pub const INFO_OFFSET: u16 = 6;

/// Informations of one channel's result.
#[derive(LogicBlock)]
pub struct FrameInfos {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: the channel takes a trigger.
    pub taken: Signal<In, Bit>,
    /// Strobe: a new result is there.
    pub result_strobe: Signal<In, Bit>,
    /// The result brought the position.
    pub fresh: Signal<In, Bit>,
    /// The position came with F2.
    pub has_f2: Signal<In, Bit>,
    /// Strobe: a frame has ended.
    pub over: Signal<In, Bit>,
    /// The encoder sends after each EnDat 2.2 position: bit 0 information 1, bit 1 information 2.
    pub info_active: Signal<In, Bits<2>>,
    /// Information 1 as it came last: WRN, RM, Busy, I4..I0, 16 bits.
    pub info_1: Signal<In, Bits<24>>,
    /// Information 2 as it came last.
    pub info_2: Signal<In, Bits<24>>,
    /// The frame brought: bit 0 information 1, bit 1 information 2.
    pub info_came: Signal<In, Bits<2>>,
    /// Their CRCs are right.
    pub info_good: Signal<In, Bits<2>>,
    /// The frame of the result is not over: informations may still come.
    pub is_open: Signal<Out, Bit>,
    /// Information 1 of the result's frame: 24 bits, came, good, due.
    pub word_1: Signal<Out, Bits<27>>,
    /// Information 2 of it.
    pub word_2: Signal<Out, Bits<27>>,
    /// The held words follow.
    pub load: Signal<In, Bit>,
    /// Word address of the access.
    pub word_address: Signal<In, Bits<11>>,
    /// It is one of the register map.
    pub in_range: Signal<In, Bit>,
    /// Byte of the word, 0 = most significant.
    pub lane: Signal<In, Bits<2>>,
    /// The held byte, 1 cycle later; 0 if another word is read.
    pub read_byte: Signal<Out, Bits<8>>,
    open: Reg<Bit>,
    past: Reg<Bit>,
    first: Reg<Bits<26>>,
    second: Reg<Bits<26>>,
    held_first: Reg<Bits<27>>,
    held_second: Reg<Bits<27>>,
    byte_read: Reg<Bits<8>>,
    opens: Signal<Local, Bit>,
    open_now: Signal<Local, Bit>,
    filled_1: Signal<Local, Bits<26>>,
    filled_2: Signal<Local, Bits<26>>,
    shown_1: Signal<Local, Bits<27>>,
    shown_2: Signal<Local, Bits<27>>,
    selected: Signal<Local, Bit>,
    word: Signal<Local, Bits<32>>,
    pair: Constant<Bits<10>>,
}

impl FrameInfos {
    /// Those of channel `channel`.
    pub fn new(channel: usize) -> Self {
        let first = RESULT_BASE + BLOCK_STRIDE * channel as u16 + INFO_OFFSET;
        Self {
            clock: Default::default(),
            reset: Default::default(),
            taken: Default::default(),
            result_strobe: Default::default(),
            fresh: Default::default(),
            has_f2: Default::default(),
            over: Default::default(),
            info_active: Default::default(),
            info_1: Default::default(),
            info_2: Default::default(),
            info_came: Default::default(),
            info_good: Default::default(),
            is_open: Default::default(),
            word_1: Default::default(),
            word_2: Default::default(),
            load: Default::default(),
            word_address: Default::default(),
            in_range: Default::default(),
            lane: Default::default(),
            read_byte: Default::default(),
            open: Default::default(),
            past: Default::default(),
            first: Default::default(),
            second: Default::default(),
            held_first: Default::default(),
            held_second: Default::default(),
            byte_read: Default::default(),
            opens: Default::default(),
            open_now: Default::default(),
            filled_1: Default::default(),
            filled_2: Default::default(),
            shown_1: Default::default(),
            shown_2: Default::default(),
            selected: Default::default(),
            word: Default::default(),
            pair: Constant::new(u64::from(first / 2).into()),
        }
    }
}

impl Logic for FrameInfos {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self,
            clock,
            open,
            past,
            first,
            second,
            held_first,
            held_second,
            byte_read
        );
        self.open.reset.next = self.reset.val();
        self.past.reset.next = self.reset.val();
        self.first.reset.next = self.reset.val() | self.result_strobe.val();
        self.second.reset.next = self.reset.val() | self.result_strobe.val();
        self.held_first.reset.next = self.reset.val();
        self.held_second.reset.next = self.reset.val();

        // A frame that is given up before its position ends a cycle before its result is there; one that withdraws its position changes the
        // result a cycle after its end.
        self.past.d.next = self.over.val();
        self.opens.next = self.result_strobe.val()
            & !self.past.q.val()
            & self.info_active.val().any()
            & (self.has_f2.val() | !self.fresh.val());
        self.open_now.next = self.open.q.val() | self.opens.val();
        self.open.d.next = self.open_now.val();
        // The next frame: that of the result must have ended.
        if self.past.q.val() | self.taken.val() {
            self.open.d.next = false;
        }
        self.is_open.next = self.open_now.val();

        // The content counts if its CRC is right.
        self.filled_1.next = bit_cast::<26, 1>(self.info_came.val().get_bits::<1>(0)) << 24;
        if self.info_came.val().get_bit(0) & self.info_good.val().get_bit(0) {
            self.filled_1.next =
                bit_cast::<26, 24>(self.info_1.val()) | (bit_cast::<26, 2>(3.into()) << 24);
        }
        self.filled_2.next = bit_cast::<26, 1>(self.info_came.val().get_bits::<1>(1)) << 24;
        if self.info_came.val().get_bit(1) & self.info_good.val().get_bit(1) {
            self.filled_2.next =
                bit_cast::<26, 24>(self.info_2.val()) | (bit_cast::<26, 2>(3.into()) << 24);
        }
        if self.open.q.val() & self.past.q.val() {
            self.first.d.next = self.filled_1.val();
            self.second.d.next = self.filled_2.val();
        }
        self.shown_1.next = bit_cast::<27, 26>(self.first.q.val())
            | (bit_cast::<27, 1>(self.open.q.val().into()) << 26);
        self.shown_2.next = bit_cast::<27, 26>(self.second.q.val())
            | (bit_cast::<27, 1>(self.open.q.val().into()) << 26);
        // What is there is of the result before.
        if self.result_strobe.val() {
            self.shown_1.next = bit_cast::<27, 1>(self.opens.val().into()) << 26;
            self.shown_2.next = bit_cast::<27, 1>(self.opens.val().into()) << 26;
        }
        self.word_1.next = self.shown_1.val();
        self.word_2.next = self.shown_2.val();

        // The host's words.
        if self.load.val() {
            self.held_first.d.next = self.shown_1.val();
            self.held_second.d.next = self.shown_2.val();
        }
        self.selected.next =
            self.in_range.val() & (self.word_address.val().get_bits::<10>(1) == self.pair.val());
        self.word.next = bit_cast::<32, 27>(self.held_first.q.val());
        if self.word_address.val().get_bit(0) {
            self.word.next = bit_cast::<32, 27>(self.held_second.q.val());
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
    }
}
