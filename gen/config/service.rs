//! The table `[service]`.

use super::parts::read_parts;
use super::reader::{At, Table};
use endat_hdl::config::{ServiceParts, LIST};

/// Reads the table; everything in it may be left out. `None` if something is wrong.
pub fn read(table: &Table<'_, '_>) -> Option<ServiceParts> {
    let infos = read_infos(table);
    let mut parts = ServiceParts::default();
    let named = read_parts(
        table,
        &["requests", "diagnosis", "continuous", "initialise"],
        &mut [
            &mut parts.requests,
            &mut parts.diagnosis,
            &mut parts.continuous,
            &mut parts.initialise,
        ],
    )?;
    if let (Some((line, shown)), false) = (named.first(), parts.requests) {
        let text = "every other part takes requests; add \"requests\"";
        table.complain(*line, "parts", shown, text);
        return None;
    }
    let infos = infos?;
    if let (Some(first), false) = (infos.first(), parts.requests) {
        let text = "a card without requests has no list of additional informations; add \"requests\" to service.parts";
        table.complain(first.line, "infos", &format!("0x{:02X}", first.value), text);
        return None;
    }
    for (place, info) in parts.infos.iter_mut().zip(&infos) {
        *place = info.value as u8;
    }
    Some(parts)
}

/// Additional informations that are selected from the start on; `None` for what cannot be.
fn read_infos(table: &Table<'_, '_>) -> Option<Vec<At<u64>>> {
    const CODES: &str = "no additional information; use MRS codes 0x40..0x4E and 0x50..0x5E";
    let Some(infos) = table.integers("infos", CODES) else {
        return if table.has("infos") {
            None
        } else {
            Some(vec![])
        };
    };
    for (index, info) in infos.iter().enumerate() {
        let shown = format!("0x{:02X}", info.value);
        let text = match info.value {
            _ if index >= LIST => {
                format!("more than {LIST} additional informations; leave some out")
            }
            code if infos[..index].iter().any(|i| i.value == code) => {
                "stands twice; remove one".into()
            }
            0x40..=0x4E | 0x50..=0x5E => continue,
            _ => CODES.into(),
        };
        table.complain(info.line, "infos", &shown, &text);
        return None;
    }
    Some(infos)
}
