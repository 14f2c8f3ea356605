//! Additional data: which blocks the encoder sends, and their last content.
//!
//! ```text
//! supplement 001001 with 0x40..0x4E -> info 1 follows every position, 0x4F -> no more
//!                        0x50..0x5E -> info 2, in front of info 1,    0x5F -> no more
//! 101010 -> none
//! one is missing -> only those that came    the answer is longer than expected -> both
//! ```
//!
//! The last line resynchronises the record after a reset, a changed encoder or a request that the encoder rejected. Each frame that contradicts
//! the record corrects it, at the latest the second one; bit I4 identifies the block. A frame with a wrong CRC does not change
//! the record. If an answer is longer than expected with both selected, only the blocks with a right CRC count.
//!
//! ```text
//! slow frame   last CRC bit  X LOW, or HIGH for tm ~~~~\_____
//! center       ______________/\_____________________________
//! look         _______________________/\____________________    a short tm is not over yet
//! sample       ______________________________________/\_____
//! ```
//!
//! Ref: TI motor-control SDK, `endat_drv.c` (order, selection); HEIDENHAIN EnDat FAQ (end of selection).

use crate::ports::AdditionalDataOut;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Record of selections and contents of one channel.
#[derive(LogicBlock, Block)]
pub struct AddInfo {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: a frame begins.
    pub start: Signal<In, Bit>,
    /// Strobe: middle of the expected place of a data edge.
    pub center: Signal<In, Bit>,
    /// Strobe: the data line is sampled, in the middle of the cell after it.
    pub sample: Signal<In, Bit>,
    /// Strobe: position, or answer, and its CRC have been received.
    pub answer_done: Signal<In, Bit>,
    /// The frame has F2, so additional data may follow.
    pub has_f2: Signal<In, Bit>,
    /// A supplement follows.
    pub has_supplement: Signal<In, Bit>,
    /// Mode command of the frame.
    pub command: Signal<In, Bits<6>>,
    /// MRS code that the frame sends.
    pub mrs: Signal<In, Bits<8>>,
    /// Strobe: a block of additional data has been received.
    pub info_done: Signal<In, Bit>,
    /// The CRC of the block is right; also valid one cycle after `answer_done`, for the answer.
    pub crc_ok: Signal<In, Bit>,
    /// Bits WRN, RM, Busy, I4..I0 of the block, then 16 data bits.
    pub word: Signal<In, Bits<24>>,
    /// CRC of the block as received.
    pub crc: Signal<In, Bits<5>>,
    /// Strobe: the frame has ended.
    pub over: Signal<In, Bit>,
    /// Raw flags of the frame, with `over`.
    pub flags: Signal<In, Bits<12>>,
    /// Record of the additional data that follow each position.
    #[bundle]
    pub record: AdditionalDataOut,
    /// Number of blocks that follow the position of this frame.
    pub infos: Signal<Out, Bits<2>>,
    /// Strobe: in the first part of a long cell, where a short recovery time is not over yet.
    pub look: Signal<Out, Bit>,
    /// Additional data that follow each position: bit 0 info 1, bit 1 info 2.
    selected: Reg<Bits<2>>,
    /// Last block of info 1.
    first: Reg<Bits<24>>,
    /// Last block of info 2.
    second: Reg<Bits<24>>,
    /// Received CRC of info 1 in this frame; 0 until received.
    first_crc: Reg<Bits<5>>,
    /// Received CRC of info 2 in this frame; 0 until received.
    second_crc: Reg<Bits<5>>,
    /// Blocks received in this frame: bit 0 info 1, bit 1 info 2.
    seen: Reg<Bits<2>>,
    /// Blocks of this frame whose CRC is right: bit 0 info 1, bit 1 info 2.
    right: Reg<Bits<2>>,
    /// `answer_done`, one cycle later.
    answered: Reg<Bit>,
    /// Set if the CRC of the answer is right; cleared when the frame ends or the next one begins.
    trusted: Reg<Bit>,
    /// Cycles until `look`; loaded with `center`, 0 after it and after a sample.
    remaining: Reg<Bits<8>>,
    /// High for one cycle: a short recovery time is not over yet.
    look_now: Reg<Bit>,
    /// From the edge after an answer to `look`, in system clock cycles.
    separator_cycles: Constant<Bits<8>>,
    /// High if the current block is info 2.
    is_second: Signal<Local, Bit>,
    /// High with `over` if the supplement was sent.
    is_sent: Signal<Local, Bit>,
    /// High if the supplement selects or deselects additional data.
    is_selection: Signal<Local, Bit>,
    /// High if the supplement deselects them.
    is_off: Signal<Local, Bit>,
}

