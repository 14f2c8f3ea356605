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
        "status.sequence of the frame that brought it: its age is the difference",
    ),
];
const COUNT: &[Field] = &[field("frames", 0, 32, "", "Frames since clear, wrapping")];
const PLATE: &[Field] = &[
    field("value", 0, 16, "", "Word of the encoder"),
    field("is_read", 16, 1, "", "It has been read"),
];

const fn list(name: &'static str, i: u8) -> Register {
    word(name, at::LIST + i, ReadWrite, "A code of the list.", CODE)
}

const fn slot(name: &'static str, i: u8) -> Register {
    word(
        name,
        at::SLOTS + i,
        ReadOnly,
        "What the additional data of that code said last.",
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
        "Frames that ended with this cause (good: with none).",
        COUNT,
    );
    // What only the diagnosis of the line finds.
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

/// Requests, health, slots and name plate of a channel; cards without service do not have it. RAM: a reset does not clear it.
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
        word("request_state", at::REQUEST_STATE, ReadOnly, "What became of the request.", &[
            field("busy", 0, 1, "", "It is under way"),
            field("error", 4, 4, "", "What went wrong").codes(ERRORS),
            field("finished", 16, 16, "", "Requests finished, wrapping"),
        ]),
        word("answer", at::ANSWER, ReadOnly, "Answer to the last request; bits 31..0 of a longer one.", &[
            field("data", 0, 16, "", "Data, or content of additional data 1"),
            field("address", 16, 8, "", "Echo of MRS code, address or port; or WRN, RM, Busy, I4..I0"),
        ]),
        word("answer_more", at::ANSWER_MORE, ReadOnly, "Bits 47..32 of a longer answer.", HIGH),
        word("duration", at::DURATION, ReadOnly, "How long the last request took.", &[
            field("us", 0, 16, "us", "Modulo 65536"),
            field("ms", 16, 16, "ms", "The same in milliseconds"),
        ]),
        word("control", at::CONTROL, ReadWrite, "Acts when written.", &[
            field("initialise", 0, 1, "", "1: initialise the encoder"),
            field("clear", 1, 1, "", "1: counters, alarm, position_2 and error_test to zero; lost.triggers goes on"),
            field("cancel", 2, 1, "", "1: the request that waits for a trigger is given up; one on the wire is finished"),
        ]),
        word("force", at::FORCE, ReadWrite, "Errors forced upon what is received, to try the error paths; not for regular operation.", &[
            field("f1", 0, 1, "", "Inverts F1"),
            field("f2", 1, 1, "", "Inverts F2"),
            field("crc", 2, 1, "", "Spoils the CRC"),
            field("second_receiver", 3, 1, "", "The second receiver disagrees, if there is one"),
            field("own_frames", 4, 1, "", "1: only in frames that requests have of their own"),
        ]),
        word("progress", at::PROGRESS, ReadOnly, "Initialisation.", &[
            field("step", 0, 16, "", "Step under way").codes(STEPS),
            field("failed", 16, 16, "", "Step that failed").codes(STEPS),
        ]).of(Part::Initialise),
        word("state", at::STATE, ReadOnly, "What is known and what is wrong.", &[
            field("initialised", 0, 1, "", "The name plate is valid"),
            field("alarm", 1, 1, "", "Too many bad frames; latched"),
            field("position_2", 2, 1, "", "Position 2 was too far from position 1; latched"),
            field("endat22", 3, 1, "", "The encoder knows EnDat 2.2"),
            field("other_width", 4, 1, "", "The encoder has another width than configured; its own is used"),
            field("slower", 5, 1, "", "The encoder takes only a slower clock than configured; that is used"),
            field("unplugged", 6, 1, "", "DATA has been HIGH for long: no encoder, or an open line"),
            field("initialising", 7, 1, "", "power-up sequence or initialisation is under way; triggers are lost"),
            field("error_test", 8, 1, "", "A forced error was not told; latched"),
            field("starts", 16, 16, "", "How often the program has begun since power-up, wrapping: one more after each reset, and after an upset that led it astray"),
        ]),
        word("lost", at::LOST, ReadOnly, "What did not get its turn.", &[
            field("triggers", 0, 16, "", "Triggers that came while the line was not free, wrapping"),
            field("ends", 16, 16, "", "Frames that ended before the one before was counted"),
        ]),
        word("threshold", at::THRESHOLD, ReadWrite, "Alarm: n bad frames of the last m.", &[
            field("n", 0, 16, "frames", "0 = no alarm"),
            field("m", 16, 16, "frames", "1..16; another m begins a new count").takes(&[(1, 16)]),
        ]),
        word("bad_frames", at::BAD_FRAMES, ReadOnly, "Bad frames of the last m.", &[
            field("count", 0, 16, "frames", "How many"),
            field("which", 16, 16, "", "Bit 0 = the last frame"),
        ]),
        word("offset_low", at::OFFSET[0], ReadWrite, "Position 2 minus position 1 as it should be, bits 31..0.", VALUE),
        word("offset_high", at::OFFSET[1], ReadWrite, "The same, bits 47..32.", HIGH),
        word("tolerance", at::TOLERANCE, ReadWrite, "Largest distance from that; 0 = no comparison.", VALUE),
        word("difference_low", at::DIFFERENCE[0], ReadOnly, "Position 2 minus position 1 minus offset, modulo the position's width, bits 31..0.", VALUE),
        word("difference_high", at::DIFFERENCE[1], ReadOnly, "The same, bits 47..32.", HIGH),
        word("comparisons", at::COMPARISONS, ReadOnly, "Comparisons of positions 1 and 2.", &[
            field("all", 0, 16, "", "All, wrapping"),
            field("failed", 16, 16, "", "Those that failed, wrapping"),
        ]),
        word("position_2_low", at::POSITION_2[0], ReadOnly, "Position 2, bits 31..0.", VALUE),
        word("position_2_high", at::POSITION_2[1], ReadOnly, "Position 2, bits 47..32.", HIGH),
        word("list_length", at::LIST_LENGTH, ReadWrite, "Codes of the list that are selected in turn.", &[
            field("length", 0, 4, "", "0..8; more is 8").takes(&[(0, 8)]),
        ]),
        word("info_status", at::INFO_STATUS, ReadOnly, "WRN, RM, Busy, I4..I0 as they came last with a right CRC.", &[
            field("info_1", 0, 8, "", "Of additional data 1"),
            field("crc_1", 8, 1, "", "CRC of the last additional data 1 wrong: nothing of it was taken"),
            field("info_2", 16, 8, "", "Of additional data 2"),
            field("crc_2", 24, 1, "", "CRC of the last additional data 2 wrong: nothing of it was taken"),
        ]),
        word("limits", at::LIMITS, ReadWrite, "What a frame must keep to.", &[
            field("watchdog_us", 0, 12, "us", "Longest time from the first falling edge to the end of the recovery time; 0 = not watched. 101010, 100011, 011100, continuous clock and the initialisation are not watched"),
            field("recovery_min_cycles", 16, 13, "cycles", "Shortest recovery time; 0 = not checked. The program writes the shortest of the configured range at start"),
        ]).of(Part::Diagnosis),
        word("continuous", at::CONTINUOUS, ReadWrite, "Continuous clock, for the command 000111.", &[
            field("go_on", 0, 1, "", "1: the clock goes on after each position, from the next trigger on"),
            field("stop_at_error", 1, 1, "", "1: it stops after an error until the next trigger; 0: it goes on after CRC, F1 and F2"),
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
        word("request_wait", at::REQUEST_WAIT, ReadWrite, "Longest wait of a request for a trigger.", &[
            field("ms", 0, 16, "ms", "0 = no limit. The program writes 2000 at start"),
        ]),
        word("error_test", at::ERROR_TEST, ReadWrite, "Forced errors on the card's own schedule.", &[
            field("period_ms", 0, 16, "ms", "One error each so many milliseconds, in a frame of its own: 10 to 32000, 0 = none. Begins with safety.error_test_ms of the configuration").takes(&[(0, 0), (ERROR_TEST_PATIENCE_MS as u32, ERROR_TEST_MS_MAX as u32)]),
        ]).of(Part::ErrorTest),
        word("error_test_state", at::ERROR_TEST_STATE, ReadOnly, "What became of them.", &[
            field("told", 0, 16, "", "Forced errors that were told with their cause, since clear, wrapping"),
            field("silent", 16, 16, "", "Forced errors after which the frame was told as good, since clear"),
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
        word("frames_position_2", at::COUNTERS + COUNTER_POSITION_2, ReadOnly, "Comparisons of positions 1 and 2 that failed.", COUNT),
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
            field("value", 0, 16, "cycles", "tD, synchroniser and filter included"),
            field("is_read", 16, 1, "", "It has been measured"),
        ]).of(Part::Initialise),
    ],
};
