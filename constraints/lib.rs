//! The boards and families that come with the program, and the templates of what is emitted around a card.

include!(concat!(env!("OUT_DIR"), "/boards.rs"));

/// Names of all boards.
pub fn names() -> Vec<&'static str> {
    let files = BOARDS.iter().map(|(file, _)| *file);
    files
        .filter_map(|file| file.strip_suffix(".toml"))
        .collect()
}

/// Text of a board's file.
pub fn board(name: &str) -> Option<&'static str> {
    let found = BOARDS
        .iter()
        .find(|(file, _)| file.strip_suffix(".toml") == Some(name));
    found.map(|(_, text)| *text)
}

/// Names of all families.
pub fn families() -> Vec<&'static str> {
    FAMILIES.iter().map(|(name, _)| *name).collect()
}

/// The files of a family.
pub fn family(name: &str) -> Option<&'static [(&'static str, &'static str)]> {
    let found = FAMILIES.iter().find(|(family, _)| *family == name);
    found.map(|(_, files)| *files)
}

/// Templates that every board has in common.
pub mod templates {
    /// The top of a board in Verilog.
    pub const TOP: &str = include_str!("templates/top.v.jinja");
    /// The same in VHDL.
    pub const TOP_VHDL: &str = include_str!("templates/top.vhd.jinja");
    /// Vivado's report of the timing.
    pub const REPORT: &str = include_str!("templates/report.tcl.jinja");
    /// The page of an emission.
    pub const README: &str = include_str!("templates/readme.md.jinja");
    /// Its part about the bus.
    pub const README_BUS: &str = include_str!("templates/readme_bus.md.jinja");
}
