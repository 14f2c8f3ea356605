//! The EnDat receiver core, described in rust-hdl.
//!
//! ```text
//! trigger -> Transaction -> ClockGen ------> endat_clk
//!                |   \----> CommandSender -> data_o, data_oe
//!                |
//!                +-- LineDelay <- InputFilter <- data_i
//!                |       | sample strobes
//!                +-- Receiver -> Crc5 -> Snapshot -> registers -> host link
//! ```
//!
//! Reading order: [`protocol`] and [`timing`] (facts), then the blocks
//! from left to right in the drawing, [`channel`], [`card`]. [`rtl_design`] has the registers, and turns any block into a typed `Design`.

pub mod add_info;
pub mod bus;
pub mod card;
pub mod channel;
pub mod channel_registers;
pub mod channel_trigger;
pub mod clock_gen;
pub mod command_sender;
pub mod command_shape;
pub mod config;
pub mod config_ring;
pub mod crc5;
pub mod direct;
pub mod encoder_port;
pub mod features;
pub mod frame_ports;
pub mod frame_settings;
pub mod half_period;
pub mod input_filter;
pub mod interrupt;
pub mod line_delay;
pub mod line_health;
pub mod line_monitor;
pub mod phase_tracker;
pub mod ports;
pub use endat_regs::protocol;
pub mod receiver;
pub mod recovery_counter;
pub mod register_bank;
pub mod regs;
pub mod second_interface;
pub mod second_receiver;
pub mod sequencer;
pub mod service;
mod several;
pub mod snapshot;
pub mod stream;
pub mod sure_bit;
pub mod t_format;
#[cfg(test)]
mod testing;
pub mod timebase;
pub mod timing;
pub mod transaction;
pub mod trigger;
pub mod uart;
pub mod uart_bridge;
pub mod whole_result;
