//! Causes of T-format exchanges.
//!
//! The code of a flag is its number plus one, and the lowest flag is the primary cause: it explains those above it.

crate::causes::cause::causes! {
    NONE = 0, "none", "none";
        same;
    UNKNOWN_REQUEST = 1, "unknown_command", "unknown request";
        same;
    LINE_NOT_IDLE = 2, "line_not_idle", "line not idle";
        "The T-format line was LOW, or had not been idle for long enough after a bad reply, when a request was to go out; nothing was sent.",
        "Trigger more slowly after faults; look for a short circuit, and for an encoder that still sends.";
    NO_ANSWER = 3, "no_answer", "no answer";
        "The T-format encoder did not answer within the reply gap.",
        "Look at plug, supply and the pair; compare bit_hz with the data sheet; raise reply_gap_us.";
    HEADER = 4, "no_header", "no header";
        "Something came from the T-format encoder, but no control field with start bit and sync code.",
        "Compare bit_hz with the data sheet; look at termination and shield; raise filter_ns against short pulses.";
    CONTROL_PARITY = 5, "control_parity", "parity of the control field";
        "The parity of the ID in the reply is wrong: a bit was disturbed.",
        "Look at termination and shield.";
    ECHO = 6, "reply_echo", "another ID or address in the reply";
        "The reply repeats another request ID or EEPROM address than was sent.",
        "Look for a second encoder on the pair, or for a disturbed line.";
    DELIMITER = 7, "delimiter", "delimiter";
        "A field of the reply ends with a LOW bit: it was disturbed, or the rate is another one.",
        "Compare bit_hz with the data sheet; look at termination and shield.";
    FIELD_TIMEOUT = 8, "field_missing", "field missing";
        "A field of the reply did not begin in time.",
        "Raise field_gap_us; does the encoder know this request?";
    CRC = 9, "reply_crc", "CRC";
        "The CRC of the T-format reply is wrong: a bit was disturbed.",
        "Look at termination and shield; t_format<n>.fields shows what came.";
    REQUEST_PARITY = 10, "request_parity", "encoder saw a parity error";
        "The encoder says that the parity of the request was wrong: the way to the encoder is disturbed.",
        "Look at termination and shield, and that the driver stays enabled while sending.";
    REQUEST_DELIMITER = 11, "request_delimiter", "encoder saw a delimiter error";
        "The encoder says that the delimiter of the request was wrong: the way to the encoder is disturbed.",
        "As for request_parity; compare bit_hz with the data sheet.";
    EEPROM_BUSY = 12, "eeprom_busy", "EEPROM busy";
        "The encoder's EEPROM is busy with the last byte; the data mean nothing.",
        "Send the request again some milliseconds later.";
    COUNTING_ERROR = 13, "counting_error", "counting error";
        "The encoder reports a counting error; the position is taken.",
        "Turn the power off and on, or send request 7 ten times in a row.";
    MULTI_TURN_ALARM = 14, "multi_turn_alarm", "multi-turn or battery alarm";
        "The encoder reports a multi-turn, overflow or battery alarm; the position is taken, and its turns may be wrong.",
        "Look at t_format<n>.fields.alarm and at the battery; then send request 7 or 12 ten times in a row.";
    UPSET = 15, "upset", "stored data upset";
        same;
    TRIGGER_OVERRUN = 16, "trigger_overrun", "trigger overrun";
        same;
}

/// Codes there are.
pub const COUNT: u64 = ALL.len() as u64;

/// Raw flag of a cause; 0 for none.
pub const fn flag(cause: u64) -> u64 {
    match cause {
        NONE => 0,
        _ => 1 << (cause - 1),
    }
}

/// Flags with which the position is taken.
pub const HARMLESS: u64 = flag(COUNTING_ERROR) | flag(MULTI_TURN_ALARM) | flag(TRIGGER_OVERRUN);
