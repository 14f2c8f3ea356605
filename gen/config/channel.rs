//! The table `[[channel]]`, and `[endat]`, which says for all channels what they do not say themselves.

use super::reader::{At, Table};
use super::{protocol, trigger};
use endat_hdl::config::*;
use endat_hdl::protocol::ModeCommand;
use endat_hdl::timing::{cycles_at_most, RECOVERY_MAX_NS, RECOVERY_MIN_NS};
use std::collections::BTreeMap;

/// Keys that `[endat]` gives for all channels and a `[[channel]]` may give for itself.
const LINE_KEYS: [&str; 9] = [
    "clock_hz",
    "calibration_hz",
    "tst_ns",
    "filter_ns",
    "start_window_ns",
    "tcal_max_ns",
    "recovery_min_ns",
    "recovery_max_ns",
    "cable_m",
];
/// The usual longest calculation time of EnDat 2.2 encoders, in ns.
const TCAL_MAX_NS: u64 = 5_000;
/// Longest name of an encoder, in characters: a column of a report.
const ENCODER_MAX: usize = 40;
/// Longest cable when none is given, in metres.
const CABLE_M: u64 = 100;

/// Where a key of the resolved request was written: path and line.
pub type Places = BTreeMap<&'static str, (String, usize)>;

/// A channel as read, with the places of its keys.
pub struct Channel {
    /// What is asked for.
    pub request: ChannelRequest,
    /// Name of the encoder.
    pub encoder: String,
    /// Where its keys stand.
    pub places: Places,
}

/// What was written for the keys of a line; `None` for what could not be read.
pub type LineKeys = BTreeMap<&'static str, Option<(String, At<u64>)>>;

pub fn read_line_keys(table: &Table<'_, '_>, system_hz: Option<u64>) -> LineKeys {
    let written = LINE_KEYS.iter().filter_map(|key| {
        let value = table.integer(key, &limits(key, system_hz));
        let place = |at| (table.name(key), at);
        table.has(key).then(|| (*key, value.map(place)))
    });
    written.collect()
}

pub fn read_endat(
    table: &Table<'_, '_>,
    defaults: &LineKeys,
    system_hz: Option<u64>,
    is_aligned: bool,
) -> Option<Channel> {
    let encoder = read_encoder(table);
    let own = trigger::read_own(table);
    let position_limits = limits("position_bits", system_hz);
    let position = table.required_integer("position_bits", "29", &position_limits);
    let command = table.required_string("command", "\"111000\"");
    table.offer(ModeCommand::POSITION.map(|c| format!("{:06b}", c.code())));
    let command = command.and_then(|c| read_command(table, c));
    let mut keys = defaults.clone();
    let own_keys = read_line_keys(table, system_hz);
    keys.extend(own_keys.clone());
    if !keys.contains_key("clock_hz") {
        let text = format!(
            "{}: is missing; add `clock_hz = 3_125_000` here or in [endat]",
            table.name("clock_hz")
        );
        table.complain_plain(text);
    }
    if command.is_none() && table.has("command") {
        // No channel comes of it, so nobody else will look at these.
        let read = own_keys.iter();
        let read = read.filter_map(|(key, written)| Some((*key, &written.as_ref()?.1)));
        for (key, at) in read.chain(position.iter().map(|at| ("position_bits", at))) {
            table.check(key, at, &limits(key, system_hz));
        }
    }
    let (encoder, position, command) = (encoder?, position?, command?);
    let mut values = BTreeMap::new();
    let mut places = Places::new();
    let (own, divider_line) = own?;
    places.insert("divider", (table.name("divider"), divider_line));
    for (key, written) in keys {
        let (path, at) = written?;
        values.insert(key, at.value);
        places.insert(key, (path, at.line));
    }
    let value = |key: &str| values.get(key).copied();
    let clock_hz = value("clock_hz")?;
    places.insert(
        "position_bits",
        (table.name("position_bits"), position.line),
    );
    places.insert("channel", (table.name("position_bits"), table.line));
    let request = ChannelRequest {
        clock_hz,
        calibration_hz: value("calibration_hz"),
        tst_ns: value("tst_ns").unwrap_or(ChannelRequest::usual_tst_ns(clock_hz)),
        command,
        position_bits: position.value,
        filter_ns: value("filter_ns").unwrap_or(0),
        start_window_ns: value("start_window_ns")
            .unwrap_or_else(|| usual_window_ns(clock_hz, system_hz.unwrap_or(0), is_aligned)),
        tcal_max_ns: value("tcal_max_ns").unwrap_or(TCAL_MAX_NS),
        recovery_min_ns: value("recovery_min_ns").unwrap_or(RECOVERY_MIN_NS),
        recovery_max_ns: value("recovery_max_ns").unwrap_or(RECOVERY_MAX_NS),
        cable_m: value("cable_m").unwrap_or(CABLE_M),
        t_format: None,
        trigger: own,
    };
    Some(Channel {
        request,
        encoder,
        places,
    })
}

