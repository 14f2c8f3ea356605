//! The host's side of a card: everything between a serial port and an angle in degrees.
//!
//! ```text
//! serial port, TCP, a card in the same process
//!        v  Transport
//!     Bridge    words, in the UARTBone byte format; separates answers from pushed sample sets
//!        v
//!      Card     registers by name, results of one instant, name plate, requests
//!        v
//!     Scale     degrees, turns, millimetres
//! ```
//!
//! This crate does not depend on the design of the card; [`endat_regs`] supplies names and places of its registers, causes and parts.

pub mod bridge;
pub mod card;
pub mod causes;
mod error;
pub mod explain;
pub mod feed;
pub mod mailbox;
pub mod motion;
pub mod name_plate;
pub mod owner;
pub mod panda;
pub mod protocols;
pub mod range;
pub mod ready;
pub mod registers;
pub mod result;
pub mod stream;
pub mod t_format;
pub mod transport;
pub mod units;
mod witness;

pub use bridge::Bridge;
pub use card::Card;
pub use error::HostError;
pub use transport::Transport;
