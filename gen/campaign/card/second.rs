//! The second controller of a card: an SPI master at the second interface in each lane, and what it takes from an answer, as
//! [safety.md](../../../docs/safety.md) says.

use super::{CHANNELS, POSITION_BITS};
use crc::{Crc, CRC_16_IBM_3740};
use endat_driver::{Reading, RESULT_WORDS};
use endat_regs::Protocol;
use endat_sim::bench::LaneBench;
use rtl_design::engine::PortId;

/// Half a period of the serial clock, in system clock cycles: the fastest that is allowed.
const HALF: u64 = 4;
/// Words before those of the first channel: mark with count, and hash.
const HEAD_WORDS: usize = 2;
/// Words of a channel, the check sum among them.
const CHANNEL_WORDS: usize = RESULT_WORDS + 1;
/// Bytes of an answer.
const BYTES: usize = 4 * (HEAD_WORDS + CHANNELS * CHANNEL_WORDS);
const SUM: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// An SPI master in each lane; all have one clock.
#[derive(Clone)]
pub struct Masters {
    clock: PortId,
    select: PortId,
    data: PortId,
    /// Lanes whose cards are selected.
    selected: Vec<u64>,
    /// When an answer is to begin, of each lane.
    due: Vec<Option<u64>>,
    /// Bits that have come, of each lane.
    bits: Vec<usize>,
    coming: Vec<Vec<u8>>,
    answers: Vec<Vec<Vec<u8>>>,
}

impl Masters {
    /// Masters at the pins of the second interface; selects no card.
    pub fn new(bench: &mut LaneBench) -> Self {
        bench.set_all("second_cs_n_i", 1);
        let engine = bench.engine();
        let lanes = engine.lanes();
        Self {
            clock: engine.port("second_sck_i"),
            select: engine.port("second_cs_n_i"),
            data: engine.port("second_miso_o"),
            selected: vec![0; lanes / 64],
            due: vec![None; lanes],
            bits: vec![0; lanes],
            coming: vec![vec![]; lanes],
            answers: vec![vec![]; lanes],
        }
    }

    /// A lane's controller asks for an answer then.
    pub fn ask(&mut self, lane: usize, at: u64) {
        self.due[lane] = Some(at);
    }

    /// Answers of a lane that have come since they were taken.
    pub fn take(&mut self, lane: usize) -> Vec<Vec<u8>> {
        std::mem::take(&mut self.answers[lane])
    }

    /// Drives clock and selects, before the bench runs by a cycle.
    pub fn drive(&mut self, bench: &mut LaneBench) {
        let now = bench.cycle();
        if !now.is_multiple_of(HALF) {
            return;
        }
        let rises = now / HALF % 2 == 1;
        for part in 0..self.selected.len() {
            let engine = bench.engine();
            if !rises {
                engine.set_word(self.clock, 0, part, 0);
                self.select(part, now);
                engine.set_word(self.select, 0, part, !self.selected[part]);
                continue;
            }
            let level = engine.word(self.data, 0, part);
            let mut clocked = 0;
            for bit in (0..64).filter(|bit| self.selected[part] >> bit & 1 == 1) {
                let lane = 64 * part + bit;
                if self.bits[lane] < 8 * BYTES {
                    let byte = self.bits[lane] / 8;
                    self.coming[lane][byte] =
                        self.coming[lane][byte] << 1 | (level >> bit & 1) as u8;
                    clocked |= 1 << bit;
                }
                self.bits[lane] += 1;
            }
            engine.set_word(self.clock, 0, part, clocked);
        }
    }

    /// Ends answers, and begins those that are due.
    fn select(&mut self, part: usize, now: u64) {
        for bit in 0..64 {
            let lane = 64 * part + bit;
            if self.selected[part] >> bit & 1 == 1 {
                // The select stays for a period longer.
                if self.bits[lane] > 8 * BYTES {
                    self.selected[part] &= !(1 << bit);
                    self.answers[lane].push(std::mem::take(&mut self.coming[lane]));
                }
            } else if self.due[lane].is_some_and(|due| due <= now) {
                self.due[lane] = None;
                self.selected[part] |= 1 << bit;
                self.bits[lane] = 0;
                self.coming[lane] = vec![0; BYTES];
            }
        }
    }
}

/// What a second controller knows of its card.
#[derive(Clone, Debug, Default)]
pub struct Controller {
    hash: Option<u32>,
    /// Of the answer before; none if that was refused.
    count: Option<u16>,
    sequences: [u16; CHANNELS],
}

impl Controller {
    /// There has been an answer.
    pub fn has_begun(&self) -> bool {
        self.hash.is_some()
    }

    /// The results that it takes from an answer; none where it refuses one.
    pub fn take(&mut self, answer: &[u8]) -> [Option<Reading>; CHANNELS] {
        let word = |b: &[u8]| u32::from_be_bytes([b[0], b[1], b[2], b[3]]);
        let words: Vec<u32> = answer.chunks_exact(4).map(word).collect();
        let first = |channel: usize| HEAD_WORDS + channel * CHANNEL_WORDS;
        // The check sum of the first channel covers the head.
        let is_right = |channel: usize| {
            let from = if channel == 0 { 0 } else { 4 * first(channel) };
            SUM.checksum(&answer[from..4 * (first(channel) + CHANNEL_WORDS)]) == 0
        };
        let count = words[0] as u16;
        let is_next = self
            .count
            .is_some_and(|before| count == before.wrapping_add(1));
        let is_head = is_right(0)
            && words[0] >> 16 == 0x5E00 | CHANNELS as u32
            && words[1] == *self.hash.get_or_insert(words[1]);
        self.count = is_head.then_some(count);
        std::array::from_fn(|channel| {
            let all = &words[first(channel)..][..CHANNEL_WORDS];
            let reading = Reading::new(all, Protocol::Endat);
            let before = self.sequences[channel];
            let is_its = all[RESULT_WORDS] >> 16 == (channel as u32) << 8;
            if !(is_head && is_right(channel) && is_its) {
                return None;
            }
            self.sequences[channel] = reading.sequence;
            let is_new = reading.fresh && !reading.stale && reading.sequence != before;
            let is_whole = reading.fits && reading.width_bits == POSITION_BITS;
            (is_next && is_new && is_whole).then_some(reading)
        })
    }
}
