//! Core of a card: encoder ports, triggers and registers. A front connects the registers to a host:
//! [`Card`](super::Card) with a UART, the tops in [`super::bus`] with another bus.
//!
//! ```text
//! trigger_i -> Trigger --+--> EncoderPort 0 -> endat_clk0_o, endat_data0_o, endat_data0_oe <- endat_data0_i
//!               ^        +--> EncoderPort 1 -> ...
//!               |             |   ^
//!               |             v   | configuration
//!               |     ChannelRegisters 0, 1
//!               |             ^
//!               +------- RegisterBank <-> the front: word_address, access, read_byte, done, ...
//! +--> Stream (optional): sets of results, by register or pushed through the front
//! +--> DirectOutput 0, 1, Interrupt (optional): to logic and a processor in the same device
//! ```
//!
//! `led_status_o` blinks slowly if every channel is good, quickly if the last result of one is an error;
//! `led_channelN_o` is on while the channel's last result is a good position.

use crate::card::channel_registers::ChannelRegisters;
use crate::card::channel_trigger::ChannelTrigger;
use crate::card::direct::DirectOutput;
use crate::card::interrupt::Interrupt;
use crate::card::recovery_counter::RecoveryCounter;
use crate::card::register_bank::RegisterBank;
use crate::card::second_interface::{record::SecondRecord, SecondInterface};
use crate::card::stream::{buffer::SetParts, channel::SetChannel, run::RunChannel, Stream};
use crate::card::timebase::Timebase;
use crate::card::trigger::Trigger;
use crate::card::whole_result::WholeResult;
use crate::config::CardConfig;
use crate::encoder_port::EncoderPort;
use crate::endat::service::{program::ServiceTimes, Service, CHANNELS_SERVED};
use crate::replicate::each;
use rtl_design::Block;
use rust_hdl::prelude::*;

use super::ports::{AccessIn, PushOut};
use parts::{blink_bit, channel_triggers, port, served_channels};

pub use parts::{bare_port, service_times, services};

