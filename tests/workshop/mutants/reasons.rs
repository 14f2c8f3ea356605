//! Why survivors survive: typed by people who have looked, for those of the results in `campaigns/results`.

/// How a reason begins that takes a survivor for equivalent.
pub const NOTHING: &str = "changes nothing";

/// Block, a piece of its source at the place of the mutant or of its name, and the reason.
const REASONS: &[(&str, &str, &str)] = &[
    (
        "Exchange",
        "`bad_echo_next = bad_echo | differs;`",
        "an address of the encoder's memory that comes back with one wrong bit, not the last one: the bench spoils another one, random inputs do not come so far, and no property speaks of it",
    ),
    (
        "UartReceiver",
        "`count_next = count + 15'd1;`",
        "changes nothing: follows bit 13 of a count that a bit at this rate never takes so far",
    ),
    (
        "Trigger",
        "`timer_next = timer + 24'd1;`",
        "follows the highest bit of the timer: periods from 84 ms on, for which neither the bench nor random inputs wait",
    ),
    (
        "Trigger",
        "== period_cycles",
        "a period with another pattern in two of its bits than bench and random inputs have waited for",
    ),
    ("UartBridge", "`if (tick_us) begin`", TIME_OUT),
    ("UartBridge", "`if (stop_timer | expired) begin`", TIME_OUT),
    ("UartBridge", "idle_us_next", TIME_OUT),
    (
        "Card",
        "core_push_byte",
        "bytes that the stream pushes: the emitted bench does not switch it on, and random levels at the pins are no commands",
    ),
    (
        "AxiLiteCard",
        "s_axi_rresp[0]",
        "changes nothing: the front answers OKAY or SLVERR, whose lower bit is 0; what comes out of a block below is anything to the solver",
    ),
    (
        "SpiFront",
        "`if (!(|crc) & !waits) begin`",
        "one register of those that a right check sum sets, needed by a write of several words: the bench writes single words, and random levels at the pins are no commands",
    ),
    (
        "Sequencer",
        "",
        "an instruction that the program of this card does not have in this form; the block alone runs no program",
    ),
    (
        "EncoderPort",
        "first_fall_timestamp[30]",
        "time stamps from 10 s on: the bench ends before, and random inputs begin no frame then",
    ),
    (
        "CardCore",
        "trigger_trigger_count[14]",
        "counts of triggers from 16384 on: the bench ends before, and random inputs seldom trigger so often between two resets",
    ),
    (
        "CardCore",
        "set_byte_1[4]",
        "a byte of the second channel's set with a one in bit 5: the emitted bench does not switch the stream on, and random levels seldom bring a good frame",
    ),
    (
        "CardCore",
        "start_timeout_us[8]",
        "a start time-out of 512 us and more: the bench writes shorter ones, and random accesses seldom write a whole configuration word there",
    ),
    (
        "Channel",
        "position[13]",
        "positions from 2^30 on: those of the bench's encoders are narrower, and random levels seldom bring a good frame",
    ),
    (
        "FrameBuffer",
        "code_at_next[1]",
        "changes nothing: follows bit 12 of an address that a mask keeps below 2048; the solver's model has the RAM as registers, which are too many for it",
    ),
    (
        "Transaction",
        "flags_told[16]",
        "changes nothing: follows raw flag 14, which a channel of this card does not have; what comes out of a block below is anything to the solver",
    ),
    (
        "Transaction",
        "`assign afresh",
        "a delay that has been measured, and is to be measured again: the bench asks for it only where nothing has been measured, and random levels seldom bring a good frame",
    ),
    (
        "UartBridge",
        "write_busy_next",
        "a byte that waits for the end of the word before: the bench sends slower than a turn of the configuration ring, and random levels are seldom commands",
    ),
    (
        "UartBridge",
        "words_left_next[5]",
        "commands of 32 words and more: the bench has shorter ones, and random levels are seldom commands",
    ),
    ("LastEdge", "`if (reset) begin`", COUNTED_BEFORE),
    ("Receiver", "`assign in35 = ", COUNTED_BEFORE),
    (
        "Receiver",
        "align_first[0]",
        "the word is aligned one step short at the widths where it begins where it ends: the bench has none of them",
    ),
];

/// Told by a run of that case alone (`--case`).
const COUNTED_BEFORE: &str =
    "counted with the simpler random inputs; those of today show it to the block alone";

/// A time that is longer than all runs.
const TIME_OUT: &str = "the time-out after 100 ms of a command that is not whole: neither the bench nor random inputs wait for it";

/// The reason for a survivor, if somebody has given one.
pub fn reason(block: &str, place: &str) -> Option<&'static str> {
    let is_of = |row: &&(&str, &str, &'static str)| row.0 == block && place.contains(row.1);
    REASONS.iter().find(is_of).map(|row| row.2)
}
