//! Receiver for encoders with the asynchronous protocol known as T-format (Tamagawa).
//!
//! ```text
//! trigger, request -> Exchange -> tx, driver
//!                      ^   |
//! rx -> InputFilter ---+-> Reply -> Outcome -> registers -> DSP bus
//! ```
//!
//! Reading order: [`protocol`] and [`cause`] (facts), [`bit_grid`], [`field_order`], [`request_bits`] (parts), [`exchange`] (order
//! and checks), [`channel`], [`dsp`]; [`port`] is the same encoder as a channel of a card.

pub mod bit_grid;
pub use endat_regs::causes::t_format as cause;
pub mod channel;
pub mod dsp;
pub mod exchange;
pub mod field_order;
pub mod outcome;
pub mod port;
pub mod primary;
pub mod protocol;
pub mod reply;
pub mod request_bits;
