//! The card's own words: identification, capabilities, counters and strobes.

use crate::part::{Part, FEATURES, MORE_FEATURES};
use crate::{field, protocols, word, Access, Block, Field, Protocol, BLOCK_STRIDE};
use Access::{ReadOnly, ReadWrite, Strobe};

/// Offset of the first of the stream's four words.
const STREAM_FIRST: u8 = 12;

/// Which channels speak what, and what else there is.
const PROTOCOLS: &[Field] = &protocols::fields::<{ Protocol::ALL.len() + 1 }>(&[
    field(
        "stream_additional_data",
        8,
        1,
        "",
        "1: sets of the stream have the additional data",
    ),
    field(
        "features",
        16,
        8,
        "",
        "Parts that have no place in capabilities.features",
    )
    .bits(MORE_FEATURES),
]);

/// Identification, capabilities, counters and strobes.
pub const CARD: Block = Block {
    name: "card",
    base: 0,
    stride: BLOCK_STRIDE,
    per_channel: false,
    meaning: "Identification, capabilities, counters and strobes.",
    is_ram: false,
    part: None,
    registers: &[
        word(
            "id",
            0,
            ReadOnly,
            "Identification: the ASCII letters EnDt.",
            &[field("value", 0, 32, "", "0x456E4474")],
        ),
        word(
            "version",
            1,
            ReadOnly,
            "Version of the register map; offsets never move within a major version.",
            &[
                field("patch", 0, 16, "", "Patch"),
                field("minor", 16, 8, "", "Minor"),
                field("major", 24, 8, "", "Major"),
            ],
        ),
        word(
            "capabilities",
            2,
            ReadOnly,
            "What this card has.",
            &[
                field("channels", 0, 8, "", "Encoder ports"),
                field("max_position_bits", 8, 8, "bits", "Widest position"),
                field("features", 16, 16, "", "Parts").bits(FEATURES),
            ],
        ),
        word(
            "system_hz",
            3,
            ReadOnly,
            "System clock: the unit of every number of cycles.",
            &[field("value", 0, 32, "Hz", "Frequency")],
        ),
        word(
            "configuration_hash",
            4,
            ReadOnly,
            "Tells which configuration the card was generated from.",
            &[field(
                "value",
                0,
                32,
                "",
                "First 8 digits of the hash that stands in the generated files",
            )],
        ),
        word(
            "protocols",
            5,
            ReadOnly,
            "Which channels speak another protocol than EnDat, what sets of the stream have, and further parts.",
            PROTOCOLS,
        ),
        word(
            "trigger_count",
            8,
            ReadOnly,
            "Triggers since reset; stands still with the results (see hold).",
            &[field("value", 0, 32, "", "Wraps")],
        ),
        word(
            "trigger_now",
            9,
            Strobe,
            "Triggers all channels that take it, if sources allows it.",
            &[field("trigger", 0, 1, "", "Write 1")],
        ),
        word(
            "calibrate",
            10,
            Strobe,
            "Makes channels measure their line delay again, with their next frame.",
            &[field("channels", 0, 8, "", "Bit n for channel n")],
        ),
        word(
            "stream_control",
            STREAM_FIRST,
            ReadWrite,
            "What the stream of sample sets does.",
            &[
                field("collect", 0, 1, "", "Triggers make sets"),
                field("push", 1, 1, "", "Frames go out over the UART"),
            ],
        )
        .of(Part::Stream),
        word(
            "stream_state",
            STREAM_FIRST + 1,
            ReadOnly,
            "What is in the stream's buffer, and what did not get in.",
            &[
                field("bytes", 0, 16, "bytes", "Bytes that wait"),
                field("lost", 16, 16, "", "Sets lost since clear; stops at 65535"),
            ],
        )
        .of(Part::Stream),
        word(
            "stream_data",
            STREAM_FIRST + 2,
            ReadOnly,
            "Takes the next bytes of the stream out of the buffer.",
            &[field(
                "bytes",
                0,
                32,
                "",
                "First byte in bits 31..24; what is not there is 0",
            )],
        )
        .of(Part::Stream),
        word(
            "stream_clear",
            STREAM_FIRST + 3,
            Strobe,
            "Empties the buffer, forgets what was lost.",
            &[field("clear", 0, 1, "", "Write 1")],
        )
        .of(Part::Stream),
    ],
};
