//! Options of all commands: what a command answers to a value that it does not take, and whether it takes what it asks for instead.
//!
//! No command runs here: beside the option in question stands a stopper, an argument that is refused in any case, and later than the option.

use super::kind;
use crate::program::run;
use clap::{Arg, Command};
use endat_gen::cli::command_line;
use std::any::TypeId;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Arguments that no command takes.
const STOPPERS: [&str; 8] = [
    "--config=/no/such/file.toml",
    "--port=/no/such/port",
    "--preset=no_such_preset",
    "--seed=no_number",
    "--board=no_such_board",
    "--threads=no_number",
    "--x=no_quantity",
    "--name=1 2",
];

/// Values that hardly any option takes.
const WRONG: [&str; 5] = ["no such word", "-1", "99999999999999999999999", "0", "1e9"];

/// Options whose values have nothing to do with their words: names, and text of any kind.
const FREE: [&str; 5] = ["name", "out", "encoder", "host", "token"];

/// All commands that do something, by their words.
fn commands(command: &Command, words: &[String]) -> Vec<(Vec<String>, Command)> {
    let below = command.get_subcommands().filter(|c| c.get_name() != "help");
    let below: Vec<_> = below
        .flat_map(|c| commands(c, &[words, &[c.get_name().to_owned()]].concat()))
        .collect();
    match below.is_empty() {
        true => vec![(words.to_vec(), command.clone())],
        false => below,
    }
}

/// The messages of a run with these arguments.
fn told(words: &[String], more: &[String]) -> String {
    let all: Vec<&str> = words.iter().chain(more).map(String::as_str).collect();
    let outcome = run(&all);
    assert_eq!(outcome.exit_code, 2, "{all:?} runs: {outcome:?}");
    outcome.messages.join("\n")
}

/// Values that a message asks for; none if it says it in other words.
fn wanted(told: &str, option: &str) -> Option<(&'static str, Vec<String>)> {
    let numbers = |text: &str| -> Vec<String> {
        let is_digit = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
        let words = text
            .split(|c: char| !is_digit(c))
            .map(|w| w.trim_matches('.'));
        words
            .filter(|w| w.chars().any(|c| c.is_ascii_digit()))
            .map(str::to_owned)
            .collect()
    };
    let list = |text: &str| -> Vec<String> {
        let text = text.replace(" or ", ", ");
        let words = text
            .split(", ")
            .map(|w| w.trim().trim_matches('"').to_owned());
        words
            .filter(|w| !w.is_empty() && !w.contains(' '))
            .collect()
    };
    let line = told.lines().find(|line| line.contains(option))?;
    let between = |text: &str, low: &str, high: &str| -> Option<Vec<String>> {
        let (_, rest) = text.split_once(low)?;
        Some(numbers(&rest.split(';').next()?.replacen(high, " ", 1)))
    };
    if let Some((_, words)) = told.split_once("[possible values: ") {
        return Some(("possible values", list(words.split(']').next()?)));
    }
    if let Some((_, range)) = line.split_once(" is not in ") {
        return Some(("is not in", numbers(&range.replacen("..=", " ", 1))));
    }
    if line.ends_with("; give a number in that range") {
        return Some(("outside", between(line, ": outside ", "..")?));
    }
    if let Some((_, example)) = line.split_once("; ").and_then(|(_, r)| {
        r.split_once("for example, ")
            .or(r.split_once("for example "))
    }) {
        let word = example.split([' ', ';']).next()?;
        return Some(("for example", vec![word.to_owned()]));
    }
    if let Some((problem, examples)) = line.split_once("; write ") {
        let ends = between(problem, " from ", " to ");
        return Some(("is not a number", ends.unwrap_or_else(|| list(examples))));
    }
    let remedy = line.rsplit_once("; ")?.1;
    if let Some(near) = remedy.strip_prefix("did you mean ") {
        return Some(("did you mean", vec![near.trim_end_matches('?').to_owned()]));
    }
    for begin in [
        "known presets: ",
        "known boards: ",
        "known flows: ",
        "known causes: ",
        "use one of ",
        "one of ",
        "use ",
        "give ",
    ] {
        if let Some(words) = remedy.strip_prefix(begin) {
            let words = words.split(", or give ").next()?;
            return Some(("a list", list(words)));
        }
    }
    None
}

