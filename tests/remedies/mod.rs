//! Every remedy of every message is one that the same command accepts: a walk over the mistakes that people make, and what the messages advise.

mod document;
mod follow;
mod mistakes;
mod usage;

use crate::bases::BASES;
use document::Document;
use endat_config::parse_any;
use endat_config::{preset, PRESETS, RECEIVER_PRESETS};
use endat_console::error::Diagnostic;
use std::collections::{BTreeMap, BTreeSet};

/// Forms of words that a walk must have met.
const FORMS: [&str; 19] = [
    "add a key",
    "add a part",
    "another system clock",
    "choose a value in that range",
    "choose another bus",
    "did you mean",
    "it belongs to",
    "known keys here",
    "leave it out",
    "leave that out",
    "must be of a type",
    "remove one",
    "remove the table",
    "set a key",
    "to a number",
    "use one of",
    "use a range",
    "write a key",
    "write one table",
];

/// A message without its numbers and quoted words.
fn kind(text: &str) -> String {
    let mut kind = String::new();
    let mut is_quoted = false;
    for c in text.chars() {
        match c {
            '"' => is_quoted = !is_quoted,
            _ if is_quoted => continue,
            c if c.is_ascii_digit() => {
                if !kind.ends_with('#') {
                    kind.push('#');
                }
                continue;
            }
            _ => {}
        }
        kind.push(c);
    }
    kind
}

/// Subject and problem of a message, without the remedy.
fn complaint(text: &str) -> (String, String) {
    let (subject, rest) = text.split_once(": ").unwrap_or(("", text));
    let path = subject.split(" = ").next().unwrap_or_default();
    let problem = rest.rsplit_once("; ").map_or(rest, |(problem, _)| problem);
    (path.to_owned(), kind(problem))
}

fn read(document: &Document) -> Vec<Diagnostic> {
    parse_any("card.toml", &document.text())
        .err()
        .unwrap_or_default()
}

/// The counts and findings of a walk.
#[derive(Default)]
struct Walk {
    /// How often a remedy of each form of words was followed.
    forms: BTreeMap<&'static str, usize>,
    /// How often a message of each kind was followed.
    kinds: BTreeMap<String, usize>,
    wrong: Vec<String>,
    mistakes: usize,
}

impl Walk {
    /// Whether the remedies of what is wrong still, followed one after the other, lead to a good file.
    fn ends(document: &Document, steps: usize) -> bool {
        let told = read(document);
        let Some(first) = told.first() else {
            return true;
        };
        let Some(steps) = steps.checked_sub(1) else {
            return false;
        };
        let Ok(done) = follow::remedies(document, first) else {
            return false;
        };
        // Only a person knows.
        if done.is_empty() {
            return true;
        }
        // The first thing that helps, of all but the first few steps.
        let documents = done.into_iter().flat_map(|done| done.documents);
        let helps = documents.filter(|d| !still(first, d, document));
        let mut some = helps.take(if steps > 37 { 2 } else { 1 });
        some.any(|next| Self::ends(&next, steps))
    }

    /// Follows every remedy of a message.
    fn follow(&mut self, document: &Document, told: &Diagnostic) {
        let done = match follow::remedies(document, told) {
            Ok(done) => done,
            Err(unknown) => return self.wrong.push(format!("not understood: {unknown}")),
        };
        for done in done {
            *self.forms.entry(done.form).or_default() += 1;
            let good: Vec<&Document> = match done.must_each {
                true => done.documents.iter().collect(),
                // The first that helps.
                false => {
                    let mut all = done.documents.iter();
                    all.find(|d| !still(told, d, document))
                        .into_iter()
                        .collect()
                }
            };
            let bad = match good.is_empty() {
                true => done.documents.last(),
                false => good.iter().find(|d| still(told, d, document)).copied(),
            };
            if good.is_empty() || bad.is_some() {
                let again: Vec<String> = bad.iter().flat_map(|d| read(d)).map(|d| d.text).collect();
                let told = format!(
                    "{:?}: {}\n    then {}",
                    done.form,
                    told.text,
                    again.join("\n         ")
                );
                self.wrong.push(told);
                continue;
            }
            let ends = good.iter().all(|d| Self::ends(d, 40));
            if !ends {
                let next: Vec<String> = good.iter().flat_map(|d| read(d)).map(|d| d.text).collect();
                self.wrong.push(format!(
                    "{:?} leads nowhere: {}\\n    then {}",
                    done.form,
                    told.text,
                    next.join("\\n         ")
                ));
            }
        }
    }

