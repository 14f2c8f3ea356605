//! Outcome: the result registers, changed in one clock cycle. They hold the last good position, and its parity as received.

use super::ports::{FieldsIn, ReadingOut, ReplyPartsIn};
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Result registers of one T-format channel.
#[derive(LogicBlock, Block)]
pub struct Outcome {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe: take the inputs.
    pub publish: Signal<In, Bit>,
    /// With `publish`: the reply is good.
    pub good: Signal<In, Bit>,
    /// Raw flags.
    pub flags_in: Signal<In, Bits<16>>,
    /// ID echoed in the reply.
    pub reply_id_in: Signal<In, Bits<4>>,
    /// CRC as received.
    pub crc_in: Signal<In, Bits<8>>,
    /// Content of a reply, field by field.
    #[bundle("_in")]
    pub fields: FieldsIn,
    /// Parts in the reply to a request.
    #[bundle]
    pub parts: ReplyPartsIn,
    /// Outputs of a receiver without registers.
    #[bundle]
    pub reading: ReadingOut,
    /// High for one cycle when a new result can be read.
    strobe: Reg<Bit>,
    /// High if the last reply was good.
    is_fresh: Reg<Bit>,
    /// Number of results, wrapping.
    count: Reg<Bits<8>>,
    /// Last good single-turn position.
    single: Reg<Bits<24>>,
    /// High if a single-turn position was received since reset.
    has_had_single: Reg<Bit>,
    /// Last good multi-turn position.
    multi: Reg<Bits<24>>,
    /// High if a multi-turn position was received since reset.
    has_had_multi: Reg<Bit>,
    /// Kind of encoder, last received.
    identity: Reg<Bits<8>>,
    /// EEPROM data, last received.
    memory: Reg<Bits<8>>,
    /// Alarm field, last received.
    alarms: Reg<Bits<8>>,
    /// Status field of the last reply.
    state: Reg<Bits<8>>,
    /// CRC of the last reply.
    received: Reg<Bits<8>>,
    /// ID echoed in the last reply.
    echo: Reg<Bits<4>>,
    /// Raw flags 0 to 8 of the last exchange.
    low_flags: Reg<Bits<9>>,
    /// Raw flag 11 of the last exchange: the EEPROM was busy.
    memory_busy: Reg<Bit>,
    /// Raw flag 14 of the last exchange: an upset was found.
    upset: Reg<Bit>,
    /// Raw flag 15 of the last exchange: a trigger was lost.
    overrun: Reg<Bit>,
    /// Parity of `single` and its valid bit, as received.
    single_sum: Reg<Bit>,
    /// Parity of `multi` and its valid bit, as received.
    multi_sum: Reg<Bit>,
    /// High for one cycle when a good reply is taken.
    take: Signal<Local, Bit>,
    /// Raw flags 12 and 13: alarms of the status field; 0 after an upset.
    alarm_flags: Signal<Local, Bits<2>>,
    /// 1 if the parities are outputs.
    has_guards: Constant<Bit>,
}

impl Outcome {
    /// An outcome; with `guards` it outputs the parities of the positions, otherwise 0.
    pub fn new(guards: bool) -> Self {
        Self::from_parts(OutcomeParts {
            has_guards: Constant::new(guards),
        })
    }
}

#[kernel]
impl Logic for Outcome {
    fn update(&mut self) {
        self.strobe.d.next = self.publish.val();
        self.take.next = self.publish.val() & self.good.val();
        if self.publish.val() {
            self.is_fresh.d.next = self.good.val();
            self.count.d.next = self.count.q.val() + 1;
            self.state.d.next = self.fields.status.val();
            self.received.d.next = self.crc_in.val();
            self.echo.d.next = self.reply_id_in.val();
            self.low_flags.d.next = self.flags_in.val().get_bits::<9>(0);
            self.memory_busy.d.next = self.flags_in.val().get_bit(11);
            self.upset.d.next = self.flags_in.val().get_bit(14);
            self.overrun.d.next = self.flags_in.val().get_bit(15);
        }
        if self.take.val() & self.parts.has_single.val() {
            self.single.d.next = self.fields.single_turn.val();
            self.has_had_single.d.next = true;
            self.single_sum.d.next = !self.fields.single_parity.val();
        }
        if self.take.val() & self.parts.has_multi.val() {
            self.multi.d.next = self.fields.multi_turn.val();
            self.has_had_multi.d.next = true;
            self.multi_sum.d.next = !self.fields.multi_parity.val();
        }
        if self.take.val() & self.parts.has_identity.val() {
            self.identity.d.next = self.fields.byte_field.val();
        }
        if self.take.val() & self.parts.is_memory.val() {
            self.memory.d.next = self.fields.byte_field.val();
        }
        if self.take.val() & self.parts.has_alarm.val() {
            self.alarms.d.next = self.fields.alarm.val();
        }
        self.reading.result_strobe.next = self.strobe.q.val();
        self.reading.fresh.next = self.is_fresh.q.val();
        self.reading.sequence.next = self.count.q.val();
        self.reading.single_turn.next = self.single.q.val();
        self.reading.single_valid.next = self.has_had_single.q.val();
        self.reading.single_parity.next = self.single_sum.q.val() & self.has_guards.val();
        self.reading.multi_turn.next = self.multi.q.val();
        self.reading.multi_valid.next = self.has_had_multi.q.val();
        self.reading.multi_parity.next = self.multi_sum.q.val() & self.has_guards.val();
        self.reading.encoder_id.next = self.identity.q.val();
        self.reading.memory_data.next = self.memory.q.val();
        self.reading.alarm.next = self.alarms.q.val();
        self.reading.status.next = self.state.q.val();
        self.reading.crc.next = self.received.q.val();
        self.reading.reply_id.next = self.echo.q.val();
        // Error reports and alarms are in the status field; an alarm reported with an upset would hide the upset.
        self.alarm_flags.next = self.state.q.val().get_bits::<2>(4);
        if self.upset.q.val() {
            self.alarm_flags.next = 0.into();
        }
        self.reading.flags.next = bit_cast::<16, 9>(self.low_flags.q.val())
            | (bit_cast::<16, 2>(self.state.q.val().get_bits::<2>(6)) << 9)
            | (bit_cast::<16, 1>(self.memory_busy.q.val().into()) << 11)
            | (bit_cast::<16, 2>(self.alarm_flags.val()) << 12)
            | (bit_cast::<16, 1>(self.upset.q.val().into()) << 14)
            | (bit_cast::<16, 1>(self.overrun.q.val().into()) << 15);
    }
}
