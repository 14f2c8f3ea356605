//! SSI encoder, written from the encoder's side of the interface.
//!
//! It works in picoseconds and only at edges. The first falling edge of the clock latches the position; each rising edge puts the next bit on
//! DATA, most significant first, and the edge after the last bit sets DATA LOW. Each falling edge restarts the recovery time tm; at its end
//! DATA goes HIGH and the next falling edge latches a new position. It is strict: every error of the receiver is noted as a [`Violation`].
//! It shares no code with the core.
//!
//! ```text
//! clock ~~~~\_/~\_/~\_ ... _/~\_/~~~~~~~~~~~~~~~~~~~
//! data  ~~~~~~~<  >< ...   ><   >\___________/~~~~~~
//!           ^ taken             |<--- tm --->|
//! ```

mod link;
#[cfg(test)]
mod tests;
mod violation;

pub use link::{SsiLink, SsiMotion};
pub use violation::Violation;

use crate::{rng::Rng, Journal, Time, NS, US};
use std::collections::VecDeque;

/// An encoder and its present state.
#[derive(Clone, Debug)]
pub struct EncoderConfig {
    /// Width of a position, 1 to 48 bits.
    pub position_bits: u32,
    /// Sends Gray code.
    pub gray: bool,
    /// A parity bit after the position: even, or odd if true.
    pub parity: Option<bool>,
    /// Bits before the position, in the order of transmission.
    pub before: Vec<Extra>,
    /// Bits after the position, and after its parity bit.
    pub after: Vec<Extra>,
    /// DATA keeps the last bit, instead of LOW, until `tm` is over; only without `repeats`.
    pub keeps_last: bool,
    /// Sends the same position again if the clock continues within `tm`; otherwise DATA stays LOW then.
    pub repeats: bool,
    /// Recovery time: from the last falling edge until DATA is HIGH.
    pub tm: Time,
    /// Delay from a rising edge of the clock to its bit.
    pub bit_delay: Time,
    /// Largest additional delay of a bit.
    pub jitter: Time,
    /// Shortest pulse of the clock.
    pub pulse_min: Time,
    /// Position as a number.
    pub position: u64,
    /// Fault.
    pub defect: Defect,
    /// Seed of the jitter.
    pub seed: u64,
}

impl Default for EncoderConfig {
    /// A multi-turn encoder of 25 bits, 12 of them turns.
    fn default() -> Self {
        Self {
            position_bits: 25,
            gray: false,
            parity: None,
            before: vec![],
            after: vec![],
            keeps_last: false,
            repeats: true,
            tm: 20 * US,
            bit_delay: 150 * NS,
            jitter: 0,
            pulse_min: 200 * NS,
            position: 0,
            defect: Defect::None,
            seed: 1,
        }
    }
}

impl EncoderConfig {
    /// The bits, most significant first, in the encoder's code.
    fn bits(&self) -> Vec<bool> {
        let code = match self.gray {
            true => self.position ^ self.position >> 1,
            false => self.position,
        };
        let places = (0..self.position_bits).rev();
        let bits = places.map(|n| code >> n & 1 == 1);
        let parity = self.parity.map(|odd| (code.count_ones() % 2 == 1) != odd);
        let mut sent = vec![];
        self.before.iter().for_each(|extra| extra.send(&mut sent));
        sent.extend(bits.chain(parity));
        self.after.iter().for_each(|extra| extra.send(&mut sent));
        sent
    }
}

/// A bit that is not position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extra {
    /// Constant level.
    Level(bool),
    /// Parity of all bits sent so far and this one: even, or odd if true.
    Parity(bool),
    /// Six bits, most significant first: the remainder of all bits sent so far, followed by six zeros, divided by x^6 + x + 1.
    Crc6,
}

impl Extra {
    /// Appends it to the sent bits.
    fn send(self, sent: &mut Vec<bool>) {
        match self {
            Self::Level(level) => sent.push(level),
            Self::Parity(odd) => {
                sent.push((sent.iter().filter(|bit| **bit).count() % 2 == 1) != odd)
            }
            Self::Crc6 => {
                let divided = sent.iter().map(|bit| u64::from(*bit)).chain([0; 6]);
                let remainder = divided.fold(0, |rest, bit| {
                    let rest = rest << 1 | bit;
                    rest ^ if rest & 0x40 == 0 { 0 } else { 0x43 }
                });
                sent.extend((0..6).rev().map(|n| remainder >> n & 1 == 1));
            }
        }
    }
}

/// Faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// Nothing.
    None,
    /// The encoder ignores the clock: DATA stays HIGH.
    Silent,
    /// DATA is held LOW.
    StuckLow,
    /// A bit of one copy is wrong, both counted from 0, the most significant bit first.
    Flip {
        /// 0, or 1 for the repetition.
        copy: usize,
        /// Bit.
        bit: usize,
    },
    /// Latches a new position for each copy.
    TakesAnew,
    /// Has this many additional bits, all HIGH.
    Longer(usize),
}

