//! Folders for the files of outside tools.

use crate::error::GenError;
use std::path::Path;
use tempfile::TempDir;

/// What to do if such a folder cannot be written.
pub const REMEDY: &str = "make the folder for temporary files writable";

/// A folder that goes away again.
pub fn folder() -> Result<TempDir, GenError> {
    let made = tempfile::Builder::new().prefix("endat-gen-").tempdir();
    made.map_err(|e| GenError::io("make a folder in", &std::env::temp_dir(), &e, REMEDY))
}

/// A text that an outside tool has written there.
pub fn read(path: &Path) -> Result<String, GenError> {
    std::fs::read_to_string(path).map_err(|e| GenError::io("read", path, &e, REMEDY))
}
