//! Result banks: results as the processor's words, in RAM; one result is held while others arrive.
//!
//! ```text
//! verdict -> step 3, 4, .. 15, 0, 1, 2 -> byte = head, or the previous one -> RAM, bank `free`
//!                                   \--> free becomes latest
//! address 0 is read: latest becomes held
//! ```
//!
//! A byte of step n is the low (n even) or high (n odd) one of word n / 2. Three of the four banks are in use: `held`, which the processor
//! reads, `latest`, and `free`, to which the next result is written as a whole. Parts that a reply does not bring are copied from `latest`, out of a
//! second RAM for this purpose. So a result changes at once, and is held as long as the processor needs it.
//! <!-- with has_guards -->
//!
//! The parity of the positions, formed from the received bits, is compared when the processor takes a result: words 1 to 4 are read while the
//! processor still reads address 0, whose word is not in RAM.
//! <!-- end -->

use super::ports::ReplyPartsIn;
use super::verdict_bytes::VerdictBytes;
use rtl_design::memory::Memory;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Words of results.
#[derive(LogicBlock, Block)]
#[properties("../../properties/result_banks.sv")]
pub struct ResultBanks {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// An exchange has ended; the inputs below belong to it, and do not change while `hold` is high.
    pub verdict: Signal<In, Bit>,
    /// The result has not been stored completely.
    pub hold: Signal<Out, Bit>,
    /// The reply is good.
    pub good: Signal<In, Bit>,
    /// Raw flags, one bit for each fault; bits as in the register map.
    pub flags: Signal<In, Bits<16>>,
    /// ID echoed in the reply.
    pub reply_id: Signal<In, Bits<4>>,
    /// CRC as received.
    pub crc: Signal<In, Bits<8>>,
    /// Parity of the single-turn position as received.
    pub single_parity: Signal<In, Bit>,
    /// Parity of the multi-turn position as received.
    pub multi_parity: Signal<In, Bit>,
    /// Parts in the reply to a request.
    #[bundle]
    pub parts: ReplyPartsIn,
    /// Next byte of the reply.
    pub head: Signal<In, Bits<8>>,
    /// The byte after it.
    pub second: Signal<In, Bits<8>>,
    /// Strobe: the bytes of the reply advance.
    pub copy: Signal<Out, Bit>,
    /// Byte that follows the fields.
    pub tail: Signal<Out, Bits<8>>,
    /// Strobe: a new result can be read from the next cycle on.
    pub published: Signal<Out, Bit>,
    /// The last reply was good.
    pub fresh: Signal<Out, Bit>,
    /// Address that the processor has selected.
    pub register: Signal<In, Bits<3>>,
    /// The word is being read.
    pub reading: Signal<In, Bit>,
    /// Request ID, the word of address 0.
    pub request_id: Signal<In, Bits<4>>,
    /// An exchange is under way, bit 15 of address 7.
    pub busy: Signal<In, Bit>,
    /// The word, two clocks after `register`.
    pub word: Signal<Out, Bits<16>>,
    /// Bytes with the checks of the reply.
    #[start]
    verdict_bytes: VerdictBytes,
    /// Low bytes of the words.
    #[start]
    low: Memory<8, 5>,
    /// High bytes of the words.
    #[start]
    high: Memory<8, 5>,
    /// Copy of these bytes, for parts that a reply does not bring.
    #[start]
    known: Memory<8, 6>,
    /// Byte of the result that is stored next; 3 at rest, then up to 15 and from 0 to 2.
    #[start(3.into())]
    step: Reg<Bits<4>>,
    /// High after a reset until a bank is filled with zeros.
    #[start(true)]
    clearing: Reg<Bit>,
    /// Complement of `clearing`, so that no single upset starts the filling.
    cleared: Reg<Bit>,
    /// Bank for the next result.
    #[start(1.into())]
    free: Reg<Bits<2>>,
    /// Bank of the latest result.
    #[start(1.into())]
    latest: Reg<Bits<2>>,
    /// Bank that the processor reads.
    held: Reg<Bits<2>>,
    /// Parity of `latest`, to find an upset of it.
    #[start(true)]
    latest_sum: Reg<Bit>,
    /// Parity of `held`, to find an upset of it.
    held_sum: Reg<Bit>,
    /// High if the last reply was good.
    is_fresh: Reg<Bit>,
    /// High if a good single-turn position has come since reset.
    had_single: Reg<Bit>,
    /// High if a good multi-turn position has come since reset.
    had_multi: Reg<Bit>,
    /// Parity of the last good single-turn position, as received.
    single_sum: Reg<Bit>,
    /// Parity of the last good multi-turn position, as received.
    multi_sum: Reg<Bit>,
    /// `is_first` of the cycle before.
    was_first: Reg<Bit>,
    /// Word whose parity is added, 1 to 4, after address 0 was read; 0 at rest.
    scan: Reg<Bits<3>>,
    /// `scan` of the cycle before.
    scanned: Reg<Bits<3>>,
    /// Parity of the words read so far, with those of the positions: 1 at the end is an upset.
    differs: Reg<Bit>,
    /// Address of the word at the RAM's output.
    shown: Reg<Bits<3>>,
    /// Word that the processor reads.
    out_data: Reg<Bits<16>>,
    /// High while a bank is filled with zeros.
    clears: Signal<Local, Bit>,
    /// High while a byte is stored.
    copies: Signal<Local, Bit>,
    /// High at the last byte of a result.
    is_last: Signal<Local, Bit>,
    /// High for one cycle when the last byte is stored.
    ends: Signal<Local, Bit>,
    /// High if the reply brings a good single-turn position.
    takes_single: Signal<Local, Bit>,
    /// High if the reply brings a good multi-turn position.
    takes_multi: Signal<Local, Bit>,
    /// High if the reply brings the byte of this step; else it is copied from the latest result.
    brings: Signal<Local, Bit>,
    /// Step of the next cycle.
    next_step: Signal<Local, Bits<4>>,
    /// Byte that is stored.
    byte: Signal<Local, Bits<8>>,
    /// High if the byte is written to the RAM that the processor reads.
    writes: Signal<Local, Bit>,
    /// Bank after the latest one.
    after_latest: Signal<Local, Bits<2>>,
    /// Bank that is neither the latest nor the held one.
    next_free: Signal<Local, Bits<2>>,
    /// High while the processor reads address 0.
    is_first: Signal<Local, Bit>,
    /// High for one cycle when the processor takes the latest result.
    takes: Signal<Local, Bit>,
    /// Address of the word that is read from RAM.
    place: Signal<Local, Bits<3>>,
    /// Parity of the position bits in the word at the RAM's output.
    part: Signal<Local, Bit>,
    /// High if the held bank is the selected one, and its positions match their parity.
    fits: Signal<Local, Bit>,
    /// Cause in the word of address 7.
    cause: Signal<Local, Bits<4>>,
    /// High if that cause explains a bad result: then no upset is shown instead.
    is_explained: Signal<Local, Bit>,
    /// High byte of the word at the RAM's output.
    high_byte: Signal<Local, Bits<8>>,
    /// Low byte of the word at the RAM's output.
    low_byte: Signal<Local, Bits<8>>,
    /// 1 if upsets of stored bits are detected.
    has_guards: Constant<Bit>,
}

