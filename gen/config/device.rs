//! The table `[device]`.

use super::reader::Table;

/// Reads its only key.
pub fn read_initial_values(table: &Table<'_, '_>) -> bool {
    table.boolean("initial_values").is_none_or(|at| at.value)
}
