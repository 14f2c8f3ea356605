//! What campaigns leave: parts that are put together, tables, budgets.

pub mod budget;
pub mod card;
pub mod configurations;
pub mod elements;
pub mod part;
pub mod reference;
pub mod report;
