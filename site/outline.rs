//! The order of the site's pages. Titles are the pages' own.

/// A page of the site that is a file of the repository.
pub struct Home {
    /// File below the repository.
    pub file: &'static str,
    /// Page below the site, without its ending.
    pub page: &'static str,
}

/// Pages that are not in `docs/`; those have their file's name.
pub const HOMES: [Home; 7] = [
    home("README.md", "index"),
    home("ARCHITECTURE.md", "architecture"),
    home("CONTRIBUTING.md", "contributing"),
    home("CHANGELOG.md", "changelog"),
    home("design/README.md", "design"),
    home("drivers/rust/README.md", "driver_in_rust"),
    home("drivers/host/README.md", "host_library"),
];

const fn home(file: &'static str, page: &'static str) -> Home {
    Home { file, page }
}

/// What belongs together.
pub struct Part {
    /// Its heading; the first has none.
    pub title: &'static str,
    /// Pages, in order.
    pub pages: &'static [&'static str],
}

/// The page below which that of each block is.
pub const BLOCKS: &str = "blocks";

/// Everything, in order.
pub const OUTLINE: [Part; 6] = [
    Part {
        title: "Begin",
        pages: &[
            "index",
            "tutorial",
            "first-bitstream",
            "first-driver",
            "glossary",
        ],
    },
    Part {
        title: "How to",
        pages: &[
            "wiring",
            "boards",
            "vhdl",
            "bus",
            "driver",
            "driver_in_rust",
            "programming",
            "host",
            "live-page",
            "recording",
            "python",
            "campaigns",
            "safety",
        ],
    },
    Part {
        title: "Reference",
        pages: &[
            "command-line",
            "commands",
            "configuration",
            "causes",
            "registers",
            "registers_of_t_format",
            "host-link",
            "stream",
            "size",
            "works-with",
        ],
    },
    Part {
        title: "Explanation",
        pages: &[
            "architecture",
            "t-format",
            "ssi",
            "margin",
            "simulation",
            "proofs",
            "mutants",
            "reliability",
            "comparison",
            "decisions",
        ],
    },
    Part {
        title: "Blocks",
        pages: &[BLOCKS],
    },
    Part {
        title: "Project",
        pages: &["contributing", "changelog", "design", "host_library"],
    },
];
