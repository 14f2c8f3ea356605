//! Causes of a result, with remedies.

use endat_regs::causes;

pub use causes::{advice, number as of_code, ALL, CODES};

/// Name of a cause in counters and files.
pub fn name(cause: u8) -> &'static str {
    causes::of(cause).map_or("unknown", |c| c.name)
}

/// Number of the cause with this name.
pub fn number(name: &str) -> Option<u8> {
    let known = ALL.iter().find(|c| c.name == name);
    known.map(|c| c.number as u8)
}
