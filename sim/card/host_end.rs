//! Where a host's bytes come into a virtual card: the card's own UART, or a controller at the pins of its bus.

use super::gateway::Gateway;
use endat_sim::bench::{Bench, Uart};
use rtl_design::engine::Compiled;
use std::collections::VecDeque;

/// The host's end.
pub enum HostEnd {
    /// At the pins of the UART.
    Uart(Uart),
    /// In front of a controller.
    Gateway(Gateway),
}

impl HostEnd {
    /// Bytes for the card.
    pub fn send(&mut self, bytes: &[u8], now: u64) {
        match self {
            Self::Uart(uart) => uart.send(bytes),
            Self::Gateway(gateway) => gateway.send(bytes, now),
        }
    }

    /// Bytes that the card has not got yet.
    pub fn unsent(&self) -> usize {
        match self {
            Self::Uart(uart) => uart.unsent(),
            Self::Gateway(gateway) => gateway.unsent(),
        }
    }

    /// Bytes that have come from the host and are still here.
    pub fn untaken(&self) -> usize {
        match self {
            Self::Uart(uart) => uart.unsent(),
            Self::Gateway(gateway) => gateway.untaken(),
        }
    }

    /// Drops those.
    pub fn forget(&mut self) {
        match self {
            Self::Uart(uart) => uart.forget(),
            Self::Gateway(gateway) => gateway.forget(),
        }
    }

    /// Bytes from the card.
    pub fn received(&mut self) -> &mut VecDeque<u8> {
        match self {
            Self::Uart(uart) => uart.received(),
            Self::Gateway(gateway) => gateway.received(),
        }
    }

    /// Runs the card by a cycle at least.
    pub fn step(&mut self, card: &mut Bench<Compiled>) {
        match self {
            Self::Uart(uart) => uart.tick(card),
            Self::Gateway(gateway) => gateway.step(card),
        }
    }

    /// What is not simulated comes in real time from now on.
    pub fn keep_time(&mut self) {
        if let Self::Gateway(gateway) = self {
            gateway.keep_time();
        }
    }
}
