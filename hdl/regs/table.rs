//! The words themselves.

use super::values::{CAUSES, EVIDENCE_FLAGS, FEATURES, LINE_FLAGS, POSITION_COMMANDS};
use super::{
    word, zero, Access, Block, Field, BLOCK_STRIDE, CONFIG_BASE, ID, RESULT_BASE, VERSION,
};
use crate::config::{CardConfig, ChannelConfig, OwnTrigger};
use crate::protocol::MAX_POSITION_BITS;
use crate::whole_result::INFO_OFFSET;
use Access::{ReadOnly, ReadWrite, Strobe};

/// A field with a value of its own after reset.
const fn field(
    name: &'static str,
    lsb: u32,
    width: u32,
    unit: &'static str,
    meaning: &'static str,
    start: fn(&CardConfig, usize) -> u64,
) -> Field {
    Field {
        start,
        ..super::field(name, lsb, width, unit, meaning)
    }
}

/// The channel's start values; zeros for a channel that the card does not have.
fn of(config: &CardConfig, channel: usize, value: impl Fn(&ChannelConfig) -> u64) -> u64 {
    config.channels.get(channel).map(value).unwrap_or_default()
}

/// The triggers that a channel takes.
fn own(channel: &ChannelConfig) -> OwnTrigger {
    channel.request.trigger.unwrap_or_default()
}

/// Offset of the first of the stream's four words.
pub(super) const STREAM_FIRST: u8 = 12;

/// Identification, capabilities, counters and strobes.
pub const CARD: Block = Block {
    name: "card",
    base: 0,
    stride: BLOCK_STRIDE,
    per_channel: false,
    meaning: "Identification, capabilities, counters and strobes.",
    is_ram: false,
    registers: &[
        word(
            "id",
            0,
            ReadOnly,
            "Identification: the ASCII letters EnDt.",
            &[field("value", 0, 32, "", "0x456E4474", |_, _| ID as u64)],
        ),
        word(
            "version",
            1,
            ReadOnly,
            "Version of the register map; offsets never move within a major version.",
            &[
                field("patch", 0, 16, "", "Patch", |_, _| VERSION[2] as u64),
                field("minor", 16, 8, "", "Minor", |_, _| VERSION[1] as u64),
                field("major", 24, 8, "", "Major", |_, _| VERSION[0] as u64),
            ],
        ),
        word(
            "capabilities",
            2,
            ReadOnly,
            "What this card has.",
            &[
                field("channels", 0, 8, "", "Encoder ports", |s, _| {
                    s.channels.len() as u64
                }),
                field(
                    "max_position_bits",
                    8,
                    8,
                    "bits",
                    "Widest position",
                    |_, _| MAX_POSITION_BITS as u64,
                ),
                field("features", 16, 16, "", "Parts", |s, _| {
                    let endat = (s.endat_channels().next().is_some()) as u64;
                    0b1100
                        | endat
                        | endat << 1
                        | (s.service.requests as u64) << 4
                        | (s.service.initialise as u64) << 5
                        | (s.service.diagnosis as u64) << 6
                        | (s.service.continuous as u64) << 7
                        | (s.line.alignment as u64) << 8
                        | (s.line.margin as u64) << 9
                        | (s.line.double_edge as u64) << 10
                        | ((s.stream.fifo_bytes != 0) as u64) << 11
                        | (s.outputs.any() as u64) << 12
                        | (s.outputs.interrupt as u64) << 13
                        | ((s.t_format_channels() != 0) as u64) << 14
                        | (s.own_triggers() as u64) << 15
                })
                .bits(&FEATURES),
            ],
        ),
        word(
            "system_hz",
            3,
            ReadOnly,
            "System clock: the unit of every number of cycles.",
            &[field("value", 0, 32, "Hz", "Frequency", |s, _| s.system_hz)],
        ),
        word(
            "configuration_hash",
            4,
            ReadOnly,
            "Tells which configuration the card was generated from.",
            &[field(
                "value",
                0,
                32,
                "",
                "First 8 digits of the hash that stands in the generated files",
                |s, _| s.hash >> 16,
            )],
        ),
        word(
            "protocols",
            5,
            ReadOnly,
            "Which channels speak another protocol than EnDat, and what sets of the stream have.",
            &[
                field(
                    "t_format",
                    0,
                    8,
                    "",
                    "T-format: bit n for channel n",
                    |s, _| s.t_format_channels(),
                ),
                field(
                    "stream_informations",
                    8,
                    1,
                    "",
                    "1: sets of the stream have the additional informations",
                    |s, _| s.stream.informations as u64,
                ),
            ],
        ),
        word(
            "trigger_count",
            8,
            ReadOnly,
            "Triggers since reset; stands still with the results (see hold).",
            &[field("value", 0, 32, "", "Wraps", zero)],
        ),
        word(
            "trigger_now",
            9,
            Strobe,
            "Triggers all channels that take it, if sources allows it.",
            &[field("trigger", 0, 1, "", "Write 1", zero)],
        ),
        word(
            "calibrate",
            10,
            Strobe,
            "Makes channels measure their line delay again, with their next frame.",
            &[field("channels", 0, 8, "", "Bit n for channel n", zero)],
        ),
        word(
            "stream_control",
            STREAM_FIRST,
            ReadWrite,
            "What the stream of sample sets does.",
            &[
                field("collect", 0, 1, "", "Triggers make sets", |s, _| {
                    s.stream.start.collects() as u64
                }),
                field("push", 1, 1, "", "Frames go out over the UART", |s, _| {
                    s.stream.start.pushes() as u64
                }),
            ],
        ),
        word(
            "stream_state",
            STREAM_FIRST + 1,
            ReadOnly,
            "What is in the stream's buffer, and what did not get in.",
            &[
                field("bytes", 0, 16, "bytes", "Bytes that wait", zero),
                field(
                    "lost",
                    16,
                    16,
                    "",
                    "Sets lost since clear; stops at 65535",
                    zero,
                ),
            ],
        ),
        word(
            "stream_data",
            STREAM_FIRST + 2,
            ReadOnly,
            "Takes the next bytes of the stream out of the buffer.",
            &[field(
                "bytes",
                0,
                32,
                "",
                "First byte in bits 31..24; what is not there is 0",
                zero,
            )],
        ),
        word(
            "stream_clear",
            STREAM_FIRST + 3,
            Strobe,
            "Empties the buffer, forgets what was lost.",
            &[field("clear", 0, 1, "", "Write 1", zero)],
        ),
    ],
};

