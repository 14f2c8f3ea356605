//! What a message advises, as documents in which it has been done.

use super::document::Document;
use super::mistakes::example;
use endat_config::keys::{CHANNELS, KEYS};
use endat_console::error::Diagnostic;

/// A remedy, done.
pub struct Done {
    /// Which form of words it had.
    pub form: &'static str,
    /// Whether each of the documents must do, or one of them.
    pub must_each: bool,
    /// The document as it would be then.
    pub documents: Vec<Document>,
}

/// Words with which another remedy begins.
const VERBS: &[&str] = &[
    "use",
    "leave",
    "lower",
    "raise",
    "shorten",
    "add",
    "write",
    "remove",
    "choose",
    "set",
    "another",
    "a faster",
    "a slower",
    "ask",
    "put",
    "did",
    "give",
    "call",
    "move",
    "line.parts",
    "stream.additional_data =",
    "start =",
];

/// Remedies that nobody but a person can follow.
const PROSE: &[&str] = &[
    "correct the line",
    "give a board's TOML file",
    "`endat-gen boards --show NAME` prints one to start from",
];

/// A message, taken apart: key or table, value, problem and remedy.
struct Message<'d> {
    document: &'d Document,
    /// Key with its table.
    path: String,
    /// Its value as the message shows it.
    value: String,
    problem: String,
    remedy: String,
}

/// The path at the line, of messages that do not name it.
fn path_of_line(document: &Document, line: usize) -> String {
    document.path_of_line(line)
}

/// Splits a message into what is wrong and what to do.
fn message<'d>(document: &'d Document, diagnostic: &Diagnostic) -> Message<'d> {
    let text = &diagnostic.text;
    let (subject, rest) = text.split_once(": ").unwrap_or(("", text));
    let (path, value) = subject.split_once(" = ").unwrap_or((subject, ""));
    let path = match path {
        "not TOML" => path_of_line(document, diagnostic.line),
        path => path.to_owned(),
    };
    let typed = rest
        .split_once(", must be ")
        .map(|(problem, wanted)| (problem, format!("must be {wanted}")));
    let (problem, remedy) = match rest.rsplit_once("; ") {
        Some((problem, remedy)) => (problem, remedy.to_owned()),
        None => typed.unwrap_or((rest, String::new())),
    };
    Message {
        document,
        path,
        value: value.into(),
        problem: problem.into(),
        remedy,
    }
}

/// The single remedies in a text.
fn alternatives(remedy: &str) -> Vec<String> {
    let mut all = vec![];
    let shorter = [
        ", or make the frame shorter: ",
        ", or make the exchange shorter: ",
    ];
    // Each of these helps a little.
    let mut rest = shorter
        .iter()
        .find_map(|words| remedy.split_once(words))
        .map_or(remedy, |(rest, _)| rest);
    'next: while !rest.is_empty() {
        for (at, _) in rest.match_indices([',', ' ']) {
            for joint in [", or ", ", ", " or "] {
                let Some(tail) = rest[at..].strip_prefix(joint) else {
                    continue;
                };
                let begins = |verb: &&str| {
                    tail.strip_prefix(*verb)
                        .is_some_and(|t| t.is_empty() || t.starts_with(' '))
                };
                if VERBS.iter().any(begins) {
                    all.push(rest[..at].to_owned());
                    rest = tail;
                    continue 'next;
                }
            }
        }
        all.push(rest.to_owned());
        break;
    }
    all
}

/// Without what is said of a remedy besides.
fn bare(remedy: &str) -> &str {
    let mut bare = remedy;
    for more in [
        ", if ",
        " if ",
        ", which ",
        ", as there",
        ", and instantiate",
        ", the host reads",
        " (SSI has",
        " (T-format has",
        ", and give the folder",
        ", and the word ",
    ] {
        bare = bare.split(more).next().unwrap_or_default();
    }
    bare.trim()
}

fn numbers(text: &str) -> Vec<u64> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    words.filter_map(number).collect()
}

