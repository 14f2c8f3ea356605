//! SSI, the synchronous serial interface. Its channels have no additional words.

pub mod causes;

use self::causes as cause;
use crate::causes::cause::coded;
use crate::named::{named, Named, Values};
use crate::protocol_row::{channels, own, OwnField, ProtocolRow};
use crate::result::LINE_FIRST;

/// Facts about SSI that card and host share.
pub const PROTOCOL: ProtocolRow = ProtocolRow {
    name: "SSI",
    word: "ssi",
    means: "SSI",
    channel: "an SSI channel",
    has_clock: true,
    causes: cause::ALL,
    coded: CAUSES,
    blocks: &[],
    fields: FIELDS,
    channels: channels("ssi", 24, "SSI: bit n for channel n"),
    part: None,
    turns_at: None,
    turns_with: None,
    has_special_bits: true,
};

/// Causes under the codes of a result.
const CAUSES: &[Named] = &coded::<{ cause::ALL.len() }>(cause::ALL);

/// Raw flags that fit into the evidence word.
const FLAGS: [Named; cause::ALL.len() - 1] = {
    assert!(cause::ALL.len() - 1 <= LINE_FIRST as usize);
    let mut flags = [named("", 0, ""); cause::ALL.len() - 1];
    let mut bit = 0;
    while bit < flags.len() {
        let cause = &cause::ALL[bit + 1];
        flags[bit] = named(cause.name, bit as u32, cause.meaning);
        bit += 1;
    }
    flags
};

/// Bits of the frame that are neither position nor flags.
const SPECIALS: &[Named] = &[
    named("special_0", 0, "last special bit of the frame"),
    named("special_1", 1, "special bit before it"),
    named("special_2", 2, "special bit 2 before special_0"),
    named("special_3", 3, "special bit 3 before special_0"),
    named("special_4", 4, "special bit 4 before special_0"),
    named("special_5", 5, "special bit 5 before special_0"),
    named("special_6", 6, "special bit 6 before special_0"),
    named("special_7", 7, "special bit 7 before special_0"),
];

const FIELDS: &[OwnField] = &[
    own("cause", Values::Codes(CAUSES), &[]),
    own("line", Values::Bits(SPECIALS), &[]),
    own("flags", Values::Bits(&FLAGS), &[]),
    own("period_cycles", Values::Plain, &[(4, 2047)]),
    own("position_bits", Values::Plain, &[(1, 48)]),
    own(
        "command",
        Values::Bits(frame::ALL),
        &[(4, 7), (12, 15), (28, 31)],
    ),
    own("request_id", Values::Plain, &[]),
    own("start_timeout_us", Values::Plain, &[]),
];

/// Frame format: bits of the field that holds the mode command in EnDat.
pub mod frame {
    use crate::named::{named, Named};

    /// The position is in Gray code.
    pub const GRAY: u32 = 0;
    /// The encoder sends each position twice; the card compares the two.
    pub const TWICE: u32 = 1;
    /// Enables the clock; the channel sends no frame without it.
    pub const CLOCKED: u32 = 2;
    /// A parity bit over the position as sent follows the position.
    pub const PARITY: u32 = 3;
    /// The parity is odd; otherwise even.
    pub const ODD: u32 = 4;
    /// All bits.
    pub const ALL: &[Named] = &[
        named("gray", GRAY, "in Gray code"),
        named("twice", TWICE, "each position sent twice and compared"),
        named("clocked", CLOCKED, "sends a frame; must be 1"),
        named("parity", PARITY, "a parity bit follows the position"),
        named("odd", ODD, "the parity is odd"),
    ];
}
