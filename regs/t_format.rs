//! The port of a T-format encoder: requests of the host, fields of the replies. Its settings are those of its configuration.

use crate::causes::EXCHANGE;
use crate::part::Part;
use crate::{field, word, Access, Block, BLOCK_STRIDE, T_FORMAT_BASE};
use word as at;
use Access::{ReadOnly, Strobe};

/// Words that the host reaches, as `host_address` counts them.
pub mod word {
    /// A request with an exchange of its own.
    pub const SEND: u8 = 0;
    /// What became of it.
    pub const ANSWER: u8 = 1;
    /// Fields of the last reply.
    pub const FIELDS: u8 = 2;
    /// Which parts of the position there are.
    pub const PARTS: u8 = 3;
}

/// Requests to a T-format encoder beside its triggers, and the fields of its replies.
pub const T_FORMAT: Block = Block {
    name: "t_format",
    base: T_FORMAT_BASE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Requests to a T-format encoder beside its triggers, and the fields of its replies; 0 on a channel that speaks EnDat.",
    is_ram: false,
    part: Some(Part::TFormat),
    registers: &[
        word("send", at::SEND, Strobe, "Sends one request, now or as soon as the exchange under way has ended; not taken while answer.busy.", &[
            field("data", 0, 8, "", "EEPROM data, of request 6"),
            field("address", 8, 7, "", "EEPROM address, of requests 6 and 13; 127 is the page register"),
            field("id", 16, 4, "", "Request ID"),
        ]),
        word("answer", at::ANSWER, ReadOnly, "What became of the request in send.", &[
            field("data", 0, 8, "", "EEPROM data as they came last"),
            field("id", 8, 4, "", "ID that the reply repeats"),
            field("cause", 12, 4, "", "T-format cause of the exchange").codes(EXCHANGE),
            field("done", 16, 1, "", "The exchange has ended; 0 from send on"),
            field("busy", 17, 1, "", "The exchange is under way, or waits for its turn"),
        ]),
        word("fields", at::FIELDS, ReadOnly, "Fields of the last reply, of a trigger or of send.", &[
            field("status", 0, 8, "", "Status field (SF); 0 if none came"),
            field("encoder_id", 8, 8, "", "Kind of encoder (ENID) as it came last"),
            field("alarm", 16, 8, "", "Alarm field (ALMC) as it came last"),
            field("crc", 24, 8, "", "CRC as received"),
        ]),
        word("parts", at::PARTS, ReadOnly, "Which parts of the position have come since reset.", &[
            field("single_valid", 0, 1, "", "There is a single-turn position, bits 23..0"),
            field("multi_valid", 1, 1, "", "There is a multi-turn position, bits 47..24"),
        ]),
    ],
};
