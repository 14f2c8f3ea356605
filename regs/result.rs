//! The result of a channel.

use crate::causes::{cause::row, endat};
use crate::part::Part;
use crate::{field, named::named, word, Access, Block, Field, Named, BLOCK_STRIDE, RESULT_BASE};
use Access::ReadOnly;

/// The raw flag of a cause, in a field that begins with this raw flag.
const fn flag_of(code: u64, first: u32) -> Named {
    let place = endat::flag(code).trailing_zeros() - first;
    let cause = row(endat::ALL, code);
    named(cause.name, place, cause.meaning)
}

/// Raw flags that stand beside the evidence.
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

/// The first raw flag that stands in the status.
pub(crate) const LINE_FIRST: u32 = EVIDENCE_FLAGS.len() as u32;

/// Raw flags that stand in the status.
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

/// Offset of the first of the two words that cards with requests have.
pub const INFO_FIRST: u8 = 6;

const INFO: [Field; 8] = [
    field("content", 0, 16, "", "What it says; 0 unless good"),
    field(
        "sign",
        16,
        5,
        "",
        "I4..I0: which one it is; I4 = 0 additional data 1, 1 additional data 2",
    ),
    field("busy", 21, 1, "", "The encoder is busy with a request"),
    field(
        "reference_mark",
        22,
        1,
        "",
        "RM: the reference mark has been passed",
    ),
    field(
        "warning",
        23,
        1,
        "",
        "WRN: one of the encoder's warnings is set",
    ),
    field("came", 24, 1, "", "The frame brought it"),
    field("good", 25, 1, "", "Its CRC is right"),
    field(
        "crc",
        26,
        5,
        "",
        "Its CRC as received, over bits 23..0 as they came",
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
        word("status", 0, ReadOnly, "What became of the last trigger.", &[
            field("sequence", 0, 16, "", "Number of results, wrapping"),
            field("cause", 16, 5, "", "Primary cause; some come with a good position: fresh tells").codes(endat::CODED).by_protocol("cause"),
            field("valid", 22, 1, "", "There is a good position"),
            field("fresh", 23, 1, "", "The last result brought the position; 0 = held from an earlier one"),
            field("line", 24, 8, "", "Raw flags that evidence has no room for").bits(LINE_FLAGS).by_protocol("line"),
        ]),
        word("position_low", 1, ReadOnly, "Last good position, bits 31..0.", &[
            field("value", 0, 32, "", "Bit 0 is the LSB"),
        ]),
        word("position_high", 2, ReadOnly, "Last good position, bits 47..32.", &[
            field("value", 0, 16, "", "0 above the position's width; T-format: multi-turn in bits 47..24, single-turn in 23..0"),
            field("crc", 16, 5, "", "CRC that came with this position, over F1, F2 and the position, LSB first: whoever reads it checks it once more; T-format: 0"),
            field("f2", 22, 1, "", "The position came with F2 = 1 (EnDat 2.2); F1 of a good position is 0"),
            field("width", 24, 6, "bits", "Width of this position; 0 = there is none yet, or T-format: nothing to check"),
        ]),
        word("timestamp", 3, ReadOnly, "First falling clock edge of the frame that brought the position; equal in two EnDat channels = same trigger. T-format: start bit of the request.", &[
            field("value", 0, 32, "cycles", "Since reset, wrapping"),
        ]),
        word("evidence", 4, ReadOnly, "How good the last frame was.", &[
            field("crc_received", 0, 5, "", "CRC as received"),
            field("crc_computed", 5, 5, "", "CRC as computed"),
            field("delay_cycles", 10, 10, "cycles", "Tracked line delay tD, synchroniser and filter included"),
            field("flags", 20, 12, "", "Raw flags; the rest of them is status.line").bits(EVIDENCE_FLAGS).by_protocol("flags"),
        ]),
        word("age_recovery", 5, ReadOnly, "Age and recovery time.", &[
            field("age_us", 0, 16, "us", "Age of the position: 0 until its frame has ended, counted from there, also while results are held; stops at 65535"),
            field("recovery_cycles", 16, 13, "cycles", "Recovery time tm of the last frame"),
            field("delay_high", 29, 1, "", "Bit 10 of delay_cycles"),
            field("stale", 30, 1, "", "A trigger of this channel has come since this result"),
        ]),
        word("info_1", INFO_FIRST, ReadOnly, "Additional data 1 of the frame of this result.", &INFO).of(Part::Requests),
        word("info_2", INFO_FIRST + 1, ReadOnly, "Additional data 2 of the frame of this result.", &INFO).of(Part::Requests),
    ],
};
