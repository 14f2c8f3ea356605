//! A host at the UART of a card on its bench.

use endat_gen::config::load_preset;
use endat_hdl::{
    config::CardConfig,
    regs::{Block, Register},
};
use endat_sim::{
    bench::{Bench, Link, PinNames},
    MS,
};
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::Compiled;

/// System clock cycles in a UART bit.
const BIT: u64 = 8;

/// Reads and writes words of a card.
pub struct Host {
    /// The card.
    pub bench: Bench<Compiled>,
}

/// The card of a preset, with a quick UART.
pub fn card(preset: &str) -> CardConfig {
    let mut config = load_preset(preset).unwrap().card;
    config.uart_bit_cycles = BIT;
    config
}

impl Host {
    /// A card with a link on each channel, reset.
    pub fn new(mut card: impl rust_hdl::prelude::Block, system_hz: u64, links: Vec<Link>) -> Self {
        card.connect_all();
        Self::of_design(&elaborate(&card, "card").unwrap(), system_hz, links)
    }

    /// The same of a card that is elaborated already.
    pub fn of_design(design: &Design, system_hz: u64, links: Vec<Link>) -> Self {
        let engine = Compiled::new(design).unwrap();
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
