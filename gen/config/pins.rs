//! The board, and which port of its top is on which pin.

use super::keys::{BOARD_FILE, BOARD_NAME};
use super::reader::{Source, Table};
use crate::board::{Assignment, Board, Kind, OSCILLATOR_PORT};
use std::collections::BTreeSet;
use std::path::Path;

/// The pin of every port; complaints go to `source`.
pub(super) fn assign_pins(
    source: &Source<'_>,
    pins: &Table<'_, '_>,
    board: &Board,
    ports: Vec<(String, Kind)>,
) -> Vec<Assignment> {
    let moved = pins.free_strings();
    for (signal, at) in &moved {
        if !ports.iter().any(|(port, _)| port == signal) {
            let names: Vec<&str> = ports.iter().map(|(port, _)| port.as_str()).collect();
            let text = format!("no such signal; signals: {}", names.join(", "));
            pins.complain(at.line, signal, &format!("{:?}", at.value), &text);
        }
    }
    let taken_pins: BTreeSet<String> = ports
        .iter()
        .filter_map(|(signal, _)| {
            let user = moved.iter().find(|(s, _)| s == signal);
            user.map(|(_, at)| &at.value)
                .or_else(|| board.usual_place(signal))
        })
        .filter_map(|word| board.pin(word).ok())
        .collect();
    let mut free = board.places().filter(|(_, pin)| !taken_pins.contains(*pin));
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
            let place = free.next().map_or(String::new(), |(place, _)| place);
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
            let free = board.places().find(|(_, pin)| !taken_pins.contains(*pin));
            let remedy = match free {
                Some((place, _)) => {
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
