//! Words of the protocol and of this project: the table of docs/glossary.md.

const PAGE: &str = include_str!("../../docs/glossary.md");

/// Rows of the table: words, and their meaning without links.
fn rows() -> impl Iterator<Item = (&'static str, String)> {
    let rows = PAGE.lines().filter_map(|line| {
        let (word, meaning) = line
            .strip_prefix("| ")?
            .strip_suffix(" |")?
            .split_once(" | ")?;
        Some((
            word,
            endat_config::json_schema::plain(&without_links(meaning)),
        ))
    });
    rows.filter(|(word, _)| *word != "word")
}

/// `[text](address)` as `text`.
fn without_links(text: &str) -> String {
    let mut rest = text;
    let mut plain = String::new();
    while let Some((before, link)) = rest.split_once('[') {
        let Some((name, behind)) = link.split_once("](") else {
            break;
        };
        plain += before;
        plain += name;
        rest = behind.split_once(')').map_or("", |(_, after)| after);
    }
    plain + rest
}

/// Names of a row in lower case: all of its words, each of them, and the symbol at the end of one, such as tD.
fn names_of(words: &str) -> impl Iterator<Item = String> + '_ {
    let all = words.contains(", ").then(|| words.to_ascii_lowercase());
    let each = words.split(", ").flat_map(|word| {
        let last = word.rsplit(' ').next().filter(|last| *last != word);
        let symbol = last.filter(|last| last.starts_with('t') && last.len() <= 4);
        [Some(word), symbol]
            .into_iter()
            .flatten()
            .map(str::to_ascii_lowercase)
    });
    all.into_iter().chain(each)
}

/// Rows of a word in lower case, also with the number of a channel or port after it.
pub fn text(name: &str) -> String {
    let of = |name: &str| -> String {
        rows()
            .filter(|(words, _)| names_of(words).any(|known| known == name))
            .map(|(words, meaning)| format!("{words}: {meaning}\n"))
            .collect()
    };
    let text = of(name);
    match name.rsplit_once(' ') {
        Some((word, number)) if text.is_empty() && number.parse::<u8>().is_ok() => of(word),
        _ => text,
    }
}

/// All words and symbols.
pub fn names() -> Vec<String> {
    rows()
        .flat_map(|(words, _)| names_of(words).collect::<Vec<_>>())
        .collect()
}
