//! Asynchronous bus with eight registers of 16 bits; a receiver for a signal processor has the same pins.

use crate::front::{design_of, set_all, BenchHost, Controller, Front, Pins, ACCESS_CYCLES_MAX};
use endat_hdl::card::bus::parallel::ParallelCard;

/// A controller.
struct Parallel;

/// From an address to its data, in system clock cycles; a strobe takes as long.
const STROBE_CYCLES: u64 = 4;
/// Registers that follow the results: position from bit 0 on, then both halves of the status, high half first.
const DIRECT: [u32; 5] = [0, 1, 2, 3, 4];
/// Registers: the window's address, and both halves of its word.
const WINDOW: u32 = 5;
const WINDOW_LOW: u32 = 6;
const WINDOW_HIGH: u32 = 7;
const WINDOW_WRITES: u32 = 1 << 14;
const WINDOW_BUSY: u32 = 1 << 15;
const PORTS: &[(&str, &str)] = &[
    ("bus_cs_n_i", "bus_cs_n"),
    ("bus_rd_n_i", "bus_rd_n"),
    ("bus_wr_n_i", "bus_wr_n"),
    ("bus_address_i", "bus_address"),
    ("bus_data_i", "bus_data_to_card"),
    ("bus_data_o", "bus_data_from_card"),
    ("bus_data_oe", "bus_data_oe"),
];

/// What there is to know of it.
pub(super) const FRONT: Front = Front {
    design: |card, name, times, _| design_of(ParallelCard::with_times(card, times), name),
    bench_host: Some(BenchHost {
        text: include_str!("../templates/bench_host/parallel.v"),
        vhdl: include_str!("../templates/vhdl/bench/host/parallel.vhd"),
        moves_words: true,
        connections: PORTS,
    }),
    controller: Some(&Parallel),
    interface: None,
};

fn rest(card: &mut Pins) {
    set_all(
        card,
        &[("bus_cs_n_i", 1), ("bus_rd_n_i", 1), ("bus_wr_n_i", 1)],
    );
}

impl Controller for Parallel {
    fn rest(&self, card: &mut Pins) {
        rest(card);
    }

    fn read_word(&self, card: &mut Pins, address: u16) -> Option<u32> {
        put(card, WINDOW, address.into());
        let is_free = wait_for_window(card);
        let word = get(card, WINDOW_LOW) | get(card, WINDOW_HIGH) << 16;
        is_free.then_some(word)
    }

    fn write(&self, card: &mut Pins, address: u16, word: u32) {
        put(card, WINDOW, u32::from(address) | WINDOW_WRITES);
        put(card, WINDOW_LOW, word & 0xFFFF);
        put(card, WINDOW_HIGH, word >> 16);
        wait_for_window(card);
    }

    fn newest(&self, card: &mut Pins) -> Option<Vec<u32>> {
        // The read of register 0 latches the others.
        let [p0, p1, p2, high, low] = DIRECT.map(|register| get(card, register));
        Some(vec![low | high << 16, p0 | p1 << 16, p2])
    }

    fn must_hold(&self) -> bool {
        true
    }
}

/// The addresses of a T-format receiver, 16 bits each.
pub struct Dsp;

impl Controller for Dsp {
    fn rest(&self, card: &mut Pins) {
        rest(card);
    }

    fn read_word(&self, card: &mut Pins, address: u16) -> Option<u32> {
        Some(get(card, address.into()))
    }

    fn write(&self, card: &mut Pins, address: u16, word: u32) {
        put(card, address.into(), word & 0xFFFF);
    }

    fn has_registers(&self) -> bool {
        false
    }

    fn addresses(&self) -> u32 {
        1 << 3
    }
}

/// Reads a register of a bus with strobes.
fn get(card: &mut Pins, register: u32) -> u32 {
    let strobes = |level| [("bus_cs_n_i", level), ("bus_rd_n_i", level)];
    card.set("bus_address_i", register.into());
    set_all(card, &strobes(0));
    card.run_cycles(STROBE_CYCLES);
    let data = card.get("bus_data_o") as u32;
    set_all(card, &strobes(1));
    card.run_cycles(STROBE_CYCLES);
    data
}

/// Writes one.
fn put(card: &mut Pins, register: u32, data: u32) {
    let strobes = |level| [("bus_cs_n_i", level), ("bus_wr_n_i", level)];
    set_all(card, &[("bus_address_i", register), ("bus_data_i", data)]);
    set_all(card, &strobes(0));
    card.run_cycles(STROBE_CYCLES);
    set_all(card, &strobes(1));
    card.run_cycles(STROBE_CYCLES);
}

/// Whether it becomes free.
fn wait_for_window(card: &mut Pins) -> bool {
    let end = card.cycle() + ACCESS_CYCLES_MAX;
    while card.cycle() < end {
        if get(card, WINDOW) & WINDOW_BUSY == 0 {
            return true;
        }
    }
    false
}
