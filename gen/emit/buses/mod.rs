//! The buses that a card may stand behind.

mod ahb_lite;
mod apb;
mod axi_lite;
mod bare;
pub mod parallel;
mod spi;
mod uart;
mod wishbone;

use crate::front::Front;
use endat_hdl::card::bus::HostBus;

/// What there is to know of a bus.
pub fn front(bus: HostBus) -> &'static Front {
    match bus {
        HostBus::Uart => &uart::FRONT,
        HostBus::Apb => &apb::FRONT,
        HostBus::Wishbone => &wishbone::FRONT,
        HostBus::AxiLite => &axi_lite::FRONT,
        HostBus::AhbLite => &ahb_lite::FRONT,
        HostBus::Spi => &spi::FRONT,
        HostBus::Parallel => &parallel::FRONT,
        HostBus::Bare => &bare::FRONT,
    }
}
