use super::*;
use crate::card::Card;
use crate::config::CardConfig;
use crate::protocols::t_format::cause;
use crate::regs::tests::{mixed_config, test_config};
use crate::regs::{Access, Block as RegisterBlock, CARD, CARD_CONFIG, RESULT, T_FORMAT};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, Engine, Keep, PortId};
use rust_hdl::prelude::Block;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

mod held;
mod own_triggers;

/// Cycles of a UART bit.
const BIT: usize = 8;

/// An elaborated card as native code, with its host, which drives the UART bit by bit. `tests/elaborate` compares such a card with its
/// kernels.
struct Host {
    card: Compiled,
    /// Index of each net, by its hierarchical name.
    nets: Arc<BTreeMap<String, usize>>,
    /// Ports and nets that are used every cycle.
    rx_port: PortId,
    tx_net: usize,
    clk_nets: Vec<usize>,
    calibrate_nets: Vec<usize>,
    /// Cycles in which each EnDat clock fell.
    falls: Vec<Vec<u64>>,
    clk: Vec<bool>,
    tx: Vec<bool>,
    /// Cycles with a calibrate strobe, per channel.
    calibrations: Vec<usize>,
    cycle: u64,
}

/// The card of a configuration before its first cycle. Compiling takes longer than most tests, so each card is compiled once.
fn compiled(config: &CardConfig) -> (Compiled, Arc<BTreeMap<String, usize>>) {
    type Made = Arc<OnceLock<(Compiled, Arc<BTreeMap<String, usize>>)>>;
    static MADE: Mutex<Vec<(CardConfig, Made)>> = Mutex::new(Vec::new());
    let made = {
        let mut all = MADE.lock().unwrap();
        match all.iter().find(|(of, _)| of == config) {
            Some((_, made)) => made.clone(),
            None => {
                let made = Made::default();
                all.push((config.clone(), made.clone()));
                made
            }
        }
    };
    let compile = || {
        let mut card = Card::with_timeout(config, 100);
        card.connect_all();
        let design = elaborate(&card, "card").unwrap();
        let card = Compiled::keeping(&design, Keep::Nets).unwrap();
        let names = card.nets().map(str::to_owned);
        let nets = names.enumerate().map(|(at, name)| (name, at)).collect();
        (card, Arc::new(nets))
    };
    made.get_or_init(compile).clone()
}

impl Host {
    /// A card whose encoders hold DATA at `data`, with its trigger sources as bits.
    fn new(data: bool, sources: u8) -> Self {
        Self::with_channels(data, sources, 2)
    }

    fn with_channels(data: bool, sources: u8, channels: usize) -> Self {
        let mut config = test_config();
        config.channels = config.channels.into_iter().cycle().take(channels).collect();
        Self::of(data, sources, config)
    }

    fn of(data: bool, sources: u8, mut config: CardConfig) -> Self {
        let channels = config.channels.len();
        config.sources.pin = sources & 1 != 0;
        config.sources.timer = sources & 2 != 0;
        config.sources.register = sources & 4 != 0;
        config.sample_period_cycles = 700;
        for channel in &mut config.channels {
            channel.abort_us = 2;
        }
        let (card, nets) = compiled(&config);
        let each = |name: fn(usize) -> String| (0..channels).map(|i| nets[&name(i)]).collect();
        let mut host = Self {
            rx_port: card.port("uart_rx_i"),
            tx_net: nets["uart_tx_o"],
            clk_nets: each(|i| format!("endat_clk{i}_o")),
            calibrate_nets: each(|i| format!("core.port_{i}.calibrate")),
            nets,
            card,
            falls: vec![Vec::new(); channels],
            clk: vec![true; channels],
            tx: Vec::new(),
            calibrations: vec![0; channels],
            cycle: 0,
        };
        (0..channels).for_each(|i| host.set_data(i, data));
        // DATA low for longer than tR.
        host.idle(200);
        host
    }

    fn set(&mut self, pin: &str, level: bool) {
        let pin = self.card.port(pin);
        self.card.set(pin, level.into());
    }

    /// DATA of a channel's encoder.
    fn set_data(&mut self, channel: usize, level: bool) {
        self.set(&format!("endat_data{channel}_i"), level);
    }

    /// Current value of a net.
    fn net(&mut self, name: &str) -> u64 {
        let Some(at) = self.nets.get(name) else {
            panic!("{name}: no such net");
        };
        self.peek(*at)
    }

    fn peek(&mut self, net: usize) -> u64 {
        self.card.peek(net).unwrap() as u64
    }

    fn is_busy(&mut self, channel: usize) -> bool {
        self.net(&format!("core.port_{channel}_busy")) == 1
    }

