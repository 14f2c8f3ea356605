//! Ports that travel together between the blocks that send a frame and take its answer.
//!
//! ```text
//! Channel --NextFrame--> Transaction          FrameSettings --FrameLimits--> Transaction
//! Transaction --Control--> Receiver           Transaction --CellControl--> LineDelay --Cells--> Receiver, Transaction
//! CommandShape --AnswerShape--> Receiver
//! Receiver --Progress, AnswerCheck--> Transaction --AnswerCheck--> Verdict --Told--> Transaction, Snapshot
//! ```
//!
//! A second receiver has what the receiver has, and what it says.

use rtl_design::ports;
use rust_hdl::prelude::*;

/// What begins the next frame, and what it is.
#[ports]
pub struct NextFrame {
    /// One-cycle strobe: take a position.
    pub trigger: Bit,
    /// Strobe: measure the propagation delay again with the next frame.
    pub calibrate: Bit,
    /// The mode command is one that the core sends.
    pub is_known: Bit,
    /// Begin a frame without a trigger; `is_own` is high.
    pub begin_own: Bit,
    /// The frame under way, or the next one, is not a trigger's.
    pub is_own: Bit,
    /// No frame may begin.
    pub hold_off: Bit,
    /// The clock goes on after each position, and the next one follows without a command.
    pub continuous: Bit,
    /// It stops after an error.
    pub stop_at_error: Bit,
    /// The line is wanted for something else.
    pub line_wanted: Bit,
}

/// How long the parts of a frame may take.
#[ports]
pub struct FrameLimits {
    /// How much longer than half a period the first low phase is: 0, or at least 4 system clock cycles (tST).
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

/// What a receiver is told of the frame.
#[ports]
pub struct Control {
    /// One-cycle strobe: a frame begins; the first falling clock edge comes at the end of this cycle.
    pub start: Bit,
    /// The frame is given up: driver off at once, nothing is expected any more.
    pub aborts: Bit,
    /// The frame measures the propagation delay: cells before the start bit are counted by clock edges.
    pub acquire: Bit,
    /// One-cycle strobe: the supplement begins.
    pub start_supplement: Bit,
    /// The clock goes on after this answer, and another one follows.
    pub going_on: Bit,
}

/// How the cells of a frame run.
#[ports]
pub struct CellControl {
    /// A frame is under way on the wire; low between frames, where everything but the delay is forgotten.
    pub run: Bit,
    /// The clock waits: when the cells of all pulses that were sent have ended, a new burst begins.
    pub drain: Bit,
    /// One-cycle strobe: the last cell has begun. The next sample comes half a period after this, which may be that of another clock.
    pub last_cell: Bit,
    /// This frame runs at the calibration clock.
    pub slow: Bit,
}

/// Places of the answer's cells.
#[ports]
pub struct Cells {
    /// Strobe: a clock pulse is sent that the answer needs; not one before the start edge of a frame that measures.
    pub pulse: Bit,
    /// Strobe: the data line is sampled.
    pub sample: Bit,
    /// A rising data edge lies within the window of this cell.
    pub edge_in_window: Bit,
}

/// What an answer consists of.
#[ports]
pub struct AnswerShape {
    /// The answer begins with F1.
    pub has_f1: Bit,
    /// F2 follows F1; the selected additional data follow the position.
    pub has_f2: Bit,
    /// 24 bits follow the command, and the answer, which may take long, is 24 bits.
    pub has_parameter: Bit,
    /// A supplement follows the answer: the clock is parked LOW.
    pub has_supplement: Bit,
}

/// How far a receiver is.
#[ports]
pub struct Progress {
    /// The line is undefined: samples are not looked at.
    pub skipping: Bit,
    /// The start bit may come now.
    pub hunting: Bit,
    /// Strobe with `sample`: this sample is a good start bit.
    pub start_found: Bit,
    /// Strobe one cycle after `sample`: it was high, but its edge is outside the window.
    pub start_refused: Bit,
    /// The start bit has been taken.
    pub started: Bit,
    /// All clock pulses have been sent, or are on their way to the pin.
    pub all_sent: Bit,
    /// All but one.
    pub one_to_send: Bit,
    /// Strobe: the last one is counted in this cycle.
    pub last_sent: Bit,
    /// The cell of each pulse that was sent has ended.
    pub none_under_way: Bit,
    /// The counts of cells and pulses agree that this cell is the last one.
    pub all_used: Bit,
    /// They agree that there is none left.
    pub all_ended: Bit,
    /// Strobe: payload, error bits, CRC and verdict of the answer without additional data are valid.
    pub done: Bit,
    /// Strobe: payload and verdict of a block of additional data are valid.
    pub info_done: Bit,
    /// Strobe: the LOW in front of a block of additional data has come. Payload and verdict stay for two more cycles.
    pub separated: Bit,
    /// Strobe: a block of additional data should begin, but the line is HIGH.
    pub info_missing: Bit,
    /// Strobe: the last bit of an answer or of additional data has been sampled; with double edge `finished` may be some cells late.
    pub last_bit: Bit,
    /// Strobe: the answer with all its additional data, or the supplement, is complete.
    pub finished: Bit,
    /// Strobe: while the clock goes on, the cell after the last CRC bit is HIGH, as it should.
    pub gap_good: Bit,
    /// Strobe: while the clock goes on, the cell after the last CRC bit is LOW.
    pub gap_low: Bit,
    /// Strobe: while the clock goes on, the second cell after the last CRC bit is HIGH.
    pub gap_high: Bit,
    /// Strobe: the encoder has taken the next position, one propagation delay ago.
    pub latched: Bit,
}

/// What an answer says of itself.
#[ports]
pub struct AnswerCheck {
    /// It begins with the own mode command, leading zeros aside.
    pub is_echo: Bit,
    /// Error bit 1, high = alarm.
    pub f1: Bit,
    /// Error bit 2, low = alarm; high in frames without it.
    pub f2: Bit,
    /// The CRC of the bits as they came is the one received.
    pub crc_ok: Bit,
    /// The word as it is stored now fits the received CRC; without guards as `crc_ok`.
    pub stored_ok: Bit,
}

/// What has become of a frame.
#[ports]
pub struct Told {
    /// Strobe: result of a trigger, `cause` and `flags` are valid.
    pub publish: Bit,
    /// With `publish`: the position is good.
    pub good: Bit,
    /// Strobe: something was wrong after the result was published; cause and flags replace those of the result.
    pub late_fault: Bit,
    /// Strobe: the published position is not good after all; the one before comes back.
    pub withdraw: Bit,
    /// Strobe: the published position stands, nothing can withdraw it any more.
    pub confirm: Bit,
    /// Primary cause, with `publish`, `late_fault` or the end of a frame.
    pub cause_told: Bits<5>,
    /// Raw flags, one bit for each fault; bits as in the register map.
    pub flags_told: Bits<20>,
}
