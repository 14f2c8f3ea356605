//! The keys of a `[[channel]]` that speaks T-format, of a card or of a receiver.

use super::keys::{
    of_channels, BIT_RATE, CARD_FORM, ENDAT_FORM, FIELD_GAP_US, FILTER_NS, PROTOCOL, REPLY_GAP_US,
    REQUEST, T_FORMAT_FILTER_NS, T_FORMAT_FORM,
};
use super::reader::{At, Table};
use super::words::{ENDAT, T_FORMAT};
use crate::form::key::Key;
use endat_hdl::config::{is_rate, is_triggered, TFormatRequest};
use endat_hdl::t_format::protocol::{Request, BIT_HZ, FAST_BIT_HZ};

/// Takes the keys of a channel of either protocol as asked for.
fn know_all(table: &Table<'_, '_>) {
    table.know(&of_channels(CARD_FORM).collect::<Vec<_>>());
}

/// Whether a channel of a card speaks T-format; `None` for what is no protocol. Keys of the other protocol are refused.
pub fn is_t_format(table: &Table<'_, '_>) -> Option<bool> {
    let protocol = table.string(&PROTOCOL);
    let is_t_format = match &protocol {
        None if table.has(PROTOCOL.name) => {
            know_all(table);
            return None;
        }
        None => false,
        Some(word) if word.value == ENDAT => false,
        Some(word) if word.value == T_FORMAT => true,
        Some(word) => {
            let text = format!("unknown protocol; use \"{ENDAT}\" (default) or \"{T_FORMAT}\"");
            let shown = format!("{:?}", word.value);
            table.complain(word.line, PROTOCOL.name, &shown, &text);
            know_all(table);
            return None;
        }
    };
    let (own, text) = match is_t_format {
        true => (T_FORMAT_FORM, "is a key of EnDat, and this channel speaks T-format; remove it (T-format has bit_hz, request, reply_gap_us, field_gap_us, filter_ns)"),
        false => (ENDAT_FORM, "is a key of T-format, and this channel speaks EnDat; remove it, or add protocol = \"t_format\""),
    };
    for foreign in of_channels(CARD_FORM).filter(|key| key.forms & own == 0) {
        table.refuse(foreign, text);
    }
    Some(is_t_format)
}

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

/// What is asked of a T-format channel of a card, and its filter, with the lines of the keys.
pub fn read(
    table: &Table<'_, '_>,
    system_hz: Option<u64>,
) -> (TFormatRequest, u64, Vec<(&'static str, usize)>) {
    let usual = TFormatRequest::default();
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
    let filter_ns = number(&FILTER_NS, T_FORMAT_FILTER_NS);
    let bit = read_bit_hz(table);
    let request = read_request(table, is_triggered);
    lines.push((BIT_RATE.name, bit.as_ref().map_or(table.line, |b| b.line)));
    lines.push((
        REQUEST.name,
        request.as_ref().map_or(table.line, |r| r.line),
    ));
    let wanted = TFormatRequest {
        bit_hz: bit.map_or(BIT_RATE.usual_number(), |b| b.value),
        request: request.map_or(usual.request, |r| r.value),
        reply_gap_us,
        field_gap_us,
    };
    (wanted, filter_ns, lines)
}
