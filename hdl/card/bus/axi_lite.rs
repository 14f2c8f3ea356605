//! AXI4-Lite front: the card as a slave of an AMBA AXI4-Lite interconnect.
//!
//! ```text
//! aw ---> write_address --+
//! w  ---> data, strobes --+--> in turn --> WordAccess <-> bank
//! ar ---> read_address ---+                    |
//! b, r <---------------------------------------+  held until accepted
//! ```
//!
//! All five channels are independent; every READY, VALID and response comes from registers. A write to part of a word gets
//! SLVERR and has no effect. A write without any byte gets OKAY and has no effect. Absent words read 0 with OKAY, as in the register map.
//! The card has no pins for AWPROT and ARPROT.
//!
//! Ref: ARM IHI 0022E, AMBA AXI4-Lite, chapter B1.

use super::word_access::WordAccess;
use crate::card::ports::AccessOut;
use crate::card::{top::card_top, CardCore};
use crate::config::CardConfig;
use crate::replicate::each;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// AXI4-Lite slave in front of the register bank.
#[derive(LogicBlock, Block)]
pub struct AxiLiteFront {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Byte address of a write; the lowest two bits are ignored.
    pub awaddr: Signal<In, Bits<13>>,
    /// The write address is valid.
    pub awvalid: Signal<In, Bit>,
    /// The write address is accepted.
    pub awready: Signal<Out, Bit>,
    /// Word to write.
    pub wdata: Signal<In, Bits<32>>,
    /// Byte strobes: all, or none.
    pub wstrb: Signal<In, Bits<4>>,
    /// The word to write is valid.
    pub wvalid: Signal<In, Bit>,
    /// The word to write is accepted.
    pub wready: Signal<Out, Bit>,
    /// 0 = written, 2 = rejected: part of a word.
    pub bresp: Signal<Out, Bits<2>>,
    /// A write has ended.
    pub bvalid: Signal<Out, Bit>,
    /// The master accepts the write response.
    pub bready: Signal<In, Bit>,
    /// Byte address of a read; the lowest two bits are ignored.
    pub araddr: Signal<In, Bits<13>>,
    /// The read address is valid.
    pub arvalid: Signal<In, Bit>,
    /// The read address is accepted.
    pub arready: Signal<Out, Bit>,
    /// Word read.
    pub rdata: Signal<Out, Bits<32>>,
    /// Always 0.
    pub rresp: Signal<Out, Bits<2>>,
    /// The word read is valid.
    pub rvalid: Signal<Out, Bit>,
    /// The master accepts the word read.
    pub rready: Signal<In, Bit>,
    /// Strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// A front's access to the register bank.
    #[bundle]
    pub bank: AccessOut,
    /// Accesses of the register bank.
    #[start]
    words: WordAccess,
    /// High while a write address waits for its access.
    has_aw: Reg<Bit>,
    /// Word address of the waiting write.
    write_address: Reg<Bits<11>>,
    /// High while a word to write waits for its access.
    has_w: Reg<Bit>,
    /// Word to write.
    data: Reg<Bits<32>>,
    /// Byte strobes of the waiting write.
    strobes: Reg<Bits<4>>,
    /// High while a read address waits for its access.
    has_ar: Reg<Bit>,
    /// Word address of the waiting read.
    read_address: Reg<Bits<11>>,
    /// High while a write response waits for the master.
    has_b: Reg<Bit>,
    /// High if the last write selected a part of a word.
    error: Reg<Bit>,
    /// High while a word that was read waits for the master.
    has_r: Reg<Bit>,
    /// Word that was read.
    answer: Reg<Bits<32>>,
    /// High while a word access runs.
    busy: Reg<Bit>,
    /// High for one cycle when a word access begins.
    request: Reg<Bit>,
    /// Word address of the access.
    address: Reg<Bits<11>>,
    /// High if the access, or the last one, is a write.
    writing: Reg<Bit>,
    /// High if address and word of a write are present, and its response register is free.
    may_write: Signal<Local, Bit>,
    /// High if the address of a read is present, and its data register is free.
    may_read: Signal<Local, Bit>,
    /// High for one cycle when a write is accepted.
    goes_write: Signal<Local, Bit>,
    /// High for one cycle when a read is accepted.
    goes_read: Signal<Local, Bit>,
}

