//! Receiver for encoders with the asynchronous protocol known as T-format (Tamagawa).
//!
//! ```text
//! trigger, request -> Exchange -> tx, driver
//!                      ^   |
//! rx -> InputFilter ---+-> ReplyBytes -> ResultBanks -> DSP bus
//! ```
//!
//! Reading order: [`protocol`] and [`cause`] (facts), [`bit_grid`], [`field_order`], [`request_bits`] (parts), [`exchange`] (order
//! and checks), [`reply_bytes`], [`verdict_bytes`], [`result_banks`] (words for a processor), [`dsp`]; [`port`] is the same encoder
//! as a channel of a card, [`channel`] a receiver whose results are signals.

pub mod asked;
pub mod bit_grid;
pub use endat_regs::protocols::t_format::causes as cause;
pub mod channel;
pub(crate) mod config;
pub mod dsp;
pub mod exchange;
pub mod field_order;
pub mod outcome;
pub mod port;
pub mod ports;
pub mod protocol;
pub mod reply;
pub mod reply_bytes;
pub mod request_bits;
pub mod result_banks;
pub mod verdict_bytes;
