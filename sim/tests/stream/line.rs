//! A card with a stream, its encoders, and a host at its UART that sends and receives at the same time.

use super::rig::Set;
use endat_hdl::protocols::Spoken;
use endat_hdl::{
    card::Card,
    config::*,
    protocol::ModeCommand,
    regs::{Block as Words, CARD},
};
use endat_sim::{
    bench::{Bench, Link, PinNames},
    encoder::{RCN_8510, ROQ_437},
    line::LineConfig,
};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, Engine, PortId};
use rust_hdl::prelude::Block;
use std::collections::VecDeque;

/// Items on the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Item {
    Set(Set),
    Answer(Vec<u32>),
}

/// The host: queued and received bytes.
pub struct Line {
    pub bench: Bench<Compiled>,
    bit: u64,
    rx: PortId,
    tx: PortId,
    out: VecDeque<bool>,
    hold: u64,
    /// Cycles of the byte being received, and its bits so far.
    coming: Option<(u64, u8)>,
    pub heard: Vec<u8>,
    /// Expected number of words of each answer, in order.
    pub asked: VecDeque<usize>,
}

/// A card of two channels with a stream that pushes from reset on.
pub fn card(system_hz: u64, sample_hz: u64, baud: u64, start: StreamStart) -> CardConfig {
    let first = ChannelSpec {
        clock_hz: 6_000_000,
        calibration_hz: None,
        tst_ns: 2_000,
        command: ModeCommand::SendPositionAddInfo,
        position_bits: 29,
        filter_ns: 0,
        start_window_ns: 40,
        tcal_max_ns: 5_000,
        recovery_min_ns: 10_000,
        recovery_max_ns: 30_000,
        cable_m: 20,
        spoken: Spoken::Endat,
        trigger: None,
        range: None,
    };
    let second = ChannelSpec {
        position_bits: 37,
        ..first.clone()
    };
    CardConfig::resolve(&CardSpec {
        system_hz,
        channels: vec![first, second],
        sample_hz,
        sources: TriggerSources {
            pin: false,
            timer: true,
            register: true,
        },
        baud,
        read_hz: 100,
        service: Default::default(),
        line: Default::default(),
        stream: StreamParts {
            fifo_bytes: 2048,
            start,
            additional_data: false,
        },
        outputs: Default::default(),
        safety: Default::default(),
    })
    .unwrap()
}

impl Line {
    pub fn new(config: &CardConfig) -> Self {
        let mut card = Card::with_timeout(config, 200);
        card.connect_all();
        let engine = Compiled::new(&elaborate(&card, "card").unwrap()).unwrap();
        let link = |encoder| Link::new(LineConfig::cable(10.0), encoder);
        let links = [link(RCN_8510.encoder()), link(ROQ_437.encoder())];
        let links = links.into_iter().enumerate();
        let links = links.map(|(n, link)| (PinNames::card(n), link)).collect();
        let mut bench = Bench::new(engine, config.system_hz, links);
        bench.set("uart_rx_i", 1);
        bench.power_up();
        let port = |bench: &mut Bench<Compiled>, name| bench.engine().port(name);
        Self {
            rx: port(&mut bench, "uart_rx_i"),
            tx: port(&mut bench, "uart_tx_o"),
            bench,
            bit: config.uart_bit_cycles,
            out: VecDeque::new(),
            hold: 0,
            coming: None,
            heard: Vec::new(),
            asked: VecDeque::new(),
        }
    }

    /// One cycle of card and host.
    pub fn step(&mut self) {
        if self.hold == 0 {
            let level = self.out.pop_front();
            self.bench
                .engine()
                .set(self.rx, level.unwrap_or(true).into());
            self.hold = level.map_or(0, |_| self.bit);
        }
        self.hold = self.hold.saturating_sub(1);
        self.bench.tick();
        let level = self.bench.engine().get(self.tx) == 1;
        self.coming = match self.coming {
            None => (!level).then_some((1, 0)),
            Some((cycles, byte)) => {
                let (bits, middle) = (cycles / self.bit, cycles % self.bit == self.bit / 2);
                match (bits, middle) {
                    (9, true) => {
                        assert!(level, "stop bit");
                        self.heard.push(byte);
                        None
                    }
                    (1..=8, true) => Some((cycles + 1, byte | u8::from(level) << (bits - 1))),
                    _ => Some((cycles + 1, byte)),
                }
            }
        };
    }

    pub fn run(&mut self, cycles: u64) {
        (0..cycles).for_each(|_| self.step());
    }

    fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let bits = u16::from(*byte) << 1 | 1 << 9;
            self.out.extend((0..10).map(|i| bits >> i & 1 == 1));
        }
    }

    pub fn write(&mut self, block: &Words, name: &str, value: u32) {
        let [high, low] = block
            .address(block.register(name).unwrap(), 0)
            .to_be_bytes();
        let [a, b, c, d] = value.to_be_bytes();
        self.send(&[1, 1, 0, 0, high, low, a, b, c, d]);
    }

    pub fn control(&mut self, value: u32) {
        self.write(&CARD, "stream_control", value);
    }

    pub fn read(&mut self, command: u8, address: u16, words: usize) {
        let [high, low] = address.to_be_bytes();
        self.send(&[command, words as u8, 0, 0, high, low]);
        self.asked.push_back(words);
    }

    /// Runs until nothing is queued and nothing has arrived for `bits` bit times.
    pub fn settle(&mut self, bits: u64) {
        let mut quiet = 0;
        while quiet < bits * self.bit {
            self.step();
            let busy = !self.out.is_empty() || self.coming.is_some();
            quiet = if busy { 0 } else { quiet + 1 };
        }
    }

    /// Number of complete answers received so far.
    pub fn answers_heard(&self) -> usize {
        let (mut rest, mut count) = (&self.heard[..], 0);
        while !rest.is_empty() {
            let next = if rest[0] == 0xff {
                let end = 1 + 4 * self.asked[count];
                count += usize::from(rest.len() >= end);
                rest.get(end..)
            } else {
                let end = rest.iter().position(|b| *b == 0);
                end.and_then(|end| rest.get(end + 1..))
            };
            rest = next.unwrap_or_default();
        }
        count
    }

    /// Received items, while answers are marked.
    pub fn marked(&mut self) -> Vec<Item> {
        let (mut items, mut rest) = (Vec::new(), &self.heard[..]);
        while !rest.is_empty() {
            if rest[0] == 0xff {
                let words = self.asked.pop_front().expect("an unexpected answer");
                items.push(Item::Answer(words_of(&rest[1..1 + 4 * words])));
                rest = &rest[1 + 4 * words..];
            } else {
                let Some(end) = rest.iter().position(|b| *b == 0) else {
                    break;
                };
                assert!(end > 0, "an empty frame on the line");
                items.push(Item::Set(Set::decode(&rest[..end]).unwrap()));
                rest = &rest[end + 1..];
            }
        }
        self.heard = rest.to_vec();
        items
    }
}

/// Words of a UARTBone answer.
pub fn words_of(bytes: &[u8]) -> Vec<u32> {
    let word = |b: &[u8]| u32::from_be_bytes([b[0], b[1], b[2], b[3]]);
    bytes.chunks(4).map(word).collect()
}
