//! What campaigns leave: parts that are put together, tables, the page.

pub mod report;
