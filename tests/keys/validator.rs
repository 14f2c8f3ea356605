//! The JSON Schemas, as JSON Schema's own validator reads them: what the reader takes it takes, and what is wrong in one key both refuse.

use super::{base_of, bases, table_of, told, BASES};
use crate::program::{good, Dir};
use crate::strangers::configurations::texts;
use crate::tools;
use endat_campaign::configurations::{mutated, valid};
use endat_config::board::{self, Board, BOARD_KEYS};
use endat_config::json_schema;
use endat_config::keys::{self, Key, Kind, Usual, CHANNELS, KEYS};
use endat_config::{parse_any, PRESETS, RECEIVER_PRESETS};
use endat_hdl::regs::Protocol;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use toml::{Table, Value};

/// Draws that are validated, and spoilt ones for each.
const QUICK_DRAWS: u64 = 15;
const DRAWS: u64 = 150;
const SPOILT: u64 = 8;

/// What the validator says of each document.
fn validated(schema: serde_json::Value, documents: &[Table]) -> Vec<String> {
    let documents: Vec<_> = documents
        .iter()
        .map(|d| serde_json::to_value(d).unwrap())
        .collect();
    let given = serde_json::json!({"schema": schema, "documents": documents});
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/validate.py");
    let mut child = Command::new("python3")
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut pipe = child.stdin.take().unwrap();
    pipe.write_all(given.to_string().as_bytes()).unwrap();
    drop(pipe);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "validate.py");
    let told: Vec<String> = String::from_utf8(output.stdout)
        .unwrap()
        .lines()
        .map(str::to_owned)
        .collect();
    assert_eq!(told.len(), documents.len());
    told
}

/// Catches a schema that refuses what the reader takes: of every configuration of the suite, and of random ones. What it refuses of spoilt
/// ones the reader refuses, too.
#[test]
fn what_the_reader_takes_the_validator_takes() {
    draws_agree(QUICK_DRAWS, 20);
}

#[test]
#[ignore = "slow: ten times as many random configurations"]
fn what_the_reader_takes_of_many_the_validator_takes() {
    draws_agree(DRAWS, 100);
}

/// Of the spoilt ones more than `least` are refused.
fn draws_agree(draws: u64, least: usize) {
    let test = "what_the_reader_takes_the_validator_takes";
    if !tools::require_python("jsonschema", test) {
        return;
    }
    let named = texts()
        .into_iter()
        .chain((0..draws).map(|n| (format!("draw {n}"), valid(n).unwrap())));
    let named: Vec<(String, String)> = named
        .chain(BASES.map(|t| ("base".to_owned(), t.to_owned())))
        .collect();
    let documents: Vec<Table> = named
        .iter()
        .map(|(_, text)| text.parse().unwrap())
        .collect();
    for ((name, text), wrong) in named.iter().zip(validated(json_schema::card(), &documents)) {
        assert_eq!(told(text), [] as [&str; 0], "{name}");
        assert_eq!(wrong, "", "{name}: {text}");
    }
    let spoilt = (0..draws).flat_map(|n| {
        let text = valid(n).unwrap();
        (0..SPOILT).map(move |m| mutated(&text, 1_000 * n + m))
    });
    // What is no TOML no validator sees.
    let spoilt: Vec<(String, Table)> = spoilt
        .filter_map(|t| Some((t.clone(), t.parse().ok()?)))
        .collect();
    let documents: Vec<Table> = spoilt.iter().map(|(_, table)| table.clone()).collect();
    let (mut caught, mut refused) = (0, 0);
    for ((text, _), wrong) in spoilt
        .iter()
        .zip(validated(json_schema::card(), &documents))
    {
        let is_good = told(text).is_empty();
        assert!(wrong.is_empty() || !is_good, "{wrong}: {text}");
        refused += usize::from(!is_good);
        caught += usize::from(!wrong.is_empty());
    }
    // The rest are numbers that do not go together.
    assert!(
        refused > least && caught * 10 > refused * 7,
        "{caught} of {refused}"
    );
}

