//! Core of a card: encoder ports, each for EnDat or T-format, triggers and registers. A front connects the registers to a host:
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
//!               +--> Stream, if there is one: sets of results, by register or pushed through the front
//!               +--> DirectOutput 0, 1, Interrupt, if there are any: to logic and a processor in the same device
//! ```
//!
//! `led_status_o` blinks slowly while every channel is well, quickly while the last result of one is an error;
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
use crate::several::each;
use rtl_design::Block;
use rust_hdl::prelude::*;

use super::ports::{AccessIn, PushOut};
use parts::{blink_bit, channel_triggers, port, served_channels};

pub use parts::{bare_port, service_times, services};

/// The card but for its front; the number of channels is that of [`CardConfig::channels`].
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
    /// Frames of the stream that are sent without being asked for; all low without a stream.
    #[bundle]
    pub pushed: PushOut,
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
    /// Second interface, serial clock, asynchronous; at most an eighth of the system clock.
    #[optional]
    pub second_sck_i: Vec<Signal<In, Bit>>,
    /// Second interface, chip select, active low, asynchronous.
    #[optional]
    pub second_cs_n_i: Vec<Signal<In, Bit>>,
    /// Second interface, data to the controller; changes after the falling edge.
    #[optional]
    pub second_miso_o: Vec<Signal<Out, Bit>>,
    /// The card drives `second_miso_o`, straight from `second_cs_n_i`.
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
    /// Blinks: slowly = well, quickly = the last result of a channel is an error.
    pub led_status_o: Signal<Out, Bit>,
    /// The channel's last result is a good position.
    pub led_channel_o: Vec<Signal<Out, Bit>>,
    timebase: Timebase,
    #[start]
    trigger: Trigger,
    own_trigger: Vec<ChannelTrigger>,
    trigger_of: Vec<Signal<Local, Bit>>,
    is_off: Vec<Signal<Local, Bit>>,
    bank: RegisterBank,
    registers: Vec<ChannelRegisters>,
    port: Vec<EncoderPort>,
    whole: Vec<WholeResult>,
    info_byte: Vec<Signal<Local, Bits<8>>>,
    set_open: Vec<Signal<Local, Bit>>,
    service: Vec<Service>,
    stream: Vec<Stream>,
    set: Vec<SetChannel>,
    set_byte: Vec<Signal<Local, Bits<8>>>,
    set_owes: Vec<Signal<Local, Bit>>,
    set_replaced: Vec<Signal<Local, Bit>>,
    set_taken: Vec<Signal<Local, Bit>>,
    set_block: Vec<Signal<Local, Bits<4>>>,
    set_byte_at: Vec<Signal<Local, Bits<3>>>,
    run: Vec<RunChannel>,
    run_ready: Vec<Signal<Local, Bit>>,
    run_sequence: Vec<Signal<Local, Bits<16>>>,
    run_moment: Vec<Signal<Local, Bits<32>>>,
    run_head: Vec<Signal<Local, Bits<8>>>,
    run_place: Vec<Signal<Local, Bits<7>>>,
    run_lost: Vec<Signal<Local, Bit>>,
    direct: Vec<DirectOutput>,
    interrupt: Vec<Interrupt>,
    direct_byte: Vec<Signal<Local, Bits<8>>>,
    part_byte: Vec<Signal<Local, Bits<8>>>,
    recovery: Vec<RecoveryCounter>,
    recovery_byte: Vec<Signal<Local, Bits<8>>>,
    second: Vec<SecondInterface>,
    record: Vec<SecondRecord>,
    record_link: Vec<Signal<Local, Bits<32>>>,
    part_write: Signal<Local, Bit>,
    ring_link: Vec<Signal<Local, Bits<9>>>,
    read_link: Vec<Signal<Local, Bits<8>>>,
    service_link: Vec<Signal<Local, Bits<32>>>,
    selected: Vec<Signal<Local, Bits<32>>>,
    io_address: Vec<Signal<Local, Bits<5>>>,
    io_read: Vec<Signal<Local, Bit>>,
    io_in: Vec<Signal<Local, Bits<16>>>,
    io_out: Vec<Signal<Local, Bits<16>>>,
    io_write: Vec<Signal<Local, Bit>>,
    word_link: Vec<Signal<Local, Bits<32>>>,
    in_service: Signal<Local, Bit>,
    taken: Vec<Signal<Local, Bit>>,
    owes: Vec<Signal<Local, Bit>>,
    brought: Vec<Signal<Local, Bit>>,
    new_set: Signal<Local, Bit>,
    faulty: Vec<Signal<Local, Bit>>,
    now: Signal<Local, Bits<32>>,
    slow_bit: Constant<Bits<5>>,
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
