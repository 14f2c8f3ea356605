//! Causes of T-format exchanges.
//!
//! The code of a flag is its number plus one, and the lowest flag is the primary cause: it explains those above it.

crate::causes::cause::causes! {
    NONE = 0, "none", "none";
        same;
    UNKNOWN_REQUEST = 1, "unknown_command", "unknown request";
        same;
    LINE_NOT_IDLE = 2, "line_not_idle", "line not idle";
        "Nothing was sent: the T-format line was LOW, or had not been idle for long enough after a bad reply.",
        "Trigger more slowly after faults; check for a short circuit, and for an encoder that is still sending.";
    NO_ANSWER = 3, "no_answer", "no answer";
        "The T-format encoder did not answer within the reply gap.",
        "Check plug, supply and pair; compare bit_hz with the data sheet; raise reply_gap_us.";
    HEADER = 4, "no_header", "no header";
        "The T-format encoder sent something, but no control field with start bit and sync code.",
        "Compare bit_hz with the data sheet; check termination and shield; raise filter_ns against short pulses.";
    CONTROL_PARITY = 5, "control_parity", "parity of the control field";
        "The parity of the ID in the reply is wrong: a bit was disturbed.",
        "Check termination and shield.";
    ECHO = 6, "reply_echo", "another ID or address in the reply";
        "The reply has another request ID or EEPROM address than the request.",
        "Check for a second encoder on the pair, or for a disturbed line.";
    DELIMITER = 7, "delimiter", "delimiter";
        "A field of the reply ends with a LOW bit: it was disturbed, or the bit rate differs.",
        "Compare bit_hz with the data sheet; check termination and shield.";
    FIELD_TIMEOUT = 8, "field_missing", "field missing";
        "A field of the reply did not begin in time.",
        "Raise field_gap_us; check whether the encoder supports this request.";
    CRC = 9, "reply_crc", "CRC";
        "The CRC of the T-format reply is wrong: a bit was disturbed.",
        "Check termination and shield; t_format<n>.fields shows the received fields.";
    REQUEST_PARITY = 10, "request_parity", "encoder saw a parity error";
        "The encoder reports a parity error in the request: the line to the encoder is disturbed.",
        "Check termination and shield, and that the driver stays enabled while sending.";
    REQUEST_DELIMITER = 11, "request_delimiter", "encoder saw a delimiter error";
        "The encoder reports a delimiter error in the request: the line to the encoder is disturbed.",
        "See request_parity; compare bit_hz with the data sheet.";
    EEPROM_BUSY = 12, "eeprom_busy", "EEPROM busy";
        "The encoder's EEPROM is still writing the last byte; the data in the reply are invalid.",
        "Send the request again after some milliseconds.";
    COUNTING_ERROR = 13, "counting_error", "counting error";
        "The encoder reports a counting error; the position is valid.",
        "Turn the power off and on, or send request 7 ten times in a row.";
    MULTI_TURN_ALARM = 14, "multi_turn_alarm", "multi-turn or battery alarm";
        "The encoder reports a multi-turn, overflow or battery alarm; the position is valid, but its turns may be wrong.",
        "Check t_format<n>.fields.alarm and the battery; then send request 7 or 12 ten times in a row.";
    UPSET = 15, "upset", "stored data upset";
        same;
    TRIGGER_OVERRUN = 16, "trigger_overrun", "trigger overrun";
        same;
}

/// Number of codes.
pub const COUNT: u64 = ALL.len() as u64;

/// Raw flag of a cause; 0 for none.
pub const fn flag(cause: u64) -> u64 {
    match cause {
        NONE => 0,
        _ => 1 << (cause - 1),
    }
}

/// Flags of a result with a valid position.
pub const HARMLESS: u64 = flag(COUNTING_ERROR) | flag(MULTI_TURN_ALARM) | flag(TRIGGER_OVERRUN);
