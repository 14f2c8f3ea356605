//! The words of the outputs to logic and to a processor in the same device.

use crate::part::Part;
use crate::{
    field, named::named, word, Access, Block, Field, Named, Register, BLOCK_STRIDE, DIRECT_BASE,
    INTERRUPT_BASE,
};
use Access::{ReadOnly, ReadWrite, Strobe};

/// What sets a bit of a channel in the interrupt's status.
pub const INTERRUPT_EVENTS: &[Named] = &[
    named("result", 0, "a new result"),
    named(
        "error",
        1,
        "a result whose cause is one of direct.error_causes",
    ),
    named("alarm", 2, "the alarm has come on"),
    named("request", 3, "the frame of a request has ended"),
];

/// The events of all channels.
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

/// Causes that are errors after reset: all but 0, which is the alarm's.
pub const ERROR_CAUSES: u32 = !1;

/// Interrupt.
pub const INTERRUPT: Block = Block {
    name: "interrupt",
    base: INTERRUPT_BASE,
    stride: BLOCK_STRIDE,
    per_channel: false,
    meaning: "Interrupt: irq_o is high while a bit of status is set that is set in mask, too.",
    is_ram: false,
    part: Some(Part::Interrupt),
    registers: &[
        all_events(
            "status",
            0,
            ReadOnly,
            "What has happened since it was cleared.",
        ),
        all_events("mask", 1, ReadWrite, "What makes irq_o high."),
        all_events(
            "clear",
            2,
            Strobe,
            "Clears the bits of status that are written 1; an event of the same cycle stays.",
        ),
    ],
};

/// Direct outputs of a channel.
pub const DIRECT: Block = Block {
    name: "direct",
    base: DIRECT_BASE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Direct outputs of a channel: where its position is cropped, and what is an error.",
    is_ram: false,
    part: Some(Part::Direct),
    registers: &[
        word(
            "crop",
            0,
            ReadWrite,
            "Which bits of the position come out; taken over with the next result.",
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
                    "How many bits, 0..32; zeros above",
                ),
            ],
        ),
        word(
            "error_causes",
            1,
            ReadWrite,
            "What makes direct_error_o high: bit k for cause k, bit 0 for the channel's alarm.",
            &[field(
                "causes",
                0,
                32,
                "",
                "Selected causes of the last result",
            )],
        ),
    ],
};
