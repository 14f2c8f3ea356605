//! The table `[[channel]]`, and `[endat]`, which says for all channels what they do not say themselves.

use super::keys::*;
use super::reader::{At, Table};
use super::trigger;
use crate::form::key::Key;
use crate::protocols::OtherConfig;
use endat_hdl::config::{limits, narrowest, ChannelSpec, Limits, PositionRange, START_WINDOW_BITS};
use endat_hdl::endat::timing::cycles_at_most;
use endat_hdl::protocol::ModeCommand;
use endat_hdl::protocols::Spoken;
use endat_regs::Protocol;
use std::collections::BTreeMap;

/// Where a key of the resolved request was written: path and line.
pub type Places = BTreeMap<&'static str, (String, usize)>;

/// A channel as read, with the places of its keys.
pub struct Channel {
    /// What is asked for.
    pub spec: ChannelSpec,
    /// Name of the encoder.
    pub encoder: String,
    /// Where its keys stand.
    pub places: Places,
}

impl Channel {
    /// Whether it speaks this protocol.
    pub fn speaks(&self, protocol: Protocol) -> bool {
        self.spec.spoken.protocol() == protocol
    }
}

/// What was written for the keys of a line; `None` for what could not be read.
pub type LineKeys = BTreeMap<&'static str, Option<(String, At<u64>)>>;

pub fn read_line_keys(table: &Table<'_, '_>, system_hz: Option<u64>) -> LineKeys {
    let written = of_lines().filter_map(|key| {
        // The answer to a value that is no number is the range that fits every cable.
        let value = table.integer_or(
            key,
            &limits(key.name, system_hz),
            &narrowest(key.name, system_hz),
        );
        let place = |at| (table.name(key.name), at);
        table.has(key.name).then(|| (key.name, value.map(place)))
    });
    written.collect()
}

/// Checks what `[endat]` says and every channel says for itself: nobody else looks at it.
pub fn check_overridden(
    table: &Table<'_, '_>,
    defaults: &LineKeys,
    channels: &[Option<Channel>],
    system_hz: Option<u64>,
) {
    for key in of_lines() {
        let Some(Some((path, at))) = defaults.get(key.name) else {
            continue;
        };
        let takes =
            |channel: &Channel| channel.places.get(key.name).is_some_and(|(p, _)| p == path);
        // One that could not be read may take it.
        if !channels.iter().any(|c| c.as_ref().is_none_or(takes)) {
            table.check(key, at, &limits(key.name, system_hz));
        }
    }
}

pub fn read_endat(
    table: &Table<'_, '_>,
    defaults: &LineKeys,
    system_hz: Option<u64>,
    is_aligned: bool,
) -> Option<Channel> {
    let encoder = read_encoder(table);
    let own = trigger::read_own(table);
    let position = table.required_integer(&POSITION_BITS, &POSITION_BITS.limits(system_hz));
    let range = read_range(table, Protocol::Endat, position.as_ref().map(|at| at.value));
    let command = table.required_string(&COMMAND);
    let command = command.and_then(|c| read_command(table, c));
    let mut keys = defaults.clone();
    let own_keys = read_line_keys(table, system_hz);
    keys.extend(own_keys.clone());
    if !keys.contains_key(CLOCK_HZ.name) {
        let text = format!(
            "{}: is missing; add `{} = {}` here or in [{COMMON}]",
            table.name(CLOCK_HZ.name),
            CLOCK_HZ.name,
            CLOCK_HZ.example()
        );
        table.complain_plain(text);
    }
    if command.is_none() && table.has(COMMAND.name) {
        // No channel comes of it, so nobody else will look at these.
        let read = of_lines().filter_map(|key| {
            let (_, at) = own_keys.get(key.name)?.as_ref()?;
            Some((key, at))
        });
        for (key, at) in read.chain(position.iter().map(|at| (&POSITION_BITS, at))) {
            table.check(key, at, &limits(key.name, system_hz));
        }
    }
    let (encoder, position, command) = (encoder?, position?, command?);
    let mut values = BTreeMap::new();
    let mut places = Places::new();
    let (own, divider_line) = own?;
    let (range, range_places) = range?;
    places.extend(range_places);
    places.insert(DIVIDER.name, (table.name(DIVIDER.name), divider_line));
    for (key, written) in keys {
        let (path, at) = written?;
        values.insert(key, at.value);
        places.insert(key, (path, at.line));
    }
    let value = |key: &Key| values.get(key.name).copied();
    let usual = |key: &Key| value(key).unwrap_or(key.usual_number());
    let clock_hz = value(&CLOCK_HZ)?;
    let bits = POSITION_BITS.name;
    places.insert(bits, (table.name(bits), position.line));
    places.insert("channel", (table.name(bits), table.line));
    let spec = ChannelSpec {
        clock_hz,
        calibration_hz: value(&CALIBRATION_HZ),
        tst_ns: value(&TST_NS).unwrap_or(ChannelSpec::usual_tst_ns(clock_hz)),
        command,
        position_bits: position.value,
        filter_ns: usual(&FILTER_NS),
        start_window_ns: value(&START_WINDOW_NS)
            .unwrap_or_else(|| usual_window_ns(clock_hz, system_hz.unwrap_or(0), is_aligned)),
        tcal_max_ns: usual(&TCAL_MAX),
        recovery_min_ns: usual(&RECOVERY_MIN),
        recovery_max_ns: usual(&RECOVERY_MAX),
        cable_m: usual(&CABLE),
        spoken: Spoken::Endat,
        trigger: own,
        range,
    };
    Some(Channel {
        spec,
        encoder,
        places,
    })
}

