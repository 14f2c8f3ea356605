//! The words of a T-format port; their places come from [`crate::t_format::port::word`]. Its settings are those of its configuration.

use super::values::T_FORMAT_CAUSES;
use super::{field, word, Access, Block, BLOCK_STRIDE, T_FORMAT_BASE};
use crate::t_format::port::word as at;
use Access::{ReadOnly, Strobe};

/// Requests to a T-format encoder beside its triggers, and the fields of its replies.
pub const T_FORMAT: Block = Block {
    name: "t_format",
    base: T_FORMAT_BASE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Requests to a T-format encoder beside its triggers, and the fields of its replies; 0 on a channel that speaks EnDat.",
    is_ram: false,
    registers: &[
        word("send", at::SEND, Strobe, "Sends one request, now or as soon as the exchange under way has ended; not taken while answer.busy.", &[
            field("data", 0, 8, "", "EEPROM data, of request 6"),
            field("address", 8, 7, "", "EEPROM address, of requests 6 and 13; 127 is the page register"),
            field("id", 16, 4, "", "Request ID"),
        ]),
        word("answer", at::ANSWER, ReadOnly, "What became of the request in send.", &[
            field("data", 0, 8, "", "EEPROM data as they came last"),
            field("id", 8, 4, "", "ID that the reply repeats"),
            field("cause", 12, 4, "", "T-format cause of the exchange").codes(&T_FORMAT_CAUSES),
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