/// The card without its front; [`CardConfig::channels`] sets the number of channels.
#[derive(LogicBlock, Block)]
pub struct CardCore {
    /// System clock.
    pub clk_i: Signal<In, Clock>,
    /// Synchronous reset, active high.
    pub rst_i: Signal<In, Bit>,
    /// Trigger pin, asynchronous; a rising edge triggers.
    pub trigger_i: Signal<In, Bit>,
    /// Strobe each microsecond.
    pub tick_us: Signal<Out, Bit>,
    /// A front's access to the register bank.
    #[bundle]
    pub front: AccessIn,
    /// Unrequested frames of the stream; all low without a stream.
    #[bundle]
    pub pushed: PushOut,
    /// Cropped position of the channel, for logic in the same device.
    pub direct_position_o: Vec<Signal<Out, Bits<32>>>,
    /// The cropped position belongs to the last result.
    pub direct_valid_o: Vec<Signal<Out, Bit>>,
    /// Strobe: the cropped position is new.
    pub direct_fresh_o: Vec<Signal<Out, Bit>>,
    /// The cause of the last result is selected as an error, or the alarm is.
    pub direct_error_o: Vec<Signal<Out, Bit>>,
    /// Interrupt; low without this part.
    pub irq_o: Signal<Out, Bit>,
    /// Second interface, serial clock, asynchronous; at most an eighth of the system clock.
    #[optional]
    pub second_sck_i: Vec<Signal<In, Bit>>,
    /// Second interface, chip select, active low, asynchronous.
    #[optional]
    pub second_cs_n_i: Vec<Signal<In, Bit>>,
    /// Second interface, data to the controller; changes after the falling edge.
    #[optional]
    pub second_miso_o: Vec<Signal<Out, Bit>>,
    /// The card drives `second_miso_o`; combinational from `second_cs_n_i`.
    #[optional]
    pub second_miso_oe: Vec<Signal<Out, Bit>>,
    /// EnDat clock to the transceiver; HIGH if the channel speaks T-format.
    pub endat_clk_o: Vec<Signal<Out, Bit>>,
    /// Data to the transceiver.
    pub endat_data_o: Vec<Signal<Out, Bit>>,
    /// Driver enable of the data line.
    pub endat_data_oe: Vec<Signal<Out, Bit>>,
    /// Data from the transceiver, asynchronous.
    pub endat_data_i: Vec<Signal<In, Bit>>,
    /// Blinks: slowly = good, quickly = the last result of a channel is an error.
    pub led_status_o: Signal<Out, Bit>,
    /// The channel's last result is a good position.
    pub led_channel_o: Vec<Signal<Out, Bit>>,
    /// Microsecond strobe and time.
    timebase: Timebase,
    /// Trigger sources of the card.
    #[start]
    trigger: Trigger,
    /// Trigger of each channel, if channels have separate triggers.
    own_trigger: Vec<ChannelTrigger>,
    /// Trigger of each channel.
    trigger_of: Vec<Signal<Local, Bit>>,
    /// High if the channel ignores triggers.
    is_off: Vec<Signal<Local, Bit>>,
    /// Register bank.
    bank: RegisterBank,
    /// Registers of each channel.
    registers: Vec<ChannelRegisters>,
    /// Encoder port of each channel.
    port: Vec<EncoderPort>,
    /// Result with additional data, for each channel with them.
    whole: Vec<WholeResult>,
    /// Read byte of the additional data, from the last channel down to the first.
    info_byte: Vec<Signal<Local, Bits<8>>>,
    /// High if additional data of one of these channels may still come.
    set_open: Vec<Signal<Local, Bit>>,
    /// Services, each for two channels.
    service: Vec<Service>,
    /// Stream, if the card has one.
    stream: Vec<Stream>,
    /// Place of each channel in a set of the stream.
    set: Vec<SetChannel>,
    /// Byte of the set, from the last channel down to the first.
    set_byte: Vec<Signal<Local, Bits<8>>>,
    /// High if one of these channels has not brought its result yet.
    set_owes: Vec<Signal<Local, Bit>>,
    /// High if the result of one of these channels has been replaced.
    set_replaced: Vec<Signal<Local, Bit>>,
    /// High for one cycle when a set is closed.
    set_taken: Vec<Signal<Local, Bit>>,
    /// Requested block of the set.
    set_block: Vec<Signal<Local, Bits<4>>>,
    /// Requested byte of that block.
    set_byte_at: Vec<Signal<Local, Bits<3>>>,
    /// Running clock of each channel.
    run: Vec<RunChannel>,
    /// High if a position of a running clock waits, from the last channel down to the first.
    run_ready: Vec<Signal<Local, Bit>>,
    /// Number of its result.
    run_sequence: Vec<Signal<Local, Bits<16>>>,
    /// Its time stamp.
    run_timestamp: Vec<Signal<Local, Bits<32>>>,
    /// First byte of its set.
    run_head: Vec<Signal<Local, Bits<8>>>,
    /// Place of its channel in a set.
    run_place: Vec<Signal<Local, Bits<7>>>,
    /// High if one of these channels has lost a position.
    run_lost: Vec<Signal<Local, Bit>>,
    /// Direct outputs of each channel.
    direct: Vec<DirectOutput>,
    /// Interrupt, if the card has one.
    interrupt: Vec<Interrupt>,
    /// Read byte of the direct outputs, from the last channel down to the first.
    direct_byte: Vec<Signal<Local, Bits<8>>>,
    /// Read bytes of stream, interrupt and additional data.
    part_byte: Vec<Signal<Local, Bits<8>>>,
    /// Recovery counter of each channel.
    recovery: Vec<RecoveryCounter>,
    /// Read byte of the recovery counters, from the last channel down to the first.
    recovery_byte: Vec<Signal<Local, Bits<8>>>,
    /// Second interface, if the card has one.
    second: Vec<SecondInterface>,
    /// Record of each channel for the second interface.
    record: Vec<SecondRecord>,
    /// Word of the record, from the last channel down to the first.
    record_link: Vec<Signal<Local, Bits<32>>>,
    /// High for one cycle when the host writes a word.
    part_write: Signal<Local, Bit>,
    /// Configuration byte between two channels on the ring.
    ring_link: Vec<Signal<Local, Bits<9>>>,
    /// Read byte of the channels, from the first to the last.
    read_link: Vec<Signal<Local, Bits<8>>>,
    /// Read word of the ports, from the first channel to the last.
    service_link: Vec<Signal<Local, Bits<32>>>,
    /// Read word of each channel's port; 0 unless the channel is selected.
    selected: Vec<Signal<Local, Bits<32>>>,
    /// Port address of the service program, per channel.
    io_address: Vec<Signal<Local, Bits<5>>>,
    /// High for one cycle when the service program reads a port.
    io_read: Vec<Signal<Local, Bit>>,
    /// Word that the service program reads.
    io_in: Vec<Signal<Local, Bits<16>>>,
    /// Word that the service program writes.
    io_out: Vec<Signal<Local, Bits<16>>>,
    /// High for one cycle when the service program writes a port.
    io_write: Vec<Signal<Local, Bit>>,
    /// Read word of ports and services, from the first service to the last.
    word_link: Vec<Signal<Local, Bits<32>>>,
    /// High if the accessed word belongs to a service.
    in_service: Signal<Local, Bit>,
    /// High if one of these channels takes the trigger, from the first to the last.
    taken: Vec<Signal<Local, Bit>>,
    /// High if one of these channels owes a result.
    owes: Vec<Signal<Local, Bit>>,
    /// High if one of these channels has brought its result.
    brought: Vec<Signal<Local, Bit>>,
    /// High for one cycle when a channel takes a trigger.
    new_set: Signal<Local, Bit>,
    /// High if the last result of one of these channels is an error, or it raises an alarm.
    faulty: Vec<Signal<Local, Bit>>,
    /// Time in system clock cycles; its bits make the LED blink.
    now: Signal<Local, Bits<32>>,
    /// Bit of the time that makes the LED blink slowly.
    slow_bit: Constant<Bits<5>>,
    /// Bit of the time that makes the LED blink quickly.
    quick_bit: Constant<Bits<5>>,
    _channels: usize,
    _links: usize,
    _own_triggers: usize,
    _streams: usize,
    _sets: usize,
    _set_links: usize,
    _infos: usize,
    _info_links: usize,
    _set_ends: usize,
    _info_interrupts: usize,
    _set_infos: usize,
    _plain_sets: usize,
    _runs: usize,
    _run_sets: usize,
    _run_links: usize,
    _directs: usize,
    _direct_links: usize,
    _direct_ports: usize,
    _interrupts: usize,
    _seconds: usize,
    _records: usize,
    _record_links: usize,
    _record_infos: usize,
    _recoveries: usize,
    _recovery_links: usize,
    _served: usize,
    _services: usize,
    _pairs: usize,
    _service_links: usize,
    _interrupt_channels: usize,
}

mod build;
mod kernel;
mod parts;
#[cfg(test)]
mod tests;
