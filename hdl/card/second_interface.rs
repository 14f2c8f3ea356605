//! Second interface: the results of the channels for a second controller, over a separate read-only SPI.
//!
//! ```text
//! cs_n  ~~\__________________________________________________________________/~~
//! miso    5E c r r | hash | 8 words of channel 0 | 0 . k k | 8 words of channel 1 | 1 . k k | 0 ...
//! ^ all channels are latched here, in one cycle
//! ```
//!
//! Mode 0, 32-bit words, most significant bit first. `c` channels; `r r` counts completed reads, so that two consecutive answers always
//! differ. The words are those of the register block `result`, followed by the channel's number and `k k`: CRC-16/CCITT-FALSE (polynomial
//! 0x1021, start 0xFFFF) over everything since the previous check sum. The controller may stop anywhere.
//!
//! Only clock and select enter the card here, so the second controller cannot affect the first one.

pub mod record;

use crate::card::stream::buffer::CRC16_POLYNOMIAL;
use crate::regs::RESULT;
use rtl_design::reg::{Reg, SyncReg};
use rtl_design::{kernel, Block, States};
use rust_hdl::prelude::*;

/// First byte of an answer.
pub const MARK: u8 = 0x5E;

/// Words of a channel, without its check sum.
pub const RECORD_WORDS: usize = RESULT.registers.len();

/// Word on the line.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum SecondState {
    /// Mark, channels, count.
    Head,
    /// Configuration hash.
    Hash,
    /// A word of a channel.
    Record,
    /// Number of the channel, check sum.
    CheckSum,
    /// No more words.
    Rest,
}

/// The SPI slave of the second interface.
#[derive(LogicBlock, Block)]
pub struct SecondInterface {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// Serial clock, idle low, asynchronous; at most an eighth of the system clock.
    pub sck: Signal<In, Bit>,
    /// Chip select, active low, asynchronous.
    pub cs_n: Signal<In, Bit>,
    /// Data to the controller; changes after the falling edge.
    pub miso: Signal<Out, Bit>,
    /// The card drives `miso`; combinational from `cs_n`.
    pub miso_enable: Signal<Out, Bit>,
    /// Strobe: the records latch the results of the channels.
    pub take: Signal<Out, Bit>,
    /// Channel whose word is next.
    pub channel: Signal<Out, Bits<4>>,
    /// Next word of the channel; after the last one the check sum.
    pub word_at: Signal<Out, Bits<4>>,
    /// Value of that word.
    pub word: Signal<In, Bits<32>>,
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
    /// Chip select one cycle before `cs_1`.
    cs_2: Reg<Bit>,
    /// Word on the line.
    #[start(SecondState::Head)]
    state: Reg<SecondState>,
    /// Bits of the word sent so far.
    bit_count: Reg<Bits<5>>,
    /// CRC since the last check sum.
    #[start(0xffffu64.into())]
    crc: Reg<Bits<16>>,
    /// Bits still to be sent of the word, the one on the line at the top.
    shift_out: Reg<Bits<32>>,
    /// Answers that have ended, wrapping.
    reads: Reg<Bits<16>>,
    /// Channel whose word is sent next.
    channel_at: Reg<Bits<4>>,
    /// Word of the record that is sent next; after the last one the check sum.
    next_word: Reg<Bits<4>>,
    /// High for one cycle at a rising edge of the serial clock.
    rise: Signal<Local, Bit>,
    /// High for one cycle at a falling edge of the serial clock.
    fall: Signal<Local, Bit>,
    /// High if the check sum is sent next.
    at_check_sum: Signal<Local, Bit>,
    /// Number of channels.
    channels: Constant<Bits<4>>,
    /// Number of words in a record: the index of its check sum.
    check_sum: Constant<Bits<4>>,
    /// First half of the first word: mark and number of channels.
    head: Constant<Bits<16>>,
    /// Configuration hash.
    hash: Constant<Bits<32>>,
    /// Generator of the CRC, without x^16.
    polynomial: Constant<Bits<16>>,
}

