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
            0 if self.file.is_empty() => f.write_str(&self.text),
            0 => write!(f, "{}: {}", self.file, self.text),
            line => write!(f, "{}:{line}: {}", self.file, self.text),
        }
    }
}

/// Why a command did not succeed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CommandError {
    /// A check found a difference; the texts say what and how to repair it (exit code 1).
    CheckFailed(Vec<String>),
    /// Something the user gave is wrong (exit code 2).
    Input(Vec<String>),
}

impl CommandError {
    /// One message about the input.
    pub fn input(text: impl Into<String>) -> Self {
        Self::Input(vec![text.into()])
    }

    /// What can go wrong by a fault of this program only.
    pub fn fault(what: &str, error: &dyn fmt::Display) -> Self {
        Self::input(format!(
            "{what}: {error}; this is a fault of this program, please report it"
        ))
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

impl From<Vec<Diagnostic>> for CommandError {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Self::Input(diagnostics.iter().map(Diagnostic::to_string).collect())
    }
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.messages().join("\n"))
    }
}

impl std::error::Error for CommandError {}

/// At most 60 characters, on one line, without control characters.
pub fn shorten(text: &str) -> String {
    shorten_to(text, 60)
}

/// At most so many characters, on one line, without control characters.
pub fn shorten_to(text: &str, most: usize) -> String {
    let mut short: String = text.chars().take(most).flat_map(printable).collect();
    if text.chars().nth(most).is_some() {
        short.push_str("...");
    }
    short
}

fn printable(c: char) -> Vec<char> {
    if c.is_control() {
        c.escape_default().collect()
    } else {
        vec![c]
    }
}

/// A word as it stands in a message: in quotes when it would not be seen otherwise.
pub fn shown(text: &str) -> String {
    let plain = |c: char| !c.is_whitespace() && !c.is_control() && c != '"';
    if !text.is_empty() && text.chars().all(plain) {
        shorten(text)
    } else {
        format!("{:?}", text.chars().take(60).collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_in_messages_stay_on_one_line() {
        assert_eq!(shorten("a\nb\u{7}"), "a\\nb\\u{7}");
        assert_eq!(shorten(&"x".repeat(61)), format!("{}...", "x".repeat(60)));
    }

    #[test]
    fn a_word_that_would_not_be_seen_stands_in_quotes() {
        for (text, wanted) in [
            ("2", "2"),
            ("", "\"\""),
            ("a b", "\"a b\""),
            ("\n", "\"\\n\""),
        ] {
            assert_eq!(shown(text), wanted);
        }
    }
}
