//! The port of a T-format encoder: requests of the host, fields of the replies. Its configuration words hold its settings.

pub mod causes;

use self::causes as cause;
use crate::causes::cause::coded;
use crate::named::named;
use crate::part::Part;
use crate::protocol_row::{channels, own, OwnField, ProtocolRow};
use crate::result::LINE_FIRST;
use crate::{field, word, Access, Block, Named, Values, BLOCK_STRIDE, T_FORMAT_BASE};
use word as at;
use Access::{ReadOnly, Strobe};

/// Requests in a row that a reset needs before it takes effect.
pub const RESETS_IN_A_ROW: u32 = 10;

/// Lowest turn bit of a position. An encoder uses the lower ones of the 24 bits below it for the angle.
pub const TURNS_AT: u32 = 24;

/// Facts about T-format that card and host share.
pub const PROTOCOL: ProtocolRow = ProtocolRow {
    name: "T-format",
    word: "t_format",
    means: "T-format",
    channel: "a T-format channel",
    has_clock: false,
    causes: cause::ALL,
    coded: CAUSES,
    blocks: &["t_format"],
    fields: FIELDS,
    channels: channels("t_format", 0, "T-format: bit n for channel n"),
    part: Some(Part::TFormat),
    turns_at: Some(TURNS_AT),
    turns_with: Some(&[request::EVERYTHING, request::MULTI_TURN]),
    has_special_bits: false,
};

/// Causes under the codes of a result.
const CAUSES: &[Named] = &coded::<{ cause::ALL.len() }>(cause::ALL);
/// Causes of an exchange that the host requests: those before the trigger overrun.
const EXCHANGE: &[Named] = &coded::<{ cause::TRIGGER_OVERRUN as usize }>(cause::ALL);

/// Raw flags from flag `FIRST` on.
const fn flags<const FIRST: usize, const N: usize>() -> [Named; N] {
    let mut flags = [named("", 0, ""); N];
    let mut bit = 0;
    while bit < N {
        // The code of a flag is its number plus one.
        let cause = &cause::ALL[FIRST + bit + 1];
        assert!(cause::flag(cause.code) == 1 << (FIRST + bit));
        flags[bit] = named(cause.name, bit as u32, cause.meaning);
        bit += 1;
    }
    flags
}

/// Raw flags in the evidence word and in the status.
const EVIDENCE: &[Named] = &flags::<0, { LINE_FIRST as usize }>();
const LINE: &[Named] =
    &flags::<{ LINE_FIRST as usize }, { cause::ALL.len() - 1 - LINE_FIRST as usize }>();

const FIELDS: &[OwnField] = &[
    own("cause", Values::Codes(CAUSES), &[]),
    own("line", Values::Bits(LINE), &[]),
    own("flags", Values::Bits(EVIDENCE), &[]),
    own("period_cycles", Values::Plain, &[(8, 127)]),
    own("position_bits", Values::Plain, &[(1, 2 * TURNS_AT)]),
    own("multi_turn_bits", Values::Plain, &[(0, TURNS_AT)]),
    own("command", Values::Plain, &[]),
    own("request_id", Values::Plain, &[(0, 5), (7, 12), (14, 15)]),
    own("start_timeout_us", Values::Plain, &[(1, 63)]),
    // The port rejects an invalid request with a cause.
    own("send_id", Values::Codes(request::ALL), &[(0, 15)]),
];

/// Requests, by their ID on the wire.
pub mod request {
    use crate::named::codes;

    codes! {
        /// All requests.
        ALL: u8;
        SINGLE_TURN = 0x0, "single_turn", "single-turn position";
        MULTI_TURN = 0x1, "multi_turn", "multi-turn position";
        ENCODER_ID = 0x2, "encoder_id", "kind of encoder";
        EVERYTHING = 0x3, "everything", "both positions, kind and alarms";
        WRITE_EEPROM = 0x6, "write_eeprom", "writes a byte of the EEPROM";
        CLEAR_ERRORS = 0x7, "clear_errors", "clears errors, ten in a row";
        CLEAR_SINGLE_TURN = 0x8, "clear_single_turn", "makes the present angle zero, ten in a row";
        CLEAR_MULTI_TURN = 0xC, "clear_multi_turn", "clears turns and errors, ten in a row";
        READ_EEPROM = 0xD, "read_eeprom", "reads a byte of the EEPROM";
    }
}

/// Addresses of the host's words, as `host_address` counts them.
pub mod word {
    /// Sends a request.
    pub const SEND: u8 = 0;
    /// State and data of the request.
    pub const ANSWER: u8 = 1;
    /// Fields of the last reply.
    pub const FIELDS: u8 = 2;
    /// Received parts of the position.
    pub const PARTS: u8 = 3;
}

/// Requests to a T-format encoder in addition to its triggers, and the fields of its replies.
pub const T_FORMAT: Block = Block {
    name: "t_format",
    base: T_FORMAT_BASE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Requests to a T-format encoder in addition to triggers, and the fields of its replies; 0 on a channel with another protocol.",
    is_ram: false,
    part: Some(Part::TFormat),
    registers: &[
        word("send", at::SEND, Strobe, "Sends one request, now or when the exchange under way has ended; ignored while answer.busy.", &[
            field("data", 0, 8, "", "EEPROM data for request 6"),
            field("address", 8, 7, "", "EEPROM address for requests 6 and 13; 127 is the page register"),
            field("id", 16, 4, "", "Request ID").codes(request::ALL).by_protocol("send_id"),
        ]),
        word("answer", at::ANSWER, ReadOnly, "State and data of the request in send.", &[
            field("data", 0, 8, "", "EEPROM data of the last reply that had it"),
            field("id", 8, 4, "", "ID echoed in the reply"),
            field("cause", 12, 4, "", "T-format cause of the exchange").codes(EXCHANGE),
            field("done", 16, 1, "", "The exchange has ended; cleared by send"),
            field("busy", 17, 1, "", "The exchange is under way or waiting"),
        ]),
        word("fields", at::FIELDS, ReadOnly, "Fields of the last reply, to a trigger or to send.", &[
            field("status", 0, 8, "", "Status field (SF); 0 if none was received"),
            field("encoder_id", 8, 8, "", "Kind of encoder (ENID), last received"),
            field("alarm", 16, 8, "", "Alarm field (ALMC), last received"),
            field("crc", 24, 8, "", "CRC as received"),
        ]),
        word("parts", at::PARTS, ReadOnly, "Parts of the position received since reset.", &[
            field("single_valid", 0, 1, "", "Single-turn position received, bits 23..0"),
            field("multi_valid", 1, 1, "", "Multi-turn position received, bits 47..24"),
        ]),
    ],
};