    /// Number of a channel's result.
    fn sequence(&mut self, channel: usize) -> u64 {
        self.net(&format!("core.port_{channel}_sequence"))
    }

    fn step(&mut self, rx: bool) {
        self.card.set(self.rx_port, rx.into());
        self.card.tick();
        for i in 0..self.falls.len() {
            let clk = self.peek(self.clk_nets[i]) == 1;
            if self.clk[i] && !clk {
                self.falls[i].push(self.cycle);
            }
            self.clk[i] = clk;
            self.calibrations[i] += self.peek(self.calibrate_nets[i]) as usize;
        }
        let tx = self.peek(self.tx_net) == 1;
        self.tx.push(tx);
        self.cycle += 1;
    }

    fn idle(&mut self, cycles: usize) {
        (0..cycles).for_each(|_| self.step(true));
    }

    fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let mut bits = vec![false];
            bits.extend((0..8).map(|i| byte >> i & 1 == 1));
            bits.push(true);
            for bit in bits {
                (0..BIT).for_each(|_| self.step(bit));
            }
        }
    }

    fn read(&mut self, address: u16, words: usize) -> Vec<u32> {
        self.tx.clear();
        let [high, low] = address.to_be_bytes();
        self.send(&[2, words as u8, 0, 0, high, low]);
        self.idle((4 * words + 3) * 10 * BIT);
        let (mut at, mut bytes) = (0, Vec::new());
        while let Some(start) = self.tx[at..].iter().position(|l| !l) {
            let middle = at + start + BIT / 2;
            bytes.push((0..8).fold(0, |b, i| b | u8::from(self.tx[middle + (i + 1) * BIT]) << i));
            at = middle + 9 * BIT;
        }
        assert_eq!(bytes.len(), 4 * words, "answer of {words} words");
        let word = |b: &[u8]| u32::from_be_bytes([b[0], b[1], b[2], b[3]]);
        bytes.chunks(4).map(word).collect()
    }

    fn write(&mut self, address: u16, words: &[u32]) {
        let [high, low] = address.to_be_bytes();
        self.send(&[1, words.len() as u8, 0, 0, high, low]);
        words.iter().for_each(|w| self.send(&w.to_be_bytes()));
        self.idle(10 * BIT);
    }
}

fn address(block: RegisterBlock, register: &str, channel: usize) -> u16 {
    block.address(block.register(register).unwrap(), channel)
}

/// Every word of the card: address, access and start value.
fn words() -> Vec<(u16, Access, u32)> {
    let config = test_config();
    let words = crate::regs::words(&config).into_iter();
    words
        .map(|w| (w.address, w.register.access, w.start))
        .collect()
}

#[test]
fn every_address_reads_as_the_table_says_after_reset() {
    let mut host = Host::new(false, 0b101);
    let words = words();
    for (first, count) in [(0, 17), (0x0ff, 21), (0x1fd, 6)] {
        for (i, got) in host.read(first, count).into_iter().enumerate() {
            let at = first + i as u16;
            let start = words.iter().find(|w| w.0 == at).map_or(0, |w| w.2);
            // The timer's period is shorter here than in the configuration of the other tests.
            let expected = match at {
                0x101 => 700,
                at if (RESULT.base..0x200).contains(&at) => continue,
                _ => start,
            };
            assert_eq!(got, expected, "word {at:#x}");
        }
    }
    // No result yet: everything is 0 except the age.
    for at in [
        0x180, 0x181, 0x182, 0x183, 0x184, 0x186, 0x187, 0x190, 0x1ff,
    ] {
        assert_eq!(host.read(at, 1), [0], "word {at:#x}");
    }
}

#[test]
fn every_rw_word_keeps_what_is_written_and_no_other_word_changes() {
    let mut host = Host::new(false, 0);
    let rw: Vec<u16> = words()
        .iter()
        .filter(|w| w.1 == Access::ReadWrite)
        .map(|w| w.0)
        .collect();
    assert_eq!(rw.len(), 9);
    let start = [
        host.read(0x100, 3),
        host.read(0x108, 3),
        host.read(0x110, 3),
    ]
    .concat();
    let mut expected = start.clone();
    let all = |host: &mut Host| {
        [
            host.read(0x100, 3),
            host.read(0x108, 3),
            host.read(0x110, 3),
        ]
        .concat()
    };
    // A different value for every byte of every word; no trigger source, so that the channels stay idle.
    for (i, word) in expected.iter_mut().enumerate() {
        *word = 0x0f1e_2d38u32.wrapping_add(0x1121_3141 * i as u32) & !7;
    }
    for (at, values) in rw.chunks(3).zip(expected.chunks(3)) {
        host.write(at[0], values);
    }
    assert_eq!(all(&mut host), expected, "bursts");
    for i in [0, 4, 8] {
        expected[i] = !expected[i] & !7;
        host.write(rw[i], &expected[i..=i]);
    }
    assert_eq!(all(&mut host), expected, "single words");
    host.set("rst_i", true);
    host.idle(1);
    host.set("rst_i", false);
    host.idle(5);
    assert_eq!(all(&mut host), start, "after reset");
}

