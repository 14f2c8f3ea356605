//! Ports of the service's program. The register table has the words of its RAM: [`endat_regs::service`].

/// Ports that the program reads.
pub mod input {
    /// Bits of [`STATUS`].
    pub mod status {
        /// A frame has ended, and the program has not handled it.
        pub const EVENT: u16 = 1 << 0;
        /// That frame carried the request.
        pub const IS_REQUEST: u16 = 1 << 1;
        /// The host has written the request word.
        pub const MAILBOX: u16 = 1 << 2;
        /// The host has written the control word.
        pub const CONTROL: u16 = 1 << 3;
        /// DATA is HIGH, and no frame is on the wire.
        pub const LINE_HIGH: u16 = 1 << 4;
        /// The CRC of the answer to the last separate request frame is right.
        pub const REPLY_GOOD: u16 = 1 << 5;
        /// The last frame brought additional data 1 with a right CRC.
        pub const INFO_1: u16 = 1 << 6;
        /// The last frame brought additional data 2 with a right CRC.
        pub const INFO_2: u16 = 1 << 7;
        /// The encoder sends additional data 1.
        pub const INFO_1_ACTIVE: u16 = 1 << 8;
        /// A frame ended before the program handled the previous one.
        pub const MISSED: u16 = 1 << 9;
        /// The last frame brought a good position.
        pub const FRESH: u16 = 1 << 10;
        /// The frame under way carries the request.
        pub const REQUEST_RUNS: u16 = 1 << 11;
        /// The last frame brought additional data 1, with a right CRC or a wrong one.
        pub const INFO_1_CAME: u16 = 1 << 12;
        /// The last frame brought additional data 2, with a right CRC or a wrong one.
        pub const INFO_2_CAME: u16 = 1 << 13;
        /// The host has written at least half of a word.
        pub const WRITTEN: u16 = 1 << 14;
    }
    /// Events and state.
    pub const STATUS: u8 = 0;
    /// Primary cause of the frame that ended.
    pub const CAUSE: u8 = 1;
    /// Additional data 1: its 16 bits.
    pub const INFO_1: u8 = 2;
    /// WRN, RM, Busy, I4..I0 of additional data 1.
    pub const INFO_1_STATUS: u8 = 3;
    /// Additional data 2: its 16 bits.
    pub const INFO_2: u8 = 4;
    /// WRN, RM, Busy, I4..I0 of additional data 2.
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
    /// Number of the ports above.
    pub const WORDS: u8 = DELAY + 1;
    /// Microseconds, wrapping. Ports from 24 on are equal for all channels.
    pub const TIME_US: u8 = 30;
    /// Milliseconds, wrapping.
    pub const TIME_MS: u8 = 31;
}

/// Ports that the program writes.
pub mod output {
    /// Bits of [`GO`].
    pub mod go {
        /// The next triggered frame carries the request.
        pub const RIDE: u16 = 1 << 0;
        /// The request gets a separate frame.
        pub const OWN: u16 = 1 << 1;
        /// Cancels a request that has not begun.
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
        /// The end of the frame has been handled.
        pub const EVENT: u16 = 1 << 0;
        /// The request has been read.
        pub const MAILBOX: u16 = 1 << 1;
        /// The control word has been read.
        pub const CONTROL: u16 = 1 << 2;
        /// The program is about to guard the words that the host has written.
        pub const WRITTEN: u16 = 1 << 3;
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
    /// Properties of the encoder: position bits (5..0, 0 = unknown), supports EnDat 2.1 only (6).
    pub const FOUND: u8 = 7;
    /// EnDat clock period for the encoder, in system clock cycles; 0 = as configured.
    pub const PERIOD: u8 = 8;
    /// Watchdog, in microseconds.
    pub const WATCHDOG: u8 = 9;
    /// Shortest recovery time, in system clock cycles.
    pub const RECOVERY_MIN: u8 = 10;
    /// Continuous clock: as [`super::word::CONTINUOUS`].
    pub const CONTINUOUS: u8 = 11;
    /// Any value: the program is running, or waits for something with a time limit.
    pub const ALIVE: u8 = 12;
}

pub use endat_regs::service::*;

/// Memory area for EnDat 2.2.
pub const AREA_ENDAT22: u8 = 0xBD;
/// Address of the recovery time in the operating status.
pub const RECOVERY_ADDRESS: u8 = 3;
/// Recovery time bits of that word; the encoder defines the others.
pub const RECOVERY_MASK: u16 = 3;
/// Long recovery time (TI).
pub const RECOVERY_LONG: u16 = 2;
/// Short recovery time (TI).
pub const RECOVERY_SHORT: u16 = 1;
