//! Folders for the files of outside tools.

use std::path::PathBuf;

/// What to do if such a folder cannot be written.
pub const REMEDY: &str = "make the folder for temporary files writable";

/// A folder that goes away again.
pub struct Scratch(pub PathBuf);

impl Scratch {
    /// A folder for one command of this process.
    pub fn new(command: &str) -> Self {
        let name = format!("endat-gen-{command}-{}", std::process::id());
        Self(std::env::temp_dir().join(name))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // Nothing better can be done about a folder that stays.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
