//! What an encoder is doing, in the order of a frame.

use rtl_design::States;
use rust_hdl::prelude::*;

/// What an encoder is doing.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum Phase {
    /// Driver off, edges ignored, until CLOCK has been HIGH for long: after a reset, without plug, or out of step with the receiver.
    Deaf,
    /// DATA LOW: waits for the first falling edge.
    Idle,
    /// The mode command comes in.
    Listen,
    /// The mode command has no answer here: DATA LOW until CLOCK has been HIGH for long.
    Refuse,
    /// DATA LOW until the calculation time is over.
    Wait,
    /// F1 is next.
    F1,
    /// F2 is next (EnDat 2.2 commands).
    F2,
    /// A bit of the position is next, LSB first.
    Position,
    /// A bit of the CRC is next, MSB first.
    Crc,
    /// All bits are sent; HIGH is next.
    Tail,
    /// DATA HIGH: recovery time tm.
    Recovery,
}
