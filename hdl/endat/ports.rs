//! Bundles of ports between the blocks that send a frame and receive its answer.
//!
//! ```text
//! Channel --NextFrame--> Transaction          FrameSettings --FrameLimits--> Transaction
//! Transaction --Control--> Receiver           Transaction --CellControl--> LineDelay --Cells--> Receiver, Transaction
//! CommandShape --AnswerShape--> Receiver
//! Receiver --Progress, AnswerCheck--> Transaction --AnswerCheck--> Verdict --Told--> Transaction, Snapshot
//! ```
//!
//! A second receiver has the inputs and outputs of the receiver.

use rtl_design::ports;
use rust_hdl::prelude::*;

/// Start of the next frame, and its parameters.
#[ports]
pub struct NextFrame {
    /// One-cycle strobe: read a position.
    pub trigger: Bit,
    /// Strobe: measure the propagation delay again with the next frame.
    pub calibrate: Bit,
    /// The mode command is one that the core sends.
    pub is_known: Bit,
    /// Begin a frame without a trigger; `is_own` is high.
    pub begin_own: Bit,
    /// The frame under way, or the next one, belongs to a request, not to a trigger.
    pub is_own: Bit,
    /// No frame may begin.
    pub hold_off: Bit,
    /// The clock continues after each position, and the next one follows without a command.
    pub continuous: Bit,
    /// It stops after an error.
    pub stop_at_error: Bit,
    /// Something else needs the line.
    pub line_wanted: Bit,
}

/// Time limits for the parts of a frame.
#[ports]
pub struct FrameLimits {
    /// Extension of the first low phase beyond half a period: 0, or at least 4 system clock cycles (tST).
    pub first_low_extra_cycles: Bits<11>,
    /// Longest wait for the start bit after the turnaround, in microseconds.
    pub start_timeout_us: Bits<12>,
    /// Data must fall within this many system clock cycles after the frame.
    pub recovery_limit_cycles: Bits<13>,
    /// Data must not fall before this after the frame; 0 = not checked.
    pub recovery_min_cycles: Bits<13>,
    /// Longest time from the first falling edge to the end of the recovery time; 0 = not watched.
    pub watchdog_us: Bits<12>,
}

/// Control of a receiver during a frame.
#[ports]
pub struct Control {
    /// One-cycle strobe: a frame begins; the first falling clock edge comes at the end of this cycle.
    pub start: Bit,
    /// The frame is aborted: driver off at once, the receiver expects nothing more.
    pub aborts: Bit,
    /// The frame measures the propagation delay: cells before the start bit are counted by clock edges.
    pub acquire: Bit,
    /// One-cycle strobe: the supplement begins.
    pub start_supplement: Bit,
    /// The clock continues after this answer, and another one follows.
    pub going_on: Bit,
}

/// Timing control of the cells of a frame.
#[ports]
pub struct CellControl {
    /// A frame is under way on the wire; between frames all timing state except the delay is cleared.
    pub run: Bit,
    /// The clock stops: when the cells of all sent pulses have ended, a new burst begins.
    pub drain: Bit,
    /// One-cycle strobe: the last cell has begun. The next sample comes half a period later, possibly of another clock.
    pub last_cell: Bit,
    /// This frame runs at the calibration clock.
    pub slow: Bit,
}

/// Places of the answer's cells.
#[ports]
pub struct Cells {
    /// Strobe: a clock pulse of the answer is sent; in a frame that measures, only from the start edge on.
    pub pulse: Bit,
    /// Strobe: the data line is sampled.
    pub sample: Bit,
    /// A rising data edge lies within the window of this cell.
    pub edge_in_window: Bit,
}

/// Parts of an answer.
#[ports]
pub struct AnswerShape {
    /// The answer begins with F1.
    pub has_f1: Bit,
    /// F2 follows F1; the selected additional data follow the position.
    pub has_f2: Bit,
    /// 24 bits follow the command; the answer is 24 bits and may take long.
    pub has_parameter: Bit,
    /// A supplement follows the answer: the clock is parked LOW.
    pub has_supplement: Bit,
}

/// Progress of a receiver.
#[ports]
pub struct Progress {
    /// The line is undefined: samples are ignored.
    pub skipping: Bit,
    /// The start bit may come now.
    pub hunting: Bit,
    /// Strobe with `sample`: this sample is a good start bit.
    pub start_found: Bit,
    /// Strobe one cycle after `sample`: the sample was high, but its edge is outside the window.
    pub start_refused: Bit,
    /// The start bit has been received.
    pub started: Bit,
    /// All clock pulses have been sent, or are on their way to the pin.
    pub all_sent: Bit,
    /// All clock pulses but one have been sent.
    pub one_to_send: Bit,
    /// Strobe: the last pulse is counted in this cycle.
    pub last_sent: Bit,
    /// The cell of each sent pulse has ended.
    pub none_under_way: Bit,
    /// The counts of cells and pulses agree that this cell is the last one.
    pub all_used: Bit,
    /// The counts of cells and pulses agree that no cell is left.
    pub all_ended: Bit,
    /// Strobe: payload, error bits, CRC and verdict of the answer without additional data are valid.
    pub done: Bit,
    /// Strobe: payload and verdict of a block of additional data are valid.
    pub info_done: Bit,
    /// Strobe: the LOW in front of a block of additional data was sampled. Payload and verdict stay for two more cycles.
    pub separated: Bit,
    /// Strobe: a block of additional data should begin, but the line is HIGH.
    pub info_missing: Bit,
    /// Strobe: the last bit of an answer or of additional data has been sampled; with double edge `finished` may be some cells late.
    pub last_bit: Bit,
    /// Strobe: the answer with all its additional data, or the supplement, is complete.
    pub finished: Bit,
    /// Strobe: while the clock continues, the cell after the last CRC bit is HIGH, as it should be.
    pub gap_good: Bit,
    /// Strobe: while the clock continues, the cell after the last CRC bit is LOW.
    pub gap_low: Bit,
    /// Strobe: while the clock continues, the second cell after the last CRC bit is HIGH.
    pub gap_high: Bit,
    /// Strobe: the encoder has latched the next position, one propagation delay ago.
    pub latched: Bit,
}

/// Checks of an answer.
#[ports]
pub struct AnswerCheck {
    /// The answer begins with the card's own mode command, ignoring leading zeros.
    pub is_echo: Bit,
    /// Error bit 1, high = alarm.
    pub f1: Bit,
    /// Error bit 2, low = alarm; high in frames without it.
    pub f2: Bit,
    /// The CRC of the bits as received equals the received CRC.
    pub crc_ok: Bit,
    /// The stored word matches the received CRC; without guards equal to `crc_ok`.
    pub stored_ok: Bit,
}

/// Outcome of a frame.
#[ports]
pub struct Told {
    /// Strobe: result of a trigger, `cause` and `flags` are valid.
    pub publish: Bit,
    /// With `publish`: the position is good.
    pub good: Bit,
    /// Strobe: a fault was found after the result was published; cause and flags replace those of the result.
    pub late_fault: Bit,
    /// Strobe: the published position is not good after all; the previous one returns.
    pub withdraw: Bit,
    /// Strobe: the published position is final.
    pub confirm: Bit,
    /// Primary cause, with `publish`, `late_fault` or the end of a frame.
    pub cause_told: Bits<5>,
    /// Raw flags, one bit for each fault; bits as in the register map.
    pub flags_told: Bits<20>,
}
