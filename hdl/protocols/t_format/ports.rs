//! Bundles of ports between the blocks of a T-format exchange.
//!
//! ```text
//! FieldOrder --FieldBits, ReplyParts--> Exchange --FieldBits--> Reply, ReplyBytes
//!                                                --ReplyParts--> Outcome, ResultBanks
//! Reply --Fields--> Outcome --Reading--> TFormatChannel
//! ```

use rtl_design::ports;
use rust_hdl::prelude::*;

/// Field of the reply that a data bit belongs to.
#[ports]
pub struct FieldBits {
    /// The bit belongs to the status field.
    pub is_status: Bit,
    /// The bit belongs to the single-turn position.
    pub is_single: Bit,
    /// The bit belongs to the multi-turn position.
    pub is_multi: Bit,
    /// The bit belongs to the kind of encoder or to EEPROM data.
    pub is_byte: Bit,
    /// The bit belongs to the alarm field.
    pub is_alarm: Bit,
}

/// Parts in the reply to a request.
#[ports]
pub struct ReplyParts {
    /// The reply has a single-turn position.
    pub has_single: Bit,
    /// The reply has a multi-turn position.
    pub has_multi: Bit,
    /// The reply has the kind of encoder.
    pub has_identity: Bit,
    /// The reply has alarms.
    pub has_alarm: Bit,
    /// The reply has EEPROM data.
    pub is_memory: Bit,
}

/// Content of a reply, field by field.
#[ports]
pub struct Fields {
    /// Status field; 0 before it is received.
    pub status: Bits<8>,
    /// Single-turn position.
    pub single_turn: Bits<24>,
    /// Multi-turn position.
    pub multi_turn: Bits<24>,
    /// Parity of the single-turn position as received.
    pub single_parity: Bit,
    /// Parity of the multi-turn position as received.
    pub multi_parity: Bit,
    /// Kind of encoder, or EEPROM data.
    pub byte_field: Bits<8>,
    /// Alarm field.
    pub alarm: Bits<8>,
}

/// Outputs of a receiver without registers.
#[ports]
pub struct Reading {
    /// A new result can be read from this cycle on.
    pub result_strobe: Bit,
    /// The last reply was good; low = the values are from an earlier one.
    pub fresh: Bit,
    /// Number of results, wrapping.
    pub sequence: Bits<8>,
    /// Last good single-turn position.
    pub single_turn: Bits<24>,
    /// A single-turn position is available.
    pub single_valid: Bit,
    /// Parity of `single_turn` as received, and of `single_valid`; compared at the output.
    pub single_parity: Bit,
    /// Last good multi-turn position.
    pub multi_turn: Bits<24>,
    /// A multi-turn position is available.
    pub multi_valid: Bit,
    /// Parity of `multi_turn` as received, and of `multi_valid`.
    pub multi_parity: Bit,
    /// Kind of encoder, last received.
    pub encoder_id: Bits<8>,
    /// EEPROM data, last received.
    pub memory_data: Bits<8>,
    /// Alarm field, last received.
    pub alarm: Bits<8>,
    /// Status field of the last reply; 0 if none was received.
    pub status: Bits<8>,
    /// CRC of the last reply.
    pub crc: Bits<8>,
    /// ID echoed in the last reply.
    pub reply_id: Bits<4>,
    /// Raw flags of the last exchange; bits as in the register map.
    pub flags: Bits<16>,
}
