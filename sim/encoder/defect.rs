//! How an encoder can be wrong in one frame.

use crate::Time;

/// Something wrong with one frame, to be noticed by the receiver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Defect {
    /// Stays LOW instead of answering.
    NoStartBit,
    /// Needs this much longer for its calculation.
    LateStart(Time),
    /// Answers at this rising edge (1 = first), however early that is.
    StartAtEdge(u32),
    /// Sends these error bits (with a CRC that fits them); good are F1 = 0, F2 = 1.
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
        /// Which of the two.
        info: u8,
        /// The bits.
        xor: u8,
    },
    /// Echoes address and parameter with these bits inverted (address in bits 23..16), and a CRC that fits.
    EchoXor(u32),
    /// Inverts the answer bits whose number (0 = start bit) is set in the mask.
    FlipBits(u128),
    /// From this answer bit to the end of the recovery time the line is held at `level`.
    StuckFrom {
        /// First wrong bit, 0 = start bit.
        bit: u32,
        /// The level.
        level: bool,
    },
    /// From this answer bit (0 = start bit) to the end of the recovery time nobody drives the line.
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
    /// Does not see the clock pulse that ends in this rising edge.
    MissEdge(u32),
    /// Takes this rising edge for two.
    DoubleEdge(u32),
    /// Drives the wrong level for a moment.
    Glitch {
        /// From the first falling edge.
        after: Time,
        /// How long.
        width: Time,
    },
    /// Goes dead (as after a loss of supply) this long after the first falling edge, for this long.
    BrownOut {
        /// From the first falling edge.
        after: Time,
        /// How long until it is ready again.
        length: Time,
    },
}
