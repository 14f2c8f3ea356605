//! Lists of words: the key `parts`, and others.

use super::reader::{At, Table};
use crate::form::key::Key;

/// Marks the parts that a list names, in the order of the key's words; line and text of each, `None` if something is wrong.
pub(super) fn read_parts(
    table: &Table<'_, '_>,
    key: &'static Key,
    marks: &mut [&mut bool],
) -> Option<Vec<(usize, String)>> {
    let mut all = Vec::new();
    let names = key.words();
    for word in table.strings(key).unwrap_or_default() {
        let shown = format!("{:?}", word.value);
        let index = names.iter().position(|name| *name == word.value);
        let Some(mark) = index.and_then(|index| marks.get_mut(index)) else {
            let text = format!("unknown part; use {}", names.join(", "));
            table.complain(word.line, key.name, &shown, &text);
            return None;
        };
        if std::mem::replace(*mark, true) {
            table.complain(word.line, key.name, &shown, "stands twice; remove one");
            return None;
        }
        all.push((word.line, shown));
    }
    Some(all)
}

/// Complains about parts without the one that leads them.
pub(super) fn check_leader(
    table: &Table<'_, '_>,
    key: &Key,
    has_leader: bool,
    named: &[(usize, String)],
) -> Option<()> {
    let (Some((line, shown)), false) = (named.first(), has_leader) else {
        return Some(());
    };
    let leader = key.words().into_iter().next().unwrap_or_default();
    let text = format!("every other part takes {leader}; add {leader:?}");
    table.complain(*line, key.name, shown, &text);
    None
}

/// Places of the words of a list among those of its key. Complains about each word that is unknown, or there twice; then `None`.
pub(super) fn read_words(
    table: &Table<'_, '_>,
    key: &'static Key,
    words: Vec<At<String>>,
    kind: &str,
) -> Option<Vec<usize>> {
    let names = key.words();
    let (mut places, mut is_good) = (Vec::new(), true);
    for word in words {
        let text = match names.iter().position(|name| *name == word.value) {
            None => format!("unknown {kind}; use {}", names.join(", ")),
            Some(place) if places.contains(&place) => "stands twice; remove one".into(),
            Some(place) => {
                places.push(place);
                continue;
            }
        };
        table.complain(word.line, key.name, &format!("{:?}", word.value), &text);
        is_good = false;
    }
    is_good.then_some(places)
}
