//! `read`: the latest positions, once.

use crate::port::{scales, settled, told, RangedPort};
use clap::Args;
use endat_console::error::CommandError;
use endat_driver::Reading;
use endat_host::units::Scale;
use endat_host::{causes, range};
use endat_regs::{Part, Protocol};
use endat_terminal::colour;
use endat_terminal::outcome::{to_json, Outcome};
use serde_json::{json, Value};
use std::fmt::Write;

/// Arguments of `read`.
#[derive(Args)]
pub struct ReadArgs {
    #[command(flatten)]
    port: RangedPort,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// A position with its unit, as people read it; a dash if there is none.
pub fn shown(reading: &Reading, scale: &Scale) -> String {
    if !reading.valid {
        return "-".into();
    }
    let units = scale.convert(reading.position);
    let value = format!("{:.*} {}", scale.digits(), units.value, units.unit);
    match units.turns {
        Some(turns) if matches!(scale, Scale::Counts { .. }) => {
            format!("single {value}, multi {turns}")
        }
        Some(turns) if turns > 0 => format!("{value} + {turns} turns"),
        _ => value,
    }
}

/// Whether a position is older than its age can tell: 65 ms.
fn is_old(reading: &Reading) -> bool {
    reading.valid && reading.age_us == u16::MAX
}

/// Why a position is so old, if it is: triggers that bring none have a cause, without one there are none.
fn why_old(reading: &Reading) -> Option<String> {
    let why = match (reading.fresh, reading.cause) {
        (false, 1..) => {
            let name = reading.cause_name();
            let [means, then] = causes::advice(name).unwrap_or(["", ""]);
            format!("the last trigger brought none, cause {name}: {means}; {then}")
        }
        _ => "is a trigger enabled (`endat reg read card_config`)?".into(),
    };
    is_old(reading).then(|| format!("the position is older than 65 ms; {why}"))
}

/// What every command tells of a result as data.
pub fn json(channel: usize, reading: &Reading, scale: &Scale) -> Value {
    let units = scale.convert(reading.position);
    json!({
        "channel": channel,
        "position": reading.valid.then_some(reading.position),
        "value": reading.valid.then_some(units.value),
        "unit": units.unit,
        "turns": units.turns.filter(|_| reading.valid),
        "in_range": is_in_range(reading, scale),
        "fresh": reading.fresh,
        "cause": reading.cause_name(),
        "age_us": reading.age_us,
    })
}

/// Whether a position has no bit outside the range of its channel.
pub fn is_in_range(reading: &Reading, scale: &Scale) -> bool {
    !reading.valid || scale.fits(reading.position)
}

/// Names the kind of a result, and its special bits.
pub fn verdict(reading: &Reading, scale: &Scale) -> String {
    match reading.special_bits {
        Some(bits @ 1..) => format!("{}, special bits 0x{bits:02X}", kind(reading, scale)),
        _ => kind(reading, scale),
    }
}

fn kind(reading: &Reading, scale: &Scale) -> String {
    if !is_in_range(reading, scale) {
        return "wrong: bits outside its range".into();
    }
    if reading.fresh && is_old(reading) {
        return "old: no result for more than 65 ms".into();
    }
    match (reading.fresh, reading.valid, reading.cause) {
        (true, _, 0) => "good".into(),
        (true, ..) => format!("good, {}", reading.cause_name()),
        (_, true, 0) => "held: the answer had no position".into(),
        (_, true, _) => format!("held: {}", reading.cause_name()),
        _ if reading.sequence == 0 => "none yet".into(),
        (.., 0) => "none: the answer had no position".into(),
        _ => format!("none: {}", reading.cause_name()),
    }
}

/// Names the flags of a frame that its primary cause hides.
fn also(reading: &Reading, protocol: Protocol) -> String {
    let others = reading.flag_names(protocol);
    let others: Vec<_> = others.filter(|f| *f != reading.cause_name()).collect();
    match others[..] {
        [] => String::new(),
        _ => format!(", also {}", others.join(", ")),
    }
}

/// The same with its colour.
fn painted_verdict(reading: &Reading, scale: &Scale) -> String {
    let told = verdict(reading, scale);
    if !is_in_range(reading, scale) {
        return colour::bad(told);
    }
    match (reading.fresh && !is_old(reading), reading.cause) {
        (true, 0) => colour::good(told),
        (true, _) => colour::doubtful(told),
        (false, _) if reading.has_come() => colour::bad(told),
        _ => colour::doubtful(told),
    }
}

/// Runs the command.
pub fn run(arguments: &ReadArgs) -> Result<Outcome, CommandError> {
    let mut card = arguments.port.open()?;
    settled(&mut card)?;
    let scales = scales(&mut card)?;
    let results = card.results().map_err(told)?;
    let system_hz = f64::from(card.identity().system_hz);
    let mut messages = Vec::new();
    if !results.channels.iter().any(|r| r.has_come()) {
        messages.push(
            "no channel has a result since reset; trigger one with `endat reg write card.trigger_now 1 --port PORT`, or enable the timer (`endat reg write card_config.trigger_sources.timer 1 --port PORT`); a card behind `virtual` is a new one each time, start one with `card`".into(),
        );
    }
    let each = results.channels.iter().enumerate();
    messages.extend(
        each.filter_map(|(channel, r)| Some(format!("channel {channel}: {}", why_old(r)?))),
    );
    let each = results.channels.iter().zip(&scales).enumerate();
    let outside = each
        .clone()
        .filter(|(_, (r, scale))| !is_in_range(r, scale));
    messages.extend(outside.map(|(n, (_, scale))| range::too_small(n, 1, scale)));
    let mut pairs = each.clone().map(|(_, pair)| pair);
    let is_good = pairs.all(|(r, scale)| r.fresh && !is_old(r) && is_in_range(r, scale));
    let has_infos = card.identity().has(Part::Requests);
    let stdout = if arguments.json {
        let objects = each.map(|(channel, (r, scale))| {
            let mut object = json(channel, r, scale);
            object["sequence"] = r.sequence.into();
            object["timestamp_s"] = (f64::from(r.timestamp) / system_hz).into();
            object["stale"] = r.stale.into();
            let flags = r.flag_names(card.identity().protocol(channel));
            object["flags"] = flags.collect::<Vec<_>>().into();
            object["delay_cycles"] = r.delay_cycles.into();
            if let Some(bits) = r.special_bits {
                object["special_bits"] = bits.into();
            }
            for (n, info) in r.infos.iter().enumerate().filter(|_| has_infos) {
                let good = info.good();
                let good = good.map(|i| json!({ "status": i.status, "content": i.content }));
                object[format!("info_{}", n + 1)] = json!(good);
            }
            object
        });
        to_json(&objects.collect::<Vec<_>>())?
    } else {
        let mut text = format!(
            "{:>7}  {:<24} {:>16}  {:>9}  {}\n",
            "channel", "position", "raw", "age us", "result"
        );
        for (channel, (r, scale)) in each {
            let raw = if r.valid {
                format!("0x{:X}", r.position)
            } else {
                "-".into()
            };
            let _ = writeln!(
                text,
                "{channel:>7}  {:<24} {raw:>16}  {:>9}  {}{}",
                shown(r, scale),
                r.age_us,
                painted_verdict(r, scale),
                also(r, card.identity().protocol(channel)),
            );
        }
        text
    };
    Ok(Outcome {
        messages,
        exit_code: u8::from(!is_good),
        ..Outcome::good(stdout)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use endat_regs::causes::endat;
    use endat_regs::RESULT;

    const ANY: Scale = Scale::Counts { turns_at: None };

    /// Catches an angle that has lost its upper bits and is called good.
    #[test]
    fn a_position_with_bits_outside_its_range_is_not_called_good() {
        let reading = |position| Reading {
            position,
            valid: true,
            fresh: true,
            ..Reading::default()
        };
        let small = Scale::of_bits(17, 4, Some(24));
        assert_eq!(verdict(&reading(0xF << 24 | 0x1_FFFF), &small), "good");
        for outside in [1 << 17, 1 << 28] {
            let (reading, wanted) = (reading(outside), "wrong: bits outside its range");
            assert_eq!(verdict(&reading, &small), wanted);
            assert!(painted_verdict(&reading, &small).contains(wanted));
            assert_eq!(json(0, &reading, &small)["in_range"], false);
        }
    }

    #[test]
    fn a_result_of_long_ago_is_not_called_good() {
        let at = |age_us| Reading {
            valid: true,
            fresh: true,
            age_us,
            ..Reading::default()
        };
        let told = |age_us| verdict(&at(age_us), &ANY);
        assert_eq!(told(65_534), "good");
        assert_eq!(told(65_535), "old: no result for more than 65 ms");
        assert_eq!(why_old(&at(65_534)), None);
        let old = why_old(&at(65_535)).unwrap();
        assert!(old.contains("is a trigger enabled"), "{old}");
    }

    /// Catches a wrong CRC and an alarm that `read` hides because the frame had another length, too.
    #[test]
    fn what_the_primary_cause_hides_is_told() {
        let field = |name| RESULT.field("evidence", name).lsb;
        let flags = 1 << endat::flag::TAIL_LOW.trailing_zeros() | 1 << 3 | 1 << 4;
        let line = RESULT.field("status", "line");
        let words = [
            1 | 7 << 16 | 1 << (line.lsb + line.width - 1),
            0,
            0,
            0,
            flags << field("flags"),
            0,
        ];
        let reading = Reading::new(&words, Protocol::Endat);
        let told = format!(
            "{}{}",
            verdict(&reading, &ANY),
            also(&reading, Protocol::Endat)
        );
        assert_eq!(
            told,
            "none: data_not_falling, also crc, f1, tail_low, upset"
        );
        let ssi = Reading::new(
            &[1 | 2 << 16, 0, 0, 0, 0b1010 << field("flags"), 0],
            Protocol::Ssi,
        );
        let told = format!("{}{}", verdict(&ssi, &ANY), also(&ssi, Protocol::Ssi));
        assert_eq!(told, "none: data_not_high, also position_parity");
    }

    /// Catches a search for a trigger where the encoder has an alarm.
    #[test]
    fn a_position_that_is_held_has_the_advice_of_its_cause() {
        let held = Reading {
            valid: true,
            cause: causes::number("f1").unwrap(),
            age_us: u16::MAX,
            ..Reading::default()
        };
        let told = why_old(&held).unwrap();
        assert!(
            told.contains("cause f1: ") && !told.contains("enabled"),
            "{told}"
        );
    }
}
