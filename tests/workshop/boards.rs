//! `boards`: builds the shipped card on every board that open tools know.

use clap::Args;
use endat_config::arguments::board_of;
use endat_config::board::Board;
use endat_config::shipped_on;
use endat_console::error::CommandError;
use endat_draw::{decimal, mhz};
use endat_terminal::outcome::Outcome;
use endat_terminal::work::Steps;
use endat_tools::bitstream::{self, Effort, Use};

/// Arguments of `boards`.
#[derive(Args)]
pub struct BoardsArgs {
    /// Only this board, by name or file
    #[arg(value_name = "BOARD")]
    board: Option<String>,
}

/// Effort for each row of the table.
const EFFORT: Effort = Effort {
    seeds: 5,
    until_met: false,
    way_back: None,
};

/// Builds the shipped card, and prints a row for each board as Markdown; exits with 1 if one is too slow.
pub fn run(arguments: &BoardsArgs) -> Result<Outcome, CommandError> {
    let boards = match &arguments.board {
        Some(name) => vec![board_of("BOARD", name)?],
        None => Board::all()?,
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
        let project = shipped_on(board)?;
        let artifacts = endat_emit::emit(&project)?;
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
        // Cells that the device has many of, and the card takes a part of.
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
