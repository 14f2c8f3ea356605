//! Driver for cards with EnDat receivers: `no_std`, no heap, any bus.
//!
//! A [`Link`] of the user, which reads and writes words, accesses the card. Everything else follows from the register table
//! (`endat-regs`) and from the card's identification, so one driver serves every card. [`Mapped`] is the link of a memory-mapped card,
//! [`Spi`], [`Parallel`] and [`Uart`] are those of other buses.
//!
//! ```
//! use embedded_hal::delay::DelayNs;
//! use endat_driver::{Card, Error, Link};
//!
//! /// The angle of encoder 0, when it is available.
//! fn angle<L: Link, D: DelayNs>(link: L, delay: D) -> Result<i64, Error<L::Error>> {
//!     let mut card = Card::open(link, delay, None)?;
//!     card.wait_ready(0, 5_000)?;
//!     let moment = card.measure(1_000)?;
//!     let result = &moment.results()[0];
//!     Ok(endat_driver::signed(result.position, result.width_bits))
//! }
//! ```
//!
//! Only one master may access a card. Every call that waits has a limit. It is counted in the waits of the [`embedded_hal::delay::DelayNs`] with
//! which the card was opened, so a slow bus makes it longer, never shorter. A call retries failed accesses if that is
//! safe; successful writes have been read back.

#![no_std]

mod answer;
mod card;
mod error;
mod facts;
mod frame;
mod link;
mod map;
mod parallel;
mod plate;
mod range;
mod result;
mod service;
mod settings;
mod spi;
mod stream;
mod t_format;
mod uart;

pub use answer::Answer;
pub use card::Card;
pub use endat_regs as regs;
pub use endat_regs::{protocol::ModeCommand, Part};
pub use error::Error;
pub use facts::Facts;
pub use link::{Link, Mapped};
pub use parallel::{Parallel, Registers};
pub use plate::{NamePlate, Number};
pub use range::{Range, Turns};
pub use result::{
    difference, readings, signed, AdditionalData, Moment, Reading, MOMENT_WORDS, RESULT_WORDS,
};
pub use service::{Request, State};
pub use settings::{Settings, Sources};
pub use spi::Spi;
pub use stream::{Sample, Set, Stream, SET_BYTES};
pub use t_format::{Fields, Reply, TFormatSettings};
pub use uart::{Serial, Uart};
