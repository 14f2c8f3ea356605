//! The table `[service]`.

use super::keys::{INFOS, INFOS_RANGES, SERVICE_PARTS};
use super::parts::{check_leader, read_parts};
use super::reader::{At, Table};
use endat_hdl::config::{ServiceParts, LIST};

/// Reads the table; everything in it may be left out. `None` if something is wrong.
pub fn read(table: &Table<'_, '_>, has_endat: bool) -> Option<ServiceParts> {
    let infos = read_infos(table);
    let mut parts = ServiceParts::default();
    let named = read_parts(
        table,
        &SERVICE_PARTS,
        &mut [
            &mut parts.requests,
            &mut parts.diagnosis,
            &mut parts.continuous,
            &mut parts.initialise,
        ],
    )?;
    check_leader(table, &SERVICE_PARTS, parts.requests, &named)?;
    let infos = infos?;
    if let (Some(first), false) = (infos.first(), parts.requests) {
        let text = match has_endat {
            true => "a card without requests has no list of additional data; add \"requests\" to service.parts, or leave it out",
            false => "takes a channel that speaks EnDat, and this card has none; leave it out",
        };
        table.complain(
            first.line,
            INFOS.name,
            &format!("0x{:02X}", first.value),
            text,
        );
        return None;
    }
    for (place, info) in parts.infos.iter_mut().zip(&infos) {
        *place = info.value as u8;
    }
    Some(parts)
}

/// Additional data that are selected from the start on; `None` for what cannot be.
fn read_infos(table: &Table<'_, '_>) -> Option<Vec<At<u64>>> {
    const CODES: &str = "no additional data; use MRS codes 0x40..0x4E and 0x50..0x5E";
    let Some(infos) = table.integers(&INFOS, CODES) else {
        return if table.has(INFOS.name) {
            None
        } else {
            Some(vec![])
        };
    };
    for (index, info) in infos.iter().enumerate() {
        let shown = format!("0x{:02X}", info.value);
        let text = match info.value {
            _ if index >= LIST => {
                format!(
                    "more than {LIST} codes of additional data; keep {LIST}, leave the rest out"
                )
            }
            code if infos[..index].iter().any(|i| i.value == code) => {
                "stands twice; remove one".into()
            }
            code if INFOS_RANGES.iter().any(|range| range.contains(&code)) => continue,
            _ => CODES.into(),
        };
        table.complain(info.line, INFOS.name, &shown, &text);
        return None;
    }
    Some(infos)
}
