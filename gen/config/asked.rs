//! What the reader asks a file for: the keys that there may be, as the reader itself knows them.

use super::reader::Source;
use super::schema;
use crate::error::Diagnostic;
use crate::t_format;
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

/// All that the reader asks a text for, and what it complains about.
pub fn asked(text: &str) -> (Vec<Asked>, Vec<Diagnostic>) {
    let source = Source::new("", text);
    // What was read does not matter here; what is wrong is among the complaints.
    match t_format::receiver_line(text) {
        Some(_) => drop(t_format::read(&source)),
        None => drop(schema::read(&source)),
    }
    source.into_asked()
}
