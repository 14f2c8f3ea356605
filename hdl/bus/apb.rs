//! APB3 front: the card as a slave of an AMBA 3 peripheral bus.
//!
//! ```text
//! psel, penable, pwrite, paddr, pwdata --> start --> WordAccess <-> bank
//! prdata, pready, pslverr <---------------------------- finished
//! ```
//!
//! A transfer is taken in the cycle after its first one, if it is enabled then: what a master shows in a longer SETUP and changes does not count.
//! Every transfer has wait states; none is without an end. `pslverr` tells an address that is no multiple of 4. A
//! master that takes `psel` away before `pready` gets no answer, and a write that has begun is carried out.
//!
//! Ref: ARM IHI 0024B, AMBA 3 APB Protocol v1.0.

use super::word_access::WordAccess;
use crate::card::CardCore;
use crate::config::CardConfig;
use crate::reg::Reg;
use crate::several::each;
use endat_macros::{kernel, Block};
use rust_hdl::prelude::*;

/// APB3 slave in front of the register bank.
#[derive(LogicBlock, Block)]
pub struct ApbFront {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// The master talks to this slave.
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
    /// With `pready`: the address is no multiple of 4; nothing was done.
    pub pslverr: Signal<Out, Bit>,
    /// Strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// To the bank: word address.
    pub word_address: Signal<Out, Bits<11>>,
    /// To the bank: byte of the word, 0 = most significant.
    pub lane: Signal<Out, Bits<2>>,
    /// To the bank: begin an access.
    pub access: Signal<Out, Bit>,
    /// To the bank: with `access`, write.
    pub bank_write: Signal<Out, Bit>,
    /// To the bank: word to write.
    pub bank_data: Signal<Out, Bits<32>>,
    /// To the bank: results must not change.
    pub reading: Signal<Out, Bit>,
    /// From the bank: a byte of the configuration word passes.
    pub take_byte: Signal<In, Bit>,
    /// From the bank: the byte that passes.
    pub passing_byte: Signal<In, Bits<8>>,
    /// From the bank: the byte that was read.
    pub read_byte: Signal<In, Bits<8>>,
    /// From the bank: the access has ended.
    pub done: Signal<In, Bit>,
    #[start]
    words: WordAccess,
    busy: Reg<Bit>,
    ready: Reg<Bit>,
    error: Reg<Bit>,
    request: Reg<Bit>,
    abandoned: Reg<Bit>,
    address: Reg<Bits<11>>,
    writing: Reg<Bit>,
    start: Signal<Local, Bit>,
    enabled: Signal<Local, Bit>,
    misaligned: Signal<Local, Bit>,
}

impl Logic for ApbFront {
    #[kernel]
    fn update(&mut self) {
        self.words.clock.next = self.clock.val();
        self.words.reset.next = self.reset.val();
        self.words.tick_us.next = self.tick_us.val();
        self.words.take_byte.next = self.take_byte.val();
        self.words.passing_byte.next = self.passing_byte.val();
        self.words.read_byte.next = self.read_byte.val();
        self.words.done.next = self.done.val();
        self.words.keep_moment.next = false;
        self.words.end_moment.next = false;
        self.lane.next = self.words.lane.val();
        self.access.next = self.words.access.val();
        self.bank_data.next = self.words.bank_data.val();
        self.reading.next = self.words.reading.val();

        // Also in the second cycle of a transfer, if one that was abandoned kept it waiting.
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
        // A master that leaves in the middle gets no answer: the next transfer would take it for its own.
        self.enabled.next = self.psel.val() & self.penable.val();
        if self.busy.q.val() & !self.enabled.val() {
            self.abandoned.d.next = true;
        }
        // One that leaves at once, or does not enable it, has asked for nothing: its word cannot be trusted any more.
        self.words.request.next = self.request.q.val() & self.enabled.val();
        if self.words.finished.val() | (self.request.q.val() & !self.enabled.val()) {
            self.busy.d.next = false;
        }
        if self.words.finished.val() {
            self.ready.d.next = self.enabled.val() & !self.abandoned.q.val();
        }

        self.words.word_address.next = self.address.q.val();
        self.words.write.next = self.writing.q.val();
        self.words.write_data.next = self.pwdata.val();
        self.word_address.next = self.address.q.val();
        self.bank_write.next = self.writing.q.val();
        self.prdata.next = self.words.read_data.val();
        self.pready.next = self.ready.q.val();
        self.pslverr.next = self.error.q.val();
    }
}