/// The problem of an option, without value and remedy.
fn problem(told: &str, option: &str) -> Option<String> {
    let is_it =
        |line: &&str| line.contains(&format!("{option} ")) || line.contains(&format!("{option}:"));
    let line = told.lines().find(is_it)?;
    let (_, rest) = line.split_once(": ").unwrap_or(("", line));
    Some(rest.split("; ").next().unwrap_or_default().to_owned())
}

/// Catches a limit or a word that a message names and the option refuses.
#[test]
fn remedies_of_options_are_accepted() {
    let mut forms: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut followed, mut unknown, mut wrong) = (0, vec![], vec![]);
    for (words, command) in commands(&command_line(), &[]) {
        let is_path = |arg: &Arg| arg.get_value_parser().type_id() == TypeId::of::<PathBuf>();
        let options: Vec<&Arg> = command
            .get_arguments()
            .filter(|a| a.get_long().is_some() && a.get_action().takes_values())
            .collect();
        let has = |stopper: &&str| {
            options
                .iter()
                .any(|o| stopper.starts_with(&format!("--{}=", o.get_long().unwrap_or_default())))
        };
        let needed = command
            .get_arguments()
            .filter(|a| a.is_required_set() && a.get_long().is_none());
        let needed: Vec<String> = needed.map(|_| "/no/such/thing".to_owned()).collect();
        for option in options
            .iter()
            .filter(|o| !is_path(o) && !FREE.contains(&o.get_long().unwrap_or_default()))
        {
            let name = format!("--{}", option.get_long().unwrap_or_default());
            for value in WRONG {
                let bad = format!("{name}={value}");
                // One that is refused later.
                let stoppers = STOPPERS
                    .iter()
                    .filter(|s| has(s) && !s.starts_with(&format!("{name}=")));
                let found = stoppers.filter_map(|stopper| {
                    let with = |option: &str| {
                        let port = ["--port=/no/such/port".to_owned()];
                        let needs_port = options
                            .iter()
                            .any(|o| o.get_long() == Some("port") && o.is_required_set())
                            && !stopper.starts_with("--port")
                            && name != "--port";
                        let more = [option.to_owned(), (*stopper).to_owned()];
                        let more = match needs_port {
                            true => [&needed[..], &more[..], &port[..]].concat(),
                            false => [&needed[..], &more[..]].concat(),
                        };
                        told(&words, &more)
                    };
                    let told = with(&bad);
                    let is_of_it =
                        told.contains(&format!("{name} ")) || told.contains(&format!("{name}:"));
                    // The parser of the command line looks at all arguments together.
                    let is_of_both = told.contains("cannot be used with")
                        || told.contains("arguments were not provided");
                    (is_of_it && !is_of_both)
                        .then(|| (told, Box::new(with) as Box<dyn Fn(&str) -> String>))
                });
                let Some((told, with)) = found.into_iter().next() else {
                    continue;
                };
                match wanted(&told, &name) {
                    Some((form, values)) if !values.is_empty() => {
                        *forms.entry(form).or_default() += 1;
                        followed += 1;
                        for value in values {
                            let again = with(&format!("{name}={value}"));
                            if problem(&again, &name) == problem(&told, &name) {
                                wrong.push(format!(
                                    "{words:?} {bad}: {told}\n    then {name}={value}: {again}"
                                ));
                            }
                        }
                    }
                    _ => unknown.push(format!("{words:?} {bad}: {told}")),
                }
            }
        }
    }
    wrong.dedup_by_key(|w| kind(w));
    unknown.dedup_by_key(|w| kind(w));
    println!("{followed} followed, {forms:?}");
    assert!(
        wrong.is_empty(),
        "{} wrong:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
    assert!(
        unknown.is_empty(),
        "{} not understood:\n{}",
        unknown.len(),
        unknown.join("\n")
    );
    assert!(followed > 100, "{followed}");
}
