//! SSI, the synchronous serial interface, as card and host see it. Its channels have no words of their own.

pub mod causes;

use self::causes as cause;
use crate::causes::cause::coded;
use crate::named::{named, Named, Values};
use crate::protocol_row::{channels, own, OwnField, ProtocolRow};
use crate::result::LINE_FIRST;

/// What card and host agree on of SSI.
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

/// Raw flags: they have room beside the evidence.
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

/// Bits of the frame that are not position, beside the flags.
const SPECIALS: &[Named] = &[
    named("special_0", 0, "last special bit that is shown"),
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

/// How a position comes: bits of the field that has the mode command in EnDat.
pub mod frame {
    use crate::named::{named, Named};

    /// The position is in Gray code.
    pub const GRAY: u32 = 0;
    /// Each position comes twice, and the two are compared.
    pub const TWICE: u32 = 1;
    /// A frame may go out: without it nothing does.
    pub const CLOCKED: u32 = 2;
    /// Behind the position comes a parity bit, of its bits as they are sent.
    pub const PARITY: u32 = 3;
    /// With that: it is odd, otherwise even.
    pub const ODD: u32 = 4;
    /// All of them.
    pub const ALL: &[Named] = &[
        named("gray", GRAY, "in Gray code"),
        named("twice", TWICE, "each position twice, compared"),
        named("clocked", CLOCKED, "a frame goes out; always 1"),
        named("parity", PARITY, "a parity bit behind the position"),
        named("odd", ODD, "which is odd"),
    ];
}