#[kernel]
impl Logic for AxiLiteFront {
    fn update(&mut self) {
        connect!(self.words <= self;
            clock, reset, tick_us
        );
        self.words.keep_snapshot.next = false;
        self.words.end_snapshot.next = false;
        AccessOut::link(&mut self.bank, &mut self.words.bank);

        // Each channel has a register for one item; it is free again when the access begins.
        if self.awvalid.val() & !self.has_aw.q.val() {
            self.has_aw.d.next = true;
            self.write_address.d.next = self.awaddr.val().get_bits::<11>(2);
        }
        if self.wvalid.val() & !self.has_w.q.val() {
            self.has_w.d.next = true;
            self.data.d.next = self.wdata.val();
            self.strobes.d.next = self.wstrb.val();
        }
        if self.arvalid.val() & !self.has_ar.q.val() {
            self.has_ar.d.next = true;
            self.read_address.d.next = self.araddr.val().get_bits::<11>(2);
        }
        if self.bready.val() {
            self.has_b.d.next = false;
        }
        if self.rready.val() {
            self.has_r.d.next = false;
        }

        // A response that the master does not accept stops its own direction only. If both directions are ready, they alternate.
        self.may_write.next = self.has_aw.q.val() & self.has_w.q.val() & !self.has_b.q.val();
        self.may_read.next = self.has_ar.q.val() & !self.has_r.q.val();
        self.goes_write.next = !self.busy.q.val()
            & self.may_write.val()
            & !(self.may_read.val() & self.writing.q.val());
        self.goes_read.next = !self.busy.q.val() & self.may_read.val() & !self.goes_write.val();
        self.request.d.next = false;
        if self.goes_read.val() {
            self.has_ar.d.next = false;
            self.address.d.next = self.read_address.q.val();
            self.writing.d.next = false;
            self.request.d.next = true;
            self.busy.d.next = true;
        }
        if self.goes_write.val() {
            self.has_aw.d.next = false;
            self.has_w.d.next = false;
            self.address.d.next = self.write_address.q.val();
            self.writing.d.next = true;
            // No byte selected: no effect. Part of a word: error.
            self.error.d.next = self.strobes.q.val().any() & !self.strobes.q.val().all();
            if self.strobes.q.val().all() {
                self.request.d.next = true;
                self.busy.d.next = true;
            } else {
                self.has_b.d.next = true;
            }
        }
        if self.words.finished.val() {
            self.busy.d.next = false;
            if self.writing.q.val() {
                self.has_b.d.next = true;
            } else {
                self.has_r.d.next = true;
                self.answer.d.next = self.words.read_data.val();
            }
        }

        self.words.request.next = self.request.q.val();
        self.words.address_in.next = self.address.q.val();
        self.words.write_in.next = self.writing.q.val();
        self.words.data_in.next = self.data.q.val();
        self.awready.next = !self.has_aw.q.val();
        self.wready.next = !self.has_w.q.val();
        self.arready.next = !self.has_ar.q.val();
        self.bvalid.next = self.has_b.q.val();
        self.bresp.next = 0.into();
        if self.error.q.val() {
            self.bresp.next = 2.into();
        }
        self.rvalid.next = self.has_r.q.val();
        self.rdata.next = self.answer.q.val();
        self.rresp.next = 0.into();
    }
}

card_top! {
    /// The whole core with an AXI4-Lite front; [`CardConfig::channels`] sets the number of channels.
    AxiLiteCard, AxiLiteCardParts: AxiLiteFront
    in {
        /// Byte address of a write; the lowest two bits are ignored.
        s_axi_awaddr: Bits<13> => awaddr,
        /// The write address is valid.
        s_axi_awvalid: Bit => awvalid,
    }
    out {
        /// The write address is accepted.
        s_axi_awready: Bit => awready,
    }
    in {
        /// Word to write.
        s_axi_wdata: Bits<32> => wdata,
        /// Byte strobes: all, or none.
        s_axi_wstrb: Bits<4> => wstrb,
        /// The word to write is valid.
        s_axi_wvalid: Bit => wvalid,
    }
    out {
        /// The word to write is accepted.
        s_axi_wready: Bit => wready,
        /// 0 = written, 2 = rejected: part of a word.
        s_axi_bresp: Bits<2> => bresp,
        /// A write has ended.
        s_axi_bvalid: Bit => bvalid,
    }
    in {
        /// The master accepts the write response.
        s_axi_bready: Bit => bready,
        /// Byte address of a read; the lowest two bits are ignored.
        s_axi_araddr: Bits<13> => araddr,
        /// The read address is valid.
        s_axi_arvalid: Bit => arvalid,
    }
    out {
        /// The read address is accepted.
        s_axi_arready: Bit => arready,
        /// Word read.
        s_axi_rdata: Bits<32> => rdata,
        /// Always 0.
        s_axi_rresp: Bits<2> => rresp,
        /// The word read is valid.
        s_axi_rvalid: Bit => rvalid,
    }
    in {
        /// The master accepts the word read.
        s_axi_rready: Bit => rready,
    }
    out {}
}
