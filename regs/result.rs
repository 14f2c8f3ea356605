//! The result of a channel.

use crate::causes::{cause::row, endat};
use crate::part::Part;
use crate::{field, named::named, word, Access, Block, Field, Named, BLOCK_STRIDE, RESULT_BASE};
use Access::ReadOnly;

/// Named raw flag of a cause, in a field that begins with raw flag `first`.
const fn flag_of(code: u64, first: u32) -> Named {
    let place = endat::flag(code).trailing_zeros() - first;
    let cause = row(endat::ALL, code);
    named(cause.name, place, cause.meaning)
}

/// Raw flags in the evidence word.
pub const EVIDENCE_FLAGS: &[Named] = &[
    flag_of(endat::DATA_NOT_LOW, 0),
    flag_of(endat::NO_START_BIT, 0),
    flag_of(endat::START_WINDOW, 0),
    flag_of(endat::CRC, 0),
    flag_of(endat::F1, 0),
    flag_of(endat::F2, 0),
    flag_of(endat::DATA_NOT_FALLING, 0),
    flag_of(endat::TRIGGER_OVERRUN, 0),
    named(
        "parallel_crc",
        endat::flag::PARALLEL_CRC.trailing_zeros(),
        "parallel CRC",
    ),
    named(
        "tail_low",
        endat::flag::TAIL_LOW.trailing_zeros(),
        "data not high after the frame",
    ),
    flag_of(endat::UNKNOWN_COMMAND, 0),
    flag_of(endat::INFO_MISSING, 0),
];

/// The first raw flag in the status word.
pub(crate) const LINE_FIRST: u32 = EVIDENCE_FLAGS.len() as u32;

/// Raw flags in the status word.
pub const LINE_FLAGS: &[Named] = &[
    flag_of(endat::NO_ENCODER, LINE_FIRST),
    flag_of(endat::STUCK_HIGH, LINE_FIRST),
    flag_of(endat::STUCK_LOW, LINE_FIRST),
    flag_of(endat::LATE_START, LINE_FIRST),
    flag_of(endat::WATCHDOG, LINE_FIRST),
    flag_of(endat::OWN_ECHO, LINE_FIRST),
    flag_of(endat::RECOVERY_TOO_SHORT, LINE_FIRST),
    named(
        "upset",
        endat::flag(endat::UPSET).trailing_zeros() - LINE_FIRST,
        endat::name(endat::UPSET),
    ),
];

/// Offset of the first of the two additional data words, on cards with requests.
pub const INFO_FIRST: u8 = 6;

const INFO: [Field; 8] = [
    field("content", 0, 16, "", "Content; 0 unless good"),
    field(
        "sign",
        16,
        5,
        "",
        "I4..I0: number of the content; I4 = 0 additional data 1, 1 additional data 2",
    ),
    field("busy", 21, 1, "", "The encoder is busy with a request"),
    field(
        "reference_mark",
        22,
        1,
        "",
        "RM: the reference mark has been passed",
    ),
    field("warning", 23, 1, "", "WRN: a warning of the encoder is set"),
    field("came", 24, 1, "", "The frame included this block"),
    field("good", 25, 1, "", "The CRC is right"),
    field(
        "crc",
        26,
        5,
        "",
        "CRC as received, over bits 23..0 as received",
    ),
];

/// Result of a channel; all words of all channels change together and never within a read command.
pub const RESULT: Block = Block {
    name: "result",
    base: RESULT_BASE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Result of a channel; all words of all channels change together and never within a read command.",
    is_ram: false,
    part: None,
    registers: &[
        word("status", 0, ReadOnly, "Outcome of the last trigger.", &[
            field("sequence", 0, 16, "", "Number of results, wrapping"),
            field("cause", 16, 5, "", "Primary cause. With some causes the position is good: then fresh is 1").codes(endat::CODED).by_protocol("cause"),
            field("valid", 22, 1, "", "A good position is available"),
            field("fresh", 23, 1, "", "1: the last result brought the position; 0: held from an earlier result"),
            field("line", 24, 8, "", "Raw flags that do not fit into evidence").bits(LINE_FLAGS).by_protocol("line"),
        ]),
        word("position_low", 1, ReadOnly, "Last good position, bits 31..0.", &[
            field("value", 0, 32, "", "Bit 0 is the LSB"),
        ]),
        word("position_high", 2, ReadOnly, "Last good position, bits 47..32.", &[
            field("value", 0, 16, "", "0 above the position's width; T-format: multi-turn in bits 47..24, single-turn in 23..0"),
            field("crc", 16, 5, "", "CRC received with this position, over F1, F2 and the position, LSB first, for a check by the host; T-format: 0"),
            field("f2", 22, 1, "", "The position came with F2 = 1 (EnDat 2.2); F1 of a good position is 0"),
            field("width", 24, 6, "bits", "Width of this position; 0 = no position yet, or T-format: no check"),
        ]),
        word("timestamp", 3, ReadOnly, "First falling clock edge of the frame that brought the position; equal in two EnDat channels: same trigger. T-format: start bit of the request.", &[
            field("value", 0, 32, "cycles", "Since reset, wrapping"),
        ]),
        word("evidence", 4, ReadOnly, "Quality of the last frame.", &[
            field("crc_received", 0, 5, "", "CRC as received"),
            field("crc_computed", 5, 5, "", "CRC as computed"),
            field("delay_cycles", 10, 10, "cycles", "Tracked line delay tD, including synchroniser and filter"),
            field("flags", 20, 12, "", "Raw flags; status.line has the others").bits(EVIDENCE_FLAGS).by_protocol("flags"),
        ]),
        word("age_recovery", 5, ReadOnly, "Age and recovery time.", &[
            field("age_us", 0, 16, "us", "Age of the position, counted from the end of its frame (0 until then), also while results are held; stops at 65535"),
            field("recovery_cycles", 16, 13, "cycles", "Recovery time tm of the last frame"),
            field("delay_high", 29, 1, "", "Bit 10 of delay_cycles"),
            field("stale", 30, 1, "", "The channel has had a trigger since this result"),
        ]),
        word("info_1", INFO_FIRST, ReadOnly, "Additional data 1 of the frame of this result.", &INFO).of(Part::Requests),
        word("info_2", INFO_FIRST + 1, ReadOnly, "Additional data 2 of the frame of this result.", &INFO).of(Part::Requests),
    ],
};
