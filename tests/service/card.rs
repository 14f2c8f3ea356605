//! The service behind the host link of a card.

use super::rig::{quick, times};
use endat_gen::config::load_preset;
use endat_hdl::{
    card::Card,
    elaborate::elaborate,
    regs::{Register, SERVICE},
};
use endat_sim::{
    bench::{Bench, Link, PinNames},
    encoder::{RCN_8510, ROQ_437},
    engine::Compiled,
    line::LineConfig,
    MS,
};
use rust_hdl::prelude::Block;

/// System clock cycles in a UART bit.
const BIT: u64 = 8;

/// A host at the card's UART.
struct Host {
    bench: Bench<Compiled>,
}

impl Host {
    fn new() -> Self {
        let mut config = load_preset("s6_two_channel_service").unwrap().card;
        config.uart_bit_cycles = BIT;
        let times = endat_hdl::service::program::ServiceTimes {
            system_khz: (config.system_hz / 1_000) as u32,
            ..times(true)
        };
        let mut block = Card::with_times(&config, 100, &times);
        block.connect_all();
        let design = elaborate(&block, "card").unwrap();
        let engine = Compiled::new(&design).unwrap();
        let link = |encoder| Link::new(LineConfig::cable(10.0), quick(encoder));
        let links = vec![
            (PinNames::card(0), link(RCN_8510.encoder())),
            (PinNames::card(1), link(ROQ_437.encoder())),
        ];
        let mut bench = Bench::new(engine, config.system_hz, links);
        bench.set("uart_rx_i", 1);
        bench.reset();
        Self { bench }
    }

    fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let bits = u16::from(*byte) << 1 | 1 << 9;
            for i in 0..10 {
                self.bench.set("uart_rx_i", (bits >> i & 1).into());
                self.bench.run_cycles(BIT);
            }
        }
    }

    fn receive(&mut self) -> u8 {
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

    fn address(name: &str, channel: usize) -> u16 {
        let register: &Register = SERVICE.register(name).expect("a register");
        SERVICE.address(register, channel)
    }

    fn read(&mut self, name: &str, channel: usize) -> u32 {
        let [high, low] = Self::address(name, channel).to_be_bytes();
        self.send(&[2, 1, 0, 0, high, low]);
        let bytes = [0; 4].map(|_: u8| self.receive());
        u32::from_be_bytes(bytes)
    }

    fn write(&mut self, name: &str, channel: usize, value: u32) {
        let [high, low] = Self::address(name, channel).to_be_bytes();
        let [a, b, c, d] = value.to_be_bytes();
        self.send(&[1, 1, 0, 0, high, low, a, b, c, d]);
        self.bench.run_cycles(20 * BIT);
    }

    fn wait_for(&mut self, name: &str, channel: usize, done: impl Fn(u32) -> bool) -> u32 {
        for _ in 0..2_000 {
            let value = self.read(name, channel);
            if done(value) {
                return value;
            }
            self.bench.run_cycles(10_000);
        }
        panic!("{name} of channel {channel} never comes");
    }
}

#[test]
fn both_channels_are_initialised_and_take_requests_over_the_host_link() {
    let mut host = Host::new();
    for (channel, width) in [(0, 29), (1, 37)] {
        host.wait_for("state", channel, |s| s & 1 == 1);
        assert_eq!(host.read("progress", channel), 0);
        assert_eq!(host.read("position_bits", channel) & 0x3F, width);
        assert_eq!(host.read("position_bits", channel) >> 16, 1);
    }
    assert_ne!(host.read("serial_1", 0), host.read("id_1", 0));
    // Each channel has its own memory, and keeps what is written.
    for channel in [0, 1] {
        host.write("offset_low", channel, 0x1234_5678 + channel as u32);
        host.write("list_0", channel, 0x4C + channel as u32);
        host.write("list_length", channel, 1);
    }
    assert_eq!(host.read("offset_low", 0), 0x1234_5678);
    assert_eq!(host.read("offset_low", 1), 0x1234_5679);
    // The preset's timer triggers ten thousand times a second: the selections ride, and the slots fill.
    for (channel, celvin) in [(0, 2954), (1, 2982)] {
        let slot = host.wait_for("slot_0", channel, |s| s != 0);
        assert_eq!(slot & 0xFFFF, celvin);
    }
    // A request with a frame of its own, between the triggers.
    host.write("request", 1, 0x0E << 24 | 0xA1 << 16);
    let finished = host.wait_for("request_state", 1, |s| s & 1 == 0 && s >> 16 == 1);
    assert_eq!(finished & 0xF0, 0, "fulfilled");
    host.write("request", 1, 0x23 << 24 | 0x0D << 16);
    host.wait_for("request_state", 1, |s| s & 1 == 0 && s >> 16 == 2);
    assert_eq!(host.read("answer", 1), 0x0D_8025);
    assert_eq!(host.bench.conflicts(0), []);
    assert_eq!(host.bench.conflicts(1), []);
}