    /// Makes every mistake in a base, and follows messages, each kind of them so often at most.
    fn walk(&mut self, documents: impl IntoIterator<Item = Document>, often: usize) {
        for document in documents {
            self.mistakes += 1;
            for told in read(&document) {
                let (path, problem) = match told.text.strip_prefix("not TOML: ") {
                    // The remedy tells one problem of a line from another.
                    Some(rest) => ("not TOML".to_owned(), kind(rest)),
                    None => complaint(&told.text),
                };
                let path = path.rsplit('.').next().unwrap_or_default().to_owned();
                let seen = self.kinds.entry(format!("{path}: {problem}")).or_default();
                *seen += 1;
                if *seen <= often {
                    self.follow(&document, &told);
                }
            }
        }
    }
}

/// Whether a file is still refused for the same reason; of a list, for the same item.
fn still(told: &Diagnostic, now: &Document, before: &Document) -> bool {
    let was = complaint(&told.text);
    let is_list = before
        .get(&was.0)
        .is_some_and(|value| value.starts_with('['));
    let item = |text: &str| text.split(": ").next().unwrap_or_default().to_owned();
    let is_same = |now: &Diagnostic| {
        complaint(&now.text) == was && (!is_list || item(&now.text) == item(&told.text))
    };
    read(now).iter().any(is_same)
}

fn check(walk: &Walk, kinds: usize) {
    assert!(
        walk.wrong.is_empty(),
        "{} wrong:\n{}",
        walk.wrong.len(),
        walk.wrong.join("\n")
    );
    // A walk that finds no mistakes finds no wrong remedies.
    assert!(walk.kinds.len() >= kinds, "{} kinds", walk.kinds.len());
    for form in FORMS {
        assert!(
            walk.forms.contains_key(form),
            "no remedy says {form}: {:?}",
            walk.forms
        );
    }
}

/// Catches a message whose remedy the program refuses with the same message, whose remedies lead round in a circle, or that has none.
#[test]
fn remedies_of_configurations_are_accepted() {
    let mut walk = Walk::default();
    let mut seen = BTreeSet::new();
    for base in BASES.map(Document::new) {
        walk.walk(mistakes::all(&base, Some(&mut seen)), 1);
    }
    println!(
        "{} mistakes, {} kinds, {:?}",
        walk.mistakes,
        walk.kinds.len(),
        walk.forms
    );
    check(&walk, 250);
}

/// Catches a remedy without a pin in it for a board that has run out of pins.
#[test]
fn board_with_too_few_pins_is_refused_with_boards_that_have_enough() {
    let few = BASES
        .iter()
        .find(|text| text.contains("icebreaker"))
        .unwrap();
    let document = Document::new(&few.replace("\"spi\"", "\"parallel\""));
    let told = read(&document);
    assert_eq!(told.len(), 1, "{told:?}");
    let wanted = "has 19 free pins for 22 signals without a usual pin, 3 too few; use one of ";
    assert!(told[0].text.contains(wanted), "{told:?}");
    let mut walk = Walk::default();
    walk.follow(&document, &told[0]);
    assert_eq!(walk.wrong, [""; 0]);
    assert_eq!(walk.forms.len(), 2, "{:?}", walk.forms);
}

#[test]
#[ignore = "slow: every mistake in every preset, beside seven system clocks"]
fn remedies_of_all_mistakes_are_accepted() {
    let presets = PRESETS.iter().chain(RECEIVER_PRESETS);
    let presets = presets.map(|(name, _)| preset(name).unwrap());
    let mut walk = Walk::default();
    for base in BASES.into_iter().chain(presets).map(Document::new) {
        walk.walk(mistakes::all(&base, None), 20);
    }
    println!(
        "{} mistakes, {} kinds, {:?}",
        walk.mistakes,
        walk.kinds.len(),
        walk.forms
    );
    check(&walk, 500);
}
