//! Remedies of `new` for a bus and a board that do not go together: each has been tried.

use super::complete::{complete, useless};
use super::questions::{buses_of_boards, Answers, NO_BOARD};
use endat_config::board::{self, Board};
use endat_config::form::key::head;
use endat_config::keys::CHANNELS;

/// True if `new` accepts these answers.
fn is_accepted(given: &Answers) -> bool {
    complete(given).is_ok_and(|all| useless(given, &all).is_none())
}

/// The options for board, bus and channels that `new` accepts in the place of those that are given.
pub fn use_another(given: &Answers, all: &Answers) -> String {
    let accepted = |option: &'static str, values: Vec<String>, most: usize| {
        let goes = |value: &String| {
            let mut changed = given.clone();
            changed.insert(option, value.clone());
            all.get(option) != Some(value) && is_accepted(&changed)
        };
        let good: Vec<String> = values.into_iter().filter(goes).take(most).collect();
        (!good.is_empty()).then(|| format!("--{option} {}", good.join(", ")))
    };
    let words = |words: Vec<&str>| words.into_iter().map(str::to_owned).collect();
    // A card inside a chip has none.
    let may_have_board = all.contains_key("board");
    let boards = board::names().into_iter().filter(|_| may_have_board);
    let boards = [NO_BOARD].into_iter().chain(boards).collect();
    let channels = all.get("channels").and_then(|told| told.parse().ok());
    let fewer = (1..channels.unwrap_or(1))
        .rev()
        .map(|n: usize| n.to_string());
    let found = [
        accepted("board", words(boards), usize::MAX),
        accepted("bus", words(buses_of_boards()), usize::MAX),
        // The highest number.
        accepted("channels", fewer.collect(), 1),
    ];
    let found: Vec<String> = found.into_iter().flatten().collect();
    match found.is_empty() {
        true => "leave --board out".to_owned(),
        false => format!("use {}", found.join(", or ")),
    }
}

/// A complaint about the number of channels, with options in its remedy.
pub fn of_channels(given: &Answers, all: &Answers, complaint: &str) -> Option<String> {
    let told = given.get("channels")?;
    let (_, rest) = complaint.split_once(&format!("{}: ", head(CHANNELS)))?;
    let problem = rest.rsplit_once("; ").map_or(rest, |(what, _)| what);
    let remedy = use_another(given, all);
    Some(format!("--channels = {told}: {problem}; {remedy}"))
}

/// True if a complaint of the configuration is about what the board has, not about its name.
pub fn is_of_board(all: &Answers, complaint: &str) -> bool {
    let is_known = |name: &String| Board::named(name).is_ok();
    all.get("board").is_some_and(is_known) && complaint.starts_with("board.name = ")
}

/// Such a complaint with options in its remedy.
pub fn of_board(given: &Answers, all: &Answers, complaint: &str) -> String {
    let name = all.get("board").map_or("", String::as_str);
    let problem = complaint.split_once(": ").map_or("", |(_, rest)| rest);
    let problem = problem.rsplit_once("; ").map_or(problem, |(what, _)| what);
    format!("--board = {name}: {problem}; {}", use_another(given, all))
}
