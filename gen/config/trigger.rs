//! Keys about triggers: those of the card, and those that a channel has for itself.

use super::reader::Table;
use endat_hdl::config::{limits, OwnTrigger, TriggerSources};

/// Keys of a channel; one of them on any channel gives all channels of the card their own trigger.
const OWN_KEYS: [&str; 3] = ["enabled", "divider", "sources"];

/// The triggers that a channel takes, and the line of `divider`; `None` if something is wrong.
pub fn read_own(table: &Table<'_, '_>) -> Option<(Option<OwnTrigger>, usize)> {
    let enabled = table.boolean("enabled");
    let divider = table.integer("divider", &limits("divider", None));
    let sources = read_sources(table)?;
    let is_read = |key, read: bool| read || !table.has(key);
    if !is_read("enabled", enabled.is_some()) || !is_read("divider", divider.is_some()) {
        return None;
    }
    if !OWN_KEYS.iter().any(|key| table.has(key)) {
        return Some((None, 0));
    }
    let line = divider.as_ref().map_or(0, |d| d.line);
    let own = OwnTrigger {
        enabled: enabled.is_none_or(|e| e.value),
        divider: divider.map_or(1, |d| d.value),
        sources,
    };
    Some((Some(own), line))
}

/// The list `sources` of a card or a channel: all three where there is none, `None` if something is wrong.
pub fn read_sources(table: &Table<'_, '_>) -> Option<TriggerSources> {
    let words = table.strings("sources");
    table.offer(["pin", "timer", "register"]);
    let Some(words) = words else {
        return Some(TriggerSources {
            pin: true,
            timer: true,
            register: true,
        });
    };
    let mut sources = TriggerSources::default();
    let mut good = true;
    for word in words {
        let source = match word.value.as_str() {
            "pin" => &mut sources.pin,
            "timer" => &mut sources.timer,
            "register" => &mut sources.register,
            _ => {
                table.complain(
                    word.line,
                    "sources",
                    &format!("{:?}", word.value),
                    "unknown trigger; use pin, timer, register",
                );
                good = false;
                continue;
            }
        };
        if std::mem::replace(source, true) {
            table.complain(
                word.line,
                "sources",
                &format!("{:?}", word.value),
                "stands twice; remove one",
            );
            good = false;
        }
    }
    good.then_some(sources)
}
