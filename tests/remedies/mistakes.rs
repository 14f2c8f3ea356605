//! Mistakes that people make in a configuration: every key beyond its limits, of another type, misspelt, missing, in another table, of another
//! protocol; tables that are not there, or too often.

use super::document::Document;
use endat_config::asked::{Asked, Kind};
use endat_config::asked_of;
use endat_config::keys::{CHANNELS, KEYS, TABLES};
use std::collections::BTreeSet;

/// System clocks at which other limits count.
const SYSTEM_HZ: [u64; 7] = [
    1_000_000,
    7_000_000,
    12_000_000,
    33_333_333,
    48_000_000,
    100_000_000,
    250_000_000,
];

fn path(asked: &Asked) -> String {
    match asked.table.as_str() {
        "" => asked.key.into(),
        table => format!("{table}.{}", asked.key),
    }
}

/// The same with another value for a key.
fn with(base: &Document, path: &str, value: &str) -> Document {
    let mut document = base.clone();
    document.set(path, value);
    document
}

/// Values of a number, at its limits and on the way between them.
fn ladder(low: u64, high: u64) -> Vec<u64> {
    let mut all = vec![0, low.saturating_sub(1), low, low + 1, high, high + 1];
    let mut value = low.max(1);
    while value < high {
        all.push(value);
        value = value * 3 + 7;
    }
    all
}

/// An accepted value of a key.
fn values(asked: &Asked) -> Vec<String> {
    let quoted = |word: &String| match asked.kind {
        Kind::Integer(_) => word.clone(),
        _ => format!("{word:?}"),
    };
    let words: Vec<String> = asked.words.iter().map(quoted).collect();
    match &asked.kind {
        Kind::Integer(limits) => {
            let (low, high) = limits.range().into_inner();
            let high = high.min(1 << 40);
            let numbers = ladder(low, high).into_iter().map(|n| n.to_string());
            let others = ["-1", "1.5", "true", "\"12\"", "012", "99999999999999999999", "[]"];
            let units = ["3 MHz", "\"20 us\"", "5 m", "1 Mbit/s", "\"fast\""];
            let rest = others.into_iter().chain(units).map(str::to_owned);
            numbers.chain(rest).chain(words).collect()
        }
        Kind::Text => {
            let long = format!("{:?}", "x".repeat(50));
            let rest = ["\"bogus\"", "\"\"", "1", "000111", "\"a b\"", "\"module\"", "\"a__b\"", "\"../x\"", "\"a\u{200b}\"", "\"1a\""];
            let near = words.iter().filter(|w| w.len() > 5);
            let near: Vec<String> = near.map(|w| w.replacen(&w[2..4], &w[2..3], 1)).collect();
            let rest = rest.into_iter().map(str::to_owned).chain([long]);
            rest.chain(words).chain(near).collect()
        }
        Kind::Boolean => ["\"true\"", "1", "true", "false"].map(str::to_owned).into(),
        Kind::Texts => {
            let all = words.join(", ");
            let first = words.first().cloned().unwrap_or_default();
            let rest = [
                "[\"bogus\"]".into(),
                "[1]".into(),
                "\"bogus\"".into(),
                "[]".into(),
                format!("[{first}, {first}]"),
                format!("[{all}]"),
            ];
            let pairs = words.iter().map(|word| format!("[{first}, {word}]"));
            let alone = words.iter().map(|word| format!("[{word}]"));
            rest.into_iter().chain(alone).chain(pairs).collect()
        }
        Kind::Integers => [
            "[0x3F]",
            "[0x4F]",
            "[64, 64]",
            "[\"x\"]",
            "64",
            "[]",
            "[0x40, 0x41, 0x42, 0x43, 0x44, 0x45, 0x46, 0x47, 0x48, 0x49, 0x4A, 0x4B, 0x4C, 0x4D, 0x4E, 0x50, 0x51, 0x52]",
            "[-1]",
        ]
        .map(str::to_owned)
        .into(),
        Kind::Tables => vec!["5".into(), "[1]".into(), "\"x\"".into()],
    }
}

