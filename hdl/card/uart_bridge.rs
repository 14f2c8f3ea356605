//! UART bridge: register accesses from a host, in the UARTBone byte format.
//!
//! ```text
//! write   01 len  a3 a2 a1 a0  d3 d2 d1 d0  d3 d2 d1 d0 ...          03: all words to one address
//! read    02 len  a3 a2 a1 a0                                        04: all words from one address
//! answer                       d3 d2 d1 d0  d3 d2 d1 d0 ...
//! ```
//!
//! Addresses count words; every field is sent most significant byte first. The bridge drops a command that stops half way
//! after the time-out. After a byte with a framing error within a command it ignores everything until then. An answer that stalls ends after the time-out, too.
//!
//! Between answers it pushes the frames of a [`crate::card::stream::Stream`], each without interruption; an answer then begins with 0xFF.
//!
//! The time-out also stops reading: a late byte would meet the next command, and would be written if that one writes.
//!
//! A word is written within one turn of the configuration ring, which may take longer than the first byte of the next word. That byte
//! waits; the second one arrives after the end of any turn.
//!
//! A byte is read in at most one turn of the configuration ring, while the byte before it is being sent.
//!
//! Ref: LiteX, `litex/soc/cores/uart.py` (gateware) and `litex/tools/remote/comm_uart.py` (client).

use crate::card::ports::{AccessOut, PushIn};
use crate::card::uart::{UartReceiver, UartTransmitter};
use rtl_design::reg::Reg;
use rtl_design::{kernel, Block, States};
use rust_hdl::prelude::*;

/// Longest pause within a command, in microseconds (LiteX: 100 ms).
pub const TIMEOUT_US: u64 = 100_000;
/// Bits of a register's word address; any higher address bit makes an access miss.
pub const ADDRESS_BITS: u32 = 11;

/// Meaning of the next byte.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum BridgeState {
    /// Command code.
    Command,
    /// Number of words.
    Length,
    /// Word address.
    Address,
    /// Data from the host.
    Write,
    /// Data to the host; received bytes are dropped.
    Read,
    /// Bytes are ignored until the time-out.
    Discard,
}

