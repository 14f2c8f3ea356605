//! JSON Schemas of configurations and of boards' files, for editors that complete and check TOML. They are made of the tables of keys; what
//! is here besides is which keys go together, as far as a schema can say it. Where it says less than the reader, the reader decides.

use crate::base;
use crate::board::BOARD_KEYS;
use crate::form::key::{Key, Kind, Usual, ANY_NAME};
use crate::keys::*;
use crate::words::RECEIVER_BUS;
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::CHANNELS as COUNTS;
use endat_regs::Protocol;
use serde_json::{json, Map, Value};

/// What every schema begins with.
pub const COMMENT: &str = "Written by endat-gen schema from its table of keys. Do not edit.";
/// The one version that all editors know.
const DRAFT: &str = "http://json-schema.org/draft-07/schema#";

/// A text of the tables without Markdown, whose links are in the folder of the pages.
pub fn plain(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('[') {
        plain += before;
        let link = behind.split_once("](");
        let link = link.and_then(|(words, tail)| Some((words, tail.split_once(')')?)));
        match link.filter(|(words, _)| !words.contains(']')) {
            Some((words, (url, tail))) => {
                let page = url.split('#').next().unwrap_or_default();
                plain += &match page {
                    "" => words.to_owned(),
                    page => format!("docs/{page}"),
                };
                rest = tail;
            }
            None => {
                plain.push('[');
                rest = behind;
            }
        }
    }
    (plain + rest).replace('`', "")
}

/// What a key is, in one text.
fn description(key: &Key) -> String {
    let mut text = format!("{}: {}", key.meaning, key.may_be(""));
    if !key.note.is_empty() {
        text += &format!("; {}", key.note);
    }
    match key.usual {
        Usual::Required(_) => {}
        _ => text += &format!(". Default: {}", key.otherwise("")),
    }
    plain(&text)
}

/// What may stand under a key.
fn value(key: &Key) -> Value {
    let words = key.words();
    let choices: Vec<Value> = match key.kind {
        Kind::Number => words
            .iter()
            .map(|w| json!(w.parse::<u64>().unwrap_or(0)))
            .collect(),
        _ => words.iter().map(|w| json!(w)).collect(),
    };
    let few = !choices.is_empty();
    match key.kind {
        Kind::Boolean => json!({"type": "boolean"}),
        Kind::Number if few => json!({"type": "integer", "enum": choices}),
        Kind::Number => {
            let limits = key.limits(None);
            let (low, high) = limits.range().into_inner();
            let mut range = json!({"minimum": low, "maximum": high});
            if limits.or_zero() {
                range = json!({"anyOf": [{"const": 0}, range]});
            }
            range["type"] = "integer".into();
            if key.step > 1 {
                range["multipleOf"] = key.step.into();
            }
            range
        }
        Kind::Text => {
            let mut text = json!({"type": "string"});
            match (few, key.is_open) {
                (true, true) => text["anyOf"] = json!([{"enum": choices}, {"type": "string"}]),
                (true, false) => text["enum"] = choices.into(),
                _ => {}
            }
            if key.most > 0 {
                text["maxLength"] = key.most.into();
            }
            if !key.pattern.is_empty() {
                text["pattern"] = key.pattern.into();
            }
            text
        }
        Kind::Texts => {
            let mut list = json!({"type": "array", "items": {"type": "string"}});
            if few {
                list["items"]["enum"] = choices.into();
            }
            if few && !key.repeats {
                list["uniqueItems"] = true.into();
            }
            if key.most > 0 {
                list["maxItems"] = key.most.into();
            }
            if let (true, Some(first)) = (key.first_leads, words.first()) {
                list["anyOf"] = json!([{"maxItems": 0}, {"contains": {"const": first}}]);
            }
            list
        }
        Kind::Numbers => {
            let ranges = key.items.iter().map(|range| {
                let (low, high) = (range.start(), range.end());
                json!({"minimum": low, "maximum": high})
            });
            let ranges: Vec<Value> = ranges.collect();
            json!({
                "type": "array",
                "items": {"type": "integer", "anyOf": ranges},
                "uniqueItems": true,
                "maxItems": key.most,
            })
        }
    }
}

