//! Why a frame gave no position: the codes of the status register.

/// The frame is good.
pub const NONE: u64 = 0;
/// Data was high when the frame was to start.
pub const DATA_NOT_LOW: u64 = 1;
/// No start bit within its time.
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

/// Name of a code.
pub fn name(code: u64) -> &'static str {
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
        _ => "unknown",
    }
}
