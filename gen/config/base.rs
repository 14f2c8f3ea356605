//! The keys of `[host]` besides the bus, and which bus takes them.

use super::keys::{Key, BASE_ADDRESS as KEY, SCK_HZ};
use super::reader::Table;
use endat_hdl::card::bus::HostBus;
use endat_regs::MAP_BYTES;

/// Whether a card with this bus takes a key.
pub fn takes(bus: HostBus, key: &Key) -> bool {
    match key.name {
        name if name == KEY.name => bus.has_base(),
        name if name == SCK_HZ.name => bus == HostBus::Spi,
        _ => true,
    }
}

/// Reads where a system has the registers; `None` if something is wrong.
pub fn read(table: &Table<'_, '_>, bus: Option<HostBus>) -> Option<u32> {
    let limits = KEY.limits(None);
    let Some(base) = table.integer(&KEY, &limits) else {
        return (!table.has(KEY.name)).then_some(0);
    };
    let problem = match u32::try_from(base.value) {
        _ if !bus.is_none_or(|bus| takes(bus, &KEY)) => {
            let takers = HostBus::ALL.iter().filter(|bus| bus.has_base());
            let takers: Vec<&str> = takers.map(|bus| bus.name()).collect();
            format!(
                "has a meaning with {} only; leave it out",
                takers.join(", ")
            )
        }
        Err(_) => limits.to_string(),
        Ok(value) if value % MAP_BYTES != 0 => {
            let below = value - value % MAP_BYTES;
            format!("is no multiple of 0x{MAP_BYTES:X}, the size of the register map; use 0x{below:08X}")
        }
        Ok(value) => return Some(value),
    };
    table.complain(
        base.line,
        KEY.name,
        &format!("0x{:08X}", base.value),
        &problem,
    );
    None
}

/// The rate of SPI's clock, which only decides whether the card can follow it.
pub fn check_sck(host: &Table<'_, '_>, bus: Option<HostBus>, system_hz: Option<u64>) {
    if !bus.is_none_or(|bus| takes(bus, &SCK_HZ)) {
        host.refuse(&SCK_HZ, "has a meaning with spi only; leave it out");
        return;
    }
    let limits = SCK_HZ.limits(system_hz);
    if let Some(sck) = host.integer(&SCK_HZ, &limits) {
        host.check(&SCK_HZ, &sck, &limits);
    }
}
