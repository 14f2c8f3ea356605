//! A table of `docs/comparison.md`: each row tells where the figure on our side is from.

use std::fmt;

/// Source of a figure on our side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// A run that wrote the page.
    Measured,
    /// A figure of synthesis, which a test compares.
    Synthesis,
    /// A constant of the description that the core is made from.
    Description,
    /// Words, which the linked pages and the tests show.
    Words,
}

impl Basis {
    /// What the page calls it.
    const fn name(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Synthesis => "synthesis",
            Self::Description => "description",
            Self::Words => "words",
        }
    }
}

/// Text of the page before its tables.
pub const HEAD: &str = "# Comparison

Published systems, and the same work with this core. `cargo run --release -p endat-workshop -- bench comparison > docs/comparison.md` writes this page from runs of the presets with encoder models, and a test compares it. \
Sampling rate and initialisation differ from the presets. The lines have the delay of a cable, not its attenuation; EnDat allows 150 m. A dash means: not published. The last column is the source of the figure on our side:

- *measured*: in a run that wrote this page
- *synthesis*: a figure that a test compares with the tools
- *description*: a constant of the source
- *words*: the linked pages and the tests show it
";
/// Text of the page after its tables.
pub const STATUS: &str = include_str!("endat_if_status.md");

/// A table of the page.
pub struct Table {
    heading: &'static str,
    /// Who is in the second column.
    theirs: &'static str,
    rows: Vec<(Basis, [String; 3])>,
    notes: String,
}

impl Table {
    /// A table without rows.
    pub fn new(heading: &'static str, theirs: &'static str) -> Self {
        Self {
            heading,
            theirs,
            rows: vec![],
            notes: String::new(),
        }
    }

    /// One more row.
    pub fn row(
        &mut self,
        basis: Basis,
        what: &str,
        theirs: impl Into<String>,
        ours: impl Into<String>,
    ) {
        let cells = [what.into(), theirs.into(), ours.into()];
        self.rows.push((basis, cells));
    }

    /// A row of words.
    pub fn words(&mut self, what: &str, theirs: &str, ours: &str) {
        self.row(Basis::Words, what, theirs, ours);
    }

    /// The text below the table.
    pub fn note(&mut self, text: impl Into<String>) {
        self.notes = text.into();
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "\n## {}\n\n| | {} | here | |\n|---|---|---|---|",
            self.heading, self.theirs
        )?;
        for (basis, [what, theirs, ours]) in &self.rows {
            writeln!(f, "| {what} | {theirs} | {ours} | {} |", basis.name())?;
        }
        match self.notes.is_empty() {
            true => Ok(()),
            false => writeln!(f, "\n{}", self.notes),
        }
    }
}
