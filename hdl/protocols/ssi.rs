//! Receiver for encoders with SSI, the synchronous serial interface.
//!
//! ```text
//! clk   ~~~~~\_/~\_/~\_ ... _/~\_/~~~~~~~~~~~~~~~~~~~~~~    HIGH at rest; one more falling edge than bits
//! data  ~~~~~~~~~<msb ><    ...  ><lsb>\___________/~~~~    HIGH at rest; a bit from each rising edge on, then LOW for the
//!            ^ taken by the encoder                         recovery time tm
//! ```
//!
//! Each bit is sampled at the next rising edge of the clock, so that cable and encoder have a whole period for it. A frame that continues within
//! tm repeats the same position, after one LOW bit; if the two copies differ there is no position.
//!
//! Reading order: [`protocol`] and [`cause`] (facts), [`asked`] (request of a configuration), [`specials`] (bits that are not position),
//! [`port`] (an encoder as a channel of a card).

pub mod asked;
pub use endat_regs::protocols::ssi::causes as cause;
pub(crate) mod config;
pub mod port;
pub mod protocol;
pub mod special_bits;
pub mod specials;
