//! Wishbone front: the card as a slave of a Wishbone bus, classic cycles.
//!
//! ```text
//! cyc, stb, we, adr, dat, sel --> start --> WordAccess <-> bank
//! dat, ack, err <---------------------------- finished
//! ```
//!
//! `ack` and `err` come from registers, one cycle each. A write that does not select all four bytes gets `err`; a read
//! returns the whole word for any `sel`. If `cyc` or `stb` falls before the answer there is no answer; a write that has begun is completed.
//!
//! Ref: OpenCores, Wishbone B4, chapter 3 (classic cycles), 32-bit port, granularity 8 bits.

use super::word_access::WordAccess;
use crate::card::ports::AccessOut;
use crate::card::{top::card_top, CardCore};
use crate::config::CardConfig;
use crate::replicate::each;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Wishbone slave in front of the register bank.
#[derive(LogicBlock, Block)]
pub struct WishboneFront {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// A bus cycle is under way.
    pub cyc: Signal<In, Bit>,
    /// With `cyc`: the master requests a transfer.
    pub stb: Signal<In, Bit>,
    /// Write.
    pub we: Signal<In, Bit>,
    /// Word address: a byte address divided by 4.
    pub adr: Signal<In, Bits<11>>,
    /// Word to write.
    pub dat_write: Signal<In, Bits<32>>,
    /// Byte selects; a write must select all four.
    pub sel: Signal<In, Bits<4>>,
    /// Word read, valid with `ack`.
    pub dat_read: Signal<Out, Bits<32>>,
    /// The transfer is complete.
    pub ack: Signal<Out, Bit>,
    /// The transfer is rejected: a write to part of a word.
    pub err: Signal<Out, Bit>,
    /// Strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// A front's access to the register bank.
    #[bundle]
    pub bank: AccessOut,
    /// Accesses of the register bank.
    #[start]
    words: WordAccess,
    /// High from the start of a transfer until its word access has ended.
    busy: Reg<Bit>,
    /// High for one cycle when the transfer has been carried out.
    acknowledge: Reg<Bit>,
    /// High for one cycle when the transfer is rejected.
    error: Reg<Bit>,
    /// High for one cycle when a word access begins.
    request: Reg<Bit>,
    /// High if the master has dropped the transfer before its end; cleared by the next transfer.
    abandoned: Reg<Bit>,
    /// Word address of the transfer.
    address: Reg<Bits<11>>,
    /// High if the transfer is a write.
    writing: Reg<Bit>,
    /// High while the master requests a transfer.
    asks: Signal<Local, Bit>,
    /// High for one cycle when a transfer is accepted.
    start: Signal<Local, Bit>,
    /// High if the transfer writes part of a word.
    refused: Signal<Local, Bit>,
}

#[kernel]
impl Logic for WishboneFront {
    fn update(&mut self) {
        connect!(self.words <= self;
            clock, reset, tick_us
        );
        self.words.keep_snapshot.next = false;
        self.words.end_snapshot.next = false;
        AccessOut::link(&mut self.bank, &mut self.words.bank);

        // Also later than the first cycle of a transfer, if an abandoned one delayed it.
        self.asks.next = self.cyc.val() & self.stb.val();
        self.start.next =
            self.asks.val() & !self.busy.q.val() & !self.acknowledge.q.val() & !self.error.q.val();
        self.refused.next = self.we.val() & !self.sel.val().all();
        self.acknowledge.d.next = false;
        self.error.d.next = false;
        self.request.d.next = false;
        if self.start.val() {
            self.address.d.next = self.adr.val();
            self.writing.d.next = self.we.val();
            self.abandoned.d.next = false;
            self.request.d.next = !self.refused.val();
            self.busy.d.next = !self.refused.val();
            self.error.d.next = self.refused.val();
        }
        // If the master drops the request, give no answer: the next transfer would take it as its own.
        if self.busy.q.val() & !self.asks.val() {
            self.abandoned.d.next = true;
        }
        // Cancel the access if the master drops the request one cycle after it: its write data may no longer be valid.
        self.words.request.next = self.request.q.val() & self.asks.val();
        if self.words.finished.val() | (self.request.q.val() & !self.asks.val()) {
            self.busy.d.next = false;
        }
        if self.words.finished.val() {
            self.acknowledge.d.next = self.asks.val() & !self.abandoned.q.val();
        }

        self.words.address_in.next = self.address.q.val();
        self.words.write_in.next = self.writing.q.val();
        self.words.data_in.next = self.dat_write.val();
        self.dat_read.next = self.words.read_data.val();
        self.ack.next = self.acknowledge.q.val();
        self.err.next = self.error.q.val();
    }
}

card_top! {
    /// The whole core with a Wishbone front; [`CardConfig::channels`] sets the number of channels.
    WishboneCard, WishboneCardParts: WishboneFront
    in {
        /// A bus cycle is under way.
        wb_cyc_i: Bit => cyc,
        /// With `wb_cyc_i`: the master requests a transfer.
        wb_stb_i: Bit => stb,
        /// Write.
        wb_we_i: Bit => we,
        /// Word address: a byte address divided by 4.
        wb_adr_i: Bits<11> => adr,
        /// Word to write.
        wb_dat_i: Bits<32> => dat_write,
        /// Byte selects; a write must select all four.
        wb_sel_i: Bits<4> => sel,
    }
    out {
        /// Word read, valid with `wb_ack_o`.
        wb_dat_o: Bits<32> => dat_read,
        /// The transfer is complete.
        wb_ack_o: Bit => ack,
        /// The transfer is rejected: a write to part of a word.
        wb_err_o: Bit => err,
    }
}
