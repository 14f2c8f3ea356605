//! A preset on another board: its text, with the board and the clocks that suit it.

use super::document::parse;
use super::reader::Source;
use super::{check_name, preset_of, DEFAULT_PRESET};
use crate::board::Board;
use endat_console::error::CommandError;
use std::ops::Range;

/// Text of a preset for this board, to start from; `option` is what asked for the preset. The shipped one also takes the board's clocks.
pub fn preset_for(option: &str, name: &str, board: &Board) -> Result<String, CommandError> {
    let text = preset_of(option, name)?;
    let source = Source::new(name, text);
    let Some(document) = parse(&source, &[]) else {
        return Err(source.into_diagnostics().into());
    };
    let place = |table: &str, key: &str| -> Option<(Range<usize>, Range<usize>)> {
        let table = document.get(table)?.get_ref().as_table()?;
        let (key, value) = table.get_key_value(key)?;
        Some((key.span(), value.span()))
    };
    let value = |table: &str, key: &str| place(table, key).map(|(_, value)| value);
    // On its own board there is nothing to change.
    let own = value("board", "name").and_then(|span| text.get(span));
    if board.file.is_none() && own == Some(format!("{:?}", board.name).as_str()) {
        return Ok(text.to_owned());
    }
    let mut edits = Vec::new();
    let start = board.start.filter(|_| name == DEFAULT_PRESET);
    let is_small = start.is_some_and(|start| start.channels == 1);
    let own_name = match is_small {
        true => format!("{}_{ONE_CHANNEL}", board.name),
        false => format!("{}_{}", board.name, name.trim_start_matches("s6_")),
    };
    if let (Some(span), Ok(())) = (document.get("name"), check_name(&own_name)) {
        edits.push((span.span(), format!("{own_name:?}")));
    }
    if let Some((key, value)) = place("board", "name") {
        match &board.file {
            Some(file) => edits.extend([(key, "file".to_owned()), (value, format!("{file:?}"))]),
            None => edits.push((value, format!("{:?}", board.name))),
        }
    }
    if let Some(start) = start {
        let clocks = [
            ("clock", "system_hz", start.system_hz),
            ("endat", "clock_hz", start.clock_hz),
        ];
        for (table, key, hz) in clocks {
            edits.extend(value(table, key).map(|span| (span, endat_console::number::grouped(hz))));
        }
    }
    // A slower link than the preset's, where the board's chip is slower.
    if let Some(span) = value("link", "baud") {
        let asked = text.get(span.clone()).and_then(number);
        if asked.is_some_and(|baud| baud > board.uart_baud_max) {
            edits.push((span, endat_console::number::grouped(board.uart_baud_max)));
        }
    }
    edits.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    let mut text = text.to_owned();
    for (span, new) in edits {
        text.replace_range(span, &new);
    }
    Ok(match is_small {
        true => with_one_channel(&text),
        false => text,
    })
}

/// Name of the shipped card without its second channel, behind that of the board.
const ONE_CHANNEL: &str = "one_channel";

/// The text with the first of its channels only, and a line that says so.
fn with_one_channel(text: &str) -> String {
    let (mut channels, mut is_out) = (0, false);
    let kept = text.lines().filter(|line| {
        if line.starts_with('[') {
            let is_channel = line.starts_with("[[channel]]");
            channels += usize::from(is_channel);
            is_out = is_channel && channels > 1;
        }
        !is_out
    });
    let about = "# Of the two channels the first one: both do not fit the device of this board.";
    let lines = std::iter::once(about).chain(kept);
    lines.map(|line| format!("{line}\n")).collect()
}

/// The number that a text with underscores is.
fn number(text: &str) -> Option<u64> {
    text.replace('_', "").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board;
    use crate::parse_on;

    #[test]
    fn the_shipped_card_is_good_on_every_board() {
        for name in board::names() {
            let board = Board::named(name).unwrap();
            let text = preset_for("--preset", DEFAULT_PRESET, &board).unwrap();
            let project = parse_on("card.toml", &text, Some(&board));
            let project = project.unwrap_or_else(|e| panic!("{name}: {e:?}"));
            let channels = board.start.map_or(2, |start| start.channels);
            assert_eq!(project.card.channels.len(), channels, "{name}");
            assert_eq!(project.board, Some(board));
            assert!(text.contains(&format!("name = {name:?}")), "{text}");
        }
        assert_eq!(
            [
                endat_console::number::grouped(7),
                endat_console::number::grouped(3_125_000)
            ],
            ["7", "3_125_000"]
        );
    }

    /// Catches a preset that asks for more than the chip behind the connector of the host can do.
    #[test]
    fn the_uart_of_a_preset_is_no_faster_than_that_of_the_board() {
        let slow = Board {
            uart_baud_max: 921_600,
            ..Board::named("papilio_pro").unwrap()
        };
        let slow = Board {
            name: "slow".into(),
            ..slow
        };
        let text = preset_for("--preset", DEFAULT_PRESET, &slow).unwrap();
        assert!(text.contains("\nbaud = 921_600"), "{text}");
        let own = Board::named("papilio_pro").unwrap();
        let text = preset_for("--preset", DEFAULT_PRESET, &own).unwrap();
        assert!(!text.contains("921_600"), "{text}");
    }
}
