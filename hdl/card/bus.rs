//! Fronts: a card on a bus of a system on chip or of a processor instead of a UART.
//!
//! ```text
//! bus pins <-> front (ApbFront, ...) <-> WordAccess <-> CardCore <-> trigger_i, endat_*, led_*
//! ```
//!
//! A front implements its bus but no registers. [`word_access`] converts one word of the bus into the bank's bytes and decides which
//! words belong to one snapshot. See `docs/bus.md`.

pub mod ahb_lite;
pub mod apb;
pub mod axi_lite;
pub mod parallel;
pub mod spi;
pub mod strobes;
pub mod wishbone;
pub mod word_access;

/// Connection between the registers and the host.
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
    /// AMBA 3 AHB-Lite subordinate.
    AhbLite,
    /// SPI slave, mode 0, with check sums.
    Spi,
    /// Asynchronous bus with eight registers of 16 bits.
    Parallel,
    /// No bus: one encoder port with its signals, no registers.
    Bare,
}

/// Properties of a bus.
#[derive(Clone, Copy, Debug)]
pub struct BusRow {
    /// Name in a configuration.
    pub name: &'static str,
    /// Description.
    pub means: &'static str,
    /// Place of its signals.
    pub place: Place,
}

/// Place of the signals of a bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// To pins of a board.
    Pins,
    /// Inside the chip, at addresses of a system.
    System,
    /// Inside the chip, without addresses.
    Inside,
}

const fn row(name: &'static str, means: &'static str, place: Place) -> BusRow {
    BusRow { name, means, place }
}

impl HostBus {
    /// All buses, in the order of the documentation.
    pub const ALL: [Self; 8] = [
        Self::Uart,
        Self::Apb,
        Self::Wishbone,
        Self::AxiLite,
        Self::AhbLite,
        Self::Spi,
        Self::Parallel,
        Self::Bare,
    ];

    /// Properties of the bus.
    pub const fn row(self) -> BusRow {
        use Place::{Inside, Pins, System};
        match self {
            Self::Uart => row("uart", "UART in the UARTBone format", Pins),
            Self::Apb => row("apb", "AMBA 3 APB", System),
            Self::Wishbone => row("wishbone", "Wishbone B4, classic", System),
            Self::AxiLite => row("axi_lite", "AXI4-Lite", System),
            Self::AhbLite => row("ahb_lite", "AMBA 3 AHB-Lite", System),
            Self::Spi => row("spi", "SPI, mode 0, with check sums", Pins),
            Self::Parallel => row(
                "parallel",
                "asynchronous bus with eight registers of 16 bits",
                Pins,
            ),
            Self::Bare => row(
                "none",
                "one encoder port with its signals, no registers",
                Inside,
            ),
        }
    }

    /// Name in a configuration.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// The bus of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|bus| bus.name() == name)
    }

    /// True if its signals stay inside the chip, so that no board has pins for them.
    pub const fn is_internal(self) -> bool {
        !matches!(self.row().place, Place::Pins)
    }

    /// True if the registers have addresses in a system.
    pub const fn has_base(self) -> bool {
        matches!(self.row().place, Place::System)
    }
}
