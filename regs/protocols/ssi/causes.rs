//! Causes of SSI frames.
//!
//! The code of a flag is its number plus one, and the lowest flag is the primary cause: it explains those above it.

crate::causes::cause::causes! {
    NONE = 0, "none", "none";
        same;
    UNKNOWN_FRAME = 1, "unknown_frame", "unknown kind of frame";
        "Nothing was clocked: config<n>.frame.command of an SSI channel has no bit 2, or the stored configuration was disturbed.",
        "Write the configuration again: 4 to config<n>.frame.command, 5 for Gray code, 6 and 7 for the same sent twice.";
    DATA_NOT_HIGH = 2, "data_not_high", "data not high before the frame";
        "DATA of an SSI encoder was LOW when a frame was to begin (nothing was clocked), or at the first rising edge of CLOCK. The encoder still holds its last position or has no supply, or the pair is swapped or shorted.",
        "Check plug, supply and pair; trigger more slowly; compare recovery_max_ns with the encoder's monoflop time.";
    DATA_NOT_LOW_AFTER = 3, "data_not_low_after", "data not low after the last bit";
        "DATA was HIGH after the last bit, or between two copies: no encoder is connected, it has another width than configured or keeps its last bit on the line, or its bits arrive too late for this clock.",
        "Check plug and supply; compare position_bits and end_low with the data sheet; lower clock_hz.";
    PARITY = 4, "position_parity", "parity of the position";
        "A parity bit does not match the bits before it: a bit was disturbed, or the encoder has no parity or the other polarity.",
        "Check termination and shield; lower clock_hz; compare parity and bits_after with the data sheet.";
    COPIES_DIFFER = 5, "copies_differ", "the two copies differ";
        "The encoder sent the position twice, and the copies differ: a bit was disturbed, or the encoder samples a new position for each copy.",
        "Check termination and shield; lower clock_hz; remove twice if the encoder does not repeat the position.";
    UPSET = 6, "upset", "stored data upset";
        same;
    TRIGGER_OVERRUN = 7, "trigger_overrun", "trigger overrun";
        same;
    RECOVERY_TOO_LONG = 8, "recovery_too_long", "recovery time too long";
        "After a frame DATA was still LOW when recovery_max_ns had passed: the line is broken or shorted, or the encoder needs longer than configured. The position of that frame is withdrawn. The next result has this cause, too, with a good position.",
        "Check plug and pair; raise recovery_max_ns to the encoder's monoflop time.";
    ALARM = 9, "encoder_alarm", "alarm of the encoder";
        "The bit that bits_before or bits_after names alarm is active: the encoder cannot guarantee its position. The card rejects it.",
        "Look up the bit in the encoder's data sheet; compare bits_before, bits_after and position_bits with it.";
    POWER_FAIL = 10, "power_fail", "power failure of the encoder";
        "The bit that bits_before or bits_after names power_fail is active: the encoder's supply is too low. The card rejects the position.",
        "Check supply, cable and plug, and the voltage at the encoder; compare bits_before, bits_after and position_bits with the data sheet.";
    NOT_VALID = 11, "position_not_valid", "the encoder marks the position not valid";
        "The bit that bits_before or bits_after names valid is not set: the encoder is starting, moves too fast, or has lost its magnet or scale. The card rejects the position.",
        "Look up the bit in the encoder's data sheet; compare bits_before, bits_after and position_bits with it.";
    CRC = 12, "position_crc", "CRC of the position";
        "The CRC in bits_after does not match the bits before it: a bit was disturbed, or the frame has other bits than configured.",
        "Check termination and shield; lower clock_hz; compare bits_before, bits_after and position_bits with the data sheet.";
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
pub const HARMLESS: u64 = flag(TRIGGER_OVERRUN) | flag(RECOVERY_TOO_LONG);
