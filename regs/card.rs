//! The card's own words: identification, capabilities, counters and strobes.

use crate::part::{Part, FEATURES, MORE_FEATURES};
use crate::{field, protocols, word, Access, Block, Field, Protocol, BLOCK_STRIDE};
use Access::{ReadOnly, ReadWrite, Strobe};

/// Offset of the first of the stream's four words.
const STREAM_FIRST: u8 = 12;

/// Word `protocols`: which protocol each channel speaks, and features beyond the first word.
const PROTOCOLS: &[Field] = &protocols::fields::<{ Protocol::ALL.len() + 1 }>(&[
    field(
        "stream_additional_data",
        8,
        1,
        "",
        "1: stream sets include additional data",
    ),
    field(
        "features",
        16,
        8,
        "",
        "Features that do not fit into capabilities.features",
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
            "Features of this card.",
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
            "Hash of the configuration from which the card was generated.",
            &[field(
                "value",
                0,
                32,
                "",
                "First 8 digits of the configuration hash in the generated files",
            )],
        ),
        word(
            "protocols",
            5,
            ReadOnly,
            "Channels with another protocol than EnDat, content of stream sets, further features.",
            PROTOCOLS,
        ),
        word(
            "trigger_count",
            8,
            ReadOnly,
            "Triggers since reset; frozen while the results are held (see hold).",
            &[field("value", 0, 32, "", "Wraps")],
        ),
        word(
            "trigger_now",
            9,
            Strobe,
            "Triggers all channels that accept it, if sources enables the register.",
            &[field("trigger", 0, 1, "", "Write 1")],
        ),
        word(
            "calibrate",
            10,
            Strobe,
            "Channels measure their line delay again with their next frame.",
            &[field("channels", 0, 8, "", "Bit n for channel n")],
        ),
        word(
            "stream_control",
            STREAM_FIRST,
            ReadWrite,
            "Enables of the sample stream.",
            &[
                field("collect", 0, 1, "", "1: triggers produce sets"),
                field("push", 1, 1, "", "1: the UART sends frames"),
            ],
        )
        .of(Part::Stream),
        word(
            "stream_state",
            STREAM_FIRST + 1,
            ReadOnly,
            "Fill level of the stream buffer, and lost sets.",
            &[
                field("bytes", 0, 16, "bytes", "Bytes in the buffer"),
                field("lost", 16, 16, "", "Sets lost since clear; stops at 65535"),
            ],
        )
        .of(Part::Stream),
        word(
            "stream_data",
            STREAM_FIRST + 2,
            ReadOnly,
            "Reads and removes the next bytes of the stream from the buffer.",
            &[field(
                "bytes",
                0,
                32,
                "",
                "First byte in bits 31..24; missing bytes read 0",
            )],
        )
        .of(Part::Stream),
        word(
            "stream_clear",
            STREAM_FIRST + 3,
            Strobe,
            "Empties the buffer and clears stream_status.lost.",
            &[field("clear", 0, 1, "", "Write 1")],
        )
        .of(Part::Stream),
    ],
};