/// Configuration of the card.
pub const CARD_CONFIG: Block = Block {
    name: "config",
    base: CONFIG_BASE,
    stride: BLOCK_STRIDE,
    per_channel: false,
    meaning: "Configuration of the card.",
    is_ram: false,
    registers: &[
        word(
            "trigger_sources",
            0,
            ReadWrite,
            "Enabled trigger sources; one trigger starts all channels that take it in the same clock cycle.",
            &[
                field("pin", 0, 1, "", "Rising edge of the trigger pin", |s, _| {
                    s.sources.pin as u64
                }),
                field("timer", 1, 1, "", "Every trigger_period", |s, _| {
                    s.sources.timer as u64
                }),
                field("register", 2, 1, "", "trigger_now", |s, _| {
                    s.sources.register as u64
                }),
                field(
                    "disabled",
                    8,
                    8,
                    "",
                    "Channels that take no trigger, bit n for channel n; with part own_trigger only",
                    |s, _| {
                        let off = |c: &ChannelConfig| c.request.trigger.is_some_and(|t| !t.enabled);
                        let channels = s.channels.iter().enumerate();
                        channels.map(|(n, c)| (off(c) as u64) << n).sum()
                    },
                ),
            ],
        ),
        word(
            "trigger_period",
            1,
            ReadWrite,
            "Period of the timer, at least 4; write it while the timer is disabled.",
            &[field("value", 0, 24, "cycles", "Period", |s, _| {
                s.sample_period_cycles
            })
            .takes(&[(4, 0xFF_FFFF)], &[])],
        ),
        word(
            "hold",
            2,
            ReadWrite,
            "Keeps the results of all channels, for a host that reads word by word.",
            &[
                field(
                    "hold",
                    0,
                    1,
                    "",
                    "1: results and trigger_count stand still",
                    zero,
                ),
                field(
                    "scratch",
                    8,
                    24,
                    "",
                    "Free for the host, to try the link",
                    zero,
                ),
            ],
        ),
    ],
};

