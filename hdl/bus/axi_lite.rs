//! AXI4-Lite front: the card as a slave of an AMBA AXI4-Lite interconnect.
//!
//! ```text
//! aw ---> write_address --+
//! w  ---> data, strobes --+--> in turn --> WordAccess <-> bank
//! ar ---> read_address ---+                    |
//! b, r <---------------------------------------+  held until they are taken
//! ```
//!
//! All five channels are independent; every READY, VALID and answer comes from registers. A write of a part of a word is refused with
//! SLVERR and does nothing; one without any byte is OKAY and does nothing. Absent words read as 0 with OKAY, as the map says.
//! The card does not look at AWPROT and ARPROT, and has no pins for them.
//!
//! Ref: ARM IHI 0022E, AMBA AXI4-Lite, chapter B1.

use super::word_access::WordAccess;
use crate::card::CardCore;
use crate::config::CardConfig;
use crate::reg::Reg;
use crate::several::each;
use endat_macros::{kernel, Block};
use rust_hdl::prelude::*;

/// AXI4-Lite slave in front of the register bank.
#[derive(LogicBlock, Block)]
pub struct AxiLiteFront {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Byte address of a write; the lowest two bits do not matter.
    pub awaddr: Signal<In, Bits<13>>,
    /// There is an address of a write.
    pub awvalid: Signal<In, Bit>,
    /// It is taken.
    pub awready: Signal<Out, Bit>,
    /// Word to write.
    pub wdata: Signal<In, Bits<32>>,
    /// Bytes of it: all, or none.
    pub wstrb: Signal<In, Bits<4>>,
    /// There is a word to write.
    pub wvalid: Signal<In, Bit>,
    /// It is taken.
    pub wready: Signal<Out, Bit>,
    /// 0 = written, 2 = refused: a part of a word.
    pub bresp: Signal<Out, Bits<2>>,
    /// A write has ended.
    pub bvalid: Signal<Out, Bit>,
    /// The master takes that.
    pub bready: Signal<In, Bit>,
    /// Byte address of a read; the lowest two bits do not matter.
    pub araddr: Signal<In, Bits<13>>,
    /// There is an address of a read.
    pub arvalid: Signal<In, Bit>,
    /// It is taken.
    pub arready: Signal<Out, Bit>,
    /// Word read.
    pub rdata: Signal<Out, Bits<32>>,
    /// Always 0.
    pub rresp: Signal<Out, Bits<2>>,
    /// There is a word read.
    pub rvalid: Signal<Out, Bit>,
    /// The master takes it.
    pub rready: Signal<In, Bit>,
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
    has_aw: Reg<Bit>,
    write_address: Reg<Bits<11>>,
    has_w: Reg<Bit>,
    data: Reg<Bits<32>>,
    strobes: Reg<Bits<4>>,
    has_ar: Reg<Bit>,
    read_address: Reg<Bits<11>>,
    has_b: Reg<Bit>,
    error: Reg<Bit>,
    has_r: Reg<Bit>,
    answer: Reg<Bits<32>>,
    busy: Reg<Bit>,
    request: Reg<Bit>,
    address: Reg<Bits<11>>,
    writing: Reg<Bit>,
    may_write: Signal<Local, Bit>,
    may_read: Signal<Local, Bit>,
    goes_write: Signal<Local, Bit>,
    goes_read: Signal<Local, Bit>,
}

impl Logic for AxiLiteFront {
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

        // Each channel has a place for one item; it is free again when the access begins.
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

