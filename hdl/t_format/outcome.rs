//! Outcome: the result registers, changed in one clock cycle, with the last good position held, and the parity that it came with.

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
    /// Strobe: take what stands at the inputs.
    pub publish: Signal<In, Bit>,
    /// With `publish`: the reply is good.
    pub good: Signal<In, Bit>,
    /// Raw flags.
    pub flags_in: Signal<In, Bits<16>>,
    /// ID that the reply repeats.
    pub reply_id_in: Signal<In, Bits<4>>,
    /// CRC as received.
    pub crc_in: Signal<In, Bits<8>>,
    /// Status field.
    pub status_in: Signal<In, Bits<8>>,
    /// Single-turn position.
    pub single_turn_in: Signal<In, Bits<24>>,
    /// Multi-turn position.
    pub multi_turn_in: Signal<In, Bits<24>>,
    /// Parity of the single-turn position as it came.
    pub single_parity_in: Signal<In, Bit>,
    /// Parity of the multi-turn position as it came.
    pub multi_parity_in: Signal<In, Bit>,
    /// Kind of encoder, or EEPROM data.
    pub byte_in: Signal<In, Bits<8>>,
    /// Alarm field.
    pub alarm_in: Signal<In, Bits<8>>,
    /// The reply has a single-turn position.
    pub has_single: Signal<In, Bit>,
    /// It has a multi-turn position.
    pub has_multi: Signal<In, Bit>,
    /// It has the kind of encoder.
    pub has_identity: Signal<In, Bit>,
    /// It has alarms.
    pub has_alarm: Signal<In, Bit>,
    /// It has EEPROM data.
    pub is_memory: Signal<In, Bit>,
    /// A new result can be read from this cycle on.
    pub result_strobe: Signal<Out, Bit>,
    /// The last reply was good; low = what stands here is of an earlier one.
    pub fresh: Signal<Out, Bit>,
    /// Number of results, wrapping.
    pub sequence: Signal<Out, Bits<8>>,
    /// Last good single-turn position.
    pub single_turn: Signal<Out, Bits<24>>,
    /// There is one.
    pub single_valid: Signal<Out, Bit>,
    /// Parity of the single-turn position and `single_valid`.
    pub single_parity: Signal<Out, Bit>,
    /// Last good multi-turn position.
    pub multi_turn: Signal<Out, Bits<24>>,
    /// There is one.
    pub multi_valid: Signal<Out, Bit>,
    /// Parity of the multi-turn position and `multi_valid`.
    pub multi_parity: Signal<Out, Bit>,
    /// Kind of encoder, as it came last.
    pub encoder_id: Signal<Out, Bits<8>>,
    /// EEPROM data as they came last.
    pub memory_data: Signal<Out, Bits<8>>,
    /// Alarm field as it came last.
    pub alarm: Signal<Out, Bits<8>>,
    /// Status field of the last reply; 0 if none came.
    pub status: Signal<Out, Bits<8>>,
    /// CRC of the last reply.
    pub crc: Signal<Out, Bits<8>>,
    /// ID that the last reply repeats.
    pub reply_id: Signal<Out, Bits<4>>,
    /// Raw flags of the last exchange, see [`super::cause`].
    pub flags: Signal<Out, Bits<16>>,
    strobe: Reg<Bit>,
    is_fresh: Reg<Bit>,
    count: Reg<Bits<8>>,
    single: Reg<Bits<24>>,
    has_had_single: Reg<Bit>,
    multi: Reg<Bits<24>>,
    has_had_multi: Reg<Bit>,
    identity: Reg<Bits<8>>,
    memory: Reg<Bits<8>>,
    alarms: Reg<Bits<8>>,
    state: Reg<Bits<8>>,
    received: Reg<Bits<8>>,
    echo: Reg<Bits<4>>,
    low_flags: Reg<Bits<9>>,
    memory_busy: Reg<Bit>,
    upset: Reg<Bit>,
    overrun: Reg<Bit>,
    single_sum: Reg<Bit>,
    multi_sum: Reg<Bit>,
    take: Signal<Local, Bit>,
    alarm_flags: Signal<Local, Bits<2>>,
}

impl Logic for Outcome {
    #[kernel]
    fn update(&mut self) {
        self.strobe.d.next = self.publish.val();
        self.take.next = self.publish.val() & self.good.val();
        if self.publish.val() {
            self.is_fresh.d.next = self.good.val();
            self.count.d.next = self.count.q.val() + 1;
            self.state.d.next = self.status_in.val();
            self.received.d.next = self.crc_in.val();
            self.echo.d.next = self.reply_id_in.val();
            self.low_flags.d.next = self.flags_in.val().get_bits::<9>(0);
            self.memory_busy.d.next = self.flags_in.val().get_bit(11);
            self.upset.d.next = self.flags_in.val().get_bit(14);
            self.overrun.d.next = self.flags_in.val().get_bit(15);
        }
        if self.take.val() & self.has_single.val() {
            self.single.d.next = self.single_turn_in.val();
            self.has_had_single.d.next = true;
            self.single_sum.d.next = !self.single_parity_in.val();
        }
        if self.take.val() & self.has_multi.val() {
            self.multi.d.next = self.multi_turn_in.val();
            self.has_had_multi.d.next = true;
            self.multi_sum.d.next = !self.multi_parity_in.val();
        }
        if self.take.val() & self.has_identity.val() {
            self.identity.d.next = self.byte_in.val();
        }
        if self.take.val() & self.is_memory.val() {
            self.memory.d.next = self.byte_in.val();
        }
        if self.take.val() & self.has_alarm.val() {
            self.alarms.d.next = self.alarm_in.val();
        }
        self.result_strobe.next = self.strobe.q.val();
        self.fresh.next = self.is_fresh.q.val();
        self.sequence.next = self.count.q.val();
        self.single_turn.next = self.single.q.val();
        self.single_valid.next = self.has_had_single.q.val();
        self.single_parity.next = self.single_sum.q.val();
        self.multi_turn.next = self.multi.q.val();
        self.multi_valid.next = self.has_had_multi.q.val();
        self.multi_parity.next = self.multi_sum.q.val();
        self.encoder_id.next = self.identity.q.val();
        self.memory_data.next = self.memory.q.val();
        self.alarm.next = self.alarms.q.val();
        self.status.next = self.state.q.val();
        self.crc.next = self.received.q.val();
        self.reply_id.next = self.echo.q.val();
        // Complaints and alarms stand in the status field; an alarm beside it would hide an upset.
        self.alarm_flags.next = self.state.q.val().get_bits::<2>(4);
        if self.upset.q.val() {
            self.alarm_flags.next = 0.into();
        }
        self.flags.next = bit_cast::<16, 9>(self.low_flags.q.val())
            | (bit_cast::<16, 2>(self.state.q.val().get_bits::<2>(6)) << 9)
            | (bit_cast::<16, 1>(self.memory_busy.q.val().into()) << 11)
            | (bit_cast::<16, 2>(self.alarm_flags.val()) << 12)
            | (bit_cast::<16, 1>(self.upset.q.val().into()) << 14)
            | (bit_cast::<16, 1>(self.overrun.q.val().into()) << 15);
    }
}
