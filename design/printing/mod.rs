//! Shared by the printers of a [`Design`](crate::elaborate::Design): the head of a file, names, numbers, and the order in a module.

mod clocked;
mod comment;
mod header;
mod names;
mod order;
mod row;
mod scope;

pub(crate) use clocked::Clocked;
pub use comment::with_wrapped_comments;
pub(crate) use comment::{beside, comment, with_comment};
pub use header::Header;
pub(crate) use names::{variant_name, Names};
use order::used_parameters;
pub(crate) use order::{constant_values, reads_and_targets, register_groups};
pub(crate) use row::{is_row, parts, Part};
pub(crate) use scope::Scope;

/// One step of indentation.
pub(crate) const INDENT: &str = "    ";

/// Largest pattern of bits that is said in decimal: everyone sees the bits of a small number.
pub(crate) const SMALL_MASK_MAX: u128 = 255;

/// Ends of the names of quantities.
const UNITS: [&str; 8] = ["hz", "ns", "us", "ms", "cycles", "bits", "bytes", "words"];

/// Whether the value of something that has a name is said in decimal: quantities are, what may be flags or several fields is not.
pub(crate) fn is_quantity(name: &str, value: u128) -> bool {
    let last = name.rsplit('_').next().unwrap_or(name).to_lowercase();
    UNITS.contains(&last.as_str()) || value <= SMALL_MASK_MAX
}

/// Whether a number without a name is said in decimal: times and counts, which are below a million or round, are.
pub(crate) fn is_count(value: u128) -> bool {
    value < 1_000_000 || value.is_multiple_of(1_000)
}
