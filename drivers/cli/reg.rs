//! `reg`: words of the card by name.

use crate::port::{told, AnyCard, PortArgs};
use clap::{Args, Subcommand};
use endat_console::error::CommandError;
use endat_console::number::number;
use endat_host::registers::{Access, Field, Named, Place, Values};
use endat_host::HostError;
use endat_regs::{Protocol, BLOCKS};
use endat_terminal::outcome::{to_json, Outcome};
use serde_json::{json, Value};
use std::fmt::Write;

/// Arguments of `reg`.
#[derive(Args)]
pub struct RegArgs {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// Read words or fields
    Read {
        #[command(flatten)]
        port: PortArgs,
        /// BLOCK.REGISTER or BLOCK.REGISTER.FIELD, for example result0.status.cause; BLOCK for all its words
        #[arg(required = true, value_name = "NAME")]
        names: Vec<String>,
        /// As JSON
        #[arg(long)]
        json: bool,
    },
    /// Write a word or a field, and read it back
    Write {
        #[command(flatten)]
        port: PortArgs,
        /// BLOCK.REGISTER or BLOCK.REGISTER.FIELD, for example config0.frame.period_cycles
        name: String,
        /// Number, the name of one of the field's values, or names of its bits: result,error
        #[arg(allow_negative_numbers = true)]
        value: String,
        /// Write what the register map forbids, too
        #[arg(long)]
        force: bool,
        /// What it reads then, as JSON
        #[arg(long)]
        json: bool,
    },
    /// List the registers that a card can have, without a card
    List {
        /// As JSON
        #[arg(long)]
        json: bool,
    },
}

/// Runs the command.
pub fn run(arguments: &RegArgs) -> Result<Outcome, CommandError> {
    match &arguments.action {
        Action::Read { port, names, json } => read(&mut port.open()?, names, *json),
        Action::Write {
            port,
            name,
            value,
            force,
            json,
        } => write(&mut port.open()?, name, value, *force, *json),
        Action::List { json: false } => Ok(Outcome::good(list())),
        Action::List { json: true } => to_json(&list_as_json()).map(Outcome::good),
    }
}

/// All words of a block, or the one place.
fn places(card: &AnyCard, name: &str) -> Result<Vec<Place>, CommandError> {
    if name.contains('.') {
        return Ok(vec![card.place(name).map_err(told)?]);
    }
    // Any register of the block tells whether the block is there.
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let block = BLOCKS
        .iter()
        .find(|b| b.name == if b.per_channel { stem } else { name });
    match block {
        Some(block) => block
            .registers
            .iter()
            .filter(|r| r.part.is_none_or(|part| card.identity().has(part)))
            .map(|r| card.place(&format!("{name}.{}", r.name)).map_err(told))
            .collect(),
        None => Ok(vec![card.place(name).map_err(told)?]),
    }
}

