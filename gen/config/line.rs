//! The table `[line]`.

use super::parts::read_parts;
use super::reader::{At, Table};
use endat_hdl::config::{limits, LineParts, PhaseSource};

/// Words for the source of the phase after reset.
const PHASES: [(&str, PhaseSource); 3] = [
    ("tracked", PhaseSource::Tracked),
    ("frame", PhaseSource::Frame),
    ("fixed", PhaseSource::Fixed),
];
/// Numbers among the settings of the part alignment.
const NUMBERS: [&str; 3] = ["fixed_delay_ns", "drift_limit_ns", "samples"];

/// How many samples of a bit there may be; the last of the numbers.
const SAMPLES: [u64; 2] = [1, 3];

/// Reads the table; everything in it may be left out. `None` if something is wrong.
pub fn read(table: &Table<'_, '_>, system_hz: Option<u64>) -> Option<LineParts> {
    let mut parts = LineParts::default();
    let named = read_parts(
        table,
        &["alignment", "margin", "double_edge"],
        &mut [
            &mut parts.alignment,
            &mut parts.margin,
            &mut parts.double_edge,
        ],
    );
    let phase = table.string("phase");
    table.offer(PHASES.map(|(name, _)| name));
    let numbers = NUMBERS.map(|key| table.integer(key, &limits(key, system_hz)));
    table.offer(SAMPLES);
    let named = named?;
    if !parts.alignment {
        if let Some((line, shown)) = named.first() {
            let text = "every other part takes alignment; add \"alignment\"";
            table.complain(*line, "parts", shown, text);
            return None;
        }
        let phase = phase.map(|p| ("phase", p.line, format!("{:?}", p.value)));
        let number = |(key, n): (&'static str, &Option<At<u64>>)| {
            n.as_ref().map(|n| (key, n.line, n.value.to_string()))
        };
        let mut settings = phase
            .into_iter()
            .chain(NUMBERS.into_iter().zip(&numbers).filter_map(number));
        return match settings.next() {
            Some((key, line, value)) => {
                let text = "takes the part alignment; add it to line.parts, or remove the key";
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
        match PHASES.iter().find(|(name, _)| *name == word.value) {
            Some((_, phase)) => parts.phase = *phase,
            None => {
                let names = PHASES.map(|(name, _)| name).join(", ");
                let text = format!("unknown; use {names}");
                table.complain(word.line, "phase", &format!("{:?}", word.value), &text);
                good = false;
            }
        }
    }
    let [fixed_delay, drift_limit, samples] = numbers.map(|n| n.map_or(0, |n| n.value));
    (parts.fixed_delay_ns, parts.drift_limit_ns) = (fixed_delay, drift_limit);
    parts.samples = samples;
    let is_fixed = parts.phase == PhaseSource::Fixed;
    if let (Some(word), true) = (&phase, is_fixed && !table.has("fixed_delay_ns")) {
        let text = "takes line.fixed_delay_ns; write the delay that `margin` shows on this cable";
        table.complain(word.line, "phase", "\"fixed\"", text);
        return None;
    }
    good.then_some(parts)
}

/// The source of the phase after reset, as it is written.
pub fn phase_name(phase: PhaseSource) -> &'static str {
    let found = PHASES.iter().find(|(_, p)| *p == phase);
    found.map_or("", |(name, _)| name)
}

fn within(table: &Table<'_, '_>, key: &str, number: &At<u64>, system_hz: Option<u64>) -> bool {
    let value = number.value;
    let text = match key {
        "samples" if !SAMPLES.contains(&value) => {
            "not a number of samples; use 1, or 3 for their majority".to_owned()
        }
        _ if !limits(key, system_hz).contains(value) => limits(key, system_hz).to_string(),
        _ => return true,
    };
    table.complain(number.line, key, &value.to_string(), &text);
    false
}