/// A value that a key may have, for keys that a base does not have.
pub fn example(name: &str) -> Option<String> {
    let key = KEYS.iter().find(|key| key.name == name)?;
    let word = key.words().into_iter().next();
    Some(match key.kind {
        endat_config::keys::Kind::Number => match key.usual_number() {
            0 => key.limits(None).range().start().to_string(),
            number => number.to_string(),
        },
        endat_config::keys::Kind::Text => format!("{:?}", word.unwrap_or("x".into())),
        endat_config::keys::Kind::Boolean => "true".into(),
        endat_config::keys::Kind::Texts => format!("[{:?}]", word?),
        endat_config::keys::Kind::Numbers => "[64]".into(),
    })
}

/// Every mistake in a base: all of them, or those with keys that have not been `seen`, at its own system clock.
pub fn all(base: &Document, seen: Option<&mut BTreeSet<String>>) -> Vec<Document> {
    let mut all = vec![];
    let is_quick = seen.is_some();
    let mut nothing = BTreeSet::new();
    let seen = seen.unwrap_or(&mut nothing);
    let (asked, complaints) = asked_of(&base.text());
    assert_eq!(complaints, [], "{}", base.text());
    let mut is_new = |asked: &&Asked| {
        let table = asked.table.split('[').next().unwrap_or_default();
        seen.insert(format!("{table}.{}", asked.key))
    };
    let keys = asked.iter().filter(|a| a.kind != Kind::Tables);
    let keys: Vec<&Asked> = keys.filter(|a| is_new(a)).collect();
    for key in &keys {
        let path = path(key);
        let mut values = values(key);
        if is_quick && values.len() > 12 {
            // Other ones of each key.
            let first = path.len();
            let kept = (0..12).map(|n| values[(first + 5 * n) % values.len()].clone());
            let ends = [1, 4, 5].map(|n| values[n].clone());
            values = kept.chain(ends).collect();
        }
        all.extend(values.iter().map(|value| with(base, &path, value)));
        let mut missing = base.clone();
        missing.remove(&path);
        all.push(missing);
        if let Some(value) = base.get(&path).or_else(|| example(key.key)) {
            // Misspelt, and in another table.
            let start = path.len() - key.key.len();
            let spelt = format!("{}x{}", &key.key[..1], &key.key[1..]);
            for name in [spelt, format!("{}s", key.key), "colour".into()] {
                let mut other = with(base, &path, &value);
                other.rename(&path, &name);
                all.push(other);
            }
            for table in ["", "clock.", "trigger.", "channel[0].", "host.", "stream."] {
                if is_quick && table.len() % 3 != path.len() % 3 {
                    continue;
                }
                if table != &path[..start] {
                    let mut other = base.clone();
                    other.remove(&path);
                    all.push(with(&other, &format!("{table}{}", key.key), &value));
                }
            }
        }
        // Beside another system clock, which a board would have to make.
        if let (Kind::Integer(limits), false) = (&key.kind, is_quick || base.has_table("board")) {
            let (low, high) = limits.range().into_inner();
            for hz in SYSTEM_HZ {
                let slower = with(base, "clock.system_hz", &hz.to_string());
                let numbers = ladder(low, high.min(1 << 40));
                all.extend(numbers.iter().map(|n| with(&slower, &path, &n.to_string())));
            }
        }
    }
    // Keys that this form has not.
    for key in KEYS {
        for table in key.tables {
            let table = match *table {
                CHANNELS => "channel[0]",
                table => table,
            };
            let path = match table {
                "" => key.name.to_owned(),
                table => format!("{table}.{}", key.name),
            };
            if let (None, Some(value)) = (base.get(&path), example(key.name)) {
                all.push(with(base, &path, &value));
            }
        }
    }
    for (table, _) in TABLES {
        let mut misspelt = base.clone();
        misspelt.rename(table, &format!("{table}s"));
        let mut without = base.clone();
        without.remove_table(table);
        let mut listed = base.clone();
        listed.bracket(table, if *table == CHANNELS { "[" } else { "[[" });
        all.extend([misspelt, without, listed]);
    }
    let mut doubled = base.clone();
    doubled.double("name");
    all.push(doubled);
    for count in [2, 3, 6, 9, 12] {
        let mut more = base.clone();
        more.repeat(CHANNELS, count);
        all.push(more);
    }
    all.push(with(base, "colour.x", "1"));
    all
}
