//! The words of the outputs to logic and to a processor in the same device.

use crate::part::Part;
use crate::{
    field, named::named, word, Access, Block, Field, Named, Register, BLOCK_STRIDE, DIRECT_BASE,
    INTERRUPT_BASE,
};
use Access::{ReadOnly, ReadWrite, Strobe};

/// Events that set a bit of a channel in the interrupt status.
pub const INTERRUPT_EVENTS: &[Named] = &[
    named("result", 0, "a new result"),
    named(
        "error",
        1,
        "a result with one of the causes in direct.error_causes",
    ),
    named("alarm", 2, "the alarm was set"),
    named("request", 3, "the frame of a request ended"),
];

/// The event fields of all channels.
const EVENTS: &[Field] = &[
    events("channel_0", 0),
    events("channel_1", 1),
    events("channel_2", 2),
    events("channel_3", 3),
    events("channel_4", 4),
    events("channel_5", 5),
    events("channel_6", 6),
    events("channel_7", 7),
];

const fn events(name: &'static str, channel: u32) -> Field {
    field(name, 4 * channel, 4, "", "Events of the channel").bits(INTERRUPT_EVENTS)
}

const fn all_events(
    name: &'static str,
    offset: u8,
    access: Access,
    meaning: &'static str,
) -> Register {
    word(name, offset, access, meaning, EVENTS)
}

/// Causes that count as errors after reset: all except bit 0, which is the alarm.
pub const ERROR_CAUSES: u32 = !1;

/// Interrupt.
pub const INTERRUPT: Block = Block {
    name: "interrupt",
    base: INTERRUPT_BASE,
    stride: BLOCK_STRIDE,
    per_channel: false,
    meaning: "Interrupt: irq_o is high while a bit is set in both status and mask.",
    is_ram: false,
    part: Some(Part::Interrupt),
    registers: &[
        all_events("status", 0, ReadOnly, "Events since cleared."),
        all_events("mask", 1, ReadWrite, "Events that assert irq_o."),
        all_events(
            "clear",
            2,
            Strobe,
            "Clears the bits of status that are written 1; an event in the same cycle remains.",
        ),
    ],
};

/// Direct outputs of a channel.
pub const DIRECT: Block = Block {
    name: "direct",
    base: DIRECT_BASE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Direct outputs of a channel: position slice and selection of errors.",
    is_ram: false,
    part: Some(Part::Direct),
    registers: &[
        word(
            "crop",
            0,
            ReadWrite,
            "Position bits at the output; takes effect with the next result.",
            &[
                field(
                    "first_bit",
                    0,
                    6,
                    "",
                    "Position bit that becomes bit 0, 0..47",
                ),
                field(
                    "length_bits",
                    8,
                    6,
                    "bits",
                    "Number of bits, 0..32; upper bits are 0",
                ),
            ],
        ),
        word(
            "error_causes",
            1,
            ReadWrite,
            "Causes that assert direct_error_o: bit k for cause k, bit 0 for the channel's alarm.",
            &[field(
                "causes",
                0,
                32,
                "",
                "Causes counted as errors, judged at the last result",
            )],
        ),
    ],
};
