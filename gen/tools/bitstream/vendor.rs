//! A bitstream by the tool of the vendor, which runs the script of the emission: here, or on a machine that has it.

use super::{
    attempt, failed, file_name, fill, input_hz, made, report_of, Maker, Report, NO_SYSTEM_CLOCK,
    TOO_LARGE,
};
use crate::programs;
use crate::scratch;
use endat_config::board::{Board, Vendor};
use endat_config::Project;
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

/// What a report says that the script has left in a folder, and the bitstream beside it.
pub fn read(
    project: &Project,
    board: &Board,
    vendor: &Vendor,
    folder: &Path,
) -> Result<(Report, Vec<u8>), CommandError> {
    let bitstream = file_name(project, board, Maker::Vendor(vendor))?;
    let report = report_of(project, board, folder, &bitstream)?;
    let best = attempt(&report, 0, project.card.system_hz, input_hz(project)).ok_or_else(|| {
        CommandError::input(format!(
            "{}_report.json: {NO_SYSTEM_CLOCK}; look at what {} says of its clocks",
            project.name, vendor.tool
        ))
    })?;
    let bytes = made(folder, &bitstream)?;
    Ok((Report::new(project, board, vec![], best, bitstream), bytes))
}

/// Runs the script on a copy of the emission. Returns the report and the bitstream's bytes; `emitted` is where the emission is.
pub fn run(
    project: &Project,
    board: &Board,
    vendor: &Vendor,
    artifacts: &[Artifact],
    emitted: &Path,
    progress: &mut dyn FnMut(String),
) -> Result<(Report, Vec<u8>), CommandError> {
    let words = fill(project, board, &vendor.run)?;
    // A script of somebody else's family may do anything.
    if board.family.is_own() {
        return Err(CommandError::input(format!(
            "{}: its script is not one of this program, so you run it: `{}` in {}, and then the same command with --read",
            board.family.name,
            words.join(" "),
            emitted.display()
        )));
    }
    let (name, arguments) = words
        .split_first()
        .ok_or_else(|| CommandError::input("vendor.run: no tool"))?;
    let scratch = scratch::folder()?;
    artifact::write(scratch.path(), artifacts, scratch::REMEDY)?;
    progress(format!("{}: {}", project.name, vendor.tool));
    let mut command = Command::new(name);
    match programs::start(command.current_dir(scratch.path()).args(arguments)) {
        Ok(ran) if ran.is_good => read(project, board, vendor, scratch.path()),
        Ok(ran) => Err(failed(name, &ran, TOO_LARGE)),
        Err(e) if e.kind() == ErrorKind::NotFound => Err(CommandError::input(format!(
            "{name}: is not installed here; on a machine with {}, run `{}` in {} (it is complete), and then the same command with --read",
            vendor.tool,
            words.join(" "),
            emitted.display()
        ))),
        Err(e) => Err(CommandError::input(format!("{name}: cannot be started: {e}; look at the installation of {}", vendor.tool))),
    }
}
