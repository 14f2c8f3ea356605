//! The table `[safety]`.

use super::parts::read_parts;
use super::reader::Table;
use endat_hdl::bus::HostBus;
use endat_hdl::config::SafetyParts;

/// Reads the table, for a card with this bus, on which some channel speaks EnDat or none; `None` if something is wrong.
pub fn read(table: &Table<'_, '_>, bus: Option<HostBus>, has_endat: bool) -> Option<SafetyParts> {
    let mut parts = SafetyParts::default();
    let marks = &mut [&mut parts.recovery_counter];
    let named = read_parts(table, &["recovery_counter"], marks)?;
    let Some((line, shown)) = named.last() else {
        return Some(parts);
    };
    let remedy = match bus {
        Some(HostBus::Bare) => "host.bus = \"none\" has no registers to read it from; choose another bus, or leave [safety] out",
        _ if !has_endat => "no channel speaks EnDat, and T-format has no recovery time; leave [safety] out",
        _ => return Some(parts),
    };
    table.complain(*line, "parts", shown, remedy);
    None
}
