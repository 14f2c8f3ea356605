//! Ports that travel together between the blocks of a T-format exchange.
//!
//! ```text
//! FieldOrder --FieldBits, ReplyParts--> Exchange --FieldBits--> Reply, ReplyBytes
//!                                                --ReplyParts--> Outcome, ResultBanks
//! Reply --Fields--> Outcome --Reading--> TFormatChannel
//! ```

use rtl_design::ports;
use rust_hdl::prelude::*;

/// Which field of the reply a data bit belongs to.
#[ports]
pub struct FieldBits {
    /// It belongs to the status field.
    pub is_status: Bit,
    /// It belongs to the single-turn position.
    pub is_single: Bit,
    /// It belongs to the multi-turn position.
    pub is_multi: Bit,
    /// It belongs to the kind of encoder or to EEPROM data.
    pub is_byte: Bit,
    /// It belongs to the alarm field.
    pub is_alarm: Bit,
}

/// What replies to a request bring.
#[ports]
pub struct ReplyParts {
    /// They bring a single-turn position.
    pub has_single: Bit,
    /// They bring a multi-turn position.
    pub has_multi: Bit,
    /// They bring the kind of encoder.
    pub has_identity: Bit,
    /// They bring alarms.
    pub has_alarm: Bit,
    /// They bring EEPROM data.
    pub is_memory: Bit,
}

/// What a reply has brought, field by field.
#[ports]
pub struct Fields {
    /// Status field; 0 before it has come.
    pub status: Bits<8>,
    /// Single-turn position.
    pub single_turn: Bits<24>,
    /// Multi-turn position.
    pub multi_turn: Bits<24>,
    /// Parity of the single-turn position as it came.
    pub single_parity: Bit,
    /// Parity of the multi-turn position as it came.
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
    /// The last reply was good; low = the values are of an earlier one.
    pub fresh: Bit,
    /// Number of results, wrapping.
    pub sequence: Bits<8>,
    /// Last good single-turn position.
    pub single_turn: Bits<24>,
    /// There is one.
    pub single_valid: Bit,
    /// Parity of `single_turn` as it came, and of `single_valid`; compared where they are shown.
    pub single_parity: Bit,
    /// Last good multi-turn position.
    pub multi_turn: Bits<24>,
    /// There is one.
    pub multi_valid: Bit,
    /// Parity of `multi_turn` as it came, and of `multi_valid`.
    pub multi_parity: Bit,
    /// Kind of encoder, as it came last.
    pub encoder_id: Bits<8>,
    /// EEPROM data as they came last.
    pub memory_data: Bits<8>,
    /// Alarm field as it came last.
    pub alarm: Bits<8>,
    /// Status field of the last reply; 0 if none came.
    pub status: Bits<8>,
    /// CRC of the last reply.
    pub crc: Bits<8>,
    /// ID that the last reply repeats.
    pub reply_id: Bits<4>,
    /// Raw flags of the last exchange; bits as in the register map.
    pub flags: Bits<16>,
}
