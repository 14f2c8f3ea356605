//! `boards`: lists the boards that come with the program, prints the file of one, or builds the shipped card on them.

use super::work::Steps;
use super::{to_json, Outcome};
use crate::bitstream::{self, Effort, Use};
use crate::board::{self, Board};
use crate::config::{self, Project};
use crate::error::{shown, GenError};
use crate::wiring;
use endat_sim::decimal;

/// What is tried for the table.
const EFFORT: Effort = Effort {
    seeds: 5,
    until_met: false,
    way_back: None,
};

/// Prints a board's file.
pub fn show(name: &str) -> Result<Outcome, GenError> {
    let text = Board::text(name).ok_or_else(|| {
        GenError::input(format!(
            "--show = {}: unknown board; known boards: {}",
            shown(name),
            board::names().join(", ")
        ))
    })?;
    Ok(Outcome::good(text))
}

/// The wiring of the shipped card on a board, as SVG.
pub fn wiring(name: &str) -> Result<Outcome, GenError> {
    let board = super::board_of("--wiring", name)?;
    let project = shipped_card(&board)?;
    Ok(Outcome::good(wiring::drawing(&project, &board)))
}

fn all() -> Result<Vec<Board>, GenError> {
    let boards = board::names().into_iter().map(Board::named);
    let boards = boards.collect::<Result<Vec<_>, _>>();
    boards.map_err(|e| GenError::fault("boards", &e))
}

/// The shipped card on a board.
fn shipped_card(board: &Board) -> Result<Project, GenError> {
    let text = config::preset_for("--preset", config::DEFAULT_PRESET, board)?;
    Ok(config::parse_on(&board.name, &text, Some(board))?)
}

fn mhz(hz: u64) -> String {
    decimal(hz as f64 / 1e6, 6)
}

/// A row for each, as Markdown.
pub fn page() -> Result<Outcome, GenError> {
    let mut text = String::from(
        "| board | family, device | oscillator, MHz | shipped card at, MHz | its EnDat clock, MHz | constraints | `build` with | wiring |\n|---|---|---|---|---|---|---|---|\n",
    );
    for board in all()? {
        let card = shipped_card(&board)?.card;
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

/// Builds the shipped card, and prints a row for each board as Markdown; exits with 1 if one is too slow.
pub fn measure(name: Option<&str>) -> Result<Outcome, GenError> {
    let boards = match name {
        Some(name) => vec![super::board_of("--measure", name)?],
        None => all()?,
    };
    let mut text = String::from(
        "| board | system clock, MHz | reached with seeds 1 to 5, MHz | best margin | cells |\n|---|---|---|---|---|\n",
    );
    let (mut exit_code, mut messages) = (0, vec![]);
    let steps = Steps::new(None);
    let mut begin = |step: String| steps.begin(&step);
    for board in &boards {
        let Some(build) = &board.family.build else {
            continue;
        };
        let project = shipped_card(board)?;
        let artifacts = crate::emit(&project)?;
        let built = bitstream::build(&project, board, build, &artifacts, EFFORT, &mut begin);
        let report = match built {
            Ok((report, _)) => report,
            // The others are as good as before.
            Err(error) => {
                text += &format!(
                    "| `{}` | {} | not built | | |\n",
                    board.name,
                    mhz(project.card.system_hz)
                );
                exit_code = exit_code.max(error.exit_code());
                messages.push(error.to_string());
                continue;
            }
        };
        let best = &report.best;
        let reached = report.reached_mhz.iter().map(|mhz| decimal(*mhz, 1));
        let reached = reached.collect::<Vec<_>>().join(", ");
        // What there are many of, and the card takes some of.
        let counts = |cells: &Use| cells.available > 20 && cells.used * 50 > cells.available;
        let cells = best.cells.iter().filter(|(_, cells)| counts(cells));
        let cells = cells.map(|(kind, c)| format!("{kind} {} of {}", c.used, c.available));
        text += &format!(
            "| `{}` | {} | {reached} | {} % | {} |\n",
            board.name,
            mhz(project.card.system_hz),
            decimal(best.margin(), 1),
            cells.collect::<Vec<_>>().join(", ")
        );
        exit_code = exit_code.max(u8::from(!best.is_met));
    }
    Ok(Outcome {
        exit_code,
        messages,
        ..Outcome::good(text)
    })
}

/// One line for each.
pub fn list(json: bool) -> Result<Outcome, GenError> {
    let boards = all()?;
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