/// What may not stand under a key, each with a word for it.
fn wrong_values(key: &Key) -> Vec<(&'static str, Value)> {
    let text = |text: &str| Value::from(text);
    let mut wrong = vec![match key.kind {
        Kind::Text => ("type", Value::from(7)),
        Kind::Number => ("type", text("fast")),
        Kind::Boolean => ("type", text("yes")),
        Kind::Texts => ("type", text("pin")),
        Kind::Numbers => ("type", Value::from(0x4C)),
    }];
    let few = !key.choices().is_empty() && !key.is_open;
    match key.kind {
        Kind::Number => {
            let limits = key.limits(None);
            let (low, high) = limits.range().into_inner();
            wrong.push(("below", Value::from(low as i64 - 1)));
            wrong.push(("above", Value::from(high as i64 + 1)));
            if key.step > 1 {
                wrong.push(("step", Value::from(key.step as i64 + 1)));
            }
        }
        Kind::Text if few => wrong.push(("word", text("no_such_word"))),
        Kind::Texts => {
            wrong.push(("item", Value::from(vec![7])));
            if few {
                let first = key.words()[0].clone();
                wrong.push((
                    "word",
                    Value::from(vec![first.clone(), "no_such_word".into()]),
                ));
                if !key.repeats {
                    wrong.push(("twice", Value::from(vec![first.clone(), first.clone()])));
                }
                if key.most > 0 {
                    wrong.push(("many", Value::from(vec![first; key.most + 1])));
                }
            }
        }
        Kind::Numbers => {
            let numbers = key.items.iter().cloned().flatten().map(|n| n as i64);
            let more: Vec<i64> = numbers.take(key.most + 1).collect();
            let behind = *key.items[0].end() as i64 + 1;
            wrong.push(("item", Value::from(vec!["x"])));
            wrong.push(("number", Value::from(vec![behind])));
            wrong.push(("twice", Value::from(vec![more[0], more[0]])));
            wrong.push(("many", Value::from(more)));
        }
        _ => {}
    }
    if key.kind == Kind::Text && key.most > 0 {
        wrong.push(("long", text(&"x".repeat(key.most + 1))));
    }
    if !key.pattern.is_empty() {
        wrong.push(("pattern", text("a b")));
    }
    wrong
}

/// Wrong documents made of the keys: what is wrong, the key that the reader has to name, and the document.
fn wrong_cards() -> Vec<(String, String, Table)> {
    let mut all = vec![];
    let mut add =
        |what: String, key: &str, document: Table| all.push((what, key.to_owned(), document));
    for key in KEYS {
        let (base, table) = base_of(key);
        let name = if key.names.is_some() {
            "trigger_i"
        } else {
            key.name
        };
        for (what, value) in wrong_values(key) {
            let mut document = base.clone();
            let place = table_of(&mut document, table).unwrap();
            if key.path() == "board.file" {
                place.clear();
            }
            place.insert(name.into(), value);
            add(format!("{} {what}", key.path()), name, document);
        }
        let mut without = base.clone();
        let place = table_of(&mut without, table).unwrap();
        if matches!(key.usual, Usual::Required(_)) && place.remove(name).is_some() {
            add(format!("{} missing", key.path()), name, without);
        }
        if key.names.is_some() {
            let mut document = base.clone();
            let place = table_of(&mut document, table).unwrap();
            place.insert("no_such_signal".into(), "A1".into());
            add(
                format!("{} unknown", key.path()),
                "no_such_signal",
                document,
            );
        }
        // Another form's key.
        for base in bases() {
            let is_receiver = base["name"].as_str() == Some("receiver");
            let channel = base[CHANNELS].as_array().unwrap()[0].as_table().unwrap();
            let speaks = channel.get("protocol").and_then(Value::as_str);
            let mut all = Protocol::ALL.iter();
            let spoken = all.find(|p| Some(p.row().word) == speaks);
            let form = match is_receiver {
                true => keys::RECEIVER_FORM,
                false => keys::form(*spoken.unwrap_or(&Protocol::Endat)),
            };
            if key.tables.contains(&CHANNELS) && key.forms & form == 0 {
                let (mut from, own_table) = base_of(key);
                let value = table_of(&mut from, own_table).unwrap()[key.name].clone();
                let mut document = base.clone();
                table_of(&mut document, CHANNELS)
                    .unwrap()
                    .insert(key.name.into(), value);
                add(
                    format!("{} in {}", key.path(), base["name"]),
                    key.name,
                    document,
                );
            }
        }
    }
    for (table, _) in keys::TABLES.iter().chain(&[("", "")]) {
        let base = bases()
            .into_iter()
            .find(|b| table_of(&mut b.clone(), table).is_some())
            .unwrap();
        let mut document = base;
        table_of(&mut document, table)
            .unwrap()
            .insert("colour".into(), "red".into());
        add(format!("[{table}] unknown"), "colour", document);
    }
    all
}