#[test]
fn writing_a_read_only_or_absent_word_does_nothing() {
    let mut host = Host::new(false, 0b100);
    let before = [host.read(0, 9), host.read(0x100, 3), host.read(0x108, 3)].concat();
    for at in [
        0u16, 1, 2, 3, 4, 5, 8, 11, 0x19, 0x29, 0x89, 0x103, 0x104, 0x107, 0x10b, 0x118, 0x180,
        0x189,
    ] {
        host.write(at, &[0xffff_ffff]);
    }
    assert_eq!(
        [host.read(0, 9), host.read(0x100, 3), host.read(0x108, 3)].concat(),
        before
    );
    assert!(host.falls.iter().all(Vec::is_empty), "no trigger");
}

#[test]
fn both_channels_clock_falls_in_the_same_cycle_whatever_triggers() {
    for source in ["pin", "timer", "register"] {
        let mut host = Host::new(
            false,
            match source {
                "pin" => 1,
                "timer" => 2,
                _ => 4,
            },
        );
        match source {
            "pin" => host.set("trigger_i", true),
            "timer" => {}
            _ => host.write(address(CARD, "trigger_now", 0), &[1]),
        }
        host.idle(900);
        assert!(!host.falls[0].is_empty(), "{source}");
        assert_eq!(host.falls[0][0], host.falls[1][0], "{source}");
    }
}

#[test]
fn a_disabled_source_does_not_trigger() {
    let mut host = Host::new(false, 0);
    host.set("trigger_i", true);
    host.write(address(CARD, "trigger_now", 0), &[1]);
    host.idle(1_500);
    assert!(host.falls.iter().all(Vec::is_empty));
    // A bit that is not the trigger bit.
    let mut host = Host::new(false, 4);
    host.write(address(CARD, "trigger_now", 0), &[0xffff_fffe]);
    host.idle(100);
    assert!(host.falls.iter().all(Vec::is_empty));
    // A read of the strobe, with the trigger bit left over from a write to another word.
    host.write(address(CARD, "id", 0), &[1]);
    assert_eq!(host.read(address(CARD, "trigger_now", 0), 1), [0]);
    assert!(host.falls.iter().all(Vec::is_empty));
}

#[test]
fn calibrate_reaches_the_channels_whose_bits_are_set() {
    let mut host = Host::new(false, 0);
    for (bits, expected) in [(2, [0, 1]), (1, [1, 1]), (3, [2, 2]), (0xfc, [2, 2])] {
        host.write(address(CARD, "calibrate", 0), &[bits]);
        assert_eq!(host.calibrations, expected, "{bits}");
    }
}

/// Sequence number and cause of a status word.
fn status(word: u32) -> (u32, u32) {
    (word & 0xffff, word >> 16 & 0xf)
}

#[test]
fn one_burst_read_shows_both_channels_after_the_same_trigger_while_results_come_in() {
    // DATA is high, so every trigger gives a result with cause 1 at once; one every 7 us, and a read takes 58 us.
    let mut host = Host::new(true, 2);
    let mut last = None;
    for pause in [300, 390, 555] {
        host.idle(pause);
        let words = host.read(RESULT.base, 14);
        let (first, second) = (status(words[0]), status(words[8]));
        assert_eq!(first, second);
        assert_eq!(first.1, 1);
        assert!(
            last.is_none_or(|l| first.0 > l + 5),
            "{first:?} after {last:?}"
        );
        last = Some(first.0);
    }
}

#[test]
fn hold_lets_a_host_read_word_by_word_and_gives_way_afterwards() {
    let mut host = Host::new(true, 2);
    let hold = address(CARD_CONFIG, "hold", 0);
    let count = address(CARD, "trigger_count", 0);
    host.write(hold, &[1]);
    let held = [host.read(RESULT.base, 1), host.read(count, 1)];
    assert_ne!(held[0][0], 0);
    host.idle(3_000);
    assert_eq!([host.read(RESULT.base, 1), host.read(count, 1)], held);
    assert_eq!(status(host.read(RESULT.base + 8, 1)[0]), status(held[0][0]));
    host.write(hold, &[0]);
    assert!(status(host.read(RESULT.base, 1)[0]).0 > status(held[0][0]).0 + 5);
    assert!(host.read(count, 1)[0] > held[1][0] + 5);
}

