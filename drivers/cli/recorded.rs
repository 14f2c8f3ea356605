//! The commands that read recordings: figures and drawings of what `log` and the live page have written.

use crate::port::RangeArgs;
use clap::Args;
use endat_console::error::CommandError;
use endat_recording::read::{self, Found, Rows};
use std::path::PathBuf;

/// Which recording.
#[derive(Args)]
pub struct FileArgs {
    /// Recording: CSV, JSON lines or Parquet; several files of one recording in any order. The files that a Parquet recording filled after FILE are read, too
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    range: RangeArgs,
}

impl FileArgs {
    /// The files' names.
    pub fn names(&self) -> String {
        let names: Vec<String> = self.files.iter().map(|f| f.display().to_string()).collect();
        match &names[..] {
            [first, .., last] => format!("{first} to {last}"),
            all => all.concat(),
        }
    }

    /// Reads all rows; `is_sparse`: some were left out on purpose.
    pub fn read(&self, is_sparse: bool, take: Rows<'_>) -> Result<Found, CommandError> {
        read::read_as(&self.files, is_sparse, self.range.ranges()?, take)
    }
}
