//! Where things stand in the service's RAM and at its ports. One home for program, block, register table and host.

use crate::transaction::cause;

/// Ports that the program reads.
pub mod input {
    /// Bits of [`STATUS`].
    pub mod status {
        /// A frame has ended and not been looked at.
        pub const EVENT: u16 = 1 << 0;
        /// It had the request.
        pub const IS_REQUEST: u16 = 1 << 1;
        /// The host has written the request word.
        pub const MAILBOX: u16 = 1 << 2;
        /// The host has written the control word.
        pub const CONTROL: u16 = 1 << 3;
        /// DATA is HIGH, and no frame is on the wire.
        pub const LINE_HIGH: u16 = 1 << 4;
        /// The CRC of the answer to the last request with a frame of its own is right.
        pub const REPLY_GOOD: u16 = 1 << 5;
        /// The last frame brought additional information 1 with a right CRC.
        pub const INFO_1: u16 = 1 << 6;
        /// The last frame brought additional information 2 with a right CRC.
        pub const INFO_2: u16 = 1 << 7;
        /// The encoder sends additional information 1.
        pub const INFO_1_ACTIVE: u16 = 1 << 8;
        /// A frame ended before the last one had been looked at.
        pub const MISSED: u16 = 1 << 9;
        /// The last frame brought a good position.
        pub const FRESH: u16 = 1 << 10;
        /// The frame under way has the request.
        pub const REQUEST_RUNS: u16 = 1 << 11;
        /// The last frame brought additional information 1, with a right CRC or a wrong one.
        pub const INFO_1_CAME: u16 = 1 << 12;
        /// The last frame brought additional information 2, with a right CRC or a wrong one.
        pub const INFO_2_CAME: u16 = 1 << 13;
    }
    /// What there is to do.
    pub const STATUS: u8 = 0;
    /// Primary cause of the frame that ended.
    pub const CAUSE: u8 = 1;
    /// Additional information 1: its 16 bits.
    pub const INFO_1: u8 = 2;
    /// WRN, RM, Busy, I4..I0 of additional information 1.
    pub const INFO_1_STATUS: u8 = 3;
    /// Additional information 2: its 16 bits.
    pub const INFO_2: u8 = 4;
    /// WRN, RM, Busy, I4..I0 of additional information 2.
    pub const INFO_2_STATUS: u8 = 5;
    /// Position or test values that answer a request, bits 15..0; then 31..16 and 47..32.
    pub const REPLY: [u8; 3] = [6, 7, 8];
    /// Answer to a command with a parameter: its 16 bits; then the echo of MRS code, address or port.
    pub const PARAMETER: [u8; 2] = [9, 10];
    /// Triggers lost, wrapping.
    pub const DISPLACED: u8 = 11;
    /// Number of results, wrapping.
    pub const SEQUENCE: u8 = 12;
    /// Last good position, bits 15..0; then 31..16 and 47..32.
    pub const POSITION: [u8; 3] = [13, 14, 15];
    /// Configured: position bits (5..0), the command is 111000 (6), short recovery time wanted (7).
    pub const CONFIGURED: u8 = 16;
    /// Configured EnDat clock period, in system clock cycles.
    pub const PERIOD: u8 = 17;
    /// Tracked line delay, in system clock cycles.
    pub const DELAY: u8 = 18;
    /// Number of these.
    pub const WORDS: u8 = DELAY + 1;
    /// Microseconds, wrapping. From 24 on ports are the same for all channels.
    pub const TIME_US: u8 = 30;
    /// Milliseconds, wrapping.
    pub const TIME_MS: u8 = 31;
}

