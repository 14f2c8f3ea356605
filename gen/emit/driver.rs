//! The C driver as files of an emission.

pub use endat_c_driver::FILES;
use endat_console::artifact::Artifact;

/// Its row in the README of an emission.
pub const ROW: &str = "| `endat.h` and the other `endat*` | driver in C99 for this and every other card, on any bus: `endat.h` documents its calls; `endat_transports.h` is for SPI, parallel bus and UART |";

/// Every file of the driver.
pub fn artifacts() -> Vec<Artifact> {
    let artifact = |(name, text): &(&str, &str)| Artifact::new(*name, *text);
    FILES.iter().map(artifact).collect()
}

/// Whether a file of an emission is one of them.
pub fn is_of(path: &str) -> bool {
    FILES.iter().any(|(name, _)| *name == path)
}
