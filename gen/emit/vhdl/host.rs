//! A host at the bus of a simulated card, for the run that a bench plays again.

use crate::buses::front;
use crate::front::Controller;
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::CardConfig;
use endat_sim::bench::{Bench, Uart};
use rtl_design::engine::Compiled;

/// A UART's answer is waited for so many bytes longer than it is.
const SPARE_BYTES: u64 = 20;
const BITS_OF_BYTE: u64 = 10;

/// The host.
pub(super) struct Host {
    controller: Option<&'static dyn Controller>,
    uart: Option<(Uart, u64)>,
}

impl Host {
    /// At the bus of this card; leaves it at rest.
    pub fn new(bus: HostBus, card: &CardConfig, bench: &mut Bench<Compiled>) -> Self {
        if bench.has_port("second_cs_n_i") {
            bench.set("second_cs_n_i", 1);
        }
        let controller = front(bus).controller;
        if let Some(controller) = controller {
            controller.rest(bench);
        }
        let is_uart = bus == HostBus::Uart;
        let uart = is_uart.then(|| (Uart::new(bench, card.uart_bit_cycles), card.uart_bit_cycles));
        Self { controller, uart }
    }

    /// Some cycles in which the host does nothing new.
    pub fn run(&mut self, bench: &mut Bench<Compiled>, cycles: u64) {
        match &mut self.uart {
            Some((uart, _)) => (0..cycles).for_each(|_| uart.tick(bench)),
            None => bench.run_cycles(cycles),
        }
    }

    /// Reads words from a word address on; none if no answer comes.
    pub fn read(&mut self, bench: &mut Bench<Compiled>, address: u64, words: u64) -> Vec<u32> {
        let Some(controller) = self.controller else {
            return match self.uart {
                Some(_) => self.read_uart(bench, address, words),
                None => vec![],
            };
        };
        let each = (0..words).map(|n| {
            let word = controller.read_word(bench, (address + n) as u16);
            bench.run_cycles(1);
            word
        });
        each.collect::<Option<_>>().unwrap_or_default()
    }

    /// Writes a word.
    pub fn write(&mut self, bench: &mut Bench<Compiled>, address: u64, value: u32) {
        match self.controller {
            Some(controller) => {
                controller.write(bench, address as u16, value);
                bench.run_cycles(1);
            }
            None => {
                let bytes = [command(1, address, 1), value.to_be_bytes().to_vec()].concat();
                self.exchange(bench, &bytes, 0);
            }
        }
    }

    fn read_uart(&mut self, bench: &mut Bench<Compiled>, address: u64, words: u64) -> Vec<u32> {
        let bytes = self.exchange(bench, &command(2, address, words), 4 * words);
        let words = bytes.chunks_exact(4);
        words
            .map(|b| u32::from_be_bytes([b[0], b[1], b[2], b[3]]))
            .collect()
    }

    /// Sends bytes and waits for so many.
    fn exchange(&mut self, bench: &mut Bench<Compiled>, bytes: &[u8], answer: u64) -> Vec<u8> {
        let Some((uart, bit_cycles)) = &mut self.uart else {
            return vec![];
        };
        let byte_cycles = BITS_OF_BYTE * *bit_cycles;
        uart.received().clear();
        uart.send(bytes);
        let longest = (bytes.len() as u64 + answer + SPARE_BYTES) * byte_cycles;
        for _ in 0..longest {
            if uart.unsent() == 0 && uart.received().len() as u64 >= answer {
                break;
            }
            uart.tick(bench);
        }
        let received = uart.received().drain(..).collect();
        self.run(bench, 2 * byte_cycles);
        received
    }
}

/// A command of the link.
fn command(code: u8, address: u64, words: u64) -> Vec<u8> {
    let mut bytes = vec![code, words as u8];
    bytes.extend((address as u32).to_be_bytes());
    bytes
}
