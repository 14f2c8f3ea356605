//! `explain NAME`: what a key, a cause, a register or a word of the protocol is.

use super::{explain_key, glossary};
use endat_console::did_you_mean::guesses;
use endat_console::error::{shown, CommandError};
use endat_host::explain;

/// Everything called so.
pub fn text(typed: &str) -> Result<String, CommandError> {
    let name = typed.to_ascii_lowercase();
    let text = explain::text(&name) + &explain_key::text(&name) + &glossary::text(&name);
    if !text.is_empty() {
        return Ok(text);
    }
    let mut names = explain::names();
    names.extend(explain_key::names());
    names.extend(glossary::names());
    let guess = guesses(&name, names);
    Err(CommandError::input(format!(
        "name = {}: no key, cause, register, field or word of the glossary has this name; {guess}`endat reg list` lists registers and docs/configuration.md keys",
        shown(typed),
    )))
}
