//! Causes: what can be wrong with a result, and what helps.

use crate::registers::{Named, Place, Values};

/// All causes, 0 = none.
pub fn all() -> &'static [Named] {
    let field = Place::field_at("result", "status", "cause", 0).field;
    match field.map(|f| f.values) {
        Some(Values::Codes(causes)) => causes,
        _ => &[],
    }
}

/// Name of a cause, as counters and files have it.
pub fn name(cause: u8) -> &'static str {
    let known = all().iter().find(|c| c.number == u32::from(cause));
    known.map_or("unknown", |c| c.name)
}

/// Number of the cause with this name.
pub fn number(name: &str) -> Option<u8> {
    all()
        .iter()
        .find(|c| c.name == name)
        .map(|c| c.number as u8)
}

/// What the cause means for a user, and what to do about it.
pub fn advice(name: &str) -> Option<[&'static str; 2]> {
    Some(match name {
        "none" => ["The frame was good.", "Nothing."],
        "data_not_low" => [
            "DATA was HIGH before the frame began: the line is open, the encoder has no supply, or it is lost within a frame.",
            "Look at plug and supply. The card waits 30 ms and tries again.",
        ],
        "no_start_bit" => [
            "The encoder did not answer: it is silent, does not know the mode command, or needs a longer calculation time than configured.",
            "Try the command 000111; raise tcal_max_ns; lower the clock. If no frame gets beyond the slow ones that measure the delay: tcal_max_ns counts there, too (a start bit at clock 15 needs 28000 at 200 kHz), and an encoder that leaves a frame after 2 us of HIGH needs a faster calibration_hz.",
        ],
        "start_window" => [
            "The start bit came at another phase than expected: a glitch, another cable, or a tcal that is not the configured one.",
            "Widen start_window_ns, or filter_ns against glitches. The card measures the line delay again.",
        ],
        "crc" => [
            "The CRC of the answer is wrong: a bit was disturbed, the width is not the encoder's, or the sample is near an edge.",
            "Compare position_bits with the data sheet; look at `margin`; lower the clock; check termination and shield.",
        ],
        "f1" => [
            "The encoder reports an alarm in F1: a malfunction that can make positions wrong.",
            "Read the alarms (`param read 0xB9 0`), then clear them with the command 101101. After power-up an alarm is usual.",
        ],
        "f2" => [
            "The encoder reports an alarm in F2, found independently of F1.",
            "As for f1.",
        ],
        "data_not_falling" => [
            "DATA stayed HIGH after the frame: the encoder has more bits than configured, or a recovery time longer than recovery_max_ns.",
            "Compare position_bits and recovery_max_ns with the data sheet.",
        ],
        "trigger_overrun" => [
            "A trigger came while a frame or a T-format exchange was under way; its position is good.",
            "Trigger more slowly: `explain` shows the highest rate.",
        ],
        "unknown_command" => [
            "The configured command is none of the mode commands, the T-format request is none that a trigger sends, or the period is too short for additional informations; nothing was sent.",
            "Write 7 (000111) or 56 (111000) to config<n>.frame.command, 4 or more to .period_cycles; on a T-format channel 3 to config<n>.timing.request_id.",
        ],
        "info_missing" => [
            "An additional information that was expected did not come: the frame has another length than it should have, so its position is not taken.",
            "The card finds out in the next frames what the encoder sends.",
        ],
        "no_encoder" => [
            "Nothing is plugged in: DATA is HIGH, and LOW when the card drives it.",
            "Plug the encoder in; the card goes on by itself.",
        ],
        "stuck_high" => [
            "DATA stays HIGH although the card drives it LOW.",
            "Look for a short circuit to the supply, and for the driver enable.",
        ],
        "stuck_low" => [
            "DATA stays LOW: not even the card's own mode command is heard.",
            "Look for a short circuit, a swapped pair, and that the receiver stays enabled while sending.",
        ],
        "late_start" => [
            "The start bit came after the limit, but it came.",
            "Raise tcal_max_ns to the encoder's.",
        ],
        "watchdog" => [
            "The frame took longer than limits.watchdog_us.",
            "Look at limits.watchdog_us and at the encoder's times.",
        ],
        "own_echo" => [
            "What came back is the card's own mode command.",
            "Look for a converter that sends back what it gets, or a pair that is swapped.",
        ],
        "upset" => [
            "A register of the card, or a word on its way to the host, was disturbed: what is stored does not fit its CRC or parity.",
            "Nothing, if it is rare: the next trigger brings a new position. If it is not: supply, clock and timing of the device.",
        ],
        "recovery_too_short" => [
            "DATA fell before limits.recovery_min_cycles: the encoder has another recovery time than the card; the position is good.",
            "Set recovery_min_ns to what the encoder is set to.",
        ],
        "line_not_idle" => [
            "The T-format line was LOW, or had not been idle for long enough after a bad reply, when a request was to go out; nothing was sent.",
            "Trigger more slowly after faults; look for a short circuit, and for an encoder that still sends.",
        ],
        "no_answer" => [
            "The T-format encoder did not answer within the reply gap.",
            "Look at plug, supply and the pair; compare bit_hz with the data sheet; raise reply_gap_us.",
        ],
        "no_header" => [
            "Something came from the T-format encoder, but no control field with start bit and sync code.",
            "Compare bit_hz with the data sheet; look at termination and shield; raise filter_ns against short pulses.",
        ],
        "control_parity" => [
            "The parity of the ID in the reply is wrong: a bit was disturbed.",
            "Look at termination and shield.",
        ],
        "reply_echo" => [
            "The reply repeats another request ID or EEPROM address than was sent.",
            "Look for a second encoder on the pair, or for a disturbed line.",
        ],
        "delimiter" => [
            "A field of the reply ends with a LOW bit: it was disturbed, or the rate is another one.",
            "Compare bit_hz with the data sheet; look at termination and shield.",
        ],
        "field_missing" => [
            "A field of the reply did not begin in time.",
            "Raise field_gap_us; does the encoder know this request?",
        ],
        "reply_crc" => [
            "The CRC of the T-format reply is wrong: a bit was disturbed.",
            "Look at termination and shield; t_format<n>.fields shows what came.",
        ],
        "request_parity" => [
            "The encoder says that the parity of the request was wrong: the way to the encoder is disturbed.",
            "Look at termination and shield, and that the driver stays enabled while sending.",
        ],
        "request_delimiter" => [
            "The encoder says that the delimiter of the request was wrong: the way to the encoder is disturbed.",
            "As for request_parity; compare bit_hz with the data sheet.",
        ],
        "eeprom_busy" => [
            "The encoder's EEPROM is busy with the last byte; the data mean nothing.",
            "Send the request again some milliseconds later.",
        ],
        "counting_error" => [
            "The encoder reports a counting error; the position is taken.",
            "Turn the power off and on, or send request 7 ten times in a row.",
        ],
        "multi_turn_alarm" => [
            "The encoder reports a multi-turn, overflow or battery alarm; the position is taken, and its turns may be wrong.",
            "Look at t_format<n>.fields.alarm and at the battery; then send request 7 or 12 ten times in a row.",
        ],
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cause_has_advice() {
        assert_eq!(all().len(), 32);
        for cause in all() {
            assert!(advice(cause.name).is_some(), "{}", cause.name);
            assert_eq!(name(cause.number as u8), cause.name);
        }
        assert_eq!(name(32), "unknown");
    }
}
