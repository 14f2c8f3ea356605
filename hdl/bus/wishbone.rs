//! Wishbone front: the card as a slave of a Wishbone bus, classic cycles.
//!
//! ```text
//! cyc, stb, we, adr, dat, sel --> start --> WordAccess <-> bank
//! dat, ack, err <---------------------------- finished
//! ```
//!
//! `ack` and `err` come from registers, one cycle each. A write that does not select all four bytes is refused with `err`; a read
//! gives the whole word whatever it selects. If `cyc` or `stb` falls before the answer there is none, and a write that has begun is carried out.
//!
//! Ref: OpenCores, Wishbone B4, chapter 3 (classic cycles), 32-bit port, granularity 8 bits.

use super::word_access::WordAccess;
use crate::card::CardCore;
use crate::config::CardConfig;
use crate::reg::Reg;
use crate::several::each;
use endat_macros::{kernel, Block};
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
    /// With `cyc`: the master asks for a transfer.
    pub stb: Signal<In, Bit>,
    /// Write.
    pub we: Signal<In, Bit>,
    /// Word address: a byte address divided by 4.
    pub adr: Signal<In, Bits<11>>,
    /// Word to write.
    pub dat_write: Signal<In, Bits<32>>,
    /// Bytes of it; a write takes all four.
    pub sel: Signal<In, Bits<4>>,
    /// Word read, valid with `ack`.
    pub dat_read: Signal<Out, Bits<32>>,
    /// The transfer has been done.
    pub ack: Signal<Out, Bit>,
    /// The transfer has been refused: a write of a part of a word.
    pub err: Signal<Out, Bit>,
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
    acknowledge: Reg<Bit>,
    error: Reg<Bit>,
    request: Reg<Bit>,
    abandoned: Reg<Bit>,
    address: Reg<Bits<11>>,
    writing: Reg<Bit>,
    asks: Signal<Local, Bit>,
    start: Signal<Local, Bit>,
    refused: Signal<Local, Bit>,
}

impl Logic for WishboneFront {
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

        // Also later than the first cycle of a transfer, if one that was abandoned kept it waiting.
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
        // A master that leaves in the middle gets no answer: the next transfer would take it for its own.
        if self.busy.q.val() & !self.asks.val() {
            self.abandoned.d.next = true;
        }
        // One that leaves at once has asked for nothing: its word cannot be trusted any more.
        self.words.request.next = self.request.q.val() & self.asks.val();
        if self.words.finished.val() | (self.request.q.val() & !self.asks.val()) {
            self.busy.d.next = false;
        }
        if self.words.finished.val() {
            self.acknowledge.d.next = self.asks.val() & !self.abandoned.q.val();
        }

        self.words.word_address.next = self.address.q.val();
        self.words.write.next = self.writing.q.val();
        self.words.write_data.next = self.dat_write.val();
        self.word_address.next = self.address.q.val();
        self.bank_write.next = self.writing.q.val();
        self.dat_read.next = self.words.read_data.val();
        self.ack.next = self.acknowledge.q.val();
        self.err.next = self.error.q.val();
    }
}

/// The whole core behind Wishbone; the number of channels is that of [`CardConfig::channels`].
#[derive(LogicBlock, Block)]
pub struct WishboneCard {
    /// System clock.
    pub clk_i: Signal<In, Clock>,
    /// Synchronous reset, active high.
    pub rst_i: Signal<In, Bit>,
    /// Trigger pin, asynchronous; a rising edge triggers.
    pub trigger_i: Signal<In, Bit>,
    /// A bus cycle is under way.
    pub wb_cyc_i: Signal<In, Bit>,
    /// With `wb_cyc_i`: the master asks for a transfer.
    pub wb_stb_i: Signal<In, Bit>,
    /// Write.
    pub wb_we_i: Signal<In, Bit>,
    /// Word address: a byte address divided by 4.
    pub wb_adr_i: Signal<In, Bits<11>>,
    /// Word to write.
    pub wb_dat_i: Signal<In, Bits<32>>,
    /// Bytes of it; a write takes all four.
    pub wb_sel_i: Signal<In, Bits<4>>,
    /// Word read, valid with `wb_ack_o`.
    pub wb_dat_o: Signal<Out, Bits<32>>,
    /// The transfer has been done.
    pub wb_ack_o: Signal<Out, Bit>,
    /// The transfer has been refused: a write of a part of a word.
    pub wb_err_o: Signal<Out, Bit>,
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
    front: WishboneFront,
    _direct_ports: usize,
    _channels: usize,
}

impl WishboneCard {
    /// A card.
    pub fn new(config: &CardConfig) -> Self {
        let channels = config.channels.len();
        let direct_ports = channels * usize::from(config.outputs.position);
        Self::from_parts(WishboneCardParts {
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

impl Logic for WishboneCard {
    #[kernel]
    fn update(&mut self) {
        self.core.clk_i.next = self.clk_i.val();
        self.core.rst_i.next = self.rst_i.val();
        self.core.trigger_i.next = self.trigger_i.val();
        self.front.clock.next = self.clk_i.val();
        self.front.reset.next = self.rst_i.val();

        self.front.cyc.next = self.wb_cyc_i.val();
        self.front.stb.next = self.wb_stb_i.val();
        self.front.we.next = self.wb_we_i.val();
        self.front.adr.next = self.wb_adr_i.val();
        self.front.dat_write.next = self.wb_dat_i.val();
        self.front.sel.next = self.wb_sel_i.val();
        self.wb_dat_o.next = self.front.dat_read.val();
        self.wb_ack_o.next = self.front.ack.val();
        self.wb_err_o.next = self.front.err.val();

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
