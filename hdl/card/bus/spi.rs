//! SPI front: frames of mode 0 with a check sum, most significant bit first.
//!
//! ```text
//! read    03 a1 a0 n  xx  -- -- -- -- ... -- --          write   02 a1 a0 n  d3 d2 d1 d0 c1 c0  d3 d2 d1 d0 c1 c0 ...
//! answer  s  -- -- -- --  d3 d2 d1 d0 ... c1 c0          answer  s
//! ```
//!
//! Addresses count words and rise; `n` words, 1 to 255. `c1 c0` is CRC-16/CCITT-FALSE (polynomial 0x1021, start 0xFFFF). In a read it covers
//! the four bytes of the request and all words sent. In a write it covers everything before it, and from the second word on that
//! word. A word is written if its check sum is right; otherwise the rest of the frame is ignored. `s` is 0xA0, or 0xA2 if the last write was rejected.
//! All result words of a frame belong to one snapshot. A frame may end anywhere. A read during a pending write waits for the write;
//! if the host's clock does not wait, the check sum of the answer is wrong.

use super::word_access::WordAccess;
use crate::card::ports::AccessOut;
use crate::card::stream::buffer::CRC16_POLYNOMIAL;
use crate::card::{top::card_top, CardCore};
use crate::config::CardConfig;
use crate::endat::service::program::ServiceTimes;
use crate::replicate::each;
use rtl_design::reg::{Reg, SyncReg};
use rtl_design::{kernel, Block, States};
use rust_hdl::prelude::*;

/// Meaning of the byte.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum SpiState {
    /// 2 = write, 3 = read.
    Command,
    /// Word address, bits 15..8.
    AddressHigh,
    /// Word address, bits 7..0.
    AddressLow,
    /// Number of words.
    Length,
    /// Idle byte: the first word is being read.
    Turnaround,
    /// A word, in either direction.
    Data,
    /// Check sum, in either direction.
    Crc,
    /// Ignored until the frame ends.
    Ignore,
}

