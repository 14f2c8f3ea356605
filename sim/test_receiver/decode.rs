//! Decodes answers.

use super::{command, TestReceiver};
use crate::frame::crc5;

impl TestReceiver {
    /// Decodes the answer and returns the cause.
    pub(super) fn decode(&mut self) -> u128 {
        let is_position = !command::has_parameter(self.at("command"));
        let (head, infos) = self.bits.split_at(self.head_bits());
        let bit = |i: usize| u128::from(head[i]);
        let fields_at = 2 + usize::from(self.has_f2());
        let crc_at = head.len() - 5;
        let received = (crc_at..head.len()).fold(0, |c, i| c << 1 | bit(i));
        let computed = u128::from(crc5(head[1..crc_at].iter().copied()));
        let (f1, f2) = match (is_position, fields_at) {
            (true, 3) => (bit(1), bit(2)),
            (true, _) => (bit(1), 1),
            (false, _) => (0, 1),
        };
        let (reply, _) = command::block(&head[1..]);
        self.position = match is_position {
            true => (fields_at..crc_at).rev().fold(0, |p, i| p << 1 | bit(i)),
            false => self.position,
        };
        let blocks: Vec<_> = infos.chunks(30).map(|b| command::block(&b[1..])).collect();
        // Additional data 2 comes first.
        let names = [("info_2", 2), ("info_1", 1)];
        let selected = self.at("infos");
        let expected = names.iter().filter(|n| selected & n.1 != 0);
        let mut errors = 0;
        for ((name, mask), (covered, good)) in expected.zip(&blocks) {
            self.put(name, *covered);
            errors |= if *good { 0 } else { u128::from(*mask) };
        }
        self.put("info_errors", errors);
        if !is_position {
            self.put("reply", reply);
        }
        self.put("crc_received", received);
        self.put("crc_computed", computed);
        match (received == computed, f1, f2) {
            (false, _, _) => 4,
            (_, 1, _) => 5,
            (_, _, 0) => 6,
            _ => 0,
        }
    }
}
