//! Configuration of the card and of its channels.

use crate::named::codes;
use crate::protocol::POSITION_COMMANDS;
use crate::{field, word, Access, Block, BLOCK_STRIDE, CONFIG_BASE};
use Access::ReadWrite;

/// Kinds of range of a channel's position.
pub mod range {
    use super::codes;

    codes! {
        /// All kinds of range.
        ALL: u8;
        UNKNOWN = 0, "unknown", "not given here; the name plate may have it";
        ROTARY = 1, "rotary", "multi_turn_bits count turns, the bits below them the angle";
        LINEAR = 2, "linear", "no turn bits; the position does not wrap";
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
            "Enabled trigger sources; one trigger starts all channels that accept it in the same clock cycle.",
            &[
                field("pin", 0, 1, "", "Rising edge of the trigger pin"),
                field("timer", 1, 1, "", "Every trigger_period"),
                field("register", 2, 1, "", "trigger_now"),
                field("disabled", 8, 8, "", "Channels that ignore triggers, bit n for channel n; with part own_trigger only"),
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
            "Holds the results of all channels, for a host that reads word by word.",
            &[
                field("hold", 0, 1, "", "1: results and trigger_count are frozen"),
                field("scratch", 8, 24, "", "Free for the host: link test of a driver, restart mark of a recording"),
            ],
        ),
    ],
};

/// Configuration of a channel; takes effect between two frames.
pub const CHANNEL_CONFIG: Block = Block {
    name: "config",
    base: CONFIG_BASE + BLOCK_STRIDE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Configuration of a channel; takes effect between two frames.",
    is_ram: false,
    part: None,
    registers: &[
        word(
            "frame",
            0,
            ReadWrite,
            "Command to the encoder, and clock rate.",
            &[
                field("period_cycles", 0, 11, "cycles", "EnDat clock period; if odd, the high phase is longer; T-format: a bit, 8..127")
                .takes(&[(2, 2047)]).by_protocol("period_cycles"),
                field("skip", 11, 5, "", "Triggers to skip after each accepted one; with part own_trigger only, as the ignored sources"),
                field("position_bits", 16, 6, "bits", "Position width, 1..48; T-format: bits of angle and turns together if limits.range is rotary, else unused, as command")
                .takes(&[(1, 48)]).by_protocol("position_bits"),
                field("ignore_pin", 22, 1, "", "1: the channel ignores the trigger pin"),
                field("ignore_timer", 23, 1, "", "1: the channel ignores the timer"),
                field("command", 24, 6, "", "Mode command, sent most significant bit first")
                .codes(POSITION_COMMANDS).by_protocol("command"),
                field("ignore_register", 30, 1, "", "1: the channel ignores trigger_now"),
            ],
        ),
        word(
            "timing",
            1,
            ReadWrite,
            "First low phase and tolerance of the start bit; bits that count turns.",
            &[
                field("first_low_extra_cycles", 0, 11, "cycles", "First low phase minus half a period (tST)"),
                field("multi_turn_bits", 11, 5, "bits", "Upper bits of the position that count turns, if limits.range is rotary; only the host uses it. T-format: of bits 47..24, up to 24")
                .by_protocol("multi_turn_bits"),
                field("start_window_cycles", 16, 6, "cycles", "Tolerance of the start edge around its expected phase"),
                field("filter_half", 23, 1, "", "1: half a cycle more; with part double_edge only"),
                field("filter_cycles", 24, 4, "cycles", "Pulses on DATA up to this length are ignored; 0 = off"),
                field("request_id", 28, 4, "", "T-format: request ID of a trigger; 6 and 13 are rejected")
                .by_protocol("request_id"),
            ],
        ),
        word(
            "limits",
            2,
            ReadWrite,
            "Timeouts; kind of position.",
            &[
                field("start_timeout_us", 0, 12, "us", "Longest wait for the start bit after the turnaround; T-format: longest pause before the reply, 1..63")
                .by_protocol("start_timeout_us"),
                field("range", 12, 2, "", "Kind of position; only the host uses it")
                .codes(range::ALL),
                field("recovery_limit_cycles", 16, 13, "cycles", "DATA must fall within this time after the frame (tm)"),
                field("field_gap_us", 29, 3, "us", "T-format: longest pause between two fields"),
            ],
        ),
    ],
};