/// Ports that the program writes.
pub mod output {
    /// Bits of [`GO`].
    pub mod go {
        /// The request rides on the next triggered frame.
        pub const RIDE: u16 = 1 << 0;
        /// The request gets a frame of its own.
        pub const OWN: u16 = 1 << 1;
        /// A request that has not begun is forgotten.
        pub const CANCEL: u16 = 1 << 2;
        /// The next frame measures the line delay, at the calibration clock.
        pub const CALIBRATE: u16 = 1 << 3;
    }
    /// Bits of [`CONTROL`].
    pub mod control {
        /// Triggers are lost.
        pub const HOLD_OFF: u16 = 1 << 0;
        /// The clock is LOW.
        pub const CLOCK_LOW: u16 = 1 << 1;
        /// The channel's alarm.
        pub const ALARM: u16 = 1 << 2;
    }
    /// Bits of [`ACKNOWLEDGE`].
    pub mod acknowledge {
        /// The frame's end has been looked at.
        pub const EVENT: u16 = 1 << 0;
        /// The request has been taken.
        pub const MAILBOX: u16 = 1 << 1;
        /// The control word has been taken.
        pub const CONTROL: u16 = 1 << 2;
    }
    /// Clears bits of the status.
    pub const ACKNOWLEDGE: u8 = 0;
    /// Mode command of the request.
    pub const COMMAND: u8 = 1;
    /// MRS code, address or port of the request.
    pub const ADDRESS: u8 = 2;
    /// Data of the request.
    pub const DATA: u8 = 3;
    /// Strobes.
    pub const GO: u8 = 4;
    /// Levels.
    pub const CONTROL: u8 = 5;
    /// Forced errors: F1, F2, CRC.
    pub const FORCE: u8 = 6;
    /// Found in the encoder: position bits (5..0, 0 = nothing found), it knows EnDat 2.1 only (6).
    pub const FOUND: u8 = 7;
    /// EnDat clock period that the encoder takes, in system clock cycles; 0 = as configured.
    pub const PERIOD: u8 = 8;
    /// Watchdog, in microseconds.
    pub const WATCHDOG: u8 = 9;
    /// Shortest recovery time, in system clock cycles.
    pub const RECOVERY_MIN: u8 = 10;
    /// Continuous clock: as [`super::word::CONTINUOUS`].
    pub const CONTINUOUS: u8 = 11;
    /// Whatever is written: the program goes its round, or waits for something that has an end.
    pub const ALIVE: u8 = 12;
}

/// Words of 32 bits in RAM, as the host counts them; the program's word is twice that, plus one for the high half.
pub mod word {
    /// Request: mode command (29..24), MRS code, address or port (23..16), data (15..0). Writing it sends it.
    pub const REQUEST: u8 = 0;
    /// State of the request (15..0) and number of requests finished (31..16).
    pub const REQUEST_STATE: u8 = 1;
    /// Answer: data (15..0), then echo of MRS code or address, or the status byte of additional information 1 (23..16); of
    /// longer answers bits 31..0.
    pub const ANSWER: u8 = 2;
    /// Bits 47..32 of longer answers.
    pub const ANSWER_MORE: u8 = 3;
    /// Duration: microseconds, wrapping (15..0), milliseconds (31..16).
    pub const DURATION: u8 = 4;
    /// Control: writing it acts.
    pub const CONTROL: u8 = 5;
    /// Forced errors.
    pub const FORCE: u8 = 6;
    /// Initialisation: step under way (15..0, 0 = none), step that failed (31..16, 0 = none).
    pub const PROGRESS: u8 = 7;
    /// What is known and what is wrong (15..0), how often the program has begun (31..16).
    pub const STATE: u8 = 8;
    /// Triggers lost (15..0), ends of frames not looked at (31..16).
    pub const LOST: u8 = 9;
    /// Alarm threshold: n bad frames (15..0) of the last m (31..16, up to 16); 0 = none.
    pub const THRESHOLD: u8 = 10;
    /// Bad frames among the last m (15..0), which ones (31..16, bit 0 = the last).
    pub const BAD_FRAMES: u8 = 11;
    /// Position 2 minus position 1 as it should be, bits 31..0, then 47..32.
    pub const OFFSET: [u8; 2] = [12, 13];
    /// Largest distance from that, in measuring steps; 0 with no comparison.
    pub const TOLERANCE: u8 = 14;
    /// Position 2 minus position 1 minus offset, bits 31..0 then 47..32, modulo the position's width.
    pub const DIFFERENCE: [u8; 2] = [15, 16];
    /// Comparisons (15..0), comparisons that failed (31..16).
    pub const COMPARISONS: u8 = 17;
    /// Position 2 as last read, bits 31..0, then 47..32.
    pub const POSITION_2: [u8; 2] = [18, 19];
    /// Number of codes in the list, 0..=8.
    pub const LIST_LENGTH: u8 = 20;
    /// Last good status byte of additional information 1 (15..0) and 2 (31..16): WRN, RM, Busy, I4..I0; then
    /// [`super::info_status`].
    pub const INFO_STATUS: u8 = 21;
    /// Watchdog in microseconds (15..0, 0 = off), shortest recovery time in system clock cycles (31..16, 0 = not checked).
    pub const LIMITS: u8 = 22;
    /// Continuous clock: bit 0 wanted, bit 1 stop after an error.
    pub const CONTINUOUS: u8 = 23;
    /// Longest wait of a request for a trigger, in milliseconds (15..0); 0 = none.
    pub const REQUEST_WAIT: u8 = 40;
    /// MRS codes that are selected in turn.
    pub const LIST: u8 = 24;
    /// Codes in the list at most, and slots.
    pub const LIST_MAX: u8 = 8;
    /// For each code of the list: 16 bits of content (15..0), number of the result that brought it (31..16).
    pub const SLOTS: u8 = 32;
    /// Frames of each cause, 32 bits; the first one counts good frames, the last two comparisons of positions that failed and
    /// additional informations with a wrong CRC.
    pub const COUNTERS: u8 = 48;
    /// Name plate: value (15..0), 1 = it has been read (31..16).
    pub const NAME_PLATE: u8 = 68;
    /// Where the program's own words begin.
    pub const PRIVATE: u8 = 96;
}

