//! Stream: the results of each trigger as one set in a buffer, for a host that needs all of them.
//!
//! ```text
//! trigger, time stamp, count --> set under way --(all channels have their result, or the next trigger)--> closed set
//!                                                                                                            |
//! SetChannel 0, 1, ... (owes, replaced; byte of the closed set) ------------------------------- byte --> FrameBuffer
//!                                                                                                            |
//! host's registers: control, state, data, clear <---- bytes ------------------------------------------------+----> push
//! ```
//!
//! `docs/stream.md` has the format of a set and of a frame. A closed set is latched in one cycle, then written
//! to the buffer. If the next one is closed before that has ended, or does not fit into the buffer, it is dropped and counted.

use crate::card::ports::PushOut;
use crate::replicate::each;
use buffer::{FrameBuffer, SetParts};
use endat_macros::kernel;
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;

pub mod buffer;
pub mod channel;
pub mod run;

/// Collector, buffer and their registers.
#[derive(LogicBlock, Block)]
#[properties("../properties/stream.sv")]
pub struct Stream {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Strobe to all channels.
    pub trigger: Signal<In, Bit>,
    /// Triggers since reset; counts a cycle after `trigger`.
    pub trigger_count: Signal<In, Bits<32>>,
    /// Free-running time in system clock cycles.
    pub timestamp: Signal<In, Bits<32>>,
    /// A channel that took the trigger has no result yet.
    pub owes: Signal<In, Bit>,
    /// A later result has replaced a channel's result.
    pub replaced: Signal<In, Bit>,
    /// Strobe: the channels latch their part of the set.
    pub take_set: Signal<Out, Bit>,
    /// Requested 8 bytes of the set: 0 = head, n + 1 = channel n.
    pub block: Signal<Out, Bits<4>>,
    /// Requested byte of these.
    pub byte_at: Signal<Out, Bits<3>>,
    /// The other 8 bytes of channel n: the additional data, if sets have them.
    pub second: Vec<Signal<Out, Bit>>,
    /// Sets are collected. The next eight ports belong to the sets of a running clock.
    pub collects: Vec<Signal<Out, Bit>>,
    /// Channel whose running clock is polled.
    pub run_turn: Vec<Signal<Out, Bits<3>>>,
    /// A position of its running clock is waiting.
    pub run_ready: Vec<Signal<In, Bit>>,
    /// Number of that result.
    pub run_sequence: Vec<Signal<In, Bits<16>>>,
    /// Time of the trigger, in system clock cycles.
    pub run_timestamp: Vec<Signal<In, Bits<32>>>,
    /// First byte of that set.
    pub run_head: Vec<Signal<In, Bits<8>>>,
    /// Place of its channel in a set.
    pub run_place: Vec<Signal<In, Bits<7>>>,
    /// Strobe: the position is taken.
    pub run_take: Vec<Signal<Out, Bit>>,
    /// A position of a running clock was lost.
    pub run_lost: Vec<Signal<In, Bit>>,
    /// Strobe: a lost position has been counted.
    pub run_counted: Vec<Signal<Out, Bit>>,
    /// Requested byte from the channels.
    pub channel_byte: Signal<In, Bits<8>>,
    /// The accessed word belongs to the stream.
    pub selected: Signal<In, Bit>,
    /// Word of the stream: control, state, data, clear.
    pub word: Signal<In, Bits<2>>,
    /// Byte of the word, 0 = most significant.
    pub lane: Signal<In, Bits<2>>,
    /// One-cycle strobe: begin an access.
    pub access: Signal<In, Bit>,
    /// With `access`: write a word; low = read a byte.
    pub write: Signal<In, Bit>,
    /// Low bits of the word to write.
    pub write_data: Signal<In, Bits<2>>,
    /// Byte read, from the cycle after `access` on; 0 for words of other blocks.
    pub read_byte: Signal<Out, Bits<8>>,
    /// Unrequested frames of the stream; all low without a stream.
    #[bundle]
    pub pushed: PushOut,
    buffer: FrameBuffer,
    /// High while sets are collected; written by the host.
    #[given]
    collect: Reg<Bit>,
    /// High while frames are pushed through the front; written by the host.
    #[given]
    push_on: Reg<Bit>,
    /// High from a trigger until its set is closed or counted as lost.
    open: Reg<Bit>,
    /// High in the first cycle after a trigger, before the trigger count is up to date.
    first: Reg<Bit>,
    /// High if a result of the open set has been replaced by another; cleared by a trigger.
    spoilt: Reg<Bit>,
    /// Number of the trigger of the open set.
    sequence: Reg<Bits<16>>,
    /// Time of the trigger of the open set.
    trigger_time: Reg<Bits<32>>,
    /// Number in the head of the set that is being written.
    sequence_taken: Reg<Bits<16>>,
    /// Time in the head of the set that is being written.
    time_taken: Reg<Bits<32>>,
    /// Count of lost sets in the head of the set that is being written.
    lost_taken: Reg<Bits<8>>,
    /// Sets lost since the last one that was written, up to 255.
    lost_before: Reg<Bits<8>>,
    /// Sets lost since the host cleared the count, up to 65535.
    lost_all: Reg<Bits<16>>,
    /// Requested byte of the head; 0 for other blocks.
    head_byte: Reg<Bits<8>>,
    /// Low three bytes of the state word, latched by the read of its first byte.
    state_held: Reg<Bits<24>>,
    /// Byte for the host; 0 for words of other blocks.
    byte_read: Reg<Bits<8>>,
    /// High from a clear by the host until the buffer is empty: its bytes are discarded.
    flush: Reg<Bit>,
    /// High if the last byte that was taken was not the end of a frame.
    mid_frame: Reg<Bit>,
    /// High from the first pushed byte of a frame to its last one.
    pushing: Reg<Bit>,
    /// Channel whose position of a running clock is next.
    turn: Vec<Reg<Bits<3>>>,
    /// High if the set that is being written is a position of a running clock.
    is_run: Vec<Reg<Bit>>,
    /// First byte of that set.
    head_taken: Vec<Reg<Bits<8>>>,
    /// Place of its channel in a set.
    place_taken: Vec<Reg<Bits<7>>>,
    /// High for one cycle when a position of a running clock is taken.
    run_now: Vec<Signal<Local, Bit>>,
    /// High for one cycle when a lost position of a running clock is counted.
    run_counts: Vec<Signal<Local, Bit>>,
    /// High when the open set is complete, or ended by the next trigger.
    wanted: Signal<Local, Bit>,
    /// High if the open set can be written: it fits into the buffer, and no result was replaced.
    good: Signal<Local, Bit>,
    /// High for one cycle when a set is closed and latched for writing.
    take_now: Signal<Local, Bit>,
    /// High for one cycle when a set is lost.
    lost_now: Signal<Local, Bit>,
    /// High for one cycle when the host reads a byte of the stream's words.
    reads: Signal<Local, Bit>,
    /// High for one cycle when the host writes one of the stream's words.
    writes: Signal<Local, Bit>,
    /// High if the host can take the next byte from the data word.
    bus_may: Signal<Local, Bit>,
    /// High for one cycle when the host takes a byte from the data word.
    bus_take: Signal<Local, Bit>,
    /// High if the next byte is discarded: after a clear, or in the rest of a frame that was partly read.
    skip: Signal<Local, Bit>,
    /// High for one cycle when a byte leaves the buffer.
    take: Signal<Local, Bit>,
    /// High if the next byte is not the end of a frame.
    more: Signal<Local, Bit>,
    /// High for one cycle when the host clears the stream.
    clear: Signal<Local, Bit>,
    /// First byte of a set of a trigger: its type and the number of channels.
    head: Constant<Bits<8>>,
    _seconds: usize,
    _runs: usize,
}

