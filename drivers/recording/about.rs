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
/// Bits of a position.
const POSITION_BITS: u32 = endat_regs::protocol::MAX_POSITION_BITS;
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
    /// One of so many rows is kept, and every one with a fault.
    pub every: u64,
    /// Names that have an event of their own.
    pub events: Vec<String>,
    /// By the clock of the host, when it began.
    pub start: SystemTime,
}

/// Lowest bit of turns where a description of counts does not tell: those of recordings that have been made before it did.
const TURNS_AT: u32 = 24;

/// Writes a scale as JSON.
fn scale(scale: &Scale) -> Value {
    let mut object = json!({"unit": scale.convert(0).unit});
    match *scale {
        Scale::Rotary {
            steps_per_turn,
            turns,
            turns_at,
        } => {
            object["steps_per_turn"] = json!(steps_per_turn);
            object["turns"] = json!(turns);
            if turns_at.is_some() {
                object["turns_at"] = json!(turns_at);
            }
        }
        Scale::Linear { step_nm } => {
            object["linear"] = json!(true);
            object["step_nm"] = json!(step_nm);
        }
        Scale::Counted => object["linear"] = json!(true),
        Scale::Counts { turns_at } => object["turns_at"] = json!(turns_at),
    }
    if let Some(range) = scale.range() {
        object["range"] = json!(range);
    }
    object
}

/// Reads the scale of a channel from a description.
pub fn scale_of(object: &Value) -> Option<Scale> {
    let bit = |name: &str| {
        let told = object[name].as_u64().and_then(|n| n.try_into().ok());
        told.filter(|n: &u32| *n < u64::BITS)
    };
    if let Some(steps_per_turn) = object["steps_per_turn"].as_u64() {
        // Older descriptions have the product alone.
        let range = object["range"].as_u64();
        let turns = range.map(|range| range / steps_per_turn.max(1));
        return Some(Scale::Rotary {
            steps_per_turn,
            turns: object["turns"].as_u64().or(turns).unwrap_or(1).max(1),
            turns_at: bit("turns_at"),
        });
    }
    if let Some(step_nm) = object["step_nm"].as_f64() {
        return Some(Scale::Linear { step_nm });
    }
    if object["linear"] == true {
        return Some(Scale::Counted);
    }
    (object["unit"] == "counts").then(|| Scale::Counts {
        turns_at: match object.get("turns_at") {
            Some(_) => bit("turns_at"),
            None => Some(bit("single_bits").unwrap_or(TURNS_AT)).filter(|at| *at < POSITION_BITS),
        },
    })
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
            let mut object = scale(one);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_positions_are_is_read_as_it_was_written() {
        for one in [
            Scale::singleturn(29),
            Scale::of_bits(25, 12, None),
            Scale::of_bits(17, 16, Some(24)),
            Scale::Linear { step_nm: 10.0 },
            Scale::Counted,
            Scale::Counts { turns_at: Some(24) },
            Scale::Counts { turns_at: None },
        ] {
            assert_eq!(scale_of(&scale(&one)), Some(one), "{one}");
        }
    }

    /// Catches a recording of an older program whose turns are counted in another way than then, or whose counts are taken for known.
    #[test]
    fn older_descriptions_mean_what_they_meant() {
        for (told, wanted) in [
            (
                json!({"unit": "deg", "steps_per_turn": 1 << 25, "range": 1u64 << 37}),
                Some(Scale::of_bits(25, 12, None)),
            ),
            (
                json!({"unit": "deg", "steps_per_turn": 1 << 29}),
                Some(Scale::singleturn(29)),
            ),
            (
                json!({"unit": "counts", "single_bits": 24}),
                Some(Scale::Counts { turns_at: Some(24) }),
            ),
            (
                json!({"unit": "counts", "single_bits": 48}),
                Some(Scale::Counts { turns_at: None }),
            ),
            (
                json!({"unit": "counts"}),
                Some(Scale::Counts { turns_at: Some(24) }),
            ),
            (json!({}), None),
        ] {
            assert_eq!(scale_of(&told), wanted, "{told}");
        }
    }
}
