//! What can go wrong, and with which exit code.

use std::fmt;
use std::path::Path;

/// One message about one place of an input file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// File as the user named it.
    pub file: String,
    /// Line, counted from 1; 0 when the whole file is meant.
    pub line: usize,
    /// `key = value: what is wrong, the limit, the remedy`.
    pub text: String,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}: {}", self.file, self.text),
            line => write!(f, "{}:{line}: {}", self.file, self.text),
        }
    }
}

/// Why a command did not succeed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GenError {
    /// A check found a difference; the texts say what and how to repair it (exit code 1).
    CheckFailed(Vec<String>),
    /// Something the user gave is wrong (exit code 2).
    Input(Vec<String>),
}

impl GenError {
    /// One message about the input.
    pub fn input(text: impl Into<String>) -> Self {
        Self::Input(vec![text.into()])
    }

    /// A file that could not be read or written.
    pub fn io(action: &str, path: &Path, error: &std::io::Error, remedy: &str) -> Self {
        Self::input(format!(
            "{}: cannot {action}: {error}; {remedy}",
            path.display()
        ))
    }

    /// The exit code of the program.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::CheckFailed(_) => 1,
            Self::Input(_) => 2,
        }
    }

    /// The messages, one a line.
    pub fn messages(&self) -> &[String] {
        match self {
            Self::CheckFailed(texts) | Self::Input(texts) => texts,
        }
    }
}

impl From<Vec<Diagnostic>> for GenError {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Self::Input(diagnostics.iter().map(Diagnostic::to_string).collect())
    }
}

impl fmt::Display for GenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.messages().join("\n"))
    }
}

impl std::error::Error for GenError {}
