//! What the reader asks a file for: the keys that there may be, as the reader itself knows them.

use endat_hdl::config::Limits;

/// What may stand under a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number within limits.
    Integer(Limits),
    /// Text.
    Text,
    /// True or false.
    Boolean,
    /// A list of texts.
    Texts,
    /// A list of numbers.
    Integers,
    /// Tables in double brackets.
    Tables,
}

/// A key that was asked for, written or not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// Its table, empty at the top of the file; `channel[0]` for the first one in double brackets.
    pub table: String,
    /// The key.
    pub key: &'static str,
    /// What may stand there.
    pub kind: Kind,
    /// All that it may be, if it is one of a few words or numbers.
    pub words: Vec<String>,
}
