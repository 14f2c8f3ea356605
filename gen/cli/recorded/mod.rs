//! The commands that read recordings: figures and drawings of what `log` and the live page have written.

pub mod plot;
pub mod stats;

use crate::error::GenError;
use crate::recording::picture::Measurement;
use crate::recording::read::{self, Head};
use clap::Args;
use std::path::PathBuf;

/// Which recording.
#[derive(Args)]
pub struct FileArgs {
    /// Recording: CSV, JSON lines or Parquet; several files of one recording in their order
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
}

impl FileArgs {
    /// The files' names.
    fn names(&self) -> String {
        let names: Vec<String> = self.files.iter().map(|f| f.display().to_string()).collect();
        match &names[..] {
            [first, .., last] => format!("{first} to {last}"),
            all => all.concat(),
        }
    }

    /// Reads all rows; what the file says before them, and what is to be told.
    fn read(
        &self,
        take: &mut dyn FnMut(&Head, Measurement),
    ) -> Result<(Head, Vec<String>), GenError> {
        read::read_all(&self.files, take)
    }
}
