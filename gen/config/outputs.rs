//! The table `[outputs]`.

use super::keys::OUTPUT_PARTS;
use super::parts::read_parts;
use super::reader::Table;
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::OutputParts;

/// Reads the table, for a card with this bus, on a board or not; `None` if something is wrong.
pub fn read(table: &Table<'_, '_>, bus: Option<HostBus>, has_board: bool) -> Option<OutputParts> {
    let mut parts = OutputParts::default();
    let marks = &mut [&mut parts.position, &mut parts.interrupt];
    let named = read_parts(table, &OUTPUT_PARTS, marks)?;
    let Some(last) = named.last() else {
        return Some(parts);
    };
    // What is said of one part names that part; what is said of all, the last.
    let position = named.iter().find(|(_, text)| text == "\"position\"");
    let (part, remedy) = match bus {
        Some(HostBus::Uart) => (
            last,
            "a card with a UART has no ports for them; choose another host.bus, or leave [outputs] out",
        ),
        Some(HostBus::Bare) => (
            last,
            "host.bus = \"none\" has the whole position and the cause as ports; leave [outputs] out",
        ),
        _ if has_board && parts.position => (
            position.unwrap_or(last),
            "a card with a board top is the whole device, nothing else in it could take the positions; leave \"position\" out, or leave [board] out",
        ),
        _ => return Some(parts),
    };
    table.complain(part.0, OUTPUT_PARTS.name, &part.1, remedy);
    None
}