fn number(word: &str) -> Option<u64> {
    match word.strip_prefix("0x") {
        Some(digits) => u64::from_str_radix(digits, 16).ok(),
        None => word.replace('_', "").parse().ok(),
    }
}

/// Words of a list such as `"a" (what it is), b or c`.
fn words(text: &str) -> Vec<String> {
    let mut plain = String::new();
    let mut depth = 0;
    for c in text.chars() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            c if depth == 0 => plain.push(c),
            _ => {}
        }
    }
    let plain = plain.replace(" or ", ", ").replace(" and ", ", ");
    let all = plain
        .split(',')
        .map(|w| w.trim().trim_matches('"').to_owned());
    all.filter(|w| !w.is_empty()).collect()
}

impl Message<'_> {
    fn table(&self) -> &str {
        self.path.rsplit_once('.').map_or("", |(table, _)| table)
    }

    fn is_list(&self) -> bool {
        self.document
            .get(&self.path)
            .is_some_and(|v| v.starts_with('['))
    }

    /// The document with another value.
    fn with(&self, path: &str, value: &str) -> Document {
        let mut document = self.document.clone();
        document.set(path, value);
        document
    }

    /// Items of a list as they are written.
    fn items(&self, path: &str) -> Vec<String> {
        let list = self.document.get(path).unwrap_or_default();
        let items = list
            .trim_matches(['[', ']'])
            .split(',')
            .map(|i| i.trim().to_owned());
        items.filter(|i| !i.is_empty()).collect()
    }

    fn with_items(&self, path: &str, items: &[String]) -> Document {
        self.with(path, &format!("[{}]", items.join(", ")))
    }

    /// Another value in the place of the one that is wrong, in quotes where that has some.
    fn instead(&self, word: &str) -> Document {
        let is_text = KEYS.iter().any(|k| {
            k.name == self.path.rsplit('.').next().unwrap_or_default()
                && !matches!(
                    k.kind,
                    endat_config::keys::Kind::Number | endat_config::keys::Kind::Numbers
                )
        });
        let is_pin = self.table() == "pins";
        let written = match is_text || is_pin {
            true => format!("{word:?}"),
            false => word.to_owned(),
        };
        if !self.is_list() {
            return self.with(&self.path, &written);
        }
        let same = |item: &String| {
            *item == self.value || number(item).is_some() && number(item) == number(&self.value)
        };
        let items: Vec<String> = self
            .items(&self.path)
            .into_iter()
            .map(|item| if same(&item) { written.clone() } else { item })
            .collect();
        self.with_items(&self.path, &items)
    }

    /// Without the value: an item of a list, or the key.
    fn without(&self) -> Document {
        let mut document = self.document.clone();
        // The list, or one of its items.
        if !self.is_list() || self.value.is_empty() || self.value.starts_with('[') {
            document.remove(&self.path);
            return document;
        }
        let same = |item: &String| {
            *item == self.value || number(item).is_some() && number(item) == number(&self.value)
        };
        let mut items = self.items(&self.path);
        if let Some(at) = items.iter().rposition(same) {
            items.remove(at);
        }
        self.with_items(&self.path, &items)
    }

    /// With one of the items of a list called ignored, in turn.
    fn each_ignored(&self) -> Vec<Document> {
        let items = self.items(&self.path);
        let with = |n: usize| {
            let mut items = items.clone();
            let bits = if items[n] == "\"crc6\"" { 6 } else { 1 };
            let ignored = vec!["\"ignored\"".to_owned(); bits];
            items.splice(n..=n, ignored);
            self.with_items(&self.path, &items)
        };
        (0..items.len()).map(with).collect()
    }

    /// The path of a key that a remedy names, in the file or as it would be.
    fn place(&self, name: &str) -> String {
        if name == "it" {
            return self.path.clone();
        }
        if name.contains('.') {
            return name.to_owned();
        }
        // The one whose value the message shows.
        let shown = self.problem.split_once(&format!("{name} = "));
        let shown = shown.and_then(|(_, rest)| numbers(rest).first().copied());
        let tables = (0..8)
            .map(|n| format!("{CHANNELS}[{n}]"))
            .chain(["endat".into()]);
        let mut places = tables.map(|table| format!("{table}.{name}"));
        let is_it = |path: &String| {
            let written = self.document.get(path).and_then(|v| number(&v));
            written.is_some() && written == shown
        };
        if let Some(path) = places.find(is_it) {
            return path;
        }
        let channel = self
            .problem
            .split_once("channel ")
            .and_then(|(_, rest)| numbers(rest).first().copied());
        let own = match self.table().strip_prefix(CHANNELS) {
            Some(_) => self.table().to_owned(),
            None => format!("{CHANNELS}[{}]", channel.unwrap_or(0)),
        };
        let known = |table: &str| {
            let table = table.split('[').next().unwrap_or_default();
            KEYS.iter()
                .any(|k| k.name == name && k.tables.contains(&table))
        };
        if !self.table().is_empty() && known(self.table()) && !self.table().starts_with(CHANNELS) {
            return format!("{}.{name}", self.table());
        }
        let in_common = format!("endat.{name}");
        let in_own = format!("{own}.{name}");
        match self.document.get(&in_own).is_none() && self.document.get(&in_common).is_some() {
            true => in_common,
            false => in_own,
        }
    }

    /// The number that counts for a key.
    fn current(&self, path: &str) -> u64 {
        let name = path.rsplit('.').next().unwrap_or_default();
        let written = self.document.get(path).and_then(|v| number(&v));
        let key = KEYS.iter().find(|k| k.name == name);
        written.or(key.map(|k| k.usual_number())).unwrap_or(0)
    }

    /// Numbers below or above the one that counts, further and further away.
    fn search(&self, name: &str, up: bool) -> Vec<Document> {
        let path = self.place(name);
        let mut value = self.current(&path);
        let mut all = vec![];
        for _ in 0..60 {
            value = match up {
                true => value + value / 4 + 1,
                false => value - value.div_ceil(5),
            };
            all.push(self.with(&path, &value.to_string()));
            if value == 0 {
                break;
            }
        }
        all
    }

    /// Other values for another key, as one that looks for it tries them.
    fn try_all<T: ToString>(
        &self,
        path: &str,
        values: impl IntoIterator<Item = T>,
    ) -> Vec<Document> {
        values
            .into_iter()
            .map(|v| self.with(path, &v.to_string()))
            .collect()
    }

    fn system_clocks(&self) -> Vec<Document> {
        let all = (1..=250).map(|mhz: u64| mhz * 1_000_000);
        self.try_all("clock.system_hz", all)
    }

    /// Does what a remedy says; nothing if no form of words fits.
    fn done(&self, remedy: &str) -> Option<Done> {
        let each = |form, documents: Vec<Document>| {
            Some(Done {
                form,
                must_each: true,
                documents,
            })
        };
        let one = |form, documents: Vec<Document>| {
            Some(Done {
                form,
                must_each: false,
                documents,
            })
        };
        let range = |text: &str| -> Option<Vec<u64>> {
            let (low, high) = text.split_once("..")?;
            let low = low.rsplit([' ', '(']).next().and_then(number)?;
            let high = high.split([' ', ';', ',']).next().and_then(number)?;
            Some(vec![low, high])
        };
        let text = bare(remedy);
        let set = |path: &str, value: u64| self.with(path, &value.to_string());
        match text {
            "choose a value in that range" => {
                let mut all = range(&self.problem)?;
                if self.problem.contains("neither 0") {
                    all.push(0);
                }
                return each(
                    "choose a value in that range",
                    self.try_all(&self.path, all),
                );
            }
            "leave it out"
            | "remove it"
            | "remove the key"
            | "leave one of them out"
            | "remove one of the two"
            | "remove one"
            | "leave some out" => {
                if let Some((_, bad)) = self.problem.split_once("has the character '") {
                    let bad = bad.split('\'').next().unwrap_or_default();
                    let value = self.document.get(&self.path)?;
                    let clean = value.replace(bad, "").replace('\u{200b}', "");
                    return each("remove a character", vec![self.with(&self.path, &clean)]);
                }
                if self.problem.contains("underscore") {
                    let value = self.document.get(&self.path)?;
                    return each(
                        "remove a character",
                        vec![self.with(&self.path, &value.replace("__", "_").replace("_\"", "\""))],
                    );
                }
                if self.path.starts_with('[') {
                    return self.done("remove the table");
                }
                return each("leave it out", vec![self.without()]);
            }
            "remove the table" => {
                let mut document = self.document.clone();
                document.remove_table(self.path.trim_matches(['[', ']']));
                return each("remove the table", vec![document]);
            }
            "leave the list empty" => {
                return each("leave the list empty", vec![self.with(&self.path, "[]")])
            }
            "leave the last ones out" => {
                let items = self.items(&self.path);
                let fewer = (0..items.len()).rev();
                let fewer = fewer.map(|n| self.with_items(&self.path, &items[..n]));
                return one("leave the last ones out", fewer.collect());
            }
            "call it \"ignored\""
            | "call the first of them \"ignored\""
            | "call its six bits \"ignored\""
            | "call the six bits of the first one \"ignored\"" => {
                return one("call it ignored", self.each_ignored());
            }
            "move it to bits_after" => {
                let bad = format!("\"{}\"", self.problem.split('"').nth(1)?);
                let items = self.items(&self.path).into_iter().filter(|i| *i != bad);
                let mut document = self.with_items(&self.path, &items.collect::<Vec<_>>());
                document.set(&self.place("bits_after"), &format!("[{bad}]"));
                return each("move it", vec![document]);
            }
            "lower it" => return one("lower it", self.search("it", false)),
            "shorten it" => {
                let most = numbers(&self.problem).last().copied()?;
                let value: String = self
                    .value
                    .trim_matches('"')
                    .chars()
                    .take(most as usize)
                    .collect();
                return each(
                    "shorten it",
                    vec![self.with(&self.path, &format!("{value:?}"))],
                );
            }
            "use letters, digits and underscores, a letter first"
            | "use letters, digits and underscores"
            | "a letter first" => {
                return each("use letters", vec![self.with(&self.path, "\"card_1\"")]);
            }
            "use a faster system clock"
            | "a faster system clock"
            | "a slower system clock"
            | "another system clock" => {
                return one("another system clock", self.system_clocks());
            }
            "use another rate" => {
                return one(
                    "use another rate",
                    (1..160).map(|n| set(&self.path, n * 100_000)).collect(),
                );
            }
            "choose another bus" | "choose another host.bus" | "another host.bus" => {
                let buses = ["uart", "apb", "spi", "parallel", "none"].map(|b| format!("{b:?}"));
                return one("choose another bus", self.try_all("host.bus", buses));
            }
            "add [board]" => {
                return each(
                    "add a table",
                    vec![self.with("board.name", "\"papilio_pro\"")],
                )
            }
            "write one [[channel]] table for each" => {
                let mut document = self.document.clone();
                match self.value.starts_with('0') {
                    true => {
                        document.set("channel.position_bits", "25");
                        document.set("channel[0].command", "\"111000\"");
                        document.set("channel[0].clock_hz", "2_000_000");
                    }
                    false => document.keep(CHANNELS, 8),
                }
                return each("write one table for each", vec![document]);
            }
            "write one table" => {
                let mut document = self.document.clone();
                document.keep(CHANNELS, 1);
                return each("write one table", vec![document]);
            }
            "write [[channel]]" | "write [[channel]], one for each" => {
                let mut document = self.document.clone();
                document.bracket(CHANNELS, "[[");
                return each("write [[channel]]", vec![document]);
            }
            "write the delay that `margin` shows on this cable" => {
                return each(
                    "write what a command shows",
                    vec![set("line.fixed_delay_ns", 400)],
                );
            }
            _ => {}
        }
        if let Some(name) = text
            .strip_prefix("did you mean ")
            .and_then(|t| t.strip_suffix('?'))
        {
            let mut document = self.document.clone();
            document.rename(&self.path, name);
            return each("did you mean", vec![document]);
        }
        if let Some(homes) = text.strip_prefix("it belongs ") {
            let key = self.path.rsplit('.').next().unwrap_or_default();
            let value = self.document.get(&self.path)?;
            let moved = homes.split("to ").filter_map(|home| {
                let home = home.split(" or ").next().unwrap_or_default().trim();
                let table = match home {
                    "" => return None,
                    "the top of the file, above all tables" => "".to_owned(),
                    "[[channel]]" => "channel[0].".into(),
                    home => format!("{}.", home.trim_matches(['[', ']'])),
                };
                let mut document = self.document.clone();
                document.remove(&self.path);
                document.set(&format!("{table}{key}"), &value);
                Some(document)
            });
            // `to the top of the file` has that word twice.
            return each("it belongs to", moved.collect());
        }
        if let Some(known) = text.strip_prefix("known keys here: ") {
            let dot = if self.table().is_empty() { "" } else { "." };
            let is_free = |key: &&str| {
                let path = format!("{}{dot}{key}", self.table());
                let is_table = self.table().is_empty() && self.document.has_table(key);
                self.document.get(&path).is_none() && !is_table
            };
            let mut all: Vec<Document> = known
                .split(", ")
                .filter(is_free)
                .map(|key| {
                    let mut document = self.document.clone();
                    document.rename(&self.path, key);
                    document
                })
                .collect();
            let mut without = self.document.clone();
            match self.document.get(&self.path) {
                Some(_) => without.remove(&self.path),
                None => without.remove_table(&self.path),
            }
            all.insert(0, without);
            return each("known keys here", all);
        }
        if let Some(signals) = text
            .strip_prefix("signals: ")
            .or(text.strip_prefix("known signals: "))
        {
            let all = signals.split(", ").map(|signal| {
                let mut document = self.document.clone();
                document.rename(&self.path, signal);
                document
            });
            return each("signals", all.collect());
        }
        if let Some(wanted) = text.strip_prefix("must be ") {
            let key = self.path.rsplit('.').next().unwrap_or_default();
            if let Some(table) = wanted.strip_prefix("a table headed ") {
                let mut document = self.document.clone();
                document.bracket(table.trim_matches(['[', ']']), "[");
                return each("must be a table", vec![document]);
            }
            if wanted.starts_with("tables headed") {
                let mut document = self.document.clone();
                document.remove(&self.path);
                return each("must be a table", vec![document]);
            }
            return one(
                "must be of a type",
                vec![self.with(&self.path, &example(key)?)],
            );
        }
        if let Some(assignment) = text
            .strip_prefix("leave the first 0 out: ")
            .or(text.strip_prefix("put it in quotes: "))
        {
            let (_, value) = assignment.split_once(" = ")?;
            return each("write the line so", vec![self.with(&self.path, value)]);
        }
        if text.ends_with(" is there already, remove this one") {
            return each("leave it out", vec![self.without()]);
        }
        if let Some(kept) = text.strip_prefix("keep ").and_then(|t| t.split(',').next()) {
            let items = self.items(&self.path).into_iter().take(kept.parse().ok()?);
            return each(
                "leave that out",
                vec![self.with_items(&self.path, &items.collect::<Vec<_>>())],
            );
        }
        if let Some(boards) = text.strip_prefix("known boards: ") {
            return each(
                "use one of",
                words(boards).iter().map(|w| self.instead(w)).collect(),
            );
        }
        if let Some(list) = text
            .strip_prefix("leave ")
            .and_then(|t| t.strip_suffix(" out"))
        {
            let mut document = self.document.clone();
            match list {
                list if list.starts_with('[') => {
                    document.remove_table(list.trim_matches(['[', ']']))
                }
                list if list.starts_with('"') => {
                    let items: Vec<String> = self
                        .items(&self.path)
                        .into_iter()
                        .filter(|i| i != list)
                        .collect();
                    document = self.with_items(&self.path, &items);
                }
                key => document.remove(&self.place(key)),
            }
            return each("leave that out", vec![document]);
        }
        if let Some((part, path)) = text
            .strip_prefix("leave ")
            .and_then(|t| t.split_once(" out of "))
        {
            let items: Vec<String> = self.items(path).into_iter().filter(|i| i != part).collect();
            return each("leave that out", vec![self.with_items(path, &items)]);
        }
        let added = text
            .strip_prefix("add")
            .filter(|rest| rest.starts_with([' ', ',']));
        if let Some(rest) = added.map(|rest| rest.trim_start_matches(", for example,").trim_start())
        {
            let part = |part: &str, path: &str| {
                let mut items = self.items(path);
                items.push(part.to_owned());
                self.with_items(path, &items)
            };
            if let Some((word, path)) = rest
                .split_once(" to ")
                .filter(|(_, path)| path.ends_with(".parts"))
            {
                let named = self.problem.rsplit("part ").next().unwrap_or_default();
                let word = if word == "it" {
                    format!("{named:?}")
                } else {
                    word.to_owned()
                };
                return each("add a part", vec![part(&word, path)]);
            }
            if rest.starts_with('"') {
                return each("add a part", vec![part(rest, &self.path)]);
            }
            if rest.starts_with("a suffix") {
                return each(
                    "add a suffix",
                    vec![self.with(
                        &self.path,
                        &format!("\"{}_card\"", self.value.trim_matches('"')),
                    )],
                );
            }
            if rest.starts_with("one table with ") {
                let mut document = self.document.clone();
                document.set("channel.protocol", "\"t_format\"");
                return each("add a table", vec![document]);
            }
            let quoted = rest.split('`').nth(1);
            let assignment = quoted.unwrap_or(rest);
            let (key, value) = assignment.split_once(" = ")?;
            let dot = if self.table().is_empty() { "" } else { "." };
            let mut all = vec![self.with(&format!("{}{dot}{key}", self.table()), value)];
            if rest.ends_with("or in [endat]") {
                all.push(self.with(&format!("endat.{key}"), value));
            }
            return each("add a key", all);
        }
        let text = text.strip_prefix("set ").unwrap_or(text);
        let text = text.strip_prefix("write ").unwrap_or(text);
        if let Some((key, value)) = text.split_once(" = ").filter(|(key, _)| {
            key.chars()
                .all(|c| c.is_ascii_lowercase() || c == '_' || c == '.')
        }) {
            let path = match key {
                key if self.path.ends_with(key) => self.path.clone(),
                key if key.contains('.') => key.to_owned(),
                key => format!("{}.{key}", self.table()),
            };
            return each("write a key", vec![self.with(&path, value)]);
        }
        if let Some((key, value)) = text
            .split_once(" to ")
            .filter(|(key, _)| !key.contains(' '))
        {
            return each(
                "set a key",
                vec![set(&self.place(key), numbers(value).first().copied()?)],
            );
        }
        for (verb, up) in [("lower ", false), ("raise ", true), ("shorten ", false)] {
            let Some(rest) = text.strip_prefix(verb) else {
                continue;
            };
            if let Some((keys, value)) = rest.split_once(" to ") {
                let value = numbers(value).first().copied()?;
                let mut document = self.document.clone();
                for key in keys.split(" and ") {
                    document.set(&self.place(key), &value.to_string());
                }
                return each("to a number", vec![document]);
            }
            let keys: Vec<&str> = rest
                .split(" and ")
                .map(|k| {
                    k.split(" = ")
                        .next()
                        .unwrap_or_default()
                        .split(' ')
                        .next()
                        .unwrap_or_default()
                })
                .collect();
            let keys: Vec<&str> = match rest {
                "cable or filter" => vec!["cable_m", "filter_ns"],
                _ => keys,
            };
            let found: Vec<Vec<Document>> = keys.iter().map(|key| self.search(key, up)).collect();
            // All of them together, step by step.
            let steps = found.iter().map(Vec::len).max().unwrap_or(0);
            let together = (0..steps).map(|n| {
                let mut document = self.document.clone();
                for (key, all) in keys.iter().zip(&found) {
                    let path = self.place(key);
                    let value = all.get(n).or(all.last()).and_then(|d| d.get(&path));
                    document.set(&path, &value.unwrap_or_default());
                }
                document
            });
            let together = together.collect();
            return one("without a number", [found.concat(), together].concat());
        }
        if let Some(rest) = text.strip_prefix("ask for less with request = ") {
            let _ = rest;
            return one("without a number", vec![set(&self.place("request"), 0)]);
        }
        if let Some(rest) = text.strip_prefix("use ") {
            if rest.contains("system clock of ")
                || rest.contains("for clock.system_hz, for example")
            {
                let all = match rest.split_once("example ") {
                    Some((_, example)) => numbers(example),
                    None => numbers(rest),
                };
                return each("use a system clock", self.try_all("clock.system_hz", all));
            }
            if rest.contains("MRS codes") {
                return each(
                    "use codes",
                    numbers(&rest.replace("..", " "))
                        .iter()
                        .map(|n| self.instead(&n.to_string()))
                        .collect(),
                );
            }
            if let Some((_, place)) = rest.split_once("for one of the two, for example ") {
                return each("use another pin", vec![self.instead(place)]);
            }
            if let Some(all) = range(rest).filter(|_| rest.ends_with(" ns")) {
                return each("use a range", self.try_all(&self.path, all));
            }
            if rest.contains("..") {
                let ends = rest.split(", ").flat_map(|range| range.split(".."));
                return each(
                    "use a place",
                    ends.map(|place| self.instead(place)).collect(),
                );
            }
            let plain = rest
                .trim_start_matches("at most ")
                .trim_start_matches("at least ")
                .trim_start_matches("one of ");
            let plain = plain
                .trim_end_matches(" or less")
                .trim_end_matches(" ns")
                .trim_end_matches(" Hz")
                .trim_end_matches(" bit/s");
            let words = words(plain);
            let is_word = |w: &String| {
                !w.is_empty()
                    && w.chars()
                        .all(|c| c.is_ascii_alphanumeric() || "_-".contains(c))
            };
            if !words.is_empty() && words.iter().all(is_word) {
                return each(
                    "use one of",
                    words.iter().map(|w| self.instead(w)).collect(),
                );
            }
        }
        None
    }
}

/// Everything that a message advises; `Err` has a remedy that is in no form of words.
pub fn remedies(document: &Document, diagnostic: &Diagnostic) -> Result<Vec<Done>, String> {
    let message = message(document, diagnostic);
    if message.remedy.is_empty() {
        return Err(format!("no remedy: {}", diagnostic.text));
    }
    if PROSE.contains(&message.remedy.as_str()) {
        return Ok(vec![]);
    }
    let is_one = [" is there already, remove this one", ", leave the rest out"];
    if is_one.iter().any(|end| message.remedy.ends_with(end)) {
        let done = message.done(&message.remedy);
        return done
            .map(|done| vec![done])
            .ok_or_else(|| diagnostic.text.clone());
    }
    if message.remedy.ends_with(" stands twice, remove one") {
        let mut once = document.clone();
        once.dedup(&message.path);
        return Ok(vec![Done {
            form: "remove one",
            must_each: true,
            documents: vec![once],
        }]);
    }
    alternatives(&message.remedy)
        .iter()
        .map(|one| {
            message
                .done(one)
                .ok_or_else(|| format!("{one:?} of {:?}", diagnostic.text))
        })
        .collect()
}
