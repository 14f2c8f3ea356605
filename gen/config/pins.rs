//! The board, and which port of its top is on which pin.

use super::keys::{BOARD_FILE, BOARD_NAME};
use super::reader::{Source, Table};
use crate::board::{self, Assignment, Board, Kind, OSCILLATOR_PORT};
use std::path::Path;

/// The board of a card, and where the configuration names it.
pub(super) struct OnBoard<'a, 's, 't> {
    pub board: &'a Board,
    /// `[board]`.
    pub table: &'a Table<'s, 't>,
    /// True if the option `--board` names the board in the place of the configuration.
    pub is_option: bool,
    /// The system clock in hertz, if its number is good.
    pub system_hz: Option<u64>,
}

impl OnBoard<'_, '_, '_> {
    /// Complains that the board has fewer free pins than the card has signals without a pin.
    fn complain_short(&self, ports: &[(String, Kind)], wanted: usize, free: usize) {
        let board = self.board;
        let fits = |name: &&str| {
            let other = Board::named(name);
            other.is_ok_and(|other| {
                let makes_clock = self.system_hz.is_none_or(|hz| other.pll(hz).is_ok());
                makes_clock && other.spare_places(ports).is_some()
            })
        };
        let others: Vec<&str> = board::names().into_iter().filter(fits).collect();
        let list = others.join(", ");
        let (subject, remedy) = match (self.is_option, &board.file) {
            (true, _) if others.is_empty() => {
                ("--board", "give a board's file with more pins".into())
            }
            (true, _) => ("--board", format!("use one of {list}")),
            (false, Some(_)) => (
                "board.file",
                "give its [connectors] more pins, or leave [board] out".into(),
            ),
            (false, None) if others.is_empty() => ("board.name", "leave [board] out".into()),
            (false, None) => (
                "board.name",
                format!("use one of {list}, or leave [board] out"),
            ),
        };
        let shown = match (self.is_option, &board.file) {
            (true, _) => board.name.clone(),
            (false, file) => format!("{:?}", file.as_ref().unwrap_or(&board.name)),
        };
        self.table.complain_plain(format!(
            "{subject} = {shown}: has {free} free pins for {wanted} signals without a usual pin, {} too few; {remedy}",
            wanted - free
        ));
    }
}

/// The pin of every port; complaints go to `source`.
pub(super) fn assign_pins(
    source: &Source<'_>,
    pins: &Table<'_, '_>,
    on: &OnBoard<'_, '_, '_>,
    ports: Vec<(String, Kind)>,
) -> Vec<Assignment> {
    let board = on.board;
    let moved = pins.free_strings();
    for (signal, at) in &moved {
        if !ports.iter().any(|(port, _)| port == signal) {
            let names: Vec<&str> = ports.iter().map(|(port, _)| port.as_str()).collect();
            let text = format!("no such signal; signals: {}", names.join(", "));
            pins.complain(at.line, signal, &format!("{:?}", at.value), &text);
        }
    }
    let words = ports.iter().map(|(signal, _)| {
        let user = moved.iter().find(|(s, _)| s == signal);
        user.map(|(_, at)| &at.value)
            .or_else(|| board.usual_place(signal))
    });
    let free = board.free_places(words.clone().flatten());
    let wanted = words.filter(Option::is_none).count();
    let is_short = wanted > free.len();
    if is_short {
        on.complain_short(&ports, wanted, free.len());
    }
    let mut next_free = free.iter();
    // Each complaint offers another pin.
    let mut spare = free.iter().skip(wanted);
    let mut all = vec![Assignment {
        signal: OSCILLATOR_PORT.into(),
        kind: Kind::Oscillator,
        pin: board.oscillator_pin.clone(),
        position: String::new(),
    }];
    for (signal, kind) in ports {
        let user = moved.iter().find(|(s, _)| *s == signal).map(|(_, at)| at);
        let Some(word) = user
            .map(|at| &at.value)
            .or_else(|| board.usual_place(&signal))
        else {
            let Some(place) = next_free.next().filter(|_| !is_short) else {
                continue;
            };
            let text = format!(
                "{}: {} has no usual pin for it; add, for example, `{signal} = \"{place}\"` to [pins]",
                pins.name(&signal),
                board.name
            );
            source.complain_line(pins.line, text);
            continue;
        };
        let line = user.map_or(pins.line, |at| at.line);
        let pin = match board.pin(word) {
            Ok(pin) => pin,
            Err(text) => {
                pins.complain(line, &signal, &format!("{word:?}"), &text);
                continue;
            }
        };
        if let Some(other) = all.iter().find(|a: &&Assignment| a.pin == pin) {
            // The one that the file has moved is the one to complain about, whichever comes first.
            let moved_other = moved
                .iter()
                .find(|(s, _)| *s == other.signal)
                .map(|(_, at)| at);
            let (mover, at, place) = match (user, moved_other) {
                (None, Some(at)) => (other.signal.as_str(), at.line, &at.value),
                _ => (signal.as_str(), line, word),
            };
            let taken = if mover == signal {
                &other.signal
            } else {
                &signal
            };
            let remedy = match spare.next() {
                Some(place) => {
                    format!("use another pin for one of the two, for example {place}")
                }
                None => "remove the key, or one of the other pins".into(),
            };
            let text = format!("{pin} already carries {taken}; {remedy}");
            pins.complain(at, mover, &format!("{place:?}"), &text);
            continue;
        }
        let position = board.position(&pin);
        all.push(Assignment {
            signal,
            kind,
            pin,
            position,
        });
    }
    all
}

/// The board that is asked for, by name or by file; `other` takes its place.
pub(super) fn read_board(
    source: &Source<'_>,
    table: &Table<'_, '_>,
    other: Option<&Board>,
) -> Option<Board> {
    if let Some(other) = other {
        table.know(&[&BOARD_NAME, &BOARD_FILE]);
        return Some(other.clone());
    }
    // The key counts as known even if it is absent: nobody can guess a file.
    table.know(&[&BOARD_FILE]);
    if table.has(BOARD_FILE.name) {
        let file = table.string(&BOARD_FILE)?;
        table.refuse(
            &BOARD_NAME,
            "file names a board, too; remove one of the two",
        );
        let folder = Path::new(source.file).parent().unwrap_or(Path::new(""));
        return match Board::from_file(&folder.join(&file.value)) {
            Ok(board) => Some(board),
            Err(wrong) => {
                source.adopt(wrong);
                None
            }
        };
    }
    let name = table.required_string(&BOARD_NAME)?;
    match Board::named(&name.value) {
        Ok(board) => Some(board),
        Err(text) => {
            let shown = format!("{:?}", name.value);
            let text = format!("{text}, or write file = \"FILE.toml\" in its place");
            table.complain(name.line, BOARD_NAME.name, &shown, &text);
            None
        }
    }
}
