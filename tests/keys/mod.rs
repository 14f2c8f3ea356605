//! The table of keys: what the reader asks for, the pages, the schemas and `explain` are one, and JSON Schema's own validator says so.

mod validator;

use crate::bases::BASES;
use crate::program::{bad, good, run, Dir};
use crate::tools;
use endat_campaign::configurations::valid;
use endat_config::board::{self, BOARD_KEYS};
use endat_config::keys::{self, Key, Kind, Usual, CHANNELS, KEYS};
use endat_config::{asked_of, parse_any};
use std::collections::BTreeSet;
use std::path::Path;
use toml::{Table, Value};

fn bases() -> Vec<Table> {
    BASES.map(|text| text.parse().unwrap()).into()
}

/// A table of a document; of those in double brackets the first one.
fn table_of<'t>(document: &'t mut Table, name: &str) -> Option<&'t mut Table> {
    match name {
        "" => Some(document),
        CHANNELS => document.get_mut(name)?.as_array_mut()?[0].as_table_mut(),
        // The first of tables with names of their own.
        name if name.ends_with(".NAME") => {
            let all = table_of(document, name.trim_end_matches(".NAME"))?;
            all.iter_mut().next()?.1.as_table_mut()
        }
        name => document.get_mut(name)?.as_table_mut(),
    }
}

/// A base that has the key, and the table that it stands in.
fn base_of(key: &Key) -> (Table, &'static str) {
    for base in bases() {
        for table in key.tables {
            let mut document = base.clone();
            let found = table_of(&mut document, table);
            // No board stands in two ways at once, and pins have names of their own.
            let stands = |t: &Table| t.contains_key(key.name) || key.names.is_some();
            let is_file = key.path() == "board.file";
            if found.is_some_and(|t| stands(t) || is_file && t.contains_key("name")) {
                return (base, table);
            }
        }
    }
    panic!("{}: no base has it", key.path());
}

/// What is wrong with a text; nothing if it is good.
fn told(text: &str) -> Vec<String> {
    let complaints = parse_any("card.toml", text).err().unwrap_or_default();
    complaints.into_iter().map(|c| c.text).collect()
}

/// Catches a key that the table has and the reader does not ask for, and one that it asks for elsewhere.
#[test]
fn the_reader_asks_for_the_keys_of_the_table_and_for_no_other() {
    let all = KEYS.iter().filter(|key| key.names.is_none());
    let wanted: BTreeSet<String> = all
        .flat_map(|key| key.tables.iter().map(|t| key.path_in(t)))
        .collect();
    let mut found = BTreeSet::new();
    let with_file = format!(
        "{}file = \"nothing.toml\"\n",
        BASES[0].split("name = \"papilio").next().unwrap()
    );
    let bases = BASES.iter().map(|text| (*text).to_owned());
    for text in bases.chain([with_file]).chain((0..40).filter_map(valid)) {
        for asked in asked_of(&text).0 {
            let table = asked.table.split('[').next().unwrap();
            let dot = if table.is_empty() { "" } else { "." };
            found.insert(format!("{table}{dot}{}", asked.key));
        }
    }
    // The tables themselves.
    found.remove(CHANNELS);
    assert_eq!(found, wanted);
    let tables: BTreeSet<&str> = keys::TABLES.iter().map(|(name, _)| *name).collect();
    let of_keys = KEYS.iter().flat_map(|key| key.tables).copied();
    assert_eq!(tables, of_keys.filter(|t| !t.is_empty()).collect());
}

/// A page in which the tables behind such a line are written from the table of keys.
const MARK: &str =
    "<!-- From the table of keys: UPDATE_EXPECT=1 cargo test --test configuration keys writes it. -->\n";

#[test]
fn the_tables_of_the_pages_are_those_of_the_keys() {
    for (page, tables) in [
        ("docs/configuration.md", keys::page()),
        ("docs/boards.md", vec![board::page()]),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(page);
        let text = std::fs::read_to_string(&path).unwrap();
        let mut parts = text.split(MARK);
        let mut now = parts.next().unwrap().to_owned();
        let parts: Vec<&str> = parts.collect();
        assert_eq!(parts.len(), tables.len(), "{page}: {MARK}");
        for (part, table) in parts.iter().zip(&tables) {
            let behind = part.find("\n\n").map_or("", |at| &part[at + 1..]);
            now += &format!("{MARK}{table}{behind}");
        }
        tools::assert_committed(&path, &now);
        for (at, cell) in now.match_indices("](#") {
            let anchor = cell.len() + at;
            let anchor = now[anchor..].split(')').next().unwrap();
            let is_it = |line: &str| {
                let head = line.trim_start_matches(['#', ' ']).to_lowercase();
                head.replace(' ', "-") == anchor
            };
            assert!(
                now.lines().filter(|l| l.starts_with('#')).any(is_it),
                "{page}: #{anchor}"
            );
        }
    }
}

