//! Parallel front: an asynchronous 16-bit bus with eight registers, for a signal processor.
//!
//! ```text
//! cs_n, rd_n, wr_n, register --> synchronisers --> 0 .. 2  position     \
//!                                                  3, 4    status        >- read continuously by WordAccess <-> bank
//! data <-- output register <---------------------- 5 .. 7  window       //
//! ```
//!
//! | register | read | write |
//! |---|---|---|
//! | 0, 1, 2 | position, bits 15..0, 31..16, 47..32; reading register 0 latches 0 to 4 | |
//! | 3, 4 | word `status` of the result, bits 31..16 and 15..0 | |
//! | 5 | bit 15 busy, 13:11 channel, 10:0 word address | 13:11 channel of 0 to 4, 10:0 word address; begins to read that word unless bit 14 is set |
//! | 6, 7 | the word, bits 15..0, 31..16 | bits 15..0, 31..16; writing 7 writes the word |
//!
//! The data of a register reach the pins 4 clocks after the register is selected. While bit 15 of register 5 is set, writes
//! are ignored. The direct registers follow a result after at most 130 clocks.

use super::strobes::BusStrobes;
use super::word_access::WordAccess;
use crate::card::ports::AccessOut;
use crate::card::{top::card_top, CardCore};
use crate::config::CardConfig;
use crate::replicate::each;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Eight registers of 16 bits in front of the register bank.
#[derive(LogicBlock, Block)]
pub struct ParallelFront {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Chip select, active low, asynchronous.
    pub cs_n: Signal<In, Bit>,
    /// Read strobe, active low, asynchronous.
    pub rd_n: Signal<In, Bit>,
    /// Write strobe, active low, asynchronous; its rising edge writes.
    pub wr_n: Signal<In, Bit>,
    /// Register that is read or written, asynchronous.
    pub register_at: Signal<In, Bits<3>>,
    /// Data from the processor, asynchronous.
    pub data_in: Signal<In, Bits<16>>,
    /// Data to the processor, valid 4 clocks after the register is selected.
    pub data_out: Signal<Out, Bits<16>>,
    /// The card drives the data lines; combinational from the strobes.
    pub data_enable: Signal<Out, Bit>,
    /// Strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// A front's access to the register bank.
    #[bundle]
    pub bank: AccessOut,
    /// Accesses of the register bank.
    #[start]
    words: WordAccess,
    /// Strobes of the bus, in the system clock domain.
    #[start]
    strobes: BusStrobes,
    /// Data at the pins; held while the same register is read.
    out_data: Reg<Bits<16>>,
    /// `is_first` of the cycle before.
    was_first: Reg<Bit>,
    /// Status word of the result that is being read.
    next_status: Reg<Bits<32>>,
    /// Low position word of the result that is being read.
    next_low: Reg<Bits<32>>,
    /// Status word of the last complete result.
    live_status: Reg<Bits<32>>,
    /// Position of the last complete result.
    live_position: Reg<Bits<48>>,
    /// Status word that registers 3 and 4 show; latched by a read of register 0.
    seen_status: Reg<Bits<32>>,
    /// Position that registers 0 to 2 show; latched by a read of register 0.
    seen_position: Reg<Bits<48>>,
    /// Word address of the window, registers 6 and 7.
    window_address: Reg<Bits<11>>,
    /// Channel of registers 0 to 4.
    channel: Reg<Bits<3>>,
    /// Low half of the window's word.
    window_low: Reg<Bits<16>>,
    /// High half of the window's word.
    window_high: Reg<Bits<16>>,
    /// High from a write of register 5 until the word of the window has been read.
    wants_read: Reg<Bit>,
    /// High from a write of register 7 until the word of the window has been written.
    wants_write: Reg<Bit>,
    /// High from a change of the channel until its result has been read.
    settling: Reg<Bit>,
    /// High while a word access runs.
    busy: Reg<Bit>,
    /// High for one cycle when a word access begins.
    request: Reg<Bit>,
    /// Word address of the access.
    address: Reg<Bits<11>>,
    /// High if the access is a write.
    writing: Reg<Bit>,
    /// High if the access belongs to the window.
    is_window: Reg<Bit>,
    /// Word of the result that is read next, 0 to 2.
    step: Reg<Bits<2>>,
    /// Channel whose result is being read.
    polled: Reg<Bits<3>>,
    /// High if a register was being read in the cycle before.
    was_read: Reg<Bit>,
    /// Register that was selected in the cycle before.
    last_register: Reg<Bits<3>>,
    /// High if the same register has been read for two cycles.
    is_steady: Reg<Bit>,
    /// High while the register of the previous cycle is still read.
    is_same: Signal<Local, Bit>,
    /// High while register 0 is read.
    is_first: Signal<Local, Bit>,
    /// High while an access of the window or a change of the channel is not finished.
    is_busy: Signal<Local, Bit>,
}