/// UART and UARTBone command interpreter.
#[derive(LogicBlock, Block)]
#[properties("../properties/uart_bridge.sv")]
pub struct UartBridge {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Serial line from the host, asynchronous.
    pub rx: Signal<In, Bit>,
    /// Serial line to the host, from a register.
    pub tx: Signal<Out, Bit>,
    /// A front's access to the register bank.
    #[bundle]
    pub bank: AccessOut,
    /// Unrequested frames of the stream; all low without a stream.
    #[bundle]
    pub pushed: PushIn,
    receiver: UartReceiver,
    transmitter: UartTransmitter,
    /// Meaning of the next byte.
    #[start(BridgeState::Command)]
    state: Reg<BridgeState>,
    /// High if all words of the command have one address.
    fixed: Reg<Bit>,
    /// High if the command writes.
    writing: Reg<Bit>,
    /// Remaining words of the command, including the one under way.
    words_left: Reg<Bits<8>>,
    /// Word address; advances after each word unless `fixed`.
    address: Reg<Bits<11>>,
    /// High if the address is beyond the map: reads give 0, writes have no effect.
    out_of_range: Reg<Bit>,
    /// Byte of the field under way: 0 = most significant.
    byte_lane: Reg<Bits<2>>,
    /// Word to write; shifts up by a byte as bytes arrive or are written.
    data: Reg<Bits<32>>,
    /// Last byte received for a write, until it moves into `data`.
    next_byte: Reg<Bits<8>>,
    /// High while `next_byte` waits.
    has_byte: Reg<Bit>,
    /// High from the start of a write until it is complete.
    write_busy: Reg<Bit>,
    /// High in the cycle after a byte of an answer was handed to the transmitter.
    sent: Reg<Bit>,
    /// High in the cycle after the last byte of a word.
    word_end: Reg<Bit>,
    /// High if one word is left.
    last_word: Reg<Bit>,
    /// High if no word is left.
    no_word: Reg<Bit>,
    /// High for one cycle when the address advances.
    step_address: Reg<Bit>,
    /// High for one cycle before `access_strobe`.
    access_due: Reg<Bit>,
    /// High for one cycle when an access to the register bank begins.
    access_strobe: Reg<Bit>,
    /// High while a byte that was read waits for the transmitter.
    byte_ready: Reg<Bit>,
    /// Microseconds since the last byte of the command.
    idle_us: Reg<Bits<17>>,
    /// High for one cycle when the time-out has ended the command.
    expired: Reg<Bit>,
    /// High if the time-out restarts: a byte was received or sent, or no command is under way.
    stop_timer: Reg<Bit>,
    /// High if the next answer begins with the mark 0xFF: pushing is on, or was since the last answer.
    marked: Reg<Bit>,
    /// High until the mark of the answer under way has been handed to the transmitter.
    marker: Reg<Bit>,
    /// High if the next byte on the line belongs to the stream, not to an answer.
    from_stream: Signal<Local, Bit>,
    /// High for one cycle when a byte of an answer is handed to the transmitter.
    answer_sent: Signal<Local, Bit>,
    /// High at the last byte of an address or word.
    last_lane: Signal<Local, Bit>,
    /// High for one cycle when a byte of an address or word has been received or sent.
    next_lane: Signal<Local, Bit>,
    /// Address of the following word, with carry.
    next_address: Signal<Local, Bits<12>>,
    /// High if the received byte is not 0.
    high_bits: Signal<Local, Bit>,
    /// High for one cycle when `next_byte` moves into `data`.
    data_moves: Signal<Local, Bit>,
    /// Longest pause within a command, in microseconds.
    timeout_us: Constant<Bits<17>>,
}

impl UartBridge {
    /// A bridge with bits of `bit_cycles` system clock cycles that drops a command after a pause of `timeout_us`.
    pub fn new(bit_cycles: u64, timeout_us: u64) -> Self {
        Self::from_parts(UartBridgeParts {
            receiver: UartReceiver::new(bit_cycles),
            transmitter: UartTransmitter::new(bit_cycles),
            timeout_us: Constant::new(timeout_us.into()),
        })
    }
}

#[kernel]
impl Logic for UartBridge {
    fn update(&mut self) {
        clock!(self, clock, receiver, transmitter);
        self.receiver.reset.next = self.reset.val();
        self.transmitter.reset.next = self.reset.val();
        self.share_line();
        self.begin_cycle();
        self.go_on();
        self.count();
        self.step_address();
        self.take_data();
        self.give_up();
        self.ask();
    }

    /// Shares one line between answers and the stream.
    fn share_line(&mut self) {
        self.receiver.rx.next = self.rx.val();
        // A frame that has begun is finished first; none begins while an answer is due.
        self.from_stream.next =
            self.pushed.in_frame.val() | (self.state.q.val() != BridgeState::Read);
        self.transmitter.data.next = self.bank.read_byte.val();
        self.transmitter.valid.next = self.byte_ready.q.val();
        if self.marker.q.val() {
            self.transmitter.data.next = 255.into();
        }
        if self.from_stream.val() {
            connect!(self.transmitter <= self.pushed; data = push_byte, valid = push_valid);
        }
        self.pushed.push_take.next = self.transmitter.accept.val() & self.from_stream.val();
        self.answer_sent.next =
            self.transmitter.accept.val() & !self.from_stream.val() & !self.marker.q.val();
        if self.transmitter.accept.val() & !self.from_stream.val() {
            self.marker.d.next = false;
        }
        // The first answer after the last frame has the mark, too, so that the host can distinguish it from a frame.
        if self.pushed.push.val() {
            self.marked.d.next = true;
        }
        self.tx.next = self.transmitter.tx.val();
    }

