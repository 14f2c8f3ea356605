//! Keys about triggers: those of the card, and those that a channel has for itself.

use super::keys::{DIVIDER, ENABLED, OWN_SOURCES};
use super::parts::read_words;
use super::reader::Table;
use crate::form::key::Key;
use endat_hdl::config::{OwnTrigger, TriggerSources};

/// Keys of a channel; one of them on any channel gives all channels of the card their own trigger.
static OWN_KEYS: [&Key; 3] = [&ENABLED, &DIVIDER, &OWN_SOURCES];

/// The triggers that a channel takes, and the line of `divider`; `None` if something is wrong.
pub fn read_own(table: &Table<'_, '_>) -> Option<(Option<OwnTrigger>, usize)> {
    let enabled = table.boolean(&ENABLED);
    let divider = table.integer(&DIVIDER, &DIVIDER.limits(None));
    let sources = read_sources(table, &OWN_SOURCES)?;
    let is_read = |key: &Key, read: bool| read || !table.has(key.name);
    if !is_read(&ENABLED, enabled.is_some()) || !is_read(&DIVIDER, divider.is_some()) {
        return None;
    }
    if !OWN_KEYS.iter().any(|key| table.has(key.name)) {
        return Some((None, 0));
    }
    let line = divider.as_ref().map_or(0, |d| d.line);
    let own = OwnTrigger {
        enabled: enabled.is_none_or(|e| e.value),
        divider: divider.map_or(DIVIDER.usual_number(), |d| d.value),
        sources,
    };
    Some((Some(own), line))
}

/// The list `sources` of a card or a channel: all three where there is none, `None` if something is wrong.
pub fn read_sources(table: &Table<'_, '_>, key: &'static Key) -> Option<TriggerSources> {
    let Some(words) = table.strings(key) else {
        return Some(TriggerSources {
            pin: true,
            timer: true,
            register: true,
        });
    };
    let mut sources = TriggerSources::default();
    let marks = &mut [&mut sources.pin, &mut sources.timer, &mut sources.register];
    for place in read_words(table, key, words, "trigger")? {
        *marks[place] = true;
    }
    Some(sources)
}
