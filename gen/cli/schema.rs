//! `schema`: what editors need to complete and check configurations.

use super::{to_json, Outcome};
use clap::{Args, ValueEnum};
use endat_config::json_schema::{self, COMMENT};
use endat_console::error::CommandError;
use endat_terminal::files::{check_all, write_all, File};
use std::path::PathBuf;

/// Of which files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Configurations
    #[default]
    Card,
    /// Boards' files
    Board,
}

/// Arguments of `schema`.
#[derive(Args)]
pub struct SchemaArgs {
    /// Of which files
    #[arg(value_enum, default_value_t)]
    form: Form,
    /// Write it into this file instead
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Prints a schema, or writes it.
pub fn run(arguments: &SchemaArgs) -> Result<Outcome, CommandError> {
    let schema = match arguments.form {
        Form::Card => json_schema::card(),
        Form::Board => json_schema::board(),
    };
    let text = to_json(&schema)?;
    let Some(path) = &arguments.out else {
        return Ok(Outcome::good(text));
    };
    let file = File {
        option: "--out",
        path: path.clone(),
        text,
        is_ours: |head| head.contains(COMMENT),
    };
    check_all(&[&file])?;
    Ok(Outcome {
        messages: write_all(&[file])?,
        ..Outcome::default()
    })
}