/// Type of a set of positions, in the upper half of its first byte.
pub const SET_TYPE: u64 = 1;
/// Type of a set with additional data.
pub const INFO_SET_TYPE: u64 = 2;
/// Type of a set with a position of a running clock.
pub const RUN_SET_TYPE: u64 = 3;

impl Stream {
    /// A stream with a buffer of `bytes` bytes (one of [`buffer::BUFFER_BYTES`]) for `channels` channels, with `collect` and `push`
    /// after reset; `parts` selects the content of sets.
    pub fn new(bytes: u64, channels: usize, collect: bool, push: bool, parts: SetParts) -> Self {
        let (seconds, runs) = (usize::from(parts.additional_data), usize::from(parts.runs));
        let set_type = if parts.additional_data {
            INFO_SET_TYPE
        } else {
            SET_TYPE
        };
        Self::from_parts(StreamParts {
            collect: Reg::new(collect),
            push_on: Reg::new(push),
            second: each(seconds),
            collects: each(runs),
            run_turn: each(runs),
            run_ready: each(runs),
            run_sequence: each(runs),
            run_timestamp: each(runs),
            run_head: each(runs),
            run_place: each(runs),
            run_take: each(runs),
            run_lost: each(runs),
            run_counted: each(runs),
            buffer: FrameBuffer::new(bytes, channels, parts),
            turn: each(runs),
            is_run: each(runs),
            head_taken: each(runs),
            place_taken: each(runs),
            run_now: each(runs),
            run_counts: each(runs),
            head: Constant::new((set_type << 4 | channels as u64).into()),
            _seconds: seconds,
            _runs: runs,
        })
    }
}

