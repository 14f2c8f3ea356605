//! A project's core in VHDL: its files, the bench that plays recorded vectors, and what a VHDL design takes the Verilog in with.

mod bench;
mod component;
mod host;
mod play;

pub use bench::artifacts as bench;
pub use component::artifacts as component;
pub use play::{card, receiver, Played};

use crate::artifact::Artifact;
use rtl_design::elaborate::Design;
use rtl_design::vhdl::{print_files, Header};

/// The files of a design in the order in which compilers want them, the top's last.
pub fn artifacts(design: &Design, header: &Header) -> Vec<Artifact> {
    let files = print_files(design, header).into_iter();
    files
        .map(|(path, text)| Artifact::new(path, text))
        .collect()
}
