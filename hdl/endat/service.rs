//! Service: requests, additional data, health and initialisation of one or two channels, as a program of the [`Sequencer`].
//!
//! ```text
//!               +--> requests, hold-off ------> Channel
//! ServiceChannel+<-- ends of frames, infos ----    |
//!      |        +--> width, command, clock -----> (+) <-- configuration
//!   Service --- Sequencer, RAM
//!      |
//!     host: mailbox, name plate, slots, counters
//! ```
//!
//! Positions do not wait for the service: a trigger goes to the channel directly, together with a request that the program has prepared.
//! [`map`] defines the ports, [`program`] the steps, [`channel`] the part for each channel.
//!
//! Two channels share a machine: each has a separate run of the program, with separate RAM and ports. An instruction then takes four cycles instead of three.
//!
//! A program that stops writing its alive port has gone astray after an upset: all runs restart.

pub mod channel;
pub mod map;
pub mod program;

use crate::endat::sequencer::Sequencer;
use crate::replicate::each;
use map::output;
use program::ServiceTimes;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Largest number of channels of a service.
pub const CHANNELS_SERVED: usize = 2;

/// Service of one or two channels.
#[derive(LogicBlock, Block)]
pub struct Service {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Port that the program reads or writes, for all channels.
    pub io_address: Signal<Out, Bits<5>>,
    /// Strobe of each channel: the program reads its port.
    pub io_read: Vec<Signal<Out, Bit>>,
    /// In the next cycle the value of each channel's port; otherwise 0.
    pub io_in: Vec<Signal<In, Bits<16>>>,
    /// Value to write.
    pub io_out: Signal<Out, Bits<16>>,
    /// Strobe of each channel: the program writes its port.
    pub io_write: Vec<Signal<Out, Bit>>,
    /// Word of RAM that the host accesses; stable from one strobe to the next, at least 8 cycles.
    pub host_address: Signal<In, Bits<7>>,
    /// The word belongs to the second channel.
    pub host_second: Signal<In, Bit>,
    /// Strobe: the host reads the word.
    pub host_read: Signal<In, Bit>,
    /// Strobe: the host begins to read, from this or any other block.
    pub host_clear: Signal<In, Bit>,
    /// The word read, from the third cycle after its strobe; 0 if the host has read from another block since.
    pub host_word: Signal<Out, Bits<32>>,
    /// Strobe: the host writes one half of the word.
    pub host_write: Signal<In, Bit>,
    /// Half to write: 1 = high. If written last, the low half acts.
    pub host_half: Signal<In, Bit>,
    /// Data to write.
    pub host_data: Signal<In, Bits<16>>,
    sequencer: Sequencer,
    /// Microseconds, modulo 65536.
    time_us: Reg<Bits<16>>,
    /// Microseconds of the present millisecond.
    us_in_ms: Reg<Bits<10>>,
    /// Milliseconds, modulo 65536.
    time_ms: Reg<Bits<16>>,
    /// `time_us` in the cycle after the program reads it, otherwise 0.
    seen_us: Reg<Bits<16>>,
    /// `time_ms` in the cycle after the program reads it, otherwise 0.
    seen_ms: Reg<Bits<16>>,
    /// Milliseconds since each run of the program last wrote its alive port.
    silent_ms: Vec<Reg<Bits<6>>>,
    /// High if the program reads a time.
    is_time: Signal<Local, Bit>,
    /// Value of the port of the second channel; otherwise 0.
    second_in: Signal<Local, Bits<16>>,
    /// High for one cycle each millisecond.
    is_millisecond: Signal<Local, Bit>,
    /// One bit for each run of the program: it writes its alive port.
    lives: Signal<Local, Bits<2>>,
    /// Number of the alive port.
    alive_port: Constant<Bits<5>>,
    /// High if a run has not written its alive port for too long: all runs restart.
    is_stuck: Signal<Local, Bit>,
    /// Milliseconds after which a run is stuck.
    stuck_ms: Constant<Bits<6>>,
    _seconds: usize,
    _runs: usize,
}