impl AddInfo {
    /// A record that looks for additional data `separator_cycles` system clock cycles (1..=255) after the edge after an answer.
    pub fn new(separator_cycles: u64) -> Self {
        Self::from_parts(AddInfoParts {
            separator_cycles: Constant::new(separator_cycles.into()),
        })
    }
}

#[kernel]
impl Logic for AddInfo {
    fn update(&mut self) {
        // After a sample there is nothing left to look for.
        self.look_now.d.next = (self.remaining.q.val() == 1) & !self.sample.val();
        if self.remaining.q.val().any() {
            self.remaining.d.next = self.remaining.q.val() - 1;
        }
        if self.center.val() {
            self.remaining.d.next = self.separator_cycles.val();
        }
        if self.sample.val() {
            self.remaining.d.next = 0.into();
        }
        self.look.next = self.look_now.q.val();

        self.answered.d.next = self.answer_done.val();
        if self.answered.q.val() {
            self.trusted.d.next = self.crc_ok.val();
        }

        // Two blocks come in fixed order. A single one identifies itself, if its CRC is right.
        self.is_second.next = self.selected.q.val().get_bit(1);
        if self.selected.q.val().all() & self.seen.q.val().get_bit(1) {
            self.is_second.next = false;
        }
        if self.crc_ok.val() & !self.selected.q.val().all() {
            self.is_second.next = self.word.val().get_bit(20);
        }
        if self.info_done.val() {
            if self.is_second.val() {
                self.second.d.next = self.word.val();
                self.second_crc.d.next = self.crc.val();
                self.seen.d.next = self.seen.q.val() | 2;
            } else {
                self.first.d.next = self.word.val();
                self.first_crc.d.next = self.crc.val();
                self.seen.d.next = self.seen.q.val() | 1;
            }
            if self.crc_ok.val() {
                self.right.d.next = self.right.q.val() | 1;
                if self.is_second.val() {
                    self.right.d.next = self.right.q.val() | 2;
                }
            }
        }
        if self.start.val() {
            self.seen.d.next = 0.into();
            self.right.d.next = 0.into();
            self.first_crc.d.next = 0.into();
            self.second_crc.d.next = 0.into();
            self.trusted.d.next = false;
        }

        // A frame that is aborted early leaves the supplement unsent.
        self.is_sent.next = !self.flags.val().get_bit(0)
            & !self.flags.val().get_bit(1)
            & !self.flags.val().get_bit(2)
            & !self.flags.val().get_bit(9)
            & !self.flags.val().get_bit(10)
            & !self.flags.val().get_bit(11);
        // 001001 with 010x xxxx.
        self.is_selection.next = self.has_supplement.val()
            & (self.command.val() == 9)
            & (self.mrs.val().get_bits::<3>(5) == 2);
        self.is_off.next = self.mrs.val().get_bits::<4>(0).all();
        if self.over.val() {
            if self.has_f2.val() & self.seen.q.val().any() & !self.selected.q.val().all() {
                self.selected.d.next = self.seen.q.val();
            }
            if self.is_selection.val() & self.is_sent.val() {
                if self.mrs.val().get_bit(4) {
                    self.selected.d.next = self.selected.q.val().replace_bit(1, !self.is_off.val());
                } else {
                    self.selected.d.next = self.selected.q.val().replace_bit(0, !self.is_off.val());
                }
            }
            if self.flags.val().get_bit(11) {
                self.selected.d.next = self.seen.q.val();
            }
            if self.flags.val().get_bit(9) & self.has_f2.val() & self.trusted.q.val() {
                self.selected.d.next = 3.into();
                if self.selected.q.val().all() {
                    self.selected.d.next = self.right.q.val();
                }
            }
            // A frame corrects the record once.
            self.trusted.d.next = false;
            // 101010, whatever its answer was.
            if self.command.val() == 42 {
                self.selected.d.next = 0.into();
            }
        }
        self.record.info_active.next = self.selected.q.val();
        self.infos.next = 0.into();
        if self.has_f2.val() {
            self.infos.next = bit_cast::<2, 1>(self.selected.q.val().get_bits::<1>(0))
                + bit_cast::<2, 1>(self.selected.q.val().get_bits::<1>(1));
        }
        self.record.info_1.next = self.first.q.val();
        self.record.info_2.next = self.second.q.val();
        self.record.info_came.next = self.seen.q.val();
        self.record.info_good.next = self.right.q.val();
        self.record.info_crcs.next = (bit_cast::<10, 5>(self.second_crc.q.val()) << 5)
            | bit_cast::<10, 5>(self.first_crc.q.val());
    }
}
