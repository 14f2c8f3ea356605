//! The words of the recovery time's second measurement.

use crate::part::Part;
use crate::{field, word, Access::ReadOnly, Block, BLOCK_STRIDE, RECOVERY_BASE};

/// Cycles between the start values of the counters of two channels: more than 30 us at any system clock.
pub const COUNTER_SPACING: u16 = 1 << 13;

/// Recovery counter of a channel.
pub const RECOVERY: Block = Block {
    name: "recovery",
    base: RECOVERY_BASE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Recovery time of a channel, measured beside the core: a counter that goes on for ever, as it stood at the edges. No meaning where the channel speaks T-format.",
    is_ram: false,
    part: Some(Part::RecoveryCounter),
    registers: &[
        word("edges", 0, ReadOnly, "The counter at the edges that begin and end the recovery time; their difference, modulo 65536, is that time with the line delay.", &[
            field("rise", 0, 16, "cycles", "At the last rising edge of CLOCK"),
            field("fall", 16, 16, "cycles", "At the last falling edge of DATA while the receiver's driver was off"),
        ]),
        word("counter", 1, ReadOnly, "The counter now: it has changed whenever it is looked at again, or stands still because something is broken.", &[
            field("value", 0, 16, "cycles", "Begins at 8192 times the channel's number"),
            field("fallen", 16, 1, "", "DATA has fallen since the last rising edge of CLOCK, and is LOW"),
        ]),
    ],
};
