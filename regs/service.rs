//! The service of a channel: its words, in RAM.

mod plate;
mod steps;
mod words;

pub use plate::*;
pub use steps::STEPS;
pub use words::*;

use crate::causes::endat;
use crate::part::Part;
use crate::protocol::MODE_COMMANDS;
use crate::{field, word, Access, Block, Field, Register, SERVICE_BASE};
use request_state::ERRORS;
use word as at;
use Access::{ReadOnly, ReadWrite};

const VALUE: &[Field] = &[field("value", 0, 32, "", "Number")];
const HIGH: &[Field] = &[field("value", 0, 16, "", "Bits 47..32")];
const CODE: &[Field] =
    &[field("mrs", 0, 8, "", "MRS code 0x40..0x5E").takes(&[(0, 0), (0x40, 0x5E)])];
const SLOT: &[Field] = &[
    field("value", 0, 16, "", "Content"),
    field(
        "sequence",
        16,
        16,
        "",
        "status.sequence of the frame that brought it; the difference is its age",
    ),
];
const COUNT: &[Field] = &[field("frames", 0, 32, "", "Frames since clear, wrapping")];
const PLATE: &[Field] = &[
    field("value", 0, 16, "", "Content of the encoder's word"),
    field("is_read", 16, 1, "", "The word has been read"),
];

const fn list(name: &'static str, i: u8) -> Register {
    word(name, at::LIST + i, ReadWrite, "A code of the list.", CODE)
}

const fn slot(name: &'static str, i: u8) -> Register {
    word(
        name,
        at::SLOTS + i,
        ReadOnly,
        "Last content of the additional data with that code.",
        SLOT,
    )
}

const fn frames(cause: u8) -> Register {
    let counter = word(
        match cause {
            0 => "frames_good",
            cause => crate::causes::cause::row(endat::ALL, cause as u64).counter,
        },
        at::COUNTERS + cause,
        ReadOnly,
        "Frames that ended with this cause (good: without one).",
        COUNT,
    );
    // Only the line diagnosis detects these.
    match cause as u64 {
        endat::NO_ENCODER.. => counter.of(Part::Diagnosis),
        _ => counter,
    }
}

const fn plate_word(i: usize) -> Register {
    let entry = &NAME_PLATE[i];
    word(
        entry.name,
        at::NAME_PLATE + i as u8,
        ReadOnly,
        entry.meaning,
        PLATE,
    )
    .of(Part::Initialise)
}

