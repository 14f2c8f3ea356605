//! The key `parts`: a list of names.

use super::reader::Table;

/// Marks the parts that a list names; line and text of each, `None` if something is wrong.
pub(super) fn read_parts(
    table: &Table<'_, '_>,
    names: &[&str],
    marks: &mut [&mut bool],
) -> Option<Vec<(usize, String)>> {
    let mut all = Vec::new();
    let words = table.strings("parts");
    table.offer(names);
    for word in words.unwrap_or_default() {
        let shown = format!("{:?}", word.value);
        let Some(index) = names.iter().position(|name| *name == word.value) else {
            let text = format!("unknown part; use {}", names.join(", "));
            table.complain(word.line, "parts", &shown, &text);
            return None;
        };
        if std::mem::replace(marks[index], true) {
            table.complain(word.line, "parts", &shown, "stands twice; remove one");
            return None;
        }
        all.push((word.line, shown));
    }
    Some(all)
}