/// The encoder.
#[derive(Clone)]
pub struct Encoder {
    /// Configuration; may be changed between two frames.
    pub config: EncoderConfig,
    rng: Rng,
    clock: bool,
    changed: Option<Time>,
    /// Bits of the copy under way, and the LOW bit after them; empty between frames.
    word: Vec<bool>,
    rises: u64,
    copies: usize,
    planned: VecDeque<(Time, bool)>,
    data: bool,
    ready: Option<Time>,
    frames: u64,
    violations: Journal<Violation>,
}

impl Encoder {
    /// An encoder on a line at rest.
    pub fn new(config: EncoderConfig) -> Self {
        Self {
            rng: Rng::new(config.seed),
            config,
            clock: true,
            changed: None,
            word: vec![],
            rises: 0,
            copies: 0,
            planned: VecDeque::new(),
            data: true,
            ready: None,
            frames: 0,
            violations: Journal::default(),
        }
    }

    /// DATA as driven by the encoder.
    pub fn data(&self) -> bool {
        match self.config.defect {
            Defect::StuckLow => false,
            Defect::Silent => true,
            _ => self.data,
        }
    }

    /// Keeps only the last `most` violations.
    pub fn keep(&mut self, most: usize) {
        self.violations.keep(most);
    }

    /// Number of whole frames; a repeated position counts once.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Violations of the receiver.
    pub fn violations(&self) -> &[Violation] {
        &self.violations
    }

    /// True if the next falling edge latches a new position.
    pub fn is_ready(&self) -> bool {
        self.word.is_empty()
    }

    /// Notes a violation once instead of at each edge.
    pub(super) fn note(&mut self, violation: Violation) {
        if self.violations.last() != Some(&violation) {
            self.violations.push(violation);
        }
    }

    /// Time of its next action.
    pub fn next_event(&self) -> Option<Time> {
        let planned = self.planned.front().map(|(time, _)| *time);
        [planned, self.ready].into_iter().flatten().min()
    }

    /// Executes its actions up to `time`.
    pub fn advance(&mut self, time: Time) {
        while let Some(event) = self.next_event().filter(|event| *event <= time) {
            if self.planned.front().is_some_and(|(at, _)| *at == event) {
                self.data = self.planned.pop_front().is_none_or(|(_, level)| level);
            } else {
                self.recover();
            }
        }
    }

    /// Ends the recovery time.
    fn recover(&mut self) {
        let whole = self.word.len() as u64;
        // Clocks after the only copy have been noted.
        let is_whole = match self.config.repeats {
            true => self.rises == whole * (self.copies as u64 + 1),
            false => self.rises >= whole,
        };
        if !is_whole {
            self.violations.push(Violation::Clocks(self.rises));
        } else {
            self.frames += 1;
        }
        self.word.clear();
        self.planned.clear();
        self.ready = None;
        self.data = true;
    }

    /// The clock changes at the encoder.
    pub fn clock(&mut self, time: Time, level: bool) {
        self.advance(time);
        if level == self.clock {
            return;
        }
        let short = |before: Time| time - before < self.config.pulse_min;
        if !self.word.is_empty() && self.changed.is_some_and(short) {
            self.note(Violation::ShortPulse);
        }
        self.clock = level;
        self.changed = Some(time);
        match level {
            false => self.fall(time),
            true => self.rise(time),
        }
    }

    fn take(&mut self) {
        self.word = self.config.bits();
        if let Defect::Longer(bits) = self.config.defect {
            self.word.extend(vec![true; bits]);
        }
        let last = self.word.last().is_some_and(|last| *last);
        self.word.push(self.config.keeps_last && last);
    }

    fn fall(&mut self, time: Time) {
        if self.word.is_empty() {
            self.take();
            (self.rises, self.copies) = (0, 0);
        } else if !self.config.repeats {
            if self.rises >= self.word.len() as u64 {
                self.note(Violation::NoRepeat);
            }
        } else if self.rises == self.word.len() as u64 * (self.copies as u64 + 1) {
            if self.config.defect == Defect::TakesAnew {
                self.config.position = self.config.position.wrapping_add(1);
                self.take();
            }
            self.copies += 1;
        }
        self.ready = Some(time + self.config.tm);
    }

    fn rise(&mut self, time: Time) {
        // CLOCK was LOW for longer than tm: the frame is over, and the edge brings no bit.
        if self.word.is_empty() {
            return;
        }
        let is_over = !self.config.repeats && self.rises >= self.word.len() as u64;
        let place = (self.rises % self.word.len() as u64) as usize;
        self.rises += 1;
        let mut level = match is_over {
            true => self.word.last().is_some_and(|last| *last),
            false => self.word[place],
        };
        if let Defect::Flip { copy, bit } = self.config.defect {
            level ^= copy == self.copies && bit == place;
        }
        let jitter = match self.config.jitter {
            0 => 0,
            most => self.rng.in_range(0, most),
        };
        let at = time + self.config.bit_delay + jitter;
        self.planned.push_back((at, level));
    }
}
