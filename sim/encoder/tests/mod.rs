//! The encoder alone, with an ideal receiver at its pins.

mod position;

use super::*;
use crate::{MS, NS, US};

/// An ideal receiver right at the encoder.
struct Master {
    encoder: Encoder,
    now: Time,
    half: Time,
    /// Outputs of the encoder, with the moments of their changes.
    outputs: Vec<(Time, Output)>,
}

impl Master {
    fn new(config: EncoderConfig, hz: u64) -> Self {
        let encoder = Encoder::new(config);
        Self {
            outputs: vec![(0, encoder.output())],
            encoder,
            now: 10 * US,
            half: 500_000_000_000 / hz,
        }
    }

    fn wait(&mut self, span: Time) {
        let end = self.now + span;
        while let Some(t) = self.encoder.next_event().filter(|t| *t <= end) {
            self.encoder.advance(t);
            self.note(t);
        }
        self.now = end;
    }

    fn note(&mut self, time: Time) {
        let output = self.encoder.output();
        if self.outputs.last().is_none_or(|o| o.1 != output) {
            self.outputs.push((time, output));
        }
    }

    fn edge(&mut self, level: bool, data: Drive) {
        self.encoder.clock_edge(self.now, level, data);
        self.note(self.now);
    }

    fn command_bit(command: u8, rise: u32) -> Drive {
        match rise {
            2 => Drive::Low,
            3..=8 => Drive::level(command >> (8 - rise) & 1 != 0),
            _ => Drive::Released,
        }
    }

    /// Gives `pulses` clock pulses, the first LOW for `first_low`, and returns the bits seen just before each falling edge.
    fn pulses(&mut self, command: u8, first_low: Time, pulses: u32) -> Vec<Output> {
        let mut seen = Vec::new();
        for rise in 1..=pulses {
            let data = Self::command_bit(command, rise);
            self.edge(false, data);
            self.wait(if rise == 1 { first_low } else { self.half });
            self.edge(true, data);
            self.wait(self.half);
            seen.push(self.encoder.output());
        }
        seen
    }

    fn violations(&self) -> Vec<Violation> {
        self.encoder.violations().iter().map(|v| v.1).collect()
    }

    fn drives(&self, symbol: Symbol) -> Time {
        let found = self.outputs.iter().rfind(|o| o.1.symbol == symbol);
        found.expect("the symbol was on the line").0
    }
}
