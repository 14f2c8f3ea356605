//! Ports that travel together between a card's front, its core and its stream.
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
    /// Word address; what stood there in the cycle before `access` counts until `done`.
    pub word_address: Bits<11>,
    /// The front's address fits `word_address`; otherwise a read gives 0 and a write does nothing. It counts like the address.
    pub in_range: Bit,
    /// Byte of the word, 0 = most significant; 0 in a write.
    pub lane: Bits<2>,
    /// One-cycle strobe: begin an access, with the address stable since the cycle before. Before `done` of the last one it does nothing.
    pub access: Bit,
    /// With `access`: write a word; low = read a byte.
    pub write: Bit,
    /// Word to write; moves up by a byte in each cycle with `take_byte`.
    pub write_data: Bits<32>,
    /// The host is reading: results must not change.
    pub reading: Bit,
    /// A byte of the configuration word passes the head, most significant first: in a write that of `write_data` replaces it.
    #[back]
    pub take_byte: Bit,
    /// With `take_byte`: the byte that stood there.
    #[back]
    pub passing_byte: Bits<8>,
    /// Byte that was read, from `done` to the next `access`.
    #[back]
    pub read_byte: Bits<8>,
    /// One-cycle strobe: the access has ended.
    #[back]
    pub done: Bit,
}

/// Frames of the stream that are sent without being asked for; all low without a stream.
#[ports]
pub struct Push {
    /// Frames are to be pushed.
    pub push: Bit,
    /// A frame is being pushed: its first byte has been taken, its last one has not.
    pub in_frame: Bit,
    /// `push_byte` is the next byte to push.
    pub push_valid: Bit,
    /// The next byte.
    pub push_byte: Bits<8>,
    /// Strobe, with `push_valid` only: the byte is taken.
    #[back]
    pub push_take: Bit,
}

/// Words that are not the bank's own.
#[ports]
pub struct ServiceWords {
    /// The word is one of a line monitor or of a port of another protocol, not of a service.
    pub service_line: Bit,
    /// Word of a service's RAM, a line monitor or a port of another protocol.
    pub service_address: Bits<7>,
    /// The channel that it belongs to, one bit per channel.
    pub service_channels: Bits<8>,
    /// Strobe: an access begins; the word that was read before is not asked for any more.
    pub service_clear: Bit,
    /// Strobe, one bit per channel: read it.
    pub service_read: Bits<8>,
    /// The word read.
    #[back]
    pub service_word: Bits<32>,
    /// Strobe, one bit per channel: write one half of it; the high one comes first.
    pub service_write: Bits<8>,
    /// The half: 1 = high.
    pub service_half: Bit,
    /// What is written.
    pub service_data: Bits<16>,
}
