//! The line monitor of a channel: sampling phase and timing margin.

use crate::part::Part;
use crate::{field, word, Access, Block, Field, Register, LINE_BASE, LINE_STRIDE};
use word as at;
use Access::{ReadOnly, ReadWrite, Strobe};

/// Addresses of the monitor's words.
pub mod word {
    /// Histogram of the offsets: first bin -16 or less, last bin 15 or more.
    pub const HISTOGRAM: u8 = 0;
    /// Source of the phase, majority, bin width.
    pub const ALIGNMENT: u8 = 32;
    /// Delay in mode `fixed`.
    pub const FIXED_DELAY: u8 = 33;
    /// Limits of the alarms.
    pub const LIMITS: u8 = 34;
    /// Strobes that clear.
    pub const CLEAR: u8 = 35;
    /// Offsets of the last frame.
    pub const FRAME: u8 = 40;
    /// Offsets since cleared, alarms.
    pub const WORST: u8 = 41;
    /// Tracked delay and its reference.
    pub const PHASE: u8 = 42;
    /// Glitches and bad frames.
    pub const COUNTS: u8 = 43;
    /// Frames.
    pub const FRAMES: u8 = 44;
}

/// Sources of the phase.
pub mod mode {
    crate::named::codes! {
        /// All modes.
        ALL: u64;
        TRACKED = 0, "tracked", "mean of many edges";
        FIXED = 1, "fixed", "fixed_delay";
        FRAME = 2, "frame", "start bit of each frame";
    }
}

const EDGES: &[Field] = &[field("edges", 0, 32, "", "Edges since clear, wrapping")];

const fn bin(name: &'static str, index: u8, meaning: &'static str) -> Register {
    word(name, at::HISTOGRAM + index, ReadOnly, meaning, EDGES).of(Part::Margin)
}

/// Sampling phase and timing margin.
pub const LINE: Block = Block {
    name: "line",
    base: LINE_BASE,
    stride: LINE_STRIDE,
    per_channel: true,
    meaning: "Sampling phase and timing margin. A place is a system clock cycle, or half of one with double_edge; offsets are signed.",
    is_ram: false,
    part: Some(Part::Alignment),
    registers: &[
        bin("edges_0", 0, "Edges with offset -16 or less (all bins: offset divided by 2^bin_shift)."),
        bin("edges_1", 1, "Edges with offset -15."),
        bin("edges_2", 2, "Edges with offset -14."),
        bin("edges_3", 3, "Edges with offset -13."),
        bin("edges_4", 4, "Edges with offset -12."),
        bin("edges_5", 5, "Edges with offset -11."),
        bin("edges_6", 6, "Edges with offset -10."),
        bin("edges_7", 7, "Edges with offset -9."),
        bin("edges_8", 8, "Edges with offset -8."),
        bin("edges_9", 9, "Edges with offset -7."),
        bin("edges_10", 10, "Edges with offset -6."),
        bin("edges_11", 11, "Edges with offset -5."),
        bin("edges_12", 12, "Edges with offset -4."),
        bin("edges_13", 13, "Edges with offset -3."),
        bin("edges_14", 14, "Edges with offset -2."),
        bin("edges_15", 15, "Edges with offset -1: at the expected place, or up to one place before."),
        bin("edges_16", 16, "Edges with offset 0: up to one place after the expected one."),
        bin("edges_17", 17, "Edges with offset 1."),
        bin("edges_18", 18, "Edges with offset 2."),
        bin("edges_19", 19, "Edges with offset 3."),
        bin("edges_20", 20, "Edges with offset 4."),
        bin("edges_21", 21, "Edges with offset 5."),
        bin("edges_22", 22, "Edges with offset 6."),
        bin("edges_23", 23, "Edges with offset 7."),
        bin("edges_24", 24, "Edges with offset 8."),
        bin("edges_25", 25, "Edges with offset 9."),
        bin("edges_26", 26, "Edges with offset 10."),
        bin("edges_27", 27, "Edges with offset 11."),
        bin("edges_28", 28, "Edges with offset 12."),
        bin("edges_29", 29, "Edges with offset 13."),
        bin("edges_30", 30, "Edges with offset 14."),
        bin("edges_31", 31, "Edges with offset 15 or more."),
        word("alignment", at::ALIGNMENT, ReadWrite, "Source of the phase; takes effect between two frames.", &[
            field("mode", 0, 2, "", "Source of the sampling phase").codes(mode::ALL),
            field("majority", 4, 1, "", "Each sample is the majority of itself and its two neighbours; measure the delay again after a change"),
            field("bin_shift", 8, 2, "", "Bins of the histogram are 2^bin_shift places wide; clear after a change"),
        ]),
        word("fixed_delay", at::FIXED_DELAY, ReadWrite, "Delay in mode fixed, including synchroniser and filter.", &[
            field("value", 0, 15, "cycles/16", "In the format of phase.tracked"),
        ]),
        word("limits", at::LIMITS, ReadWrite, "Limits of the alarms; 0 = none.", &[
            field("drift", 0, 12, "cycles/16", "Largest allowed distance of the tracked delay from its reference"),
            field("offset", 16, 7, "places", "Largest allowed offset of an edge"),
        ]),
        word("clear", at::CLEAR, Strobe, "Clears the monitor, or sets the reference.", &[
            field("clear", 0, 1, "", "Write 1: histogram, worst edges, alarms, counters"),
            field("reference", 1, 1, "", "Write 1: the tracked delay becomes the reference"),
        ]),
        word("frame", at::FRAME, ReadOnly, "Edges of the last frame.", &[
            field("earliest", 0, 8, "places", "Smallest offset"),
            field("latest", 8, 8, "places", "Largest offset"),
            field("start", 16, 8, "places", "Offset of the start bit's edge"),
        ]).of(Part::Margin),
        word("worst", at::WORST, ReadOnly, "Extreme edges since clear.", &[
            field("earliest", 0, 8, "places", "Smallest offset"),
            field("latest", 8, 8, "places", "Largest offset"),
            field("valid", 16, 1, "", "At least one edge was measured"),
            field("drift_alarm", 24, 1, "", "The drift exceeded its limit"),
            field("offset_alarm", 25, 1, "", "An edge exceeded its limit"),
        ]).of(Part::Margin),
        word("phase", at::PHASE, ReadOnly, "Tracked delay, including synchroniser and filter.", &[
            field("tracked", 0, 15, "cycles/16", "Mean place of the edges after their clock edge"),
            field("reference", 16, 15, "cycles/16", "Tracked delay when it was measured or last set as reference"),
        ]),
        word("counts", at::COUNTS, ReadOnly, "Counters, wrapping.", &[
            field("glitches", 0, 16, "", "Pulses removed by the input filter since clear"),
            field("bad_frames", 16, 16, "", "Frames with a cause other than 0 since clear"),
        ]).of(Part::Margin),
        word("frames", at::FRAMES, ReadOnly, "Frames since clear, wrapping.", &[
            field("value", 0, 32, "", "Frames"),
        ]).of(Part::Margin),
    ],
};
