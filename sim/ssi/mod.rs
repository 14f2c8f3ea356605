//! SSI encoder, written from the encoder's side of the interface.
//!
//! It works in picoseconds and only at edges. The first falling edge of the clock takes the position; each rising edge puts the next bit on
//! DATA, most significant first, and the one behind the last bit LOW. Each falling edge starts the recovery time tm anew; when it is over,
//! DATA goes HIGH and the next falling edge takes a new position. It is strict: what the receiver does wrong is noted as a [`Violation`].
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

/// An encoder and its moment.
#[derive(Clone, Debug)]
pub struct EncoderConfig {
    /// Width of a position, 1 to 48 bits.
    pub position_bits: u32,
    /// It sends Gray code.
    pub gray: bool,
    /// Behind the position comes a bit with which the ones are even, or odd if this is true.
    pub parity: Option<bool>,
    /// Bits before the position, in the order in which it sends them.
    pub before: Vec<Extra>,
    /// Bits after the position, and after its parity bit.
    pub after: Vec<Extra>,
    /// DATA keeps the last bit until `tm` is over, instead of LOW; only without `repeats`.
    pub keeps_last: bool,
    /// It sends the same position again if the clock goes on within `tm`; otherwise DATA stays LOW then.
    pub repeats: bool,
    /// Recovery time: from the last falling edge until DATA is HIGH.
    pub tm: Time,
    /// From a rising edge of the clock to its bit.
    pub bit_delay: Time,
    /// Each bit comes later by at most this.
    pub jitter: Time,
    /// Shortest pulse of the clock.
    pub pulse_min: Time,
    /// Position, as a number.
    pub position: u64,
    /// What is wrong with it.
    pub defect: Defect,
    /// For the jitter.
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
    /// Its bits, most significant first, in its code.
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
    /// This level.
    Level(bool),
    /// With it all bits that have been sent have an even number of ones, or an odd one if this is true.
    Parity(bool),
    /// Six bits, most significant first: the remainder of all bits that have been sent, with six zeros after them, divided by x^6 + x + 1.
    Crc6,
}

impl Extra {
    /// Sends it after these.
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

/// What may be wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// Nothing.
    None,
    /// It does not hear the clock: DATA stays HIGH.
    Silent,
    /// DATA is held LOW.
    StuckLow,
    /// A bit of one copy is wrong, both counted from 0, the most significant bit first.
    Flip {
        /// 0, or 1 for the repetition.
        copy: usize,
        /// Which bit.
        bit: usize,
    },
    /// It takes a new position for each copy.
    TakesAnew,
    /// It has so many bits more, all HIGH.
    Longer(usize),
}

/// The encoder.
#[derive(Clone)]
pub struct Encoder {
    /// What it is; may be changed between two frames.
    pub config: EncoderConfig,
    rng: Rng,
    clock: bool,
    changed: Option<Time>,
    /// Bits of the copy under way, and the LOW one behind them; empty between frames.
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

    /// DATA, as it drives it.
    pub fn data(&self) -> bool {
        match self.config.defect {
            Defect::StuckLow => false,
            Defect::Silent => true,
            _ => self.data,
        }
    }

    /// Notes only so many violations, the last ones.
    pub fn keep(&mut self, most: usize) {
        self.violations.keep(most);
    }

    /// Whole frames; a position that comes twice is one.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// What the receiver has done wrong.
    pub fn violations(&self) -> &[Violation] {
        &self.violations
    }

    /// Whether the next falling edge takes a new position.
    pub fn is_ready(&self) -> bool {
        self.word.is_empty()
    }

    /// Notes what would otherwise be noted at each edge.
    pub(super) fn note(&mut self, violation: Violation) {
        if self.violations.last() != Some(&violation) {
            self.violations.push(violation);
        }
    }

    /// When it wants to act next.
    pub fn next_event(&self) -> Option<Time> {
        let planned = self.planned.front().map(|(time, _)| *time);
        [planned, self.ready].into_iter().flatten().min()
    }

    /// Lets it act up to `time`.
    pub fn advance(&mut self, time: Time) {
        while let Some(event) = self.next_event().filter(|event| *event <= time) {
            if self.planned.front().is_some_and(|(at, _)| *at == event) {
                self.data = self.planned.pop_front().is_none_or(|(_, level)| level);
            } else {
                self.recover();
            }
        }
    }

    /// The recovery time is over.
    fn recover(&mut self) {
        let whole = self.word.len() as u64;
        // Clocks behind the only copy have been noted.
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
