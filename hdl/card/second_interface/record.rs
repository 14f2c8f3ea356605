//! Record of one channel for the second interface.
//!
//! ```text
//! result words of the channel --(take)--> held --+
//! channel, word_at ------------------------------+--> word, 0 for other channels
//! ```
//!
//! The words are held from the beginning of an answer; a later result belongs to the next answer.

use super::RECORD_WORDS;
use crate::replicate::each;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Record of one channel.
#[derive(LogicBlock, Block)]
pub struct SecondRecord {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// The current words of the register block `result`.
    pub live: Vec<Signal<In, Bits<32>>>,
    /// Strobe: latch the words.
    pub take: Signal<In, Bit>,
    /// Selected channel.
    pub channel: Signal<In, Bits<4>>,
    /// Selected word; after the last one the check sum.
    pub word_at: Signal<In, Bits<4>>,
    /// Word of the channels after this one.
    pub word_in: Signal<In, Bits<32>>,
    /// `word_in`, or this channel's word.
    pub word: Signal<Out, Bits<32>>,
    /// Words of the record, latched at the beginning of the answer.
    held: Vec<Reg<Bits<32>>>,
    /// Number of this channel.
    number: Constant<Bits<4>>,
    /// Selected word of this channel.
    own: Signal<Local, Bits<32>>,
    _words: usize,
}

impl SecondRecord {
    /// The record of channel `channel`.
    pub fn new(channel: usize) -> Self {
        Self::from_parts(SecondRecordParts {
            live: each(RECORD_WORDS),
            held: each(RECORD_WORDS),
            number: Constant::new((channel as u64).into()),
            _words: RECORD_WORDS,
        })
    }
}

#[kernel]
impl Logic for SecondRecord {
    fn update(&mut self) {
        for i in 0..self._words {
            connect!(self.held[i] <= self; clock, reset);
            self.held[i].d.next = self.held[i].q.val();
            if self.take.val() {
                self.held[i].d.next = self.live[i].val();
            }
        }
        // The record supplies the number itself, so that a swapped record is detected.
        self.own.next = bit_cast::<32, 4>(self.number.val()) << 24;
        match self.word_at.val().index() {
            0 => {
                self.own.next = self.held[0].q.val();
            }
            1 => {
                self.own.next = self.held[1].q.val();
            }
            2 => {
                self.own.next = self.held[2].q.val();
            }
            3 => {
                self.own.next = self.held[3].q.val();
            }
            4 => {
                self.own.next = self.held[4].q.val();
            }
            5 => {
                self.own.next = self.held[5].q.val();
            }
            6 => {
                self.own.next = self.held[6].q.val();
            }
            7 => {
                self.own.next = self.held[7].q.val();
            }
            _ => {}
        }
        self.word.next = self.word_in.val();
        if self.channel.val() == self.number.val() {
            self.word.next = self.own.val();
        }
    }
}
