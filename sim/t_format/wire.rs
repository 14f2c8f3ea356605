//! Bytes as edges on the line.

use super::config::{Defect, EncoderConfig};
use crate::{rng::Rng, Time};

/// Bit timing on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wire {
    /// Duration of a bit.
    pub bit: Time,
    /// Largest deviation of each edge.
    pub jitter: Time,
}

impl EncoderConfig {
    /// Bit timing of the encoder.
    pub fn wire(&self) -> Wire {
        let bit = self.nominal_bit() as i64;
        Wire {
            bit: (bit * 1_000_000 / (1_000_000 + self.rate_error_ppm)) as Time,
            jitter: self.jitter,
        }
    }
}

impl Wire {
    /// Changes of the line with these levels, one for each bit, from `start` on; it is HIGH before and after.
    pub fn changes(&self, levels: &[bool], start: Time, rng: &mut Rng) -> Vec<(Time, bool)> {
        let mut changes = vec![];
        let mut before = true;
        for (index, level) in levels.iter().chain([&true]).enumerate() {
            if *level != before {
                let nominal = (start + index as u64 * self.bit) as i64;
                let jitter = match self.jitter {
                    0 => 0,
                    peak => rng.around_zero(peak),
                };
                changes.push(((nominal + jitter) as Time, *level));
            }
            before = *level;
        }
        changes
    }
}

/// Levels of a field: start, eight bits LSB first, delimiter.
fn field(byte: u8) -> impl Iterator<Item = bool> {
    let bits = (0..8).map(move |i| byte >> i & 1 == 1);
    [false].into_iter().chain(bits).chain([true])
}

/// Changes of the line with these consecutive fields from `start` on.
pub fn edges(bytes: &[u8], wire: &Wire, start: Time, rng: &mut Rng) -> Vec<(Time, bool)> {
    let levels: Vec<bool> = bytes.iter().flat_map(|byte| field(*byte)).collect();
    wire.changes(&levels, start, rng)
}

/// As [`edges`], with a defect; the second value is the time when the driver goes off.
pub(super) fn spoilt(
    bytes: &[u8],
    wire: &Wire,
    defect: &Defect,
    start: Time,
    rng: &mut Rng,
) -> (Vec<(Time, bool)>, Time) {
    let mut changes = vec![];
    let mut at = start;
    if let Defect::Pulse { ahead, width } = *defect {
        changes.extend([(start - ahead, false), (start - ahead + width, true)]);
    } else {
        // The driver is on before the start bit.
        changes.push((start - wire.bit / 2, true));
    }
    for (index, byte) in bytes.iter().enumerate() {
        let mut levels: Vec<bool> = field(*byte).collect();
        match *defect {
            Defect::Short { fields } if index >= fields => break,
            Defect::Pause { field, length } if field == index => at += length,
            Defect::Flip { field, bit } if field == index => levels[bit + 1] = !levels[bit + 1],
            Defect::Delimiter { field } if field == index => levels[9] = false,
            _ => {}
        }
        changes.extend(wire.changes(&levels, at, rng));
        at += 10 * wire.bit;
    }
    (changes, at)
}
