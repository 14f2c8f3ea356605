//! The C driver: its generated files, strict compilers, and its calls against the fronts of real cards.

use crate::tools;
use std::path::{Path, PathBuf};

/// Where the driver lies.
fn home() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("drivers/c")
}

/// Catches a register, cause or step that has changed while the driver has the old one.
#[test]
fn the_driver_has_the_map_and_the_texts_of_the_tables() {
    for file in endat_gen::maps::driver::artifacts() {
        let path = home().join(&file.path);
        assert!(
            tools::committed(&path, &file.text) == file.text,
            "{}: is not what the tables give; UPDATE_EXPECT=1 renews it",
            file.path
        );
    }
}