    /// Defaults of a cycle.
    fn begin_cycle(&mut self) {
        self.last_lane.next = self.byte_lane.q.val().all();
        // Bytes are tens of cycles apart, so every decision may take a few cycles, which keeps the paths short.
        self.last_word.d.next = self.words_left.q.val() == 1;
        self.no_word.d.next = !self.words_left.q.val().any();
        self.sent.d.next = self.answer_sent.val();
        self.word_end.d.next = false;
        self.step_address.d.next = false;
        self.access_due.d.next = false;
        self.access_strobe.d.next = self.access_due.q.val();
        self.next_lane.next = false;
        self.high_bits.next = self.receiver.data.val().any();
        self.stop_timer.d.next = self.receiver.strobe.val();
    }

    /// Steps of a command.
    fn go_on(&mut self) {
        match self.state.q.val() {
            BridgeState::Command => {
                self.stop_timer.d.next = true;
                if self.receiver.strobe.val() {
                    self.writing.d.next = self.receiver.data.val().get_bit(0);
                    self.fixed.d.next = false;
                    match self.receiver.data.val().index() {
                        1 => {
                            self.state.d.next = BridgeState::Length;
                        }
                        2 => {
                            self.state.d.next = BridgeState::Length;
                        }
                        3 => {
                            self.fixed.d.next = true;
                            self.state.d.next = BridgeState::Length;
                        }
                        4 => {
                            self.fixed.d.next = true;
                            self.state.d.next = BridgeState::Length;
                        }
                        _ => {}
                    }
                }
            }
            BridgeState::Length => {
                if self.receiver.strobe.val() {
                    self.words_left.d.next = self.receiver.data.val();
                    self.byte_lane.d.next = 0.into();
                    self.out_of_range.d.next = false;
                    self.state.d.next = BridgeState::Address;
                }
            }
            BridgeState::Address => {
                if self.receiver.strobe.val() {
                    self.next_lane.next = true;
                    if self.last_lane.val() {
                        self.state.d.next = BridgeState::Read;
                        self.access_due.d.next = !self.writing.q.val() & !self.no_word.q.val();
                        self.marker.d.next = self.marked.q.val();
                        if self.writing.q.val() {
                            self.state.d.next = BridgeState::Write;
                        }
                        if self.no_word.q.val() {
                            self.state.d.next = BridgeState::Command;
                        }
                    }
                }
            }
            BridgeState::Write => {
                if self.receiver.strobe.val() {
                    self.next_lane.next = true;
                    self.word_end.d.next = self.last_lane.val();
                    self.access_due.d.next = self.last_lane.val();
                }
            }
            BridgeState::Read => {
                // Without the time-out an answer would wait forever for a byte that an upset has lost.
                self.stop_timer.d.next = self.transmitter.accept.val();
                if self.sent.q.val() {
                    self.next_lane.next = true;
                    self.word_end.d.next = self.last_lane.val();
                    self.access_due.d.next = !self.last_lane.val();
                }
                if self.word_end.q.val() {
                    self.access_due.d.next = !self.last_word.q.val();
                    self.step_address.d.next = !self.fixed.q.val();
                }
            }
            BridgeState::Discard => {
                self.stop_timer.d.next = false;
            }
            _ => {
                self.state.d.next = BridgeState::Discard;
            }
        }
    }

    /// Counts bytes and words.
    fn count(&mut self) {
        if self.next_lane.val() {
            self.byte_lane.d.next = self.byte_lane.q.val() + 1;
        }
        if self.word_end.q.val() {
            self.words_left.d.next = self.words_left.q.val() - 1;
            if self.last_word.q.val() {
                self.state.d.next = BridgeState::Command;
                if !self.writing.q.val() & !self.pushed.push.val() {
                    self.marked.d.next = false;
                }
            }
        }
    }

