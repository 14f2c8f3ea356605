//! Folders for the files of outside tools.

use endat_console::error::CommandError;
use std::path::Path;
use tempfile::TempDir;

/// What to do if such a folder cannot be written.
pub const REMEDY: &str = "make the folder for temporary files writable";

/// A folder that goes away again.
pub fn folder() -> Result<TempDir, CommandError> {
    let made = tempfile::Builder::new().prefix("endat-gen-").tempdir();
    made.map_err(|e| CommandError::io("make a folder in", &std::env::temp_dir(), &e, REMEDY))
}

/// A text that an outside tool has written there.
pub fn read(path: &Path) -> Result<String, CommandError> {
    std::fs::read_to_string(path).map_err(|e| CommandError::io("read", path, &e, REMEDY))
}