/// SPI slave in front of the register bank.
#[derive(LogicBlock, Block)]
pub struct SpiFront {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Serial clock, idle low, asynchronous; at most an eighth of the system clock.
    pub sck: Signal<In, Bit>,
    /// Chip select, active low, asynchronous.
    pub cs_n: Signal<In, Bit>,
    /// Data from the host, sampled at the rising edge, asynchronous.
    pub mosi: Signal<In, Bit>,
    /// Data to the host; changes after the falling edge.
    pub miso: Signal<Out, Bit>,
    /// The card drives `miso`; combinational from `cs_n`.
    pub miso_enable: Signal<Out, Bit>,
    /// Strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// A front's access to the register bank.
    #[bundle]
    pub bank: AccessOut,
    /// Accesses of the register bank.
    #[start]
    words: WordAccess,
    /// Serial clock, first synchroniser stage.
    sck_0: SyncReg<Bit>,
    /// Serial clock, second synchroniser stage.
    sck_1: SyncReg<Bit>,
    /// Serial clock one cycle before `sck_1`, to find its edges.
    sck_2: Reg<Bit>,
    /// Chip select, active high, first synchroniser stage.
    cs_0: SyncReg<Bit>,
    /// Chip select, second synchroniser stage.
    cs_1: SyncReg<Bit>,
    /// Data from the host, first synchroniser stage.
    mosi_0: SyncReg<Bit>,
    /// Data from the host, second synchroniser stage.
    mosi_1: SyncReg<Bit>,
    /// Meaning of the byte.
    #[start(SpiState::Command)]
    state: Reg<SpiState>,
    /// Bits of the byte received so far.
    bit_count: Reg<Bits<3>>,
    /// Last eight bits from the host.
    byte_in: Reg<Bits<8>>,
    /// High for one cycle when a byte is complete.
    byte_end: Reg<Bit>,
    /// Byte of the word or check sum.
    byte_count: Reg<Bits<2>>,
    /// CRC of the frame so far; in a write since the last word that was accepted.
    #[start(0xffffu64.into())]
    crc: Reg<Bits<16>>,
    /// Bits still to be sent, the one on the line at the top.
    shift_out: Reg<Bits<32>>,
    /// High until the next falling edge loads a word that was read.
    load_word: Reg<Bit>,
    /// High until the next falling edge loads the check sum.
    load_crc: Reg<Bit>,
    /// High if a word was not ready in time: the check sum of the frame is inverted.
    late: Reg<Bit>,
    /// High if the frame is a write.
    writing: Reg<Bit>,
    /// Remaining words of the frame.
    words_left: Reg<Bits<8>>,
    /// Word address of the next access.
    address: Reg<Bits<11>>,
    /// High if that address is beyond the map.
    out_of_range: Reg<Bit>,
    /// Word to write.
    data: Reg<Bits<32>>,
    /// High while an access waits for the previous one.
    asked: Reg<Bit>,
    /// High while an access runs.
    busy: Reg<Bit>,
    /// High for one cycle when a word access begins.
    request: Reg<Bit>,
    /// Word address of the access.
    access_address: Reg<Bits<11>>,
    /// High if the address of the access is beyond the map.
    access_outside: Reg<Bit>,
    /// High if the access is a write.
    access_writes: Reg<Bit>,
    /// High if the last word to write was rejected: wrong check sum, or an access was still running.
    refused: Reg<Bit>,
    /// High while the host selects this slave.
    selected: Signal<Local, Bit>,
    /// High for one cycle at a rising edge of the serial clock.
    rise: Signal<Local, Bit>,
    /// High for one cycle at a falling edge of the serial clock.
    fall: Signal<Local, Bit>,
    /// Bit that enters the CRC.
    crc_bit: Signal<Local, Bit>,
    /// High while bits enter the CRC.
    crc_runs: Signal<Local, Bit>,
    /// High for one cycle when the address advances.
    step_address: Signal<Local, Bit>,
    /// High while an access waits or runs.
    waits: Signal<Local, Bit>,
    /// Following address, with carry.
    next_address: Signal<Local, Bits<12>>,
    /// High if one word is left.
    last_word: Signal<Local, Bit>,
    /// Check sum that is sent: inverted if a word was late.
    crc_sent: Signal<Local, Bits<16>>,
    /// Generator of the CRC, without x^16.
    polynomial: Constant<Bits<16>>,
    /// First word of an answer if the last write was accepted.
    accepted_word: Constant<Bits<32>>,
    /// First word of an answer if the last write was rejected.
    refused_word: Constant<Bits<32>>,
}

impl Default for SpiFront {
    fn default() -> Self {
        Self::from_parts(SpiFrontParts {
            polynomial: Constant::new(CRC16_POLYNOMIAL.into()),
            accepted_word: Constant::new(0xa000_0000u64.into()),
            refused_word: Constant::new(0xa200_0000u64.into()),
        })
    }
}

