//! A host at the UART of a card on its bench.

use endat_config::{parse, preset, Project};
use endat_hdl::{
    config::CardConfig,
    regs::{Block, Register},
};
use endat_sim::{
    bench::{Bench, Link, PinNames},
    MS,
};
use rtl_design::engine::Compiled;

/// System clock cycles in a UART bit.
const BIT: u64 = 8;

/// Reads and writes words of a card.
pub struct Host {
    /// The card.
    pub bench: Bench<Compiled>,
}

/// The card of a preset for a system clock of 100 MHz, at this clock, with a quick UART and without its board.
pub fn card(name: &str, system_khz: u64) -> CardConfig {
    card_with(name, system_khz, str::to_owned)
}

/// The same with a change of its configuration.
pub fn card_with(name: &str, system_khz: u64, change: impl Fn(&str) -> String) -> CardConfig {
    let mut config = project(name, system_khz, change).card;
    config.uart_bit_cycles = BIT;
    config
}

/// The same as a project.
pub fn project(name: &str, system_khz: u64, change: impl Fn(&str) -> String) -> Project {
    let text = preset(name).unwrap().split("\n[board]").next().unwrap();
    let mut text = text.to_owned();
    let system = format!("system_hz = {}", system_khz * 1_000);
    let baud = format!("baud = {}", system_khz * 1_000 / BIT);
    for (from, to) in [
        ("system_hz = 100_000_000", system.as_str()),
        ("baud = 3_000_000", baud.as_str()),
    ] {
        assert!(text.contains(from), "{name}: {from}");
        text = text.replacen(from, to, 1);
    }
    parse("card.toml", &change(&text)).unwrap()
}

impl Host {
    /// This card with a link on each channel, reset.
    pub fn new(engine: Compiled, system_hz: u64, links: Vec<Link>) -> Self {
        let links = links.into_iter().enumerate();
        let links = links.map(|(n, link)| (PinNames::card(n), link)).collect();
        let mut bench = Bench::new(engine, system_hz, links);
        bench.set("uart_rx_i", 1);
        bench.power_up();
        Self { bench }
    }

    /// Sends bytes.
    pub fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let bits = u16::from(*byte) << 1 | 1 << 9;
            for i in 0..10 {
                self.bench.set("uart_rx_i", (bits >> i & 1).into());
                self.bench.run_cycles(BIT);
            }
        }
    }

    /// The next byte.
    pub fn receive(&mut self) -> u8 {
        let started = self.bench.run_until_done(MS, |b| b.get("uart_tx_o") == 0);
        assert!(started, "an answer");
        self.bench.run_cycles(BIT / 2);
        let mut byte = 0;
        for i in 0..8 {
            self.bench.run_cycles(BIT);
            byte |= (self.bench.get("uart_tx_o") as u8) << i;
        }
        self.bench.run_cycles(BIT);
        byte
    }

    fn address(block: &Block, name: &str, channel: usize) -> u16 {
        let register: &Register = block.register(name).expect("a register");
        block.address(register, channel)
    }

    /// A word.
    pub fn read(&mut self, block: &Block, name: &str, channel: usize) -> u32 {
        let [high, low] = Self::address(block, name, channel).to_be_bytes();
        self.send(&[2, 1, 0, 0, high, low]);
        u32::from_be_bytes([0; 4].map(|_: u8| self.receive()))
    }

    /// Writes a word, and waits until that is done.
    pub fn write(&mut self, block: &Block, name: &str, channel: usize, value: u32) {
        let [high, low] = Self::address(block, name, channel).to_be_bytes();
        let [a, b, c, d] = value.to_be_bytes();
        self.send(&[1, 1, 0, 0, high, low, a, b, c, d]);
        self.bench.run_cycles(20 * BIT);
    }
}
