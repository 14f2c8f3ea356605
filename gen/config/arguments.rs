//! Options that name a configuration and a board.

use crate::board::Board;
use crate::Configuration;
use clap::Args;
use endat_console::error::{shown, CommandError};
use std::path::{Path, PathBuf};

/// Which configuration.
#[derive(Args, Clone, Default)]
pub struct SourceArgs {
    /// Configuration file; - reads standard input
    #[arg(long, value_name = "FILE", conflicts_with = "preset")]
    pub config: Option<PathBuf>,
    /// Configuration that comes with the program [default: s6_two_channel]
    #[arg(long, value_name = "NAME")]
    pub preset: Option<String>,
}

/// On which board.
#[derive(Args, Clone, Default)]
pub struct TargetArgs {
    /// Board instead of the configuration's: one that comes with the program, or a file [default: as in the configuration]
    #[arg(long, value_name = "NAME|FILE")]
    pub board: Option<String>,
}

impl TargetArgs {
    /// The board that is asked for, if one is.
    pub fn load(&self) -> Result<Option<Board>, CommandError> {
        self.board
            .as_deref()
            .map(|word| board_of("--board", word))
            .transpose()
    }
}

/// A board by its name, or in a file.
pub fn board_of(option: &str, word: &str) -> Result<Board, CommandError> {
    if word.contains(['/', '\\', '.']) {
        return Ok(Board::from_file(Path::new(word))?);
    }
    Board::named(word).map_err(|text| {
        CommandError::input(format!(
            "{option} = {}: {text}, or give a file of your own, as {option} FILE.toml",
            shown(word)
        ))
    })
}

impl SourceArgs {
    /// Either kind.
    pub fn load_any(&self) -> Result<Configuration, CommandError> {
        self.load_any_on(None)
    }

    /// The same on another board than its own. Without a configuration it is the shipped one, with clocks that suit the board.
    pub fn load_any_on(&self, board: Option<&Board>) -> Result<Configuration, CommandError> {
        let name = self.preset.as_deref().unwrap_or(crate::DEFAULT_PRESET);
        match (&self.config, board) {
            (Some(file), board) => crate::load_any_file(file, board),
            (None, None) => crate::load_any_preset(name),
            (None, Some(board)) => {
                let text = crate::preset_for("--preset", name, board)?;
                let file = format!("{name}.toml");
                Ok(crate::parse_any_on(&file, &text, Some(board))?)
            }
        }
    }
}
