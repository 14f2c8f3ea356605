//! The table `[device]`.

use super::keys::INITIAL_VALUES;
use super::reader::Table;

/// Reads its only key.
pub fn read_initial_values(table: &Table<'_, '_>) -> bool {
    table.boolean(&INITIAL_VALUES).is_none_or(|at| at.value)
}
