//! The text of a configuration: what was answered, and beside it every key that was not asked for, with what counts without it.

use super::questions::{form_of, has_board, has_uart, place_of, Answers, Of, NOTHING, QUESTIONS};
use endat_config::base::takes;
use endat_config::board::{card_ports, Board, Kind as PortKind, MorePorts};
use endat_config::form::key::head;
use endat_config::json_schema::plain;
use endat_config::keys::{
    self, Key, Kind, Usual, CARD_FORM, CHANNELS, COMMON, ENDAT_FORM, KEYS, TABLES,
};
use endat_console::error::{shown, CommandError};
use endat_console::number::{grouped, number};
use endat_hdl::card::bus::HostBus;
use std::fmt::Write;

/// Comments are not longer.
const WIDTH: usize = 110;

/// How an answer is written; an error if it cannot be.
pub fn literal(of: Of, option: &str, answer: &str) -> Result<String, CommandError> {
    match of {
        Of::Channels => {
            let range = endat_hdl::config::CHANNELS;
            let range = *range.start() as u64..=*range.end() as u64;
            number(option, answer, range).map(|n| n.to_string())
        }
        Of::Key(key, _) if key.kind == Kind::Number => {
            let limits = key.limits(None);
            let (low, high) = limits.range().into_inner();
            let low = if limits.or_zero() { 0 } else { low };
            number(option, answer, low..=high).map(grouped)
        }
        Of::Key(key, _) if key.kind == Kind::Boolean => match answer {
            "true" | "false" => Ok(answer.to_owned()),
            other => Err(CommandError::input(format!(
                "{option} = {}: is neither true nor false; give one of the two",
                shown(other)
            ))),
        },
        Of::Key(key, _) if key.kind == Kind::Texts => {
            let words = answer.split([',', ' ']).filter(|word| !word.is_empty());
            let words = words.filter(|_| answer != NOTHING).map(toml::Value::from);
            Ok(toml::Value::Array(words.collect()).to_string())
        }
        Of::Key(..) => Ok(toml::Value::from(answer).to_string()),
    }
}

/// What counts without a key, as it would be written.
fn usual(key: &Key) -> Option<String> {
    let words = || {
        key.words()
            .iter()
            .map(|w| format!("{w:?}"))
            .collect::<Vec<_>>()
    };
    match key.usual {
        Usual::Number(number) => Some(grouped(number)),
        Usual::Word(word) => Some(format!("{word:?}")),
        Usual::Boolean(value) => Some(value.to_string()),
        Usual::Empty => Some("[]".into()),
        Usual::All => Some(format!("[{}]", words().join(", "))),
        Usual::Required(_) | Usual::Follows(_) => None,
    }
}

/// Lines of a comment.
fn comment(words: &str) -> String {
    let mut text = String::new();
    let mut line = String::from("#");
    for word in words.split_whitespace() {
        if line.len() + 1 + word.len() > WIDTH {
            text += &line;
            text.push('\n');
            line = "#".into();
        }
        line.push(' ');
        line += word;
    }
    text + &line + "\n"
}

fn about(key: &Key) -> String {
    let otherwise = match key.usual {
        Usual::Required(_) => String::new(),
        _ => format!(" (default: {})", key.otherwise("")),
    };
    comment(&plain(&format!(
        "{}: {}{otherwise}",
        key.meaning,
        key.may_be("")
    )))
}

/// Ports of the card's board top, if it has one.
fn ports(answers: &Answers) -> Option<(Board, Vec<(String, PortKind)>)> {
    let name = answers.get("board").filter(|_| has_board(answers))?;
    let bus = HostBus::from_name(answers.get("bus")?)?;
    // None of the questions is about an interrupt or the second interface.
    let ports = card_ports(bus, MorePorts::default(), count(answers)?);
    Some((Board::named(name).ok()?, ports))
}

/// The lines of `[pins]`: free pins for signals that the board has no usual pins for; empty if too few are free.
fn pins(answers: &Answers) -> String {
    let Some((board, ports)) = ports(answers) else {
        return String::new();
    };
    let spare = board.spare_places(&ports).unwrap_or_default();
    if spare.is_empty() {
        return String::new();
    }
    let mut text = comment(&format!(
        "{} has no usual pins for the following signals, so they are on its first free ones: check each of them against your wiring.",
        board.name
    ));
    for (signal, place) in spare {
        let _ = writeln!(text, "{signal} = \"{place}\"");
    }
    text
}

