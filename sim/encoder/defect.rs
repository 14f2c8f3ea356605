//! Faults of an encoder in one frame.

use crate::Time;

/// A fault in one frame, to be detected by the receiver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Defect {
    /// Stays LOW instead of answering.
    NoStartBit,
    /// Extends its calculation time by this time.
    LateStart(Time),
    /// Answers at this rising edge (1 = first), however early that is.
    StartAtEdge(u32),
    /// Sends these error bits (with a matching CRC); good are F1 = 0, F2 = 1.
    ErrorBits {
        /// First error bit, 1 = error.
        f1: bool,
        /// Second error bit, 0 = error.
        f2: bool,
    },
    /// Sends the CRC with these bits inverted.
    CrcXor(u8),
    /// Sends the CRC of additional data 1 or 2 with these bits inverted.
    InfoCrcXor {
        /// Additional data 1 or 2.
        info: u8,
        /// Inverted bits.
        xor: u8,
    },
    /// Echoes address and parameter with these bits inverted (address in bits 23..16), and a matching CRC.
    EchoXor(u32),
    /// Inverts the answer bits whose number (0 = start bit) is set in the mask.
    FlipBits(u128),
    /// Holds the line at `level` from this answer bit to the end of the recovery time.
    StuckFrom {
        /// First wrong bit, 0 = start bit.
        bit: u32,
        /// The level.
        level: bool,
    },
    /// Does not drive the line from this answer bit (0 = start bit) to the end of the recovery time.
    OpenFrom(u32),
    /// Does not drive the line from the first falling edge to the end of the recovery time.
    Open,
    /// Holds the line HIGH this much longer than the recovery time.
    LateFall(Time),
    /// Goes HIGH again, 1 us after the recovery time, for this long.
    HighWhenIdle(Time),
    /// Sends a position this many bits wider (or narrower).
    WiderBy(i32),
    /// Answers as an EnDat 2.1 encoder: without F2.
    WithoutF2,
    /// Ignores the clock pulse that ends in this rising edge.
    MissEdge(u32),
    /// Counts this rising edge twice.
    DoubleEdge(u32),
    /// Drives the wrong level for a short time.
    Glitch {
        /// From the first falling edge.
        after: Time,
        /// Duration.
        width: Time,
    },
    /// Goes dead (as after a loss of supply) this long after the first falling edge, for this long.
    BrownOut {
        /// From the first falling edge.
        after: Time,
        /// Time until it is ready again.
        length: Time,
    },
}