#[kernel]
impl Logic for SpiFront {
    fn update(&mut self) {
        connect!(self.words <= self;
            clock, reset, tick_us, keep_snapshot = selected
        );
        self.words.end_snapshot.next = !self.selected.val();
        AccessOut::link(&mut self.bank, &mut self.words.bank);

        self.sck_0.d.next = self.sck.val();
        self.sck_1.d.next = self.sck_0.q.val();
        self.sck_2.d.next = self.sck_1.q.val();
        self.cs_0.d.next = !self.cs_n.val();
        self.cs_1.d.next = self.cs_0.q.val();
        self.mosi_0.d.next = self.mosi.val();
        self.mosi_1.d.next = self.mosi_0.q.val();
        self.selected.next = self.cs_1.q.val();
        self.rise.next = self.selected.val() & self.sck_1.q.val() & !self.sck_2.q.val();
        self.fall.next = self.selected.val() & !self.sck_1.q.val() & self.sck_2.q.val();

        // Bits.
        self.crc_runs.next = (self.state.q.val() == SpiState::Command)
            | (self.state.q.val() == SpiState::AddressHigh)
            | (self.state.q.val() == SpiState::AddressLow)
            | (self.state.q.val() == SpiState::Length)
            | (self.state.q.val() == SpiState::Data)
            | ((self.state.q.val() == SpiState::Crc) & self.writing.q.val());
        self.crc_bit.next = self.mosi_1.q.val();
        if (self.state.q.val() == SpiState::Data) & !self.writing.q.val() {
            self.crc_bit.next = self.shift_out.q.val().get_bit(31);
        }
        self.byte_end.d.next = self.rise.val() & self.bit_count.q.val().all();
        if self.rise.val() {
            self.bit_count.d.next = self.bit_count.q.val() + 1;
            self.byte_in.d.next =
                (self.byte_in.q.val() << 1) | bit_cast::<8, 1>(self.mosi_1.q.val().into());
            if self.crc_runs.val() {
                self.crc.d.next = self.crc.q.val() << 1;
                if self.crc.q.val().get_bit(15) ^ self.crc_bit.val() {
                    self.crc.d.next = (self.crc.q.val() << 1) ^ self.polynomial.val();
                }
            }
        }

        // One access after the other, each with its own address and direction, because the next frame may have begun.
        self.request.d.next = false;
        self.step_address.next = false;
        self.waits.next = self.asked.q.val() | self.busy.q.val();
        if self.words.finished.val() {
            self.busy.d.next = false;
        }
        if self.asked.q.val() & !self.busy.q.val() {
            self.asked.d.next = false;
            self.busy.d.next = true;
            self.request.d.next = true;
            self.access_address.d.next = self.address.q.val();
            self.access_outside.d.next = self.out_of_range.q.val();
            self.access_writes.d.next = self.writing.q.val();
            self.step_address.next = self.writing.q.val();
        }

        // Bytes.
        self.last_word.next = self.words_left.q.val() == 1;
        if self.byte_end.q.val() {
            match self.state.q.val() {
                SpiState::Command => {
                    self.state.d.next = SpiState::Ignore;
                    self.writing.d.next = self.byte_in.q.val() == 2;
                    if (self.byte_in.q.val() == 2) | (self.byte_in.q.val() == 3) {
                        self.state.d.next = SpiState::AddressHigh;
                    }
                }
                SpiState::AddressHigh => {
                    self.state.d.next = SpiState::AddressLow;
                    self.address.d.next =
                        bit_cast::<11, 3>(self.byte_in.q.val().get_bits::<3>(0)) << 8;
                    self.out_of_range.d.next = self.byte_in.q.val().get_bits::<5>(3).any();
                }
                SpiState::AddressLow => {
                    self.state.d.next = SpiState::Length;
                    self.address.d.next =
                        self.address.q.val() | bit_cast::<11, 8>(self.byte_in.q.val());
                    // The first word is ready before the host can clock it out.
                    self.asked.d.next = !self.writing.q.val();
                }
                SpiState::Length => {
                    self.words_left.d.next = self.byte_in.q.val();
                    self.byte_count.d.next = 0.into();
                    self.state.d.next = SpiState::Turnaround;
                    if self.writing.q.val() {
                        self.state.d.next = SpiState::Data;
                    }
                    if !self.byte_in.q.val().any() {
                        self.state.d.next = SpiState::Ignore;
                    }
                }
                SpiState::Turnaround => {
                    self.state.d.next = SpiState::Data;
                    self.load_word.d.next = true;
                }
                SpiState::Data => {
                    self.byte_count.d.next = self.byte_count.q.val() + 1;
                    if self.writing.q.val() {
                        self.data.d.next =
                            (self.data.q.val() << 8) | bit_cast::<32, 8>(self.byte_in.q.val());
                    }
                    if self.byte_count.q.val().all() {
                        if self.writing.q.val() {
                            self.state.d.next = SpiState::Crc;
                        } else {
                            self.words_left.d.next = self.words_left.q.val() - 1;
                            self.load_word.d.next = !self.last_word.val();
                            if self.last_word.val() {
                                self.load_crc.d.next = true;
                                self.state.d.next = SpiState::Crc;
                            }
                        }
                    }
                }
                SpiState::Crc => {
                    self.byte_count.d.next = self.byte_count.q.val() + 1;
                    if self.byte_count.q.val().get_bit(0) {
                        self.state.d.next = SpiState::Ignore;
                        if self.writing.q.val() {
                            // Data followed by their check sum give a CRC of 0.
                            self.refused.d.next = self.crc.q.val().any() | self.waits.val();
                            if !self.crc.q.val().any() & !self.waits.val() {
                                self.asked.d.next = true;
                                self.words_left.d.next = self.words_left.q.val() - 1;
                                self.byte_count.d.next = 0.into();
                                self.crc.d.next = 0xffff.into();
                                if !self.last_word.val() {
                                    self.state.d.next = SpiState::Data;
                                }
                            }
                        }
                    }
                }
                _ => {}
            }
        }

        // If the clock is too fast the answer must be invalid: send a wrong check sum.
        self.crc_sent.next = self.crc.q.val();
        if self.late.q.val() {
            self.crc_sent.next = !self.crc.q.val();
        }
        // The output changes with the falling edge.
        if self.fall.val() {
            self.shift_out.d.next = self.shift_out.q.val() << 1;
            self.load_word.d.next = false;
            self.load_crc.d.next = false;
            if self.load_word.q.val() {
                self.shift_out.d.next = self.words.read_data.val();
                self.late.d.next = self.late.q.val() | self.waits.val();
                self.step_address.next = !self.last_word.val();
                self.asked.d.next = !self.last_word.val();
            }
            if self.load_crc.q.val() {
                self.shift_out.d.next = bit_cast::<32, 16>(self.crc_sent.val()) << 16;
            }
        }

        self.next_address.next = bit_cast::<12, 11>(self.address.q.val()) + 1;
        if self.step_address.val() {
            self.address.d.next = self.next_address.val().get_bits::<11>(0);
            if self.next_address.val().get_bit(11) {
                self.out_of_range.d.next = true;
            }
        }

        // Between frames; a pending write has its address and data.
        if !self.selected.val() {
            self.state.d.next = SpiState::Command;
            self.bit_count.d.next = 0.into();
            self.byte_end.d.next = false;
            self.byte_count.d.next = 0.into();
            self.crc.d.next = 0xffff.into();
            self.load_word.d.next = false;
            self.load_crc.d.next = false;
            self.late.d.next = false;
            if !self.writing.q.val() {
                self.asked.d.next = false;
            }
            self.shift_out.d.next = self.accepted_word.val();
            if self.refused.q.val() {
                self.shift_out.d.next = self.refused_word.val();
            }
        }

        self.words.request.next = self.request.q.val();
        self.words.address_in.next = self.access_address.q.val();
        self.words.write_in.next = self.access_writes.q.val();
        self.words.data_in.next = self.data.q.val();
        self.bank.in_range.next = !self.access_outside.q.val();
        self.miso.next = self.shift_out.q.val().get_bit(31);
        // Combinational: the line is free as soon as the frame ends.
        self.miso_enable.next = !self.cs_n.val();
    }
}

card_top! {
    /// The whole core with an SPI front; [`CardConfig::channels`] sets the number of channels.
    SpiCard, SpiCardParts: front: SpiFront, irq_o
    in {
        /// Serial clock, idle low, asynchronous; at most an eighth of the system clock.
        spi_sck_i: Bit => sck,
        /// Chip select, active low, asynchronous.
        spi_cs_n_i: Bit => cs_n,
        /// Data from the host, sampled at the rising edge, asynchronous.
        spi_mosi_i: Bit => mosi,
    }
    out {
        /// Data to the host; changes after the falling edge.
        spi_miso_o: Bit => miso,
        /// The card drives `spi_miso_o`; combinational from `spi_cs_n_i`.
        spi_miso_oe: Bit => miso_enable,
    }
    pushed {}
    silent { pushed }
}

impl SpiCard {
    /// A card.
    pub fn new(config: &CardConfig) -> Self {
        Self::behind(Default::default(), CardCore::new(config))
    }

    /// A card with other waiting times of its services, for quick tests.
    pub fn with_times(config: &CardConfig, service: &ServiceTimes) -> Self {
        Self::behind(Default::default(), CardCore::with_times(config, service))
    }
}
