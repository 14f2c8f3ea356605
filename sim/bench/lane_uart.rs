//! Host ends of the serial lines of many cards, one in each lane, bit by bit in system clock cycles; see [`super::Uart`] for a single card.

use super::{bits, LaneBench};
use rtl_design::engine::PortId;
use std::collections::VecDeque;

/// Bits of a byte on the line: start, eight, stop.
const BITS: u8 = 10;

/// One host end.
#[derive(Clone, Default)]
struct End {
    sending: VecDeque<u8>,
    /// Bits still to be sent, the next one lowest, and the cycle of the next change.
    shift: u16,
    bits_left: u8,
    next_bit: u64,
    /// Cycle of the next sample of the byte being received, the number of its samples, and the samples.
    sample_at: u64,
    samples: u8,
    byte: u16,
}

/// Sends and receives bytes, 8N1, in all lanes.
#[derive(Clone)]
pub struct LaneUart {
    bit_cycles: u64,
    rx: PortId,
    tx: PortId,
    ends: Vec<End>,
    /// Levels at the cards' inputs.
    levels: Vec<u64>,
    /// Lanes that send.
    sending: Vec<u64>,
    receiving: Vec<u64>,
    /// Cycle of the next action in any of them.
    next_bit: u64,
    next_sample: u64,
    received: Vec<(usize, u8)>,
}

impl LaneUart {
    /// Lines with bits of `bit_cycles` system clock cycles, at the pins `uart_rx_i` and `uart_tx_o`; leaves them idle.
    pub fn new(bench: &mut LaneBench, bit_cycles: u64) -> Self {
        let engine = bench.engine();
        let (rx, tx) = (engine.port("uart_rx_i"), engine.port("uart_tx_o"));
        let lanes = engine.lanes();
        engine.set_all(rx, 1);
        Self {
            bit_cycles,
            rx,
            tx,
            ends: vec![End::default(); lanes],
            levels: vec![u64::MAX; lanes / 64],
            sending: vec![0; lanes / 64],
            receiving: vec![0; lanes / 64],
            next_bit: u64::MAX,
            next_sample: u64::MAX,
            received: vec![],
        }
    }

    /// Queues bytes for the card of a lane.
    pub fn send(&mut self, lane: usize, bytes: &[u8]) {
        let end = &mut self.ends[lane];
        end.sending.extend(bytes);
        let bit = 1 << (lane % 64);
        if !bytes.is_empty() && self.sending[lane / 64] & bit == 0 {
            self.sending[lane / 64] |= bit;
            self.next_bit = self.next_bit.min(end.next_bit);
        }
    }

    /// Bytes received since the last call, with their lanes.
    pub fn take(&mut self) -> Vec<(usize, u8)> {
        std::mem::take(&mut self.received)
    }

    /// Runs the bench by a cycle.
    pub fn tick(&mut self, bench: &mut LaneBench) {
        let now = bench.cycle();
        if now >= self.next_bit {
            self.next_bit = u64::MAX;
            for part in 0..self.levels.len() {
                self.send_bits(part, now);
                let engine = bench.engine();
                engine.set_word(self.rx, 0, part, self.levels[part]);
            }
        }
        bench.tick();
        for part in 0..self.levels.len() {
            let level = bench.engine().word(self.tx, 0, part);
            let begun = !level & !self.receiving[part];
            for bit in bits(begun) {
                let end = &mut self.ends[64 * part + bit];
                (end.samples, end.byte) = (0, 0);
                end.sample_at = now + self.bit_cycles / 2;
                self.next_sample = self.next_sample.min(end.sample_at);
            }
            self.receiving[part] |= begun;
        }
        if now >= self.next_sample {
            self.next_sample = u64::MAX;
            for part in 0..self.levels.len() {
                let level = bench.engine().word(self.tx, 0, part);
                self.take_samples(part, level, now);
            }
        }
    }

    fn send_bits(&mut self, part: usize, now: u64) {
        for bit in bits(self.sending[part]) {
            let end = &mut self.ends[64 * part + bit];
            if end.next_bit <= now {
                if end.bits_left == 0 {
                    let Some(byte) = end.sending.pop_front() else {
                        self.sending[part] &= !(1 << bit);
                        continue;
                    };
                    end.shift = u16::from(byte) << 1 | 1 << 9;
                    end.bits_left = BITS;
                }
                let level = u64::from(end.shift & 1);
                self.levels[part] = self.levels[part] & !(1 << bit) | level << bit;
                end.shift >>= 1;
                end.bits_left -= 1;
                end.next_bit = now + self.bit_cycles;
            }
            self.next_bit = self.next_bit.min(end.next_bit);
        }
    }

    fn take_samples(&mut self, part: usize, level: u64, now: u64) {
        for bit in bits(self.receiving[part]) {
            let lane = 64 * part + bit;
            let end = &mut self.ends[lane];
            if end.sample_at <= now {
                end.byte = end.byte >> 1 | ((level >> bit & 1) as u16) << 9;
                end.samples += 1;
                end.sample_at = now + self.bit_cycles;
                if end.samples == BITS {
                    self.receiving[part] &= !(1 << bit);
                    // A byte without stop bit is dropped.
                    if end.byte >> 9 == 1 {
                        self.received.push((lane, (end.byte >> 1) as u8));
                    }
                    continue;
                }
            }
            self.next_sample = self.next_sample.min(end.sample_at);
        }
    }
}