        // An answer that nobody takes stops its own direction only. Of two that are ready, the direction that was not the last.
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
            // Nothing selected is nothing to do; a part of a word is refused.
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
        self.words.word_address.next = self.address.q.val();
        self.words.write.next = self.writing.q.val();
        self.words.write_data.next = self.data.q.val();
        self.word_address.next = self.address.q.val();
        self.bank_write.next = self.writing.q.val();
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

/// The whole core behind AXI4-Lite; the number of channels is that of [`CardConfig::channels`].
#[derive(LogicBlock, Block)]
pub struct AxiLiteCard {
    /// System clock.
    pub clk_i: Signal<In, Clock>,
    /// Synchronous reset, active high.
    pub rst_i: Signal<In, Bit>,
    /// Trigger pin, asynchronous; a rising edge triggers.
    pub trigger_i: Signal<In, Bit>,
    /// Byte address of a write; the lowest two bits do not matter.
    pub s_axi_awaddr: Signal<In, Bits<13>>,
    /// There is an address of a write.
    pub s_axi_awvalid: Signal<In, Bit>,
    /// It is taken.
    pub s_axi_awready: Signal<Out, Bit>,
    /// Word to write.
    pub s_axi_wdata: Signal<In, Bits<32>>,
    /// Bytes of it: all, or none.
    pub s_axi_wstrb: Signal<In, Bits<4>>,
    /// There is a word to write.
    pub s_axi_wvalid: Signal<In, Bit>,
    /// It is taken.
    pub s_axi_wready: Signal<Out, Bit>,
    /// 0 = written, 2 = refused: a part of a word.
    pub s_axi_bresp: Signal<Out, Bits<2>>,
    /// A write has ended.
    pub s_axi_bvalid: Signal<Out, Bit>,
    /// The master takes that.
    pub s_axi_bready: Signal<In, Bit>,
    /// Byte address of a read; the lowest two bits do not matter.
    pub s_axi_araddr: Signal<In, Bits<13>>,
    /// There is an address of a read.
    pub s_axi_arvalid: Signal<In, Bit>,
    /// It is taken.
    pub s_axi_arready: Signal<Out, Bit>,
    /// Word read.
    pub s_axi_rdata: Signal<Out, Bits<32>>,
    /// Always 0.
    pub s_axi_rresp: Signal<Out, Bits<2>>,
    /// There is a word read.
    pub s_axi_rvalid: Signal<Out, Bit>,
    /// The master takes it.
    pub s_axi_rready: Signal<In, Bit>,
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
    front: AxiLiteFront,
    _direct_ports: usize,
    _channels: usize,
}

impl AxiLiteCard {
    /// A card.
    pub fn new(config: &CardConfig) -> Self {
        let channels = config.channels.len();
        let direct_ports = channels * usize::from(config.outputs.position);
        Self::from_parts(AxiLiteCardParts {
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

impl Logic for AxiLiteCard {
    #[kernel]
    fn update(&mut self) {
        self.core.clk_i.next = self.clk_i.val();
        self.core.rst_i.next = self.rst_i.val();
        self.core.trigger_i.next = self.trigger_i.val();
        self.front.clock.next = self.clk_i.val();
        self.front.reset.next = self.rst_i.val();

        self.front.awaddr.next = self.s_axi_awaddr.val();
        self.front.awvalid.next = self.s_axi_awvalid.val();
        self.s_axi_awready.next = self.front.awready.val();
        self.front.wdata.next = self.s_axi_wdata.val();
        self.front.wstrb.next = self.s_axi_wstrb.val();
        self.front.wvalid.next = self.s_axi_wvalid.val();
        self.s_axi_wready.next = self.front.wready.val();
        self.s_axi_bresp.next = self.front.bresp.val();
        self.s_axi_bvalid.next = self.front.bvalid.val();
        self.front.bready.next = self.s_axi_bready.val();
        self.front.araddr.next = self.s_axi_araddr.val();
        self.front.arvalid.next = self.s_axi_arvalid.val();
        self.s_axi_arready.next = self.front.arready.val();
        self.s_axi_rdata.next = self.front.rdata.val();
        self.s_axi_rresp.next = self.front.rresp.val();
        self.s_axi_rvalid.next = self.front.rvalid.val();
        self.front.rready.next = self.s_axi_rready.val();

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
