//! Forms of a configuration: a key belongs to some of them.

use endat_regs::Protocol;

/// A receiver and its channel.
pub const RECEIVER_FORM: u8 = 0x80;
/// Any card.
pub const CARD_FORM: u8 = !RECEIVER_FORM;
/// A channel of a card that speaks EnDat.
pub const ENDAT_FORM: u8 = form(Protocol::Endat);

/// A channel of a card that speaks this protocol.
pub const fn form(protocol: Protocol) -> u8 {
    1 << protocol as u8
}
