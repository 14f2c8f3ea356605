//! T-format port: one encoder as a channel of a card, with the result registers that EnDat channels have.
//!
//! ```text
//! trigger ------+--> Exchange -> data_o, data_oe
//! host -> send -+     ^  |
//! data_i -> InputFilter -+-> Reply -+-> Snapshot (triggers)    -> position, cause, ...
//!                                   +-> answer, fields (all)   -> host_word
//! ```
//!
//! A trigger or the host starts an exchange; only a triggered one gives a result. The position of a result is
//! multi-turn (bits 47..24) and single-turn (23..0); a part that the reply does not bring stays unchanged.

use super::cause;
use super::exchange::Exchange;
use super::ports::FieldBitsOut;
use super::reply::Reply;
use crate::endat::features::Features;
use crate::input_filter::InputFilter;
use crate::lowest_cause::LowestCause;
use crate::ports::FrameResultOut;
use crate::snapshot::{Snapshot, Withdrawal};
use endat_macros::kernel;
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;

pub use endat_regs::protocols::t_format::word;

/// Port of one T-format encoder.
#[derive(LogicBlock, Block)]
#[properties("../../properties/t_format_port.sv")]
pub struct TFormatPort {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Free-running time in system clock cycles.
    pub timestamp: Signal<In, Bits<32>>,
    /// One-cycle strobe: read a position.
    pub trigger: Signal<In, Bit>,
    /// Line from the transceiver, asynchronous, idle HIGH.
    pub data_i: Signal<In, Bit>,
    /// Request ID of a triggered exchange, except EEPROM requests; constant while `busy`, as all settings.
    pub request_id: Signal<In, Bits<4>>,
    /// System clock cycles in a bit, 8 to 127; below 8, 8 is added.
    pub bit_cycles: Signal<In, Bits<7>>,
    /// Longest pause before the reply, in microseconds.
    pub reply_gap_us: Signal<In, Bits<6>>,
    /// Longest pause between two fields, in microseconds.
    pub field_gap_us: Signal<In, Bits<3>>,
    /// Pulses of at most this many system clock cycles are ignored; less than half a bit.
    pub filter_cycles: Signal<In, Bits<4>>,
    /// Line to the transceiver, from a register.
    pub data_o: Signal<Out, Bit>,
    /// Driver enable of the transceiver, from a register.
    pub data_oe: Signal<Out, Bit>,
    /// A trigger would be lost.
    pub busy: Signal<Out, Bit>,
    /// Strobe: an exchange has ended.
    pub over: Signal<Out, Bit>,
    /// The exchange was requested by the host.
    pub over_request: Signal<Out, Bit>,
    /// Strobe: a trigger is lost.
    pub trigger_lost: Signal<Out, Bit>,
    /// Result of a trigger.
    #[bundle]
    pub result: FrameResultOut,
    /// Word that the host accesses, counted from the first of the port in the register map.
    pub host_address: Signal<In, Bits<3>>,
    /// Strobe: read the word.
    pub host_read: Signal<In, Bit>,
    /// The word read.
    pub host_word: Signal<Out, Bits<32>>,
    /// Strobe: write one half of the word.
    pub host_write: Signal<In, Bit>,
    /// Half to write: 1 = high. If written last, the low half acts.
    pub host_half: Signal<In, Bit>,
    /// Data to write.
    pub host_data: Signal<In, Bits<16>>,
    /// Synchroniser and filter of the line.
    filter: InputFilter,
    /// Request and reply.
    exchange: Exchange,
    /// Fields of the reply while it is received.
    #[start]
    reply: Reply,
    /// Cause of the result.
    #[start]
    primary: LowestCause,
    /// Result registers.
    snapshot: Snapshot,
    /// Microseconds of rest after an exchange, before the next one.
    rest: Reg<Bits<2>>,
    /// High from the start bit of a request to the end of the exchange.
    started: Reg<Bit>,
    /// High if a trigger was lost, until the result of a trigger reports it.
    lost: Reg<Bit>,
    /// High in the cycle after a trigger was lost.
    is_lost: Reg<Bit>,
    /// High if the exchange under way was requested by the host.
    own: Reg<Bit>,
    /// Second copy of `own`, compared with it as a guard.
    own_too: Reg<Bit>,
    /// High from a write of the high half of the word `send`, if it was accepted, to that of the low half.
    armed: Reg<Bit>,
    /// High from the host's request until its exchange begins.
    pending: Reg<Bit>,
    /// Request ID of the host's request.
    send_id: Reg<Bits<4>>,
    /// EEPROM address of the host's request.
    send_address: Reg<Bits<7>>,
    /// EEPROM data of the host's request.
    send_data: Reg<Bits<8>>,
    /// Parity of the host's request as written; wrong after it is sent and before one is written.
    #[start(true)]
    send_sum: Reg<Bit>,
    /// EEPROM data, last received.
    memory: Reg<Bits<8>>,
    /// ID echoed in the reply to the host's request.
    echo: Reg<Bits<4>>,
    /// Cause of the host's exchange; 0 = good.
    own_cause: Reg<Bits<4>>,
    /// High if the host's exchange has ended; cleared by the next request.
    done: Reg<Bit>,
    /// Status field of the last reply.
    status: Reg<Bits<8>>,
    /// Kind of encoder, last received.
    identity: Reg<Bits<8>>,
    /// Alarm field, last received.
    alarms: Reg<Bits<8>>,
    /// CRC of the last reply.
    crc: Reg<Bits<8>>,
    /// High if the position has a single-turn part.
    has_had_single: Reg<Bit>,
    /// High if the position has a multi-turn part.
    has_had_multi: Reg<Bit>,
    /// Word for the host, latched at the strobe of its read.
    shown: Reg<Bits<32>>,
    /// 1 if upsets of stored bits are detected.
    has_guards: Constant<Bit>,
    /// High while an exchange is under way, or the rest after it.
    is_busy: Signal<Local, Bit>,
    /// High if both copies mark the exchange as the host's.
    is_own: Signal<Local, Bit>,
    /// High if the two copies differ: an upset.
    is_torn: Signal<Local, Bit>,
    /// Parity of the host's request as stored.
    send_sum_now: Signal<Local, Bit>,
    /// High if the host's request is stored as written.
    send_fits: Signal<Local, Bit>,
    /// High if the positions match their parity, and the owner of the exchange is certain.
    reply_fits: Signal<Local, Bit>,
    /// High if the reply is good.
    good: Signal<Local, Bit>,
    /// High while a request of the host waits or is under way.
    own_busy: Signal<Local, Bit>,
    /// High for one cycle when the host's exchange begins.
    own_start: Signal<Local, Bit>,
    /// High if the exchange that begins or is under way was requested by the host.
    own_now: Signal<Local, Bit>,
    /// High for one cycle when an exchange begins.
    begins: Signal<Local, Bit>,
    /// High for one cycle when the host writes the word `send`.
    sends: Signal<Local, Bit>,
    /// High for one cycle when a result brings a good position.
    takes: Signal<Local, Bit>,
    /// High if the result of this exchange reports a lost trigger.
    overrun: Signal<Local, Bit>,
    /// High for one cycle when a trigger is lost.
    loses: Signal<Local, Bit>,
    /// Raw flags of the exchange, including an upset of stored bits.
    sum_flags: Signal<Local, Bits<16>>,
    /// Raw flags of the result.
    flags_in: Signal<Local, Bits<16>>,
    /// Primary cause of the result.
    code: Signal<Local, Bits<5>>,
    /// Single-turn part of the position: from the reply, or unchanged.
    single: Signal<Local, Bits<24>>,
    /// Multi-turn part of the position: from the reply, or unchanged.
    multi: Signal<Local, Bits<24>>,
    /// Word that the host's address selects.
    chosen: Signal<Local, Bits<32>>,
}