impl Service {
    /// A service that runs the program for these times, for `channels` channels: one, or [`CHANNELS_SERVED`].
    pub fn new(times: &ServiceTimes, channels: usize) -> Self {
        let is_shared = channels > 1;
        let runs = 1 + usize::from(is_shared);
        Self::from_parts(ServiceParts {
            io_read: (0..runs).map(|_| Default::default()).collect(),
            io_in: (0..runs).map(|_| Default::default()).collect(),
            io_write: (0..runs).map(|_| Default::default()).collect(),
            sequencer: Sequencer::new(&program::program(times), is_shared),
            silent_ms: each(runs),
            alive_port: Constant::new(u64::from(output::ALIVE).into()),
            stuck_ms: Constant::new(u64::from(times.stuck_ms).into()),
            _seconds: usize::from(is_shared),
            _runs: runs,
        })
    }
}

#[kernel]
impl Logic for Service {
    fn update(&mut self) {
        clock!(self, clock, sequencer);
        self.sequencer.reset.next = self.reset.val();

        self.is_millisecond.next = self.tick_us.val() & (self.us_in_ms.q.val() == 999);
        if self.tick_us.val() {
            self.time_us.d.next = self.time_us.q.val() + 1;
            self.us_in_ms.d.next = self.us_in_ms.q.val() + 1;
        }
        if self.is_millisecond.val() {
            self.us_in_ms.d.next = 0.into();
            self.time_ms.d.next = self.time_ms.q.val() + 1;
        }

        self.lives.next = 0.into();
        if self.sequencer.port_write.val()
            & (self.sequencer.port_address.val() == self.alive_port.val())
        {
            self.lives.next = 1.into();
            if self.sequencer.port_second.val() {
                self.lives.next = 2.into();
            }
        }
        self.is_stuck.next = false;
        for i in 0..self._runs {
            self.is_stuck.next =
                self.is_stuck.val() | (self.silent_ms[i].q.val() == self.stuck_ms.val());
        }
        for i in 0..self._runs {
            self.silent_ms[i].clock.next = self.clock.val();
            self.silent_ms[i].reset.next =
                self.reset.val() | self.is_stuck.val() | self.lives.val().get_bit(i);
            self.silent_ms[i].d.next = self.silent_ms[i].q.val();
            if self.is_millisecond.val() {
                self.silent_ms[i].d.next = self.silent_ms[i].q.val() + 1;
            }
        }
        self.sequencer.restart.next = self.is_stuck.val();

        // Ports 24 and above are the times, equal for all channels.
        self.is_time.next = self.sequencer.port_read.val()
            & self.sequencer.port_address.val().get_bits::<2>(3).all();
        self.seen_us.d.next = self.time_us.q.val();
        self.seen_us.reset.next =
            !(self.is_time.val() & !self.sequencer.port_address.val().get_bit(0));
        self.seen_ms.d.next = self.time_ms.q.val();
        self.seen_ms.reset.next =
            !(self.is_time.val() & self.sequencer.port_address.val().get_bit(0));
        self.sequencer.port_in.next = self.io_in[0].val()
            | self.second_in.val()
            | self.seen_us.q.val()
            | self.seen_ms.q.val();
        self.second_in.next = 0.into();
        self.io_read[0].next = self.sequencer.port_read.val() & !self.sequencer.port_second.val();
        for i in 0..self._seconds {
            self.second_in.next = self.io_in[i + 1].val();
            self.io_read[i + 1].next =
                self.sequencer.port_read.val() & self.sequencer.port_second.val();
        }
        connect!(self <= self.sequencer; io_address = port_address, io_out = port_out);
        self.io_write[0].next = self.sequencer.port_write.val() & !self.sequencer.port_second.val();
        for i in 0..self._seconds {
            self.io_write[i + 1].next =
                self.sequencer.port_write.val() & self.sequencer.port_second.val();
        }

        connect!(self.sequencer <= self;
            host_address, host_second, host_read, host_clear, host_write, host_half, host_data
        );
        self.host_word.next = self.sequencer.host_word.val();
    }
}