/// Requests, health, slots and name plate of a channel. Cards without service have no such block. RAM: a reset does not clear it.
pub const SERVICE: Block = Block {
    name: "service",
    base: SERVICE_BASE,
    stride: 128,
    per_channel: true,
    meaning: "Requests, health, slots and name plate of a channel. RAM: 0 after power-up, a reset does not clear it.",
    is_ram: true,
    part: Some(Part::Requests),
    registers: &[
        word("request", at::REQUEST, ReadWrite, "Sends a request when written.", &[
            field("data", 0, 16, "", "Data"),
            field("address", 16, 8, "", "MRS code, address or port"),
            field("command", 24, 6, "", "Mode command, any of the fourteen").codes(MODE_COMMANDS),
        ]),
        word("request_state", at::REQUEST_STATE, ReadOnly, "State of the request.", &[
            field("busy", 0, 1, "", "The request is under way"),
            field("error", 4, 4, "", "Error of the request").codes(ERRORS),
            field("finished", 16, 16, "", "Requests finished, wrapping"),
        ]),
        word("answer", at::ANSWER, ReadOnly, "Answer to the last request; bits 31..0 of a longer one.", &[
            field("data", 0, 16, "", "Data, or content of additional data 1"),
            field("address", 16, 8, "", "Echo of MRS code, address or port; or WRN, RM, Busy, I4..I0"),
        ]),
        word("answer_more", at::ANSWER_MORE, ReadOnly, "Bits 47..32 of a longer answer.", HIGH),
        word("duration", at::DURATION, ReadOnly, "Duration of the last request.", &[
            field("us", 0, 16, "us", "Modulo 65536"),
            field("ms", 16, 16, "ms", "Milliseconds"),
        ]),
        word("control", at::CONTROL, ReadWrite, "Actions on write.", &[
            field("initialise", 0, 1, "", "1: initialise the encoder"),
            field("clear", 1, 1, "", "1: counters, alarm, position_2 and error_test to zero; lost.triggers goes on"),
            field("cancel", 2, 1, "", "1: cancel the request that waits for a trigger; one on the wire is finished"),
        ]),
        word("force", at::FORCE, ReadWrite, "Forced errors in the received data, for tests of the error paths; not for regular operation.", &[
            field("f1", 0, 1, "", "Inverts F1"),
            field("f2", 1, 1, "", "Inverts F2"),
            field("crc", 2, 1, "", "Corrupts the CRC"),
            field("second_receiver", 3, 1, "", "The second receiver disagrees, on cards with one"),
            field("own_frames", 4, 1, "", "1: only in the separate frames of requests"),
        ]),
        word("progress", at::PROGRESS, ReadOnly, "Initialisation.", &[
            field("step", 0, 16, "", "Step under way").codes(STEPS),
            field("failed", 16, 16, "", "Step that failed").codes(STEPS),
        ]).of(Part::Initialise),
        word("state", at::STATE, ReadOnly, "State of the encoder and of its monitoring.", &[
            field("initialised", 0, 1, "", "The name plate is valid"),
            field("alarm", 1, 1, "", "Too many bad frames; latched"),
            field("position_2", 2, 1, "", "Position 2 was too far from position 1; latched"),
            field("endat22", 3, 1, "", "The encoder supports EnDat 2.2"),
            field("other_width", 4, 1, "", "The encoder has another width than configured, which the card uses"),
            field("slower", 5, 1, "", "The encoder supports only a slower clock than configured, which the card uses"),
            field("unplugged", 6, 1, "", "DATA has been HIGH for long: no encoder, or an open line"),
            field("initialising", 7, 1, "", "power-up sequence or initialisation is under way; triggers are lost"),
            field("error_test", 8, 1, "", "A forced error was not reported; latched"),
            field("starts", 16, 16, "", "Starts of the program since power-up, wrapping: one for each reset, and one for each upset that made it restart"),
        ]),
        word("lost", at::LOST, ReadOnly, "Triggers and frames that were dropped.", &[
            field("triggers", 0, 16, "", "Triggers lost because the line was busy, wrapping"),
            field("ends", 16, 16, "", "Frames that ended before the previous one was counted"),
        ]),
        word("threshold", at::THRESHOLD, ReadWrite, "Alarm: n bad frames of the last m.", &[
            field("n", 0, 16, "frames", "0 = no alarm"),
            field("m", 16, 16, "frames", "1..16; changing m starts a new count").takes(&[(1, 16)]),
        ]),
        word("bad_frames", at::BAD_FRAMES, ReadOnly, "Bad frames of the last m.", &[
            field("count", 0, 16, "frames", "How many"),
            field("which", 16, 16, "", "Bit 0 = the last frame"),
        ]),
        word("offset_low", at::OFFSET[0], ReadWrite, "Nominal difference: position 2 minus position 1, bits 31..0.", VALUE),
        word("offset_high", at::OFFSET[1], ReadWrite, "Nominal difference, bits 47..32.", HIGH),
        word("tolerance", at::TOLERANCE, ReadWrite, "Largest allowed distance from the nominal difference; 0 = no comparison.", VALUE),
        word("difference_low", at::DIFFERENCE[0], ReadOnly, "Position 2 minus position 1 minus offset, modulo the position's width, bits 31..0.", VALUE),
        word("difference_high", at::DIFFERENCE[1], ReadOnly, "Position 2 minus position 1 minus offset, bits 47..32.", HIGH),
        word("comparisons", at::COMPARISONS, ReadOnly, "Comparisons of positions 1 and 2.", &[
            field("all", 0, 16, "", "All, wrapping"),
            field("failed", 16, 16, "", "Comparisons that failed, wrapping"),
        ]),
        word("position_2_low", at::POSITION_2[0], ReadOnly, "Position 2, bits 31..0.", VALUE),
        word("position_2_high", at::POSITION_2[1], ReadOnly, "Position 2, bits 47..32.", HIGH),
        word("list_length", at::LIST_LENGTH, ReadWrite, "Length of the list of codes that are selected in turn.", &[
            field("length", 0, 4, "", "0..8; more is 8").takes(&[(0, 8)]),
        ]),
        word("info_status", at::INFO_STATUS, ReadOnly, "Last WRN, RM, Busy, I4..I0 with a right CRC.", &[
            field("info_1", 0, 8, "", "From additional data 1"),
            field("crc_1", 8, 1, "", "CRC of the last additional data 1 was wrong; its content was discarded"),
            field("info_2", 16, 8, "", "From additional data 2"),
            field("crc_2", 24, 1, "", "CRC of the last additional data 2 was wrong; its content was discarded"),
        ]),
        word("limits", at::LIMITS, ReadWrite, "Time limits of a frame.", &[
            field("watchdog_us", 0, 12, "us", "Longest time from the first falling edge to the end of the recovery time; 0 = off. Not applied to 101010, 100011, 011100, continuous clock and initialisation"),
            field("recovery_min_cycles", 16, 13, "cycles", "Shortest recovery time; 0 = not checked. At start the program writes the lower end of the configured range"),
        ]).of(Part::Diagnosis),
        word("continuous", at::CONTINUOUS, ReadWrite, "Continuous clock, for the command 000111.", &[
            field("go_on", 0, 1, "", "1: the clock continues after each position, from the next trigger on"),
            field("stop_at_error", 1, 1, "", "1: the clock stops after an error until the next trigger; 0: it continues after CRC, F1 and F2"),
        ]).of(Part::Continuous),
        list("list_0", 0),
        list("list_1", 1),
        list("list_2", 2),
        list("list_3", 3),
        list("list_4", 4),
        list("list_5", 5),
        list("list_6", 6),
        list("list_7", 7),
        slot("slot_0", 0),
        slot("slot_1", 1),
        slot("slot_2", 2),
        slot("slot_3", 3),
        slot("slot_4", 4),
        slot("slot_5", 5),
        slot("slot_6", 6),
        slot("slot_7", 7),
        word("request_wait", at::REQUEST_WAIT, ReadWrite, "Timeout of a request that waits for a trigger.", &[
            field("ms", 0, 16, "ms", "0 = no timeout. The program writes 2000 at start"),
        ]),
        word("error_test", at::ERROR_TEST, ReadWrite, "Forced errors on the card's schedule.", &[
            field("period_ms", 0, 16, "ms", "Period of the forced errors, each in a separate frame: 10 to 32000, 0 = none. Initial value: safety.error_test_ms of the configuration").takes(&[(0, 0), (ERROR_TEST_PATIENCE_MS as u32, ERROR_TEST_MS_MAX as u32)]),
        ]).of(Part::ErrorTest),
        word("error_test_state", at::ERROR_TEST_STATE, ReadOnly, "Results of the forced errors.", &[
            field("told", 0, 16, "", "Forced errors reported with their cause, since clear, wrapping"),
            field("silent", 16, 16, "", "Forced errors whose frame was reported as good, since clear"),
        ]).of(Part::ErrorTest),
        frames(0),
        frames(1),
        frames(2),
        frames(3),
        frames(4),
        frames(5),
        frames(6),
        frames(7),
        frames(8),
        frames(9),
        frames(10),
        frames(11),
        frames(12),
        frames(13),
        frames(14),
        frames(15),
        frames(16),
        frames(17),
        word("frames_position_2", at::COUNTERS + COUNTER_POSITION_2, ReadOnly, "Failed comparisons of positions 1 and 2.", COUNT),
        word("bad_infos", at::COUNTERS + COUNTER_BAD_INFOS, ReadOnly, "Blocks of additional data with a wrong CRC.", &[
            field("count", 0, 32, "", "Since clear, wrapping"),
        ]),
        plate_word(0),
        plate_word(1),
        plate_word(2),
        plate_word(3),
        plate_word(4),
        plate_word(5),
        plate_word(6),
        plate_word(7),
        plate_word(8),
        plate_word(9),
        plate_word(10),
        plate_word(11),
        plate_word(12),
        plate_word(13),
        plate_word(14),
        plate_word(15),
        plate_word(16),
        plate_word(17),
        plate_word(18),
        plate_word(19),
        plate_word(20),
        word("delay", PLATE_DELAY, ReadOnly, "Line delay measured at initialisation.", &[
            field("value", 0, 16, "cycles", "tD, including synchroniser and filter"),
            field("is_read", 16, 1, "", "The delay has been measured"),
        ]).of(Part::Initialise),
    ],
};
