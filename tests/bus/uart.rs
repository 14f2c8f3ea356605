//! The card with a UART: what a host sends back to back is written, on the largest ring and the fastest line, too.

use crate::bus_card::text;
use crate::made;
use endat_config::parse;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::service_times;
use endat_hdl::card::uart::BIT_CYCLES_MIN;
use endat_hdl::card::uart_bridge::TIMEOUT_US;
use endat_hdl::config::{CardConfig, UART_TOLERANCE_PPM};
use endat_hdl::endat::timing::{deviation_ppm, period_cycles};
use endat_hdl::regs::{CARD_CONFIG, CHANNEL_CONFIG};
use endat_sim::bench::{Bench, Uart};
use endat_sim::rng::Rng;
use rtl_design::engine::Compiled;
use std::collections::{BTreeMap, BTreeSet};

/// Words of a block that the ring carries.
const RING_WORDS: usize = 3;

/// A card of `channels` channels and a host at its line.
struct Host {
    bench: Bench<Compiled>,
    uart: Uart,
    bit_cycles: u64,
}

impl Host {
    fn new(channels: usize, bit_cycles: u64) -> Self {
        let more = "[[channel]]\nposition_bits = 25\ncommand = \"111000\"\n".repeat(6);
        let project = parse("card.toml", &text(HostBus::Apb, &more)).unwrap();
        let mut config: CardConfig = project.card;
        config.channels.truncate(channels);
        config.uart_bit_cycles = bit_cycles;
        let engine = made::uart_card(&config, &service_times(&config), TIMEOUT_US);
        let mut bench = Bench::new(engine, config.system_hz, vec![]);
        let uart = Uart::new(&mut bench, bit_cycles);
        bench.reset();
        Self {
            bench,
            uart,
            bit_cycles,
        }
    }

    fn send(&mut self, bytes: &[u8]) {
        self.uart.send(bytes);
        while self.uart.unsent() > 0 {
            self.uart.tick(&mut self.bench);
        }
    }

    fn read(&mut self, address: u16, words: usize) -> Vec<u32> {
        let [high, low] = address.to_be_bytes();
        self.send(&[2, words as u8, 0, 0, high, low]);
        // A byte takes its time on the line, or a turn of the ring.
        let limit = (4 * words as u64 + 4) * (20 * self.bit_cycles + 200);
        let end = self.bench.cycle() + limit;
        while self.uart.received().len() < 4 * words {
            assert!(self.bench.cycle() < end, "answer of {words} words");
            self.uart.tick(&mut self.bench);
        }
        let bytes: Vec<u8> = self.uart.received().drain(..).collect();
        let word = |b: &[u8]| u32::from_be_bytes(b.try_into().unwrap());
        bytes.chunks(4).map(word).collect()
    }
}

/// First words of the card's and of each channel's block on the ring.
fn blocks(channels: usize) -> Vec<u16> {
    let first = |n| CHANNEL_CONFIG.address(&CHANNEL_CONFIG.registers[0], n);
    let card = CARD_CONFIG.address(&CARD_CONFIG.registers[0], 0);
    [card].into_iter().chain((0..channels).map(first)).collect()
}

/// Bits of every usual rate at every usual system clock, in cycles.
fn usual_bit_cycles() -> BTreeSet<u64> {
    const SYSTEMS_HZ: [u64; 8] = [
        8_000_000,
        32_000_000,
        48_000_000,
        50_000_000,
        64_000_000,
        100_000_000,
        128_000_000,
        200_000_000,
    ];
    const RATES: [u64; 13] = [
        115_200, 230_400, 460_800, 500_000, 921_600, 1_000_000, 1_500_000, 2_000_000, 3_000_000,
        4_000_000, 6_000_000, 8_000_000, 12_000_000,
    ];
    let all = SYSTEMS_HZ.iter().flat_map(|system_hz| {
        RATES.iter().filter_map(move |rate| {
            let cycles = period_cycles(*rate, *system_hz);
            let ppm = deviation_ppm(*system_hz as f64 / cycles as f64, *rate as f64);
            (cycles >= BIT_CYCLES_MIN && ppm.abs() <= UART_TOLERANCE_PPM as f64).then_some(cycles)
        })
    });
    // Slower lines only wait longer.
    all.filter(|cycles| *cycles <= 120).collect()
}

/// 8 channels at 8 cycles a bit: a turn of the ring takes 115 cycles, a byte 80.
///
/// Each case is a number of channels and the cycles of a bit.
fn words_are_written(cases: impl IntoIterator<Item = (usize, u64)>) {
    let mut rng = Rng::new(6);
    for (channels, bit_cycles) in cases {
        let mut host = Host::new(channels, bit_cycles);
        let mut bytes = vec![];
        let mut model = BTreeMap::new();
        // Whole blocks, command after command without a pause.
        for first in blocks(channels) {
            let [high, low] = first.to_be_bytes();
            bytes.extend([1, RING_WORDS as u8, 0, 0, high, low]);
            for word in 0..RING_WORDS as u16 {
                let value = rng.next_u64() as u32;
                model.insert(first + word, value);
                bytes.extend(value.to_be_bytes());
            }
        }
        // And a read right after them.
        host.send(&bytes);
        let last = 0x108 + 8 * channels as u16 - 8;
        let all = host.read(0x100, usize::from(last) + RING_WORDS - 0x100);
        for (address, value) in model {
            assert_eq!(
                all[usize::from(address) - 0x100],
                value,
                "{channels} channels, {bit_cycles} cycles a bit: {address:#x}"
            );
        }
    }
}

/// The shortest ring and the longest one.
#[test]
fn words_back_to_back_are_written_at_the_fastest_rate() {
    let rates = usual_bit_cycles();
    assert!(
        rates.first() == Some(&BIT_CYCLES_MIN) && rates.len() > 10,
        "{rates:?}"
    );
    words_are_written([1, 8].map(|channels| (channels, BIT_CYCLES_MIN)));
}

/// The longest ring at every rate, and every ring at the fastest: only the ring's turn and a byte's time matter.
#[test]
#[ignore = "slow: every usual rate of the UART, every number of channels"]
fn words_back_to_back_are_written_at_every_rate_and_to_every_number_of_channels() {
    words_are_written(usual_bit_cycles().into_iter().map(|cycles| (8, cycles)));
    words_are_written((1..8).map(|channels| (channels, BIT_CYCLES_MIN)));
}
