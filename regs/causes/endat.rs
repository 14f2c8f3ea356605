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
        "The encoder did not answer: it is silent, does not know the mode command, or needs a longer calculation time than configured; or there is none, and the open line reads LOW.",
        "With no encoder: fit the fail-safe bias, which makes an open line HIGH. Otherwise try the command 000111; raise tcal_max_ns; lower the clock. If no frame gets beyond the slow ones that measure the delay: tcal_max_ns counts there, too (a start bit at clock 15 needs 28000 at 200 kHz), and an encoder that leaves a frame after 2 us of HIGH needs a faster calibration_hz.";
    START_WINDOW = 3, "start_window", "start bit outside its window";
        "The start bit came at another phase than expected: a glitch, another cable, or a tcal that is not the configured one.",
        "Widen start_window_ns, or filter_ns against glitches. The card measures the line delay again.";
    CRC = 4, "crc", "CRC";
        "The CRC of the answer is wrong: a bit was disturbed, the width is not the encoder's, or the sample is near an edge.",
        "Compare position_bits with the data sheet; look at `margin`; lower the clock; check termination and shield.";
    F1 = 5, "f1", "F1";
        "The encoder reports an alarm in F1: a malfunction that can make positions wrong.",
        "Read the alarms (`param read 0xB9 0`), then clear them with the command 101101. After power-up an alarm is usual.";
    F2 = 6, "f2", "F2";
        "The encoder reports an alarm in F2, found independently of F1.",
        "As for f1.";
    DATA_NOT_FALLING = 7, "data_not_falling", "data not falling after the frame";
        "DATA stayed HIGH after the frame for longer than recovery_max_ns: the encoder has more bits than configured, or a longer recovery time. With the flag tail_low DATA was LOW a clock after the CRC instead: the encoder has another width, or does not hold DATA HIGH for its recovery time. The flags of the result also show a wrong CRC and alarms of the same frame.",
        "Compare position_bits and recovery_max_ns with the data sheet. An encoder that ends its frame LOW is none of EnDat.";
    TRIGGER_OVERRUN = 8, "trigger_overrun", "trigger overrun";
        "A trigger came while a frame or a T-format exchange was under way; its position is good.",
        "Trigger more slowly: `explain` shows the highest rate.";
    UNKNOWN_COMMAND = 9, "unknown_command", "unknown mode command";
        "The configured command is none of the mode commands, the T-format request is none that a trigger sends, or the period is too short for additional data; nothing was sent.",
        "Write 7 (000111) or 56 (111000) to config<n>.frame.command, 4 or more to .period_cycles; on a T-format channel 3 to config<n>.timing.request_id.";
    INFO_MISSING = 10, "info_missing", "additional data missing";
        "Additional data that were expected did not come: the frame has another length than it should have, so its position is not taken.",
        "The card finds out in the next frames what the encoder sends.";
    NO_ENCODER = 11, "no_encoder", "no encoder";
        "Nothing is plugged in: DATA is HIGH, and LOW when the card drives it.",
        "Plug the encoder in; the card goes on by itself.";
    STUCK_HIGH = 12, "stuck_high", "data stuck high";
        "DATA stays HIGH although the card drives it LOW.",
        "Look for a short circuit to the supply, and for the driver enable.";
    STUCK_LOW = 13, "stuck_low", "data stuck low";
        "DATA stays LOW: not even the card's own mode command is heard.",
        "Look for a short circuit, a swapped pair, and that the receiver stays enabled while sending.";
    LATE_START = 14, "late_start", "late start bit";
        "The start bit came after the limit, but it came.",
        "Raise tcal_max_ns to the encoder's.";
    WATCHDOG = 15, "watchdog", "watchdog";
        "The frame took longer than limits.watchdog_us.",
        "Look at limits.watchdog_us and at the encoder's times.";
    OWN_ECHO = 16, "own_echo", "echo of the own command";
        "The card received its own mode command.",
        "Look for a converter that sends back what it gets, or a pair that is swapped.";
    RECOVERY_TOO_SHORT = 17, "recovery_too_short", "recovery time too short";
        "DATA fell before limits.recovery_min_cycles: the encoder has another recovery time than the card; the position is good.",
        "Set recovery_min_ns to what the encoder is set to.";
    UPSET = 31, "upset", "stored data upset";
        "A register of the card, or a word on its way to the host, was disturbed: what is stored does not fit its CRC or parity.",
        "Nothing, if it is rare: the next trigger brings a new position. If it is not: supply, clock and timing of the device. With a second receiver it also tells that the two disagreed, or were made to by `force`.";
}

/// Codes of frames: those below are counted, each by a register of its own.
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

/// Raw flags that are no cause of their own.
pub mod flag {
    /// The parallel CRC is wrong.
    pub const PARALLEL_CRC: u64 = 1 << 8;
    /// Data was not high after the last bit: the frame has another length.
    pub const TAIL_LOW: u64 = 1 << 9;
}

/// All of them, under the codes of a result.
pub const CODED: &[Named] = &coded::<{ ALL.len() }>(ALL);
