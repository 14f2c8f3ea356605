//! The table `[outputs]`.

use super::reader::Table;
use super::schema::read_parts;
use endat_hdl::bus::HostBus;
use endat_hdl::config::OutputParts;

/// Reads the table, for a card with this bus, on a board or not; `None` if something is wrong.
pub fn read(table: &Table<'_, '_>, bus: Option<HostBus>, has_board: bool) -> Option<OutputParts> {
    let mut parts = OutputParts::default();
    let marks = &mut [&mut parts.position, &mut parts.interrupt];
    let (line, shown) = match read_parts(table, &["position", "interrupt"], marks)? {
        Some(last) => last,
        None => return Some(parts),
    };
    let remedy = match bus {
        Some(HostBus::Uart) => {
            "a card with a UART is the whole device, nothing else in it could take them; choose another host.bus, or leave [outputs] out"
        }
        Some(HostBus::Bare) => {
            "host.bus = \"none\" has the whole position and the cause as ports; leave [outputs] out"
        }
        _ if has_board && parts.position => {
            "a card with a board top is the whole device, nothing else in it could take the positions; leave \"position\" out, or leave [board] out"
        }
        _ => return Some(parts),
    };
    table.complain(line, "parts", &shown, remedy);
    None
}
