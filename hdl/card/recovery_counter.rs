//! Independent measurement of the recovery time: a counter that no frame resets, captured at the edges.
//!
//! ```text
//! CLOCK as it goes to the pin ---------- rising edge ---> rise = counter
//! DATA pin --> separate synchroniser --falling edge---> fall = counter
//! ```
//!
//! DATA falls within the answer, too, and with a long cable after the last edge of CLOCK: only the last fall counts. The
//! counters of two channels are never equal, so a control can check that it reads the right one, and that it runs.

use crate::regs::{COUNTER_SPACING, RECOVERY};
use endat_macros::kernel;
use rtl_design::reg::{Reg, SyncReg};
use rtl_design::Block;
use rust_hdl::prelude::*;

/// Recovery counter of one channel.
#[derive(LogicBlock, Block)]
pub struct RecoveryCounter {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// EnDat clock at the output.
    pub endat_clk: Signal<In, Bit>,
    /// The receiver drives DATA.
    pub data_oe: Signal<In, Bit>,
    /// Data line from the transceiver, asynchronous.
    pub data_i: Signal<In, Bit>,
    /// Word address of an access.
    pub word_address: Signal<In, Bits<11>>,
    /// The front's address fits `word_address`.
    pub in_range: Signal<In, Bit>,
    /// Byte of the word, 0 = most significant.
    pub lane: Signal<In, Bits<2>>,
    /// Byte of the word, a cycle after its address; 0 for words of other blocks.
    pub read_byte: Signal<Out, Bits<8>>,
    /// Counts system clock cycles from reset on, and wraps; each channel starts at another value.
    #[given]
    counter: Reg<Bits<16>>,
    /// Counter at the last rising edge of CLOCK.
    rise: Reg<Bits<16>>,
    /// Counter at the last falling edge of DATA.
    fall: Reg<Bits<16>>,
    /// High if DATA has fallen since the last rising edge of CLOCK.
    fallen: Reg<Bit>,
    /// CLOCK of the cycle before; HIGH at rest.
    #[start(true)]
    clk_before: Reg<Bit>,
    /// DATA, first synchroniser stage.
    sampled: SyncReg<Bit>,
    /// DATA, second synchroniser stage.
    level: SyncReg<Bit>,
    /// DATA one cycle before `level`.
    level_before: Reg<Bit>,
    /// Low three bytes of the word, latched by the read of its first byte.
    held: Reg<Bits<24>>,
    /// Byte for the host; 0 for words of other blocks.
    byte_read: Reg<Bits<8>>,
    /// High if DATA has fallen since the last rising edge of CLOCK and is LOW.
    is_over: Signal<Local, Bit>,
    /// High if the address is one of this channel's words.
    selected: Signal<Local, Bit>,
    /// Word that the address selects.
    word: Signal<Local, Bits<32>>,
    /// Address of the two words, divided by 2.
    pair: Constant<Bits<10>>,
}

impl RecoveryCounter {
    /// The recovery counter of channel `channel`.
    pub fn new(channel: usize) -> Self {
        let first_word = RECOVERY.base + RECOVERY.stride * channel as u16;
        let start = u64::from(COUNTER_SPACING) * channel as u64;
        Self::from_parts(RecoveryCounterParts {
            counter: Reg::new(start.into()),
            pair: Constant::new(u64::from(first_word >> 1).into()),
        })
    }
}

#[kernel]
impl Logic for RecoveryCounter {
    fn update(&mut self) {
        self.counter.d.next = self.counter.q.val() + 1;
        self.sampled.d.next = self.data_i.val();
        self.level.d.next = self.sampled.q.val();
        self.level_before.d.next = self.level.q.val();
        if self.level_before.q.val() & !self.level.q.val() & !self.data_oe.val() {
            self.fall.d.next = self.counter.q.val();
            self.fallen.d.next = true;
        }
        // With a long cable, bits of the answer may still arrive, and fall.
        self.is_over.next = self.fallen.q.val() & !self.level.q.val();
        self.clk_before.d.next = self.endat_clk.val();
        if self.endat_clk.val() & !self.clk_before.q.val() {
            self.rise.d.next = self.counter.q.val();
            self.fallen.d.next = false;
        }

        self.selected.next =
            self.in_range.val() & (self.word_address.val().get_bits::<10>(1) == self.pair.val());
        self.word.next = place!(self.rise.q.val(), recovery.edges.rise)
            | place!(self.fall.q.val(), recovery.edges.fall);
        if self.word_address.val().get_bit(0) {
            self.word.next = place!(self.counter.q.val(), recovery.counter.value)
                | place!(self.is_over.val(), recovery.counter.fallen);
        }
        // The read of the first byte latches the other three.
        if !self.lane.val().any() {
            self.held.d.next = self.word.val().get_bits::<24>(0);
        }
        // A reset by deselection takes no logic.
        self.byte_read.reset.next = !self.selected.val();
        match self.lane.val().index() {
            0 => {
                self.byte_read.d.next = self.word.val().get_bits::<8>(24);
            }
            1 => {
                self.byte_read.d.next = self.held.q.val().get_bits::<8>(16);
            }
            2 => {
                self.byte_read.d.next = self.held.q.val().get_bits::<8>(8);
            }
            _ => {
                self.byte_read.d.next = self.held.q.val().get_bits::<8>(0);
            }
        }
        self.read_byte.next = self.byte_read.q.val();
    }
}
