//! Programs that are not of this project, and what they make of what is emitted.

mod benches;
pub mod configurations;
mod emissions;
mod flows;
pub mod table;