/// How many channels were answered.
fn count(answers: &Answers) -> Option<usize> {
    let told = answers.get("channels").map_or("1", String::as_str);
    literal(Of::Channels, "channels", told).ok()?.parse().ok()
}

/// What was answered for a key of a table.
fn answer(answers: &Answers, key: &Key, table: &str) -> Option<String> {
    let found = QUESTIONS.iter().find(|question| match question.of {
        Of::Key(other, its) => other.name == key.name && place_of(its, answers) == table,
        Of::Channels => false,
    })?;
    let told = answers.get(found.name)?;
    // What is empty is not said, and no board is none.
    let is_said = !told.is_empty() && (found.name != "board" || has_board(answers));
    let text = literal(found.of, found.name, told).ok();
    text.filter(|_| is_said)
}

/// A table; with a comment for each key where it is `told`.
fn table(text: &mut String, answers: &Answers, table: &str, forms: u8, is_told: bool) {
    let keys = KEYS
        .iter()
        .filter(|key| key.tables.contains(&table) && key.forms & forms != 0);
    // What all channels have alike is said for all of them.
    // Of another protocol, what it has together with EnDat; what every protocol has, each may have with another default.
    let is_for_all = |key: &Key| {
        let is_told = forms != ENDAT_FORM && key.forms != CARD_FORM;
        table == CHANNELS && key.tables.contains(&COMMON) && !is_told
    };
    let keys = keys.copied().filter(|key| !is_for_all(key));
    let bus = answers.get("bus").and_then(|name| HostBus::from_name(name));
    let is_of_bus = |key: &&Key| bus.is_none_or(|bus| takes(bus, key));
    let keys: Vec<&Key> = keys.filter(is_of_bus).collect();
    let pins = match table == keys::PINS.tables[0] {
        true => pins(answers),
        false => String::new(),
    };
    let is_answered = keys.iter().any(|key| answer(answers, key, table).is_some());
    let is_said = is_answered || !pins.is_empty();
    if table.is_empty() {
        text.push('\n');
    } else {
        let meaning = TABLES.iter().find(|(name, _)| *name == table);
        let meaning = meaning.map_or("", |(_, meaning)| meaning);
        let mark = if is_said { "" } else { "# " };
        let _ = write!(text, "\n{mark}{}", head(table));
        let _ = match is_told {
            true => writeln!(text, " # {}", plain(meaning)),
            false => writeln!(text),
        };
    }
    for key in keys {
        let said = answer(answers, key, table);
        match said {
            Some(said) => {
                if is_told {
                    *text += &about(key);
                }
                let _ = writeln!(text, "{} = {said}", key.name);
            }
            None if !is_told || matches!(key.usual, Usual::Required(_)) => {}
            None => {
                *text += &about(key);
                let otherwise = usual(key).unwrap_or("...".into());
                let _ = writeln!(text, "# {} = {otherwise}", key.name);
            }
        }
    }
    *text += &pins;
}

/// The whole text.
pub fn written(answers: &Answers) -> String {
    let form = form_of(answers);
    let mut text = comment(
        "Begun by `endat-gen new`. Lines that begin with # may be left out: without a key counts what is called its default. \
         `endat-gen explain --config FILE` says what becomes of it all, and `endat-gen explain KEY` more of a key.",
    );
    table(&mut text, answers, "", form, true);
    let is_here = |table: &str| match table {
        "link" => has_uart(answers),
        "board" | "pins" => has_board(answers),
        // A channel that speaks another protocol has nothing of these.
        COMMON | "service" | "line" => form == ENDAT_FORM,
        _ => true,
    };
    for (name, _) in TABLES.iter().filter(|(name, _)| is_here(name)) {
        let has_keys = KEYS
            .iter()
            .any(|key| key.tables.contains(name) && key.forms & form != 0);
        match *name {
            keys::CHANNELS => {
                for n in 0..count(answers).unwrap_or(1) {
                    table(&mut text, answers, CHANNELS, form, n == 0);
                }
            }
            name if has_keys => table(&mut text, answers, name, form, true),
            _ => {}
        }
    }
    text
}
