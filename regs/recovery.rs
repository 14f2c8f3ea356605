//! The words of the independent recovery time measurement.

use crate::part::Part;
use crate::{field, word, Access::ReadOnly, Block, BLOCK_STRIDE, RECOVERY_BASE};

/// Distance of the start values of two channels' counters: more than 30 us at any system clock.
pub const COUNTER_SPACING: u16 = 1 << 13;

/// Recovery counter of a channel.
pub const RECOVERY: Block = Block {
    name: "recovery",
    base: RECOVERY_BASE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Recovery time of a channel, measured independently of the core: a free-running counter, captured at the edges. Not valid for T-format channels.",
    is_ram: false,
    part: Some(Part::RecoveryCounter),
    registers: &[
        word("edges", 0, ReadOnly, "Counter at the edges that begin and end the recovery time; the difference, modulo 65536, is that time plus the line delay.", &[
            field("rise", 0, 16, "cycles", "At the last rising edge of CLOCK"),
            field("fall", 16, 16, "cycles", "At the last falling edge of DATA while the receiver's driver was off"),
        ]),
        word("counter", 1, ReadOnly, "Current counter value; two reads with the same value mean that the counter has stopped: a fault.", &[
            field("value", 0, 16, "cycles", "Starts at 8192 times the channel number"),
            field("fallen", 16, 1, "", "DATA has fallen since the last rising edge of CLOCK, and is LOW"),
        ]),
    ],
};
