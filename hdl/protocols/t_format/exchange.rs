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
//! bit and a half are ignored until the reply gap has ended. Later fields are timed from their start bits.
//!
//! After an incomplete reply the next request waits until the line has been HIGH for longer than any field lasts. A reset may
//! come in the middle of an exchange; after it the next request also waits for the longest possible pause before a reply, 63 us.
//! The driver is on only if two independent states agree that a request is under way, and a request that lasts too long is
//! cut. From the header on a reply is rejected if its level changes twice within half a bit.

mod kernel;

use super::bit_grid::BitGrid;
use super::field_order::FieldOrder;
use super::ports::{FieldBitsOut, ReplyPartsOut};
use super::request_bits::RequestBits;
use rtl_design::reg::Reg;
use rtl_design::{Block, States};
use rust_hdl::prelude::*;

/// Phase of the exchange.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum Phase {
    /// Idle.
    Rest,
    /// A field of the request is sent.
    Send,
    /// The last delimiter of the request is on the line.
    Release,
    /// Waiting for a field to begin.
    Wait,
    /// A field of the reply is received.
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
    /// Status field of the reply, 0 before it is received.
    pub status: Signal<In, Bits<8>>,
    /// The request to be sent is the requested one; otherwise it is cut.
    pub request_fits: Signal<In, Bit>,
    /// Keep the verdict: `publish` and its outputs do not change.
    pub hold: Signal<In, Bit>,
    /// Line to the encoder, from a register.
    pub tx: Signal<Out, Bit>,
    /// Driver enable, two registers that must agree: the request only.
    pub driver: Signal<Out, Bit>,
    /// An exchange is under way.
    pub busy: Signal<Out, Bit>,
    /// Strobe: `level` is a data bit of the reply.
    pub take: Signal<Out, Bit>,
    /// Field of the reply that a data bit belongs to.
    #[bundle]
    pub field: FieldBitsOut,
    /// Strobe: the exchange has ended; the outputs below belong to it.
    pub publish: Signal<Out, Bit>,
    /// The reply is good.
    pub good: Signal<Out, Bit>,
    /// Raw flags, one bit for each fault; bits as in the register map.
    pub flags: Signal<Out, Bits<16>>,
    /// ID echoed in the reply.
    pub reply_id: Signal<Out, Bits<4>>,
    /// CRC of the reply as received.
    pub crc: Signal<Out, Bits<8>>,
    /// Parts in the reply to a request.
    #[bundle]
    pub parts: ReplyPartsOut,
    /// Timing of the bits.
    #[start]
    grid: BitGrid,
    /// Order of the fields.
    #[start]
    order: FieldOrder,
    /// Bits of the request.
    #[start]
    bits: RequestBits,
    /// Phase of the exchange.
    phase: Reg<Phase>,
    /// Bit of the field: 15 = start bit, 0 to 7 = data, 8 = delimiter.
    index: Reg<Bits<4>>,
    /// Microseconds until the wait ends; counts below zero. Starts with the longest reply gap, after a reset.
    #[start(REPLY_GAP_MAX_US.into())]
    timer: Reg<Bits<7>>,
    /// Line of the cycle before.
    previous: Reg<Bit>,
    /// Line to the encoder; HIGH at rest.
    #[start(true)]
    line: Reg<Bit>,
    /// High from the start of a request to its end; first of two registers that enable the driver.
    drives: Reg<Bit>,
    /// High while the phase is one of a request; second register that enables the driver.
    enabled: Reg<Bit>,
    /// System clock cycles until half a bit has passed since the last edge.
    run: Reg<Bits<6>>,
    /// High from a request to its verdict.
    owed: Reg<Bit>,
    /// Bits of the field so far, modulo 3, to find an upset of `index`.
    bits_mod_3: Reg<Bits<2>>,
    /// High while the line may still carry a reply: requests are rejected.
    #[start(true)]
    unsettled: Reg<Bit>,
    /// Check sum of the fields so far; its bits become the CRC.
    check: Reg<Bits<8>>,
    /// ID echoed in the reply.
    echo: Reg<Bits<4>>,
    /// High if the request was rejected.
    refused: Reg<Bit>,
    /// High if a start bit was received since the request.
    heard: Reg<Bit>,
    /// High if a field did not come in time, or the header was wrong.
    missed: Reg<Bit>,
    /// High if the parity of the control field is wrong.
    bad_parity: Reg<Bit>,
    /// High if the reply echoes another ID or EEPROM address.
    bad_echo: Reg<Bit>,
    /// High if a delimiter was LOW.
    bad_delimiter: Reg<Bit>,
    /// High if the CRC is wrong, or the line had a pulse shorter than half a bit.
    bad_crc: Reg<Bit>,
    /// High if the encoder reports that its EEPROM is busy.
    memory_busy: Reg<Bit>,
    /// High if a trigger came during an exchange, until a verdict reports it.
    overrun: Reg<Bit>,
    /// High if an upset was found in this exchange.
    upset: Reg<Bit>,
    /// 1 if upsets of stored bits are detected.
    has_guards: Constant<Bit>,
    /// High while a request is sent.
    in_request: Signal<Local, Bit>,
    /// High for one cycle at each edge of the line.
    turns: Signal<Local, Bit>,
    /// Half a bit, in system clock cycles.
    half_bit: Signal<Local, Bits<7>>,
    /// High if an edge of the control field now is not a header.
    too_soon: Signal<Local, Bit>,
    /// Alarms of the status field; 0 after an upset.
    alarms: Signal<Local, Bits<2>>,
    /// High while a field is sent or taken.
    in_field: Signal<Local, Bit>,
    /// High if the exchange has reached one of its regular ends.
    is_ended: Signal<Local, Bit>,
    /// High if an upset was found, or a verdict comes when none is due.
    is_astray: Signal<Local, Bit>,
    /// High for one cycle at a rising edge of the line.
    rising: Signal<Local, Bit>,
    /// High while the notes of the last exchange are cleared.
    forget: Signal<Local, Bit>,
    /// High if the wait has ended.
    expired: Signal<Local, Bit>,
    /// High at the start bit.
    is_start: Signal<Local, Bit>,
    /// High at a data bit.
    is_bit: Signal<Local, Bit>,
    /// High in the sync code of the control field.
    in_sync: Signal<Local, Bit>,
    /// High for one cycle when an edge of the sync code times the bits that follow.
    retimed: Signal<Local, Bit>,
    /// High for one cycle in the middle of each bit.
    strobe: Signal<Local, Bit>,
    /// High for one cycle when a bit of the reply is sampled.
    sampled: Signal<Local, Bit>,
    /// High if the bit is not the one that was sent, or is expected.
    differs: Signal<Local, Bit>,
    /// Bit on the line, in either direction.
    wire_bit: Signal<Local, Bit>,
    /// Bit that enters the check sum.
    summed: Signal<Local, Bit>,
    /// High if the request was rejected because its ID is unknown.
    is_unknown: Signal<Local, Bit>,
    /// High if the request was rejected because the line was not at rest.
    is_not_idle: Signal<Local, Bit>,
    /// High if no start bit came.
    is_silent: Signal<Local, Bit>,
    /// High if start bits came, and no header.
    is_headless: Signal<Local, Bit>,
    /// High if a field after the header is missing.
    is_short: Signal<Local, Bit>,
    /// Time that the line must be HIGH before the next request, in microseconds.
    rest_us: Signal<Local, Bits<7>>,
    /// Longest time that a request lasts, in microseconds.
    request_us: Signal<Local, Bits<7>>,
    /// Raw flags of the verdict.
    raised: Signal<Local, Bits<16>>,
    /// High if the whole reply was received correctly.
    is_whole: Signal<Local, Bit>,
    /// High if the reply is good: complete, and without an error report of the encoder.
    is_good: Signal<Local, Bit>,
}

impl Exchange {
    /// An exchange; `guards` check for upsets of its registers.
    pub fn new(guards: bool) -> Self {
        Self::from_parts(ExchangeParts {
            has_guards: Constant::new(guards),
        })
    }
}
