//! Sends a supplement.

use super::{command, Phase, TestReceiver};

/// Duration of clock LOW before a supplement, in microseconds.
pub const PAUSE_US: u64 = 2;
/// Rising edges of a supplement.
const EDGES: u32 = 35;

impl TestReceiver {
    pub(super) fn park(&mut self, until: u64) {
        self.take_bit();
        if self.bits.len() == self.answer_bits() && self.cycle >= until {
            self.phase = Phase::Supplement;
            self.supplement_edges = 0;
            self.next_edge = self.cycle;
        }
    }

    pub(super) fn supplement(&mut self) {
        if self.cycle < self.next_edge {
            return;
        }
        self.next_edge = self.cycle + self.period / 2;
        if self.at("endat_clk") == 0 {
            self.put("endat_clk", 1);
            self.supplement_edges += 1;
            if self.supplement_edges == EDGES {
                let cause = self.decode();
                self.finish(cause);
                self.phase = Phase::Recover { since: self.cycle };
            }
            return;
        }
        self.put("endat_clk", 0);
        let (address, parameter) = (self.at("address"), self.at("parameter"));
        let bit = command::supplement_bit(self.supplement_edges, address, parameter);
        self.put("data_oe", u128::from(bit.is_some()));
        self.put("data_o", u128::from(bit == Some(true)));
    }
}
