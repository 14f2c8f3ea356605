//! The Verilog files of a project: what they say of themselves, and the list of them.

use crate::artifact::Artifact;
use crate::language::Language;
use rtl_design::elaborate::Design;
use rtl_design::verilog::{print_files, Header};

/// The licence of emitted text.
const LICENCE: &str = "MIT OR Apache-2.0";

/// The first lines of the files: what the design is, the hash of its configuration, and its resolved timing.
pub fn header(title: String, configuration_hash: &str, timing: &str) -> Header {
    let mut notes: Vec<String> = timing.lines().map(|line| format!("  {line}")).collect();
    if !notes.is_empty() {
        notes.insert(0, "Timing:".into());
    }
    let version = env!("CARGO_PKG_VERSION");
    Header {
        title,
        licence: LICENCE.into(),
        made_by: format!("endat-gen {version}, configuration {configuration_hash}"),
        notes,
    }
}

/// The files of a design, the top module's first.
pub fn artifacts(design: &Design, header: &Header) -> Vec<Artifact> {
    let files = print_files(design, header).into_iter();
    files
        .map(|(path, text)| Artifact::new(path, text))
        .collect()
}

/// The same of a design that nobody is given.
pub fn untitled(design: &Design) -> Vec<Artifact> {
    artifacts(design, &header(String::new(), "", ""))
}

/// The files in a language among the artefacts of a design.
pub fn source_files(artifacts: &[Artifact], language: Language) -> Vec<String> {
    let paths = artifacts.iter().map(|a| a.path.clone());
    paths
        .filter(|p| p.ends_with(language.extension()))
        .collect()
}

/// The list of a card's files, in Verilog such as compilers read with `-f`: no pattern of names takes in a file that is not the card's.
pub fn source_list(name: &str, sources: &[String]) -> Artifact {
    let lines = sources.iter().map(|file| format!("{file}\n"));
    Artifact::new(format!("{name}.f"), lines.collect::<String>())
}
