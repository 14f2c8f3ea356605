//! A table of `docs/comparison.md`: each row tells where the figure on our side is from.

use std::fmt;

/// Where what stands on our side is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// A run that wrote the page.
    Measured,
    /// A figure of synthesis, which a test compares.
    Synthesis,
    /// A constant of the description that the core is made from.
    Description,
    /// Words: what the linked pages and the tests show.
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

/// What the column of a basis says.
pub const LEGEND: &str = "Of each row the last column tells where the right side is from: *measured* in a run that wrote this page; *synthesis*: a figure that a test compares with the tools; \
    *description*: a constant that the core is made from; *words*: for these the linked pages and the tests stand.";

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

    /// What stands below it.
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