/// A key, with what it means.
fn property(key: &Key) -> Value {
    let mut value = value(key);
    value["description"] = description(key).into();
    match key.usual {
        Usual::Number(number) => value["default"] = number.into(),
        Usual::Word(word) => value["default"] = word.into(),
        Usual::Boolean(is) => value["default"] = is.into(),
        Usual::Empty => value["default"] = json!([]),
        Usual::All => value["default"] = json!(key.words()),
        Usual::Required(_) | Usual::Follows(_) => {}
    }
    // The words' meanings, where Taplo and Even Better TOML look for them.
    let choices = key.choices();
    if key.kind == Kind::Text && choices.iter().any(|c| !c.meaning.is_empty()) {
        let meanings: Vec<String> = choices.iter().map(|c| plain(c.meaning)).collect();
        value["x-taplo"] = json!({"docs": {"enumValues": meanings}});
    }
    value
}

/// Keys that a table must have whatever the others say.
fn required<'k>(keys: impl IntoIterator<Item = &'k Key>) -> Vec<Value> {
    let needed = keys.into_iter().filter(|k| !k.example().is_empty());
    needed.map(|k| k.name.into()).collect()
}

/// A table, without what it must have.
fn table(keys: &[&'static Key], meaning: &str) -> Value {
    let (free, fixed): (Vec<&Key>, Vec<&Key>) = keys.iter().partition(|k| k.names.is_some());
    let mut properties = Map::new();
    let mut rest = json!(false);
    for key in fixed {
        properties.insert(key.name.into(), property(key));
    }
    for key in free {
        let names = key.names.map(|names| names()).unwrap_or_default();
        if names.is_empty() {
            rest = property(key);
        }
        properties.extend(names.into_iter().map(|name| (name, property(key))));
    }
    let mut table =
        json!({"type": "object", "properties": properties, "additionalProperties": rest});
    if !meaning.is_empty() {
        table["description"] = meaning.into();
    }
    let taken = keys.iter().filter(|key| !key.takes.is_empty());
    let takes: Vec<Value> = taken.map(|key| takes(key)).collect();
    if !takes.is_empty() {
        table["allOf"] = takes.into();
    }
    table
}

/// Where the key stands its part is in the list; an empty list asks for nothing.
fn takes(key: &Key) -> Value {
    let something = match key.kind {
        Kind::Numbers => json!({"minItems": 1}),
        _ => json!(true),
    };
    json!({
        "if": {"properties": {key.name: something}, "required": [key.name]},
        "then": {"properties": {"parts": {"contains": {"const": key.takes}}}, "required": ["parts"]},
    })
}

fn of_table(all: &[&'static Key], name: &str) -> Vec<&'static Key> {
    let is_in = |key: &&&Key| key.tables.contains(&name);
    all.iter().filter(is_in).copied().collect()
}

/// None of these.
fn none_of<'n>(names: impl IntoIterator<Item = &'n str>) -> Value {
    let none = names.into_iter().map(|n| (n.to_owned(), json!(false)));
    Value::Object(none.collect())
}

/// What a channel of this form has, and has not.
fn channel_of(form: u8) -> Value {
    let foreign = of_channels(!form).filter(|key| key.forms & form == 0);
    let own = of_channels(form).filter(|key| key.tables.len() == 1);
    json!({"properties": none_of(foreign.map(|k| k.name)), "required": required(own)})
}

/// The bus is written, and one of these.
fn bus_is(buses: &[&str]) -> Value {
    let is_one = json!({"properties": {BUS.name: {"enum": buses}}, "required": [BUS.name]});
    json!({"properties": {"host": is_one}, "required": ["host"]})
}

/// What a card's tables have to do with each other.
fn card_rules() -> Value {
    let speaks = |word: &str| json!({"properties": {PROTOCOL.name: {"const": word}}, "required": [PROTOCOL.name]});
    let others = || Protocol::ALL.iter().filter(|p| **p != Protocol::Endat);
    let channel = others().fold(channel_of(ENDAT_FORM), |otherwise, p| {
        json!({"if": speaks(p.row().word), "then": channel_of(form(*p)), "else": otherwise})
    });
    let has_clock = json!({"required": [CLOCK_HZ.name]});
    let common = json!({"properties": {COMMON: has_clock}, "required": [COMMON]});
    let mut either: Vec<Value> = others().map(|p| speaks(p.row().word)).collect();
    either.push(has_clock);
    let each = json!({"properties": {CHANNELS: {"items": {"anyOf": either}}}});
    let others: Vec<&str> = (HostBus::ALL.iter())
        .filter(|bus| **bus != HostBus::Uart)
        .map(|bus| bus.name())
        .collect();
    let internal = HostBus::ALL.iter().filter(|bus| bus.is_internal());
    let internal: Vec<&str> = internal.map(|bus| bus.name()).collect();
    let only_with = |key: &Key| {
        let takers = HostBus::ALL.iter().filter(|bus| base::takes(**bus, key));
        let takers: Vec<&str> = takers.map(|bus| bus.name()).collect();
        let without = json!({"properties": {"host": {"properties": none_of([key.name])}}});
        json!({"if": bus_is(&takers), "then": true, "else": without})
    };
    json!({
        "required": ["clock", "trigger"],
        "properties": {CHANNELS: {"items": channel}},
        "anyOf": [common, each],
        "allOf": [
            {"if": bus_is(&others), "then": {"properties": none_of(["link"])}, "else": {"required": ["link"]}},
            {"if": bus_is(&internal), "then": {"properties": none_of(["board", "pins"])}},
            only_with(&BASE_ADDRESS),
            only_with(&SCK_HZ),
            {"if": bus_is(&[HostBus::Bare.name()]), "then": {"properties": {CHANNELS: {"maxItems": 1}}}},
        ],
    })
}

/// What a receiver has, and has not.
fn receiver_rules() -> Value {
    let ours = tables(RECEIVER_FORM);
    let foreign = tables(CARD_FORM);
    let foreign = foreign.into_iter().filter(|table| !ours.contains(table));
    let host = KEYS
        .iter()
        .filter(|k| k.tables.contains(&"host") && k.forms & RECEIVER_FORM == 0);
    let mut channel = channel_of(RECEIVER_FORM);
    channel["properties"][PROTOCOL.name] = json!({"const": Protocol::TFormat.row().word});
    channel["required"] = json!([PROTOCOL.name]);
    let mut properties = none_of(foreign);
    properties["host"] = json!({"properties": none_of(host.map(|k| k.name))});
    properties[CHANNELS] = json!({"maxItems": 1, "items": channel});
    json!({"properties": properties})
}

/// A whole schema.
fn schema(title: &str, mut body: Value) -> Value {
    body["$comment"] = COMMENT.into();
    body["$schema"] = DRAFT.into();
    body["title"] = title.into();
    body
}

/// The schema of a configuration.
pub fn card() -> Value {
    let mut body = table(&of_table(KEYS, ""), "");
    for (name, meaning) in TABLES {
        let keys = of_table(KEYS, name);
        let mut table = table(&keys, &plain(meaning));
        match *name {
            // What a channel must have is a matter of what it speaks.
            COMMON | CHANNELS => {}
            "board" => {
                table["oneOf"] =
                    json!([{"required": [BOARD_NAME.name]}, {"required": [BOARD_FILE.name]}]);
            }
            _ => table["required"] = required(keys).into(),
        }
        if *name == CHANNELS {
            let (least, most) = (COUNTS.start(), COUNTS.end());
            table = json!({"type": "array", "minItems": least, "maxItems": most, "items": table});
        }
        body["properties"][*name] = table;
    }
    body["required"] = json!([NAME.name, CHANNELS]);
    body["if"] = bus_is(&[RECEIVER_BUS]);
    body["then"] = receiver_rules();
    body["else"] = card_rules();
    schema("Configuration of an EnDat receiver card", body)
}

/// The schema of a board's file.
pub fn board() -> Value {
    let top = of_table(BOARD_KEYS, "");
    let mut body = table(&top, "");
    for key in BOARD_KEYS.iter().filter(|k| k.tables != [""]) {
        let name = key.tables.first().copied().unwrap_or_default();
        let keys = of_table(BOARD_KEYS, name);
        let mut table = table(&keys, "");
        let fixed = keys.into_iter().filter(|k| k.names.is_none());
        table["required"] = required(fixed).into();
        match name.strip_suffix(ANY_NAME) {
            Some(all) => {
                body["properties"][all] = json!({"type": "object", "additionalProperties": table});
            }
            None => body["properties"][name] = table,
        }
    }
    // A package has numbered pins, or a grid of balls.
    let (packages, others): (Vec<&Key>, Vec<&Key>) =
        (top.iter()).partition(|key| key.name.starts_with("package_"));
    let (numbered, grid): (Vec<&Key>, Vec<&Key>) =
        (packages.iter()).partition(|key| key.name.ends_with("_pins"));
    body["required"] = required(others).into();
    body["oneOf"] = json!([
        {"required": required(numbered)},
        {"required": required(grid)},
    ]);
    schema("A board for EnDat receiver cards", body)
}