#[test]
fn the_committed_schemas_are_what_the_command_prints() {
    let dir = Dir::new("schemas");
    for form in ["card", "board"] {
        let now = good(&["schema", form]);
        let name = format!("docs/endat-{form}.schema.json");
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(&name);
        tools::assert_committed(&path, &now);
        let file = dir.path(form);
        run(&["schema", form, "--out", &file]);
        assert_eq!(std::fs::read_to_string(&file).unwrap(), now);
        // Once more: it is ours.
        assert_eq!(run(&["schema", form, "--out", &file]).exit_code, 0);
    }
    let other = dir.write("other", b"{}");
    assert!(bad(&["schema", "--out", &other], 2).contains("holds something else"));
    assert_eq!(good(&["schema"]), good(&["schema", "card"]));
}

/// Catches a default that the table tells and the reader does not take: with it in the file, and without the key, it is the same card.
#[test]
fn a_default_in_the_file_changes_nothing() {
    let mut count = 0;
    for key in KEYS {
        let value = match key.usual {
            Usual::Number(number) => Value::from(number as i64),
            Usual::Word(word) => Value::from(word),
            Usual::Boolean(is) => Value::from(is),
            Usual::Empty => Value::Array(vec![]),
            Usual::All => Value::from(key.words()),
            Usual::Required(_) | Usual::Follows(_) => continue,
        };
        // The first base in which the key may be left out.
        let (own, table) = base_of(key);
        let is_same = std::iter::once(own).chain(bases()).find_map(|mut base| {
            table_of(&mut base, table)?.remove(key.name);
            let without = parse_any("card.toml", &base.to_string()).ok()?;
            table_of(&mut base, table)?.insert(key.name.into(), value.clone());
            let with = parse_any("card.toml", &base.to_string());
            Some(with.as_ref().is_ok_and(|with| *with == without))
        });
        assert_eq!(is_same, Some(true), "{}", key.path());
        count += 1;
    }
    assert!(count > 25, "{count}");
}

/// Catches limits that nothing checks: every number is within some, or one of a few.
#[test]
fn every_number_has_limits_and_every_key_a_meaning() {
    for key in KEYS.iter().chain(BOARD_KEYS) {
        assert!(
            !key.meaning.is_empty() && !key.meaning.ends_with('.'),
            "{}",
            key.path()
        );
        if key.kind == Kind::Number {
            assert!(*key.limits(None).range().end() < u64::MAX, "{}", key.path());
        }
        for choice in key.choices().iter().filter(|_| key.kind == Kind::Number) {
            let number: u64 = choice.word.parse().unwrap();
            assert!(key.limits(None).contains(number), "{} {number}", key.path());
        }
    }
}

#[test]
fn keys_tables_and_words_are_explained() {
    for key in KEYS.iter().chain(BOARD_KEYS) {
        for table in key.tables {
            let text = good(&["explain", &key.path_in(table)]);
            assert!(text.contains(&format!("key {} of ", key.name)), "{text}");
        }
    }
    let clock = good(&["explain", "endat.clock_hz"]);
    for words in [
        "in [endat] or [[channel]]: clock on the line",
        "80 kHz to 16 MHz",
        "below 100 kHz with SSI only",
        "required, for example clock_hz = 3_125_000",
    ] {
        assert!(clock.contains(words), "{clock}");
    }
    assert_eq!(clock, good(&["explain", "channel[0].clock_hz"]));
    let test = good(&["explain", "error_test_ms"]);
    assert!(
        test.contains("10 to 32000 ms; takes \"error_test\" in safety.parts")
            && test.contains("default: 1000 ms"),
        "{test}"
    );
    let safety = good(&["explain", "safety"]);
    assert!(
        safety.contains("table [safety] of a configuration")
            && safety.contains("keys: parts, error_test_ms"),
        "{safety}"
    );
    assert!(
        good(&["explain", "tracked"]).contains("word \"tracked\" of line.phase in a configuration")
    );
    for (typed, meant) in [
        ("clok_hz", "did you mean clock_hz?"),
        ("endat.fliter_ns", "did you mean endat.filter_ns?"),
        ("saftey", "did you mean safety?"),
        ("crx", "did you mean crc?"),
    ] {
        let told = bad(&["explain", typed], 2);
        assert!(told.contains(meant), "{told}");
    }
    // Links of the pages are paths here, and nothing is marked.
    let parts = good(&["explain", "line.parts"]);
    assert!(
        parts.contains("(docs/margin.md)") && !parts.contains('`'),
        "{parts}"
    );
}
