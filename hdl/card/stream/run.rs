//! Positions of a running clock of one channel: positions without a trigger wait for a separate set.
//!
//! ```text
//! trigger taken  _/\______________________________
//! result         ________/\______/\______/\_______    the first one is the trigger's
//! waits          _________________/~~\____/~~\____    until the stream takes it
//! ```
//!
//! The stream takes the result that the channel shows in that cycle. A newer result replaces one that still waits, which
//! is lost.

use super::RUN_SET_TYPE;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Running clock of one channel.
#[derive(LogicBlock, Block)]
pub struct RunChannel {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Sets are collected.
    pub collects: Signal<In, Bit>,
    /// Strobe: the channel takes a trigger.
    pub taken: Signal<In, Bit>,
    /// Strobe: a new result is valid.
    pub result_strobe: Signal<In, Bit>,
    /// Number of results.
    pub sequence: Signal<In, Bits<16>>,
    /// Time stamp of the position.
    pub first_fall_timestamp: Signal<In, Bits<32>>,
    /// Channel whose turn it is.
    pub turn: Signal<In, Bits<3>>,
    /// It is this channel's turn, and a position waits.
    pub ready: Signal<Out, Bit>,
    /// Number of the result while `ready`, else 0.
    pub ready_sequence: Signal<Out, Bits<16>>,
    /// Time stamp while `ready`, else 0.
    pub ready_timestamp: Signal<Out, Bits<32>>,
    /// First byte of the set while `ready`, else 0.
    pub ready_head: Signal<Out, Bits<8>>,
    /// Place of the channel in a set while `ready`, else 0.
    pub ready_place: Signal<Out, Bits<7>>,
    /// Strobe: the position of the channel with `ready` is taken.
    pub take: Signal<In, Bit>,
    /// Strobe: the position of this channel is taken.
    pub take_run: Signal<Out, Bit>,
    /// A position was lost.
    pub lost: Signal<Out, Bit>,
    /// Strobe: the lost position has been counted.
    pub counted: Signal<In, Bit>,
    /// High from a trigger that the channel takes until its result, which belongs to the trigger's set.
    asked: Reg<Bit>,
    /// High while a position of the running clock waits for its set.
    waits: Reg<Bit>,
    /// High if a position was replaced before it was taken, until the loss is counted.
    dropped: Reg<Bit>,
    /// High if a position waits, and it is this channel's turn.
    ready_now: Signal<Local, Bit>,
    /// Number of this channel.
    number: Constant<Bits<3>>,
    /// First byte of this channel's sets.
    head: Constant<Bits<8>>,
    /// Place of the channel in a set: 8 times its block.
    place: Constant<Bits<7>>,
}

impl RunChannel {
    /// The running clock of channel `channel`.
    pub fn new(channel: usize) -> Self {
        Self::from_parts(RunChannelParts {
            number: Constant::new((channel as u64).into()),
            head: Constant::new((RUN_SET_TYPE << 4 | channel as u64).into()),
            place: Constant::new((8 * (channel as u64 + 1)).into()),
        })
    }
}

#[kernel]
impl Logic for RunChannel {
    fn update(&mut self) {
        // In the cycle of a result the new one is shown.
        self.ready_now.next = self.waits.q.val()
            & !(self.result_strobe.val() & self.asked.q.val())
            & (self.turn.val() == self.number.val());
        if self.counted.val() {
            self.dropped.d.next = false;
        }
        if self.result_strobe.val() {
            self.asked.d.next = false;
            self.waits.d.next = !self.asked.q.val() & self.collects.val();
            if self.waits.q.val() {
                self.dropped.d.next = true;
            }
        }
        if self.ready_now.val() & self.take.val() {
            self.waits.d.next = false;
        }
        if self.taken.val() {
            self.asked.d.next = true;
        }

        self.ready.next = self.ready_now.val();
        self.take_run.next = self.ready_now.val() & self.take.val();
        self.ready_sequence.next = 0.into();
        self.ready_timestamp.next = 0.into();
        self.ready_head.next = 0.into();
        self.ready_place.next = 0.into();
        if self.ready_now.val() {
            self.ready_sequence.next = self.sequence.val();
            self.ready_timestamp.next = self.first_fall_timestamp.val();
            self.ready_head.next = self.head.val();
            self.ready_place.next = self.place.val();
        }
        self.lost.next = self.dropped.q.val();
    }
}
