//! A controller between a host and the bus of a card: words in the UARTBone format, each an access over the pins.
//!
//! ```text
//! host's bytes <-> Gateway <-> Controller <-> pins of the bus
//! ```
//!
//! What a card with a UART does by itself, this one does for it: frames of the stream go out between two answers while the host has asked
//! for that, whether they come out of `card.stream_data` or are [made](super::sets).

use super::sets::Sets;
use endat_emit::front::Controller;
use endat_hdl::regs::{Block, BLOCK_STRIDE, CARD, CARD_CONFIG, CHANNELS_MAX, RESULT_BASE};
use endat_sim::bench::Bench;
use rtl_design::engine::Compiled;
use std::collections::VecDeque;

/// Bytes of a command before its words.
const HEAD_BYTES: usize = 6;
/// Comes before an answer while frames are pushed.
const ANSWER: u8 = 0xFF;
/// Bits of `card.stream_control`.
const COLLECT: u32 = 1;
const PUSH: u32 = 2;
/// Behind the last result word.
const RESULTS_END: u16 = RESULT_BASE + BLOCK_STRIDE * CHANNELS_MAX as u16;
/// Time between two looks at the stream's buffer, in microseconds.
const LOOK_US: u64 = 50;
/// Bytes that are on their way to the host at most, before more of the stream is fetched.
const OUTBOX_MAX: usize = 1 << 15;

/// The controller.
pub struct Gateway {
    words: &'static dyn Controller,
    inbox: VecDeque<u8>,
    outbox: VecDeque<u8>,
    /// When the last byte came, and how long half a command waits for more, in cycles.
    heard: u64,
    timeout_cycles: u64,
    look_cycles: u64,
    looked: u64,
    pushes: bool,
    /// The next answer has a marker.
    marks: bool,
    /// A frame that has not come to its end.
    frame: Vec<u8>,
    sets: Option<Sets>,
}

/// Where a word of the card stands.
fn at(block: &Block, name: &str) -> u16 {
    match block.register(name) {
        Some(register) => block.address(register, 0),
        None => unreachable!("the table has {name}"),
    }
}

impl Gateway {
    /// A controller at the pins of this bus; `sets`, if there are any, stand for the card's own stream.
    pub fn new(
        words: &'static dyn Controller,
        card: &mut Bench<Compiled>,
        timeout_us: u64,
        sets: Option<Sets>,
    ) -> Self {
        words.rest(card);
        let per_us = (card.system_hz() / 1_000_000).max(1);
        Self {
            words,
            inbox: VecDeque::new(),
            outbox: VecDeque::new(),
            heard: 0,
            timeout_cycles: timeout_us * per_us,
            look_cycles: LOOK_US * per_us,
            looked: 0,
            pushes: false,
            marks: false,
            frame: Vec::new(),
            sets,
        }
    }

    /// Bytes from the host.
    pub fn send(&mut self, bytes: &[u8], now: u64) {
        self.heard = now;
        self.inbox.extend(bytes);
    }

    /// Bytes of commands that have not been carried out.
    pub fn unsent(&self) -> usize {
        match self.is_whole() {
            true => self.inbox.len(),
            false => 0,
        }
    }

    /// Bytes that have come and have not been carried out, be they a command or not.
    pub fn untaken(&self) -> usize {
        self.inbox.len()
    }

    /// Drops what has not been carried out.
    pub fn forget(&mut self) {
        self.inbox.clear();
    }

    /// Bytes for the host.
    pub fn received(&mut self) -> &mut VecDeque<u8> {
        &mut self.outbox
    }

    /// Made sets come in real time from now on.
    pub fn keep_time(&mut self) {
        if let Some(sets) = &mut self.sets {
            sets.keep_time();
        }
    }

    fn length(&self) -> Option<usize> {
        let words = usize::from(*self.inbox.get(1)?);
        Some(match self.inbox[0] {
            1 | 3 => HEAD_BYTES + 4 * words,
            _ => HEAD_BYTES,
        })
    }

    /// Whether the first command has all its bytes.
    fn is_whole(&self) -> bool {
        self.length()
            .is_some_and(|length| self.inbox.len() >= length)
    }

    /// Does what there is to do, over the pins; at least a cycle.
    pub fn step(&mut self, card: &mut Bench<Compiled>) {
        while self.inbox.front().is_some_and(|b| !(1..=4).contains(b)) {
            self.inbox.pop_front();
        }
        if self.is_whole() {
            self.command(card);
        } else if !self.inbox.is_empty() && card.cycle() > self.heard + self.timeout_cycles {
            self.inbox.clear();
        }
        if self.pushes && self.outbox.len() < OUTBOX_MAX {
            self.push(card);
        }
        card.tick();
    }