impl ResultBanks {
    /// Banks; `guards` check for upsets of stored bits.
    pub fn new(guards: bool) -> Self {
        Self::from_parts(ResultBanksParts {
            has_guards: Constant::new(guards),
        })
    }
}

#[kernel]
impl Logic for ResultBanks {
    fn update(&mut self) {
        clock!(self, clock, low, high, known);

        self.clears.next = self.clearing.q.val() & !(self.has_guards.val() & self.cleared.q.val());
        // Step by step, from 3 round to 2: the control data, which come last, are low in word 1.
        self.copies.next = self.verdict.val() | self.clears.val();
        self.is_last.next = self.step.q.val() == 2;
        self.ends.next = self.copies.val() & self.is_last.val();
        self.next_step.next = 3.into();
        if self.copies.val() {
            self.next_step.next = self.step.q.val() + 1;
        }
        self.step.d.next = self.next_step.val();
        self.copy.next = self.copies.val();
        self.hold.next = !self.is_last.val() | self.clears.val();
        self.published.next = self.ends.val() & !self.clears.val();

        // The bytes of the verdict follow the fields of the reply. So do EEPROM data, which share the field with the kind of encoder.
        self.takes_single.next = self.good.val() & self.parts.has_single.val();
        self.takes_multi.next = self.good.val() & self.parts.has_multi.val();
        connect!(self.verdict_bytes <= self; good, flags, reply_id);
        self.verdict_bytes.valid.next =
            bit_cast::<2, 1>((self.had_single.q.val() | self.takes_single.val()).into())
                | (bit_cast::<2, 1>((self.had_multi.q.val() | self.takes_multi.val()).into()) << 1);
        // Steps 3, 4, 5, 6 and 9: they enter nine steps before they are used.
        self.tail.next = self.crc.val();
        if self.step.q.val().get_bit(2) {
            self.tail.next = self.verdict_bytes.communication.val();
            if self.step.q.val().get_bit(0) {
                self.tail.next = self.second.val();
            }
            if self.step.q.val().get_bit(1) {
                self.tail.next = self.verdict_bytes.cause_byte.val();
            }
        }
        if self.step.q.val().get_bit(3) {
            self.tail.next = self.verdict_bytes.control.val();
        }

        self.brings.next = true;
        match self.step.q.val().index() {
            3 => {
                self.brings.next = self.takes_single.val();
            }
            4 => {
                self.brings.next = self.takes_single.val();
            }
            5 => {
                self.brings.next = self.takes_single.val();
            }
            6 => {
                self.brings.next = self.good.val() & self.parts.has_identity.val();
            }
            7 => {
                self.brings.next = self.takes_multi.val();
            }
            8 => {
                self.brings.next = self.takes_multi.val();
            }
            9 => {
                self.brings.next = self.takes_multi.val();
            }
            10 => {
                self.brings.next = self.good.val() & self.parts.has_alarm.val();
            }
            14 => {
                self.brings.next = self.good.val() & self.parts.is_memory.val();
            }
            _ => {}
        }
        self.byte.next = self.known.read_data.val();
        if self.brings.val() | self.clears.val() {
            self.byte.next = self.head.val();
        }
        self.known.read_address.next =
            bit_cast::<6, 4>(self.next_step.val()) | (bit_cast::<6, 2>(self.latest.q.val()) << 4);
        self.known.write_enable.next = self.copies.val();
        self.known.write_address.next =
            bit_cast::<6, 4>(self.step.q.val()) | (bit_cast::<6, 2>(self.free.q.val()) << 4);
        self.known.write_data.next = self.byte.val();
        // No writes to the bank that the processor reads.
        self.writes.next = self.copies.val() & (self.free.q.val() != self.held.q.val());
        self.low.write_enable.next = self.writes.val() & !self.step.q.val().get_bit(0);
        self.low.write_address.next = bit_cast::<5, 3>(self.step.q.val().get_bits::<3>(1))
            | (bit_cast::<5, 2>(self.free.q.val()) << 3);
        self.low.write_data.next = self.byte.val();
        self.high.write_enable.next = self.writes.val() & self.step.q.val().get_bit(0);
        self.high.write_address.next = bit_cast::<5, 3>(self.step.q.val().get_bits::<3>(1))
            | (bit_cast::<5, 2>(self.free.q.val()) << 3);
        self.high.write_data.next = self.byte.val();

        // The next bank, or the one after it.
        self.after_latest.next = self.latest.q.val() + 1;
        self.next_free.next = self.after_latest.val();
        if self.after_latest.val() == self.held.q.val() {
            self.next_free.next = self.latest.q.val() ^ 2;
        }
        if !self.copies.val() | self.is_last.val() {
            self.free.d.next = self.next_free.val();
        }
        if self.ends.val() {
            self.latest.d.next = self.free.q.val();
            self.latest_sum.d.next = self.free.q.val().xor();
            self.clearing.d.next = false;
            self.cleared.d.next = true;
        }
        if self.ends.val() & !self.clears.val() {
            self.is_fresh.d.next = self.good.val();
            if self.takes_single.val() {
                self.had_single.d.next = true;
                self.single_sum.d.next = self.single_parity.val();
            }
            if self.takes_multi.val() {
                self.had_multi.d.next = true;
                self.multi_sum.d.next = self.multi_parity.val();
            }
        }
        self.fresh.next = self.is_fresh.q.val();

        // The result that is read.
        self.is_first.next = self.reading.val() & !self.register.val().any();
        self.was_first.d.next = self.is_first.val();
        self.takes.next = self.is_first.val() & !self.was_first.q.val();
        if self.takes.val() | (self.clears.val() & self.is_last.val()) {
            self.held.d.next = self.latest.q.val();
            self.held_sum.d.next = self.latest_sum.q.val();
        }
        self.low_byte.next = self.low.read_data.val();
        self.high_byte.next = self.high.read_data.val();
        // Words 1 to 4, of which 1 and 3 have a position in their high bytes only.
        self.scan.d.next = 0.into();
        if self.scan.q.val().any() & !self.scan.q.val().get_bit(2) {
            self.scan.d.next = self.scan.q.val() + 1;
        }
        if self.has_guards.val() & self.takes.val() {
            self.scan.d.next = 1.into();
        }
        self.scanned.d.next = self.scan.q.val();
        self.part.next = self.high_byte.val().xor()
            ^ (self.low_byte.val().xor() & !self.scanned.q.val().get_bit(0));
        if self.scanned.q.val().any() {
            self.differs.d.next = self.differs.q.val() ^ self.part.val();
        }
        if self.takes.val() {
            self.differs.d.next = self.single_sum.q.val() ^ self.multi_sum.q.val();
        }
        self.fits.next = !self.has_guards.val()
            | (!self.differs.q.val() & (self.held.q.val().xor() == self.held_sum.q.val()));
        self.place.next = self.register.val();
        if self.scan.q.val().any() {
            self.place.next = self.scan.q.val();
        }
        self.low.read_address.next =
            bit_cast::<5, 3>(self.place.val()) | (bit_cast::<5, 2>(self.held.q.val()) << 3);
        self.high.read_address.next =
            bit_cast::<5, 3>(self.place.val()) | (bit_cast::<5, 2>(self.held.q.val()) << 3);

        self.shown.d.next = self.register.val();
        self.out_data.d.next =
            bit_cast::<16, 8>(self.low_byte.val()) | (bit_cast::<16, 8>(self.high_byte.val()) << 8);
        self.cause.next = self.high_byte.val().get_bits::<4>(0);
        // Causes 1 to 12 explain it; an alarm reported with an upset would hide the upset.
        self.is_explained.next = self.cause.val().any()
            & !(self.cause.val().get_bits::<2>(2).all() & self.cause.val().get_bits::<2>(0).any());
        match self.shown.q.val().index() {
            0 => {
                self.out_data.d.next = bit_cast::<16, 4>(self.request_id.val());
            }
            1 => {
                self.out_data.d.next = bit_cast::<16, 7>(self.low_byte.val().get_bits::<7>(0))
                    | (bit_cast::<16, 1>(
                        (self.low_byte.val().get_bit(7) & self.fits.val()).into(),
                    ) << 7)
                    | (bit_cast::<16, 8>(self.high_byte.val()) << 8);
            }
            7 => {
                self.out_data.d.next = bit_cast::<16, 8>(self.low_byte.val())
                    | (bit_cast::<16, 7>(self.high_byte.val().get_bits::<7>(0)) << 8)
                    | (bit_cast::<16, 1>(self.busy.val().into()) << 15);
                if !self.fits.val() {
                    self.out_data.d.next = bit_cast::<16, 8>(self.low_byte.val())
                        | (bit_cast::<16, 4>(self.cause.val()) << 8)
                        | (bit_cast::<16, 1>(self.high_byte.val().get_bits::<1>(6)) << 14)
                        | (bit_cast::<16, 1>(self.busy.val().into()) << 15);
                    if !self.is_explained.val() {
                        self.out_data.d.next = bit_cast::<16, 8>(self.low_byte.val())
                            | 0x0F00
                            | (bit_cast::<16, 1>(self.high_byte.val().get_bits::<1>(6)) << 14)
                            | (bit_cast::<16, 1>(self.busy.val().into()) << 15);
                    }
                }
            }
            _ => {}
        }
        self.word.next = self.out_data.q.val();
    }
}