impl SecondInterface {
    /// The second interface of a card with `channels` channels and this configuration hash.
    pub fn new(channels: usize, hash: u64) -> Self {
        let head = u64::from(MARK) << 8 | channels as u64;
        Self::from_parts(SecondInterfaceParts {
            channels: Constant::new((channels as u64).into()),
            check_sum: Constant::new((RECORD_WORDS as u64).into()),
            head: Constant::new(head.into()),
            hash: Constant::new(hash.into()),
            polynomial: Constant::new(CRC16_POLYNOMIAL.into()),
        })
    }
}

#[kernel]
impl Logic for SecondInterface {
    fn update(&mut self) {
        self.sck_0.d.next = self.sck.val();
        self.sck_1.d.next = self.sck_0.q.val();
        self.sck_2.d.next = self.sck_1.q.val();
        self.cs_0.d.next = !self.cs_n.val();
        self.cs_1.d.next = self.cs_0.q.val();
        self.cs_2.d.next = self.cs_1.q.val();
        self.rise.next = self.sck_1.q.val() & !self.sck_2.q.val();
        self.fall.next = !self.sck_1.q.val() & self.sck_2.q.val();
        self.take.next = self.cs_1.q.val() & !self.cs_2.q.val();

        if self.rise.val() {
            self.bit_count.d.next = self.bit_count.q.val() + 1;
            self.crc.d.next = self.crc.q.val() << 1;
            if self.crc.q.val().get_bit(15) ^ self.shift_out.q.val().get_bit(31) {
                self.crc.d.next = (self.crc.q.val() << 1) ^ self.polynomial.val();
            }
        }

        // The output changes with the falling edge.
        self.at_check_sum.next = self.next_word.q.val() == self.check_sum.val();
        if self.fall.val() {
            self.shift_out.d.next = self.shift_out.q.val() << 1;
            if self.bit_count.q.val() == 0 {
                self.shift_out.d.next = self.word.val();
                self.next_word.d.next = self.next_word.q.val() + 1;
                self.state.d.next = SecondState::Record;
                if self.at_check_sum.val() {
                    self.state.d.next = SecondState::CheckSum;
                    self.channel_at.d.next = self.channel_at.q.val() + 1;
                    self.next_word.d.next = 0.into();
                }
                match self.state.q.val() {
                    SecondState::Head => {
                        self.state.d.next = SecondState::Hash;
                        self.shift_out.d.next = self.hash.val();
                        self.next_word.d.next = 0.into();
                    }
                    SecondState::CheckSum => {
                        self.crc.d.next = 0xffff.into();
                        if self.channel_at.q.val() == self.channels.val() {
                            self.state.d.next = SecondState::Rest;
                        }
                    }
                    SecondState::Rest => {
                        self.state.d.next = SecondState::Rest;
                        self.next_word.d.next = 0.into();
                        self.shift_out.d.next = 0.into();
                    }
                    _ => {}
                }
            }
            if (self.bit_count.q.val() == 16) & (self.state.q.val() == SecondState::CheckSum) {
                self.shift_out.d.next = bit_cast::<32, 16>(self.crc.q.val()) << 16;
            }
        }

        if !self.cs_1.q.val() {
            self.state.d.next = SecondState::Head;
            self.bit_count.d.next = 0.into();
            self.crc.d.next = 0xffff.into();
            self.channel_at.d.next = 0.into();
            self.next_word.d.next = 0.into();
            self.shift_out.d.next = (bit_cast::<32, 16>(self.head.val()) << 16)
                | bit_cast::<32, 16>(self.reads.q.val());
        }
        if self.cs_2.q.val() & !self.cs_1.q.val() {
            self.reads.d.next = self.reads.q.val() + 1;
        }

        self.channel.next = self.channel_at.q.val();
        self.word_at.next = self.next_word.q.val();
        self.miso.next = self.shift_out.q.val().get_bit(31);
        // Combinational: the line is free as soon as the controller releases it.
        self.miso_enable.next = !self.cs_n.val();
    }
}
