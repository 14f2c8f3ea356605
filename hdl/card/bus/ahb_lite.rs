//! AHB-Lite front: the card as a subordinate of an AMBA 3 bus with pipelined transfers.
//!
//! ```text
//! hsel, htrans, hwrite, haddr, hsize --> taken with hready --> WordAccess <-> bank
//! hwdata -----------------------------------------------------^
//! hrdata, hreadyout, hresp <----------------------------------- finished
//! ```
//!
//! An address phase is accepted when `hready` and `hreadyout` are HIGH. Its data phase has wait states until the word is ready, and the next address phase may overlap
//! its last cycle. Words only: another size, or an address that is not a multiple of 4, gets the two-cycle error response and has no effect.
//! A burst is handled as single words.
//!
//! Ref: ARM IHI 0033A, AMBA 3 AHB-Lite Protocol v1.0.

use super::word_access::WordAccess;
use crate::card::ports::AccessOut;
use crate::card::{top::card_top, CardCore};
use crate::config::CardConfig;
use crate::replicate::each;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// AHB-Lite subordinate in front of the register bank.
#[derive(LogicBlock, Block)]
pub struct AhbLiteFront {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// The address belongs to this subordinate.
    pub hsel: Signal<In, Bit>,
    /// Bit 1: a transfer.
    pub htrans: Signal<In, Bits<2>>,
    /// Write.
    pub hwrite: Signal<In, Bit>,
    /// Size: 2 is a word.
    pub hsize: Signal<In, Bits<3>>,
    /// Byte address, a multiple of 4.
    pub haddr: Signal<In, Bits<13>>,
    /// Word to write, in the data phase.
    pub hwdata: Signal<In, Bits<32>>,
    /// The previous transfer on the bus ends in this cycle.
    pub hready: Signal<In, Bit>,
    /// Word read, in the last cycle of the data phase.
    pub hrdata: Signal<Out, Bits<32>>,
    /// The data phase ends in this cycle.
    pub hreadyout: Signal<Out, Bit>,
    /// Error, without effect: two cycles, `hreadyout` LOW in the first.
    pub hresp: Signal<Out, Bit>,
    /// Strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// A front's access to the register bank.
    #[bundle]
    pub bank: AccessOut,
    /// Accesses of the register bank.
    #[start]
    words: WordAccess,
    /// High from the address phase of a transfer until its word access has ended.
    busy: Reg<Bit>,
    /// High for one cycle when a word access begins.
    request: Reg<Bit>,
    /// High in the first cycle of an error response.
    refused: Reg<Bit>,
    /// High in the second cycle of an error response.
    refused_still: Reg<Bit>,
    /// Word address of the transfer.
    address: Reg<Bits<11>>,
    /// High if the transfer is a write.
    writing: Reg<Bit>,
    /// High for one cycle when an address phase is accepted.
    start: Signal<Local, Bit>,
    /// High if the transfer is an aligned word.
    is_word: Signal<Local, Bit>,
}

#[kernel]
impl Logic for AhbLiteFront {
    fn update(&mut self) {
        connect!(self.words <= self;
            clock, reset, tick_us
        );
        self.words.keep_snapshot.next = false;
        self.words.end_snapshot.next = false;
        AccessOut::link(&mut self.bank, &mut self.words.bank);

        self.hreadyout.next = !self.busy.q.val() & !self.refused.q.val();
        // `hready` alone is not enough: it may be constantly HIGH for the only subordinate of a bus.
        self.start.next = self.hsel.val()
            & self.hready.val()
            & self.htrans.val().get_bit(1)
            & self.hreadyout.val();
        self.is_word.next = !self.haddr.val().get_bits::<2>(0).any() & (self.hsize.val() == 2);
        self.request.d.next = false;
        self.refused.d.next = false;
        self.refused_still.d.next = self.refused.q.val();
        if self.words.finished.val() {
            self.busy.d.next = false;
        }
        if self.start.val() {
            self.address.d.next = self.haddr.val().get_bits::<11>(2);
            self.writing.d.next = self.hwrite.val();
            self.request.d.next = self.is_word.val();
            self.busy.d.next = self.is_word.val();
            self.refused.d.next = !self.is_word.val();
        }

        self.words.request.next = self.request.q.val();
        self.words.address_in.next = self.address.q.val();
        self.words.write_in.next = self.writing.q.val();
        self.words.data_in.next = self.hwdata.val();
        self.hrdata.next = self.words.read_data.val();
        self.hresp.next = self.refused.q.val() | self.refused_still.q.val();
    }
}

card_top! {
    /// The whole core with an AHB-Lite front; [`CardConfig::channels`] sets the number of channels.
    AhbLiteCard, AhbLiteCardParts: AhbLiteFront
    in {
        /// The address belongs to this subordinate.
        s_ahb_hsel: Bit => hsel,
        /// Bit 1: a transfer.
        s_ahb_htrans: Bits<2> => htrans,
        /// Write.
        s_ahb_hwrite: Bit => hwrite,
        /// Size: 2 is a word.
        s_ahb_hsize: Bits<3> => hsize,
        /// Byte address, a multiple of 4.
        s_ahb_haddr: Bits<13> => haddr,
        /// Word to write, in the data phase.
        s_ahb_hwdata: Bits<32> => hwdata,
        /// The previous transfer on the bus ends in this cycle.
        s_ahb_hready: Bit => hready,
    }
    out {
        /// Word read, in the last cycle of the data phase.
        s_ahb_hrdata: Bits<32> => hrdata,
        /// The data phase ends in this cycle.
        s_ahb_hreadyout: Bit => hreadyout,
        /// Error, without effect: two cycles, `s_ahb_hreadyout` LOW in the first.
        s_ahb_hresp: Bit => hresp,
    }
}
