//! The buses that a card may stand behind.

mod ahb_lite;
mod apb;
mod axi_lite;
mod bare;
pub(crate) mod parallel;
mod spi;
mod uart;
mod wishbone;

use crate::front::Front;
use endat_hdl::card::bus::HostBus;

/// What there is to know of a bus.
pub(crate) fn front(bus: HostBus) -> &'static dyn Front {
    match bus {
        HostBus::Uart => &uart::Uart,
        HostBus::Apb => &apb::Apb,
        HostBus::Wishbone => &wishbone::Wishbone,
        HostBus::AxiLite => &axi_lite::AxiLite,
        HostBus::AhbLite => &ahb_lite::AhbLite,
        HostBus::Spi => &spi::Spi,
        HostBus::Parallel => &parallel::Parallel,
        HostBus::Bare => &bare::Bare,
    }
}
