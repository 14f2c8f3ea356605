//! One T-format port: input filter, exchange, reply and result registers.
//!
//! ```text
//! trigger -> Exchange -> tx, driver
//!              ^  |
//! rx -> InputFilter -> Reply -> Outcome -> single_turn, multi_turn, flags, ...
//! ```

use super::exchange::Exchange;
use super::outcome::Outcome;
use super::ports::{FieldBitsOut, FieldsOut, ReadingOut, ReplyPartsOut};
use super::reply::Reply;
use crate::endat::features::Features;
use crate::input_filter::InputFilter;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Receiver of one T-format encoder.
#[derive(LogicBlock, Block)]
pub struct TFormatChannel {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Strobe: send the request.
    pub trigger: Signal<In, Bit>,
    /// Request ID; constant while `busy`, as all settings.
    pub request_id: Signal<In, Bits<4>>,
    /// EEPROM address of requests 6 and D.
    pub address: Signal<In, Bits<7>>,
    /// EEPROM data of request 6.
    pub data: Signal<In, Bits<8>>,
    /// System clock cycles in a bit, 4 to 31.
    pub bit_cycles: Signal<In, Bits<5>>,
    /// Longest pause before the reply, in microseconds.
    pub reply_gap_us: Signal<In, Bits<6>>,
    /// Longest pause between two fields, in microseconds.
    pub field_gap_us: Signal<In, Bits<3>>,
    /// Pulses of at most this many system clock cycles are ignored; less than half a bit.
    pub filter_cycles: Signal<In, Bits<4>>,
    /// Line from the transceiver, asynchronous, idle HIGH.
    pub rx: Signal<In, Bit>,
    /// Line to the transceiver.
    pub tx: Signal<Out, Bit>,
    /// Driver enable of the transceiver, two registers that must agree.
    pub driver: Signal<Out, Bit>,
    /// An exchange is under way.
    pub busy: Signal<Out, Bit>,
    /// Outputs of a receiver without registers.
    #[bundle]
    pub reading: ReadingOut,
    /// Synchroniser and filter of the line.
    filter: InputFilter,
    /// Request and reply.
    exchange: Exchange,
    /// Fields of the reply while it is received.
    #[start]
    reply: Reply,
    /// Result registers.
    outcome: Outcome,
}

impl TFormatChannel {
    /// A channel; `guards` check for upsets of stored bits.
    pub fn new(guards: bool) -> Self {
        Self::from_parts(TFormatChannelParts {
            exchange: Exchange::new(guards),
            outcome: Outcome::new(guards),
            filter: InputFilter::new(Features::NONE),
        })
    }
}

#[kernel]
impl Logic for TFormatChannel {
    fn update(&mut self) {
        clock!(self, clock, filter, exchange, reply, outcome);
        self.filter.reset.next = self.reset.val();
        self.exchange.reset.next = self.reset.val();
        self.reply.reset.next = self.reset.val();
        self.outcome.reset.next = self.reset.val();

        connect!(self.filter <= self; pin = rx, filter_cycles);
        self.filter.filter_half.next = false;
        self.filter.majority.next = false;
        self.filter.both_edges.next = false;

        connect!(self.exchange <= self; tick_us, trigger, request_id);
        self.exchange.hold.next = false;
        connect!(self.exchange <= self; address, data);
        self.exchange.request_fits.next = true;
        self.exchange.bit_cycles.next = bit_cast::<7, 5>(self.bit_cycles.val());
        connect!(self.exchange <= self; reply_gap_us, field_gap_us);
        self.exchange.level.next = self.filter.level.val();
        self.exchange.status.next = self.reply.fields.status.val();
        connect!(self <= self.exchange; tx, driver, busy);

        self.reply.idle.next = !self.exchange.busy.val();
        self.reply.take.next = self.exchange.take.val();
        self.reply.level.next = self.filter.level.val();
        FieldBitsOut::join(&mut self.exchange.field, &mut self.reply.field);

        connect!(self.outcome <= self.exchange;
            publish, good, flags_in = flags, reply_id_in = reply_id, crc_in = crc
        );
        FieldsOut::join(&mut self.reply.fields, &mut self.outcome.fields);
        ReplyPartsOut::join(&mut self.exchange.parts, &mut self.outcome.parts);
        ReadingOut::link(&mut self.reading, &mut self.outcome.reading);
    }
}
