//! How a board's bitstream is made, in words of its family's file: for scripts and pages of an emission, and for who runs them.

use endat_config::board::{Board, Build, Vendor};
use endat_config::Project;
use endat_console::error::CommandError;
use minijinja::context;
use minijinja::value::Serde;

/// The tools that make a board's bitstream.
#[derive(Clone, Copy, Debug)]
pub enum Maker<'a> {
    /// yosys, nextpnr and a packer.
    Open(&'a Build),
    /// The vendor's tool.
    Vendor(&'a Vendor),
}

impl<'a> Maker<'a> {
    /// The tools of a board's family: open tools if it has both, unless the vendor's are asked for.
    pub fn of(board: &'a Board, asks_vendor: bool) -> Result<Self, CommandError> {
        let family = &board.family;
        match (&family.build, &family.vendor) {
            (Some(build), _) if !asks_vendor => Ok(Self::Open(build)),
            (_, Some(vendor)) => Ok(Self::Vendor(vendor)),
            (Some(_), None) => Err(CommandError::input(format!(
                "board = {}: {} has no script for a vendor's tool; leave --vendor and --read out, and open tools make the bitstream",
                board.name, family.title
            ))),
            (None, None) => Err(CommandError::input(format!(
                "board = {}: {} has neither open tools nor a vendor's; add [build] or [vendor] to its family.toml",
                board.name, family.title
            ))),
        }
    }

    const fn bitstream(self) -> &'a String {
        match self {
            Self::Open(build) => &build.bitstream,
            Self::Vendor(vendor) => &vendor.bitstream,
        }
    }
}

/// Words of a family's file, with what is this card's in them.
pub fn fill(
    project: &Project,
    board: &Board,
    words: &[String],
) -> Result<Vec<String>, CommandError> {
    let facts = context! {
        name => project.name.as_str(),
        constraints => format!("{}.{}", project.name, board.family.constraints),
        device => Serde(&board.device),
        board => context! { part => board.part.as_str() },
    };
    let place = format!("{}/family.toml: build", board.family.name);
    let words = words.iter();
    words
        .map(|word| board.family.fill(&place, word, &facts))
        .collect()
}

/// Name of a card's bitstream.
pub fn file_name(
    project: &Project,
    board: &Board,
    maker: Maker<'_>,
) -> Result<String, CommandError> {
    let words = std::slice::from_ref(maker.bitstream());
    let name = fill(project, board, words)?.concat();
    match name.contains(['/', '\\']) {
        true => Err(CommandError::input(format!(
            "{}/family.toml: bitstream = {name:?}: is a path; give a name without a folder",
            board.family.name
        ))),
        false => Ok(name),
    }
}

/// How often encoders' lines are sampled, in hertz: twice in a period with `double_edge`. What is bounded is the way to the samplers, which
/// stays below the time between two samples so that these keep their order.
pub fn input_hz(project: &Project) -> u64 {
    project.card.system_hz * (1 + u64::from(project.card.line.double_edge))
}
