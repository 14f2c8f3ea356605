//! The terminal of the programs: outcomes, colours, progress, completions and manual pages, files besides the result.

pub mod colour;
pub mod documents;
pub mod files;
pub mod outcome;
pub mod work;
