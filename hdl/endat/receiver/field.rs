//! Fields of an answer.

use rtl_design::States;
use rust_hdl::prelude::*;

/// Field to which the next sample belongs.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum Field {
    /// Cells before the earliest start bit: the line is undefined.
    Skip,
    /// Low, until the start bit.
    Start,
    /// Error bit 1.
    F1,
    /// Error bit 2 (EnDat 2.2 frames).
    F2,
    /// Position, LSB first, or other content in its place.
    Payload,
    /// CRC, MSB first.
    Crc,
    /// LOW before a block of additional data.
    Separator,
    /// The clock continues: HIGH after the last CRC bit.
    GapHigh,
    /// LOW before the next start bit may come.
    GapLow,
    /// The answer is complete.
    Done,
    /// Cells of the supplement: the card drives the line, or it is undefined.
    Supplement,
}
