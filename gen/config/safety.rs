//! The table `[safety]`.

use super::parts::read_parts;
use super::reader::Table;
use endat_hdl::bus::HostBus;
use endat_hdl::config::SafetyParts;

/// Reads the table, for a card with this bus, on which some channel speaks EnDat or none; `None` if something is wrong.
pub fn read(table: &Table<'_, '_>, bus: Option<HostBus>, has_endat: bool) -> Option<SafetyParts> {
    let mut parts = SafetyParts::default();
    let marks = &mut [&mut parts.recovery_counter, &mut parts.second_interface];
    let named = read_parts(table, &["recovery_counter", "second_interface"], marks)?;
    let Some(last) = named.last() else {
        return Some(parts);
    };
    // What is said of one part names that part; what is said of all, the last.
    let counter = named
        .iter()
        .find(|(_, text)| text == "\"recovery_counter\"");
    let ((line, shown), remedy) = match bus {
        Some(HostBus::Bare) => (last, "host.bus = \"none\" has no registers, and all results as ports; choose another bus, or leave [safety] out"),
        _ if !has_endat && parts.recovery_counter => (counter.unwrap_or(last), "no channel speaks EnDat, and T-format has no recovery time; leave it out"),
        _ => return Some(parts),
    };
    table.complain(*line, "parts", shown, remedy);
    None
}