/// Configuration of a channel; taken over between two frames.
pub const CHANNEL_CONFIG: Block = Block {
    name: "config",
    base: CONFIG_BASE + BLOCK_STRIDE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Configuration of a channel; taken over between two frames.",
    is_ram: false,
    registers: &[
        word(
            "frame",
            0,
            ReadWrite,
            "What is asked of the encoder, and how fast.",
            &[
                field(
                    "period_cycles",
                    0,
                    11,
                    "cycles",
                    "EnDat clock period; the high phase is the longer one when odd; T-format: a bit, 8..127",
                    |s, c| of(s, c, |v| v.period_cycles),
                )
                .takes(&[(2, 2047)], &[(8, 127)]),
                field(
                    "skip",
                    11,
                    5,
                    "",
                    "Triggers left out after each that the channel takes; with part own_trigger only, as the ignored sources",
                    |s, c| of(s, c, |v| own(v).skip()),
                ),
                field(
                    "position_bits",
                    16,
                    6,
                    "bits",
                    "Position width, 1..48; T-format: no meaning, as command",
                    |s, c| of(s, c, |v| v.position_bits as u64),
                )
                .takes(&[(1, 48)], &[]),
                field("ignore_pin", 22, 1, "", "1: the trigger pin is not for this channel", |s, c| {
                    of(s, c, |v| own(v).ignored() & 1)
                }),
                field("ignore_timer", 23, 1, "", "1: the timer is not", |s, c| {
                    of(s, c, |v| own(v).ignored() >> 1 & 1)
                }),
                field(
                    "command",
                    24,
                    6,
                    "",
                    "Mode command, sent most significant bit first",
                    |s, c| {
                        of(s, c, |v| match v.t_format {
                            Some(_) => 0,
                            None => v.command.code() as u64,
                        })
                    },
                )
                .codes(&POSITION_COMMANDS),
                field("ignore_register", 30, 1, "", "1: trigger_now is not", |s, c| {
                    of(s, c, |v| own(v).ignored() >> 2 & 1)
                }),
            ],
        ),
        word(
            "timing",
            1,
            ReadWrite,
            "First low phase and tolerance of the start bit.",
            &[
                field(
                    "first_low_extra_cycles",
                    0,
                    11,
                    "cycles",
                    "First low phase minus half a period (tST)",
                    |s, c| of(s, c, |v| v.first_low_extra_cycles),
                ),
                field(
                    "start_window_cycles",
                    16,
                    6,
                    "cycles",
                    "The start edge must come within plus or minus this of its expected phase",
                    |s, c| of(s, c, |v| v.start_window_cycles),
                ),
                field(
                    "filter_half",
                    23,
                    1,
                    "",
                    "1: half a cycle more; with part double_edge only",
                    |s, c| of(s, c, |v| v.filter_half.into()),
                ),
                field(
                    "filter_cycles",
                    24,
                    4,
                    "cycles",
                    "Pulses on DATA up to this length are ignored; 0 = off",
                    |s, c| of(s, c, |v| v.filter_cycles),
                ),
                field(
                    "request_id",
                    28,
                    4,
                    "",
                    "T-format: request ID of a trigger; 6 and 13 are not sent",
                    |s, c| of(s, c, |v| v.t_format.map_or(0, |t| t.request.id().into())),
                )
                .takes(&[], &[(0, 5), (7, 12), (14, 15)]),
            ],
        ),
        word(
            "limits",
            2,
            ReadWrite,
            "Longest waits.",
            &[
                field(
                    "start_timeout_us",
                    0,
                    12,
                    "us",
                    "Longest wait for the start bit after the turnaround; T-format: longest pause before the reply, 1..63",
                    |s, c| of(s, c, |v| v.start_timeout_us),
                )
                .takes(&[], &[(1, 63)]),
                field(
                    "recovery_limit_cycles",
                    16,
                    13,
                    "cycles",
                    "DATA must fall within this after the frame (tm)",
                    |s, c| of(s, c, |v| v.recovery_limit_cycles),
                ),
                field(
                    "field_gap_us",
                    29,
                    3,
                    "us",
                    "T-format: longest pause between two fields",
                    |s, c| of(s, c, |v| v.t_format.map_or(0, |t| t.field_gap_us)),
                ),
            ],
        ),
    ],
};

