//! Properties of blocks: claims to prove, in the file named by `#[properties("x.sv")]`.
//!
//! Such a file is SystemVerilog over the emitted names of the block's nets and is appended to its module, below `` `ifdef FORMAL ``.
//! It begins with a line for each property, `// name: words`, or `// name unless CONSTANT (meaning), ...: words` if it is not claimed
//! for a block in which one of these constants is not 0. Assertions are labelled with the name of their property, required lemmas with
//! `name_lemma`. Properties after `` `ifdef FORMAL_ANY_STATE `` hold for any register contents, and are proved separately. Registers
//! of the proof begin with `f_`. Lines between `// with CONSTANT`, or `// without CONSTANT`, and `// end` are left
//! out of a block in which the constant is 0, or is not 0.

use super::Module;
use std::collections::BTreeSet;

/// From which states a property holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Begins {
    /// From the start values of the registers, and ever after.
    AtStart,
    /// From any contents of the registers.
    Anywhere,
}

/// A property.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Property {
    /// Its name: label of its assertion.
    pub name: String,
    /// Claim.
    pub words: String,
    /// From where.
    pub begins: Begins,
    /// Its assertions: itself, and its lemmas.
    pub assertions: usize,
    /// It is not claimed of a block in which one of these is not 0.
    pub unless: Vec<Exception>,
}

/// A part of a block that a property excepts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exception {
    /// The constant of the block that says so.
    pub constant: String,
    /// Meaning.
    pub words: String,
}

impl Property {
    /// Its words, with its exceptions.
    pub fn whole_words(&self) -> String {
        let parts: Vec<&str> = self.unless.iter().map(|e| e.words.as_str()).collect();
        match parts[..] {
            [] => self.words.clone(),
            _ => format!("{} No claim with {}.", self.words, parts.join(", ")),
        }
    }

    /// Names the part of this block that the property excepts; none if it holds for the block.
    pub fn not_claimed(&self, block: &Module) -> Option<&str> {
        let is_there = |one: &&Exception| {
            let mut constants = block.parameters.iter();
            constants.any(|c| c.name.eq_ignore_ascii_case(&one.constant) && c.value != 0)
        };
        let found = self.unless.iter().find(is_there);
        found.map(|one| one.words.as_str())
    }
}

/// The condition for properties of any state.
pub const ANY_STATE: &str = "FORMAL_ANY_STATE";

/// The name of the line that says which inputs are assumed to be less than anything.
const INPUTS: &str = "inputs";

/// Assumptions about the inputs of a block with this text, if any: its line `// inputs: words`.
pub fn inputs(text: &str) -> Option<&str> {
    let mut lines = text.lines();
    lines.find_map(|line| {
        line.strip_prefix("// ")?
            .strip_prefix(INPUTS)?
            .strip_prefix(": ")
    })
}

/// The properties of a text.
pub fn properties(text: &str) -> Vec<Property> {
    let labels: Vec<&str> = text.lines().flat_map(labels).collect();
    let mut begins = Begins::AtStart;
    let mut found: Vec<Property> = vec![];
    for line in text.lines() {
        if line.trim_start().starts_with('`') {
            begins = match line.contains(ANY_STATE) {
                true => Begins::Anywhere,
                false => Begins::AtStart,
            };
        }
        let Some((name, words)) = line.strip_prefix("// ").and_then(|l| l.split_once(": ")) else {
            continue;
        };
        let (name, unless) = name.split_once(" unless ").unwrap_or((name, ""));
        if !is_name(name) || name == INPUTS {
            continue;
        }
        found.push(Property {
            name: name.into(),
            words: words.into(),
            begins,
            assertions: 0,
            unless: unless.split(", ").filter_map(exception).collect(),
        });
    }
    for label in labels {
        if let Some(property) = of_label(&found, label) {
            found[property].assertions += 1;
        }
    }
    found
}

