//! Reads TOML tables key by key and collects every complaint with its line.
//!
//! `serde` stops at the first problem; a configuration is a form, and a form is checked as a whole.

use super::asked::{Asked, Kind};
use super::key::Key;
use super::quantity;
use endat_console::error::{shorten, Diagnostic};
use endat_hdl::config::Limits;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt::Display;
use std::ops::Range;
use toml::de::{DeTable, DeValue};
use toml::Spanned;

/// The text of one file, and the complaints about it.
pub struct Source<'t> {
    /// File as the user named it.
    pub file: &'t str,
    text: &'t str,
    pub(super) diagnostics: RefCell<Vec<Diagnostic>>,
    pub(super) asked: RefCell<Vec<Asked>>,
    pub(super) strays: RefCell<Vec<Stray>>,
}

/// A key that its table has not.
pub(super) struct Stray {
    pub(super) line: usize,
    pub(super) key: String,
    /// With its table.
    pub(super) name: String,
    /// Keys that its table may have.
    pub(super) known: Vec<&'static str>,
    /// The other keys in that table.
    pub(super) written: Vec<String>,
    /// It is the heading of a table.
    pub(super) is_table: bool,
}

impl<'t> Source<'t> {
    /// A file that has nothing wrong yet.
    pub fn new(file: &'t str, text: &'t str) -> Self {
        Self {
            file,
            text,
            diagnostics: RefCell::default(),
            asked: RefCell::default(),
            strays: RefCell::default(),
        }
    }

    /// The text of the file.
    pub fn text(&self) -> &'t str {
        self.text
    }

    /// The line of a byte, counted from 1.
    pub fn line(&self, byte: usize) -> usize {
        let before = &self.text.as_bytes()[..byte.min(self.text.len())];
        before.iter().filter(|b| **b == b'\n').count() + 1
    }

    /// Notes a complaint about a place.
    pub fn complain(&self, span: &Range<usize>, text: String) {
        self.complain_line(self.line(span.start), text);
    }

    /// Notes a complaint about a line; 0 = the whole file.
    pub fn complain_line(&self, line: usize, text: String) {
        let diagnostic = Diagnostic {
            file: self.file.into(),
            line,
            text,
        };
        self.diagnostics.borrow_mut().push(diagnostic);
    }

    /// Takes over what is wrong with another file that this one names.
    pub fn adopt(&self, diagnostics: Vec<Diagnostic>) {
        self.diagnostics.borrow_mut().extend(diagnostics);
    }

    /// Whether nothing is wrong so far.
    pub fn is_good(&self) -> bool {
        self.diagnostics.borrow().is_empty() && self.strays.borrow().is_empty()
    }

    /// All that was asked for, and all complaints, in the order of the lines.
    pub fn into_asked(self) -> (Vec<Asked>, Vec<Diagnostic>) {
        let asked = self.asked.borrow().clone();
        (asked, self.into_diagnostics())
    }
}

/// A value and the line it stands on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct At<T> {
    /// The value.
    pub value: T,
    /// Its line, counted from 1.
    pub line: usize,
}

/// One table being read; [`Table::finish`] complains about the keys nobody asked for.
pub struct Table<'s, 't> {
    pub(super) source: &'s Source<'t>,
    pub(super) table: &'s DeTable<'t>,
    path: String,
    /// Line of the table's head; 0 when it is missing.
    pub line: usize,
    known: RefCell<BTreeSet<&'static str>>,
}

impl<'s, 't> Table<'s, 't> {
    /// The top level of a file.
    pub fn root(source: &'s Source<'t>, table: &'s DeTable<'t>) -> Self {
        Self::new(source, table, String::new(), 1)
    }

    pub(super) fn new(
        source: &'s Source<'t>,
        table: &'s DeTable<'t>,
        path: String,
        line: usize,
    ) -> Self {
        Self {
            source,
            table,
            path,
            line,
            known: RefCell::default(),
        }
    }