    fn command(&mut self, card: &mut Bench<Compiled>) {
        let length = self.length().unwrap_or_default();
        let command: Vec<u8> = self.inbox.drain(..length).collect();
        let word = |b: &[u8]| u32::from_be_bytes([b[0], b[1], b[2], b[3]]);
        let (address, count) = (word(&command[2..HEAD_BYTES]), usize::from(command[1]));
        match command[0] {
            code @ (1 | 3) => {
                for (n, bytes) in command[HEAD_BYTES..].chunks_exact(4).enumerate() {
                    let step = if code == 1 { n as u32 } else { 0 };
                    self.write(card, address.wrapping_add(step), word(bytes));
                }
            }
            // No word is no answer.
            _ if count == 0 => {}
            code => {
                let words = self.read(card, address, count, code == 2);
                if self.marks {
                    self.outbox.push_back(ANSWER);
                }
                self.marks = self.pushes;
                self.outbox
                    .extend(words.iter().flat_map(|w| w.to_be_bytes()));
            }
        }
    }

    fn write(&mut self, card: &mut Bench<Compiled>, address: u32, word: u32) {
        let Some(place) = (address < self.words.addresses()).then_some(address as u16) else {
            return;
        };
        if self.words.has_registers() && place == at(&CARD, "stream_control") {
            self.pushes = word & PUSH != 0;
            self.marks |= self.pushes;
            let collects = self.sets.is_none() && word & COLLECT != 0;
            match &mut self.sets {
                Some(sets) if self.pushes => sets.begin(),
                _ => {}
            }
            return self.words.write(card, place, collects.into());
        }
        self.words.write(card, place, word);
    }

    fn read(
        &mut self,
        card: &mut Bench<Compiled>,
        address: u32,
        count: usize,
        rises: bool,
    ) -> Vec<u32> {
        // Behind the last address nothing is asked for, so that no bus begins anew there.
        let there = self.words.addresses().saturating_sub(address) as usize;
        let asked = if rises || there == 0 {
            count.min(there)
        } else {
            count
        };
        if asked == 0 {
            return vec![0; count];
        }
        let mut words = self.burst(card, address as u16, asked, rises);
        words.resize(count, 0);
        let place = |name| {
            let back = usize::from(at(&CARD, name)).checked_sub(address as usize)?;
            (back < count && (rises || back == 0)).then_some(back)
        };
        if !self.words.has_registers() {
            return words;
        }
        if let Some(control) = place("stream_control") {
            words[control] |= if self.pushes { PUSH } else { 0 };
        }
        if let (Some(sets), Some(count)) = (&self.sets, place("trigger_count")) {
            words[count] = sets.triggers();
        }
        words
    }

    /// Reads words; those of results are of one moment.
    fn burst(
        &mut self,
        card: &mut Bench<Compiled>,
        address: u16,
        count: usize,
        rises: bool,
    ) -> Vec<u32> {
        let words = self.words;
        let has_results = (RESULT_BASE..RESULTS_END).contains(&address) && rises && count > 1;
        // On some buses they are so only while they are held.
        if !words.must_hold() || !has_results {
            return words.read(card, address, count, rises);
        }
        let hold = at(&CARD_CONFIG, "hold");
        let was = words.read(card, hold, 1, true)[0];
        words.write(card, hold, was | 1);
        let held = words.read(card, address, count, rises);
        words.write(card, hold, was);
        held
    }

    /// Fetches what the stream has, and hands whole frames on.
    fn push(&mut self, card: &mut Bench<Compiled>) {
        if let Some(sets) = &mut self.sets {
            return sets.give(&mut self.outbox);
        }
        if card.cycle() < self.looked + self.look_cycles {
            return;
        }
        self.looked = card.cycle();
        let bytes = self.words.read(card, at(&CARD, "stream_state"), 1, true)[0] & 0xFFFF;
        let count = (bytes as usize).div_ceil(4);
        for word in self
            .words
            .read(card, at(&CARD, "stream_data"), count, false)
        {
            for byte in word.to_be_bytes() {
                match (byte, self.frame.is_empty()) {
                    // Bytes that are not there are zeros, too.
                    (0, true) => {}
                    (0, false) => {
                        self.frame.push(0);
                        self.outbox.extend(self.frame.drain(..));
                    }
                    _ => self.frame.push(byte),
                }
            }
        }
    }
}
