//! Phases of the wire, in the order of a frame.

use rtl_design::States;
use rust_hdl::prelude::*;

/// Phase of the wire.
#[derive(Copy, Clone, PartialEq, Debug, LogicState, States)]
pub enum Phase {
    /// Idle, but data has not yet been low for tR.
    NotReady,
    /// Idle and ready for a trigger.
    Ready,
    /// First low phase, held for tST.
    FirstLow,
    /// Mode command, turnaround, waiting for the start bit, answer; then the supplement.
    Frame,
    /// The last CRC bit has been sampled; the cell after it must be high.
    Tail,
    /// Clock and data high: recovery time tm.
    Recovery,
    /// Quiet after an aborted frame.
    Abort,
    /// Clock LOW between answer and supplement.
    Park,
}