/// A field with what it says, in words if there are any.
type Seen = (&'static Field, u32, Option<String>);

/// What a place says.
fn looked_at(card: &mut AnyCard, place: &Place) -> Result<(u32, Vec<Seen>), HostError> {
    let value = card.read(place)?;
    let protocol = card.identity().protocol_of(place);
    let seen = |f: &'static Field, word| (f, f.of(word), f.told(word, protocol));
    let fields = match place.field {
        Some(field) => vec![seen(field, value << field.lsb)],
        None => place
            .register
            .fields
            .iter()
            .map(|f| seen(f, value))
            .collect(),
    };
    Ok((value, fields))
}

/// The same as JSON.
fn object(place: &Place, value: u32, fields: &[Seen]) -> Value {
    let fields = fields.iter().map(|(field, value, told)| {
        let about = json!({"value": value, "unit": field.unit, "meaning": told});
        (field.name.to_owned(), about)
    });
    json!({
        "name": place.to_string(),
        "address": place.address(),
        "value": value,
        "fields": fields.collect::<serde_json::Map<_, _>>(),
    })
}

/// What a place of a card says, as JSON.
pub fn as_json(card: &mut AnyCard, place: &Place) -> Result<Value, HostError> {
    let (value, fields) = looked_at(card, place)?;
    Ok(object(place, value, &fields))
}

fn read(card: &mut AnyCard, names: &[String], as_data: bool) -> Result<Outcome, CommandError> {
    // A wrong name loses nothing of the others.
    let (mut all, mut wrong) = (Vec::new(), Vec::new());
    for name in names {
        match places(card, name) {
            Ok(found) => all.extend(found),
            Err(error) => wrong.push(error),
        }
    }
    let all_wrong = all.is_empty();
    let mut text = String::new();
    let mut objects = Vec::new();
    for place in all {
        let (value, fields) = looked_at(card, &place).map_err(told)?;
        if as_data {
            objects.push(object(&place, value, &fields));
            continue;
        }
        let _ = writeln!(text, "{place} = 0x{value:08X} = {value}");
        let is_plain = fields.len() == 1 && fields[0].0.width == 32;
        for (field, value, told) in fields.iter().filter(|_| !is_plain) {
            let _ = write!(
                text,
                "  {:>5}  {:<22} {value}",
                field.bit_range(),
                field.name
            );
            if !field.unit.is_empty() {
                let _ = write!(text, " {}", field.unit);
            }
            if let Some(told) = told {
                let _ = write!(text, "  ({told})");
            }
            text.push('\n');
        }
    }
    let stdout = match as_data {
        true if all_wrong => String::new(),
        true => to_json(&objects)?,
        false => text,
    };
    Ok(Outcome {
        stdout,
        exit_code: wrong.iter().map(CommandError::exit_code).max().unwrap_or(0),
        messages: wrong.iter().flat_map(|e| e.messages().to_vec()).collect(),
    })
}

/// A number, the name of one of the field's values, or names of some of its bits.
fn value_of(
    place: &Place,
    text: &str,
    force: bool,
    protocol: Protocol,
) -> Result<u32, CommandError> {
    let by_name = |names: &[Named], text: &str| {
        let found = names.iter().find(|n| n.name == text);
        found.map(|n| n.number)
    };
    let named = match place.field.map(|f| f.values_in(protocol)) {
        Some(Values::Codes(codes)) => by_name(codes, text),
        Some(Values::Bits(bits)) => text.split(',').try_fold(0, |all, one| {
            by_name(bits, one.trim()).map(|bit| all | 1 << bit)
        }),
        _ => None,
    };
    if let Some(value) = named {
        return Ok(value);
    }
    // Where the map has limits, they are what is told of every number outside, whether it fits the bits or not.
    let limited = |f: &&Field| !f.ranges(protocol).is_empty() && !force;
    let field = place.field.filter(|f| !limited(f));
    let most = field.map_or(u32::MAX, |f| f.mask() >> f.lsb);
    let number = number("value", text, 0..=most.into()).map(|n| n as u32);
    number.map_err(|error| {
        let is_name = text.starts_with(|c: char| c.is_ascii_alphabetic());
        let names = if is_name {
            names_told(place)
        } else {
            String::new()
        };
        CommandError::input(error.messages().join("\n") + &names)
    })
}

/// The word that is written where a word's bits are named: those and no other ones, and wider fields as they are; none if they are not.
fn word_of(place: &Place, text: &str, before: u32) -> Option<u32> {
    let bits = || place.register.fields.iter().filter(|f| f.width == 1);
    let bit_of = |name: &str| bits().find(|f| f.name == name.trim()).map(Field::mask);
    let all: u32 = bits().map(Field::mask).fold(0, |all, bit| all | bit);
    let mut named = text.split(',').map(bit_of);
    let named = named.try_fold(0, |word, bit| bit.map(|bit| word | bit))?;
    place.field.is_none().then_some(before & !all | named)
}

/// What else than a number a word takes.
fn names_told(place: &Place) -> String {
    let bits = place.register.fields.iter().filter(|f| f.width == 1);
    let names: Vec<&str> = bits.map(|f| f.name).collect();
    match place.field.is_none() && !names.is_empty() {
        true => format!(", or names of its bits: {}", names.join(", ")),
        false => String::new(),
    }
}

/// When a period of the timer that was written takes effect, if the timer runs; `before` is the one until now.
fn period_told(card: &mut AnyCard, place: &Place, before: u32) -> Result<String, HostError> {
    let now = card.read(place)?;
    let field = place.register.field("value");
    let counts = field.map_or(0, |f| u64::from(f.mask() >> f.lsb) + 1);
    let hz = f64::from(card.identity().system_hz.max(1));
    Ok(match now < before {
        true => format!(
            "{place}: the timer was on, and may have counted beyond {now} already: then the next trigger comes only when it has counted through all of its {counts} cycles, {:.3} s; write 0 to card_config.trigger_sources.timer before, and 1 behind it",
            counts as f64 / hz
        ),
        false => format!("{place}: the timer was on, and the period under way is the new one"),
    })
}

fn write(
    card: &mut AnyCard,
    name: &str,
    text: &str,
    force: bool,
    as_data: bool,
) -> Result<Outcome, CommandError> {
    let place = card.place(name).map_err(told)?;
    let protocol = card.identity().protocol_of(&place);
    // What acts when it is written says nothing of itself.
    let before = match place.register.access {
        Access::Strobe => 0,
        _ => card.read(&place).map_err(told)?,
    };
    let value = match word_of(&place, text, before) {
        Some(word) => word,
        None => value_of(&place, text, force, protocol)?,
    };
    if !force {
        card.permits(&place, value)
            .map_err(|e| CommandError::input(format!("{e}; --force writes it all the same")))?;
    }
    let period = card.place("card_config.trigger_period").map_err(told)?;
    let running = match place.address() == period.address() {
        true => card
            .read_named("card_config.trigger_sources.timer")
            .and_then(|is_on| Ok((is_on == 1).then_some(card.read(&period)?))),
        false => Ok(None),
    };
    let running = running.map_err(told)?;
    card.write(&place, value).map_err(told)?;
    if place.register.access == Access::Strobe && as_data {
        let done = json!({"name": place.to_string(), "address": place.address()});
        return to_json(&done).map(Outcome::good);
    }
    if place.register.access == Access::Strobe {
        return Ok(Outcome::good(format!("{place}: done\n")));
    }
    let now = card.read(&place).map_err(told)?;
    let mut outcome = Outcome::good(match as_data {
        true => to_json(&self::as_json(card, &place).map_err(told)?)?,
        false => format!("{place} = 0x{now:08X} = {now}\n"),
    });
    if let Some(before) = running.filter(|before| *before != value) {
        let text = period_told(card, &period, before).map_err(told)?;
        outcome.messages.push(text);
    }
    if now != value {
        outcome.messages.push(format!(
            "{place}: wrote {value}, reads {now}: the word acts when written, or has bits that do not keep it"
        ));
    }
    Ok(outcome)
}

fn list_as_json() -> Vec<Value> {
    let register = |block: &'static endat_regs::Block| {
        block.registers.iter().map(|register| {
            let fields = register.fields.iter().map(|field| {
                json!({"name": field.name, "lsb": field.lsb, "width": field.width, "unit": field.unit, "meaning": field.meaning})
            });
            json!({
                "name": register.name,
                "address": block.base + register.offset,
                "access": register.access.short(),
                "part": register.part.map(|part| part.named().name),
                "meaning": register.meaning,
                "fields": fields.collect::<Vec<_>>(),
            })
        })
    };
    let block = |block: &'static endat_regs::Block| {
        json!({
            "name": block.name,
            "per_channel": block.per_channel,
            "meaning": block.meaning,
            "registers": register(block).collect::<Vec<_>>(),
        })
    };
    BLOCKS.iter().map(block).collect()
}

