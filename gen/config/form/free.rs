//! Tables whose keys are names of things, and lists.

use super::asked::Kind;
use super::key::Key;
use super::reader::{At, Table};
use endat_hdl::config::Limits;
use toml::de::DeValue;
use toml::Spanned;

impl<'s, 't> Table<'s, 't> {
    /// A number that must be there and within the limits of its key.
    pub fn number(&self, key: &'static Key) -> Option<At<u64>> {
        let limits = key.limits(None);
        let found = self.required_integer(key, &limits)?;
        self.check(key, &found, &limits);
        limits.contains(found.value).then_some(found)
    }

    /// A text that must be there, in tables whose keys are names of things.
    pub fn text_of(&self, name: &'static str, example: &str) -> Option<At<String>> {
        self.note(name, Kind::Text, vec![]);
        self.require_name(name, example)?;
        self.text(name, self.get(name)?)
    }

    /// A list of integers, if the key is there; `limits` are told of one that is negative or beyond every number.
    pub fn integers(&self, key: &'static Key, limits: &str) -> Option<Vec<At<u64>>> {
        self.ask(key, Kind::Integers);
        let key = key.name;
        let spanned = self.get(key)?;
        let wanted = "a list of whole numbers, as [0x4C, 0x5B]";
        let Some(array) = spanned.get_ref().as_array() else {
            self.wrong_type(key, spanned, wanted);
            return None;
        };
        let mut all = Vec::new();
        for item in array.iter() {
            all.extend(self.whole(key, item, |_| true, limits));
        }
        Some(all)
    }

    /// A whole number that fits; `limits` are told of one that does not, is negative or beyond every number.
    fn whole(
        &self,
        key: &str,
        item: &Spanned<DeValue<'_>>,
        fits: impl Fn(u64) -> bool,
        limits: &str,
    ) -> Option<At<u64>> {
        let Some(integer) = item.get_ref().as_integer() else {
            self.wrong_type(key, item, "a whole number");
            return None;
        };
        let value = u64::from_str_radix(integer.as_str(), integer.radix());
        match value.ok().filter(|value| fits(*value)) {
            Some(value) => self.at(value, item),
            None => {
                let line = self.source.line(item.span().start);
                self.complain(line, key, &self.excerpt(&item.span()), limits);
                None
            }
        }
    }

    /// Every key with its text, for tables whose keys are names of things.
    pub fn free_strings(&self) -> Vec<(String, At<String>)> {
        let mut all = Vec::new();
        for (key, spanned) in self.table.iter() {
            match spanned.get_ref().as_str() {
                Some(text) => all.extend(
                    self.at(text.to_owned(), spanned)
                        .map(|at| (key.get_ref().to_string(), at)),
                ),
                None => self.wrong_type(key.get_ref(), spanned, "text in quotes"),
            }
        }
        all
    }

    /// Every key with its number, within these limits.
    pub fn free_numbers(&self, limits: &Limits) -> Vec<(String, At<u64>)> {
        let mut all = Vec::new();
        for (key, spanned) in self.table.iter() {
            let name = key.get_ref();
            let fits = |value| limits.contains(value);
            let found = self.whole(name, spanned, fits, &limits.to_string());
            all.extend(found.map(|at| (name.to_string(), at)));
        }
        all
    }

    /// Every key with the table below it.
    pub fn free_tables(&self) -> Vec<(String, Table<'s, 't>)> {
        let mut all = Vec::new();
        for (key, spanned) in self.table.iter() {
            let path = self.name(key.get_ref());
            match spanned.get_ref().as_table() {
                Some(table) => {
                    let line = self.source.line(spanned.span().start);
                    let table = Table::new(self.source, table, path, line);
                    all.push((key.get_ref().to_string(), table));
                }
                None => {
                    self.wrong_type(key.get_ref(), spanned, &format!("a table headed [{path}]"));
                }
            }
        }
        all.sort_by_key(|(_, table)| table.line);
        all
    }

    /// Notes a complaint about a line of the table that its text names.
    pub fn complain_at(&self, line: usize, text: String) {
        self.source.complain_line(line, text);
    }

    /// Every key with its list of texts.
    pub fn free_lists(&self) -> Vec<(String, Vec<At<String>>)> {
        let mut all = Vec::new();
        for (key, spanned) in self.table.iter() {
            let Some(array) = spanned.get_ref().as_array() else {
                self.wrong_type(key.get_ref(), spanned, "a list of texts in quotes");
                continue;
            };
            let texts = array
                .iter()
                .filter_map(|item| self.text(key.get_ref(), item));
            all.push((key.get_ref().to_string(), texts.collect()));
        }
        all
    }

    fn text(&self, key: &str, item: &'s Spanned<DeValue<'t>>) -> Option<At<String>> {
        match item.get_ref().as_str() {
            Some(text) => self.at(text.to_owned(), item),
            None => {
                self.wrong_type(key, item, "text in quotes");
                None
            }
        }
    }
}
