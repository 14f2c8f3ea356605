//! Words of the documentation: habits that a reader stumbles over are refused, each with its rewrite.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Words in a row, in lower case, and the rewrite. A hyphen belongs to its word: a stand-in is no `stand`.
const HABITS: [(&[&str], &str); 12] = [
    (&["is", "told"], TOLD),
    (&["are", "told"], TOLD),
    (&["stand"], STANDS),
    (&["stands"], STANDS),
    (
        &["of", "its", "own"],
        "write \"its own X\" or \"a separate X\"",
    ),
    (
        &["of", "their", "own"],
        "write \"their own X\" or \"separate X\"",
    ),
    (
        &["behind"],
        "write \"after\" (time), \"following\" (bits) or \"downstream of\" (logic)",
    ),
    (&["beside"], "write \"next to\" or \"in addition to\""),
    (&["there", "is"], THERE),
    (&["there", "are"], THERE),
    (&["is", "there"], THERE),
    (&["are", "there"], THERE),
];
const TOLD: &str =
    "write \"reports\", \"prints\", \"returns error X\" or \"is shown in register Y\"";
const STANDS: &str =
    "write \"is in\", \"holds\", \"tolerates\", \"is stored at\" or \"remains valid\"";
const THERE: &str = "name what has it: \"the card has X\"; \"an installed tool\"";
/// Rewrite of a sentence that begins with "What".
const WHAT: &str = "name the subject: \"Absent fields read 0\", not \"What is absent reads 0\"";

/// Pages that a command writes whole; their words are in its sources.
const WRITTEN: [(&str, &str); 5] = [
    ("docs/comparison.md", "endat-workshop bench comparison"),
    ("docs/mutants.md", "endat-workshop page"),
    ("docs/proofs.md", "prove --page"),
    ("docs/reliability.md", "endat-workshop page"),
    (
        "docs/works-with.md",
        "tests/strangers/table.toml: names and claims of its tests",
    ),
];
/// Habits that stay: page, beginning of the line, reason. Each must occur.
const EXCEPTIONS: [(&str, &str, &str); 5] = [
    ("docs/size.md", "| the card behind APB3", AREA),
    ("docs/size.md", "| the same behind Wishbone", AREA),
    ("docs/size.md", "| the same behind AXI4-Lite", AREA),
    ("docs/size.md", "| the same behind SPI", AREA),
    ("docs/size.md", "| the same behind the parallel bus", AREA),
];
const AREA: &str = "tests/pages.rs finds the row by this name";

/// Words of a text in lower case, without punctuation.
fn words(text: &str) -> Vec<String> {
    let is_in_word = |c: char| c.is_alphanumeric() || c == '-' || c == '\'';
    let words = text.split(|c| !is_in_word(c)).filter(|w| !w.is_empty());
    words.map(str::to_lowercase).collect()
}

/// A line without its code.
fn prose(line: &str) -> String {
    line.split('`').step_by(2).collect::<Vec<_>>().join("`")
}

/// True if a sentence, a cell or an item of a list begins with "What".
fn begins_with_what(line: &str) -> bool {
    let ends = [". ", "? ", "! ", ": ", "| "];
    line.match_indices("What ").any(|(at, _)| {
        let before = line[..at].replace('*', "");
        let is_first = before.trim_matches(['-', '#', '>', ' ']).is_empty();
        is_first || ends.iter().any(|end| before.ends_with(end))
    })
}

/// Lines with a habit: number, line, rewrite. Code and tables that are written from data are left out.
fn habits(text: &str) -> Vec<(usize, &str, &str)> {
    let (mut found, mut is_code, mut is_written) = (vec![], false, false);
    for (number, line) in (1..).zip(text.lines()) {
        if line.starts_with("```") {
            is_code = !is_code;
        }
        // The line above such a table names the command that writes it.
        is_written = line.starts_with("<!--") || (is_written && line.starts_with('|'));
        if is_code || is_written {
            continue;
        }
        let prose = prose(line);
        let all = words(&prose);
        for (habit, rewrite) in HABITS {
            if all.windows(habit.len()).any(|words| words == habit) {
                found.push((number, line, rewrite));
            }
        }
        if begins_with_what(&prose) {
            found.push((number, line, WHAT));
        }
    }
    found
}

/// Pages that people write, with their text.
fn pages() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = fs::read_dir(root.join("docs")).unwrap();
    let docs = docs.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = docs
        .filter(|name| name.ends_with(".md"))
        .map(|name| format!("docs/{name}"))
        .filter(|name| WRITTEN.iter().all(|(page, _)| page != name))
        .collect();
    names.extend(["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md"].map(str::to_owned));
    names.sort();
    let read = |name: String| {
        let text = fs::read_to_string(root.join(&name)).unwrap();
        (name, text)
    };
    names.into_iter().map(read).collect()
}

/// Catches new text with a habit of the guide, and an exception that is no longer needed.
#[test]
fn pages_have_no_habit_that_readers_stumble_over() {
    let pages = pages();
    assert!(pages.len() > 25, "only {} pages found", pages.len());
    let mut unused: BTreeSet<_> = EXCEPTIONS.iter().collect();
    let mut told = vec![];
    for (page, text) in &pages {
        for (number, line, rewrite) in habits(text) {
            let is_it = |(of, begin, _): &(&str, &str, &str)| of == page && line.starts_with(begin);
            match EXCEPTIONS.iter().find(|row| is_it(row)) {
                Some(row) => {
                    unused.remove(row);
                }
                None => told.push(format!("{page}:{number}: {rewrite}\n    {line}")),
            }
        }
    }
    assert!(told.is_empty(), "\n{}", told.join("\n"));
    assert!(unused.is_empty(), "take off the list: {unused:#?}");
}

/// Catches a check that finds nothing: each habit in a sentence, and sentences that only look like one.
#[test]
fn each_habit_is_found_and_code_is_left_alone() {
    for text in [
        "The cause is told by the card.",
        "| a | errors are told |",
        "Registers stand in a table.",
        "The position\nstands.",
        "a counter of its own",
        "Channels of their own.",
        "- the bit Behind it",
        "a host beside the card",
        "There is a register.",
        "There are two.",
        "a tool that is there",
        "What the card lacks reads 0.",
        "- **What** it is. What comes next",
        "**Note.** What a card lacks reads 0.",
        "| a | What it is |",
    ] {
        assert_eq!(habits(text).len(), 1, "{text}: {:?}", habits(text));
    }
    for text in [
        "tested with stand-ins",
        "the key `behind` is code",
        "```\nstands behind it\n```",
        "<!-- From the table -->\n| it stands behind |\n| beside |",
        "what it stores, and whatever comes",
        "Whatever comes is stored.",
    ] {
        assert!(habits(text).is_empty(), "{text}: {:?}", habits(text));
    }
    // The table ends where its rows do.
    let text = "<!-- From the table -->\n| it stands |\n\nbeside";
    assert_eq!(habits(text).len(), 1);
}