// rust-hdl's macro drops match guards.
#[allow(clippy::collapsible_match)]
#[kernel]
impl Logic for Stream {
    fn update(&mut self) {
        clock!(self, clock, buffer);
        self.buffer.reset.next = self.reset.val();
        self.spoilt.reset.next = self.trigger.val();
        self.close_set();
        self.take_run();
        self.put_bytes();
        self.answer_host();
        self.push();
    }

    /// Closes the set under way. The number of its trigger is valid a cycle after the trigger.
    fn close_set(&mut self) {
        self.first.d.next = self.trigger.val();
        if self.trigger.val() {
            self.trigger_time.d.next = self.timestamp.val();
        }
        if self.first.q.val() {
            self.sequence.d.next = self.trigger_count.val().get_bits::<16>(0);
        }
        if self.replaced.val() {
            self.spoilt.d.next = true;
        }
        self.wanted.next =
            self.open.q.val() & !self.first.q.val() & (!self.owes.val() | self.trigger.val());
        self.good.next = self.buffer.room.val() & !self.spoilt.q.val() & !self.replaced.val();
        self.take_now.next = self.wanted.val() & self.buffer.idle.val() & self.good.val();
        self.lost_now.next = (self.wanted.val() & self.buffer.idle.val() & !self.good.val())
            | (self.open.q.val()
                & self.trigger.val()
                & (self.first.q.val() | !self.buffer.idle.val()));
        if self.take_now.val() | self.lost_now.val() {
            self.open.d.next = false;
        }
        if self.trigger.val() & self.collect.q.val() {
            self.open.d.next = true;
        }
        self.take_set.next = self.take_now.val();
        self.buffer.start.next = self.take_now.val();
        if self.take_now.val() {
            self.sequence_taken.d.next = self.sequence.q.val();
            self.time_taken.d.next = self.trigger_time.q.val();
            self.lost_taken.d.next = self.lost_before.q.val();
        }
        self.lost_before.reset.next = self.reset.val() | self.clear.val() | self.take_now.val();
        self.lost_all.reset.next = self.reset.val() | self.clear.val();
        if self.lost_now.val() & !self.lost_before.q.val().all() {
            self.lost_before.d.next = self.lost_before.q.val() + 1;
        }
        if self.lost_now.val() & !self.lost_all.q.val().all() {
            self.lost_all.d.next = self.lost_all.q.val() + 1;
        }
    }

