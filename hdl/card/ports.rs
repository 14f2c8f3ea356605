//! Bundles of ports between a card's front, its core and its stream.
//!
//! ```text
//! front --Access--> CardCore, RegisterBank        Stream --Push--> CardCore, front
//! RegisterBank --ServiceWords--> services, line monitors and ports of other protocols
//! ```

use rtl_design::ports;
use rust_hdl::prelude::*;

/// A front's access to the register bank.
#[ports]
pub struct Access {
    /// Word address; the value in the cycle before `access` applies until `done`.
    pub word_address: Bits<11>,
    /// The front's address fits `word_address`; otherwise a read gives 0 and a write has no effect. Timing as for the address.
    pub in_range: Bit,
    /// Byte of the word, 0 = most significant; 0 in a write.
    pub lane: Bits<2>,
    /// One-cycle strobe: begin an access, with the address stable since the cycle before. Ignored before `done` of the last access.
    pub access: Bit,
    /// With `access`: write a word; low = read a byte.
    pub write: Bit,
    /// Word to write; shifts up by a byte in each cycle with `take_byte`.
    pub write_data: Bits<32>,
    /// The host is reading: results must not change.
    pub reading: Bit,
    /// A byte of the configuration word passes the head, most significant first; a write replaces it by that of `write_data`.
    #[back]
    pub take_byte: Bit,
    /// With `take_byte`: the byte before the write.
    #[back]
    pub passing_byte: Bits<8>,
    /// Byte that was read, from `done` to the next `access`.
    #[back]
    pub read_byte: Bits<8>,
    /// One-cycle strobe: the access has ended.
    #[back]
    pub done: Bit,
}

/// Unrequested frames of the stream; all low without a stream.
#[ports]
pub struct Push {
    /// Push mode is on.
    pub push: Bit,
    /// A frame is being pushed: between its first and its last byte.
    pub in_frame: Bit,
    /// `push_byte` is the next byte to push.
    pub push_valid: Bit,
    /// The next byte.
    pub push_byte: Bits<8>,
    /// Strobe, with `push_valid` only: the byte is accepted.
    #[back]
    pub push_take: Bit,
}

/// Access to words of services, line monitors and ports of other protocols.
#[ports]
pub struct ServiceWords {
    /// The word belongs to a line monitor or to a port of another protocol, not to a service.
    pub service_line: Bit,
    /// Word of a service's RAM, a line monitor or a port of another protocol.
    pub service_address: Bits<7>,
    /// Channel of the word, one bit per channel.
    pub service_channels: Bits<8>,
    /// Strobe: an access begins; the previously read word is no longer needed.
    pub service_clear: Bit,
    /// Strobe, one bit per channel: read the word.
    pub service_read: Bits<8>,
    /// The word read.
    #[back]
    pub service_word: Bits<32>,
    /// Strobe, one bit per channel: write one half of the word; the high one comes first.
    pub service_write: Bits<8>,
    /// Half to write: 1 = high.
    pub service_half: Bit,
    /// Data to write.
    pub service_data: Bits<16>,
}
