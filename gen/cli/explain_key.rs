//! `explain KEY`: what a key, a table or a word of a configuration is.

use endat_config::board::BOARD_KEYS;
use endat_config::form::key::{head, Key, Usual};
use endat_config::json_schema::plain;
use endat_config::keys::{KEYS, TABLES};
use std::fmt::Write;

/// Everything of a configuration, or of a board's file, that is called so.
pub fn text(name: &str) -> String {
    let name = name.trim_matches(['[', ']']);
    let mut text = String::new();
    for (table, meaning) in TABLES.iter().filter(|(table, _)| *table == name) {
        let keys = KEYS.iter().filter(|key| key.tables.contains(table));
        let keys: Vec<&str> = keys.map(|key| key.name).collect();
        let head = head(table);
        let _ = writeln!(text, "table {head} of a configuration: {}", plain(meaning));
        let _ = writeln!(text, "  keys: {}", keys.join(", "));
    }
    for (keys, form) in [(KEYS, "a configuration"), (BOARD_KEYS, "a board's file")] {
        for key in keys.iter().filter(|key| is_meant(key, name)) {
            describe(&mut text, key, form);
        }
        for key in keys.iter().filter(|key| key.name != name) {
            let meant = key.choices().into_iter().filter(|c| c.word == name);
            for choice in meant.filter(|c| !c.meaning.is_empty()) {
                let meaning = plain(choice.meaning);
                let _ = writeln!(text, "word {name:?} of {} in {form}: {meaning}", key.path());
            }
        }
    }
    text
}

/// All that may be asked for.
pub fn names() -> Vec<String> {
    let keys = KEYS.iter().chain(BOARD_KEYS);
    let of_key = |key: &&Key| {
        let paths = key.tables.iter().map(|table| key.path_in(table));
        paths.chain([key.name.to_owned()]).collect::<Vec<_>>()
    };
    let tables = TABLES.iter().map(|(table, _)| (*table).to_owned());
    keys.flat_map(of_key).chain(tables).collect()
}

/// Whether a name is that of a key: alone, or behind one of its tables, with a number if that has several.
fn is_meant(key: &Key, name: &str) -> bool {
    let Some((table, own)) = name.rsplit_once('.') else {
        return name == key.name && key.names.is_none();
    };
    // Some keys are named after things, and in the table by what they are named after.
    let names = key.names.map(|names| names()).unwrap_or_default();
    let is_name = own.eq_ignore_ascii_case(key.name) || names.iter().any(|name| name == own);
    is_name && key.belongs_to(table)
}

fn describe(text: &mut String, key: &Key, form: &str) {
    let mut homes: Vec<String> = key.tables.iter().map(|table| head(table)).collect();
    if key.tables == [""] {
        homes = vec!["the top".into()];
    }
    let _ = writeln!(
        text,
        "key {} of {form}, in {}: {}",
        key.name,
        homes.join(" or "),
        plain(key.meaning)
    );
    let _ = writeln!(text, "  {}", plain(&key.may_be("")));
    if !key.note.is_empty() {
        let _ = writeln!(text, "  {}", plain(key.note));
    }
    let otherwise = match key.usual {
        Usual::Required(example) => format!("required, for example {} = {example}", key.name),
        _ => format!("default: {}", plain(&key.otherwise(""))),
    };
    let _ = writeln!(text, "  {otherwise}");
    let choices = key.choices();
    for choice in choices.iter().filter(|c| !c.meaning.is_empty()) {
        let _ = writeln!(text, "    {}: {}", choice.word, plain(choice.meaning));
    }
}
