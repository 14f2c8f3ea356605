//! Unknown keys, and the complaints about a whole file.

use super::key::head;
use super::reader::{Source, Stray};
use endat_console::did_you_mean::{closest, guess};
use endat_console::error::{shorten, Diagnostic};
use std::collections::BTreeSet;

impl Source<'_> {
    /// All complaints, in the order of the lines.
    pub fn into_diagnostics(self) -> Vec<Diagnostic> {
        // Only now all tables have been read: a key may belong to another one.
        let strays = self.strays.take();
        // A misspelt heading hides all keys below it. Other complaints would follow from that, so it is reported alone.
        let is_heading = |stray: &Stray| {
            let known = stray.known.iter().copied();
            stray.is_table && stray.name == stray.key && guess(&stray.key, known).is_some()
        };
        let has_heading = strays.iter().any(is_heading);
        if has_heading {
            self.diagnostics.borrow_mut().clear();
        }
        for stray in strays.iter().filter(|s| !has_heading || is_heading(s)) {
            let text = self.stray(stray);
            self.complain_line(stray.line, text);
        }
        let mut all = self.diagnostics.into_inner();
        // A value in the place of a table hides keys, too.
        let is_none = |d: &Diagnostic| d.text.contains(", must be a table headed ");
        if all.iter().any(is_none) {
            all.retain(is_none);
        }
        all.sort_by_key(|d| d.line);
        let mut seen = BTreeSet::new();
        all.retain(|d| seen.insert((d.line, d.text.clone())));
        all
    }

    /// The complaint about such a key: a suggestion, or the table that it belongs to.
    fn stray(&self, stray: &Stray) -> String {
        let Stray { key, known, .. } = stray;
        let asked = self.asked.borrow();
        let homes = asked.iter().filter(|a| a.key == key);
        let homes: BTreeSet<&str> = homes
            .map(|a| a.table.split('[').next().unwrap_or_default())
            .collect();
        let written: Vec<&str> = stray.written.iter().map(String::as_str).collect();
        let free = known.iter().copied().filter(|k| !written.contains(k));
        let hint = match guess(key, free) {
            // A key of another table is not misspelt.
            _ if !homes.is_empty() => {
                let homes: Vec<String> = homes.into_iter().map(home).collect();
                format!("it belongs {}", homes.join(" or "))
            }
            Some(near) => near,
            None => match closest(key, written, |k| k).first() {
                Some(near) if known.contains(near) => {
                    format!("{near} is there already, remove this one")
                }
                _ => format!("known keys here: {}", known.join(", ")),
            },
        };
        format!("{}: unknown key; {hint}", shorten(&stray.name))
    }
}

/// Names the place of a table in the file.
fn home(table: &str) -> String {
    match table {
        "" => "to the top of the file, above all tables".into(),
        table => format!("to {}", head(table)),
    }
}