#[test]
fn a_channel_that_owes_a_result_does_not_hold_up_the_last_one() {
    let mut host = Host::new(true, 4);
    let now = address(CARD, "trigger_now", 0);
    host.write(now, &[1]);
    assert_eq!(status(host.read(RESULT.base, 9)[8]), (1, 1));
    host.idle(300);
    // Channel 0's encoder is ready now: its frame starts and waits for a start bit; channel 1's fails at once.
    host.set_data(0, false);
    host.idle(400);
    host.write(now, &[1]);
    let words = host.read(RESULT.base, 9);
    assert_eq!(
        (status(words[0]), status(words[8])),
        ((1, 1), (1, 1)),
        "not one without the other"
    );
    host.idle(12_000);
    let words = host.read(RESULT.base, 9);
    assert_eq!((status(words[0]), status(words[8])), ((2, 2), (2, 1)));
}

#[test]
fn status_led_blinks_quickly_after_an_error_and_slowly_before() {
    assert_eq!(blink_bit(100_000_000, 1), 25);
    assert_eq!(blink_bit(100_000_000, 8), 22);
    assert_eq!(blink_bit(8_000_000, 8), 18);
    let mut host = Host::new(true, 4);
    assert_eq!(
        [0, 1].map(|i| host.net(&format!("led_channel{i}_o"))),
        [0; 2]
    );
    assert_eq!(
        [0, 1, 2].map(|i| host.net(&format!("core.faulty_{i}"))),
        [0; 3]
    );
    host.write(address(CARD, "trigger_now", 0), &[1]);
    assert_eq!(host.net("core.faulty_2"), 1);
}

#[test]
fn cards_of_one_and_of_four_channels_reach_every_channel() {
    for channels in [1, 4] {
        let mut host = Host::with_channels(true, 4, channels);
        let last = channels - 1;
        let count = CARD.register("capabilities").unwrap();
        assert_eq!(host.read(count.offset, 1)[0] & 0xff, channels as u32);
        // A burst at the fastest rate: the ring has completed its turn before the next word arrives.
        let at = 0x108 + 8 * last as u16;
        let values = [0x1111_1110, 0x2222_2222, 0x3333_3333];
        let first = host.read(0x108, 3);
        host.write(at, &values);
        assert_eq!(host.read(at, 3), values);
        if channels > 1 {
            assert_eq!(host.read(0x108, 3), first);
        }
        assert_eq!(host.read(at + 8, 3), [0; 3], "an absent channel");
        host.write(address(CARD, "trigger_now", 0), &[1]);
        assert_eq!(
            status(host.read(RESULT.base + 8 * last as u16, 1)[0]),
            (1, 1)
        );
    }
}

#[test]
fn a_t_format_channel_has_its_words_and_an_endat_channel_none_of_them() {
    let mut host = Host::of(true, 0, mixed_config());
    host.idle(3_000);
    let at = |register, channel| address(T_FORMAT, register, channel);
    assert_eq!(host.read(at("send", 0), 64), [0; 64]);
    // An unknown ID: rejected at once, so no encoder is needed.
    let id = 4 << 16;
    host.write(at("send", 0), &[id]);
    host.write(at("parts", 1) + 1, &[id]);
    assert_eq!(host.read(at("answer", 0), 16), [0; 16], "absent words");
    host.write(at("send", 1), &[id]);
    let answer = host.read(at("answer", 1), 1)[0];
    assert_eq!(answer >> 12, 1 << 4 | cause::UNKNOWN_REQUEST as u32);
    assert_eq!(host.read(at("send", 0), 9), [0; 9]);
    // The words of other pages with the same low address are absent.
    for page in [0x040, 0x200, 0x2c0, 0x400, 0x480, 0x4c0] {
        assert_eq!(host.read(page + at("answer", 1) % 64, 1), [0], "{page:x}");
    }
}

#[test]
fn a_trigger_starts_both_protocols() {
    let mut host = Host::of(false, 4, mixed_config());
    host.set_data(1, true);
    // A T-format port sends nothing for some 66 us after a reset.
    host.idle(8_000);
    host.write(address(CARD, "trigger_now", 0), &[1]);
    assert_eq!(host.net("endat_clk1_o"), 1, "T-format has no clock");
    // No encoder answers: the T-format channel detects this first, and the host reads both results together.
    host.idle(4_000);
    assert_eq!(host.sequence(1), 1);
    assert_eq!(host.net("core.port_1_cause"), cause::NO_ANSWER);
    assert_eq!(host.read(address(RESULT, "status", 1), 1), [0]);
    assert!(host.falls[1].is_empty(), "no clock");
    assert!(!host.falls[0].is_empty());
}
