//! Looks whether a run meets the condition of each property. A property whose condition no run meets holds for every block, and says nothing.
//!
//! The condition of `if (a) assert (!b | c)` is `a & b`. A cover statement of it takes the place of the assertion; the assertion itself is
//! assumed. Outputs of the blocks inside a module may be anything.

use super::harness;
use super::report::{Met, Row, Verdict, RUN_CYCLES};
use super::{tools, Block, Subject};
use crate::scratch;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use rtl_design::elaborate::properties::{Begins, Property};
use rtl_design::elaborate::Design;
use std::collections::BTreeSet;
use std::path::Path;

/// Cycles that run before a state counts.
const SETTLED: usize = 8;

/// Records for each proved property of these blocks how its condition is met.
pub(super) fn look(
    subject: &Subject,
    blocks: &[Block],
    rows: &mut [Row],
) -> Result<(), CommandError> {
    let folder = scratch::folder()?;
    let files = subject.files.iter();
    let files: Vec<Artifact> = files
        .map(|file| Artifact::new(file.path.clone(), covers(&file.text)))
        .collect();
    endat_console::artifact::write(folder.path(), &files, scratch::REMEDY)?;
    for block in blocks {
        let name = &block.module.name;
        let found = met(folder.path(), &subject.design, block)?;
        for (property, met) in block.properties.iter().zip(found) {
            let mut rows = rows.iter_mut();
            let row = rows.find(|row| (&row.module, &row.name) == (name, &property.name));
            let Some(row) = row.filter(|row| row.verdict == Verdict::Proved) else {
                continue;
            };
            row.met = Some(met);
            if met == Met::Never {
                row.verdict = Verdict::Empty;
            }
        }
    }
    Ok(())
}

/// Finds how the condition of each property of a module is met, with all its inputs free. The folder holds the card with cover statements.
fn met(folder: &Path, design: &Design, block: &Block) -> Result<Vec<Met>, CommandError> {
    let (module, properties) = (block.module, &block.properties);
    let inside = module.instances.iter().map(|i| &design.modules[i.module]);
    let inside: BTreeSet<&str> = inside.map(|m| m.name.as_str()).collect();
    let inside: Vec<&str> = inside.into_iter().collect();
    let harness = harness::artifact(module, design.has_initial_values);
    endat_console::artifact::write(folder, std::slice::from_ref(&harness), scratch::REMEDY)?;
    let read = inside.iter().copied().chain([module.name.as_str()]);
    let mut files: Vec<String> = read.map(rtl_design::verilog::file_name).collect();
    files.push(harness.path);
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let first = usize::from(!design.has_initial_values);
    let mut found = vec![Met::Never; properties.len()];
    let runs = [
        (Begins::AtStart, false, first..first + RUN_CYCLES, Met::Run),
        // By then the registers have lost what only a false start can have left.
        (Begins::AtStart, true, SETTLED..SETTLED + 2, Met::State),
        (
            Begins::Anywhere,
            true,
            first..first + super::ANYWHERE_CYCLES,
            Met::Run,
        ),
    ];
    for (begins, is_free, steps, how) in runs {
        let is_open = |(n, p): (usize, &Property)| p.begins == begins && found[n] == Met::Never;
        if !properties.iter().enumerate().any(is_open) {
            continue;
        }
        let model = tools::cover_model(folder, &files, begins, is_free, &inside)?;
        let steps = format!("{}:{}", steps.start, steps.end);
        for label in tools::reached(folder, &model, &steps)? {
            if let Some(n) = own(properties, &label) {
                if properties[n].begins == begins {
                    found[n] = found[n].min(how);
                }
            }
        }
    }
    Ok(found)
}

/// Finds the property by the path of its own assertion. Conditions of its other assertions need not be met.
fn own(properties: &[Property], path: &str) -> Option<usize> {
    let label = path.rsplit('.').next();
    properties
        .iter()
        .position(|p| Some(p.name.as_str()) == label)
}

/// Replaces each assertion of a text by an assumption and a cover statement of its condition.
pub(super) fn covers(text: &str) -> String {
    let mut done = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("assert (") {
        let begin = label_begin(&rest[..at]);
        let body = at + "assert (".len();
        let end = body + closing(&rest[body..]);
        let (label, said) = (&rest[begin..at], &rest[body..end]);
        done.push_str(&rest[..begin]);
        done.push_str(&format!(
            "begin assume ({said}); {label}cover ({}); end",
            condition(said)
        ));
        rest = &rest[end..];
        rest = rest.strip_prefix(");").unwrap_or(rest);
    }
    done + rest
}

/// The place of the label at the end of this text; the assertion comes next.
fn label_begin(before: &str) -> usize {
    let head = before.trim_end();
    let macro_begin = head.strip_suffix(')').and_then(|h| h.rfind('`'));
    let name = head.trim_end_matches(':');
    let name_begin = name.rfind(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    macro_begin.unwrap_or(name_begin.map_or(0, |n| n + 1))
}

/// The place of the parenthesis that closes the one before this text.
fn closing(text: &str) -> usize {
    let mut depth = 1;
    let place = text.char_indices().find(|(_, c)| {
        depth += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        depth == 0
    });
    place.map_or(text.len(), |(at, _)| at)
}

/// The condition under which an assertion claims something. An assertion begins with negated terms that name it, or is always claimed.
fn condition(said: &str) -> String {
    let terms = terms(said);
    let excepted = terms.iter().take_while(|term| term.starts_with('!'));
    // The last term is what is claimed.
    let excepted = excepted.take(terms.len() - 1);
    let met: Vec<String> = excepted.map(|term| format!("!({term})")).collect();
    match met.is_empty() {
        true => "1'b1".into(),
        false => met.join(" & "),
    }
}

/// The terms of `a | b | c`, or `a || b`.
fn terms(said: &str) -> Vec<&str> {
    let (mut depth, mut begin, mut found) = (0, 0, vec![]);
    let bytes = said.as_bytes();
    for (at, byte) in bytes.iter().enumerate() {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth -= 1,
            // A choice binds less.
            b'?' if depth == 0 => return vec![said.trim()],
            b'|' if depth == 0 && said[at..].starts_with("| ") => {
                found.push(said[begin..at].trim_end_matches('|').trim());
                begin = at + 1;
            }
            _ => {}
        }
    }
    found.push(said[begin..].trim());
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_is_what_an_assertion_excepts() {
        for (said, met) in [
            ("a", "1'b1"),
            ("!a", "1'b1"),
            ("!a | b", "!(!a)"),
            ("!a || b && |c", "!(!a)"),
            ("!a | !b", "!(!a)"),
            ("!(a | b) | !c[2:0] | (d | e)", "!(!(a | b)) & !(!c[2:0])"),
            ("!a & b | c", "!(!a & b)"),
            ("a | !b", "1'b1"),
            ("!a ? b : c | d", "1'b1"),
        ] {
            assert_eq!(condition(said), met, "{said}");
        }
    }

    #[test]
    fn an_assertion_is_granted_and_its_condition_covered() {
        let text = "if (x) `FORMAL_LABEL(a) assert (!y | f(z));\nelse b: assert (\n w);\n";
        assert_eq!(
            covers(text),
            "if (x) begin assume (!y | f(z)); `FORMAL_LABEL(a) cover (!(!y)); end\nelse begin assume (\n w); b: cover (1'b1); end\n"
        );
    }
}
