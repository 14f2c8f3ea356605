//! One channel's part of a sample set: whether it took the trigger, and its result when the set is closed.
//!
//! ```text
//! trigger, busy --> took, owes           result --(take)--> position, status --> byte of the set
//!                     ^   |                 ^
//! result strobe ------+---+-- no result missing: the set may be closed
//! ```
//!
//! Everything is latched in one cycle, so later values cannot enter the set. With separate triggers, a channel may
//! be slower than the triggers. Its result, which was missing when its set was closed, goes into the channel's empty place in the next set.
//! <!-- with has_guards -->
//!
//! A waiting set no longer has the CRC of the encoder. If an upset changes the position meanwhile, its parity shows it; the position is then sent as
//! not fresh, with the cause of an upset.
//! <!-- end -->

use super::buffer::SetParts;
use crate::replicate::each;
use endat_regs::Protocol;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// A channel's place in a set.
#[derive(LogicBlock, Block)]
pub struct SetChannel {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: the trigger that starts a set.
    pub trigger: Signal<In, Bit>,
    /// A trigger would be lost.
    pub busy: Signal<In, Bit>,
    /// Strobe: a new result is valid.
    pub result_strobe: Signal<In, Bit>,
    /// Last good position.
    pub position: Signal<In, Bits<48>>,
    /// CRC that came with the position.
    pub position_crc: Signal<In, Bits<5>>,
    /// The position came with F2.
    pub position_has_f2: Signal<In, Bit>,
    /// A good position is available.
    pub position_valid: Signal<In, Bit>,
    /// The last result brought the position.
    pub fresh: Signal<In, Bit>,
    /// Primary cause of the last result.
    pub cause: Signal<In, Bits<5>>,
    /// Raw flags of the last result.
    pub flags: Signal<In, Bits<20>>,
    /// Strobe: the set is closed; latch the current values.
    pub take: Signal<In, Bit>,
    /// Strobe, never with `take`: latch a position of a running clock for a separate set.
    pub take_run: Vec<Signal<In, Bit>>,
    /// Additional data 1 of the result: 24 bits, came, good, due; only if sets have additional data, as the next two ports.
    pub word_1: Vec<Signal<In, Bits<27>>>,
    /// Additional data 2 of the result.
    pub word_2: Vec<Signal<In, Bits<27>>>,
    /// The other 8 bytes are requested.
    pub second: Vec<Signal<In, Bit>>,
    /// Requested 8 bytes of the set: channel n has number n + 1.
    pub block: Signal<In, Bits<4>>,
    /// Requested byte of these: 0 = least significant byte of the position, 6 and 7 = status.
    pub byte_at: Signal<In, Bits<3>>,
    /// The byte, 1 cycle later; 0 for other channels.
    pub set_byte: Signal<Out, Bits<8>>,
    /// The channel took the trigger, and its result is still missing.
    pub owes: Signal<Out, Bit>,
    /// A later result has replaced that of the trigger (continuous clock).
    pub replaced: Signal<Out, Bit>,
    /// High if the channel took the last trigger.
    took: Reg<Bit>,
    /// High from a trigger that the channel took until its result.
    waiting: Reg<Bit>,
    /// High if the last set was closed without this channel's result, until the result arrives.
    owed: Reg<Bit>,
    /// High if such a result has arrived and is in no set yet; cleared when a set takes it.
    late: Reg<Bit>,
    /// `late`, with the result of this cycle.
    late_now: Signal<Local, Bit>,
    /// High if the channel took the trigger of the set and has its result.
    is_own: Signal<Local, Bit>,
    /// High for one cycle when the channel's entry in the set is cleared, because it has no result.
    empties: Signal<Local, Bit>,
    /// High if another block is requested.
    is_other: Signal<Local, Bit>,
    /// Position in the set that is being written; 0 if there is none.
    position_taken: Reg<Bits<48>>,
    /// Parity of that position, as it came with its CRC.
    parity_taken: Reg<Bit>,
    /// Cause, flags, valid and fresh in the set that is being written.
    status_taken: Reg<Bits<16>>,
    /// High if the channel took the trigger of that set.
    took_taken: Reg<Bit>,
    /// High if the result was missing when that set was closed.
    missing_taken: Reg<Bit>,
    /// Requested byte of position or status; 0 for other blocks.
    set_byte_held: Reg<Bits<8>>,
    /// Additional data 1 in the set that is being written.
    info_1: Vec<Reg<Bits<24>>>,
    /// Additional data 2 in the set that is being written.
    info_2: Vec<Reg<Bits<24>>>,
    /// State of the additional data: came and good of 1, came and good of 2, due in bits 0 to 4.
    info_state: Vec<Reg<Bits<8>>>,
    /// State of the additional data of this cycle's result.
    state_now: Vec<Signal<Local, Bits<8>>>,
    /// Requested byte of the additional data; 0 for other blocks.
    info_byte: Vec<Reg<Bits<8>>>,
    /// High while the result of the trigger is missing.
    open: Signal<Local, Bit>,
    /// Cause, flags, valid and fresh of this cycle's result.
    status: Signal<Local, Bits<16>>,
    /// High with the first status byte if the stored position differs from its parity.
    is_upset: Reg<Bit>,
    /// Parity of the position: from its CRC, or from its bits if it has no CRC.
    parity: Signal<Local, Bit>,
    /// Byte to send: the stored one, or the cause of an upset instead.
    shown: Signal<Local, Bits<8>>,
    /// 1 if stored positions are checked against their parity.
    has_guards: Constant<Bit>,
    /// 1 if positions come with a CRC.
    has_crc: Constant<Bit>,
    /// Mask of the bit in the first status byte that marks a channel that took the trigger.
    taken_bit: Constant<Bits<8>>,
    /// Cause of an upset.
    upset_cause: Constant<Bits<8>>,
    /// Number of this channel's block in a set.
    number: Constant<Bits<4>>,
    /// 1 if a late result goes into the next set.
    takes_late: Constant<Bit>,
    _runs: usize,
    _infos: usize,
}

