//! A file as TOML, and what is said if it is none.

use super::key::{Key, Kind};
use super::quantity;
use super::reader::Source;
use endat_console::error::shorten;
use toml::de::DeTable;

/// The file's top level, of a form with these keys; complaints go to `source`.
pub fn parse<'t>(source: &Source<'t>, keys: &[&Key]) -> Option<DeTable<'t>> {
    let (document, errors) = DeTable::parse_recoverable(source.text());
    // Keys below a second [channel] are no duplicates.
    let is_single = |error: &toml::de::Error| {
        let line = error.span().map_or(0, |span| source.line(span.start));
        is_channel(source, line)
    };
    let has_single = errors.iter().any(is_single);
    for error in errors.iter().filter(|e| !has_single || is_single(e)) {
        let line = error.span().map_or(0, |span| source.line(span.start));
        source.complain_line(line, not_toml(source, error, line, keys));
    }
    errors.is_empty().then(|| document.into_inner())
}

/// Whether a line is the head of a channel in single brackets.
fn is_channel(source: &Source<'_>, line: usize) -> bool {
    let written = source.text().lines().nth(line.saturating_sub(1));
    written.is_some_and(|l| l.trim_start().starts_with("[channel]"))
}

/// What the parser says about a line, and what to do about the usual mistakes.
fn not_toml(source: &Source<'_>, error: &toml::de::Error, line: usize, keys: &[&Key]) -> String {
    let is_text = |name: &str| {
        let mut keys = keys.iter();
        keys.any(|key| key.name == name && key.kind == Kind::Text)
    };
    let message = error.message().replace('\n', ", ");
    let written = source.text().lines().nth(line.saturating_sub(1));
    let (key, value) = written.and_then(|l| l.split_once('=')).unwrap_or_default();
    let value = value.split('#').next().unwrap_or_default().trim();
    let digits = value.len() > 1 && value.chars().all(|c| c.is_ascii_digit() || c == '_');
    let with_unit = quantity::remedy(key.trim(), value);
    let remedy = match () {
        () if digits && value.starts_with('0') && is_text(key.trim()) => {
            format!("put it in quotes: {} = \"{value}\"", key.trim())
        }
        () if digits && value.starts_with('0') => {
            let number = value.trim_start_matches(['0', '_']);
            let number = if number.is_empty() { "0" } else { number };
            format!("leave the first 0 out: {} = {number}", key.trim())
        }
        () if is_channel(source, line) => "write [[channel]], one for each".into(),
        () if message.contains("duplicate key") => {
            let span = error.span().and_then(|span| source.text().get(span));
            format!("{} stands twice, remove one", span.unwrap_or(key).trim())
        }
        () => with_unit.unwrap_or_else(|| "correct the line".into()),
    };
    format!("not TOML: {message}; {}", shorten(&remedy))
}