fn list() -> String {
    let mut text = String::new();
    for block in BLOCKS {
        let number = if block.per_channel { "0" } else { "" };
        let _ = writeln!(text, "{}{number}: {}", block.name, block.meaning);
        for register in block.registers {
            let access = register.access.short();
            let _ = writeln!(
                text,
                "  0x{:03X} {access:<6} {}{number}.{}: {}",
                block.base + register.offset,
                block.name,
                register.name,
                register.meaning
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_numbers_or_names_of_codes_and_bits() {
        let place = |name: &str| Place::named(name, 2).unwrap();
        let mask = place("interrupt.mask.channel_1");
        assert_eq!(
            value_of(&mask, "result,alarm", false, Protocol::Endat).unwrap(),
            0b101
        );
        assert_eq!(value_of(&mask, "0xF", false, Protocol::Endat).unwrap(), 15);
        assert!(value_of(&mask, "result,alarms", false, Protocol::Endat).is_err());
        let command = place("config0.frame.command");
        assert_eq!(
            value_of(&command, "0b000111", false, Protocol::Endat).unwrap(),
            7
        );
        assert!(value_of(&command, "64", false, Protocol::Endat).is_err());
        let whole = place("interrupt.mask");
        assert_eq!(
            value_of(&whole, "4294967295", false, Protocol::Endat).unwrap(),
            u32::MAX
        );
    }
}