    /// Stores a position of a running clock when no set of a trigger needs the buffer, one channel after the other.
    fn take_run(&mut self) {
        for i in 0..self._runs {
            connect!(self.turn[i] <= self; clock, reset);
            connect!(self.is_run[i] <= self; clock, reset);
            connect!(self.head_taken[i] <= self; clock, reset);
            connect!(self.place_taken[i] <= self; clock, reset);
            self.run_now[i].next = self.run_ready[i].val()
                & self.buffer.idle.val()
                & self.buffer.single_room[i].val()
                & !self.wanted.val()
                & !self.trigger.val()
                & !self.run_lost[i].val();
            self.turn[i].d.next = self.turn[i].q.val();
            self.is_run[i].d.next = self.is_run[i].q.val();
            self.head_taken[i].d.next = self.head_taken[i].q.val();
            self.place_taken[i].d.next = self.place_taken[i].q.val();
            // A waiting channel keeps its turn until it is served; otherwise the channel after unused turns would get most of the buffer.
            if self.run_now[i].val() | !self.run_ready[i].val() {
                self.turn[i].d.next = self.turn[i].q.val() + 1;
            }
            if self.take_now.val() {
                self.is_run[i].d.next = false;
            }
            self.lost_before.reset.next =
                self.reset.val() | self.clear.val() | self.take_now.val() | self.run_now[i].val();
            if self.run_now[i].val() {
                self.is_run[i].d.next = true;
                self.head_taken[i].d.next = self.run_head[i].val();
                self.place_taken[i].d.next = self.run_place[i].val();
                self.sequence_taken.d.next = self.run_sequence[i].val();
                self.time_taken.d.next = self.run_timestamp[i].val();
                self.lost_taken.d.next = self.lost_before.q.val();
            }
            // One is counted in each cycle.
            self.run_counts[i].next =
                self.run_lost[i].val() & !self.lost_now.val() & !self.take_now.val();
            if self.run_counts[i].val() & !self.lost_before.q.val().all() {
                self.lost_before.d.next = self.lost_before.q.val() + 1;
            }
            if self.run_counts[i].val() & !self.lost_all.q.val().all() {
                self.lost_all.d.next = self.lost_all.q.val() + 1;
            }
            self.buffer.start.next = self.take_now.val() | self.run_now[i].val();
            self.buffer.single[i].next = self.is_run[i].q.val();
            self.buffer.single_place[i].next = self.place_taken[i].q.val();
            self.collects[i].next = self.collect.q.val();
            self.run_turn[i].next = self.turn[i].q.val();
            self.run_take[i].next = self.run_now[i].val();
            self.run_counted[i].next = self.run_counts[i].val();
        }
        for i in 0..self._seconds {
            self.second[i].next = self.buffer.second[i].val();
        }
    }

    /// Bytes of a set.
    fn put_bytes(&mut self) {
        // Its bytes.
        connect!(self <= self.buffer; block, byte_at);
        self.head_byte.reset.next = self.buffer.block.val().any();
        match self.buffer.byte_at.val().index() {
            0 => {
                self.head_byte.d.next = self.head.val();
            }
            1 => {
                self.head_byte.d.next = self.lost_taken.q.val();
            }
            2 => {
                self.head_byte.d.next = self.sequence_taken.q.val().get_bits::<8>(0);
            }
            3 => {
                self.head_byte.d.next = self.sequence_taken.q.val().get_bits::<8>(8);
            }
            4 => {
                self.head_byte.d.next = self.time_taken.q.val().get_bits::<8>(0);
            }
            5 => {
                self.head_byte.d.next = self.time_taken.q.val().get_bits::<8>(8);
            }
            6 => {
                self.head_byte.d.next = self.time_taken.q.val().get_bits::<8>(16);
            }
            _ => {
                self.head_byte.d.next = self.time_taken.q.val().get_bits::<8>(24);
            }
        }
        for i in 0..self._runs {
            if self.is_run[i].q.val() & !self.buffer.byte_at.val().any() {
                self.head_byte.d.next = self.head_taken[i].q.val();
            }
        }
        self.buffer.set_byte.next = self.head_byte.q.val() | self.channel_byte.val();
    }

