//! What the program has to know of a bus that a card stands behind: one row is all of it, [`crate::buses`] lists them.

use endat_console::error::CommandError;
use endat_hdl::card::uart_bridge::ADDRESS_BITS;
use endat_hdl::config::CardConfig;
use endat_hdl::endat::service::program::ServiceTimes;
use endat_sim::bench::Bench;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;
use serde::Serialize;

/// A bus, and the card behind it.
pub struct Front {
    /// The card with this front.
    pub design: DesignOf,
    /// The host of the emitted bench; none for a port without registers.
    pub bench_host: Option<BenchHost>,
    /// A controller at its pins; none where a host has bytes of its own, and where there are no registers.
    pub controller: Option<&'static dyn Controller>,
    /// The bus as tools know it that connect by interface; none where no tool does.
    pub interface: Option<BusInterface>,
}

/// A card by its name, with these waits of its services, and with this limit on pauses within a command over the UART, in microseconds.
pub type DesignOf = fn(&CardConfig, &str, &ServiceTimes, u64) -> Result<Design, CommandError>;

/// A block as a design.
pub fn design_of(mut card: impl Block, name: &str) -> Result<Design, CommandError> {
    card.connect_all();
    elaborate(&card, name).map_err(|e| CommandError::fault("design", &e))
}

/// The bench's host at one kind of bus.
pub struct BenchHost {
    /// What it declares, and its tasks: `transfer` if it moves words, otherwise `bus_write` and `bus_read`.
    pub text: &'static str,
    /// The same in VHDL, in parts: signals, processes, procedures, steps.
    pub vhdl: &'static str,
    /// It moves one word at a time.
    pub moves_words: bool,
    /// Ports of the card, and what each is connected to.
    pub connections: &'static [(&'static str, &'static str)],
}

/// The card of a controller.
pub type Pins = Bench<Compiled>;

/// Who moves words over the pins of a card.
pub trait Controller: Sync {
    /// Puts the pins to rest.
    fn rest(&self, _: &mut Pins) {}

    /// A word; none if no answer comes.
    fn read_word(&self, card: &mut Pins, address: u16) -> Option<u32>;

    /// Writes a word.
    fn write(&self, card: &mut Pins, address: u16, word: u32);

    /// Words of addresses that rise; what does not answer is 0.
    fn burst(&self, card: &mut Pins, address: u16, count: usize) -> Vec<u32> {
        let addresses = (0..count as u16).map(|n| address.wrapping_add(n));
        let words = addresses.map(|a| self.read_word(card, a).unwrap_or(0));
        words.collect()
    }

    /// Reads `count` words, from addresses that rise or from one; what does not answer is 0.
    fn read(&self, card: &mut Pins, address: u16, count: usize, rises: bool) -> Vec<u32> {
        match rises {
            true => self.burst(card, address, count),
            false => (0..count)
                .flat_map(|_| self.burst(card, address, 1))
                .collect(),
        }
    }

    /// Status and position of channel 0 from registers that follow its results; none where a host reads the words of the map.
    fn newest(&self, _: &mut Pins) -> Option<Vec<u32>> {
        None
    }

    /// Words of results that are read one by one are of one moment only while they are held.
    fn must_hold(&self) -> bool {
        false
    }

    /// Whether the words are the registers of a card.
    fn has_registers(&self) -> bool {
        true
    }

    /// How many words there are; what is beyond reads as 0.
    fn addresses(&self) -> u32 {
        1 << ADDRESS_BITS
    }
}

/// No access takes longer, in system clock cycles: what does not answer by then is a fault of the core.
pub const ACCESS_CYCLES_MAX: u64 = 10_000;

/// Sets inputs.
pub fn set_all(card: &mut Pins, pins: &[(&str, u32)]) {
    for (name, level) in pins {
        card.set(name, (*level).into());
    }
}

/// Runs to the cycle in which one of these is high; false if that never comes.
pub fn comes(card: &mut Pins, names: &[&str]) -> bool {
    for _ in 0..ACCESS_CYCLES_MAX {
        if names.iter().any(|name| card.get(name) != 0) {
            return true;
        }
        card.tick();
    }
    false
}

/// An input that nothing looks at.
#[derive(Clone, Serialize)]
pub struct Unused {
    /// Its name.
    pub name: &'static str,
    /// What the standard calls it.
    pub logical: &'static str,
    /// Its bits.
    pub width: usize,
}

/// A bus as tools know it.
pub struct BusInterface {
    /// Its name: how its ports begin.
    pub name: &'static str,
    /// The definition that Vivado has of it; empty where it has none.
    pub vivado: &'static str,
    /// Vendor, library, name and version of IP-XACT's definition; none where it has no addresses of a system.
    pub ipxact: Option<[&'static str; 4]>,
    /// What Platform Designer calls it; empty where it has no such bus.
    pub platform_designer: &'static str,
    /// Inputs that Platform Designer asks for and the core has no use for.
    pub unused: &'static [Unused],
    /// What the standard calls a port, by what stands behind the name; in capitals if it is not here.
    pub logical: &'static [(&'static str, &'static str)],
    /// End of the port with the address, and bytes of what it counts; none without addresses of a system.
    pub address: Option<(&'static str, u64)>,
    /// What LiteX has for it.
    pub litex: Option<LitexBus>,
}

/// A bus in LiteX.
pub struct LitexBus {
    /// The module with its class.
    pub module: &'static str,
    /// The class with its arguments; `BITS` stands for those of the address.
    pub class: &'static str,
    /// Where its record has a port, by what stands behind the name, and the width.
    pub field: fn(&str, usize) -> String,
}
