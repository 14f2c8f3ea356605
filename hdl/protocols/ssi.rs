//! Receiver for encoders with SSI, the synchronous serial interface.
//!
//! ```text
//! clk   ~~~~~\_/~\_/~\_ ... _/~\_/~~~~~~~~~~~~~~~~~~~~~~    HIGH at rest; one falling edge more than there are bits
//! data  ~~~~~~~~~<msb ><    ...  ><lsb>\___________/~~~~    HIGH at rest; a bit from each rising edge on, then LOW for the
//!            ^ taken by the encoder                         recovery time tm
//! ```
//!
//! Each bit is taken where the clock rises for the next one, so that cable and encoder have a whole period for it. A frame that goes on within
//! tm brings the same position once more, after one LOW bit: two copies that differ give no position.
//!
//! Reading order: [`protocol`] and [`cause`] (facts), [`asked`] (what a configuration asks for), [`specials`] (bits that are not position),
//! [`port`] (an encoder as a channel of a card).

pub mod asked;
pub use endat_regs::protocols::ssi::causes as cause;
pub(crate) mod config;
pub mod port;
pub mod protocol;
pub mod special_bits;
pub mod specials;
