//! The card behind a bus that several topics take.

use endat_hdl::card::bus::HostBus;

/// Every front with words of 32 bits.
pub const WORD_BUSES: [HostBus; 4] = [
    HostBus::Apb,
    HostBus::Wishbone,
    HostBus::AxiLite,
    HostBus::AhbLite,
];

/// A configuration of two channels with a bus.
pub fn text(bus: HostBus, more: &str) -> String {
    let name = bus.name();
    format!(
        "name = \"{name}_card\"\n[clock]\nsystem_hz = 100_000_000\n[endat]\nclock_hz = 3_125_000\n\
         [[channel]]\nposition_bits = 29\ncommand = \"111000\"\n[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n\
         [trigger]\nsample_hz = 10_000\nsources = [\"register\"]\n[host]\nbus = \"{name}\"\n{more}"
    )
}
