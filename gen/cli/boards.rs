//! `boards`: lists the boards that come with the program, prints the file of one, or draws its wiring.

use super::{to_json, Outcome};
use endat_config as config;
use endat_config::arguments::board_of;
use endat_config::board::{self, Board};
use endat_console::error::{shown, CommandError};
use endat_draw::mhz;
use endat_emit::wiring;

/// Prints a board's file.
pub fn show(name: &str) -> Result<Outcome, CommandError> {
    let text = Board::text(name).ok_or_else(|| {
        CommandError::input(format!(
            "--show = {}: unknown board; known boards: {}",
            shown(name),
            board::names().join(", ")
        ))
    })?;
    Ok(Outcome::good(text))
}

/// The wiring of the shipped card on a board, as SVG.
pub fn wiring(name: &str) -> Result<Outcome, CommandError> {
    let board = board_of("--wiring", name)?;
    let project = config::shipped_on(&board)?;
    Ok(Outcome::good(wiring::drawing(&project, &board)))
}

/// A row for each, as Markdown.
pub fn page() -> Result<Outcome, CommandError> {
    let mut text = String::from(
        "| board | family, device | oscillator, MHz | shipped card at, MHz | its EnDat clock, MHz | constraints | `build` with | wiring |\n|---|---|---|---|---|---|---|---|\n",
    );
    for board in Board::all()? {
        let card = config::shipped_on(&board)?.card;
        let clock_hz = card.channels.first().map_or(0, |c| c.spec.clock_hz);
        let family = &board.family;
        let open = family.build.as_ref().map(|_| "open tools");
        let vendor = family.vendor.as_ref().map(|vendor| vendor.tool.as_str());
        let tools: Vec<&str> = open.into_iter().chain(vendor).collect();
        let tools = tools.join(", ");
        text += &format!(
            "| `{}`: {} | {}, {} | {} | {} | {} | {} | {tools} | [drawing](boards/{}.svg) |\n",
            board.name,
            board.title,
            board.family.title,
            board.part,
            mhz(board.oscillator_hz),
            mhz(card.system_hz),
            mhz(clock_hz),
            board.family.constraints.to_ascii_uppercase(),
            board.name,
        );
    }
    Ok(Outcome::good(text))
}

/// One line for each.
pub fn list(json: bool) -> Result<Outcome, CommandError> {
    let boards = Board::all()?;
    if json {
        let rows: Vec<_> = (boards.iter())
            .map(|b| {
                serde_json::json!({
                    "name": b.name,
                    "title": b.title,
                    "family": b.family.title,
                    "part": b.part,
                    "oscillator_hz": b.oscillator_hz,
                })
            })
            .collect();
        return Ok(Outcome::good(to_json(&rows)?));
    }
    let line = |b: &Board| {
        format!(
            "{:<16} {}, {} {}, {} Hz\n",
            b.name, b.title, b.family.title, b.part, b.oscillator_hz
        )
    };
    Ok(Outcome::good(boards.iter().map(line).collect::<String>()))
}