/// Catches a key that either of the two takes as it must not be: for every key a wrong type, and what is below, above or beside all that it
/// may be; keys of other tables and of other kinds of cards; keys that are missing.
#[test]
fn what_is_wrong_in_one_key_both_refuse() {
    let test = "what_is_wrong_in_one_key_both_refuse";
    if !tools::require_python("jsonschema", test) {
        return;
    }
    let wrong = wrong_cards();
    let documents: Vec<Table> = wrong
        .iter()
        .map(|(.., document)| document.clone())
        .collect();
    let mut silent = vec![];
    for ((what, key, document), said) in
        wrong.iter().zip(validated(json_schema::card(), &documents))
    {
        let told = told(&document.to_string());
        if !told.iter().any(|text| text.contains(key.as_str())) {
            silent.push(format!("{what}: the reader says {told:?}"));
        }
        if said.is_empty() {
            silent.push(format!("{what}: the schema takes it"));
        }
    }
    assert!(silent.is_empty(), "{silent:#?}");
    assert!(wrong.len() > 200, "{}", wrong.len());
}

/// The same of boards' files.
#[test]
fn what_is_wrong_in_a_board_both_refuse() {
    let test = "what_is_wrong_in_a_board_both_refuse";
    if !tools::require_python("jsonschema", test) {
        return;
    }
    let shipped = board::names()
        .into_iter()
        .map(|name| Board::text(name).unwrap().parse().unwrap());
    let shipped: Vec<Table> = shipped.collect();
    for (wrong, name) in validated(json_schema::board(), &shipped)
        .iter()
        .zip(board::names())
    {
        assert_eq!(wrong, "", "{name}");
    }
    let mut wrong = vec![];
    for key in BOARD_KEYS.iter().filter(|key| key.names.is_none()) {
        let table = key.tables[0];
        let has = |b: &&Table| {
            table_of(&mut (*b).clone(), table).is_some_and(|t| t.contains_key(key.name))
        };
        let base = shipped
            .iter()
            .find(has)
            .unwrap_or_else(|| panic!("{}: no board has it", key.path()));
        for (what, value) in wrong_values(key) {
            let mut document = base.clone();
            table_of(&mut document, table)
                .unwrap()
                .insert(key.name.into(), value);
            wrong.push((format!("{} {what}", key.path()), key.name, document));
        }
        let mut without = base.clone();
        table_of(&mut without, table).unwrap().remove(key.name);
        if matches!(key.usual, Usual::Required(_)) {
            wrong.push((format!("{} missing", key.path()), key.name, without));
        }
    }
    let documents: Vec<Table> = wrong
        .iter()
        .map(|(.., document)| document.clone())
        .collect();
    let dir = Dir::new("wrong_boards");
    for ((what, key, document), said) in wrong
        .iter()
        .zip(validated(json_schema::board(), &documents))
    {
        let file = dir.write("board.toml", document.to_string().as_bytes());
        let told = Board::from_file(Path::new(&file)).expect_err(what);
        // Of a grid that lacks a side, the other one is told about.
        let is_named = told
            .iter()
            .any(|d| d.text.contains(key) || d.text.contains("package_"));
        assert!(is_named, "{what}: {told:?}");
        assert!(!said.is_empty(), "{what}: the schema takes it");
    }
    assert!(wrong.len() > 30, "{}", wrong.len());
}

/// Catches a schema that editors do not understand: Taplo is what they ask.
#[test]
fn taplo_underlines_what_the_reader_refuses() {
    let test = "taplo_underlines_what_the_reader_refuses";
    if !tools::require("taplo", test) {
        return;
    }
    let dir = Dir::new("taplo");
    let page = include_str!("../../docs/configuration.md");
    let line = "#:schema ./endat-card.schema.json";
    assert!(page.contains(&format!("`{line}`")), "{line}");
    dir.write("endat-card.schema.json", good(&["schema"]).as_bytes());
    let lint = |text: &str| {
        dir.write("card.toml", format!("{line}\n{text}").as_bytes());
        tools::run("taplo", &dir.0, &["lint", "--colors", "never", "card.toml"])
    };
    for (name, text) in PRESETS.iter().chain(RECEIVER_PRESETS) {
        let (is_good, said) = lint(text);
        assert!(is_good, "{name}: {said}");
    }
    let preset = PRESETS[0].1;
    for (from, to, words) in [
        (
            "position_bits = 29",
            "position_bits = 49",
            "49 is greater than the maximum of 48",
        ),
        (
            "tst_ns = 2_000",
            "tst_ns = 400",
            "400 is not valid under any of",
        ),
        (
            "command = \"111000\"",
            "command = \"101010\"",
            "\"101010\" is not one of",
        ),
        (
            "parts = []",
            "parts = [\"margin\", \"requests\"]",
            "\"margin\" is not one of",
        ),
    ] {
        let text = preset.replacen(from, to, 1);
        let (is_good, said) = lint(&text);
        assert!(!is_good && said.contains(words), "{to}: {said}");
        // The line behind that of the schema.
        let complaints = parse_any("card.toml", &text).unwrap_err();
        let at = format!("card.toml:{}:", complaints[0].line + 1);
        assert!(said.contains(&at), "{at} {said}");
    }
}