/// Counter of comparisons that failed, among those of the causes.
pub const COUNTER_POSITION_2: u8 = cause::COUNT as u8;

/// Counter of additional informations with a wrong CRC, the last one.
pub const COUNTER_BAD_INFOS: u8 = COUNTER_POSITION_2 + 1;

/// Bits above the status byte, in both halves of [`word::INFO_STATUS`].
pub mod info_status {
    /// The information that came last had a wrong CRC; nothing of it was taken.
    pub const BAD_CRC: u16 = 1 << 8;
}

/// Bits of [`word::REQUEST_STATE`].
pub mod request_state {
    /// A request is under way.
    pub const BUSY: u16 = 1 << 0;
    /// Where the error code stands.
    pub const ERROR_SHIFT: u32 = 4;
    /// The request was fulfilled.
    pub const OK: u16 = 0;
    /// No answer: the encoder did not understand the command, or refused it.
    pub const SILENT: u16 = 1;
    /// The echo of MRS code, address or port is another one.
    pub const ADDRESS_ECHO: u16 = 2;
    /// The echo of the data is another one.
    pub const DATA_ECHO: u16 = 3;
    /// The CRC of the answer is wrong.
    pub const CRC: u16 = 4;
    /// The code is no mode command; nothing was sent.
    pub const UNKNOWN: u16 = 5;
    /// The frame went wrong in another way, or could not begin.
    pub const FRAME: u16 = 6;
    /// Busy did not end.
    pub const BUSY_TIMEOUT: u16 = 7;
    /// No trigger came that it could ride on, or that brought its answer.
    pub const NO_TRIGGER: u16 = 8;
    /// The host has cancelled it.
    pub const CANCELLED: u16 = 9;

    /// What an error code means.
    pub const fn name(error: u16) -> &'static str {
        match error {
            OK => "fulfilled",
            SILENT => "no answer: command not understood or refused",
            ADDRESS_ECHO => "echo of MRS code, address or port wrong",
            DATA_ECHO => "echo of data wrong",
            CRC => "CRC of the answer wrong",
            UNKNOWN => "unknown mode command, nothing was sent",
            FRAME => "frame went wrong or could not begin",
            BUSY_TIMEOUT => "encoder stayed busy",
            NO_TRIGGER => "no trigger came in time for a request that rides on one",
            CANCELLED => "cancelled by the host",
            _ => "unknown",
        }
    }
}

/// Bits of [`word::CONTROL`].
pub mod control {
    /// Initialise the encoder.
    pub const INITIALISE: u16 = 1 << 0;
    /// Counters and the latched part of the state go to zero.
    pub const CLEAR: u16 = 1 << 1;
    /// The request under way is given up; what is on the wire is finished.
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
    /// The encoder knows EnDat 2.2.
    pub const ENDAT22: u16 = 1 << 3;
    /// The encoder has another width than configured; its own is used.
    pub const OTHER_WIDTH: u16 = 1 << 4;
    /// The encoder takes only a slower clock than configured; that is used.
    pub const SLOWER: u16 = 1 << 5;
    /// DATA has been HIGH for long: no encoder, or a broken line.
    pub const UNPLUGGED: u16 = 1 << 6;
    /// The encoder is being initialised, or the power-up sequence is under way; no position is taken.
    pub const INITIALISING: u16 = 1 << 7;
}

/// A word of the encoder that the name plate has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlateEntry {
    /// Name.
    pub name: &'static str,
    /// Memory area.
    pub mrs: u8,
    /// Address in it.
    pub address: u8,
    /// What it is.
    pub meaning: &'static str,
}