    /// Name of a key with the path of its table.
    pub fn name(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.into()
        } else {
            format!("{}.{key}", self.path)
        }
    }

    /// Notes what is asked for.
    pub(super) fn ask(&self, key: &'static Key, kind: Kind) {
        debug_assert!(key.belongs_to(&self.path), "{}", self.name(key.name));
        self.note(key.name, kind, key.words());
    }

    pub(super) fn note(&self, key: &'static str, kind: Kind, words: Vec<String>) {
        let mut asked = self.source.asked.borrow_mut();
        asked.push(Asked {
            table: self.path.clone(),
            key,
            kind,
            words,
        });
    }

    /// Notes that the key asked for last may be fewer words than its own.
    pub fn offer(&self, words: impl IntoIterator<Item = impl Display>) {
        if let Some(last) = self.source.asked.borrow_mut().last_mut() {
            last.words = words.into_iter().map(|word| word.to_string()).collect();
        }
    }

    pub(super) fn get(&self, key: &'static str) -> Option<&'s Spanned<DeValue<'t>>> {
        self.known.borrow_mut().insert(key);
        self.table.get(key)
    }

    pub(super) fn wrong_type(&self, key: &str, value: &Spanned<DeValue<'_>>, wanted: &str) {
        let text = format!(
            "{} = {}: is {}, must be {wanted}",
            self.name(key),
            self.excerpt(&value.span()),
            article(value.get_ref().type_str())
        );
        self.source.complain(&value.span(), text);
    }

    /// The value as it stands in the file, shortened.
    pub(super) fn excerpt(&self, span: &Range<usize>) -> String {
        shorten(self.source.text.get(span.clone()).unwrap_or("?"))
    }

    pub(super) fn at<T>(&self, value: T, spanned: &Spanned<DeValue<'_>>) -> Option<At<T>> {
        Some(At {
            value,
            line: self.source.line(spanned.span().start),
        })
    }

    /// An integer, if the key is there; `limits` are told when it is negative or beyond every number of hardware.
    pub fn integer(&self, key: &'static Key, limits: &Limits) -> Option<At<u64>> {
        self.integer_or(key, limits, limits)
    }

    /// The same, but a message gives other limits.
    pub fn integer_or(&self, key: &'static Key, limits: &Limits, told: &Limits) -> Option<At<u64>> {
        self.ask(key, Kind::Integer(limits.clone()));
        let key = key.name;
        let spanned = self.get(key)?;
        let Some(integer) = spanned.get_ref().as_integer() else {
            let written = self.source.text.get(spanned.span()).unwrap_or_default();
            let wanted = match quantity::remedy(key, written) {
                Some(remedy) => format!("a whole number; {remedy}"),
                None => "a whole number, without quotes or decimal point".into(),
            };
            self.wrong_type(key, spanned, &wanted);
            return None;
        };
        match i128::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(value) if (0..=i128::from(u32::MAX) * 1_000).contains(&value) => {
                self.at(value as u64, spanned)
            }
            _ => {
                let (name, value) = (self.name(key), self.excerpt(&spanned.span()));
                let text = format!("{name} = {value}: {told}");
                self.source.complain(&spanned.span(), text);
                None
            }
        }
    }

    /// Complains about a number outside its limits.
    pub fn check(&self, key: &Key, at: &At<u64>, limits: &Limits) {
        if !limits.contains(at.value) {
            self.complain(
                at.line,
                key.name,
                &at.value.to_string(),
                &limits.to_string(),
            );
        }
    }

    /// An integer that must be there.
    pub fn required_integer(&self, key: &'static Key, limits: &Limits) -> Option<At<u64>> {
        let found = self.integer(key, limits);
        self.require(key)?;
        found
    }

    /// A string, if the key is there.
    pub fn string(&self, key: &'static Key) -> Option<At<String>> {
        self.ask(key, Kind::Text);
        let key = key.name;
        let spanned = self.get(key)?;
        match spanned.get_ref().as_str() {
            Some(text) => self.at(text.to_owned(), spanned),
            None => {
                self.wrong_type(key, spanned, "text in quotes");
                None
            }
        }
    }

    /// A string that must be there.
    pub fn required_string(&self, key: &'static Key) -> Option<At<String>> {
        let found = self.string(key);
        self.require(key)?;
        found
    }

    /// True or false, if the key is there.
    pub fn boolean(&self, key: &'static Key) -> Option<At<bool>> {
        self.ask(key, Kind::Boolean);
        let key = key.name;
        let spanned = self.get(key)?;
        match spanned.get_ref().as_bool() {
            Some(value) => self.at(value, spanned),
            None => {
                self.wrong_type(key, spanned, "true or false, without quotes");
                None
            }
        }
    }

    /// A list of strings, if the key is there.
    pub fn strings(&self, key: &'static Key) -> Option<Vec<At<String>>> {
        self.ask(key, Kind::Texts);
        let key = key.name;
        let spanned = self.get(key)?;
        let Some(array) = spanned.get_ref().as_array() else {
            self.wrong_type(key, spanned, "a list of texts in quotes");
            return None;
        };
        let mut all = Vec::new();
        for item in array.iter() {
            match item.get_ref().as_str() {
                Some(text) => all.extend(self.at(text.to_owned(), item)),
                None => self.wrong_type(key, item, "text in quotes"),
            }
        }
        Some(all)
    }

    /// A table; an empty one stands in when it is missing.
    pub fn table(&self, key: &'static str, empty: &'s DeTable<'t>) -> Table<'s, 't> {
        let path = self.name(key);
        match self.get(key).map(|s| (s, s.get_ref().as_table())) {
            Some((spanned, Some(table))) => Table::new(
                self.source,
                table,
                path,
                self.source.line(spanned.span().start),
            ),
            other => {
                if let Some((spanned, None)) = other {
                    self.wrong_type(key, spanned, &format!("a table headed [{path}]"));
                }
                Table::new(self.source, empty, path, 0)
            }
        }
    }

    /// An array of tables; empty when missing, `None` when it is something else.
    pub fn tables(&self, key: &'static str) -> Option<Vec<Table<'s, 't>>> {
        self.note(key, Kind::Tables, vec![]);
        let Some(spanned) = self.get(key) else {
            return Some(Vec::new());
        };
        let Some(array) = spanned.get_ref().as_array() else {
            // The span of a table is that of its head.
            if spanned.get_ref().is_table() {
                let text = format!(
                    "[{key}]: stands in single brackets; write [[{key}]], as there may be several"
                );
                self.source.complain(&spanned.span(), text);
                return None;
            }
            self.wrong_type(key, spanned, &format!("tables headed [[{key}]]"));
            return None;
        };
        let mut all = Vec::new();
        for (index, item) in array.iter().enumerate() {
            match item.get_ref().as_table() {
                Some(table) => {
                    let line = self.source.line(item.span().start);
                    all.push(Table::new(
                        self.source,
                        table,
                        format!("{key}[{index}]"),
                        line,
                    ));
                }
                None => {
                    self.wrong_type(key, item, &format!("a table headed [[{key}]]"));
                    return None;
                }
            }
        }
        Some(all)
    }

    /// Complains about a key that must be there, if it is not.
    pub fn require(&self, key: &'static Key) -> Option<()> {
        self.require_name(key.name, key.example())
    }

    /// The same with another example.
    pub fn require_as(&self, key: &'static Key, example: &str) -> Option<()> {
        self.require_name(key.name, example)
    }

    /// The same by its name.
    pub(super) fn require_name(&self, key: &'static str, example: &str) -> Option<()> {
        if self.get(key).is_none() {
            // Without its table there is no line to add it to.
            let place = match self.line {
                0 => format!(" below `[{}]`", self.path),
                _ => String::new(),
            };
            let text = format!(
                "{}: is missing; add, for example, `{key} = {example}`{place}",
                self.name(key)
            );
            self.source.complain_line(self.line, text);
            return None;
        }
        Some(())
    }

    /// Whether the key is there, readable or not.
    pub fn has(&self, key: &str) -> bool {
        self.table.get(key).is_some()
    }

    /// The text below a key, which is not asked for with that.
    pub fn peek(&self, key: &str) -> Option<&str> {
        self.table.get(key)?.get_ref().as_str()
    }

    /// Takes these keys as asked for.
    pub fn know(&self, keys: &[&'static Key]) {
        self.known.borrow_mut().extend(keys.iter().map(|k| k.name));
    }

    /// Complains about a key that must not stand here, if it does.
    pub fn refuse(&self, key: &'static Key, text: &str) {
        let key = key.name;
        if !self.has(key) {
            return;
        }
        if let Some(spanned) = self.get(key) {
            let line = self.source.line(spanned.span().start);
            self.complain(line, key, &self.excerpt(&spanned.span()), text);
        }
    }

    /// The same of a table.
    pub fn refuse_table(&self, key: &'static str, text: &str) {
        if let (true, Some(spanned)) = (self.has(key), self.get(key)) {
            let text = format!("[{}]: {text}", self.name(key));
            self.source.complain(&spanned.span(), text);
        }
    }

    /// Notes a complaint about the table itself.
    pub fn complain_plain(&self, text: String) {
        self.source.complain_line(self.line, text);
    }

    /// Notes a complaint about a key of this table.
    pub fn complain(&self, line: usize, key: &str, value: &str, text: &str) {
        let text = format!("{} = {}: {text}", self.name(key), shorten(value));
        self.source.complain_line(line, text);
    }

    /// Complains about every key that nothing has asked for.
    pub fn finish(&self) {
        let known = self.known.borrow();
        for (key, value) in self.table.iter() {
            if known.contains(key.get_ref().as_ref()) {
                continue;
            }
            self.source.strays.borrow_mut().push(Stray {
                line: self.source.line(key.span().start),
                is_table: value.get_ref().is_table() || value.get_ref().is_array(),
                key: key.get_ref().to_string(),
                name: self.name(key.get_ref()),
                known: known.iter().copied().collect(),
                written: self
                    .table
                    .keys()
                    .map(|k| k.get_ref().to_string())
                    .filter(|k| *k != *key.get_ref())
                    .collect(),
            });
        }
    }
}

fn article(kind: &str) -> String {
    let an = kind.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {kind}", if an { "an" } else { "a" })
}
