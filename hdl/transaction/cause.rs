//! Why a frame gave no position: the codes of the status register, and the raw flags. Codes from [`COUNT`] on are those of T-format
//! channels, see [`crate::t_format::cause::of_card`].

/// The frame is good.
pub const NONE: u64 = 0;
/// Data was high when the frame was to start.
pub const DATA_NOT_LOW: u64 = 1;
/// No start bit within its time, on a line that works: the encoder is silent.
pub const NO_START_BIT: u64 = 2;
/// A start bit at a time that does not fit the propagation delay.
pub const START_WINDOW: u64 = 3;
/// The CRC is wrong.
pub const CRC: u64 = 4;
/// Error bit 1 is set: the encoder reports an alarm.
pub const F1: u64 = 5;
/// Error bit 2 is clear: the encoder reports an alarm.
pub const F2: u64 = 6;
/// Data stayed high after the frame.
pub const DATA_NOT_FALLING: u64 = 7;
/// A trigger came while a frame was under way.
pub const TRIGGER_OVERRUN: u64 = 8;
/// The mode command is not one that the core sends; nothing went out.
pub const UNKNOWN_COMMAND: u64 = 9;
/// An additional information that should follow the position did not come; the position is good.
pub const INFO_MISSING: u64 = 10;
/// Data was high when the frame was to start, and nobody drives the line.
pub const NO_ENCODER: u64 = 11;
/// Data was high when the frame was to start, whatever the receiver does.
pub const STUCK_HIGH: u64 = 12;
/// Data stayed low through the frame, the own mode command included.
pub const STUCK_LOW: u64 = 13;
/// The start bit came after its time.
pub const LATE_START: u64 = 14;
/// The frame took longer than the watchdog allows.
pub const WATCHDOG: u64 = 15;
/// What came instead of an answer is the own mode command.
pub const OWN_ECHO: u64 = 16;
/// Data fell too early after the frame; the position is good.
pub const RECOVERY_TOO_SHORT: u64 = 17;
/// Codes there are of EnDat frames.
pub const COUNT: u64 = 18;
/// What is stored does not fit its check: a register was upset. Of both protocols, so it stands behind all others.
pub const UPSET: u64 = 31;
/// Codes there are of both protocols.
pub const ALL_COUNT: u64 = 32;

/// Raw flag of a cause.
pub const fn flag(cause: u64) -> u64 {
    match cause {
        NONE => 0,
        1..=8 => 1 << (cause - 1),
        UPSET => 1 << (COUNT + 1),
        _ => 1 << (cause + 1),
    }
}

/// Raw flags that are no cause of their own.
pub mod flag {
    /// The parallel CRC is wrong.
    pub const PARALLEL_CRC: u64 = 1 << 8;
    /// Data was not high after the last bit: the frame has another length.
    pub const TAIL_LOW: u64 = 1 << 9;
}

/// Name of a code.
pub const fn name(code: u64) -> &'static str {
    match code {
        NONE => "none",
        DATA_NOT_LOW => "data not low before start",
        NO_START_BIT => "no start bit",
        START_WINDOW => "start bit outside its window",
        CRC => "CRC",
        F1 => "F1",
        F2 => "F2",
        DATA_NOT_FALLING => "data not falling after the frame",
        TRIGGER_OVERRUN => "trigger overrun",
        UNKNOWN_COMMAND => "unknown mode command",
        INFO_MISSING => "additional information missing",
        NO_ENCODER => "no encoder",
        STUCK_HIGH => "data stuck high",
        STUCK_LOW => "data stuck low",
        LATE_START => "late start bit",
        WATCHDOG => "watchdog",
        OWN_ECHO => "echo of the own command",
        RECOVERY_TOO_SHORT => "recovery time too short",
        UPSET => "stored data upset",
        _ => "unknown",
    }
}
