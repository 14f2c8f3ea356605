//! Pieces of text that every part of a module uses.

use crate::elaborate::{mask, properties::ANY_STATE};
pub(super) use crate::printing::INDENT;

/// Begins a comment.
pub(super) const MARK: &str = "//";

/// The ranges of set bits, as lowest bit and width.
pub(super) fn ranges(mut bits: u128) -> impl Iterator<Item = (usize, usize)> {
    std::iter::from_fn(move || {
        if bits == 0 {
            return None;
        }
        let low = bits.trailing_zeros() as usize;
        let width = (bits >> low).trailing_ones() as usize;
        bits &= !(mask(width) << low);
        Some((low, width))
    })
}

pub(super) fn vector(width_bits: usize) -> String {
    match width_bits {
        1 => String::new(),
        _ => format!("[{}:0]", width_bits - 1),
    }
}

pub(super) fn comment(lines: &[String], pad: &str) -> String {
    crate::printing::comment(MARK, lines, pad)
}

/// The properties of a module: only provers see them.
pub(super) fn properties(text: &str) -> String {
    if text.is_empty() {
        return String::new();
    }
    let line = |line: &str| match line {
        "" => "\n".to_string(),
        line if line.starts_with('`') => format!("{line}\n"),
        line if line.starts_with(MARK) => {
            let words = line.trim_start_matches(MARK).trim_start().to_owned();
            comment(&[words], INDENT)
        }
        line => format!("{INDENT}{}\n", labelled(line)),
    };
    let lines: String = text.lines().map(line).collect();
    // Lines that do not apply to any state hold from the start values.
    let lines = match text.contains(ANY_STATE) {
        true => lines,
        false => format!("`ifndef {ANY_STATE}\n{lines}`endif\n"),
    };
    format!("\n`ifdef FORMAL\n{LABELS}{lines}`undef {LABEL}\n`endif\n")
}

/// The macro that labels an assertion.
const LABEL: &str = "FORMAL_LABEL";

/// Its definition: Icarus Verilog 11 takes assertions, but no labels.
const LABELS: &str = "`ifdef __ICARUS__
`define FORMAL_LABEL(name)
`else
`define FORMAL_LABEL(name) name:
`endif
";

/// A line with its label in the macro.
fn labelled(line: &str) -> String {
    let Some(end) = line.find(": assert (") else {
        return line.to_string();
    };
    let is_letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begin = line[..end].rfind(|c: char| !is_letter(c));
    let begin = begin.map_or(0, |at| at + 1);
    let [before, name, after] = [&line[..begin], &line[begin..end], &line[end + 1..]];
    format!("{before}`{LABEL}({name}){after}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_assertions_are_in_the_macro() {
        assert_eq!(
            labelled("always @* if (x) one: assert (a ? b : c);"),
            "always @* if (x) `FORMAL_LABEL(one) assert (a ? b : c);"
        );
        assert_eq!(
            labelled("    two: assert (1);"),
            "    `FORMAL_LABEL(two) assert (1);"
        );
        assert_eq!(labelled("wire a = b ? c : d;"), "wire a = b ? c : d;");
    }
}