impl TFormatPort {
    /// A port; `guards` check for upsets of stored bits.
    pub fn new(guards: bool) -> Self {
        Self::from_parts(TFormatPortParts {
            has_guards: Constant::new(guards),
            filter: InputFilter::new(Features::NONE),
            exchange: Exchange::new(guards),
            snapshot: Snapshot::new(
                Withdrawal::Never,
                guards,
                cause::UPSET,
                cause::flag(cause::UPSET),
            ),
        })
    }
}

#[kernel]
impl Logic for TFormatPort {
    fn update(&mut self) {
        clock!(self, clock, filter, exchange, reply, snapshot);
        self.filter.reset.next = self.reset.val();
        self.exchange.reset.next = self.reset.val();
        self.reply.reset.next = self.reset.val();
        self.snapshot.reset.next = self.reset.val();
        self.started.reset.next = self.reset.val() | !self.exchange.busy.val();
        self.choose_turn();
        self.take_request();
        self.run_exchange();
        self.judge();
        self.show_result();
        self.answer_host();
    }

    /// Arbitrates: triggers first, then the host. The encoder gets a rest between two exchanges.
    fn choose_turn(&mut self) {
        self.is_busy.next = self.exchange.busy.val() | self.rest.q.val().any();
        self.own_start.next = self.pending.q.val() & !self.is_busy.val() & !self.trigger.val();
        self.begins.next = !self.is_busy.val() & (self.trigger.val() | self.pending.q.val());
        self.own_now.next = self.own_start.val();
        // Stored twice with guards: the owner of the exchange decides what is sent, and who gets the result.
        self.is_own.next = self.own.q.val();
        self.is_torn.next = false;
        if self.has_guards.val() {
            self.is_own.next = self.own.q.val() & self.own_too.q.val();
            self.is_torn.next = self.own.q.val() ^ self.own_too.q.val();
        }
        if self.is_busy.val() {
            self.own_now.next = self.is_own.val();
        }
        self.own.d.next = self.own_start.val();
        self.own_too.d.next = self.own_start.val();
        if self.is_busy.val() {
            self.own.d.next = self.own.q.val();
            self.own_too.d.next = self.own_too.q.val();
        }
        self.own_busy.next = self.pending.q.val() | (self.is_own.val() & self.exchange.busy.val());
        if self.tick_us.val() & self.rest.q.val().any() {
            self.rest.d.next = self.rest.q.val() - 1;
        }
        if self.exchange.publish.val() {
            self.rest.d.next = 2.into();
        }
    }

