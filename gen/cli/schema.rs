//! `schema`: what editors need to complete and check configurations.

use super::pictures::{check_all, write_all, File};
use super::{to_json, Outcome};
use crate::error::GenError;
use crate::json_schema::{self, COMMENT};
use clap::{Args, ValueEnum};
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
pub fn run(arguments: &SchemaArgs) -> Result<Outcome, GenError> {
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
