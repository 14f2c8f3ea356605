//! Fronts: the card behind a bus of a system on chip or of a processor instead of a UART.
//!
//! ```text
//! bus pins <-> front (ApbFront, ...) <-> WordAccess <-> CardCore <-> trigger_i, endat_*, led_*
//! ```
//!
//! A front knows its bus and nothing of registers; [`word_access`] turns one word of it into the bank's bytes and decides which
//! words belong to one moment. See `docs/bus.md`.

pub mod apb;
pub mod axi_lite;
pub mod parallel;
pub mod spi;
pub mod strobes;
pub mod wishbone;
pub mod word_access;

/// What stands between the registers and the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HostBus {
    /// UART in the UARTBone format.
    #[default]
    Uart,
    /// AMBA 3 APB slave.
    Apb,
    /// Wishbone B4 classic slave.
    Wishbone,
    /// AXI4-Lite slave.
    AxiLite,
    /// SPI slave, mode 0, with check sums.
    Spi,
    /// Asynchronous bus with eight registers of 16 bits.
    Parallel,
    /// Nothing: one encoder port with its signals, no registers.
    Bare,
}

impl HostBus {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Uart,
        Self::Apb,
        Self::Wishbone,
        Self::AxiLite,
        Self::Spi,
        Self::Parallel,
        Self::Bare,
    ];

    /// Name in a configuration.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uart => "uart",
            Self::Apb => "apb",
            Self::Wishbone => "wishbone",
            Self::AxiLite => "axi_lite",
            Self::Spi => "spi",
            Self::Parallel => "parallel",
            Self::Bare => "none",
        }
    }

    /// The bus of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|bus| bus.name() == name)
    }

    /// Whether its signals stay inside the chip, so that no board has pins for them.
    pub const fn is_internal(self) -> bool {
        matches!(
            self,
            Self::Apb | Self::Wishbone | Self::AxiLite | Self::Bare
        )
    }
}
