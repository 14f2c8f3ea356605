//! The key `protocol` of a `[[channel]]`, and the keys that only some protocols have.

use super::forms::{form, CARD_FORM};
use super::keys::{of_channels, of_lines, PROTOCOL};
use super::reader::Table;
use crate::form::key::Key;
use endat_regs::Protocol;

/// Takes the keys of a channel of any protocol as asked for.
fn know_all(table: &Table<'_, '_>) {
    table.know(&of_channels(CARD_FORM).collect::<Vec<_>>());
}

/// Whether a channel speaks EnDat, as far as can be said before it is read.
pub fn may_be_endat(table: &Table<'_, '_>) -> bool {
    let word = table.peek(PROTOCOL.name);
    let others = Protocol::ALL.iter().filter(|p| **p != Protocol::Endat);
    word.is_none_or(|word| !others.clone().any(|p| p.row().word == word))
}

/// What a channel of a card speaks; `None` for what is no protocol. Keys of other protocols are refused.
pub fn read(table: &Table<'_, '_>) -> Option<Protocol> {
    let word = table.string(&PROTOCOL);
    let protocol = match &word {
        None if table.has(PROTOCOL.name) => None,
        None => Some(Protocol::Endat),
        Some(word) => {
            let mut all = Protocol::ALL.iter();
            let known = all.find(|p| p.row().word == word.value).copied();
            if known.is_none() {
                let text = format!("unknown protocol; use {}", choices());
                let shown = format!("{:?}", word.value);
                table.complain(word.line, PROTOCOL.name, &shown, &text);
            }
            known
        }
    };
    let Some(protocol) = protocol else {
        know_all(table);
        return None;
    };
    let foreign = of_channels(CARD_FORM).filter(|key| !belongs(key, protocol));
    for key in foreign {
        table.refuse(key, &why_foreign(key, protocol));
    }
    Some(protocol)
}

/// The words for all protocols.
fn choices() -> String {
    let shown = |p: &Protocol| match p {
        Protocol::Endat => format!("\"{}\" (default)", p.row().word),
        _ => format!("\"{}\"", p.row().word),
    };
    let words: Vec<String> = Protocol::ALL.iter().map(shown).collect();
    words.join(" or ")
}

fn belongs(key: &Key, protocol: Protocol) -> bool {
    key.forms & form(protocol) != 0
}

/// Why a key is none of a channel that speaks this protocol, and the remedy.
fn why_foreign(key: &Key, protocol: Protocol) -> String {
    let mut all = Protocol::ALL.iter();
    let owner = all.find(|p| belongs(key, **p)).unwrap_or(&Protocol::Endat);
    let what = format!(
        "is a key of {}, and this channel speaks {}; remove it",
        owner.name(),
        protocol.name()
    );
    if protocol == Protocol::Endat {
        return format!("{what}, or add protocol = \"{}\"", owner.row().word);
    }
    // What it has instead, then what it has of a line's.
    let own = of_channels(form(protocol)).filter(|key| !belongs(key, Protocol::Endat));
    let shared = of_lines().filter(|key| belongs(key, protocol));
    let names: Vec<&str> = own.chain(shared).map(|key| key.name).collect();
    format!("{what} ({} has {})", protocol.name(), names.join(", "))
}
