//! Turns a configuration into the files of an EnDat receiver card.
//!
//! ```text
//! config (TOML) -> Project -> emit -> [Artifact] -> artifact::write
//!                          -> explain
//! ```
//!
//! Everything before [`artifact::write`] makes text and touches no file.

pub mod artifact;
pub mod board;
pub mod cli;
pub mod config;
pub mod constraints;
pub mod crc;
pub mod error;
pub mod explain;
pub mod verilog;

use artifact::Artifact;
use config::Project;
use error::GenError;

/// All files of a project, the MANIFEST last.
pub fn emit(project: &Project) -> Result<Vec<Artifact>, GenError> {
    let mut artifacts = design_artifacts(project)?;
    artifacts.extend(constraints::artifacts(project)?);
    artifacts.push(artifact::manifest(&artifacts));
    Ok(artifacts)
}

/// The card as Verilog, and its register map.
pub fn design_artifacts(_project: &Project) -> Result<Vec<Artifact>, GenError> {
    Ok(Vec::new())
}
