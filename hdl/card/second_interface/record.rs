//! Record of one channel for the second interface.
//!
//! ```text
//! result words of the channel --(take)--> held --+
//! channel, word_at ------------------------------+--> word, 0 if it is another channel's
//! ```
//!
//! The words are held from the beginning of an answer on: a result that comes in between is in the next one.

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
    /// The words of the register block `result`, as they are now.
    pub live: Vec<Signal<In, Bits<32>>>,
    /// Strobe: take them.
    pub take: Signal<In, Bit>,
    /// Channel whose word is wanted.
    pub channel: Signal<In, Bits<4>>,
    /// Which of its words; following the last one that of the check sum.
    pub word_at: Signal<In, Bits<4>>,
    /// Word of the channels following this one.
    pub word_in: Signal<In, Bits<32>>,
    /// The same, or this channel's word.
    pub word: Signal<Out, Bits<32>>,
    /// Words of the record, as of the beginning of the answer.
    held: Vec<Reg<Bits<32>>>,
    /// Number of this channel.
    number: Constant<Bits<4>>,
    /// Word of this channel that is asked for.
    own: Signal<Local, Bits<32>>,
    _words: usize,
}

impl SecondRecord {
    /// That of channel `channel`.
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
        // The number comes from here: a record in the place of another one is found out.
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
