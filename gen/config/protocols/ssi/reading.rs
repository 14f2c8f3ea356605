//! The keys of a `[[channel]]` that speaks SSI.

use super::keys::{
    BINARY, BITS_AFTER, BITS_BEFORE, BIT_DELAY, CODE, END_LOW, GRAY, PARITIES, PARITY, TWICE,
};
use crate::form::key::Key;
use crate::keys::{
    CABLE, CLOCK_HZ, FILTER_NS, POSITION_BITS, PROTOCOL, RECOVERY_MAX, RECOVERY_MIN, TST_NS,
};
use crate::protocols::Wanted;
use crate::reader::{At, Table};
use endat_hdl::config::{ChannelConfig, ChannelSpec};
use endat_hdl::protocols::ssi::specials::{Special, Specials, SPECIALS_MAX};
use endat_hdl::protocols::{Spoken, SsiSpec};

/// What is asked of a channel; none if something could not be read.
pub fn read(table: &Table<'_, '_>, system_hz: Option<u64>) -> Option<Wanted> {
    let mut lines = vec![(PROTOCOL.name, table.line)];
    let position = table.required_integer(&POSITION_BITS, &POSITION_BITS.limits(system_hz));
    let clock = table.required_integer(&CLOCK_HZ, &CLOCK_HZ.limits(system_hz));
    for (key, at) in [(&POSITION_BITS, &position), (&CLOCK_HZ, &clock)] {
        lines.push((key.name, at.as_ref().map_or(table.line, |at| at.line)));
    }
    let mut number = |key: &'static Key, usual: u64| {
        let at = table.integer(key, &key.limits(system_hz));
        let is_read = at.is_some() || !table.has(key.name);
        let at = at.unwrap_or(At {
            value: usual,
            line: table.line,
        });
        lines.push((key.name, at.line));
        is_read.then_some(at.value)
    };
    let tst_ns = number(&TST_NS, 0);
    let filter_ns = number(&FILTER_NS, FILTER_NS.usual_number());
    let recovery_min_ns = number(&RECOVERY_MIN, RECOVERY_MIN.usual_number());
    let recovery_max_ns = number(&RECOVERY_MAX, RECOVERY_MAX.usual_number());
    let cable_m = number(&CABLE, CABLE.usual_number());
    let bit_delay_ns = number(&BIT_DELAY, BIT_DELAY.usual_number());
    let gray = one_of(table, &CODE, [(BINARY, false), (GRAY, true)]);
    let parity = one_of(
        table,
        &PARITY,
        PARITIES.map(|(word, parity, _)| (word, parity)),
    );
    let twice = table.boolean(&TWICE);
    let [before, after] = [&BITS_BEFORE, &BITS_AFTER].map(|key| specials(table, key, &mut lines));
    let end_low = table.boolean(&END_LOW);
    let end_line = end_low.as_ref().map_or(table.line, |at| at.line);
    lines.push((END_LOW.name, end_line));
    let spoken = Spoken::Ssi(SsiSpec {
        gray: gray?,
        parity: parity?,
        twice: twice.is_some_and(|at| at.value),
        before: before?,
        after: after?,
        holds_end: end_low.is_some_and(|at| !at.value),
        bit_delay_ns: bit_delay_ns?,
    });
    Some(Wanted {
        spec: ChannelSpec {
            clock_hz: clock?.value,
            position_bits: position?.value,
            tst_ns: tst_ns?,
            filter_ns: filter_ns?,
            recovery_min_ns: recovery_min_ns?,
            recovery_max_ns: recovery_max_ns?,
            cable_m: cable_m?,
            ..ChannelSpec::speaking(spoken)
        },
        lines,
    })
}

/// The special bits of a list, none if nothing is written.
fn specials(
    table: &Table<'_, '_>,
    key: &'static Key,
    lines: &mut Vec<(&'static str, usize)>,
) -> Option<Specials> {
    let Some(list) = table.strings(key) else {
        return (!table.has(key.name)).then(Specials::default);
    };
    let line = list.first().map_or(table.line, |at| at.line);
    lines.push((key.name, line));
    let mut found = vec![];
    let mut is_good = true;
    for at in &list {
        let row = Special::ALL.iter().find(|(_, word, _)| *word == at.value);
        found.extend(row.map(|(special, ..)| *special));
        if row.is_none() {
            let known: Vec<String> = key.words().iter().map(|w| format!("{w:?}")).collect();
            let text = format!("unknown bit; use {}", known.join(", "));
            table.complain(at.line, key.name, &format!("{:?}", at.value), &text);
            is_good = false;
        }
    }
    let specials = Specials::new(&found);
    if specials.is_none() && is_good {
        let text = format!("a frame has at most {SPECIALS_MAX} bits that are not position; leave the last ones out");
        table.complain(line, key.name, &format!("{} words", list.len()), &text);
    }
    specials.filter(|_| is_good)
}

/// What one of a few words stands for, the first one if nothing is written.
fn one_of<T: Copy, const N: usize>(
    table: &Table<'_, '_>,
    key: &'static Key,
    words: [(&str, T); N],
) -> Option<T> {
    let Some(told) = table.string(key) else {
        return (!table.has(key.name)).then_some(words[0].1);
    };
    let found = words.iter().find(|(word, _)| *word == told.value);
    if found.is_none() {
        let known: Vec<String> = words.iter().map(|(word, _)| format!("{word:?}")).collect();
        let text = format!("unknown {}; use {}", key.name, known.join(" or "));
        table.complain(told.line, key.name, &format!("{:?}", told.value), &text);
    }
    found.map(|(_, value)| *value)
}

/// What decides what a channel does, for the hash of a card.
pub fn canonical(asked: &SsiSpec, channel: &ChannelConfig) -> String {
    let SsiSpec {
        gray,
        twice,
        parity,
        before,
        after,
        holds_end,
        // Only what it is checked against.
        bit_delay_ns: _,
    } = asked;
    let mut more = String::new();
    if asked.has_specials() {
        more = format!(" before {before} after {after}");
    }
    if *holds_end {
        more += " holds_end";
    }
    format!(
        "ssi period_cycles {} first_low {} bits {} filter_cycles {} recovery {} gray {gray} twice {twice} parity {parity:?}{more}",
        channel.period_cycles,
        channel.first_low_extra_cycles,
        channel.position_bits,
        channel.filter_cycles,
        channel.recovery_limit_cycles,
    )
}
