//! The keys of a `[[channel]]` that speaks T-format, of a card or of a receiver.

use super::keys::{BIT_RATE, FIELD_GAP_US, REPLY_GAP_US, REQUEST};
use crate::form::key::Key;
use crate::keys::{FILTER_NS, PROTOCOL};
use crate::protocols::Wanted;
use crate::reader::{At, Table};
use endat_hdl::config::{ChannelConfig, ChannelSpec};
use endat_hdl::protocols::t_format::asked::{is_rate, is_triggered};
use endat_hdl::protocols::t_format::protocol::{Request, BIT_HZ, FAST_BIT_HZ};
use endat_hdl::protocols::{Spoken, TFormatSpec};

/// Input filter when none is given, in ns: a clock of the slower receiver.
const USUAL_FILTER_NS: u64 = 50;

/// The bit rate, if it is one of T-format.
pub fn read_bit_hz(table: &Table<'_, '_>) -> Option<At<u64>> {
    let bit = table.integer(&BIT_RATE, &BIT_RATE.limits(None));
    if let Some(bit) = bit.as_ref().filter(|bit| !is_rate(bit.value)) {
        let text = format!("is no rate of T-format encoders; use {BIT_HZ} or {FAST_BIT_HZ}");
        table.complain(bit.line, BIT_RATE.name, &bit.value.to_string(), &text);
    }
    bit.filter(|bit| is_rate(bit.value))
}

/// A request, if there is such a one, with the line it stands on; a wrong one is answered with those that `may` be.
pub fn read_request(table: &Table<'_, '_>, may: fn(Request) -> bool) -> Option<At<Request>> {
    let request = table.integer(&REQUEST, &REQUEST.limits(None));
    let usual = Request::ALL.iter().filter(|r| may(**r));
    table.offer(usual.map(|r| r.id()));
    let request = request?;
    let known = u8::try_from(request.value).ok().and_then(Request::from_id);
    if known.is_none() {
        let usual = Request::ALL.iter().filter(|r| may(**r));
        let ids: Vec<String> = usual.map(|r| r.id().to_string()).collect();
        let text = format!("is no request ID; use one of {}", ids.join(", "));
        table.complain(
            request.line,
            REQUEST.name,
            &request.value.to_string(),
            &text,
        );
    }
    known.map(|value| At {
        value,
        line: request.line,
    })
}

/// What is asked of a T-format channel of a card.
pub fn read(table: &Table<'_, '_>, system_hz: Option<u64>) -> Option<Wanted> {
    let usual = TFormatSpec::default();
    let mut lines = vec![(PROTOCOL.name, table.line)];
    let mut number = |key: &'static Key, usual: u64| {
        let at = table.integer(key, &key.limits(system_hz));
        let at = at.unwrap_or(At {
            value: usual,
            line: table.line,
        });
        lines.push((key.name, at.line));
        at.value
    };
    let reply_gap_us = number(&REPLY_GAP_US, REPLY_GAP_US.usual_number());
    let field_gap_us = number(&FIELD_GAP_US, FIELD_GAP_US.usual_number());
    let filter_ns = number(&FILTER_NS, USUAL_FILTER_NS);
    let bit = read_bit_hz(table);
    let request = read_request(table, is_triggered);
    lines.push((BIT_RATE.name, bit.as_ref().map_or(table.line, |b| b.line)));
    lines.push((
        REQUEST.name,
        request.as_ref().map_or(table.line, |r| r.line),
    ));
    let wanted = TFormatSpec {
        bit_hz: bit.map_or(BIT_RATE.usual_number(), |b| b.value),
        request: request.map_or(usual.request, |r| r.value),
        reply_gap_us,
        field_gap_us,
    };
    Some(Wanted {
        spec: ChannelSpec {
            clock_hz: wanted.bit_hz,
            filter_ns,
            ..ChannelSpec::speaking(Spoken::TFormat(wanted))
        },
        lines,
    })
}

/// What decides what a channel does, for the hash of a card.
pub fn canonical(wanted: &TFormatSpec, channel: &ChannelConfig) -> String {
    let TFormatSpec {
        // It is in the cycles of a bit.
        bit_hz: _,
        request,
        reply_gap_us,
        field_gap_us,
    } = wanted;
    format!(
        "t_format bit_cycles {} filter_cycles {} request {} gaps {reply_gap_us} {field_gap_us}",
        channel.period_cycles,
        channel.filter_cycles,
        request.id()
    )
}
