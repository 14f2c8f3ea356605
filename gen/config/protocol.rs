//! The keys of a `[[channel]]` that speaks T-format, of a card or of a receiver.

use super::reader::{At, Table};
use endat_hdl::config::{is_rate, is_triggered, limits, TFormatRequest};
use endat_hdl::t_format::protocol::{Request, BIT_HZ, FAST_BIT_HZ};

/// Bus that makes a configuration one of a receiver.
pub const RECEIVER_BUS: &str = "dsp";
/// Word of the key `protocol` for T-format.
pub const T_FORMAT: &str = "t_format";
/// Word of the key `protocol` for EnDat, which may be left out.
pub const ENDAT: &str = "endat";
/// Keys of a channel that T-format has and EnDat has not.
const T_FORMAT_KEYS: [&str; 4] = ["bit_hz", "request", "reply_gap_us", "field_gap_us"];
/// Keys of a channel that EnDat has and T-format has not.
const ENDAT_KEYS: [&str; 10] = [
    "position_bits",
    "command",
    "clock_hz",
    "tst_ns",
    "start_window_ns",
    "calibration_hz",
    "tcal_max_ns",
    "recovery_min_ns",
    "recovery_max_ns",
    "cable_m",
];
/// Input filter when none is given, in ns: a clock of the slower receiver.
pub const FILTER_NS: u64 = 50;

/// Keys of a channel of either protocol.
fn all_keys() -> Vec<&'static str> {
    [&ENDAT_KEYS[..], &T_FORMAT_KEYS, &["encoder", "filter_ns"]].concat()
}

/// Whether a channel of a card speaks T-format; `None` for what is no protocol. Keys of the other protocol are refused.
pub fn is_t_format(table: &Table<'_, '_>) -> Option<bool> {
    let protocol = table.string("protocol");
    table.offer([ENDAT, T_FORMAT]);
    let is_t_format = match &protocol {
        None if table.has("protocol") => {
            table.know(&all_keys());
            return None;
        }
        None => false,
        Some(word) if word.value == ENDAT => false,
        Some(word) if word.value == T_FORMAT => true,
        Some(word) => {
            let text = format!("unknown protocol; use \"{ENDAT}\" (default) or \"{T_FORMAT}\"");
            table.complain(word.line, "protocol", &format!("{:?}", word.value), &text);
            table.know(&all_keys());
            return None;
        }
    };
    let (foreign, text) = match is_t_format {
        true => (&ENDAT_KEYS[..], "is a key of EnDat, and this channel speaks T-format; remove it (T-format has bit_hz, request, reply_gap_us, field_gap_us, filter_ns)"),
        false => (&T_FORMAT_KEYS[..], "is a key of T-format, and this channel speaks EnDat; remove it, or add protocol = \"t_format\""),
    };
    for key in foreign {
        table.refuse(key, text);
    }
    Some(is_t_format)
}

/// The bit rate, if it is one of T-format.
pub fn read_bit_hz(table: &Table<'_, '_>) -> Option<At<u64>> {
    let bit = table.integer("bit_hz", &limits("bit_hz", None));
    table.offer([BIT_HZ, FAST_BIT_HZ]);
    if let Some(bit) = bit.as_ref().filter(|bit| !is_rate(bit.value)) {
        let text = format!("is no rate of T-format encoders; use {BIT_HZ} or {FAST_BIT_HZ}");
        table.complain(bit.line, "bit_hz", &bit.value.to_string(), &text);
    }
    bit.filter(|bit| is_rate(bit.value))
}

/// A request, if there is such a one, with the line it stands on; a wrong one is answered with those that `may` be.
pub fn read_request(table: &Table<'_, '_>, may: fn(Request) -> bool) -> Option<At<Request>> {
    let request = table.integer("request", &limits("request", None));
    let usual = Request::ALL.iter().filter(|r| may(**r));
    table.offer(usual.map(|r| r.id()));
    let request = request?;
    let known = u8::try_from(request.value).ok().and_then(Request::from_id);
    if known.is_none() {
        let usual = Request::ALL.iter().filter(|r| may(**r));
        let ids: Vec<String> = usual.map(|r| r.id().to_string()).collect();
        let text = format!("is no request ID; use one of {}", ids.join(", "));
        table.complain(request.line, "request", &request.value.to_string(), &text);
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
    let mut lines = vec![("protocol", table.line)];
    let mut number = |key: &'static str, usual: u64| {
        let at = table.integer(key, &limits(key, system_hz));
        let at = at.unwrap_or(At {
            value: usual,
            line: table.line,
        });
        lines.push((key, at.line));
        at.value
    };
    let reply_gap_us = number("reply_gap_us", usual.reply_gap_us);
    let field_gap_us = number("field_gap_us", usual.field_gap_us);
    let filter_ns = number("filter_ns", FILTER_NS);
    let bit = read_bit_hz(table);
    let request = read_request(table, is_triggered);
    lines.push(("bit_hz", bit.as_ref().map_or(table.line, |b| b.line)));
    lines.push(("request", request.as_ref().map_or(table.line, |r| r.line)));
    let wanted = TFormatRequest {
        bit_hz: bit.map_or(usual.bit_hz, |b| b.value),
        request: request.map_or(usual.request, |r| r.value),
        reply_gap_us,
        field_gap_us,
    };
    (wanted, filter_ns, lines)
}