/// The whole core behind APB3; the number of channels is that of [`CardConfig::channels`].
#[derive(LogicBlock, Block)]
pub struct ApbCard {
    /// System clock.
    pub clk_i: Signal<In, Clock>,
    /// Synchronous reset, active high.
    pub rst_i: Signal<In, Bit>,
    /// Trigger pin, asynchronous; a rising edge triggers.
    pub trigger_i: Signal<In, Bit>,
    /// The master talks to this slave.
    pub s_apb_psel: Signal<In, Bit>,
    /// Second and later cycles of a transfer.
    pub s_apb_penable: Signal<In, Bit>,
    /// Write.
    pub s_apb_pwrite: Signal<In, Bit>,
    /// Byte address, a multiple of 4.
    pub s_apb_paddr: Signal<In, Bits<13>>,
    /// Word to write.
    pub s_apb_pwdata: Signal<In, Bits<32>>,
    /// Word read, valid with `pready`.
    pub s_apb_prdata: Signal<Out, Bits<32>>,
    /// The transfer ends in this cycle.
    pub s_apb_pready: Signal<Out, Bit>,
    /// With `pready`: the address is no multiple of 4; nothing was done.
    pub s_apb_pslverr: Signal<Out, Bit>,
    /// Cropped position of the channel, for logic in the same device.
    pub direct_position_o: Vec<Signal<Out, Bits<32>>>,
    /// The cropped position is that of the last result.
    pub direct_valid_o: Vec<Signal<Out, Bit>>,
    /// Strobe: the cropped position is new.
    pub direct_fresh_o: Vec<Signal<Out, Bit>>,
    /// The last result's cause is one of those selected, or the alarm.
    pub direct_error_o: Vec<Signal<Out, Bit>>,
    /// Interrupt; low without this part.
    pub irq_o: Signal<Out, Bit>,
    /// EnDat clock to the transceiver.
    pub endat_clk_o: Vec<Signal<Out, Bit>>,
    /// EnDat data to the transceiver.
    pub endat_data_o: Vec<Signal<Out, Bit>>,
    /// Driver enable of the EnDat data line.
    pub endat_data_oe: Vec<Signal<Out, Bit>>,
    /// EnDat data from the transceiver, asynchronous.
    pub endat_data_i: Vec<Signal<In, Bit>>,
    /// Blinks: slowly = well, quickly = the last result of a channel is an error.
    pub led_status_o: Signal<Out, Bit>,
    /// The channel's last result is a good position.
    pub led_channel_o: Vec<Signal<Out, Bit>>,
    core: CardCore,
    #[start]
    front: ApbFront,
    _direct_ports: usize,
    _channels: usize,
}

impl ApbCard {
    /// A card.
    pub fn new(config: &CardConfig) -> Self {
        let channels = config.channels.len();
        let direct_ports = channels * usize::from(config.outputs.position);
        Self::from_parts(ApbCardParts {
            direct_position_o: each(direct_ports),
            direct_valid_o: each(direct_ports),
            direct_fresh_o: each(direct_ports),
            direct_error_o: each(direct_ports),
            endat_clk_o: each(channels),
            endat_data_o: each(channels),
            endat_data_oe: each(channels),
            endat_data_i: each(channels),
            led_channel_o: each(channels),
            core: CardCore::new(config),
            _direct_ports: direct_ports,
            _channels: channels,
        })
    }
}

impl Logic for ApbCard {
    #[kernel]
    fn update(&mut self) {
        self.core.clk_i.next = self.clk_i.val();
        self.core.rst_i.next = self.rst_i.val();
        self.core.trigger_i.next = self.trigger_i.val();
        self.front.clock.next = self.clk_i.val();
        self.front.reset.next = self.rst_i.val();

        self.front.psel.next = self.s_apb_psel.val();
        self.front.penable.next = self.s_apb_penable.val();
        self.front.pwrite.next = self.s_apb_pwrite.val();
        self.front.paddr.next = self.s_apb_paddr.val();
        self.front.pwdata.next = self.s_apb_pwdata.val();
        self.s_apb_prdata.next = self.front.prdata.val();
        self.s_apb_pready.next = self.front.pready.val();
        self.s_apb_pslverr.next = self.front.pslverr.val();

        self.front.tick_us.next = self.core.tick_us.val();
        self.front.take_byte.next = self.core.take_byte.val();
        self.front.passing_byte.next = self.core.passing_byte.val();
        self.front.read_byte.next = self.core.read_byte.val();
        self.front.done.next = self.core.done.val();
        self.core.word_address.next = self.front.word_address.val();
        self.core.in_range.next = true;
        self.core.lane.next = self.front.lane.val();
        self.core.access.next = self.front.access.val();
        self.core.write.next = self.front.bank_write.val();
        self.core.write_data.next = self.front.bank_data.val();
        self.core.push_take.next = false;
        self.core.reading.next = self.front.reading.val();

        for i in 0..self._direct_ports {
            self.direct_position_o[i].next = self.core.direct_position_o[i].val();
            self.direct_valid_o[i].next = self.core.direct_valid_o[i].val();
            self.direct_fresh_o[i].next = self.core.direct_fresh_o[i].val();
            self.direct_error_o[i].next = self.core.direct_error_o[i].val();
        }
        self.irq_o.next = self.core.irq_o.val();
        for i in 0..self._channels {
            self.core.endat_data_i[i].next = self.endat_data_i[i].val();
            self.endat_clk_o[i].next = self.core.endat_clk_o[i].val();
            self.endat_data_o[i].next = self.core.endat_data_o[i].val();
            self.endat_data_oe[i].next = self.core.endat_data_oe[i].val();
            self.led_channel_o[i].next = self.core.led_channel_o[i].val();
        }
        self.led_status_o.next = self.core.led_status_o.val();
    }
}
