//! What a recording is of: units, clock, card and encoders, in the file itself.

use super::layout::{of_channel, Layout};
use endat_host::card::Identity;
use endat_host::feed::cause_codes;
use endat_host::name_plate::NamePlate;
use endat_host::units::Scale;
use endat_regs::Part;
use serde_json::{json, Map, Value};
use std::time::SystemTime;

/// Form of this description.
const FORM: &str = "endat recording 1";
/// Under this name it stands in a file.
pub const KEY: &str = "endat";

/// What is known of a recording when it begins.
pub struct About {
    /// Where the card was.
    pub port: String,
    /// Who it is.
    pub identity: Identity,
    /// Name plates of its encoders.
    pub plates: Vec<Option<NamePlate>>,
    /// Positions begin anew after so many.
    pub ranges: Vec<Option<u64>>,
    /// One of so many rows is kept, and every one with a fault.
    pub every: u64,
    /// Names that have an event of their own.
    pub events: Vec<String>,
    /// By the clock of the host, when it began.
    pub start: SystemTime,
}

/// Bits of counts within a turn where a description does not tell: those of recordings that have been made before it did.
const COUNTS_BITS: u32 = 24;

/// What a measuring step is, as numbers.
fn scale(scale: &Scale, range: Option<u64>) -> Value {
    let mut object = json!({"unit": scale.convert(0).unit});
    match *scale {
        Scale::Rotary { steps_per_turn } => object["steps_per_turn"] = json!(steps_per_turn),
        Scale::Linear { step_nm } => object["step_nm"] = json!(step_nm),
        Scale::Counts { single_bits } => object["single_bits"] = json!(single_bits),
    }
    if let Some(range) = range {
        object["range"] = json!(range);
    }
    object
}

/// The scale, and after how many positions it begins anew, of what a channel of a description says.
pub fn scale_of(object: &Value) -> Option<(Scale, Option<u64>)> {
    let scale = match (
        object["steps_per_turn"].as_u64(),
        object["step_nm"].as_f64(),
    ) {
        (Some(steps_per_turn), _) => Scale::Rotary { steps_per_turn },
        (None, Some(step_nm)) => Scale::Linear { step_nm },
        (None, None) if object["unit"] == "counts" => {
            let told = object["single_bits"]
                .as_u64()
                .and_then(|n| n.try_into().ok());
            Scale::Counts {
                single_bits: told.filter(|n| *n < u64::BITS).unwrap_or(COUNTS_BITS),
            }
        }
        (None, None) => return None,
    };
    Some((scale, object["range"].as_u64()))
}

/// What a name plate says.
fn plate(plate: &NamePlate) -> Value {
    json!({
        "id": plate.id,
        "serial": plate.serial,
        "rotary": plate.rotary,
        "position_bits": plate.position_bits,
        "revolutions": plate.revolutions,
        "steps": plate.steps,
        "signal_periods": plate.signal_periods,
    })
}

impl About {
    /// Everything, of file `part` of a recording.
    pub fn json(&self, layout: &Layout, is_text: bool, part: u32) -> Value {
        let channels = layout.scales.iter().enumerate().map(|(n, one)| {
            let mut object = scale(one, self.ranges.get(n).copied().flatten());
            object["protocol"] = json!(self.identity.protocol(n).name());
            if let Some(known) = self.plates.get(n).and_then(Option::as_ref) {
                object["encoder"] = plate(known);
            }
            object
        });
        let causes: Map<String, Value> = cause_codes()
            .map(|(code, name)| (name.to_owned(), json!(code)))
            .collect();
        json!({
            "format": FORM,
            "start_time": humantime::format_rfc3339_micros(self.start).to_string(),
            "part": part,
            "port": self.port,
            "system_hz": self.identity.system_hz,
            "configuration_hash": format!("{:08x}", self.identity.configuration_hash),
            "register_map": self.identity.version.map(|n| n.to_string()).join("."),
            "every": self.every,
            "own_triggers": self.identity.has(Part::OwnTrigger),
            "events": self.events,
            "channels": channels.collect::<Vec<_>>(),
            "columns": columns(layout, is_text, self.identity.system_hz),
            "causes": causes,
        })
    }
}

/// Unit of each column that has one; what the others are.
fn columns(layout: &Layout, is_text: bool, system_hz: u32) -> Value {
    let by = "by the card's clock, since the first row";
    let time = match is_text {
        true => ("time_s", "s".to_owned()),
        false => ("cycles", format!("1/{system_hz} s")),
    };
    let trigger = "number of the trigger, not wrapping; none: a position of a running clock";
    let missing = "triggers without a row just before this one";
    let mut all: Vec<(String, String, &str)> = vec![
        ("trigger".into(), String::new(), trigger),
        (time.0.into(), time.1, by),
        ("missing".into(), String::new(), missing),
    ];
    for (n, scale) in layout.scales.iter().enumerate() {
        let unit = scale.convert(0).unit;
        let mut put = |name: &str, unit: String, is| all.push((of_channel(n, name), unit, is));
        let raw = "position as the encoder sent it; the last good one where fresh is false";
        put("raw", format!("{} {unit}", scale.step()), raw);
        if is_text {
            put(unit, unit.into(), "position within the turn");
            put("turns", "turns".into(), "whole turns");
        }
        put("fresh", String::new(), "this trigger brought the position");
        let cause = "why it did not, or what else was noticed";
        put("cause", String::new(), cause);
        for name in layout.infos() {
            put(name, String::new(), "additional data of the same frame");
        }
    }
    let derived = layout.derived.iter();
    all.extend(derived.map(|one| (one.column(), one.unit.clone(), "calculated")));
    let objects = all
        .into_iter()
        .map(|(name, unit, is)| (name, json!({"unit": unit, "is": is})));
    Value::Object(objects.collect())
}
