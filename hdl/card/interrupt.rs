//! Interrupt: one line to a processor for the events of all channels.
//!
//! ```text
//! result, error, alarm, request of each channel --> status (stays until cleared) --(mask)--> irq
//! ```
//!
//! An event in the cycle of its clear is not lost.

use crate::regs::INTERRUPT;
use crate::replicate::each;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Status, mask and line.
#[derive(LogicBlock, Block)]
#[properties("../properties/interrupt.sv")]
pub struct Interrupt {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe for each channel: a new result is valid.
    pub result: Vec<Signal<In, Bit>>,
    /// For each channel, from the cycle after `result` on: the result is an error.
    pub error: Vec<Signal<In, Bit>>,
    /// For each channel: alarm.
    pub alarm: Vec<Signal<In, Bit>>,
    /// Strobe for each channel: the frame of a request has ended.
    pub request: Vec<Signal<In, Bit>>,
    /// Word address of an access.
    pub word_address: Signal<In, Bits<11>>,
    /// The front's address fits `word_address`.
    pub in_range: Signal<In, Bit>,
    /// Byte of the word, 0 = most significant.
    pub lane: Signal<In, Bits<2>>,
    /// One-cycle strobe: write the word.
    pub write: Signal<In, Bit>,
    /// Word to write.
    pub write_data: Signal<In, Bits<32>>,
    /// Byte of the word, a cycle after its address; 0 for words of other blocks.
    pub read_byte: Signal<Out, Bits<8>>,
    /// An enabled event is set.
    pub irq: Signal<Out, Bit>,
    /// Events that have not been cleared, 4 bits per channel; set by an event, cleared by the host.
    status: Reg<Bits<32>>,
    /// Events that interrupt; written by the host.
    mask: Reg<Bits<32>>,
    /// High while an enabled event is set.
    wants: Reg<Bit>,
    /// Byte for the host; 0 for words of other blocks.
    byte_read: Reg<Bits<8>>,
    /// `result` of the cycle before, per channel.
    had_result: Vec<Reg<Bit>>,
    /// `error` of the cycle before, per channel.
    had_error: Vec<Reg<Bit>>,
    /// `alarm` of the cycle before, per channel.
    had_alarm: Vec<Reg<Bit>>,
    /// Events of this cycle, from the last channel down: 4 bits each (result, error, alarm, request), the lowest channel's lowest.
    events: Vec<Signal<Local, Bits<32>>>,
    /// Bit 0 of the channel's events: a new result.
    result_event: Vec<Signal<Local, Bits<32>>>,
    /// Bit 1: a result that is an error, or became one.
    error_event: Vec<Signal<Local, Bits<32>>>,
    /// Bit 2: the alarm was set.
    alarm_event: Vec<Signal<Local, Bits<32>>>,
    /// Bit 3: the frame of a request has ended.
    request_event: Vec<Signal<Local, Bits<32>>>,
    /// High if the address is one of these words.
    selected: Signal<Local, Bit>,
    /// Word that the address selects.
    word: Signal<Local, Bits<32>>,
    /// Address of the first word, divided by 4.
    words: Constant<Bits<9>>,
    _channels: usize,
    _links: usize,
}

impl Interrupt {
    /// The interrupt of a card with `channels` channels.
    pub fn new(channels: usize) -> Self {
        Self::from_parts(InterruptParts {
            result: each(channels),
            error: each(channels),
            alarm: each(channels),
            request: each(channels),
            had_result: each(channels),
            had_error: each(channels),
            had_alarm: each(channels),
            events: each(channels + 1),
            result_event: each(channels),
            error_event: each(channels),
            alarm_event: each(channels),
            request_event: each(channels),
            words: Constant::new(u64::from(INTERRUPT.base >> 2).into()),
            _channels: channels,
            _links: channels + 1,
        })
    }
}

#[kernel]
impl Logic for Interrupt {
    fn update(&mut self) {
        for i in 0..self._channels {
            connect!(self.had_result[i] <= self; clock, reset);
            self.had_result[i].d.next = self.result[i].val();
            connect!(self.had_error[i] <= self; clock, reset);
            self.had_error[i].d.next = self.error[i].val();
            connect!(self.had_alarm[i] <= self; clock, reset);
            self.had_alarm[i].d.next = self.alarm[i].val();
            self.result_event[i].next = 0.into();
            if self.result[i].val() {
                self.result_event[i].next = 1.into();
            }
            // Each bad result, and a cause that is reported after its result.
            self.error_event[i].next = 0.into();
            if self.error[i].val() & (self.had_result[i].q.val() | !self.had_error[i].q.val()) {
                self.error_event[i].next = 2.into();
            }
            self.alarm_event[i].next = 0.into();
            if self.alarm[i].val() & !self.had_alarm[i].q.val() {
                self.alarm_event[i].next = 4.into();
            }
            self.request_event[i].next = 0.into();
            if self.request[i].val() {
                self.request_event[i].next = 8.into();
            }
            self.events[i].next = (self.events[i + 1].val() << 4)
                | self.result_event[i].val()
                | self.error_event[i].val()
                | self.alarm_event[i].val()
                | self.request_event[i].val();
        }
        for i in self._channels..self._links {
            self.events[i].next = 0.into();
        }

        // Status, mask, clear.
        self.selected.next =
            self.in_range.val() & (self.word_address.val().get_bits::<9>(2) == self.words.val());
        self.status.d.next = self.status.q.val() | self.events[0].val();
        if self.selected.val() & self.write.val() {
            match self.word_address.val().get_bits::<2>(0).index() {
                1 => {
                    self.mask.d.next = self.write_data.val();
                }
                2 => {
                    self.status.d.next =
                        (self.status.q.val() & !self.write_data.val()) | self.events[0].val();
                }
                _ => {}
            }
        }
        self.wants.d.next = (self.status.q.val() & self.mask.q.val()).any();
        self.irq.next = self.wants.q.val();

        self.word.next = 0.into();
        match self.word_address.val().get_bits::<2>(0).index() {
            0 => {
                self.word.next = self.status.q.val();
            }
            1 => {
                self.word.next = self.mask.q.val();
            }
            _ => {}
        }
        // A reset by deselection takes no logic.
        self.byte_read.reset.next = !self.selected.val();
        match self.lane.val().index() {
            0 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(24);
            }
            1 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(16);
            }
            2 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(8);
            }
            _ => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(0);
            }
        }
        self.read_byte.next = self.byte_read.q.val();
    }
}
