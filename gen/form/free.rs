//! Tables whose keys are names of things, and lists.

use super::asked::Kind;
use super::reader::{At, Table};
use std::ops::RangeInclusive;
use toml::de::DeValue;
use toml::Spanned;

impl<'s, 't> Table<'s, 't> {
    /// A number that must be there and within a range.
    pub fn number(
        &self,
        key: &'static str,
        example: &str,
        range: RangeInclusive<u64>,
    ) -> Option<At<u64>> {
        let (low, high) = (range.start(), range.end());
        let limits = format!("outside {low}..{high}; choose a value in that range");
        let found = self.whole(key, &limits);
        self.require(key, example)?;
        let found = found?;
        if !range.contains(&found.value) {
            self.complain(found.line, key, &found.value.to_string(), &limits);
            return None;
        }
        Some(found)
    }

    /// A list of integers, if the key is there; `limits` are told of one that is negative or beyond every number.
    pub fn integers(&self, key: &'static str, limits: &str) -> Option<Vec<At<u64>>> {
        self.ask(key, Kind::Integers);
        let spanned = self.get(key)?;
        let wanted = "a list of whole numbers, as [0x4C, 0x5B]";
        let Some(array) = spanned.get_ref().as_array() else {
            self.wrong_type(key, spanned, wanted);
            return None;
        };
        let mut all = Vec::new();
        for item in array.iter() {
            let Some(integer) = item.get_ref().as_integer() else {
                self.wrong_type(key, item, "a whole number");
                continue;
            };
            match u64::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(value) => all.extend(self.at(value, item)),
                Err(_) => {
                    let line = self.source.line(item.span().start);
                    self.complain(line, key, &self.excerpt(&item.span()), limits);
                }
            }
        }
        Some(all)
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