    /// Advances the address, except during the access of a written word.
    fn step_address(&mut self) {
        // A written word keeps its address until its access has ended.
        if self.bank.done.val() & self.writing.q.val() {
            self.step_address.d.next = !self.fixed.q.val();
        }
        self.next_address.next = bit_cast::<12, 11>(self.address.q.val()) + 1;
        if self.step_address.q.val() {
            self.address.d.next = self.next_address.val().get_bits::<11>(0);
            if self.next_address.val().get_bit(11) {
                self.out_of_range.d.next = true;
            }
        }
        if (self.state.q.val() == BridgeState::Address) & self.receiver.strobe.val() {
            self.address.d.next = bit_cast::<11, 8>(self.receiver.data.val());
            match self.byte_lane.q.val().index() {
                0 => {
                    self.out_of_range.d.next = self.high_bits.val();
                }
                1 => {
                    self.out_of_range.d.next = self.out_of_range.q.val() | self.high_bits.val();
                }
                2 => {
                    self.out_of_range.d.next =
                        self.out_of_range.q.val() | self.receiver.data.val().get_bits::<5>(3).any();
                }
                _ => {
                    self.address.d.next = bit_cast::<11, 8>(self.receiver.data.val())
                        | (bit_cast::<11, 3>(self.address.q.val().get_bits::<3>(0)) << 8);
                }
            }
        }
    }

    /// Shifts the word that is being written, and keeps its bytes separate from those of the next word.
    fn take_data(&mut self) {
        if self.access_strobe.q.val() & self.writing.q.val() {
            self.write_busy.d.next = true;
        }
        if self.bank.done.val() {
            self.write_busy.d.next = false;
        }
        self.data_moves.next = self.has_byte.q.val() & !self.write_busy.q.val();
        if self.data_moves.val() {
            self.has_byte.d.next = false;
        }
        if self.receiver.strobe.val() & (self.state.q.val() == BridgeState::Write) {
            self.next_byte.d.next = self.receiver.data.val();
            self.has_byte.d.next = true;
        }
        if self.data_moves.val() | self.bank.take_byte.val() {
            self.data.d.next = (self.data.q.val() << 8) | bit_cast::<32, 8>(self.next_byte.q.val());
        }
    }

    /// Ends a command early.
    fn give_up(&mut self) {
        if self.bank.done.val() & (self.state.q.val() == BridgeState::Read) {
            self.byte_ready.d.next = true;
        }
        // The rest of an aborted answer is not part of the next one.
        if self.answer_sent.val() | (self.state.q.val() != BridgeState::Read) {
            self.byte_ready.d.next = false;
        }

        if self.receiver.framing_error.val()
            & (self.state.q.val() != BridgeState::Command)
            & (self.state.q.val() != BridgeState::Read)
        {
            self.state.d.next = BridgeState::Discard;
        }
        self.expired.d.next = self.idle_us.q.val() == self.timeout_us.val();
        if self.tick_us.val() {
            self.idle_us.d.next = self.idle_us.q.val() + 1;
        }
        if self.stop_timer.q.val() | self.expired.q.val() {
            self.idle_us.d.next = 0.into();
            self.expired.d.next = false;
        }
        if self.expired.q.val() {
            self.access_due.d.next = false;
            self.state.d.next = BridgeState::Command;
        }
    }

    /// Starts the access.
    fn ask(&mut self) {
        self.bank.word_address.next = self.address.q.val();
        self.bank.in_range.next = !self.out_of_range.q.val();
        self.bank.lane.next = self.byte_lane.q.val();
        self.bank.access.next = self.access_strobe.q.val();
        self.bank.write.next = self.writing.q.val();
        self.bank.write_data.next = self.data.q.val();
        self.bank.reading.next = self.state.q.val() == BridgeState::Read;
    }
}

#[cfg(test)]
mod tests;