/// A channel that speaks T-format; the numbers of EnDat in it mean nothing.
pub fn read_t_format(table: &Table<'_, '_>, system_hz: Option<u64>) -> Option<Channel> {
    let encoder = read_encoder(table)?;
    let (wanted, filter_ns, lines) = protocol::read(table, system_hz);
    let (own, divider_line) = trigger::read_own(table)?;
    let mut places = Places::new();
    places.insert("divider", (table.name("divider"), divider_line));
    for (key, line) in lines {
        places.insert(key, (table.name(key), line));
    }
    places.insert("channel", (table.name("protocol"), table.line));
    let request = ChannelRequest {
        clock_hz: wanted.bit_hz,
        calibration_hz: None,
        tst_ns: 0,
        command: ModeCommand::SendPosition,
        position_bits: 0,
        filter_ns,
        start_window_ns: 0,
        tcal_max_ns: 0,
        recovery_min_ns: RECOVERY_MIN_NS,
        recovery_max_ns: RECOVERY_MAX_NS,
        cable_m: 0,
        t_format: Some(wanted),
        trigger: own,
    };
    Some(Channel {
        request,
        encoder,
        places,
    })
}

/// The encoder's name, which goes into reports and comments; empty when none is given.
pub fn read_encoder(table: &Table<'_, '_>) -> Option<String> {
    let Some(encoder) = table.string("encoder") else {
        return (!table.has("encoder")).then(String::new);
    };
    let invisible = |c: &char| {
        c.is_control()
            || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
    };
    let count = encoder.value.chars().count();
    let text = if let Some(bad) = encoder.value.chars().find(invisible) {
        format!("has the character {bad:?}, which cannot be seen; remove it")
    } else if count > ENCODER_MAX {
        format!("has {count} characters, at most {ENCODER_MAX} are allowed; shorten it")
    } else {
        return Some(encoder.value);
    };
    table.complain(
        encoder.line,
        "encoder",
        &format!("{:?}", encoder.value),
        &text,
    );
    None
}

/// A quarter of a period, as far as the counter of the start window reaches.
fn usual_window_ns(clock_hz: u64, system_hz: u64, is_aligned: bool) -> u64 {
    if clock_hz == 0 || system_hz == 0 {
        return 0;
    }
    let cycle_ns = 1_000_000_000u64.div_ceil(system_hz);
    let bit_ns = 1_000_000_000 / clock_hz;
    // The mean phase stands jitter of half a bit; a quarter is for one that goes from frame to frame.
    let part = if is_aligned { 2 } else { 4 };
    let mut window_ns = (bit_ns / part).max(cycle_ns);
    let most = (1 << START_WINDOW_BITS) - 1;
    if cycles_at_most(window_ns, system_hz) > most {
        window_ns = most * 1_000_000_000 / system_hz;
    }
    window_ns
}

fn read_command(table: &Table<'_, '_>, command: At<String>) -> Option<ModeCommand> {
    let digits = command.value.replace('_', "");
    let code = u8::from_str_radix(&digits, 2)
        .ok()
        .filter(|_| digits.len() == 6);
    let known = "use 111000 (EnDat 2.2 position) or 000111 (EnDat 2.1 position)";
    let found = code
        .and_then(ModeCommand::from_code)
        .filter(|c| ModeCommand::POSITION.contains(c));
    if found.is_none() {
        let text = match code {
            Some(_) => format!("is not a mode command that a trigger can send; {known}"),
            None => format!("a mode command is six binary digits in quotes; {known}"),
        };
        table.complain(
            command.line,
            "command",
            &format!("{:?}", command.value),
            &text,
        );
    }
    found
}
