//! Strobes of an asynchronous bus, synchronised to the system clock.
//!
//! ```text
//! cs_n, rd_n, wr_n, register_at --SyncReg x2--> reading, register | written, written_register
//! data_in --SyncReg, while a write lasts--> written_data
//! ```
//!
//! Data of a write need only one register. The strobe stops it after the data have been stable for a clock, so it does not matter whether a bit is
//! still sampled at that edge; the value is used two clocks later.

use rtl_design::reg::{Reg, SyncReg};
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Bus with chip select, read and write strobe, eight registers of 16 bits.
#[derive(LogicBlock, Block)]
pub struct BusStrobes {
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
    /// Selected register, two clocks late.
    pub register: Signal<Out, Bits<3>>,
    /// The selected register is being read.
    pub reading: Signal<Out, Bit>,
    /// Strobe: a write has ended.
    pub written: Signal<Out, Bit>,
    /// Register that was written.
    pub written_register: Signal<Out, Bits<3>>,
    /// Written data.
    pub written_data: Signal<Out, Bits<16>>,
    /// Parity of the data at the pins.
    pub written_sum: Signal<Out, Bit>,
    /// Chip select, active high, first synchroniser stage.
    cs_0: SyncReg<Bit>,
    /// Chip select, second synchroniser stage.
    cs_1: SyncReg<Bit>,
    /// Read strobe, active high, first synchroniser stage.
    rd_0: SyncReg<Bit>,
    /// Read strobe, second synchroniser stage.
    rd_1: SyncReg<Bit>,
    /// Write strobe, active high, first synchroniser stage.
    wr_0: SyncReg<Bit>,
    /// Write strobe, second synchroniser stage.
    wr_1: SyncReg<Bit>,
    /// Register address, first synchroniser stage.
    register_0: SyncReg<Bits<3>>,
    /// Register address, second synchroniser stage.
    register_1: SyncReg<Bits<3>>,
    /// Data at the pins at the last clock edge before the write strobe ended.
    data_0: SyncReg<Bits<16>>,
    /// Parity of those data, formed at the pins.
    sum_0: SyncReg<Bit>,
    /// `is_writing` of the cycle before.
    was_writing: Reg<Bit>,
    /// Register that was selected while the write strobe was active.
    last_register: Reg<Bits<3>>,
    /// High while a write is under way.
    is_writing: Signal<Local, Bit>,
}

#[kernel]
impl Logic for BusStrobes {
    fn update(&mut self) {
        self.cs_0.d.next = !self.cs_n.val();
        self.cs_1.d.next = self.cs_0.q.val();
        self.rd_0.d.next = !self.rd_n.val();
        self.rd_1.d.next = self.rd_0.q.val();
        self.wr_0.d.next = !self.wr_n.val();
        self.wr_1.d.next = self.wr_0.q.val();
        self.register_0.d.next = self.register_at.val();
        self.register_1.d.next = self.register_0.q.val();
        if !self.cs_n.val() & !self.wr_n.val() {
            self.data_0.d.next = self.data_in.val();
            self.sum_0.d.next = self.data_in.val().xor();
        }

        self.register.next = self.register_1.q.val();
        self.reading.next = self.cs_1.q.val() & self.rd_1.q.val();
        // The written data are those at the last clock before the strobe ended.
        self.is_writing.next = self.cs_1.q.val() & self.wr_1.q.val();
        self.was_writing.d.next = self.is_writing.val();
        if self.is_writing.val() {
            self.last_register.d.next = self.register_1.q.val();
        }
        self.written.next = self.was_writing.q.val() & !self.is_writing.val();
        self.written_register.next = self.last_register.q.val();
        self.written_data.next = self.data_0.q.val();
        self.written_sum.next = self.sum_0.q.val();
    }
}
