//! What each guard of a position channel costs: its area without that guard.

/// A guard, and the changes of the emitted Verilog that take its effect away, so that synthesis removes it.
#[derive(Clone, Copy, Debug)]
pub struct Guard {
    /// Name of the subject that lacks it.
    pub name: &'static str,
    /// What the guard does.
    pub title: &'static str,
    /// Block, text that stands once in its file, what it becomes.
    pub edits: &'static [(&'static str, &'static str, &'static str)],
}

const SNAPSHOT: &str = "snapshot";
const TRANSACTION: &str = "transaction";
const SETTINGS: &str = "frame_settings";

/// All of them.
pub const GUARDS: [Guard; 10] = [
    Guard {
        name: "channel_without_restore",
        title: "a withdrawn position gives way to the one before, with its time stamp and CRC",
        edits: &[
            (SNAPSHOT, "held_next = earlier;", "held_next = held;"),
            (
                SNAPSHOT,
                "held_crc_next = earlier_crc;",
                "held_crc_next = held_crc;",
            ),
            (
                SNAPSHOT,
                "held_width_next = earlier_width;",
                "held_width_next = held_width;",
            ),
            (
                SNAPSHOT,
                "held_f2_next = earlier_f2;",
                "held_f2_next = held_f2;",
            ),
            (
                SNAPSHOT,
                " stamp_next = earlier_stamp;",
                " stamp_next = stamp;",
            ),
        ],
    },
    Guard {
        name: "channel_without_crc",
        title: "parallel CRC over the aligned word, until it is published",
        edits: &[("crc5_check", "is_ok = sum == received", "is_ok = 1'b1")],
    },
    Guard {
        name: "channel_without_parity",
        title: "parity of the stored position, its CRC, width and time stamp",
        edits: &[(SNAPSHOT, "upset_now = is_upset &", "upset_now = 1'b0 &")],
    },
    Guard {
        name: "channel_without_pulses",
        title: "the counts of clock pulses, compared when the frame is over",
        edits: &[(TRANSACTION, "sample & !tail_sampled & !all_used", "1'b0")],
    },
    Guard {
        name: "channel_without_moment",
        title: "parity of the time stamp while the frame runs",
        edits: &[(SNAPSHOT, "moment_wrong = good &", "moment_wrong = 1'b0 &")],
    },
    Guard {
        name: "channel_without_delay",
        title: "parity of the tracked delay",
        edits: &[("line_delay", "wrong_next = 1'b1", "wrong_next = 1'b0")],
    },
    Guard {
        name: "channel_without_limits",
        title: "time-outs that end although the timer has run past them",
        edits: &[(
            TRANSACTION,
            "(timer >= timer_limit) & !cleared",
            "(timer == timer_limit)",
        )],
    },
    Guard {
        name: "channel_without_settings",
        title: "command and width as at the start of the frame: taken over, with parity",
        edits: &[
            (
                SETTINGS,
                "is_upset = parity_now ^ parity",
                "is_upset = 1'b0",
            ),
            (SETTINGS, "if (is_at_rest) begin", "if (1'b1) begin"),
        ],
    },
    Guard {
        name: "channel_without_second",
        title: "a frame at the full clock behind one at the calibration clock",
        edits: &[(
            TRANSACTION,
            "measuring_next = !known",
            "measuring_next = 1'b0",
        )],
    },
    Guard {
        name: "channel_without_owing",
        title: "an end of each frame and a result for each trigger, whatever becomes of its state",
        edits: &[
            (
                TRANSACTION,
                "if (accept) begin\n            owing_next = 1'b1;",
                "if (accept) begin\n            owing_next = 1'b0;",
            ),
            (
                TRANSACTION,
                "under_way_next = 1'b1",
                "under_way_next = 1'b0",
            ),
        ],
    },
];
