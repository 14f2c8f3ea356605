//! Addresses and layout of the service words in RAM.

use crate::causes::endat;

/// 32-bit words in RAM, as the host counts them. The program addresses half words: twice this number, plus one for the high half.
pub mod word {
    /// Request: mode command (29..24), MRS code, address or port (23..16), data (15..0). Writing it sends it.
    pub const REQUEST: u8 = 0;
    /// State of the request (15..0) and number of requests finished (31..16).
    pub const REQUEST_STATE: u8 = 1;
    /// Answer: data (15..0), then echo of MRS code or address, or the status byte of additional data 1 (23..16); of
    /// longer answers bits 31..0.
    pub const ANSWER: u8 = 2;
    /// Bits 47..32 of longer answers.
    pub const ANSWER_MORE: u8 = 3;
    /// Duration: microseconds, wrapping (15..0), milliseconds (31..16).
    pub const DURATION: u8 = 4;
    /// Control; a write acts.
    pub const CONTROL: u8 = 5;
    /// Forced errors, see [`super::force`].
    pub const FORCE: u8 = 6;
    /// Initialisation: step under way (15..0, 0 = none), step that failed (31..16, 0 = none).
    pub const PROGRESS: u8 = 7;
    /// State bits (15..0), starts of the program (31..16).
    pub const STATE: u8 = 8;
    /// Triggers lost (15..0), ends of frames that were not counted (31..16).
    pub const LOST: u8 = 9;
    /// Alarm threshold: n bad frames (15..0) of the last m (31..16, up to 16); 0 = none.
    pub const THRESHOLD: u8 = 10;
    /// Bad frames among the last m (15..0), one bit for each (31..16, bit 0 = the last).
    pub const BAD_FRAMES: u8 = 11;
    /// Nominal difference, position 2 minus position 1, bits 31..0, then 47..32.
    pub const OFFSET: [u8; 2] = [12, 13];
    /// Largest allowed distance from it, in measuring steps; 0 with no comparison.
    pub const TOLERANCE: u8 = 14;
    /// Position 2 minus position 1 minus offset, bits 31..0 then 47..32, modulo the position's width.
    pub const DIFFERENCE: [u8; 2] = [15, 16];
    /// Comparisons (15..0), comparisons that failed (31..16).
    pub const COMPARISONS: u8 = 17;
    /// Position 2 as last read, bits 31..0, then 47..32.
    pub const POSITION_2: [u8; 2] = [18, 19];
    /// Number of codes in the list, 0..=8.
    pub const LIST_LENGTH: u8 = 20;
    /// Last good status byte of additional data 1 (15..0) and 2 (31..16): WRN, RM, Busy, I4..I0; then
    /// [`super::info_status`].
    pub const INFO_STATUS: u8 = 21;
    /// Watchdog in microseconds (15..0, 0 = off), shortest recovery time in system clock cycles (31..16, 0 = not checked).
    pub const LIMITS: u8 = 22;
    /// Continuous clock: bit 0 enables, bit 1 stops it after an error.
    pub const CONTINUOUS: u8 = 23;
    /// Timeout of a request that waits for a trigger, in milliseconds (15..0); 0 = none.
    pub const REQUEST_WAIT: u8 = 40;
    /// Period of the forced errors on the card's schedule, in milliseconds (15..0); 0 = none.
    pub const ERROR_TEST: u8 = 41;
    /// Forced errors that were reported (15..0), and that were not (31..16).
    pub const ERROR_TEST_STATE: u8 = 42;
    /// MRS codes that are selected in turn.
    pub const LIST: u8 = 24;
    /// Most codes in the list, and number of slots.
    pub const LIST_MAX: u8 = 8;
    /// For each code of the list: 16 bits of content (15..0), number of the result that brought it (31..16).
    pub const SLOTS: u8 = 32;
    /// Frames for each cause, 32 bits. The first counter counts good frames. The last two count failed comparisons of positions, and blocks of
    /// additional data with a wrong CRC.
    pub const COUNTERS: u8 = 48;
    /// Name plate: value (15..0), 1 = it has been read (31..16).
    pub const NAME_PLATE: u8 = 68;
    /// First word that only the program uses.
    pub const PRIVATE: u8 = 96;
}

