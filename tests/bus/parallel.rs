//! The card behind the parallel bus.

use super::Master;
use endat_hdl::card::bus::HostBus;
use endat_hdl::regs::{words, CARD, CARD_CONFIG};
use std::collections::BTreeMap;

/// A host.
pub struct Host(pub Master);

impl Host {
    fn new() -> Self {
        Self::at(Master::new(HostBus::Parallel, ""))
    }

    /// At this card.
    pub fn at(master: Master) -> Self {
        let mut host = Self(master);
        for strobe in ["bus_cs_n_i", "bus_rd_n_i", "bus_wr_n_i"] {
            host.0.set(strobe, 1);
        }
        host.0.bench.run_cycles(300);
        host
    }

    /// Reads as soon as the page says that the data is there: 4 clocks after the register has been selected.
    pub fn get(&mut self, register: u32) -> u32 {
        let master = &mut self.0;
        assert_eq!(master.bench.get("bus_data_oe"), 0);
        master.set("bus_address_i", register);
        master.set("bus_cs_n_i", 0);
        master.set("bus_rd_n_i", 0);
        master.bench.run_cycles(4);
        assert_eq!(master.bench.get("bus_data_oe"), 1);
        let data = master.bench.get("bus_data_o") as u32;
        for _ in 0..5 {
            master.bench.run_cycles(1);
            assert_eq!(master.bench.get("bus_data_o") as u32, data, "it is held");
        }
        master.set("bus_rd_n_i", 1);
        master.set("bus_cs_n_i", 1);
        assert_eq!(master.bench.get("bus_data_oe"), 0, "free at once");
        let pause = master.rng.in_range(3, 6);
        master.bench.run_cycles(pause);
        data
    }

    /// Writes; the data leaves the lines with the strobe.
    pub fn put(&mut self, register: u32, data: u32) {
        let master = &mut self.0;
        master.set("bus_address_i", register);
        master.set("bus_data_i", data);
        master.set("bus_cs_n_i", 0);
        master.set("bus_wr_n_i", 0);
        let long = master.rng.in_range(3, 6);
        master.bench.run_cycles(long);
        master.set("bus_wr_n_i", 1);
        master.set("bus_data_i", !data & 0xffff);
        master.set("bus_address_i", !register & 7);
        let pause = master.rng.in_range(3, 6);
        master.bench.run_cycles(pause);
        master.set("bus_cs_n_i", 1);
    }

    fn wait(&mut self) {
        for _ in 0..200 {
            if self.get(5) >> 15 == 0 {
                return;
            }
        }
        panic!("busy for ever");
    }

    fn read(&mut self, address: u16) -> u32 {
        self.put(5, address.into());
        self.wait();
        assert_eq!(self.get(5), u32::from(address));
        self.get(6) | self.get(7) << 16
    }

    fn write(&mut self, address: u16, value: u32) {
        self.put(5, u32::from(address) | 1 << 14);
        self.put(6, value & 0xffff);
        self.put(7, value >> 16);
        self.wait();
    }

    /// Position and status of the direct registers.
    fn direct(&mut self) -> (u64, u32) {
        let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|register| self.get(register));
        (
            u64::from(a) | u64::from(b) << 16 | u64::from(c) << 32,
            d << 16 | e,
        )
    }
}

fn at(block: &endat_hdl::regs::Block, name: &str) -> u16 {
    block.address(block.register(name).unwrap(), 0)
}

#[test]
fn the_window_shows_every_register_as_the_table_says() {
    let mut host = Host::new();
    let config = host.0.config.clone();
    let words = words(&config).into_iter();
    let words: BTreeMap<u16, u32> = words.map(|w| (w.address, w.start)).collect();
    for address in (0..0x20).chain(0xfe..0x118).chain([0x17f, 0x400, 0x7ff]) {
        let expected = words.get(&address).copied().unwrap_or(0);
        assert_eq!(host.read(address), expected, "{address:#x}");
    }
}

#[test]
fn words_are_written_through_the_window() {
    let mut host = Host::new();
    let mut model = [0x108, 0x109, 0x10a, 0x110].map(|address| (address, host.read(address)));
    for _ in 0..100 {
        let at = host.0.rng.in_range(0, 3) as usize;
        if host.0.rng.in_range(0, 1) == 1 {
            model[at].1 = host.0.rng.next_u64() as u32;
            host.write(model[at].0, model[at].1);
        } else {
            assert_eq!(host.read(model[at].0), model[at].1);
        }
    }
}

#[test]
fn the_direct_registers_have_the_position_of_the_selected_channel() {
    let mut host = Host::new();
    for round in 1..=3 {
        host.write(at(&CARD, "trigger_now"), 1);
        host.0.bench.run_cycles(60_000);
        for channel in [0usize, 1] {
            host.put(5, (channel as u32) << 11 | 1 << 14);
            host.wait();
            let (position, status) = host.direct();
            let frame = host.0.bench.frames(channel).last().expect("a frame");
            assert_eq!(position, frame.position, "channel {channel}");
            assert_eq!(status, 0xc0_0000 | round);
        }
    }
}

/// A processor may keep a register selected while its word arrives: half of an old word and half of a new one is neither.
#[test]
fn every_register_stands_still_while_it_is_selected() {
    let mut host = Host::new();
    host.write(0x108, 0xaaaa_5555);
    for register in 0..8 {
        for address in [0x108, 0x000] {
            host.put(5, address);
            let master = &mut host.0;
            master.set("bus_address_i", register);
            master.set("bus_cs_n_i", 0);
            master.set("bus_rd_n_i", 0);
            master.bench.run_cycles(4);
            let data = master.bench.get("bus_data_o");
            for cycle in 0..300 {
                master.bench.run_cycles(1);
                assert_eq!(
                    master.bench.get("bus_data_o"),
                    data,
                    "register {register}, {cycle} clocks later"
                );
            }
            // Another register behind the same strobe is another one after 4 clocks.
            master.set("bus_address_i", 7 - register);
            master.bench.run_cycles(4);
            let other = master.bench.get("bus_data_o");
            master.set("bus_rd_n_i", 1);
            master.set("bus_cs_n_i", 1);
            master.bench.run_cycles(4);
            assert_eq!(u128::from(host.get(7 - register)), other);
        }
    }
}

/// A write that comes while the window is busy does nothing.
#[test]
fn a_busy_window_cannot_be_written() {
    let mut host = Host::new();
    let word = host.read(0x108);
    host.put(5, 0x108);
    host.put(5, 0x000);
    host.wait();
    assert_eq!(host.get(5), 0x108);
    assert_eq!(host.get(6) | host.get(7) << 16, word);
}

#[test]
fn the_direct_registers_are_of_one_moment() {
    let mut host = Host::new();
    host.write(at(&CARD_CONFIG, "trigger_sources"), 2);
    host.write(at(&CARD_CONFIG, "trigger_period"), 5_200);
    host.0.bench.run_cycles(60_000);
    let mut seen = BTreeMap::new();
    for _ in 0..600 {
        let (position, status) = host.direct();
        let first = *seen.entry(status & 0xffff).or_insert(position);
        assert_eq!(first, position);
        let pause = host.0.rng.in_range(0, 500);
        host.0.bench.run_cycles(pause);
    }
    let positions: std::collections::BTreeSet<u64> = seen.values().copied().collect();
    assert!(positions.len() > 20, "{} positions", positions.len());
}
