//! Reply: the fields of a reply while it is received, each in a separate shift register. The parities of the positions are formed on
//! reception and stored with them everywhere.

use super::ports::{FieldBitsIn, FieldsOut};
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Fields of the reply under way.
#[derive(LogicBlock, Block)]
pub struct Reply {
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
    /// Content of a reply, field by field.
    #[bundle]
    pub fields: FieldsOut,
    /// Status field so far; bits enter at the top.
    status_bits: Reg<Bits<8>>,
    /// Single-turn position so far; bits enter at the top.
    single_bits: Reg<Bits<24>>,
    /// Multi-turn position so far; bits enter at the top.
    multi_bits: Reg<Bits<24>>,
    /// Kind of encoder, or EEPROM data, so far; bits enter at the top.
    byte_bits: Reg<Bits<8>>,
    /// Alarm field so far; bits enter at the top.
    alarm_bits: Reg<Bits<8>>,
    /// Parity of the single-turn bits, formed while they arrived; cleared between exchanges.
    single_sum: Reg<Bit>,
    /// Parity of the multi-turn bits, formed while they arrived; cleared between exchanges.
    multi_sum: Reg<Bit>,
}

#[kernel]
impl Logic for Reply {
    fn update(&mut self) {
        self.single_sum.reset.next = self.reset.val() | self.idle.val();
        self.multi_sum.reset.next = self.reset.val() | self.idle.val();
        self.status_bits.reset.next = self.reset.val() | self.idle.val();
        // Only fields filled by the frame are used, so these need no reset.
        self.single_bits.reset.next = false;
        self.multi_bits.reset.next = false;
        self.byte_bits.reset.next = false;
        self.alarm_bits.reset.next = false;
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
        self.fields.status.next = self.status_bits.q.val();
        self.fields.single_turn.next = self.single_bits.q.val();
        self.fields.multi_turn.next = self.multi_bits.q.val();
        self.fields.single_parity.next = self.single_sum.q.val();
        self.fields.multi_parity.next = self.multi_sum.q.val();
        self.fields.byte_field.next = self.byte_bits.q.val();
        self.fields.alarm.next = self.alarm_bits.q.val();
    }
}
