//! Reply bytes: the fields of a reply in registers that shift bits during reception, and bytes afterwards.
//!
//! ```text
//! bits    status <- level    alarm <- level    multi <- level    byte <- level    single <- level
//! bytes   tail -> status -> alarm -> multi -> byte -> single -> head
//! ```
//!
//! So fetching a field needs no multiplexer, and a bit takes one logic cell: its look-up table selects the direction.

use super::ports::FieldBitsIn;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Fields of the reply under way, fetched byte by byte.
#[derive(LogicBlock, Block)]
pub struct ReplyBytes {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// No exchange is under way.
    pub idle: Signal<In, Bit>,
    /// Strobe: `level` is a data bit.
    pub take: Signal<In, Bit>,
    /// The bit.
    pub level: Signal<In, Bit>,
    /// Field of the reply that a data bit belongs to.
    #[bundle]
    pub field: FieldBitsIn,
    /// All fields advance by a byte.
    pub copy: Signal<In, Bit>,
    /// Byte that enters after the last field.
    pub tail: Signal<In, Bits<8>>,
    /// The first byte: before shifting the low one of the single-turn position.
    pub head: Signal<Out, Bits<8>>,
    /// The byte after it.
    pub second: Signal<Out, Bits<8>>,
    /// Bits 7 to 4 of the status field; constant while bytes move.
    pub status: Signal<Out, Bits<8>>,
    /// Parity of the received bits of the single-turn position.
    pub single_parity: Signal<Out, Bit>,
    /// Parity of the received bits of the multi-turn position.
    pub multi_parity: Signal<Out, Bit>,
    /// Status field so far; passes bytes on while they are fetched.
    status_bits: Reg<Bits<8>>,
    /// Single-turn position so far; its low byte is fetched first.
    single_bits: Reg<Bits<24>>,
    /// Multi-turn position so far; passes bytes on while they are fetched.
    multi_bits: Reg<Bits<24>>,
    /// Kind of encoder, or EEPROM data, so far; passes bytes on while they are fetched.
    byte_bits: Reg<Bits<8>>,
    /// Alarm field so far; passes bytes on while they are fetched.
    alarm_bits: Reg<Bits<8>>,
    /// Bits 7 to 4 of the status field, kept while bytes are fetched.
    judged: Reg<Bits<4>>,
    /// Parity of the single-turn bits, formed while they arrived; cleared between exchanges.
    single_sum: Reg<Bit>,
    /// Parity of the multi-turn bits, formed while they arrived; cleared between exchanges.
    multi_sum: Reg<Bit>,
    /// High between exchanges, and in a reset.
    forget: Signal<Local, Bit>,
}

#[kernel]
impl Logic for ReplyBytes {
    fn update(&mut self) {
        self.forget.next = self.reset.val() | self.idle.val();
        self.single_sum.reset.next = self.forget.val();
        self.multi_sum.reset.next = self.forget.val();
        self.status_bits.reset.next = self.forget.val();
        self.judged.reset.next = self.forget.val();
        if self.take.val() & self.field.is_status.val() {
            self.status_bits.d.next = bit_cast::<8, 7>(self.status_bits.q.val().get_bits::<7>(1))
                | (bit_cast::<8, 1>(self.level.val().into()) << 7);
        }
        if self.take.val() & self.field.is_single.val() {
            self.single_bits.d.next =
                bit_cast::<24, 23>(self.single_bits.q.val().get_bits::<23>(1))
                    | (bit_cast::<24, 1>(self.level.val().into()) << 23);
        }
        if self.take.val() & self.field.is_single.val() {
            self.single_sum.d.next = self.single_sum.q.val() ^ self.level.val();
        }
        if self.take.val() & self.field.is_multi.val() {
            self.multi_sum.d.next = self.multi_sum.q.val() ^ self.level.val();
        }
        if self.take.val() & self.field.is_multi.val() {
            self.multi_bits.d.next = bit_cast::<24, 23>(self.multi_bits.q.val().get_bits::<23>(1))
                | (bit_cast::<24, 1>(self.level.val().into()) << 23);
        }
        if self.take.val() & self.field.is_byte.val() {
            self.byte_bits.d.next = bit_cast::<8, 7>(self.byte_bits.q.val().get_bits::<7>(1))
                | (bit_cast::<8, 1>(self.level.val().into()) << 7);
        }
        if self.take.val() & self.field.is_alarm.val() {
            self.alarm_bits.d.next = bit_cast::<8, 7>(self.alarm_bits.q.val().get_bits::<7>(1))
                | (bit_cast::<8, 1>(self.level.val().into()) << 7);
        }
        if self.copy.val() {
            self.status_bits.d.next = self.tail.val();
            self.alarm_bits.d.next = self.status_bits.q.val();
            self.multi_bits.d.next = bit_cast::<24, 16>(self.multi_bits.q.val().get_bits::<16>(8))
                | (bit_cast::<24, 8>(self.alarm_bits.q.val()) << 16);
            self.byte_bits.d.next = self.multi_bits.q.val().get_bits::<8>(0);
            self.single_bits.d.next =
                bit_cast::<24, 16>(self.single_bits.q.val().get_bits::<16>(8))
                    | (bit_cast::<24, 8>(self.byte_bits.q.val()) << 16);
        } else {
            // The verdict still needs these.
            self.judged.d.next = self.status_bits.q.val().get_bits::<4>(4);
        }
        self.head.next = self.single_bits.q.val().get_bits::<8>(0);
        self.second.next = self.single_bits.q.val().get_bits::<8>(8);
        self.status.next = bit_cast::<8, 4>(self.judged.q.val()) << 4;
        self.single_parity.next = self.single_sum.q.val();
        self.multi_parity.next = self.multi_sum.q.val();
    }
}