impl SetChannel {
    /// The place of channel `channel` with this protocol. It accepts late results if `takes_late`, and the content that `parts` selects.
    pub fn new(
        channel: usize,
        protocol: Protocol,
        takes_late: bool,
        parts: SetParts,
        guards: bool,
    ) -> Self {
        let (runs, infos) = (usize::from(parts.runs), usize::from(parts.additional_data));
        Self::from_parts(SetChannelParts {
            take_run: each(runs),
            word_1: each(infos),
            word_2: each(infos),
            second: each(infos),
            info_1: each(infos),
            info_2: each(infos),
            info_state: each(infos),
            state_now: each(infos),
            info_byte: each(infos),
            number: Constant::new((channel as u64 + 1).into()),
            takes_late: Constant::new(takes_late),
            has_guards: Constant::new(guards),
            has_crc: Constant::new(protocol == Protocol::Endat),
            taken_bit: Constant::new((1u64 << 5).into()),
            upset_cause: Constant::new(protocol.code_of("upset").into()),
            _runs: runs,
            _infos: infos,
        })
    }
}

#[kernel]
impl Logic for SetChannel {
    fn update(&mut self) {
        if self.result_strobe.val() {
            self.waiting.d.next = false;
        }
        if self.trigger.val() {
            self.took.d.next = !self.busy.val();
            self.waiting.d.next = !self.busy.val();
        }
        self.open.next = self.waiting.q.val() & !self.result_strobe.val();
        self.owes.next = self.open.val();
        self.replaced.next = self.took.q.val() & !self.waiting.q.val() & self.result_strobe.val();

        // A result that was missing in its set and has arrived since. A result after it belongs to another trigger.
        self.late_now.next = self.late.q.val();
        if self.result_strobe.val() {
            self.late_now.next = self.owed.q.val();
        }
        self.late.d.next = self.late_now.val() & !self.take.val();
        if self.result_strobe.val() {
            self.owed.d.next = false;
        }
        if self.take.val() & self.open.val() {
            self.owed.d.next = self.takes_late.val();
        }
        // Clear the entry if this trigger has no result, so that an older result is never reported as new.
        self.is_own.next = self.took.q.val() & !self.open.val();
        self.empties.next = self.take.val() & !self.is_own.val() & !self.late_now.val();
        self.position_taken.reset.next = self.empties.val();
        self.parity_taken.reset.next = self.empties.val();
        self.status_taken.reset.next = self.empties.val();
        self.status.next = bit_cast::<16, 5>(self.cause.val())
            | (bit_cast::<16, 1>(self.position_valid.val().into()) << 6)
            | (bit_cast::<16, 1>(self.fresh.val().into()) << 7)
            | (bit_cast::<16, 7>(self.flags.val().get_bits::<7>(12)) << 8);
        // The polynomial has the factor x + 1, so the CRC has the same parity as the bits it covers: F1 = 0, F2 = 1 and the position.
        self.parity.next = self.position_crc.val().xor() ^ self.position_has_f2.val();
        if !self.has_crc.val() {
            self.parity.next = self.position.val().xor();
        }
        if self.take.val() {
            self.position_taken.d.next = self.position.val();
            self.parity_taken.d.next = self.parity.val();
            self.status_taken.d.next = self.status.val();
            self.took_taken.d.next = self.took.q.val();
            self.missing_taken.d.next = self.open.val();
        }
        for i in 0..self._runs {
            if self.take_run[i].val() {
                self.position_taken.d.next = self.position.val();
                self.parity_taken.d.next = self.parity.val();
                self.status_taken.d.next = self.status.val();
                self.took_taken.d.next = true;
                self.missing_taken.d.next = false;
            }
        }

        // Reported in the first status byte; the bytes before it have been sent.
        self.is_other.next = self.block.val() != self.number.val();
        self.is_upset.reset.next = self.is_other.val();
        self.is_upset.d.next = self.has_guards.val()
            & (self.position_taken.q.val().xor() ^ self.parity_taken.q.val())
            & (self.byte_at.val() == 6);
        // A reset by deselection alone takes no logic.
        self.set_byte_held.reset.next = self.is_other.val();
        match self.byte_at.val().index() {
            0 => {
                self.set_byte_held.d.next = self.position_taken.q.val().get_bits::<8>(0);
            }
            1 => {
                self.set_byte_held.d.next = self.position_taken.q.val().get_bits::<8>(8);
            }
            2 => {
                self.set_byte_held.d.next = self.position_taken.q.val().get_bits::<8>(16);
            }
            3 => {
                self.set_byte_held.d.next = self.position_taken.q.val().get_bits::<8>(24);
            }
            4 => {
                self.set_byte_held.d.next = self.position_taken.q.val().get_bits::<8>(32);
            }
            5 => {
                self.set_byte_held.d.next = self.position_taken.q.val().get_bits::<8>(40);
            }
            6 => {
                self.set_byte_held.d.next = self.status_taken.q.val().get_bits::<8>(0)
                    | (bit_cast::<8, 1>(self.took_taken.q.val().into()) << 5);
            }
            _ => {
                self.set_byte_held.d.next = self.status_taken.q.val().get_bits::<8>(8)
                    | (bit_cast::<8, 1>(self.missing_taken.q.val().into()) << 7);
            }
        }
        self.shown.next = self.set_byte_held.q.val();
        if self.is_upset.q.val() {
            self.shown.next =
                (self.set_byte_held.q.val() & self.taken_bit.val()) | self.upset_cause.val();
        }
        self.set_byte.next = self.shown.val();
        for i in 0..self._infos {
            self.info_1[i].clock.next = self.clock.val();
            self.info_2[i].clock.next = self.clock.val();
            self.info_state[i].clock.next = self.clock.val();
            self.info_byte[i].clock.next = self.clock.val();
            self.info_1[i].d.next = self.info_1[i].q.val();
            self.info_2[i].d.next = self.info_2[i].q.val();
            self.info_state[i].d.next = self.info_state[i].q.val();
            // Came and good of each word, and due, which both share.
            self.state_now[i].next = 0.into();
            if self.word_1[i].val().get_bit(24) {
                self.state_now[i].next = self.state_now[i].val() | 1;
            }
            if self.word_1[i].val().get_bit(25) {
                self.state_now[i].next = self.state_now[i].val() | 2;
            }
            if self.word_2[i].val().get_bit(24) {
                self.state_now[i].next = self.state_now[i].val() | 4;
            }
            if self.word_2[i].val().get_bit(25) {
                self.state_now[i].next = self.state_now[i].val() | 8;
            }
            if self.word_1[i].val().get_bit(26) {
                self.state_now[i].next = self.state_now[i].val() | 16;
            }
            // Additional data without a result are cleared.
            self.info_1[i].reset.next = self.empties.val();
            self.info_2[i].reset.next = self.empties.val();
            self.info_state[i].reset.next = self.empties.val();
            if self.take.val() {
                self.info_1[i].d.next = self.word_1[i].val().get_bits::<24>(0);
                self.info_2[i].d.next = self.word_2[i].val().get_bits::<24>(0);
                self.info_state[i].d.next = self.state_now[i].val();
            }
            self.set_byte_held.reset.next = self.is_other.val() | self.second[i].val();
            self.is_upset.reset.next = self.is_other.val() | self.second[i].val();
            self.info_byte[i].reset.next = self.is_other.val() | !self.second[i].val();
            match self.byte_at.val().index() {
                0 => {
                    self.info_byte[i].d.next = self.info_1[i].q.val().get_bits::<8>(0);
                }
                1 => {
                    self.info_byte[i].d.next = self.info_1[i].q.val().get_bits::<8>(8);
                }
                2 => {
                    self.info_byte[i].d.next = self.info_1[i].q.val().get_bits::<8>(16);
                }
                3 => {
                    self.info_byte[i].d.next = self.info_2[i].q.val().get_bits::<8>(0);
                }
                4 => {
                    self.info_byte[i].d.next = self.info_2[i].q.val().get_bits::<8>(8);
                }
                5 => {
                    self.info_byte[i].d.next = self.info_2[i].q.val().get_bits::<8>(16);
                }
                6 => {
                    self.info_byte[i].d.next = self.info_state[i].q.val();
                }
                _ => {
                    self.info_byte[i].d.next = 0.into();
                }
            }
            self.set_byte.next = self.shown.val() | self.info_byte[i].q.val();
        }
    }
}