    /// The host's request: ignored while one is pending.
    fn take_request(&mut self) {
        self.send_sum_now.next = self.send_id.q.val().xor()
            ^ self.send_address.q.val().xor()
            ^ self.send_data.q.val().xor();
        self.send_fits.next =
            !self.has_guards.val() | (self.send_sum_now.val() == self.send_sum.q.val());
        // It is sent once.
        if self.exchange.publish.val() & self.is_own.val() {
            self.send_sum.d.next = !self.send_sum_now.val();
        }
        self.sends.next = self.host_write.val() & !self.host_address.val().any();
        if self.sends.val() {
            if self.host_half.val() {
                self.armed.d.next = !self.own_busy.val();
                if !self.own_busy.val() {
                    self.send_id.d.next = half!(self.host_data.val(), t_format.send.id);
                    self.send_sum.d.next = half!(self.host_data.val(), t_format.send.id).xor();
                }
            } else {
                self.armed.d.next = false;
                if self.armed.q.val() {
                    self.send_data.d.next = half!(self.host_data.val(), t_format.send.data);
                    self.send_address.d.next = half!(self.host_data.val(), t_format.send.address);
                    self.send_sum.d.next =
                        self.send_sum.q.val() ^ self.host_data.val().get_bits::<15>(0).xor();
                    self.pending.d.next = true;
                    self.done.d.next = false;
                }
            }
        }
        if self.own_start.val() {
            self.pending.d.next = false;
        }
    }