/// Offset of the first of the two words that cards with requests have.
pub(super) const INFO_FIRST: u8 = INFO_OFFSET as u8;

const INFO: [Field; 7] = [
    super::field("content", 0, 16, "", "What it says; 0 unless good"),
    super::field(
        "sign",
        16,
        5,
        "",
        "I4..I0: which one it is; I4 = 0 information 1, 1 information 2",
    ),
    super::field("busy", 21, 1, "", "The encoder is busy with a request"),
    super::field(
        "reference_mark",
        22,
        1,
        "",
        "RM: the reference mark has been passed",
    ),
    super::field(
        "warning",
        23,
        1,
        "",
        "WRN: one of the encoder's warnings is set",
    ),
    super::field("came", 24, 1, "", "The frame brought it"),
    super::field("good", 25, 1, "", "Its CRC is right"),
];

/// Result of a channel; all words of all channels change together and never within a read command.
pub const RESULT: Block = Block {
    name: "result",
    base: RESULT_BASE,
    stride: BLOCK_STRIDE,
    per_channel: true,
    meaning: "Result of a channel; all words of all channels change together and never within a read command.",
    is_ram: false,
    registers: &[
        word("status", 0, ReadOnly, "What became of the last trigger.", &[
            field("sequence", 0, 16, "", "Number of results, wrapping", zero),
            field("cause", 16, 5, "", "Primary cause; 8, 17, 29 and 30 come with a good position: fresh tells", zero).codes(&CAUSES),
            field("valid", 22, 1, "", "There is a good position", zero),
            field("fresh", 23, 1, "", "The last result brought the position; 0 = held from an earlier one", zero),
            field("line", 24, 8, "", "Raw flags: bit k stands for cause k + 11, bit 7 for cause 31; T-format: bits 0, 1 and 2 for causes 29, 30 and 8", zero).bits(&LINE_FLAGS),
        ]),
        word("position_low", 1, ReadOnly, "Last good position, bits 31..0.", &[
            field("value", 0, 32, "", "Bit 0 is the LSB", zero),
        ]),
        word("position_high", 2, ReadOnly, "Last good position, bits 47..32.", &[
            field("value", 0, 16, "", "0 above the position's width; T-format: multi-turn in bits 47..24, single-turn in 23..0", zero),
            field("crc", 16, 5, "", "CRC that came with this position, over F1, F2 and the position, LSB first: whoever reads it checks it once more; T-format: 0", zero),
            field("f2", 22, 1, "", "The position came with F2 = 1 (EnDat 2.2); F1 of a good position is 0", zero),
            field("width", 24, 6, "bits", "Width of this position; 0 = there is none yet, or T-format: nothing to check", zero),
        ]),
        word("timestamp", 3, ReadOnly, "First falling clock edge of the frame that brought the position; equal in two EnDat channels = same trigger. T-format: start bit of the request.", &[
            field("value", 0, 32, "cycles", "Since reset, wrapping", zero),
        ]),
        word("evidence", 4, ReadOnly, "How good the last frame was.", &[
            field("crc_received", 0, 5, "", "CRC as received", zero),
            field("crc_computed", 5, 5, "", "CRC as computed", zero),
            field("delay_cycles", 10, 10, "cycles", "Tracked line delay tD, synchroniser and filter included", zero),
            field("flags", 20, 12, "", "Raw flags; T-format: bit 0 for cause 9, bit k for cause k + 17", zero).bits(&EVIDENCE_FLAGS),
        ]),
        word("age_recovery", 5, ReadOnly, "Age and recovery time.", &[
            field("age_us", 0, 16, "us", "Age of the position: 0 until its frame has ended, counted from there, also while results are held; stops at 65535", zero),
            field("recovery_cycles", 16, 13, "cycles", "Recovery time tm of the last frame", zero),
            field("delay_high", 29, 1, "", "Bit 10 of delay_cycles", zero),
            field("stale", 30, 1, "", "A trigger of this channel has come since this result", zero),
        ]),
        word("info_1", INFO_FIRST, ReadOnly, "Additional information 1 of the frame of this result.", &INFO),
        word("info_2", INFO_FIRST + 1, ReadOnly, "Additional information 2 of the frame of this result.", &INFO),
    ],
};
