//! Why an exchange gave no position, or what the encoder says about it: codes and raw flags.
//!
//! The code of a flag is its number plus one, and the lowest flag is the primary cause: it explains those above it.

use crate::transaction::cause as card;

/// All is well.
pub const NONE: u64 = 0;
/// The ID is none that the receiver knows; nothing went out.
pub const UNKNOWN_REQUEST: u64 = 1;
/// The line was not idle when the request was to go out; nothing went out.
pub const LINE_NOT_IDLE: u64 = 2;
/// Nothing came within the reply gap.
pub const NO_ANSWER: u64 = 3;
/// Something came within the reply gap, but it did not begin with start bit and sync code.
pub const HEADER: u64 = 4;
/// The parity of the ID in the reply is wrong.
pub const CONTROL_PARITY: u64 = 5;
/// The reply repeats another ID or EEPROM address.
pub const ECHO: u64 = 6;
/// A field ends with a LOW bit.
pub const DELIMITER: u64 = 7;
/// A field did not begin in time.
pub const FIELD_TIMEOUT: u64 = 8;
/// The CRC of the reply is wrong.
pub const CRC: u64 = 9;
/// The encoder says that the parity of the request was wrong.
pub const REQUEST_PARITY: u64 = 10;
/// The encoder says that the delimiter of the request was wrong.
pub const REQUEST_DELIMITER: u64 = 11;
/// The EEPROM is busy; its data mean nothing.
pub const EEPROM_BUSY: u64 = 12;
/// The encoder reports a counting error; the position is taken.
pub const COUNTING_ERROR: u64 = 13;
/// The encoder reports a multi-turn, overflow or battery alarm; the position is taken.
pub const MULTI_TURN_ALARM: u64 = 14;
/// What is stored does not fit its check, or the receiver has been led astray: a register was upset. Hides 13 and 14.
pub const UPSET: u64 = 15;
/// A trigger came while an exchange was under way; the position is taken.
pub const TRIGGER_OVERRUN: u64 = 16;
/// Codes there are.
pub const COUNT: u64 = 17;

/// Raw flag of a cause; 0 for none.
pub const fn flag(cause: u64) -> u64 {
    if cause == NONE {
        0
    } else {
        1 << (cause - 1)
    }
}

/// Flags with which the position is taken.
pub const HARMLESS: u64 = flag(COUNTING_ERROR) | flag(MULTI_TURN_ALARM) | flag(TRIGGER_OVERRUN);

/// The same cause in the result of a card, see [`crate::transaction::cause`]: what EnDat has too keeps its number there.
pub const fn of_card(code: u64) -> u64 {
    match code {
        NONE => card::NONE,
        UNKNOWN_REQUEST => card::UNKNOWN_COMMAND,
        TRIGGER_OVERRUN => card::TRIGGER_OVERRUN,
        _ => CARD_FIRST - LINE_NOT_IDLE + code,
    }
}

/// Cause of a card that stands for [`LINE_NOT_IDLE`]; the others follow it.
pub const CARD_FIRST: u64 = card::COUNT;

const _: () = assert!(of_card(UPSET) == card::UPSET);

/// Name of a code.
pub const fn name(code: u64) -> &'static str {
    match code {
        NONE => "none",
        UNKNOWN_REQUEST => "unknown request",
        LINE_NOT_IDLE => "line not idle",
        NO_ANSWER => "no answer",
        HEADER => "no header",
        CONTROL_PARITY => "parity of the control field",
        ECHO => "another ID or address in the reply",
        DELIMITER => "delimiter",
        FIELD_TIMEOUT => "field missing",
        CRC => "CRC",
        REQUEST_PARITY => "encoder saw a parity error",
        REQUEST_DELIMITER => "encoder saw a delimiter error",
        EEPROM_BUSY => "EEPROM busy",
        COUNTING_ERROR => "counting error",
        MULTI_TURN_ALARM => "multi-turn or battery alarm",
        UPSET => "stored data upset",
        TRIGGER_OVERRUN => "trigger overrun",
        _ => "unknown",
    }
}