    /// The exchange, and the fields of its reply.
    fn run_exchange(&mut self) {
        connect!(self.filter <= self; pin = data_i, filter_cycles);
        self.filter.filter_half.next = false;
        self.filter.majority.next = false;
        self.filter.both_edges.next = false;
        connect!(self.exchange <= self; tick_us, trigger = begins);
        // A trigger never accesses the EEPROM: address and data belong to the host, and may change at any time.
        self.exchange.request_id.next = self.request_id.val();
        if (self.request_id.val() == 6) | (self.request_id.val() == 13) {
            self.exchange.request_id.next = 15.into();
        }
        if self.own_now.val() {
            self.exchange.request_id.next = self.send_id.q.val();
        }
        self.exchange.request_fits.next = !self.own_now.val() | self.send_fits.val();
        self.exchange.hold.next = false;
        self.exchange.address.next = self.send_address.q.val();
        self.exchange.data.next = self.send_data.q.val();
        // A bit of one cycle would have no middle.
        self.exchange.bit_cycles.next = self.bit_cycles.val();
        if !self.bit_cycles.val().get_bits::<4>(3).any() {
            self.exchange.bit_cycles.next = self.bit_cycles.val() | 8;
        }
        connect!(self.exchange <= self; reply_gap_us, field_gap_us);
        self.exchange.level.next = self.filter.level.val();
        self.exchange.status.next = self.reply.fields.status.val();
        connect!(self <= self.exchange; data_o = tx, data_oe = driver);
        self.busy.next = self.is_busy.val();

        self.reply.idle.next = !self.exchange.busy.val();
        self.reply.take.next = self.exchange.take.val();
        self.reply.level.next = self.filter.level.val();
        FieldBitsOut::join(&mut self.exchange.field, &mut self.reply.field);
    }

    /// Checks of the reply.
    fn judge(&mut self) {
        // The result of the exchange under way, or of the next one, reports a lost trigger.
        self.overrun.next = self.lost.q.val() & !self.is_own.val();
        if self.exchange.publish.val() & !self.is_own.val() {
            self.lost.d.next = false;
        }
        self.loses.next = self.trigger.val() & self.is_busy.val();
        self.is_lost.d.next = self.loses.val();
        self.trigger_lost.next = self.is_lost.q.val();
        if self.loses.val() {
            self.lost.d.next = true;
        }
        // The stored bits are the received bits, and their owner is certain.
        self.reply_fits.next = !self.is_torn.val();
        if self.has_guards.val()
            & self.exchange.parts.has_single.val()
            & (self.reply.fields.single_turn.val().xor() != self.reply.fields.single_parity.val())
        {
            self.reply_fits.next = false;
        }
        if self.has_guards.val()
            & self.exchange.parts.has_multi.val()
            & (self.reply.fields.multi_turn.val().xor() != self.reply.fields.multi_parity.val())
        {
            self.reply_fits.next = false;
        }
        self.good.next = self.exchange.good.val() & self.reply_fits.val();
        self.sum_flags.next = bit_cast::<16, 15>(self.exchange.flags.val().get_bits::<15>(0));
        if !self.reply_fits.val() {
            // An alarm reported with an upset would hide the upset.
            self.sum_flags.next =
                bit_cast::<16, 12>(self.exchange.flags.val().get_bits::<12>(0)) | 0x4000;
        }
        // Any other fault explains the wrong parity.
        if self.exchange.flags.val().get_bits::<12>(0).any() {
            self.sum_flags.next =
                bit_cast::<16, 15>(self.exchange.flags.val().get_bits::<15>(0) & 0x3FFF);
        }
        self.flags_in.next =
            self.sum_flags.val() | (bit_cast::<16, 1>(self.overrun.val().into()) << 15);
        self.primary.flags.next = self.flags_in.val();
        self.code.next = self.primary.cause.val();
    }

