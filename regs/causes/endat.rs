//! Causes of EnDat frames.

use super::cause::coded;
use crate::Named;

super::cause::causes! {
    NONE = 0, "none", "none";
        "The frame was good.",
        "Nothing.";
    DATA_NOT_LOW = 1, "data_not_low", "data not low before start";
        "DATA was HIGH before the frame began: the line is open, the encoder has no supply, or it is lost within a frame.",
        "Look at plug and supply. The card waits 30 ms and tries again.";
    NO_START_BIT = 2, "no_start_bit", "no start bit";
        "The encoder did not answer: no encoder is connected and the open line reads LOW; or it rejects the mode command; or it needs a longer calculation time than configured.",
        "Without an encoder: fit the fail-safe bias, so that an open line reads HIGH. Otherwise try the command 000111, raise tcal_max_ns or lower the clock. If even the slow frames that measure the delay fail: tcal_max_ns applies to them, too (a start bit at clock 15 needs 28000 at 200 kHz). An encoder that ends a frame after 2 us of HIGH needs a faster calibration_hz.";
    START_WINDOW = 3, "start_window", "start bit outside its window";
        "The start bit came at another phase than expected: a glitch, another cable, or another tcal than configured.",
        "Increase start_window_ns, or filter_ns against glitches. The card measures the line delay again.";
    CRC = 4, "crc", "CRC";
        "The CRC of the answer is wrong: a bit was disturbed, the width is not the encoder's, or DATA is sampled near an edge.",
        "Compare position_bits with the data sheet; look at `margin`; lower the clock; check termination and shield.";
    F1 = 5, "f1", "F1";
        "The encoder reports an alarm in F1: a malfunction that can lead to wrong positions.",
        "Read the alarms (`param read 0xB9 0`), then clear them with the command 101101. An alarm after power-up is normal.";
    F2 = 6, "f2", "F2";
        "The encoder reports an alarm in F2, found independently of F1.",
        "See f1.";
    DATA_NOT_FALLING = 7, "data_not_falling", "data not falling after the frame";
        "DATA stayed HIGH after the frame for longer than recovery_max_ns: the encoder sends more bits than configured or has a longer recovery time. With the flag tail_low DATA was LOW one clock after the CRC: the encoder has another width, or does not hold DATA HIGH for its recovery time. The flags also show a wrong CRC and alarms of the same frame.",
        "Compare position_bits and recovery_max_ns with the data sheet. An EnDat encoder does not end its frame LOW.";
    TRIGGER_OVERRUN = 8, "trigger_overrun", "trigger overrun";
        "A trigger arrived while a frame or a T-format exchange was under way; its position is good.",
        "Trigger more slowly; `explain` prints the highest rate.";
    UNKNOWN_COMMAND = 9, "unknown_command", "unknown mode command";
        "Nothing was sent: the configured command is not a mode command, the T-format request is not one that a trigger may send, or the period is too short for additional data.",
        "Write 7 (000111) or 56 (111000) to config<n>.frame.command, 4 or more to .period_cycles; on a T-format channel 3 to config<n>.timing.request_id.";
    INFO_MISSING = 10, "info_missing", "additional data missing";
        "The expected additional data did not arrive: the frame has another length than it should have, so its position is rejected.",
        "The card detects from the next frames what the encoder sends.";
    NO_ENCODER = 11, "no_encoder", "no encoder";
        "No encoder is connected: DATA is HIGH, and LOW when the card drives it.",
        "Connect the encoder; the card continues without intervention.";
    STUCK_HIGH = 12, "stuck_high", "data stuck high";
        "DATA stays HIGH while the card drives it LOW.",
        "Check for a short circuit to the supply, and check the driver enable.";
    STUCK_LOW = 13, "stuck_low", "data stuck low";
        "DATA stays LOW: the card does not even receive its own mode command.",
        "Check for a short circuit or a swapped pair, and that the receiver stays enabled while sending.";
    LATE_START = 14, "late_start", "late start bit";
        "The start bit came after the limit.",
        "Raise tcal_max_ns to the value of the encoder.";
    WATCHDOG = 15, "watchdog", "watchdog";
        "The frame exceeded limits.watchdog_us.",
        "Compare limits.watchdog_us with the encoder's times.";
    OWN_ECHO = 16, "own_echo", "echo of the own command";
        "The card received its own mode command.",
        "Check for a converter that echoes what it receives, or for a swapped pair.";
    RECOVERY_TOO_SHORT = 17, "recovery_too_short", "recovery time too short";
        "DATA fell before limits.recovery_min_cycles: the encoder has another recovery time than configured; the position is good.",
        "Set recovery_min_ns to the encoder's setting.";
    UPSET = 31, "upset", "stored data upset";
        "A register of the card, or a word on its way to the host, was disturbed: the stored value does not match its CRC or parity.",
        "If it is rare, nothing: the next trigger brings a new position. Otherwise check supply, clock and timing of the device. With a second receiver the cause also means that the receivers disagreed, or that `force` made them disagree.";
}

/// Number of counted causes: codes below it have a counter register each.
pub const COUNT: u64 = 18;

/// Raw flag of a cause.
pub const fn flag(cause: u64) -> u64 {
    match cause {
        NONE => 0,
        1..=8 => 1 << (cause - 1),
        UPSET => 1 << (COUNT + 1),
        _ => 1 << (cause + 1),
    }
}

/// Raw flags without a cause.
pub mod flag {
    /// The parallel CRC is wrong.
    pub const PARALLEL_CRC: u64 = 1 << 8;
    /// DATA was LOW after the last bit: the frame has another length.
    pub const TAIL_LOW: u64 = 1 << 9;
}

/// All causes, by code.
pub const CODED: &[Named] = &coded::<{ ALL.len() }>(ALL);