const fn entry(name: &'static str, mrs: u8, address: u8, meaning: &'static str) -> PlateEntry {
    PlateEntry {
        name,
        mrs,
        address,
        meaning,
    }
}

/// Words for EnDat 2.2.
pub const AREA_ENDAT22: u8 = 0xBD;
/// Address of the recovery time in the operating status.
pub const RECOVERY_ADDRESS: u8 = 3;
/// Bits of that word which are the recovery time; what the others mean is the encoder's.
pub const RECOVERY_MASK: u16 = 3;
/// Long recovery time, as written there (TI).
pub const RECOVERY_LONG: u16 = 2;
/// Short recovery time, as written there (TI).
pub const RECOVERY_SHORT: u16 = 1;

/// What initialisation reads, in its order; areas one after the other (TI, ADDI-DATA drivers; Beckhoff object list).
pub const NAME_PLATE: [PlateEntry; 21] = [
    entry("alarms", 0xB9, 0, "Alarms before they were cleared"),
    entry("warnings", 0xB9, 1, "Warnings before they were cleared"),
    entry(
        "position_bits",
        0xA1,
        0x0D,
        "Word 13: clock pulses for the position in bits 5..0",
    ),
    entry(
        "encoder_type",
        0xA1,
        0x0E,
        "Word 14: bit 15: 1 = rotary, 0 = linear",
    ),
    entry(
        "signal_periods_low",
        0xA1,
        0x0F,
        "Word 15: signal periods per revolution, or in nm",
    ),
    entry(
        "signal_periods_high",
        0xA3,
        0x00,
        "Word 16: upper part of word 15",
    ),
    entry(
        "revolutions",
        0xA3,
        0x01,
        "Word 17: distinguishable revolutions",
    ),
    entry(
        "steps_low",
        0xA3,
        0x04,
        "Word 20: measuring steps per revolution, or step in nm",
    ),
    entry("steps_high", 0xA3, 0x05, "Word 21: upper part of word 20"),
    entry(
        "id_0",
        0xA3,
        0x08,
        "Word 24: ID number, two ASCII characters",
    ),
    entry("id_1", 0xA3, 0x09, "Word 25: ID number, low"),
    entry("id_2", 0xA3, 0x0A, "Word 26: ID number, high"),
    entry(
        "serial_0",
        0xA3,
        0x0B,
        "Word 27: serial number: high byte, ASCII character",
    ),
    entry("serial_1", 0xA3, 0x0C, "Word 28: serial number, middle"),
    entry(
        "serial_2",
        0xA3,
        0x0D,
        "Word 29: ASCII character, serial number low byte",
    ),
    entry(
        "commands",
        0xA5,
        0x05,
        "Word 37: bits 1..0 = 01: EnDat 2.2; bits 3..2 = 01: functional safety",
    ),
    entry("tcal", 0xA5, 0x07, "Word 39: longest calculation time"),
    entry(
        "infos_1",
        0xBD,
        0x00,
        "EnDat 2.2 word 0: supported additional information 1",
    ),
    entry(
        "infos_2",
        0xBD,
        0x01,
        "EnDat 2.2 word 1: supported additional information 2",
    ),
    entry(
        "clock_max_khz",
        0xBD,
        0x19,
        "EnDat 2.2 word 25: fastest clock, in kHz",
    ),
    entry(
        "recovery",
        0xB9,
        0x03,
        "Word 3 of the operating status as set: bits 1..0 = 10: 10 to 30 us, 01: 1.25 to 3.75 us",
    ),
];
/// Where the tracked line delay stands behind the name plate, in system clock cycles.
pub const PLATE_DELAY: u8 = word::NAME_PLATE + NAME_PLATE.len() as u8;

/// Place of a name plate entry.
pub fn plate(name: &str) -> u8 {
    let index = NAME_PLATE.iter().position(|e| e.name == name);
    word::NAME_PLATE + index.expect("a name of the name plate") as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_of_the_name_plate_follow_each_other() {
        let mut areas: Vec<u8> = NAME_PLATE.iter().map(|e| e.mrs).collect();
        areas.dedup();
        assert_eq!(areas, [0xB9, 0xA1, 0xA3, 0xA5, 0xBD, 0xB9]);
        const { assert!(PLATE_DELAY < word::PRIVATE) };
        const { assert!(word::COUNTERS + COUNTER_BAD_INFOS < word::NAME_PLATE) };
    }
}
