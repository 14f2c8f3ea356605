//! What campaigns leave: parts that are put together, tables, budgets, the page.

pub mod budget;
pub mod card;
pub mod configurations;
mod elements;
pub mod mutants;
pub mod page;
pub mod part;
pub mod reference;
pub mod report;
