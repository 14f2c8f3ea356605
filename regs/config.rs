//! Configuration of the card and of its channels.

use crate::named::codes;
use crate::protocol::POSITION_COMMANDS;
use crate::{field, word, Access, Block, BLOCK_STRIDE, CONFIG_BASE};
use Access::ReadWrite;

/// Kinds of range of a channel's position.
pub mod range {
    use super::codes;

    codes! {
        /// All of them.
        ALL: u8;
        UNKNOWN = 0, "unknown", "not given: the encoder's name plate has it, or nobody";
        ROTARY = 1, "rotary", "multi_turn_bits count turns, the bits below them the angle";
        LINEAR = 2, "linear", "no bit counts turns, and the position does not wrap";
    }
}

/// Configuration of the card.
pub const CARD_CONFIG: Block = Block {
    name: "card_config",
    base: CONFIG_BASE,
    stride: BLOCK_STRIDE,
    per_channel: false,
    meaning: "Configuration of the card.",
    is_ram: false,
    part: None,
    registers: &[
        word(
            "trigger_sources",
            0,
            ReadWrite,
            "Enabled trigger sources; one trigger starts all channels that take it in the same clock cycle.",
            &[
                field("pin", 0, 1, "", "Rising edge of the trigger pin"),
                field("timer", 1, 1, "", "Every trigger_period"),
                field("register", 2, 1, "", "trigger_now"),
                field("disabled", 8, 8, "", "Channels that take no trigger, bit n for channel n; with part own_trigger only"),
            ],
        ),
        word(
            "trigger_period",
            1,
            ReadWrite,
            "Period of the timer, at least 4; write it while the timer is disabled.",
            &[field("value", 0, 24, "cycles", "Period")
            .takes(&[(4, 0xFF_FFFF)])],
        ),
        word(
            "hold",
            2,
            ReadWrite,
            "Keeps the results of all channels, for a host that reads word by word.",
            &[
                field("hold", 0, 1, "", "1: results and trigger_count stand still"),
                field("scratch", 8, 24, "", "Free for the host: a driver tries the link with it, a recording leaves a mark that a restart clears"),
            ],
        ),
    ],
};

/// Configuration of a channel; taken over between two frames.
pub const CHANNEL_CONFIG: Block = Block {
    name: "config",
    base: CONFIG_BASE + BLOCK_STRIDE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Configuration of a channel; taken over between two frames.",
    is_ram: false,
    part: None,
    registers: &[
        word(
            "frame",
            0,
            ReadWrite,
            "What is asked of the encoder, and how fast.",
            &[
                field("period_cycles", 0, 11, "cycles", "EnDat clock period; the high phase is the longer one when odd; T-format: a bit, 8..127")
                .takes(&[(2, 2047)]).by_protocol("period_cycles"),
                field("skip", 11, 5, "", "Triggers left out after each that the channel takes; with part own_trigger only, as the ignored sources"),
                field("position_bits", 16, 6, "bits", "Position width, 1..48; T-format: bits of angle and turns together if limits.range says rotary, else no meaning, as command")
                .takes(&[(1, 48)]).by_protocol("position_bits"),
                field("ignore_pin", 22, 1, "", "1: the trigger pin is not for this channel"),
                field("ignore_timer", 23, 1, "", "1: the timer is not"),
                field("command", 24, 6, "", "Mode command, sent most significant bit first")
                .codes(POSITION_COMMANDS).by_protocol("command"),
                field("ignore_register", 30, 1, "", "1: trigger_now is not"),
            ],
        ),
        word(
            "timing",
            1,
            ReadWrite,
            "First low phase and tolerance of the start bit; bits that count turns.",
            &[
                field("first_low_extra_cycles", 0, 11, "cycles", "First low phase minus half a period (tST)"),
                field("multi_turn_bits", 11, 5, "bits", "Upper bits of the position that count turns, if limits.range says rotary; for the host only. T-format: of bits 47..24, up to 24")
                .by_protocol("multi_turn_bits"),
                field("start_window_cycles", 16, 6, "cycles", "The start edge must come within plus or minus this of its expected phase"),
                field("filter_half", 23, 1, "", "1: half a cycle more; with part double_edge only"),
                field("filter_cycles", 24, 4, "cycles", "Pulses on DATA up to this length are ignored; 0 = off"),
                field("request_id", 28, 4, "", "T-format: request ID of a trigger; 6 and 13 are not sent")
                .by_protocol("request_id"),
            ],
        ),
        word(
            "limits",
            2,
            ReadWrite,
            "Longest waits; what the position is.",
            &[
                field("start_timeout_us", 0, 12, "us", "Longest wait for the start bit after the turnaround; T-format: longest pause before the reply, 1..63")
                .by_protocol("start_timeout_us"),
                field("range", 12, 2, "", "What the position is; for the host only")
                .codes(range::ALL),
                field("recovery_limit_cycles", 16, 13, "cycles", "DATA must fall within this after the frame (tm)"),
                field("field_gap_us", 29, 3, "us", "T-format: longest pause between two fields"),
            ],
        ),
    ],
};