/// A channel that speaks another protocol.
pub fn read_other(
    other: &dyn OtherConfig,
    table: &Table<'_, '_>,
    system_hz: Option<u64>,
) -> Option<Channel> {
    let encoder = read_encoder(table);
    let wanted = other.read(table, system_hz);
    let own = trigger::read_own(table);
    let width = wanted.as_ref().map(|wanted| wanted.spec.position_bits);
    let range = read_range(table, other.protocol(), width);
    let (encoder, wanted, (own, divider_line)) = (encoder?, wanted?, own?);
    let (range, mut places) = range?;
    places.insert(DIVIDER.name, (table.name(DIVIDER.name), divider_line));
    for (key, line) in wanted.lines {
        places.insert(key, (table.name(key), line));
    }
    places.insert("channel", (table.name(PROTOCOL.name), table.line));
    Some(Channel {
        spec: ChannelSpec {
            trigger: own,
            range,
            ..wanted.spec
        },
        encoder,
        places,
    })
}

/// The encoder's name, which goes into reports and comments; empty when none is given.
pub fn read_encoder(table: &Table<'_, '_>) -> Option<String> {
    let Some(encoder) = table.string(&ENCODER) else {
        return (!table.has(ENCODER.name)).then(String::new);
    };
    let invisible = |c: &char| {
        c.is_control()
            || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
    };
    let count = encoder.value.chars().count();
    let text = if let Some(bad) = encoder.value.chars().find(invisible) {
        format!("has the character {bad:?}, which cannot be seen; remove it")
    } else if count > ENCODER.most {
        format!(
            "has {count} characters, at most {} are allowed; shorten it",
            ENCODER.most
        )
    } else {
        return Some(encoder.value);
    };
    let shown = format!("{:?}", encoder.value);
    table.complain(encoder.line, ENCODER.name, &shown, &text);
    None
}

/// Reads the range of a position, and the lines of its keys; none if it has been refused. Angle and turns share `width` bits.
fn read_range(
    table: &Table<'_, '_>,
    protocol: Protocol,
    width: Option<u64>,
) -> Option<(Option<PositionRange>, Places)> {
    let mut places = Places::new();
    let mut number = |key: &'static Key, limits: Limits| {
        let at = table.integer(key, &limits);
        let line = at.as_ref().map_or(table.line, |at| at.line);
        places.insert(key.name, (table.name(key.name), line));
        at
    };
    let (usual_single, usual_multi) = (SINGLE_TURN_BITS.limits(None), MULTI_TURN_BITS.limits(None));
    let turns_at = protocol.row().turns_at.map(u64::from);
    let most = turns_at.or(width.map(|width| width.saturating_sub(1)));
    let multi = number(
        &MULTI_TURN_BITS,
        usual_multi.at_most(most.unwrap_or(u64::MAX), ""),
    );
    let rest = width.and_then(|width| width.checked_sub(multi.as_ref().map_or(0, |at| at.value)));
    let single = number(
        &SINGLE_TURN_BITS,
        match (turns_at, rest) {
            (Some(most), _) => usual_single.at_most(most, ""),
            // The angle has the rest of the position.
            (None, Some(rest)) => Limits::new(rest..=rest),
            (None, None) => usual_single,
        },
    );
    let linear = table.boolean(&LINEAR);
    let is_linear = linear.as_ref().is_some_and(|at| at.value);
    let has = |key: &Key| table.has(key.name);
    if is_linear && (has(&SINGLE_TURN_BITS) || has(&MULTI_TURN_BITS)) {
        let line = linear.as_ref().map_or(table.line, |at| at.line);
        let text = format!(
            "a scale has no turns, and {} or {} is there; remove it",
            SINGLE_TURN_BITS.name, MULTI_TURN_BITS.name
        );
        table.complain(line, LINEAR.name, "true", &text);
        return None;
    }
    if has(&MULTI_TURN_BITS) && !has(&SINGLE_TURN_BITS) && turns_at.is_some() {
        let line = multi.as_ref().map_or(table.line, |at| at.line);
        let value = multi.map_or(String::new(), |at| at.value.to_string());
        let name = SINGLE_TURN_BITS.name;
        let text = format!("counts turns of an angle, and nothing says how many bits that has; add, for example, {name} = 17, or remove it");
        table.complain(line, MULTI_TURN_BITS.name, &value, &text);
        return None;
    }
    let range = match (single, multi) {
        (None, _) if has(&SINGLE_TURN_BITS) => return None,
        (None, None) => is_linear.then_some(PositionRange::Linear),
        // Without single_turn_bits the angle has the rest of the position.
        (single, multi) => Some(PositionRange::Rotary {
            single_turn_bits: single.map(|at| at.value),
            multi_turn_bits: multi.map_or(0, |at| at.value),
        }),
    };
    Some((range, places))
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
        let shown = format!("{:?}", command.value);
        table.complain(command.line, COMMAND.name, &shown, &text);
    }
    found
}