/// Keeps the lines that apply to a block. `open` and `close` enclose the marks `with NAME`, `without NAME` and `end`; `is_set` knows the
/// block's constants.
///
/// # Errors
/// The mark that names a constant which the block does not have, or that no `end` follows.
pub(super) fn selected<'a>(
    lines: impl Iterator<Item = &'a str>,
    (open, close): (&str, &str),
    is_set: impl Fn(&str) -> Option<bool>,
) -> Result<Vec<&'a str>, &'a str> {
    let mut shown = true;
    let mut opened = None;
    let mut found = vec![];
    for line in lines {
        let mark = line.trim().strip_prefix(open);
        let mark = mark.and_then(|rest| rest.strip_suffix(close));
        let mut words = mark.unwrap_or_default().split(' ');
        match (words.next(), words.next(), words.next()) {
            (Some("end"), None, _) => (shown, opened) = (true, None),
            (Some("with" | "without"), Some(_), None) if opened.is_some() => return Err(line),
            (Some(with @ ("with" | "without")), Some(name), None) => {
                shown = is_set(name).ok_or(line)? == (with == "with");
                opened = Some(line);
            }
            _ if shown => found.push(line),
            _ => {}
        }
    }
    opened.map_or(Ok(found), Err)
}

/// `CONSTANT (what it is)`.
fn exception(text: &str) -> Option<Exception> {
    let (constant, words) = text.strip_suffix(')')?.split_once(" (")?;
    Some(Exception {
        constant: constant.into(),
        words: words.into(),
    })
}

/// Everything that a text names; comments name nothing.
pub(crate) fn words(text: &str) -> BTreeSet<&str> {
    let code = text.lines().filter_map(|line| line.split("//").next());
    code.flat_map(|code| code.split(|c: char| !c.is_ascii_alphanumeric() && c != '_'))
        .collect()
}

/// The property that an assertion with this label belongs to: the longest name that the label begins with.
pub fn of_label(properties: &[Property], label: &str) -> Option<usize> {
    let is_its = |p: &Property| {
        let rest = label.strip_prefix(p.name.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
    };
    let candidates = properties.iter().enumerate().filter(|(_, p)| is_its(p));
    candidates.max_by_key(|(_, p)| p.name.len()).map(|(i, _)| i)
}

/// Labels of assertions in a line.
fn labels(line: &str) -> impl Iterator<Item = &str> {
    let ends = line.match_indices(": assert").map(|(end, _)| end);
    ends.filter_map(|end| line[..end].rsplit(|c: char| !is_letter(c)).next())
}

fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(is_letter)
}

fn is_letter(c: char) -> bool {
    c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "// a: First.\n// a_b: Second.\nreg f_x;\nalways @* begin\n    a: assert (1);\n    a_b_lemma: assert (1);\nend\n\
        `ifdef FORMAL_ANY_STATE\n// c unless HAS_X (an x), HAS_Y (a y): Third: any.\nalways @* if (x) c: assert (1);\n`endif\n// Note: none.\n";

    /// Catches a section that a block gets without its part, and one without an end, which would hide all that follows.
    #[test]
    fn a_block_gets_the_lines_of_its_parts() {
        let is_set = |name: &str| match name {
            "A" => Some(true),
            "B" => Some(false),
            _ => None,
        };
        let of = |text: &'static str| selected(text.lines(), ("// ", ""), is_set);
        let text = "one\n// with A\ntwo\n// end\n// with B\nthree\n// end\n// without B\nfour\n// end\n// with words\n";
        assert_eq!(of(&text[..text.len() - 14]), Ok(vec!["one", "two", "four"]));
        assert_eq!(
            of("// with words of a comment\none"),
            Ok(vec!["// with words of a comment", "one"])
        );
        assert_eq!(of(text), Err("// with words"), "no such constant");
        assert_eq!(of("// with A\none\n"), Err("// with A"), "no end");
        assert_eq!(
            of("// with A\n// without B\none\n// end\n"),
            Err("// without B"),
            "one in another"
        );
    }

    #[test]
    fn a_text_gives_its_properties() {
        let found = properties(TEXT);
        let short: Vec<_> = found
            .iter()
            .map(|p| (p.name.as_str(), p.words.as_str(), p.begins, p.assertions))
            .collect();
        let start = Begins::AtStart;
        let expected = [
            ("a", "First.", start, 1),
            ("a_b", "Second.", start, 1),
            ("c", "Third: any.", Begins::Anywhere, 1),
        ];
        assert_eq!(short, expected);
        let unless = |n: usize| found[n].unless.iter().map(|e| (&*e.constant, &*e.words));
        assert_eq!(unless(0).count(), 0);
        assert!(!words(TEXT).contains("First") && words(TEXT).contains("f_x"));
        assert!(unless(2).eq([("HAS_X", "an x"), ("HAS_Y", "a y")]));
    }
}