    /// Outputs the last good position. A part that the reply does not bring stays unchanged, if it was good.
    fn show_result(&mut self) {
        self.single.next = 0.into();
        if self.has_had_single.q.val() {
            self.single.next = self.snapshot.result.position.val().get_bits::<24>(0);
        }
        if self.exchange.parts.has_single.val() {
            self.single.next = self.reply.fields.single_turn.val();
        }
        self.multi.next = 0.into();
        if self.has_had_multi.q.val() {
            self.multi.next = self.snapshot.result.position.val().get_bits::<24>(24);
        }
        if self.exchange.parts.has_multi.val() {
            self.multi.next = self.reply.fields.multi_turn.val();
        }
        self.started.d.next = self.started.q.val() | !self.exchange.tx.val();
        self.takes.next = self.exchange.publish.val()
            & self.good.val()
            & !self.is_own.val()
            & (self.exchange.parts.has_single.val() | self.exchange.parts.has_multi.val());
        connect!(self.snapshot <= self; tick_us, timestamp);
        self.snapshot.first_fall.next = !self.exchange.tx.val() & !self.started.q.val();
        self.snapshot.latched.next = false;
        self.snapshot.delay_cycles.next = 0.into();
        self.snapshot.told.publish.next = self.exchange.publish.val() & !self.is_own.val();
        self.snapshot.told.good.next = self.takes.val();
        // All faults of an exchange are known before its end.
        self.snapshot.told.late_fault.next = false;
        self.snapshot.told.withdraw.next = false;
        self.snapshot.told.confirm.next = true;
        self.snapshot.width_in.next = 0.into();
        self.snapshot.has_f2_in.next = false;
        self.snapshot.position_in.next =
            bit_cast::<48, 24>(self.single.val()) | (bit_cast::<48, 24>(self.multi.val()) << 24);
        self.snapshot.crc_received_in.next = 0.into();
        self.snapshot.crc_computed_in.next = 0.into();
        self.snapshot.told.cause_told.next = self.code.val();
        self.snapshot.told.flags_told.next = bit_cast::<20, 16>(self.flags_in.val());
        self.over.next = self.exchange.publish.val();
        self.over_request.next = self.is_own.val();
        FrameResultOut::link(&mut self.result, &mut self.snapshot.result);
    }

    /// Content of the host's words. A position that the snapshot has withdrawn is not shown.
    fn answer_host(&mut self) {
        if !self.snapshot.result.position_valid.val() {
            self.has_had_single.d.next = false;
            self.has_had_multi.d.next = false;
        }
        if self.takes.val() & self.exchange.parts.has_single.val() {
            self.has_had_single.d.next = true;
        }
        if self.takes.val() & self.exchange.parts.has_multi.val() {
            self.has_had_multi.d.next = true;
        }
        if self.exchange.publish.val() {
            self.status.d.next = self.reply.fields.status.val();
            self.crc.d.next = self.exchange.crc.val();
            if self.is_own.val() | self.is_torn.val() {
                self.echo.d.next = self.exchange.reply_id.val();
                self.own_cause.d.next = self.code.val().get_bits::<4>(0);
                self.done.d.next = true;
            }
            if self.good.val() {
                if self.exchange.parts.has_identity.val() {
                    self.identity.d.next = self.reply.fields.byte_field.val();
                }
                if self.exchange.parts.has_alarm.val() {
                    self.alarms.d.next = self.reply.fields.alarm.val();
                }
                if self.exchange.parts.is_memory.val() {
                    self.memory.d.next = self.reply.fields.byte_field.val();
                }
            }
        }
        self.chosen.next = 0.into();
        match self.host_address.val().index() {
            offset!(t_format.answer) => {
                self.chosen.next = place!(self.memory.q.val(), t_format.answer.data)
                    | place!(self.echo.q.val(), t_format.answer.id)
                    | place!(self.own_cause.q.val(), t_format.answer.cause)
                    | place!(self.done.q.val(), t_format.answer.done)
                    | place!(self.own_busy.val(), t_format.answer.busy);
            }
            offset!(t_format.fields) => {
                self.chosen.next = place!(self.status.q.val(), t_format.fields.status)
                    | place!(self.identity.q.val(), t_format.fields.encoder_id)
                    | place!(self.alarms.q.val(), t_format.fields.alarm)
                    | place!(self.crc.q.val(), t_format.fields.crc);
            }
            offset!(t_format.parts) => {
                self.chosen.next = place!(self.has_had_single.q.val(), t_format.parts.single_valid)
                    | place!(self.has_had_multi.q.val(), t_format.parts.multi_valid);
            }
            _ => {}
        }
        // The word is latched, because its bytes are fetched one after the other.
        if self.host_read.val() {
            self.shown.d.next = self.chosen.val();
        }
        self.host_word.next = self.shown.q.val();
    }
}

#[cfg(test)]
mod tests;