#[kernel]
impl Logic for ParallelFront {
    fn update(&mut self) {
        connect!(self.words <= self;
            clock, reset, tick_us
        );
        self.words.keep_snapshot.next = false;
        self.words.end_snapshot.next = false;
        AccessOut::link(&mut self.bank, &mut self.words.bank);

        connect!(self.strobes <= self; clock, reset, cs_n, rd_n, wr_n, register_at, data_in);

        // Reading register 0 latches what registers 0 to 4 show.
        self.is_first.next = self.strobes.reading.val() & !self.strobes.register.val().any();
        self.was_first.d.next = self.is_first.val();
        if self.is_first.val() & !self.was_first.q.val() {
            self.seen_status.d.next = self.live_status.q.val();
            self.seen_position.d.next = self.live_position.q.val();
        }
        self.is_busy.next =
            self.wants_read.q.val() | self.wants_write.q.val() | self.settling.q.val();
        // The data are held until another register is read, or the strobe ends. Register 0 latches in the first cycle, so the second one still
        // counts.
        self.was_read.d.next = self.strobes.reading.val();
        self.last_register.d.next = self.strobes.register.val();
        self.is_same.next = self.strobes.reading.val()
            & self.was_read.q.val()
            & (self.strobes.register.val() == self.last_register.q.val());
        self.is_steady.d.next = self.is_same.val();
        match self.strobes.register.val().index() {
            0 => {
                self.out_data.d.next = self.seen_position.q.val().get_bits::<16>(0);
            }
            1 => {
                self.out_data.d.next = self.seen_position.q.val().get_bits::<16>(16);
            }
            2 => {
                self.out_data.d.next = self.seen_position.q.val().get_bits::<16>(32);
            }
            3 => {
                self.out_data.d.next = self.seen_status.q.val().get_bits::<16>(16);
            }
            4 => {
                self.out_data.d.next = self.seen_status.q.val().get_bits::<16>(0);
            }
            5 => {
                self.out_data.d.next = bit_cast::<16, 11>(self.window_address.q.val())
                    | (bit_cast::<16, 3>(self.channel.q.val()) << 11)
                    | (bit_cast::<16, 1>(self.is_busy.val().into()) << 15);
            }
            6 => {
                self.out_data.d.next = self.window_low.q.val();
            }
            _ => {
                self.out_data.d.next = self.window_high.q.val();
            }
        }
        if self.is_same.val() & self.is_steady.q.val() {
            self.out_data.d.next = self.out_data.q.val();
        }
        self.data_out.next = self.out_data.q.val();
        // Combinational: the lines are free as soon as the strobe ends.
        self.data_enable.next = !self.cs_n.val() & !self.rd_n.val();

        if self.strobes.written.val() & !self.wants_read.q.val() & !self.wants_write.q.val() {
            match self.strobes.written_register.val().index() {
                5 => {
                    self.window_address.d.next = self.strobes.written_data.val().get_bits::<11>(0);
                    self.channel.d.next = self.strobes.written_data.val().get_bits::<3>(11);
                    self.settling.d.next =
                        self.strobes.written_data.val().get_bits::<3>(11) != self.channel.q.val();
                    self.wants_read.d.next = !self.strobes.written_data.val().get_bit(14);
                }
                6 => {
                    self.window_low.d.next = self.strobes.written_data.val();
                }
                7 => {
                    self.window_high.d.next = self.strobes.written_data.val();
                    self.wants_write.d.next = true;
                }
                _ => {}
            }
        }

        // The result of the channel is read continuously: three words at rising addresses, so from one snapshot. The window is accessed between two rounds.
        self.request.d.next = false;
        if !self.busy.q.val() {
            self.busy.d.next = true;
            self.request.d.next = true;
            self.writing.d.next = false;
            self.is_window.d.next = false;
            self.address.d.next = bit_cast::<11, 2>(self.step.q.val())
                | (bit_cast::<11, 3>(self.polled.q.val()) << 3)
                | 0x180;
            if !self.step.q.val().any() {
                self.polled.d.next = self.channel.q.val();
                self.address.d.next = (bit_cast::<11, 3>(self.channel.q.val()) << 3) | 0x180;
                if self.wants_read.q.val() | self.wants_write.q.val() {
                    self.is_window.d.next = true;
                    self.writing.d.next = self.wants_write.q.val();
                    self.address.d.next = self.window_address.q.val();
                }
            }
        }
        if self.words.finished.val() {
            self.busy.d.next = false;
            if self.is_window.q.val() {
                self.wants_read.d.next = false;
                self.wants_write.d.next = false;
                if !self.writing.q.val() {
                    self.window_low.d.next = self.words.read_data.val().get_bits::<16>(0);
                    self.window_high.d.next = self.words.read_data.val().get_bits::<16>(16);
                }
            } else {
                self.step.d.next = self.step.q.val() + 1;
                match self.step.q.val().index() {
                    0 => {
                        self.next_status.d.next = self.words.read_data.val();
                    }
                    1 => {
                        self.next_low.d.next = self.words.read_data.val();
                    }
                    _ => {
                        self.step.d.next = 0.into();
                        self.live_status.d.next = self.next_status.q.val();
                        self.live_position.d.next = bit_cast::<48, 32>(self.next_low.q.val())
                            | (bit_cast::<48, 16>(self.words.read_data.val().get_bits::<16>(0))
                                << 32);
                        if self.polled.q.val() == self.channel.q.val() {
                            self.settling.d.next = false;
                        }
                    }
                }
            }
        }

        self.words.request.next = self.request.q.val();
        self.words.address_in.next = self.address.q.val();
        self.words.write_in.next = self.writing.q.val();
        self.words.data_in.next = bit_cast::<32, 16>(self.window_low.q.val())
            | (bit_cast::<32, 16>(self.window_high.q.val()) << 16);
    }
}

card_top! {
    /// The whole core with a parallel bus; [`CardConfig::channels`] sets the number of channels.
    ParallelCard, ParallelCardParts: ParallelFront
    in {
        /// Chip select, active low, asynchronous.
        bus_cs_n_i: Bit => cs_n,
        /// Read strobe, active low, asynchronous.
        bus_rd_n_i: Bit => rd_n,
        /// Write strobe, active low, asynchronous; its rising edge writes.
        bus_wr_n_i: Bit => wr_n,
        /// Register that is read or written, asynchronous.
        bus_address_i: Bits<3> => register_at,
        /// Data from the processor, asynchronous.
        bus_data_i: Bits<16> => data_in,
    }
    out {
        /// Data to the processor, valid 4 clocks after the register is selected.
        bus_data_o: Bits<16> => data_out,
        /// The card drives the data lines; combinational from the strobes.
        bus_data_oe: Bit => data_enable,
    }
}
