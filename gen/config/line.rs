//! The table `[line]`.

use super::keys::{DRIFT_LIMIT_NS, FIXED_DELAY_NS, LINE_PARTS, PHASE, SAMPLES, SAMPLE_COUNTS};
use super::parts::{check_leader, read_parts};
use super::reader::{At, Table};
use super::words;
use crate::form::key::Key;
use endat_hdl::config::{LineParts, PhaseSource};

/// Numbers among the settings of the part alignment.
static NUMBERS: [&Key; 3] = [&FIXED_DELAY_NS, &DRIFT_LIMIT_NS, &SAMPLES];

/// Reads the table; everything in it may be left out. `None` if something is wrong.
pub fn read(table: &Table<'_, '_>, system_hz: Option<u64>, may_speak: bool) -> Option<LineParts> {
    let mut parts = LineParts::default();
    let named = read_parts(
        table,
        &LINE_PARTS,
        &mut [
            &mut parts.alignment,
            &mut parts.margin,
            &mut parts.double_edge,
        ],
    );
    let phase = table.string(&PHASE);
    let numbers = NUMBERS.map(|key| table.integer(key, &key.limits(system_hz)));
    let named = named?;
    if !parts.alignment {
        check_leader(table, &LINE_PARTS, false, &named)?;
        let phase = phase.map(|p| (PHASE.name, p.line, format!("{:?}", p.value)));
        let number = |(key, n): (&Key, &Option<At<u64>>)| {
            n.as_ref().map(|n| (key.name, n.line, n.value.to_string()))
        };
        let mut settings = phase
            .into_iter()
            .chain(NUMBERS.into_iter().zip(&numbers).filter_map(number));
        return match settings.next() {
            Some((key, line, value)) => {
                let text = match may_speak {
                    true => "takes the part alignment; add it to line.parts, or remove the key",
                    false => {
                        "takes a channel that speaks EnDat, and this card has none; remove the key"
                    }
                };
                table.complain(line, key, &value, text);
                None
            }
            None => Some(parts),
        };
    }
    let mut good = true;
    for (key, number) in NUMBERS.iter().zip(&numbers) {
        good &= number
            .as_ref()
            .is_none_or(|n| within(table, key, n, system_hz));
    }
    if let Some(word) = &phase {
        match words::phase(&word.value) {
            Some(phase) => parts.phase = phase,
            None => {
                let text = format!("unknown; use {}", PHASE.words().join(", "));
                table.complain(word.line, PHASE.name, &format!("{:?}", word.value), &text);
                good = false;
            }
        }
    }
    let read = NUMBERS.iter().zip(numbers);
    let mut read = read.map(|(key, n)| n.map_or(key.usual_number(), |n| n.value));
    let [fixed_delay, drift_limit, samples] = [(); 3].map(|()| read.next().unwrap_or(0));
    (parts.fixed_delay_ns, parts.drift_limit_ns) = (fixed_delay, drift_limit);
    parts.samples = samples;
    let is_fixed = parts.phase == PhaseSource::Fixed;
    if let (Some(word), true) = (&phase, is_fixed && !table.has(FIXED_DELAY_NS.name)) {
        let text = "takes line.fixed_delay_ns; write the delay that `margin` shows on this cable";
        table.complain(word.line, PHASE.name, "\"fixed\"", text);
        return None;
    }
    good.then_some(parts)
}

fn within(table: &Table<'_, '_>, key: &Key, number: &At<u64>, system_hz: Option<u64>) -> bool {
    let value = number.value;
    let limits = key.limits(system_hz);
    let text = match key.name == SAMPLES.name {
        true if !SAMPLE_COUNTS.contains(&value) => {
            "not a number of samples; use 1 or 3 (their majority)".to_owned()
        }
        false if !limits.contains(value) => limits.to_string(),
        _ => return true,
    };
    table.complain(number.line, key.name, &value.to_string(), &text);
    false
}
