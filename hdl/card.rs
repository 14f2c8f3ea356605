//! Card: encoder ports with triggers, registers and stream, connected to a host link.
//!
//! ```text
//! host <-> front (uart_bridge, or one of bus) <-> RegisterBank, ChannelRegisters, Stream <-> EncoderPort 0, 1, ...
//! ```
//!
//! Reading order: [`card_core`] (connections), [`register_bank`] and [`channel_registers`], [`trigger`], [`stream`]; then a front:
//! [`uart_bridge`] or one of [`bus`].

pub mod bus;
pub mod card_core;
pub mod channel_registers;
pub mod channel_trigger;
pub mod config_ring;
pub mod direct;
pub mod interrupt;
pub mod ports;
pub mod recovery_counter;
pub mod register_bank;
pub mod second_interface;
pub mod stream;
pub mod timebase;
pub(crate) mod top;
pub mod trigger;
pub mod uart;
pub mod uart_bridge;
mod uart_card;
pub mod whole_result;

pub use card_core::{bare_port, service_times, services, CardCore};
pub use uart_card::Card;
