//! Comments of at most [`COLUMNS`] columns.

/// Longest line of a comment.
const COLUMNS: usize = 132;

/// Lines of a comment that begin with `mark`. A paragraph with a line that is too long is wrapped as a whole; drawings and tables stay as they are.
pub(crate) fn comment(mark: &str, lines: &[String], pad: &str) -> String {
    let room = COLUMNS.saturating_sub(pad.len() + mark.len() + 1);
    let line = |line: &String| format!("{}\n", format!("{pad}{mark} {line}").trim_end());
    wrapped(lines, room).iter().map(line).collect()
}

/// A comment in the line of `code`, which begins with `pad`; above it if that line would be too long.
pub(crate) fn with_comment(mark: &str, code: &str, doc: Option<&String>, pad: &str) -> String {
    match doc {
        None => format!("{pad}{code}\n"),
        Some(doc) if pad.len() + code.len() + mark.len() + doc.len() + 2 <= COLUMNS => {
            format!("{pad}{code} {mark} {doc}\n")
        }
        Some(doc) => {
            let above = comment(mark, std::slice::from_ref(doc), pad);
            format!("{above}{pad}{code}\n")
        }
    }
}

/// `text` after `begin`; its later lines begin in the column of the text.
pub(crate) fn beside(begin: &str, text: &str) -> Vec<String> {
    let columns = begin.chars().count();
    // The longest mark and its space.
    let room = COLUMNS.saturating_sub(columns + 3);
    let lines = filled(&[text.to_owned()], room);
    let line = |(index, line): (usize, &String)| match index {
        0 => format!("{begin}{line}"),
        _ => format!("{}{line}", " ".repeat(columns)),
    };
    lines.iter().enumerate().map(line).collect()
}

/// A text with its long comment lines wrapped. A line goes on with the long one above it if it begins with a small letter and is no `name: words`.
pub fn with_wrapped_comments(text: &str, mark: &str) -> String {
    let words = |line: &str| {
        let code = line.trim_start();
        let words = code.strip_prefix(mark)?.strip_prefix(' ')?;
        Some((line[..line.len() - code.len()].to_owned(), words.to_owned()))
    };
    let goes_on = |(pad, line): &(String, String), (first_pad, first): &(String, String)| {
        let is_named = line
            .split(' ')
            .next()
            .is_some_and(|word| word.ends_with(':'));
        let is_small = line
            .trim_start()
            .starts_with(|c: char| c.is_ascii_lowercase());
        pad == first_pad && is_small && !is_named && continues(line, first)
    };
    let mut out = String::new();
    let mut lines = text.split_inclusive('\n').peekable();
    while let Some(line) = lines.next() {
        let is_long = line.trim_end().chars().count() > COLUMNS;
        let Some(first) = words(line.trim_end()).filter(|(_, words)| is_long && !is_drawn(words))
        else {
            out.push_str(line);
            continue;
        };
        let mut paragraph = vec![first.1.clone()];
        while let Some(next) = lines.peek().and_then(|next| words(next.trim_end())) {
            if !goes_on(&next, &first) {
                break;
            }
            paragraph.push(next.1);
            lines.next();
        }
        out.push_str(&comment(mark, &paragraph, &first.0));
    }
    out
}

/// Lines of at most `room` columns. The lines after the first one of a paragraph begin as its second one does; those of an item of a list begin
/// below its text.
fn wrapped(lines: &[String], room: usize) -> Vec<String> {
    let mut out = vec![];
    let mut rest = lines;
    while let Some(first) = rest.first() {
        let more = rest[1..].iter().take_while(|line| continues(line, first));
        let (paragraph, others) = rest.split_at(1 + more.count());
        rest = others;
        if is_drawn(first) || paragraph.iter().all(|line| line.chars().count() <= room) {
            out.extend_from_slice(paragraph);
            continue;
        }
        out.extend(filled(paragraph, room));
    }
    out
}

/// The words of a paragraph in lines of at most `room` columns.
fn filled(paragraph: &[String], room: usize) -> Vec<String> {
    let begin = indent(&paragraph[0]);
    let hang = if is_item(&paragraph[0]) {
        begin + 2
    } else {
        begin
    };
    let mut lines = vec![" ".repeat(begin)];
    let mut is_empty = true;
    for word in paragraph.iter().flat_map(|line| line.split_whitespace()) {
        let last = lines.len() - 1;
        let columns = lines[last].chars().count() + usize::from(!is_empty) + word.chars().count();
        if columns > room && !is_empty {
            lines.push(format!("{}{word}", " ".repeat(hang)));
        } else {
            let space = if is_empty { "" } else { " " };
            lines[last].push_str(&format!("{space}{word}"));
        }
        is_empty = false;
    }
    lines
}

/// Whether a line goes on with the paragraph that begins with `first`.
fn continues(line: &str, first: &str) -> bool {
    let hang = indent(first) + if is_item(first) { 2 } else { 0 };
    !line.trim().is_empty()
        && !is_item(line)
        && !is_drawn(line)
        && !is_drawn(first)
        && indent(line) == hang
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

fn is_item(line: &str) -> bool {
    line.trim_start().starts_with("- ")
}

/// Whether a line is of a drawing or a table: text has no spaces side by side, and none of the strokes.
fn is_drawn(line: &str) -> bool {
    let text = line.trim();
    let strokes = ["  ", "__", "~~", "-->", "<--", "---", "===", "/\\", "\\/"];
    text.starts_with('|')
        || text.starts_with('+')
        || strokes.iter().any(|stroke| text.contains(stroke))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(texts: &[&str]) -> Vec<String> {
        texts.iter().map(|text| (*text).to_owned()).collect()
    }

    /// Catches a long line, an orphan word, and a drawing, a list or a short paragraph that is filled.
    #[test]
    fn paragraphs_with_long_lines_are_wrapped() {
        let text = lines(&[
            "one two three four five",
            "six seven",
            "",
            "short",
            "lines",
            "- an item that is long",
            "  and goes on",
            "- b",
            "a ____/~~~\\_____________ b",
        ]);
        let expected = lines(&[
            "one two three",
            "four five six",
            "seven",
            "",
            "short",
            "lines",
            "- an item that",
            "  is long and",
            "  goes on",
            "- b",
            "a ____/~~~\\_____________ b",
        ]);
        assert_eq!(wrapped(&text, 14), expected);
    }

    /// Catches a separate line that is joined to a long one, a changed code line, and the end of a sentence that stays on a line by itself.
    #[test]
    fn long_comment_lines_of_a_text_are_wrapped() {
        let long = "word ".repeat(30);
        let text = format!("  -- {long}\n  -- end.\n  -- name: words\n  x -- {long}\n");
        let found = with_wrapped_comments(&text, "--");
        let first = "word ".repeat(25);
        let rest = "word ".repeat(5);
        assert_eq!(
            found,
            format!(
                "  -- {}\n  -- {rest}end.\n  -- name: words\n  x -- {long}\n",
                first.trim_end()
            )
        );
    }

    #[test]
    fn a_long_comment_is_above_its_line() {
        let short = "d".repeat(20);
        assert_eq!(
            with_comment("//", "code;", Some(&short), "    "),
            format!("    code; // {short}\n")
        );
        let long = "d".repeat(120);
        assert_eq!(
            with_comment("//", "code;", Some(&long), "    "),
            format!("    // {long}\n    code;\n")
        );
    }
}