/// Counter of failed comparisons, after those of the causes.
pub const COUNTER_POSITION_2: u8 = endat::COUNT as u8;

/// Counter of blocks of additional data with a wrong CRC; the last counter.
pub const COUNTER_BAD_INFOS: u8 = COUNTER_POSITION_2 + 1;

/// Bits above the status byte, in both halves of [`word::INFO_STATUS`].
pub mod info_status {
    /// The last additional data had a wrong CRC; their content was discarded.
    pub const BAD_CRC: u16 = 1 << 8;
}

/// Bits of [`word::REQUEST_STATE`].
pub mod request_state {
    /// A request is under way.
    pub const BUSY: u16 = 1 << 0;
    /// Bit offset of the error code.
    pub const ERROR_SHIFT: u32 = 4;

    crate::named::codes! {
        /// Results of a request.
        ERRORS: u16;
        OK = 0, "fulfilled", "fulfilled";
        SILENT = 1, "no_answer", "no answer: command not understood or refused";
        ADDRESS_ECHO = 2, "address_echo", "echo of MRS code, address or port wrong";
        DATA_ECHO = 3, "data_echo", "echo of data wrong";
        CRC = 4, "crc", "CRC of the answer wrong";
        UNKNOWN = 5, "unknown_command", "unknown mode command, nothing was sent";
        FRAME = 6, "frame", "frame failed or could not begin";
        BUSY_TIMEOUT = 7, "busy_timeout", "encoder stayed busy";
        NO_TRIGGER = 8, "no_trigger", "no trigger came in time for a request that waits for one";
        CANCELLED = 9, "cancelled", "cancelled by the host";
    }

    /// Meaning of an error code.
    pub fn name(error: u16) -> &'static str {
        let row = ERRORS.iter().find(|e| e.number == error.into());
        row.map_or("unknown", |e| e.meaning)
    }
}

/// Shortest period of the card's forced errors, in milliseconds. A due error waits for the end of a trigger's frame, so that the next trigger is
/// far away. After this time without triggers it is sent at once.
pub const ERROR_TEST_PATIENCE_MS: u16 = 10;
/// Longest period; a service's milliseconds wrap at 65536.
pub const ERROR_TEST_MS_MAX: u16 = 32_000;

/// Bits of [`word::FORCE`].
pub mod force {
    /// Inverts F1.
    pub const F1: u16 = 1 << 0;
    /// Inverts F2.
    pub const F2: u16 = 1 << 1;
    /// Corrupts the CRC.
    pub const CRC: u16 = 1 << 2;
    /// The second receiver disagrees.
    pub const SECOND_RECEIVER: u16 = 1 << 3;
    /// Only in separate frames of requests.
    pub const OWN_FRAMES: u16 = 1 << 4;
}

/// Bits of [`word::CONTROL`].
pub mod control {
    /// Initialise the encoder.
    pub const INITIALISE: u16 = 1 << 0;
    /// Clears counters and the latched part of the state.
    pub const CLEAR: u16 = 1 << 1;
    /// Cancels the request under way; a frame on the wire is finished.
    pub const CANCEL: u16 = 1 << 2;
}

/// Bits of [`word::STATE`], low half.
pub mod state {
    /// The encoder has been initialised; the name plate is valid.
    pub const INITIALISED: u16 = 1 << 0;
    /// n of the last m frames were bad; latched.
    pub const ALARM: u16 = 1 << 1;
    /// Positions 1 and 2 were too far apart; latched.
    pub const POSITION_2: u16 = 1 << 2;
    /// The encoder supports EnDat 2.2.
    pub const ENDAT22: u16 = 1 << 3;
    /// The encoder has another width than configured, which the card uses.
    pub const OTHER_WIDTH: u16 = 1 << 4;
    /// The encoder supports only a slower clock than configured, which the card uses.
    pub const SLOWER: u16 = 1 << 5;
    /// DATA has been HIGH for long: no encoder, or a broken line.
    pub const UNPLUGGED: u16 = 1 << 6;
    /// Initialisation or power-up sequence under way; the card takes no position.
    pub const INITIALISING: u16 = 1 << 7;
    /// A forced error was not reported; latched.
    pub const ERROR_TEST: u16 = 1 << 8;
}
