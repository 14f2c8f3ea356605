//! Exchange: one request and its reply, from the trigger to the verdict.
//!
//! ```text
//! trigger --> Send --> Release --> Wait <--> Field --> Judge --> Rest
//!  (refused: --> Judge)             \-- time-out --------^
//!
//! line    ~~~~\______________/~~~~~~~\_______X  ID ..
//!         idle| start | sync0 | sync1 | sync2
//!             ^ Field         ^ bits are timed from here
//! ```
//!
//! A rising edge is the header if the two cells before it were LOW, its own is HIGH and the next one LOW. LOW pulses of less than a
//! bit and a half are passed over until the reply gap has ended. Later fields are timed from their start bits.
//!
//! After a reply that did not come whole the next request waits until the line has been HIGH for longer than any field lasts. After a reset, which
//! may have come in the middle of an exchange, it waits for the longest pause before a reply that there may be, 63 us, as well.
//! Two states that do not know of each other must agree that a request is under way before the driver is on, and one that lasts too long is
//! cut. From the header on a reply is refused if its level changes twice within half a bit.

mod kernel;

use super::bit_grid::BitGrid;
use super::field_order::FieldOrder;
use super::ports::{FieldBitsOut, ReplyPartsOut};
use super::request_bits::RequestBits;
use rtl_design::reg::Reg;
use rtl_design::{Block, States};
use rust_hdl::prelude::*;

/// Where the exchange is.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum Phase {
    /// Nothing to do.
    Rest,
    /// A field of the request is sent.
    Send,
    /// The last delimiter of the request is on the line.
    Release,
    /// Waiting for a field to begin.
    Wait,
    /// A field of the reply is taken.
    Field,
    /// The result is published.
    Judge,
}

/// Longest pause before a reply that can be set, in microseconds.
const REPLY_GAP_MAX_US: u64 = 63;

/// Order, timing and checks of an exchange.
#[derive(LogicBlock, Block)]
#[properties("../../properties/exchange.sv")]
pub struct Exchange {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Strobe: begin an exchange.
    pub trigger: Signal<In, Bit>,
    /// Request ID; constant while `busy`, as all settings.
    pub request_id: Signal<In, Bits<4>>,
    /// EEPROM address of requests 6 and D.
    pub address: Signal<In, Bits<7>>,
    /// EEPROM data of request 6.
    pub data: Signal<In, Bits<8>>,
    /// System clock cycles in a bit, 4 to 127.
    pub bit_cycles: Signal<In, Bits<7>>,
    /// Longest pause before the reply, in microseconds.
    pub reply_gap_us: Signal<In, Bits<6>>,
    /// Longest pause between two fields, in microseconds.
    pub field_gap_us: Signal<In, Bits<3>>,
    /// The line after synchroniser and filter.
    pub level: Signal<In, Bit>,
    /// Status field of the reply, 0 before it has come.
    pub status: Signal<In, Bits<8>>,
    /// What is to be sent is what was asked for; a request that does not fit is cut.
    pub request_fits: Signal<In, Bit>,
    /// Stay with the verdict: `publish` and all that belongs to it stand still.
    pub hold: Signal<In, Bit>,
    /// Line to the encoder, from a register.
    pub tx: Signal<Out, Bit>,
    /// Driver enable, two registers that must agree: the request only.
    pub driver: Signal<Out, Bit>,
    /// An exchange is under way.
    pub busy: Signal<Out, Bit>,
    /// Strobe: `level` is a data bit of the reply.
    pub take: Signal<Out, Bit>,
    /// Which field of the reply a data bit belongs to.
    #[bundle]
    pub field: FieldBitsOut,
    /// Strobe: the exchange has ended; what follows belongs to it.
    pub publish: Signal<Out, Bit>,
    /// The reply is good.
    pub good: Signal<Out, Bit>,
    /// Raw flags, one bit for each fault; bits as in the register map.
    pub flags: Signal<Out, Bits<16>>,
    /// The ID that the reply repeats.
    pub reply_id: Signal<Out, Bits<4>>,
    /// CRC of the reply as received.
    pub crc: Signal<Out, Bits<8>>,
    /// What replies to a request bring.
    #[bundle]
    pub parts: ReplyPartsOut,
    #[start]
    grid: BitGrid,
    #[start]
    order: FieldOrder,
    #[start]
    bits: RequestBits,
    phase: Reg<Phase>,
    index: Reg<Bits<4>>,
    #[start(REPLY_GAP_MAX_US.into())]
    timer: Reg<Bits<7>>,
    previous: Reg<Bit>,
    #[start(true)]
    line: Reg<Bit>,
    drives: Reg<Bit>,
    enabled: Reg<Bit>,
    run: Reg<Bits<6>>,
    owed: Reg<Bit>,
    bits_mod_3: Reg<Bits<2>>,
    // The line may still carry a reply: a request is refused.
    #[start(true)]
    unsettled: Reg<Bit>,
    check: Reg<Bits<8>>,
    echo: Reg<Bits<4>>,
    refused: Reg<Bit>,
    heard: Reg<Bit>,
    missed: Reg<Bit>,
    bad_parity: Reg<Bit>,
    bad_echo: Reg<Bit>,
    bad_delimiter: Reg<Bit>,
    bad_crc: Reg<Bit>,
    memory_busy: Reg<Bit>,
    overrun: Reg<Bit>,
    upset: Reg<Bit>,
    has_guards: Constant<Bit>,
    in_request: Signal<Local, Bit>,
    turns: Signal<Local, Bit>,
    half_bit: Signal<Local, Bits<7>>,
    too_soon: Signal<Local, Bit>,
    alarms: Signal<Local, Bits<2>>,
    in_field: Signal<Local, Bit>,
    is_ended: Signal<Local, Bit>,
    is_astray: Signal<Local, Bit>,
    rising: Signal<Local, Bit>,
    forget: Signal<Local, Bit>,
    expired: Signal<Local, Bit>,
    is_start: Signal<Local, Bit>,
    is_bit: Signal<Local, Bit>,
    in_sync: Signal<Local, Bit>,
    retimed: Signal<Local, Bit>,
    strobe: Signal<Local, Bit>,
    sampled: Signal<Local, Bit>,
    differs: Signal<Local, Bit>,
    wire_bit: Signal<Local, Bit>,
    summed: Signal<Local, Bit>,
    is_unknown: Signal<Local, Bit>,
    is_not_idle: Signal<Local, Bit>,
    is_silent: Signal<Local, Bit>,
    is_headless: Signal<Local, Bit>,
    is_short: Signal<Local, Bit>,
    rest_us: Signal<Local, Bits<7>>,
    request_us: Signal<Local, Bits<7>>,
    raised: Signal<Local, Bits<16>>,
    is_whole: Signal<Local, Bit>,
    is_good: Signal<Local, Bit>,
}

impl Exchange {
    /// An exchange; `guards` look for upsets of its registers.
    pub fn new(guards: bool) -> Self {
        Self::from_parts(ExchangeParts {
            has_guards: Constant::new(guards),
        })
    }
}
