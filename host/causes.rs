//! Causes: what can be wrong with a result, and what helps.

use endat_regs::causes;
use endat_regs::Named;

pub use causes::advice;

/// All causes, 0 = none.
pub fn all() -> &'static [Named] {
    causes::CARD
}

/// Name of a cause, as counters and files have it.
pub fn name(cause: u8) -> &'static str {
    all().get(usize::from(cause)).map_or("unknown", |c| c.name)
}

/// Number of the cause with this name.
pub fn number(name: &str) -> Option<u8> {
    let known = all().iter().find(|c| c.name == name);
    known.map(|c| c.number as u8)
}