    /// The host's words.
    fn answer_host(&mut self) {
        self.reads.next = self.access.val() & self.selected.val() & !self.write.val();
        self.writes.next = self.access.val() & self.selected.val() & self.write.val();
        self.clear.next =
            self.writes.val() & (self.word.val() == 3) & self.write_data.val().get_bit(0);
        if self.writes.val() & !self.word.val().any() {
            self.collect.d.next = field!(self.write_data.val(), card.stream_control.collect);
            self.push_on.d.next = field!(self.write_data.val(), card.stream_control.push);
        }
        self.bus_may.next = self.buffer.ready.val()
            & !self.push_on.q.val()
            & !self.pushing.q.val()
            & !self.flush.q.val();
        self.bus_take.next = self.reads.val() & (self.word.val() == 2) & self.bus_may.val();
        // The read of the first byte latches the other three.
        if self.reads.val() & !self.lane.val().any() {
            self.state_held.d.next = bit_cast::<24, 16>(self.buffer.waiting_bytes.val())
                | (bit_cast::<24, 8>(self.lost_all.q.val().get_bits::<8>(0)) << 16);
        }
        self.byte_read.reset.next = self.access.val() & !self.reads.val();
        if self.reads.val() {
            self.byte_read.d.next = 0.into();
            match self.word.val().index() {
                0 => {
                    if self.lane.val().all() {
                        self.byte_read.d.next = bit_cast::<8, 1>(self.collect.q.val().into())
                            | (bit_cast::<8, 1>(self.push_on.q.val().into()) << 1);
                    }
                }
                1 => match self.lane.val().index() {
                    0 => {
                        self.byte_read.d.next = self.lost_all.q.val().get_bits::<8>(8);
                    }
                    1 => {
                        self.byte_read.d.next = self.state_held.q.val().get_bits::<8>(16);
                    }
                    2 => {
                        self.byte_read.d.next = self.state_held.q.val().get_bits::<8>(8);
                    }
                    _ => {
                        self.byte_read.d.next = self.state_held.q.val().get_bits::<8>(0);
                    }
                },
                2 => {
                    if self.bus_may.val() {
                        self.byte_read.d.next = self.buffer.data.val();
                    }
                }
                _ => {}
            }
        }
        self.read_byte.next = self.byte_read.q.val();
    }

    /// The read side. A frame leaves entirely through one path, register or push.
    fn push(&mut self) {
        self.pushed.push.next = self.push_on.q.val();
        self.pushed.in_frame.next = self.pushing.q.val();
        self.pushed.push_byte.next = self.buffer.data.val();
        self.pushed.push_valid.next = self.buffer.ready.val()
            & (self.pushing.q.val()
                | (self.push_on.q.val() & !self.mid_frame.q.val() & !self.flush.q.val()));
        // Discards the bytes cleared by the host, or the rest of a frame that it read partly.
        self.skip.next = self.buffer.ready.val()
            & !self.pushing.q.val()
            & (self.flush.q.val() | (self.push_on.q.val() & self.mid_frame.q.val()));
        self.take.next = self.bus_take.val() | self.pushed.push_take.val() | self.skip.val();
        self.buffer.take.next = self.take.val();
        self.more.next = self.buffer.data.val().any();
        if self.take.val() {
            self.mid_frame.d.next = self.more.val();
        }
        if self.pushed.push_take.val() {
            self.pushing.d.next = self.more.val();
        }
        // After an upset: no byte of the frame is left, and answers would wait for its end for ever.
        if self.pushing.q.val() & !self.buffer.waiting_bytes.val().any() {
            self.pushing.d.next = false;
        }
        if !self.pushing.q.val() & !self.buffer.waiting_bytes.val().any() {
            self.flush.d.next = false;
        }
        if self.clear.val() {
            self.flush.d.next = true;
        }
    }
}
