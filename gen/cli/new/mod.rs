//! `new`: asks a few questions, and writes a configuration with every key explained.

mod complete;
mod questions;
mod remedies;
mod text;

use super::work::say;
use super::Outcome;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use complete::{complete, useless, Wrong};
use endat_console::error::{shown, CommandError, Diagnostic};
use questions::{has_turns_apart, Answers, Of, Question, QUESTIONS};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// In the place of a file's name: the text goes to stdout.
const STDOUT: &str = "-";

/// Arguments of `new`: an option for each question, described by the key that it is about.
pub struct NewArgs {
    file: Option<PathBuf>,
    force: bool,
    yes: bool,
    given: Answers,
}

impl Args for NewArgs {
    fn augment_args(command: Command) -> Command {
        let file = Arg::new("file")
            .value_name("FILE")
            .value_parser(clap::value_parser!(PathBuf))
            .help("Write this file; - writes to stdout [default: the name, with .toml]");
        let flag = |name: &'static str, short: Option<char>, help: &'static str| {
            let flag = Arg::new(name).long(name).short(short);
            flag.action(ArgAction::SetTrue).help(help)
        };
        let options = QUESTIONS.iter().map(|question| {
            Arg::new(question.name)
                .long(question.name)
                .value_name("VALUE")
                .allow_negative_numbers(true)
                .help(question.about())
        });
        command
            .arg(file)
            .arg(flag("force", None, "Replace the file if it is there"))
            .arg(flag(
                "yes",
                'y'.into(),
                "Ask nothing: what no option says is as usual",
            ))
            .args(options)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for NewArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let said = |q: &Question| Some((q.name, matches.get_one::<String>(q.name)?.clone()));
        Ok(Self {
            file: matches.get_one::<PathBuf>("file").cloned(),
            force: matches.get_flag("force"),
            yes: matches.get_flag("yes"),
            given: QUESTIONS.iter().filter_map(said).collect(),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// All answers: those that are given, and usual ones that go with them; or the messages about those that are given.
fn completed(given: &Answers) -> Result<Answers, Vec<String>> {
    complete(given).map_err(|wrong| match wrong {
        Wrong::Answer(messages) => messages,
        Wrong::Configuration(all, wrong) => {
            let is_of_board = |one: &&Diagnostic| remedies::is_of_board(&all, &one.text);
            let (of_board, others): (Vec<_>, Vec<_>) = wrong.iter().partition(is_of_board);
            match others.is_empty() {
                true => (of_board.iter())
                    .map(|one| remedies::of_board(given, &all, &one.text))
                    .collect(),
                // No other board helps before these are right.
                false => (others.iter())
                    .map(|one| {
                        let of_channels = remedies::of_channels(given, &all, &one.text);
                        of_channels.unwrap_or_else(|| in_options(&one.text))
                    })
                    .collect(),
            }
        }
    })
}

/// A complaint whose remedy names options in the place of keys.
fn in_options(text: &str) -> String {
    let Some((what, remedy)) = text.rsplit_once("; ") else {
        return text.to_owned();
    };
    // There is no option for it.
    let remedy = remedy.split(", or write file = ").next().unwrap_or(remedy);
    let named = |word: &str| {
        let question = QUESTIONS.iter().find(|q| match q.of {
            Of::Key(key, _) => key.name == word && q.name.replace('-', "_") == word,
            Of::Channels => false,
        });
        question.map_or_else(|| word.to_owned(), |q| format!("--{}", q.name))
    };
    let words: Vec<String> = remedy.split(' ').map(named).collect();
    format!("{what}; {}", words.join(" "))
}

/// Asks until the answer goes with those before it.
fn ask(
    question: &Question,
    given: &mut Answers,
    usual: &str,
    lines: &mut dyn Iterator<Item = io::Result<String>>,
) -> Result<Answers, CommandError> {
    let mut stderr = io::stderr();
    let _ = writeln!(stderr, "{}: {}", question.name, question.about());
    for (word, means) in question.words() {
        let _ = writeln!(stderr, "    {word:<12} {means}");
    }
    loop {
        let _ = write!(stderr, "  [{usual}] ");
        let _ = stderr.flush();
        let line = match lines.next() {
            Some(Ok(line)) => line,
            Some(Err(error)) => {
                return Err(CommandError::input(format!(
                    "stdin: cannot read: {error}; give options instead"
                )))
            }
            None => {
                let _ = writeln!(stderr);
                return Err(CommandError::input(format!(
                    "{}: has no answer: standard input is at its end; answer with --{}, or take what is usual with --yes",
                    question.name, question.name
                )));
            }
        };
        let answer = match line.trim() {
            "" => usual,
            answer => answer,
        };
        given.insert(question.name, answer.to_owned());
        match completed(given) {
            Ok(all) => return Ok(all),
            Err(wrong) => {
                given.remove(question.name);
                wrong.iter().for_each(|text| say(text));
            }
        }
    }
}

/// Refuses an option that nothing is asked about.
fn check_asked(given: &Answers, all: &Answers) -> Result<(), CommandError> {
    useless(given, all).map_or(Ok(()), |(name, told)| {
        let bus = all.get("bus").map_or("", String::as_str);
        let protocol = all.get("protocol").map_or("", String::as_str);
        let (name_of, told) = (*name, shown(told));
        Err(CommandError::input(match name_of {
            "board" => format!(
                "--board = {told}: a card behind bus {bus} stays inside a chip, so it has no board top; {}",
                remedies::use_another(given, all)
            ),
            // Asked where it follows from nothing.
            "multi-turn-bits" if has_turns_apart(all) => format!(
                "--multi-turn-bits = {told}: positions of protocol {protocol} have unused bits above the angle, so its bits do not follow; give --single-turn-bits, too"
            ),
            _ => format!(
                "--{name_of} = {told}: a card with protocol {protocol} and bus {bus} has no such key; leave --{name_of} out"
            ),
        }))
    })
}

/// The commands that come next.
fn next(path: &Path) -> String {
    let file = path.display().to_string();
    let file = super::emit::quoted(&file);
    format!(
        "{}: written\nnext: endat-gen explain --config {file}    # what becomes of it\n      endat-gen emit --config {file}       # the files of the card\n",
        path.display()
    )
}

/// Runs the command.
pub fn run(arguments: &NewArgs) -> Result<Outcome, CommandError> {
    let mut given = arguments.given.clone();
    let mut all = completed(&given).map_err(CommandError::Input)?;
    check_asked(&given, &all)?;
    if !arguments.yes {
        let mut lines = io::stdin().lines();
        for question in QUESTIONS {
            if given.contains_key(question.name) || !(question.is_asked)(&all) {
                continue;
            }
            let usual = all.get(question.name).cloned().unwrap_or_default();
            all = ask(question, &mut given, &usual, &mut lines)?;
        }
        check_asked(&given, &all)?;
    }
    let text = text::written(&all);
    if arguments.file.as_deref() == Some(Path::new(STDOUT)) {
        return Ok(Outcome::good(text));
    }
    let path = match &arguments.file {
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.toml", all["name"])),
    };
    let remedy = "give another file, in a folder that is there";
    let made = match arguments.force {
        true => std::fs::File::create(&path),
        false => std::fs::File::create_new(&path),
    };
    let written = made.and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => CommandError::input(format!(
            "{}: is there already; give another file, or replace it with --force",
            path.display()
        )),
        _ => CommandError::io("write", &path, &error, remedy),
    })?;
    Ok(Outcome::good(next(&path)))
}
