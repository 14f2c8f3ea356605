//! Host end of a serial line at the pins `uart_rx_i` and `uart_tx_o` of a card, in system clock cycles.

use super::Bench;
use rtl_design::engine::{Engine, PortId};
use std::collections::VecDeque;

/// Bits of a byte on the line: start, eight, stop.
const BITS: u64 = 10;

/// Sends and receives bytes, 8N1.
pub struct Uart {
    bit_cycles: u64,
    rx: PortId,
    tx: PortId,
    sending: VecDeque<u8>,
    /// Bits still to be sent, the next one lowest, and the cycle of the next change.
    shift: u16,
    bits_left: u64,
    next_bit: u64,
    /// Cycle of the next sample of the byte being received, and the number of its samples.
    sample_at: Option<u64>,
    samples: u64,
    byte: u16,
    received: VecDeque<u8>,
}

impl Uart {
    /// A line with bits of `bit_cycles` system clock cycles; leaves it idle.
    pub fn new<E: Engine>(bench: &mut Bench<E>, bit_cycles: u64) -> Self {
        let (rx, tx) = (
            bench.engine.port("uart_rx_i"),
            bench.engine.port("uart_tx_o"),
        );
        bench.engine.set(rx, 1);
        Self {
            bit_cycles,
            rx,
            tx,
            sending: VecDeque::new(),
            shift: 0,
            bits_left: 0,
            next_bit: 0,
            sample_at: None,
            samples: 0,
            byte: 0,
            received: VecDeque::new(),
        }
    }

    /// Queues bytes for the card.
    pub fn send(&mut self, bytes: &[u8]) {
        self.sending.extend(bytes);
    }

    /// Bytes not sent to the card yet.
    pub fn unsent(&self) -> usize {
        self.sending.len() + usize::from(self.bits_left > 0)
    }

    /// Drops the queue; the byte on the line is finished.
    pub fn forget(&mut self) {
        self.sending.clear();
    }

    /// Bytes from the card.
    pub fn received(&mut self) -> &mut VecDeque<u8> {
        &mut self.received
    }

    /// Runs the bench by a cycle.
    pub fn tick<E: Engine>(&mut self, bench: &mut Bench<E>) {
        let now = bench.cycle;
        if now >= self.next_bit {
            if self.bits_left == 0 {
                if let Some(byte) = self.sending.pop_front() {
                    self.shift = u16::from(byte) << 1 | 1 << 9;
                    self.bits_left = BITS;
                }
            }
            if self.bits_left > 0 {
                bench.engine.set(self.rx, u128::from(self.shift & 1));
                self.shift >>= 1;
                self.bits_left -= 1;
                self.next_bit = now + self.bit_cycles;
            }
        }
        bench.tick();
        match self.sample_at {
            None => {
                if bench.engine.get(self.tx) == 0 {
                    self.sample_at = Some(now + self.bit_cycles / 2);
                    self.samples = 0;
                }
            }
            Some(at) if at <= now => {
                let level = bench.engine.get(self.tx) as u16;
                self.byte = self.byte >> 1 | level << 9;
                self.samples += 1;
                self.sample_at = Some(at + self.bit_cycles);
                if self.samples == BITS {
                    self.sample_at = None;
                    // A byte without stop bit is dropped.
                    if self.byte >> 9 == 1 {
                        self.received.push_back((self.byte >> 1) as u8);
                    }
                }
            }
            Some(_) => {}
        }
    }
}
