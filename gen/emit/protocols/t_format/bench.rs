//! The Verilog test bench that is emitted with a receiver: a signal processor on its bus, an encoder on its line.

use super::bench_parts::{cable_and_gap_ns, causes, encoder, IDLE_NS, RATE_ERROR};
use super::Receiver;
use crate::testbench::tell;
use crate::testbench::text::{clock_ns, real, whole};
use endat_config::template;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_hdl::protocols::t_format::cause;
use endat_hdl::protocols::t_format::dsp::TFormatStart;
use endat_hdl::protocols::t_format::protocol::{
    Content, Request, BIT_HZ, SYSTEM_HZ, WAIT_GRACE_US,
};
use minijinja::context;
use minijinja::value::Value;

/// What a reply brings, as bits: EEPROM data, alarms, kind, multi-turn, single-turn position.
fn brought(request: &Request) -> Value {
    let parts = [
        Content::Data,
        Content::Alarm,
        Content::EncoderId,
        Content::MultiTurn,
        Content::SingleTurn,
    ];
    let bit = |part: &Content| {
        if request.reply().contains(part) {
            '1'
        } else {
            '0'
        }
    };
    let brought: String = parts.iter().map(bit).collect();
    context! { id => request.id(), brought }
}

/// The longest that the line is in use after a request, a reply that comes too late included, in ns.
fn exchange_ns(start: &TFormatStart) -> u64 {
    let of = |request: &Request| {
        let pauses = request.reply().len() as u64 - 1;
        let gaps_us = start.reply_gap_us + start.field_gap_us * pauses + WAIT_GRACE_US + 1;
        // Bits of an encoder whose clock is slow.
        (request.wire_bits() + 2) * 1_000_000_000 / BIT_HZ + 1_000 * gaps_us
    };
    Request::ALL.iter().map(of).max().unwrap_or(0)
}

/// The test bench of a receiver.
pub fn artifact(receiver: &Receiver) -> Result<Artifact, CommandError> {
    let start = &receiver.start;
    let (cable_ns, reply_gap_ns) = cable_and_gap_ns(1.0, start.reply_gap_us);
    let other = TFormatStart {
        fast: !start.fast,
        // A bit may be as short as four clocks.
        filter_cycles: start.filter_cycles.min(1),
        ..*start
    };
    let text = template::render(
        "receiver_bench",
        include_str!("../../templates/receiver_bench.v.jinja"),
        &context! {
            name => receiver.name.as_str(),
            version => env!("CARGO_PKG_VERSION"),
            hash => receiver.hash.as_str(),
            tell => tell(&receiver.name, "clk_select %0d, ", "clk_select, ")?,
            encoder => encoder(&receiver.name)?,
            settings => format!("{:04X}", start.word()),
            other_settings => format!("{:04X}", other.word()),
            request => start.request_id,
            cable_ns => real(cable_ns),
            exchange_ns => whole(exchange_ns(start)),
            idle_ns => whole(IDLE_NS),
            unknown_request => cause::UNKNOWN_REQUEST,
            causes => causes(),
            read_id => Request::ReadEeprom.id(),
            write_id => Request::WriteEeprom.id(),
            own_rate => real(1.0 + RATE_ERROR),
            reply_gap_ns => real(reply_gap_ns),
            field_gap_ns => whole(1_000 * start.field_gap_us),
            requests => Request::ALL.iter().map(brought).collect::<Vec<_>>(),
            unknown => (0..16).find(|id| Request::from_id(*id).is_none()),
            clocks => SYSTEM_HZ.map(|hz| real(clock_ns(hz))).to_vec(),
        },
    )?;
    Ok(Artifact::new(format!("{}_tb.v", receiver.name), text))
}
