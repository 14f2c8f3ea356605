//! Answers to all questions, from those that are given.

use super::questions::{Answers, Question, NO_BOARD, QUESTIONS};
use super::text;
use endat_config as config;
use endat_console::error::Diagnostic;
use std::collections::BTreeMap;

/// Answers that give no configuration.
pub enum Wrong {
    /// An answer that is wrong by itself.
    Answer(Vec<String>),
    /// All answers, and what is wrong with the configuration that they make.
    Configuration(Answers, Vec<Diagnostic>),
}

/// All answers: those that are given, and usual ones that go with them; or what is wrong with those that are given.
pub fn complete(given: &Answers) -> Result<Answers, Wrong> {
    // Which of the usual ones; the next one where one does not go with the rest.
    let mut tried: BTreeMap<&str, usize> = BTreeMap::new();
    for question in QUESTIONS.iter().filter(|q| given.contains_key(q.name)) {
        if given[question.name].is_empty() {
            if question.may_be_empty() {
                continue;
            }
            let usual = (question.usual)(&Answers::new()).swap_remove(0);
            return Err(Wrong::Answer(vec![format!(
                "--{0} = \"\": is empty; give --{0} {usual}, or leave --{0} out",
                question.name
            )]));
        }
        let literal = text::literal(question.of, &question.option(given), &given[question.name]);
        literal.map_err(|error| Wrong::Answer(error.messages().to_vec()))?;
    }
    loop {
        let mut all = Answers::new();
        let mut left: Vec<&Question> = Vec::new();
        for question in QUESTIONS {
            // Some keys are asked about one protocol, and taken for others.
            let is_taken = given.contains_key(question.name) && question.fits(&all);
            if !(question.is_asked)(&all) && !is_taken {
                continue;
            }
            let usual = (question.usual)(&all);
            let at = tried.get(question.name).copied().unwrap_or(0);
            let answer = match given.get(question.name) {
                Some(answer) => answer.clone(),
                None => usual.get(at).cloned().unwrap_or_default(),
            };
            if !given.contains_key(question.name) && at + 1 < usual.len() {
                left.push(question);
            }
            all.insert(question.name, answer);
        }
        let wrong = match config::parse_any("new", &text::written(&all)) {
            Ok(_) => return Ok(all),
            Err(wrong) => wrong,
        };
        let is_about = |q: &&Question| {
            let path = q.path(&all);
            wrong.iter().any(|one| one.text.starts_with(&path))
        };
        let is_named = |q: &&Question| {
            let path = q.path(&all);
            let key = path.rsplit('.').next().unwrap_or_default();
            wrong.iter().any(|one| one.text.contains(key))
        };
        let next = left.iter().copied().find(is_about);
        let Some(next) = next.or_else(|| left.iter().copied().find(is_named)) else {
            return Err(Wrong::Configuration(all, wrong));
        };
        *tried.entry(next.name).or_default() += 1;
    }
}

/// An option that nothing is asked about, with its value.
pub fn useless<'g>(given: &'g Answers, all: &Answers) -> Option<(&'g &'static str, &'g String)> {
    // A card that no board can have has none.
    let says_something = |name: &str, told: &str| name != "board" || told != NO_BOARD;
    let mut useless = (given.iter())
        .filter(|(name, told)| !all.contains_key(*name) && says_something(name, told));
    useless.next()
}
