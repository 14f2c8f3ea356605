//! APB3 front: the card as a slave of an AMBA 3 peripheral bus.
//!
//! ```text
//! psel, penable, pwrite, paddr, pwdata --> start --> WordAccess <-> bank
//! prdata, pready, pslverr <---------------------------- finished
//! ```
//!
//! A transfer is accepted in the cycle after its first one, if it is enabled then; changes during a longer SETUP have no effect.
//! Every transfer has wait states, and every one ends. `pslverr` reports an address that is not a multiple of 4. A
//! master that drops `psel` before `pready` gets no answer; a write that has begun is completed.
//!
//! Ref: ARM IHI 0024B, AMBA 3 APB Protocol v1.0.

use super::word_access::WordAccess;
use crate::card::ports::AccessOut;
use crate::card::{top::card_top, CardCore};
use crate::config::CardConfig;
use crate::replicate::each;
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// APB3 slave in front of the register bank.
#[derive(LogicBlock, Block)]
pub struct ApbFront {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// The master selects this slave.
    pub psel: Signal<In, Bit>,
    /// Second and later cycles of a transfer.
    pub penable: Signal<In, Bit>,
    /// Write.
    pub pwrite: Signal<In, Bit>,
    /// Byte address, a multiple of 4.
    pub paddr: Signal<In, Bits<13>>,
    /// Word to write.
    pub pwdata: Signal<In, Bits<32>>,
    /// Word read, valid with `pready`.
    pub prdata: Signal<Out, Bits<32>>,
    /// The transfer ends in this cycle.
    pub pready: Signal<Out, Bit>,
    /// With `pready`: the address is not a multiple of 4; no effect.
    pub pslverr: Signal<Out, Bit>,
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
    /// High for one cycle when the transfer ends.
    ready: Reg<Bit>,
    /// High with `ready` if the address was not a multiple of 4.
    error: Reg<Bit>,
    /// High for one cycle when a word access begins.
    request: Reg<Bit>,
    /// High if the master has dropped the transfer before its end; cleared by the next transfer.
    abandoned: Reg<Bit>,
    /// Word address of the transfer.
    address: Reg<Bits<11>>,
    /// High if the transfer is a write.
    writing: Reg<Bit>,
    /// High for one cycle when a transfer is accepted.
    start: Signal<Local, Bit>,
    /// High while the master selects this slave and enables the transfer.
    enabled: Signal<Local, Bit>,
    /// High if the address is not a multiple of 4.
    misaligned: Signal<Local, Bit>,
}

#[kernel]
impl Logic for ApbFront {
    fn update(&mut self) {
        connect!(self.words <= self;
            clock, reset, tick_us
        );
        self.words.keep_snapshot.next = false;
        self.words.end_snapshot.next = false;
        AccessOut::link(&mut self.bank, &mut self.words.bank);

        // Also in the second cycle of a transfer, if an abandoned one delayed it.
        self.start.next = self.psel.val() & !self.busy.q.val() & !self.ready.q.val();
        self.misaligned.next = self.paddr.val().get_bits::<2>(0).any();
        self.ready.d.next = false;
        self.error.d.next = false;
        self.request.d.next = false;
        if self.start.val() {
            self.address.d.next = self.paddr.val().get_bits::<11>(2);
            self.writing.d.next = self.pwrite.val();
            self.abandoned.d.next = false;
            self.request.d.next = !self.misaligned.val();
            self.busy.d.next = !self.misaligned.val();
            self.ready.d.next = self.misaligned.val();
            self.error.d.next = self.misaligned.val();
        }
        // If the master drops the transfer, give no answer: the next transfer would take it as its own.
        self.enabled.next = self.psel.val() & self.penable.val();
        if self.busy.q.val() & !self.enabled.val() {
            self.abandoned.d.next = true;
        }
        // Cancel the access if the master drops the transfer one cycle after it, or does not enable it: its write data may no longer be valid.
        self.words.request.next = self.request.q.val() & self.enabled.val();
        if self.words.finished.val() | (self.request.q.val() & !self.enabled.val()) {
            self.busy.d.next = false;
        }
        if self.words.finished.val() {
            self.ready.d.next = self.enabled.val() & !self.abandoned.q.val();
        }

        self.words.address_in.next = self.address.q.val();
        self.words.write_in.next = self.writing.q.val();
        self.words.data_in.next = self.pwdata.val();
        self.prdata.next = self.words.read_data.val();
        self.pready.next = self.ready.q.val();
        self.pslverr.next = self.error.q.val();
    }
}

card_top! {
    /// The whole core with an APB3 front; [`CardConfig::channels`] sets the number of channels.
    ApbCard, ApbCardParts: ApbFront
    in {
        /// The master selects this slave.
        s_apb_psel: Bit => psel,
        /// Second and later cycles of a transfer.
        s_apb_penable: Bit => penable,
        /// Write.
        s_apb_pwrite: Bit => pwrite,
        /// Byte address, a multiple of 4.
        s_apb_paddr: Bits<13> => paddr,
        /// Word to write.
        s_apb_pwdata: Bits<32> => pwdata,
    }
    out {
        /// Word read, valid with `pready`.
        s_apb_prdata: Bits<32> => prdata,
        /// The transfer ends in this cycle.
        s_apb_pready: Bit => pready,
        /// With `pready`: the address is not a multiple of 4; no effect.
        s_apb_pslverr: Bit => pslverr,
    }
}
