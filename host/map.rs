//! The register map that the cards of this version have, with every part; which of them a card has, its capabilities tell.
//!
//! Generated from the card's own table. Do not edit; `UPDATE_EXPECT=1 cargo test --test system -- maps::the_host` renews it.

use crate::registers::{Access, Block, Field, Limits, Named, Register, Values};

/// Major, minor and patch version of the map.
pub const VERSION: [u8; 3] = [0, 9, 0];

/// All blocks, lowest base first.
pub const BLOCKS: &[Block] = &[
    Block { name: "card", base: 0x000, stride: 8, per_channel: false, meaning: "Identification, capabilities, counters and strobes.", registers: &[
        Register { name: "id", offset: 0, access: Access::ReadOnly, meaning: "Identification: the ASCII letters EnDt.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "", meaning: "0x456E4474", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "version", offset: 1, access: Access::ReadOnly, meaning: "Version of the register map; offsets never move within a major version.", fields: &[
            Field { name: "patch", lsb: 0, width: 16, unit: "", meaning: "Patch", values: Values::Plain, limits: Limits::ANY },
            Field { name: "minor", lsb: 16, width: 8, unit: "", meaning: "Minor", values: Values::Plain, limits: Limits::ANY },
            Field { name: "major", lsb: 24, width: 8, unit: "", meaning: "Major", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "capabilities", offset: 2, access: Access::ReadOnly, meaning: "What this card has.", fields: &[
            Field { name: "channels", lsb: 0, width: 8, unit: "", meaning: "Encoder ports", values: Values::Plain, limits: Limits::ANY },
            Field { name: "max_position_bits", lsb: 8, width: 8, unit: "bits", meaning: "Widest position", values: Values::Plain, limits: Limits::ANY },
            Field { name: "features", lsb: 16, width: 16, unit: "", meaning: "Parts", values: Values::Bits(&[Named { name: "endat22", number: 0, meaning: "EnDat 2.2 position frames (111000)" }, Named { name: "line_delay", number: 1, meaning: "line delay is measured" }, Named { name: "trigger_pin", number: 2, meaning: "trigger pin" }, Named { name: "trigger_timer", number: 3, meaning: "trigger timer" }, Named { name: "requests", number: 4, meaning: "requests" }, Named { name: "initialise", number: 5, meaning: "initialisation" }, Named { name: "diagnosis", number: 6, meaning: "diagnosis of the line" }, Named { name: "continuous", number: 7, meaning: "continuous clock" }, Named { name: "alignment", number: 8, meaning: "phase at the host's choice, mean over many edges" }, Named { name: "margin", number: 9, meaning: "margin of the samples" }, Named { name: "double_edge", number: 10, meaning: "DATA on both edges of the system clock" }, Named { name: "stream", number: 11, meaning: "stream of sample sets" }, Named { name: "direct", number: 12, meaning: "direct outputs" }, Named { name: "interrupt", number: 13, meaning: "interrupt" }, Named { name: "t_format", number: 14, meaning: "T-format channels" }, Named { name: "own_trigger", number: 15, meaning: "enable, divider and sources of triggers of each channel" }]), limits: Limits::ANY },
        ] },
        Register { name: "system_hz", offset: 3, access: Access::ReadOnly, meaning: "System clock: the unit of every number of cycles.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "Hz", meaning: "Frequency", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "configuration_hash", offset: 4, access: Access::ReadOnly, meaning: "Tells which configuration the card was generated from.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "", meaning: "First 8 digits of the hash that stands in the generated files", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "protocols", offset: 5, access: Access::ReadOnly, meaning: "Which channels speak another protocol than EnDat, and what sets of the stream have.", fields: &[
            Field { name: "t_format", lsb: 0, width: 8, unit: "", meaning: "T-format: bit n for channel n", values: Values::Plain, limits: Limits::ANY },
            Field { name: "stream_informations", lsb: 8, width: 1, unit: "", meaning: "1: sets of the stream have the additional informations", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "trigger_count", offset: 8, access: Access::ReadOnly, meaning: "Triggers since reset; stands still with the results (see hold).", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "", meaning: "Wraps", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "trigger_now", offset: 9, access: Access::Strobe, meaning: "Triggers all channels that take it, if sources allows it.", fields: &[
            Field { name: "trigger", lsb: 0, width: 1, unit: "", meaning: "Write 1", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "calibrate", offset: 10, access: Access::Strobe, meaning: "Makes channels measure their line delay again, with their next frame.", fields: &[
            Field { name: "channels", lsb: 0, width: 8, unit: "", meaning: "Bit n for channel n", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "stream_control", offset: 12, access: Access::ReadWrite, meaning: "What the stream of sample sets does.", fields: &[
            Field { name: "collect", lsb: 0, width: 1, unit: "", meaning: "Triggers make sets", values: Values::Plain, limits: Limits::ANY },
            Field { name: "push", lsb: 1, width: 1, unit: "", meaning: "Frames go out over the UART", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "stream_state", offset: 13, access: Access::ReadOnly, meaning: "What is in the stream's buffer, and what did not get in.", fields: &[
            Field { name: "bytes", lsb: 0, width: 16, unit: "bytes", meaning: "Bytes that wait", values: Values::Plain, limits: Limits::ANY },
            Field { name: "lost", lsb: 16, width: 16, unit: "", meaning: "Sets lost since clear; stops at 65535", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "stream_data", offset: 14, access: Access::ReadOnly, meaning: "Takes the next bytes of the stream out of the buffer.", fields: &[
            Field { name: "bytes", lsb: 0, width: 32, unit: "", meaning: "First byte in bits 31..24; what is not there is 0", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "stream_clear", offset: 15, access: Access::Strobe, meaning: "Empties the buffer, forgets what was lost.", fields: &[
            Field { name: "clear", lsb: 0, width: 1, unit: "", meaning: "Write 1", values: Values::Plain, limits: Limits::ANY },
        ] },
    ] },
    Block { name: "interrupt", base: 0x010, stride: 8, per_channel: false, meaning: "Interrupt: irq_o is high while a bit of status is set that is set in mask, too.", registers: &[
        Register { name: "status", offset: 0, access: Access::ReadOnly, meaning: "What has happened since it was cleared.", fields: &[
            Field { name: "channel_0", lsb: 0, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_1", lsb: 4, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_2", lsb: 8, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_3", lsb: 12, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_4", lsb: 16, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_5", lsb: 20, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_6", lsb: 24, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_7", lsb: 28, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
        ] },
        Register { name: "mask", offset: 1, access: Access::ReadWrite, meaning: "What makes irq_o high.", fields: &[
            Field { name: "channel_0", lsb: 0, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_1", lsb: 4, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_2", lsb: 8, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_3", lsb: 12, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_4", lsb: 16, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_5", lsb: 20, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_6", lsb: 24, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_7", lsb: 28, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
        ] },
        Register { name: "clear", offset: 2, access: Access::Strobe, meaning: "Clears the bits of status that are written 1; an event of the same cycle stays.", fields: &[
            Field { name: "channel_0", lsb: 0, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_1", lsb: 4, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_2", lsb: 8, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_3", lsb: 12, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_4", lsb: 16, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_5", lsb: 20, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_6", lsb: 24, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
            Field { name: "channel_7", lsb: 28, width: 4, unit: "", meaning: "Events of the channel", values: Values::Bits(&[Named { name: "result", number: 0, meaning: "a new result" }, Named { name: "error", number: 1, meaning: "a result whose cause is one of direct.error_causes" }, Named { name: "alarm", number: 2, meaning: "the alarm has come on" }, Named { name: "request", number: 3, meaning: "the frame of a request has ended" }]), limits: Limits::ANY },
        ] },
    ] },
    Block { name: "direct", base: 0x080, stride: 8, per_channel: true, meaning: "Direct outputs of a channel: where its position is cropped, and what is an error.", registers: &[
        Register { name: "crop", offset: 0, access: Access::ReadWrite, meaning: "Which bits of the position come out; taken over with the next result.", fields: &[
            Field { name: "first_bit", lsb: 0, width: 6, unit: "", meaning: "Position bit that becomes bit 0, 0..47", values: Values::Plain, limits: Limits::ANY },
            Field { name: "length_bits", lsb: 8, width: 6, unit: "bits", meaning: "How many bits, 0..32; zeros above", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "error_causes", offset: 1, access: Access::ReadWrite, meaning: "What makes direct_error_o high: bit k for cause k, bit 0 for the channel's alarm.", fields: &[
            Field { name: "causes", lsb: 0, width: 32, unit: "", meaning: "Selected causes of the last result", values: Values::Plain, limits: Limits::ANY },
        ] },
    ] },
    Block { name: "t_format", base: 0x0C0, stride: 8, per_channel: true, meaning: "Requests to a T-format encoder beside its triggers, and the fields of its replies; 0 on a channel that speaks EnDat.", registers: &[
        Register { name: "send", offset: 0, access: Access::Strobe, meaning: "Sends one request, now or as soon as the exchange under way has ended; not taken while answer.busy.", fields: &[
            Field { name: "data", lsb: 0, width: 8, unit: "", meaning: "EEPROM data, of request 6", values: Values::Plain, limits: Limits::ANY },
            Field { name: "address", lsb: 8, width: 7, unit: "", meaning: "EEPROM address, of requests 6 and 13; 127 is the page register", values: Values::Plain, limits: Limits::ANY },
            Field { name: "id", lsb: 16, width: 4, unit: "", meaning: "Request ID", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "answer", offset: 1, access: Access::ReadOnly, meaning: "What became of the request in send.", fields: &[
            Field { name: "data", lsb: 0, width: 8, unit: "", meaning: "EEPROM data as they came last", values: Values::Plain, limits: Limits::ANY },
            Field { name: "id", lsb: 8, width: 4, unit: "", meaning: "ID that the reply repeats", values: Values::Plain, limits: Limits::ANY },
            Field { name: "cause", lsb: 12, width: 4, unit: "", meaning: "T-format cause of the exchange", values: Values::Codes(&[Named { name: "none", number: 0, meaning: "none" }, Named { name: "unknown_command", number: 1, meaning: "unknown request" }, Named { name: "line_not_idle", number: 2, meaning: "line not idle" }, Named { name: "no_answer", number: 3, meaning: "no answer" }, Named { name: "no_header", number: 4, meaning: "no header" }, Named { name: "control_parity", number: 5, meaning: "parity of the control field" }, Named { name: "reply_echo", number: 6, meaning: "another ID or address in the reply" }, Named { name: "delimiter", number: 7, meaning: "delimiter" }, Named { name: "field_missing", number: 8, meaning: "field missing" }, Named { name: "reply_crc", number: 9, meaning: "CRC" }, Named { name: "request_parity", number: 10, meaning: "encoder saw a parity error" }, Named { name: "request_delimiter", number: 11, meaning: "encoder saw a delimiter error" }, Named { name: "eeprom_busy", number: 12, meaning: "EEPROM busy" }, Named { name: "counting_error", number: 13, meaning: "counting error" }, Named { name: "multi_turn_alarm", number: 14, meaning: "multi-turn or battery alarm" }, Named { name: "upset", number: 15, meaning: "stored data upset" }]), limits: Limits::ANY },
            Field { name: "done", lsb: 16, width: 1, unit: "", meaning: "The exchange has ended; 0 from send on", values: Values::Plain, limits: Limits::ANY },
            Field { name: "busy", lsb: 17, width: 1, unit: "", meaning: "The exchange is under way, or waits for its turn", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "fields", offset: 2, access: Access::ReadOnly, meaning: "Fields of the last reply, of a trigger or of send.", fields: &[
            Field { name: "status", lsb: 0, width: 8, unit: "", meaning: "Status field (SF); 0 if none came", values: Values::Plain, limits: Limits::ANY },
            Field { name: "encoder_id", lsb: 8, width: 8, unit: "", meaning: "Kind of encoder (ENID) as it came last", values: Values::Plain, limits: Limits::ANY },
            Field { name: "alarm", lsb: 16, width: 8, unit: "", meaning: "Alarm field (ALMC) as it came last", values: Values::Plain, limits: Limits::ANY },
            Field { name: "crc", lsb: 24, width: 8, unit: "", meaning: "CRC as received", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "parts", offset: 3, access: Access::ReadOnly, meaning: "Which parts of the position have come since reset.", fields: &[
            Field { name: "single_valid", lsb: 0, width: 1, unit: "", meaning: "There is a single-turn position, bits 23..0", values: Values::Plain, limits: Limits::ANY },
            Field { name: "multi_valid", lsb: 1, width: 1, unit: "", meaning: "There is a multi-turn position, bits 47..24", values: Values::Plain, limits: Limits::ANY },
        ] },
    ] },
    Block { name: "card_config", base: 0x100, stride: 8, per_channel: false, meaning: "Configuration of the card.", registers: &[
        Register { name: "trigger_sources", offset: 0, access: Access::ReadWrite, meaning: "Enabled trigger sources; one trigger starts all channels that take it in the same clock cycle.", fields: &[
            Field { name: "pin", lsb: 0, width: 1, unit: "", meaning: "Rising edge of the trigger pin", values: Values::Plain, limits: Limits::ANY },
            Field { name: "timer", lsb: 1, width: 1, unit: "", meaning: "Every trigger_period", values: Values::Plain, limits: Limits::ANY },
            Field { name: "register", lsb: 2, width: 1, unit: "", meaning: "trigger_now", values: Values::Plain, limits: Limits::ANY },
            Field { name: "disabled", lsb: 8, width: 8, unit: "", meaning: "Channels that take no trigger, bit n for channel n; with part own_trigger only", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "trigger_period", offset: 1, access: Access::ReadWrite, meaning: "Period of the timer, at least 4; write it while the timer is disabled.", fields: &[
            Field { name: "value", lsb: 0, width: 24, unit: "cycles", meaning: "Period", values: Values::Plain, limits: Limits { endat: &[(4, 16777215)], t_format: &[] } },
        ] },
        Register { name: "hold", offset: 2, access: Access::ReadWrite, meaning: "Keeps the results of all channels, for a host that reads word by word.", fields: &[
            Field { name: "hold", lsb: 0, width: 1, unit: "", meaning: "1: results and trigger_count stand still", values: Values::Plain, limits: Limits::ANY },
            Field { name: "scratch", lsb: 8, width: 24, unit: "", meaning: "Free for the host, to try the link", values: Values::Plain, limits: Limits::ANY },
        ] },
    ] },
    Block { name: "config", base: 0x108, stride: 8, per_channel: true, meaning: "Configuration of a channel; taken over between two frames.", registers: &[
        Register { name: "frame", offset: 0, access: Access::ReadWrite, meaning: "What is asked of the encoder, and how fast.", fields: &[
            Field { name: "period_cycles", lsb: 0, width: 11, unit: "cycles", meaning: "EnDat clock period; the high phase is the longer one when odd; T-format: a bit, 8..127", values: Values::Plain, limits: Limits { endat: &[(2, 2047)], t_format: &[(8, 127)] } },
            Field { name: "skip", lsb: 11, width: 5, unit: "", meaning: "Triggers left out after each that the channel takes; with part own_trigger only, as the ignored sources", values: Values::Plain, limits: Limits::ANY },
            Field { name: "position_bits", lsb: 16, width: 6, unit: "bits", meaning: "Position width, 1..48; T-format: no meaning, as command", values: Values::Plain, limits: Limits { endat: &[(1, 48)], t_format: &[] } },
            Field { name: "ignore_pin", lsb: 22, width: 1, unit: "", meaning: "1: the trigger pin is not for this channel", values: Values::Plain, limits: Limits::ANY },
            Field { name: "ignore_timer", lsb: 23, width: 1, unit: "", meaning: "1: the timer is not", values: Values::Plain, limits: Limits::ANY },
            Field { name: "command", lsb: 24, width: 6, unit: "", meaning: "Mode command, sent most significant bit first", values: Values::Codes(&[Named { name: "send_position", number: 7, meaning: "000111 send position (EnDat 2.1)" }, Named { name: "send_position_add_info", number: 56, meaning: "111000 send position with additional information (EnDat 2.2)" }]), limits: Limits::ANY },
            Field { name: "ignore_register", lsb: 30, width: 1, unit: "", meaning: "1: trigger_now is not", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "timing", offset: 1, access: Access::ReadWrite, meaning: "First low phase and tolerance of the start bit.", fields: &[
            Field { name: "first_low_extra_cycles", lsb: 0, width: 11, unit: "cycles", meaning: "First low phase minus half a period (tST)", values: Values::Plain, limits: Limits::ANY },
            Field { name: "start_window_cycles", lsb: 16, width: 6, unit: "cycles", meaning: "The start edge must come within plus or minus this of its expected phase", values: Values::Plain, limits: Limits::ANY },
            Field { name: "filter_half", lsb: 23, width: 1, unit: "", meaning: "1: half a cycle more; with part double_edge only", values: Values::Plain, limits: Limits::ANY },
            Field { name: "filter_cycles", lsb: 24, width: 4, unit: "cycles", meaning: "Pulses on DATA up to this length are ignored; 0 = off", values: Values::Plain, limits: Limits::ANY },
            Field { name: "request_id", lsb: 28, width: 4, unit: "", meaning: "T-format: request ID of a trigger; 6 and 13 are not sent", values: Values::Plain, limits: Limits { endat: &[], t_format: &[(0, 5), (7, 12), (14, 15)] } },
        ] },
        Register { name: "limits", offset: 2, access: Access::ReadWrite, meaning: "Longest waits.", fields: &[
            Field { name: "start_timeout_us", lsb: 0, width: 12, unit: "us", meaning: "Longest wait for the start bit after the turnaround; T-format: longest pause before the reply, 1..63", values: Values::Plain, limits: Limits { endat: &[], t_format: &[(1, 63)] } },
            Field { name: "recovery_limit_cycles", lsb: 16, width: 13, unit: "cycles", meaning: "DATA must fall within this after the frame (tm)", values: Values::Plain, limits: Limits::ANY },
            Field { name: "field_gap_us", lsb: 29, width: 3, unit: "us", meaning: "T-format: longest pause between two fields", values: Values::Plain, limits: Limits::ANY },
        ] },
    ] },
    Block { name: "result", base: 0x180, stride: 8, per_channel: true, meaning: "Result of a channel; all words of all channels change together and never within a read command.", registers: &[
        Register { name: "status", offset: 0, access: Access::ReadOnly, meaning: "What became of the last trigger.", fields: &[
            Field { name: "sequence", lsb: 0, width: 16, unit: "", meaning: "Number of results, wrapping", values: Values::Plain, limits: Limits::ANY },
            Field { name: "cause", lsb: 16, width: 5, unit: "", meaning: "Primary cause; 8, 17, 29 and 30 come with a good position: fresh tells", values: Values::Codes(&[Named { name: "none", number: 0, meaning: "none" }, Named { name: "data_not_low", number: 1, meaning: "data not low before start" }, Named { name: "no_start_bit", number: 2, meaning: "no start bit" }, Named { name: "start_window", number: 3, meaning: "start bit outside its window" }, Named { name: "crc", number: 4, meaning: "CRC" }, Named { name: "f1", number: 5, meaning: "F1" }, Named { name: "f2", number: 6, meaning: "F2" }, Named { name: "data_not_falling", number: 7, meaning: "data not falling after the frame" }, Named { name: "trigger_overrun", number: 8, meaning: "trigger overrun" }, Named { name: "unknown_command", number: 9, meaning: "unknown mode command" }, Named { name: "info_missing", number: 10, meaning: "additional information missing" }, Named { name: "no_encoder", number: 11, meaning: "no encoder" }, Named { name: "stuck_high", number: 12, meaning: "data stuck high" }, Named { name: "stuck_low", number: 13, meaning: "data stuck low" }, Named { name: "late_start", number: 14, meaning: "late start bit" }, Named { name: "watchdog", number: 15, meaning: "watchdog" }, Named { name: "own_echo", number: 16, meaning: "echo of the own command" }, Named { name: "recovery_too_short", number: 17, meaning: "recovery time too short" }, Named { name: "line_not_idle", number: 18, meaning: "line not idle" }, Named { name: "no_answer", number: 19, meaning: "no answer" }, Named { name: "no_header", number: 20, meaning: "no header" }, Named { name: "control_parity", number: 21, meaning: "parity of the control field" }, Named { name: "reply_echo", number: 22, meaning: "another ID or address in the reply" }, Named { name: "delimiter", number: 23, meaning: "delimiter" }, Named { name: "field_missing", number: 24, meaning: "field missing" }, Named { name: "reply_crc", number: 25, meaning: "CRC" }, Named { name: "request_parity", number: 26, meaning: "encoder saw a parity error" }, Named { name: "request_delimiter", number: 27, meaning: "encoder saw a delimiter error" }, Named { name: "eeprom_busy", number: 28, meaning: "EEPROM busy" }, Named { name: "counting_error", number: 29, meaning: "counting error" }, Named { name: "multi_turn_alarm", number: 30, meaning: "multi-turn or battery alarm" }, Named { name: "upset", number: 31, meaning: "stored data upset" }]), limits: Limits::ANY },
            Field { name: "valid", lsb: 22, width: 1, unit: "", meaning: "There is a good position", values: Values::Plain, limits: Limits::ANY },
            Field { name: "fresh", lsb: 23, width: 1, unit: "", meaning: "The last result brought the position; 0 = held from an earlier one", values: Values::Plain, limits: Limits::ANY },
            Field { name: "line", lsb: 24, width: 8, unit: "", meaning: "Raw flags: bit k stands for cause k + 11, bit 7 for cause 31; T-format: bits 0, 1 and 2 for causes 29, 30 and 8", values: Values::Bits(&[Named { name: "no_encoder", number: 0, meaning: "no encoder" }, Named { name: "stuck_high", number: 1, meaning: "data stuck high" }, Named { name: "stuck_low", number: 2, meaning: "data stuck low" }, Named { name: "late_start", number: 3, meaning: "late start bit" }, Named { name: "watchdog", number: 4, meaning: "watchdog" }, Named { name: "own_echo", number: 5, meaning: "echo of the own command" }, Named { name: "recovery_too_short", number: 6, meaning: "recovery time too short" }, Named { name: "upset", number: 7, meaning: "stored data upset" }]), limits: Limits::ANY },
        ] },
        Register { name: "position_low", offset: 1, access: Access::ReadOnly, meaning: "Last good position, bits 31..0.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "", meaning: "Bit 0 is the LSB", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "position_high", offset: 2, access: Access::ReadOnly, meaning: "Last good position, bits 47..32.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "0 above the position's width; T-format: multi-turn in bits 47..24, single-turn in 23..0", values: Values::Plain, limits: Limits::ANY },
            Field { name: "crc", lsb: 16, width: 5, unit: "", meaning: "CRC that came with this position, over F1, F2 and the position, LSB first: whoever reads it checks it once more; T-format: 0", values: Values::Plain, limits: Limits::ANY },
            Field { name: "f2", lsb: 22, width: 1, unit: "", meaning: "The position came with F2 = 1 (EnDat 2.2); F1 of a good position is 0", values: Values::Plain, limits: Limits::ANY },
            Field { name: "width", lsb: 24, width: 6, unit: "bits", meaning: "Width of this position; 0 = there is none yet, or T-format: nothing to check", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "timestamp", offset: 3, access: Access::ReadOnly, meaning: "First falling clock edge of the frame that brought the position; equal in two EnDat channels = same trigger. T-format: start bit of the request.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "cycles", meaning: "Since reset, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "evidence", offset: 4, access: Access::ReadOnly, meaning: "How good the last frame was.", fields: &[
            Field { name: "crc_received", lsb: 0, width: 5, unit: "", meaning: "CRC as received", values: Values::Plain, limits: Limits::ANY },
            Field { name: "crc_computed", lsb: 5, width: 5, unit: "", meaning: "CRC as computed", values: Values::Plain, limits: Limits::ANY },
            Field { name: "delay_cycles", lsb: 10, width: 10, unit: "cycles", meaning: "Tracked line delay tD, synchroniser and filter included", values: Values::Plain, limits: Limits::ANY },
            Field { name: "flags", lsb: 20, width: 12, unit: "", meaning: "Raw flags; T-format: bit 0 for cause 9, bit k for cause k + 17", values: Values::Bits(&[Named { name: "data_not_low", number: 0, meaning: "data not low before start" }, Named { name: "no_start_bit", number: 1, meaning: "no start bit" }, Named { name: "start_window", number: 2, meaning: "start bit outside its window" }, Named { name: "crc", number: 3, meaning: "CRC" }, Named { name: "f1", number: 4, meaning: "F1" }, Named { name: "f2", number: 5, meaning: "F2" }, Named { name: "data_not_falling", number: 6, meaning: "data not falling after the frame" }, Named { name: "trigger_overrun", number: 7, meaning: "trigger overrun" }, Named { name: "parallel_crc", number: 8, meaning: "parallel CRC" }, Named { name: "tail_low", number: 9, meaning: "data not high after the frame" }, Named { name: "unknown_command", number: 10, meaning: "unknown mode command" }, Named { name: "info_missing", number: 11, meaning: "additional information missing" }]), limits: Limits::ANY },
        ] },
        Register { name: "age_recovery", offset: 5, access: Access::ReadOnly, meaning: "Age and recovery time.", fields: &[
            Field { name: "age_us", lsb: 0, width: 16, unit: "us", meaning: "Age of the position: 0 until its frame has ended, counted from there, also while results are held; stops at 65535", values: Values::Plain, limits: Limits::ANY },
            Field { name: "recovery_cycles", lsb: 16, width: 13, unit: "cycles", meaning: "Recovery time tm of the last frame", values: Values::Plain, limits: Limits::ANY },
            Field { name: "delay_high", lsb: 29, width: 1, unit: "", meaning: "Bit 10 of delay_cycles", values: Values::Plain, limits: Limits::ANY },
            Field { name: "stale", lsb: 30, width: 1, unit: "", meaning: "A trigger of this channel has come since this result", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "info_1", offset: 6, access: Access::ReadOnly, meaning: "Additional information 1 of the frame of this result.", fields: &[
            Field { name: "content", lsb: 0, width: 16, unit: "", meaning: "What it says; 0 unless good", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sign", lsb: 16, width: 5, unit: "", meaning: "I4..I0: which one it is; I4 = 0 information 1, 1 information 2", values: Values::Plain, limits: Limits::ANY },
            Field { name: "busy", lsb: 21, width: 1, unit: "", meaning: "The encoder is busy with a request", values: Values::Plain, limits: Limits::ANY },
            Field { name: "reference_mark", lsb: 22, width: 1, unit: "", meaning: "RM: the reference mark has been passed", values: Values::Plain, limits: Limits::ANY },
            Field { name: "warning", lsb: 23, width: 1, unit: "", meaning: "WRN: one of the encoder's warnings is set", values: Values::Plain, limits: Limits::ANY },
            Field { name: "came", lsb: 24, width: 1, unit: "", meaning: "The frame brought it", values: Values::Plain, limits: Limits::ANY },
            Field { name: "good", lsb: 25, width: 1, unit: "", meaning: "Its CRC is right", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "info_2", offset: 7, access: Access::ReadOnly, meaning: "Additional information 2 of the frame of this result.", fields: &[
            Field { name: "content", lsb: 0, width: 16, unit: "", meaning: "What it says; 0 unless good", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sign", lsb: 16, width: 5, unit: "", meaning: "I4..I0: which one it is; I4 = 0 information 1, 1 information 2", values: Values::Plain, limits: Limits::ANY },
            Field { name: "busy", lsb: 21, width: 1, unit: "", meaning: "The encoder is busy with a request", values: Values::Plain, limits: Limits::ANY },
            Field { name: "reference_mark", lsb: 22, width: 1, unit: "", meaning: "RM: the reference mark has been passed", values: Values::Plain, limits: Limits::ANY },
            Field { name: "warning", lsb: 23, width: 1, unit: "", meaning: "WRN: one of the encoder's warnings is set", values: Values::Plain, limits: Limits::ANY },
            Field { name: "came", lsb: 24, width: 1, unit: "", meaning: "The frame brought it", values: Values::Plain, limits: Limits::ANY },
            Field { name: "good", lsb: 25, width: 1, unit: "", meaning: "Its CRC is right", values: Values::Plain, limits: Limits::ANY },
        ] },
    ] },
    Block { name: "line", base: 0x200, stride: 64, per_channel: true, meaning: "Phase of the samples, and how much margin they have. A place is a system clock cycle, or half of one with double_edge; offsets are signed.", registers: &[
        Register { name: "edges_0", offset: 0, access: Access::ReadOnly, meaning: "Edges with offset -16 or less (all bins: offset divided by 2^bin_shift).", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_1", offset: 1, access: Access::ReadOnly, meaning: "Edges with offset -15.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_2", offset: 2, access: Access::ReadOnly, meaning: "Edges with offset -14.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_3", offset: 3, access: Access::ReadOnly, meaning: "Edges with offset -13.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_4", offset: 4, access: Access::ReadOnly, meaning: "Edges with offset -12.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_5", offset: 5, access: Access::ReadOnly, meaning: "Edges with offset -11.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_6", offset: 6, access: Access::ReadOnly, meaning: "Edges with offset -10.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_7", offset: 7, access: Access::ReadOnly, meaning: "Edges with offset -9.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_8", offset: 8, access: Access::ReadOnly, meaning: "Edges with offset -8.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_9", offset: 9, access: Access::ReadOnly, meaning: "Edges with offset -7.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_10", offset: 10, access: Access::ReadOnly, meaning: "Edges with offset -6.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_11", offset: 11, access: Access::ReadOnly, meaning: "Edges with offset -5.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_12", offset: 12, access: Access::ReadOnly, meaning: "Edges with offset -4.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_13", offset: 13, access: Access::ReadOnly, meaning: "Edges with offset -3.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_14", offset: 14, access: Access::ReadOnly, meaning: "Edges with offset -2.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_15", offset: 15, access: Access::ReadOnly, meaning: "Edges with offset -1: at the expected place, or up to one place before.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_16", offset: 16, access: Access::ReadOnly, meaning: "Edges with offset 0: up to one place after the expected one.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_17", offset: 17, access: Access::ReadOnly, meaning: "Edges with offset 1.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_18", offset: 18, access: Access::ReadOnly, meaning: "Edges with offset 2.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_19", offset: 19, access: Access::ReadOnly, meaning: "Edges with offset 3.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_20", offset: 20, access: Access::ReadOnly, meaning: "Edges with offset 4.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_21", offset: 21, access: Access::ReadOnly, meaning: "Edges with offset 5.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_22", offset: 22, access: Access::ReadOnly, meaning: "Edges with offset 6.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_23", offset: 23, access: Access::ReadOnly, meaning: "Edges with offset 7.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_24", offset: 24, access: Access::ReadOnly, meaning: "Edges with offset 8.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_25", offset: 25, access: Access::ReadOnly, meaning: "Edges with offset 9.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_26", offset: 26, access: Access::ReadOnly, meaning: "Edges with offset 10.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_27", offset: 27, access: Access::ReadOnly, meaning: "Edges with offset 11.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_28", offset: 28, access: Access::ReadOnly, meaning: "Edges with offset 12.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_29", offset: 29, access: Access::ReadOnly, meaning: "Edges with offset 13.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_30", offset: 30, access: Access::ReadOnly, meaning: "Edges with offset 14.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "edges_31", offset: 31, access: Access::ReadOnly, meaning: "Edges with offset 15 or more.", fields: &[
            Field { name: "edges", lsb: 0, width: 32, unit: "", meaning: "Edges since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "alignment", offset: 32, access: Access::ReadWrite, meaning: "Source of the phase; taken over between two frames.", fields: &[
            Field { name: "mode", lsb: 0, width: 2, unit: "", meaning: "Where the phase of the samples comes from", values: Values::Codes(&[Named { name: "tracked", number: 0, meaning: "mean over many edges" }, Named { name: "fixed", number: 1, meaning: "fixed_delay" }, Named { name: "frame", number: 2, meaning: "start bit of each frame" }]), limits: Limits::ANY },
            Field { name: "majority", lsb: 4, width: 1, unit: "", meaning: "Each sample is the majority of itself and its neighbours; measure the delay again after a change", values: Values::Plain, limits: Limits::ANY },
            Field { name: "bin_shift", lsb: 8, width: 2, unit: "", meaning: "Bins of the histogram are 2^bin_shift places wide; clear after a change", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "fixed_delay", offset: 33, access: Access::ReadWrite, meaning: "Delay in mode fixed, synchroniser and filter included.", fields: &[
            Field { name: "value", lsb: 0, width: 15, unit: "cycles/16", meaning: "As phase.tracked shows it", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "limits", offset: 34, access: Access::ReadWrite, meaning: "Limits of the alarms; 0 = none.", fields: &[
            Field { name: "drift", lsb: 0, width: 12, unit: "cycles/16", meaning: "Most that the tracked delay may be from its reference", values: Values::Plain, limits: Limits::ANY },
            Field { name: "offset", lsb: 16, width: 7, unit: "places", meaning: "Most that an edge may be from its expected place", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "clear", offset: 35, access: Access::Strobe, meaning: "Clears, or takes a new reference.", fields: &[
            Field { name: "clear", lsb: 0, width: 1, unit: "", meaning: "Write 1: histogram, worst edges, alarms, counters", values: Values::Plain, limits: Limits::ANY },
            Field { name: "reference", lsb: 1, width: 1, unit: "", meaning: "Write 1: the tracked delay becomes the reference", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frame", offset: 40, access: Access::ReadOnly, meaning: "Edges of the last frame.", fields: &[
            Field { name: "earliest", lsb: 0, width: 8, unit: "places", meaning: "Smallest offset", values: Values::Plain, limits: Limits::ANY },
            Field { name: "latest", lsb: 8, width: 8, unit: "places", meaning: "Largest offset", values: Values::Plain, limits: Limits::ANY },
            Field { name: "start", lsb: 16, width: 8, unit: "places", meaning: "Offset of the start bit's edge", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "worst", offset: 41, access: Access::ReadOnly, meaning: "Edges since clear.", fields: &[
            Field { name: "earliest", lsb: 0, width: 8, unit: "places", meaning: "Smallest offset", values: Values::Plain, limits: Limits::ANY },
            Field { name: "latest", lsb: 8, width: 8, unit: "places", meaning: "Largest offset", values: Values::Plain, limits: Limits::ANY },
            Field { name: "valid", lsb: 16, width: 1, unit: "", meaning: "There were edges", values: Values::Plain, limits: Limits::ANY },
            Field { name: "drift_alarm", lsb: 24, width: 1, unit: "", meaning: "The drift has been beyond its limit", values: Values::Plain, limits: Limits::ANY },
            Field { name: "offset_alarm", lsb: 25, width: 1, unit: "", meaning: "An edge has been beyond its limit", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "phase", offset: 42, access: Access::ReadOnly, meaning: "Tracked delay, synchroniser and filter included.", fields: &[
            Field { name: "tracked", lsb: 0, width: 15, unit: "cycles/16", meaning: "Mean place of the edges after their clock edge", values: Values::Plain, limits: Limits::ANY },
            Field { name: "reference", lsb: 16, width: 15, unit: "cycles/16", meaning: "What it was when it had been measured", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "counts", offset: 43, access: Access::ReadOnly, meaning: "Counters, wrapping.", fields: &[
            Field { name: "glitches", lsb: 0, width: 16, unit: "", meaning: "Pulses that the input filter has removed since clear", values: Values::Plain, limits: Limits::ANY },
            Field { name: "bad_frames", lsb: 16, width: 16, unit: "", meaning: "Frames with a cause other than 0 since clear", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames", offset: 44, access: Access::ReadOnly, meaning: "Frames since clear, wrapping.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "", meaning: "Frames", values: Values::Plain, limits: Limits::ANY },
        ] },
    ] },
    Block { name: "service", base: 0x400, stride: 128, per_channel: true, meaning: "Requests, health, slots and name plate of a channel. RAM: 0 after power-up, a reset does not clear it.", registers: &[
        Register { name: "request", offset: 0, access: Access::ReadWrite, meaning: "Sends a request when written.", fields: &[
            Field { name: "data", lsb: 0, width: 16, unit: "", meaning: "Data", values: Values::Plain, limits: Limits::ANY },
            Field { name: "address", lsb: 16, width: 8, unit: "", meaning: "MRS code, address or port", values: Values::Plain, limits: Limits::ANY },
            Field { name: "command", lsb: 24, width: 6, unit: "", meaning: "Mode command, any of the fourteen", values: Values::Codes(&[Named { name: "send_position", number: 7, meaning: "000111 send position (EnDat 2.1)" }, Named { name: "select_memory", number: 14, meaning: "001110 selection of memory area" }, Named { name: "receive_parameter", number: 28, meaning: "011100 receive parameter" }, Named { name: "send_parameter", number: 35, meaning: "100011 send parameter" }, Named { name: "receive_reset", number: 42, meaning: "101010 receive reset" }, Named { name: "send_test_values", number: 21, meaning: "010101 send test values" }, Named { name: "receive_test_command", number: 49, meaning: "110001 receive test command" }, Named { name: "send_position_add_info", number: 56, meaning: "111000 send position with additional information (EnDat 2.2)" }, Named { name: "position_select_memory", number: 9, meaning: "001001 send position, then selection of memory area or additional information" }, Named { name: "position_receive_parameter", number: 27, meaning: "011011 send position, then receive parameter" }, Named { name: "position_send_parameter", number: 36, meaning: "100100 send position, then send parameter" }, Named { name: "position_error_reset", number: 45, meaning: "101101 send position, then receive error reset" }, Named { name: "position_test_command", number: 54, meaning: "110110 send position, then receive test command" }, Named { name: "receive_communication", number: 18, meaning: "010010 receive communication command" }]), limits: Limits::ANY },
        ] },
        Register { name: "request_state", offset: 1, access: Access::ReadOnly, meaning: "What became of the request.", fields: &[
            Field { name: "busy", lsb: 0, width: 1, unit: "", meaning: "It is under way", values: Values::Plain, limits: Limits::ANY },
            Field { name: "error", lsb: 4, width: 4, unit: "", meaning: "What went wrong", values: Values::Codes(&[Named { name: "fulfilled", number: 0, meaning: "fulfilled" }, Named { name: "no_answer", number: 1, meaning: "no answer: command not understood or refused" }, Named { name: "address_echo", number: 2, meaning: "echo of MRS code, address or port wrong" }, Named { name: "data_echo", number: 3, meaning: "echo of data wrong" }, Named { name: "crc", number: 4, meaning: "CRC of the answer wrong" }, Named { name: "unknown_command", number: 5, meaning: "unknown mode command, nothing was sent" }, Named { name: "frame", number: 6, meaning: "frame went wrong or could not begin" }, Named { name: "busy_timeout", number: 7, meaning: "encoder stayed busy" }, Named { name: "no_trigger", number: 8, meaning: "no trigger came in time for a request that rides on one" }, Named { name: "cancelled", number: 9, meaning: "cancelled by the host" }]), limits: Limits::ANY },
            Field { name: "finished", lsb: 16, width: 16, unit: "", meaning: "Requests finished, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "answer", offset: 2, access: Access::ReadOnly, meaning: "Answer to the last request; bits 31..0 of a longer one.", fields: &[
            Field { name: "data", lsb: 0, width: 16, unit: "", meaning: "Data, or content of additional information 1", values: Values::Plain, limits: Limits::ANY },
            Field { name: "address", lsb: 16, width: 8, unit: "", meaning: "Echo of MRS code, address or port; or WRN, RM, Busy, I4..I0", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "answer_more", offset: 3, access: Access::ReadOnly, meaning: "Bits 47..32 of a longer answer.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Bits 47..32", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "duration", offset: 4, access: Access::ReadOnly, meaning: "How long the last request took.", fields: &[
            Field { name: "us", lsb: 0, width: 16, unit: "us", meaning: "Modulo 65536", values: Values::Plain, limits: Limits::ANY },
            Field { name: "ms", lsb: 16, width: 16, unit: "ms", meaning: "The same in milliseconds", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "control", offset: 5, access: Access::ReadWrite, meaning: "Acts when written.", fields: &[
            Field { name: "initialise", lsb: 0, width: 1, unit: "", meaning: "1: initialise the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "clear", lsb: 1, width: 1, unit: "", meaning: "1: counters, alarm and position_2 to zero", values: Values::Plain, limits: Limits::ANY },
            Field { name: "cancel", lsb: 2, width: 1, unit: "", meaning: "1: the request that waits for a trigger is given up; one on the wire is finished", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "force", offset: 6, access: Access::ReadWrite, meaning: "Errors forced upon what is received, to try the error paths; not for regular operation.", fields: &[
            Field { name: "f1", lsb: 0, width: 1, unit: "", meaning: "Inverts F1", values: Values::Plain, limits: Limits::ANY },
            Field { name: "f2", lsb: 1, width: 1, unit: "", meaning: "Inverts F2", values: Values::Plain, limits: Limits::ANY },
            Field { name: "crc", lsb: 2, width: 1, unit: "", meaning: "Spoils the CRC", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "progress", offset: 7, access: Access::ReadOnly, meaning: "Initialisation.", fields: &[
            Field { name: "step", lsb: 0, width: 16, unit: "", meaning: "Step under way", values: Values::Codes(&[Named { name: "none", number: 0, meaning: "none" }, Named { name: "reset", number: 1, meaning: "reset" }, Named { name: "select_b9", number: 2, meaning: "select memory area 0xB9" }, Named { name: "read_alarms", number: 3, meaning: "read alarms" }, Named { name: "read_warnings", number: 4, meaning: "read warnings" }, Named { name: "clear_alarms", number: 5, meaning: "write 0 to word 0" }, Named { name: "clear_warnings", number: 6, meaning: "write 0 to word 1" }, Named { name: "select_a1", number: 7, meaning: "select memory area 0xA1" }, Named { name: "read_position_bits", number: 8, meaning: "read position_bits" }, Named { name: "take_width", number: 9, meaning: "take over the position width" }, Named { name: "read_encoder_type", number: 10, meaning: "read encoder_type" }, Named { name: "read_signal_periods_low", number: 11, meaning: "read signal_periods_low" }, Named { name: "select_a3", number: 12, meaning: "select memory area 0xA3" }, Named { name: "read_signal_periods_high", number: 13, meaning: "read signal_periods_high" }, Named { name: "read_revolutions", number: 14, meaning: "read revolutions" }, Named { name: "read_steps_low", number: 15, meaning: "read steps_low" }, Named { name: "read_steps_high", number: 16, meaning: "read steps_high" }, Named { name: "read_id_0", number: 17, meaning: "read id_0" }, Named { name: "read_id_1", number: 18, meaning: "read id_1" }, Named { name: "read_id_2", number: 19, meaning: "read id_2" }, Named { name: "read_serial_0", number: 20, meaning: "read serial_0" }, Named { name: "read_serial_1", number: 21, meaning: "read serial_1" }, Named { name: "read_serial_2", number: 22, meaning: "read serial_2" }, Named { name: "select_a5", number: 23, meaning: "select memory area 0xA5" }, Named { name: "read_commands", number: 24, meaning: "read commands" }, Named { name: "read_tcal", number: 25, meaning: "read tcal" }, Named { name: "find_endat22", number: 26, meaning: "find out whether it knows EnDat 2.2" }, Named { name: "select_bd", number: 27, meaning: "select memory area 0xBD" }, Named { name: "read_infos_1", number: 28, meaning: "read infos_1" }, Named { name: "read_infos_2", number: 29, meaning: "read infos_2" }, Named { name: "read_clock_max_khz", number: 30, meaning: "read clock_max_khz" }, Named { name: "choose_clock", number: 31, meaning: "choose the clock" }, Named { name: "select_b9_again", number: 32, meaning: "select memory area 0xB9" }, Named { name: "read_recovery", number: 33, meaning: "read recovery" }, Named { name: "set_recovery", number: 34, meaning: "set the recovery time" }]), limits: Limits::ANY },
            Field { name: "failed", lsb: 16, width: 16, unit: "", meaning: "Step that failed", values: Values::Codes(&[Named { name: "none", number: 0, meaning: "none" }, Named { name: "reset", number: 1, meaning: "reset" }, Named { name: "select_b9", number: 2, meaning: "select memory area 0xB9" }, Named { name: "read_alarms", number: 3, meaning: "read alarms" }, Named { name: "read_warnings", number: 4, meaning: "read warnings" }, Named { name: "clear_alarms", number: 5, meaning: "write 0 to word 0" }, Named { name: "clear_warnings", number: 6, meaning: "write 0 to word 1" }, Named { name: "select_a1", number: 7, meaning: "select memory area 0xA1" }, Named { name: "read_position_bits", number: 8, meaning: "read position_bits" }, Named { name: "take_width", number: 9, meaning: "take over the position width" }, Named { name: "read_encoder_type", number: 10, meaning: "read encoder_type" }, Named { name: "read_signal_periods_low", number: 11, meaning: "read signal_periods_low" }, Named { name: "select_a3", number: 12, meaning: "select memory area 0xA3" }, Named { name: "read_signal_periods_high", number: 13, meaning: "read signal_periods_high" }, Named { name: "read_revolutions", number: 14, meaning: "read revolutions" }, Named { name: "read_steps_low", number: 15, meaning: "read steps_low" }, Named { name: "read_steps_high", number: 16, meaning: "read steps_high" }, Named { name: "read_id_0", number: 17, meaning: "read id_0" }, Named { name: "read_id_1", number: 18, meaning: "read id_1" }, Named { name: "read_id_2", number: 19, meaning: "read id_2" }, Named { name: "read_serial_0", number: 20, meaning: "read serial_0" }, Named { name: "read_serial_1", number: 21, meaning: "read serial_1" }, Named { name: "read_serial_2", number: 22, meaning: "read serial_2" }, Named { name: "select_a5", number: 23, meaning: "select memory area 0xA5" }, Named { name: "read_commands", number: 24, meaning: "read commands" }, Named { name: "read_tcal", number: 25, meaning: "read tcal" }, Named { name: "find_endat22", number: 26, meaning: "find out whether it knows EnDat 2.2" }, Named { name: "select_bd", number: 27, meaning: "select memory area 0xBD" }, Named { name: "read_infos_1", number: 28, meaning: "read infos_1" }, Named { name: "read_infos_2", number: 29, meaning: "read infos_2" }, Named { name: "read_clock_max_khz", number: 30, meaning: "read clock_max_khz" }, Named { name: "choose_clock", number: 31, meaning: "choose the clock" }, Named { name: "select_b9_again", number: 32, meaning: "select memory area 0xB9" }, Named { name: "read_recovery", number: 33, meaning: "read recovery" }, Named { name: "set_recovery", number: 34, meaning: "set the recovery time" }]), limits: Limits::ANY },
        ] },
        Register { name: "state", offset: 8, access: Access::ReadOnly, meaning: "What is known and what is wrong.", fields: &[
            Field { name: "initialised", lsb: 0, width: 1, unit: "", meaning: "The name plate is valid", values: Values::Plain, limits: Limits::ANY },
            Field { name: "alarm", lsb: 1, width: 1, unit: "", meaning: "Too many bad frames; latched", values: Values::Plain, limits: Limits::ANY },
            Field { name: "position_2", lsb: 2, width: 1, unit: "", meaning: "Position 2 was too far from position 1; latched", values: Values::Plain, limits: Limits::ANY },
            Field { name: "endat22", lsb: 3, width: 1, unit: "", meaning: "The encoder knows EnDat 2.2", values: Values::Plain, limits: Limits::ANY },
            Field { name: "other_width", lsb: 4, width: 1, unit: "", meaning: "The encoder has another width than configured; its own is used", values: Values::Plain, limits: Limits::ANY },
            Field { name: "slower", lsb: 5, width: 1, unit: "", meaning: "The encoder takes only a slower clock than configured; that is used", values: Values::Plain, limits: Limits::ANY },
            Field { name: "unplugged", lsb: 6, width: 1, unit: "", meaning: "DATA has been HIGH for long: no encoder, or an open line", values: Values::Plain, limits: Limits::ANY },
            Field { name: "initialising", lsb: 7, width: 1, unit: "", meaning: "power-up sequence or initialisation is under way; triggers are lost", values: Values::Plain, limits: Limits::ANY },
            Field { name: "starts", lsb: 16, width: 16, unit: "", meaning: "How often the program has begun since power-up, wrapping: one more after each reset, and after an upset that led it astray", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "lost", offset: 9, access: Access::ReadOnly, meaning: "What did not get its turn.", fields: &[
            Field { name: "triggers", lsb: 0, width: 16, unit: "", meaning: "Triggers that came while the line was not free, wrapping", values: Values::Plain, limits: Limits::ANY },
            Field { name: "ends", lsb: 16, width: 16, unit: "", meaning: "Frames that ended before the one before was counted", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "threshold", offset: 10, access: Access::ReadWrite, meaning: "Alarm: n bad frames of the last m.", fields: &[
            Field { name: "n", lsb: 0, width: 16, unit: "frames", meaning: "0 = no alarm", values: Values::Plain, limits: Limits::ANY },
            Field { name: "m", lsb: 16, width: 16, unit: "frames", meaning: "1..16; another m begins a new count", values: Values::Plain, limits: Limits { endat: &[(1, 16)], t_format: &[] } },
        ] },
        Register { name: "bad_frames", offset: 11, access: Access::ReadOnly, meaning: "Bad frames of the last m.", fields: &[
            Field { name: "count", lsb: 0, width: 16, unit: "frames", meaning: "How many", values: Values::Plain, limits: Limits::ANY },
            Field { name: "which", lsb: 16, width: 16, unit: "", meaning: "Bit 0 = the last frame", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "offset_low", offset: 12, access: Access::ReadWrite, meaning: "Position 2 minus position 1 as it should be, bits 31..0.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "", meaning: "Number", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "offset_high", offset: 13, access: Access::ReadWrite, meaning: "The same, bits 47..32.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Bits 47..32", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "tolerance", offset: 14, access: Access::ReadWrite, meaning: "Largest distance from that; 0 = no comparison.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "", meaning: "Number", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "difference_low", offset: 15, access: Access::ReadOnly, meaning: "Position 2 minus position 1 minus offset, modulo the position's width, bits 31..0.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "", meaning: "Number", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "difference_high", offset: 16, access: Access::ReadOnly, meaning: "The same, bits 47..32.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Bits 47..32", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "comparisons", offset: 17, access: Access::ReadOnly, meaning: "Comparisons of positions 1 and 2.", fields: &[
            Field { name: "all", lsb: 0, width: 16, unit: "", meaning: "All, wrapping", values: Values::Plain, limits: Limits::ANY },
            Field { name: "failed", lsb: 16, width: 16, unit: "", meaning: "Those that failed, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "position_2_low", offset: 18, access: Access::ReadOnly, meaning: "Position 2, bits 31..0.", fields: &[
            Field { name: "value", lsb: 0, width: 32, unit: "", meaning: "Number", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "position_2_high", offset: 19, access: Access::ReadOnly, meaning: "Position 2, bits 47..32.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Bits 47..32", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "list_length", offset: 20, access: Access::ReadWrite, meaning: "Codes of the list that are selected in turn.", fields: &[
            Field { name: "length", lsb: 0, width: 4, unit: "", meaning: "0..8; more is 8", values: Values::Plain, limits: Limits { endat: &[(0, 8)], t_format: &[] } },
        ] },
        Register { name: "info_status", offset: 21, access: Access::ReadOnly, meaning: "WRN, RM, Busy, I4..I0 as they came last with a right CRC.", fields: &[
            Field { name: "info_1", lsb: 0, width: 8, unit: "", meaning: "Of additional information 1", values: Values::Plain, limits: Limits::ANY },
            Field { name: "crc_1", lsb: 8, width: 1, unit: "", meaning: "CRC of the last additional information 1 wrong: nothing of it was taken", values: Values::Plain, limits: Limits::ANY },
            Field { name: "info_2", lsb: 16, width: 8, unit: "", meaning: "Of additional information 2", values: Values::Plain, limits: Limits::ANY },
            Field { name: "crc_2", lsb: 24, width: 1, unit: "", meaning: "CRC of the last additional information 2 wrong: nothing of it was taken", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "limits", offset: 22, access: Access::ReadWrite, meaning: "What a frame must keep to.", fields: &[
            Field { name: "watchdog_us", lsb: 0, width: 12, unit: "us", meaning: "Longest time from the first falling edge to the end of the recovery time; 0 = not watched. Commands with a parameter and continuous clock are not watched", values: Values::Plain, limits: Limits::ANY },
            Field { name: "recovery_min_cycles", lsb: 16, width: 13, unit: "cycles", meaning: "Shortest recovery time; 0 = not checked. The program writes the shortest of the configured range at start", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "continuous", offset: 23, access: Access::ReadWrite, meaning: "Continuous clock, for the command 000111.", fields: &[
            Field { name: "go_on", lsb: 0, width: 1, unit: "", meaning: "1: the clock goes on after each position, from the next trigger on", values: Values::Plain, limits: Limits::ANY },
            Field { name: "stop_at_error", lsb: 1, width: 1, unit: "", meaning: "1: it stops after an error until the next trigger; 0: it goes on after CRC, F1 and F2", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "list_0", offset: 24, access: Access::ReadWrite, meaning: "A code of the list.", fields: &[
            Field { name: "mrs", lsb: 0, width: 8, unit: "", meaning: "MRS code 0x40..0x5E", values: Values::Plain, limits: Limits { endat: &[(0, 0), (64, 94)], t_format: &[] } },
        ] },
        Register { name: "list_1", offset: 25, access: Access::ReadWrite, meaning: "A code of the list.", fields: &[
            Field { name: "mrs", lsb: 0, width: 8, unit: "", meaning: "MRS code 0x40..0x5E", values: Values::Plain, limits: Limits { endat: &[(0, 0), (64, 94)], t_format: &[] } },
        ] },
        Register { name: "list_2", offset: 26, access: Access::ReadWrite, meaning: "A code of the list.", fields: &[
            Field { name: "mrs", lsb: 0, width: 8, unit: "", meaning: "MRS code 0x40..0x5E", values: Values::Plain, limits: Limits { endat: &[(0, 0), (64, 94)], t_format: &[] } },
        ] },
        Register { name: "list_3", offset: 27, access: Access::ReadWrite, meaning: "A code of the list.", fields: &[
            Field { name: "mrs", lsb: 0, width: 8, unit: "", meaning: "MRS code 0x40..0x5E", values: Values::Plain, limits: Limits { endat: &[(0, 0), (64, 94)], t_format: &[] } },
        ] },
        Register { name: "list_4", offset: 28, access: Access::ReadWrite, meaning: "A code of the list.", fields: &[
            Field { name: "mrs", lsb: 0, width: 8, unit: "", meaning: "MRS code 0x40..0x5E", values: Values::Plain, limits: Limits { endat: &[(0, 0), (64, 94)], t_format: &[] } },
        ] },
        Register { name: "list_5", offset: 29, access: Access::ReadWrite, meaning: "A code of the list.", fields: &[
            Field { name: "mrs", lsb: 0, width: 8, unit: "", meaning: "MRS code 0x40..0x5E", values: Values::Plain, limits: Limits { endat: &[(0, 0), (64, 94)], t_format: &[] } },
        ] },
        Register { name: "list_6", offset: 30, access: Access::ReadWrite, meaning: "A code of the list.", fields: &[
            Field { name: "mrs", lsb: 0, width: 8, unit: "", meaning: "MRS code 0x40..0x5E", values: Values::Plain, limits: Limits { endat: &[(0, 0), (64, 94)], t_format: &[] } },
        ] },
        Register { name: "list_7", offset: 31, access: Access::ReadWrite, meaning: "A code of the list.", fields: &[
            Field { name: "mrs", lsb: 0, width: 8, unit: "", meaning: "MRS code 0x40..0x5E", values: Values::Plain, limits: Limits { endat: &[(0, 0), (64, 94)], t_format: &[] } },
        ] },
        Register { name: "slot_0", offset: 32, access: Access::ReadOnly, meaning: "What the additional information of that code said last.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Content", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sequence", lsb: 16, width: 16, unit: "", meaning: "status.sequence of the frame that brought it: its age is the difference", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "slot_1", offset: 33, access: Access::ReadOnly, meaning: "What the additional information of that code said last.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Content", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sequence", lsb: 16, width: 16, unit: "", meaning: "status.sequence of the frame that brought it: its age is the difference", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "slot_2", offset: 34, access: Access::ReadOnly, meaning: "What the additional information of that code said last.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Content", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sequence", lsb: 16, width: 16, unit: "", meaning: "status.sequence of the frame that brought it: its age is the difference", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "slot_3", offset: 35, access: Access::ReadOnly, meaning: "What the additional information of that code said last.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Content", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sequence", lsb: 16, width: 16, unit: "", meaning: "status.sequence of the frame that brought it: its age is the difference", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "slot_4", offset: 36, access: Access::ReadOnly, meaning: "What the additional information of that code said last.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Content", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sequence", lsb: 16, width: 16, unit: "", meaning: "status.sequence of the frame that brought it: its age is the difference", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "slot_5", offset: 37, access: Access::ReadOnly, meaning: "What the additional information of that code said last.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Content", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sequence", lsb: 16, width: 16, unit: "", meaning: "status.sequence of the frame that brought it: its age is the difference", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "slot_6", offset: 38, access: Access::ReadOnly, meaning: "What the additional information of that code said last.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Content", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sequence", lsb: 16, width: 16, unit: "", meaning: "status.sequence of the frame that brought it: its age is the difference", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "slot_7", offset: 39, access: Access::ReadOnly, meaning: "What the additional information of that code said last.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Content", values: Values::Plain, limits: Limits::ANY },
            Field { name: "sequence", lsb: 16, width: 16, unit: "", meaning: "status.sequence of the frame that brought it: its age is the difference", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "request_wait", offset: 40, access: Access::ReadWrite, meaning: "Longest wait of a request for a trigger.", fields: &[
            Field { name: "ms", lsb: 0, width: 16, unit: "ms", meaning: "0 = no limit. The program writes 2000 at start", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_good", offset: 48, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_data_not_low", offset: 49, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_no_start_bit", offset: 50, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_start_window", offset: 51, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_crc", offset: 52, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_f1", offset: 53, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_f2", offset: 54, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_data_not_falling", offset: 55, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_trigger_overrun", offset: 56, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_unknown_command", offset: 57, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_info_missing", offset: 58, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_no_encoder", offset: 59, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_stuck_high", offset: 60, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_stuck_low", offset: 61, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_late_start", offset: 62, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_watchdog", offset: 63, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_own_echo", offset: 64, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_recovery_too_short", offset: 65, access: Access::ReadOnly, meaning: "Frames that ended with this cause (good: with none).", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "frames_position_2", offset: 66, access: Access::ReadOnly, meaning: "Comparisons of positions 1 and 2 that failed.", fields: &[
            Field { name: "frames", lsb: 0, width: 32, unit: "", meaning: "Frames since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "bad_infos", offset: 67, access: Access::ReadOnly, meaning: "Additional informations with a wrong CRC.", fields: &[
            Field { name: "count", lsb: 0, width: 32, unit: "", meaning: "Since clear, wrapping", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "alarms", offset: 68, access: Access::ReadOnly, meaning: "Alarms before they were cleared", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "warnings", offset: 69, access: Access::ReadOnly, meaning: "Warnings before they were cleared", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "position_bits", offset: 70, access: Access::ReadOnly, meaning: "Word 13: clock pulses for the position in bits 5..0", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "encoder_type", offset: 71, access: Access::ReadOnly, meaning: "Word 14: bit 15: 1 = rotary, 0 = linear", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "signal_periods_low", offset: 72, access: Access::ReadOnly, meaning: "Word 15: signal periods per revolution, or in nm", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "signal_periods_high", offset: 73, access: Access::ReadOnly, meaning: "Word 16: upper part of word 15", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "revolutions", offset: 74, access: Access::ReadOnly, meaning: "Word 17: distinguishable revolutions", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "steps_low", offset: 75, access: Access::ReadOnly, meaning: "Word 20: measuring steps per revolution, or step in nm", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "steps_high", offset: 76, access: Access::ReadOnly, meaning: "Word 21: upper part of word 20", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "id_0", offset: 77, access: Access::ReadOnly, meaning: "Word 24: ID number, two ASCII characters", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "id_1", offset: 78, access: Access::ReadOnly, meaning: "Word 25: ID number, low", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "id_2", offset: 79, access: Access::ReadOnly, meaning: "Word 26: ID number, high", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "serial_0", offset: 80, access: Access::ReadOnly, meaning: "Word 27: serial number: high byte, ASCII character", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "serial_1", offset: 81, access: Access::ReadOnly, meaning: "Word 28: serial number, middle", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "serial_2", offset: 82, access: Access::ReadOnly, meaning: "Word 29: ASCII character, serial number low byte", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "commands", offset: 83, access: Access::ReadOnly, meaning: "Word 37: bits 1..0 = 01: EnDat 2.2; bits 3..2 = 01: functional safety", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "tcal", offset: 84, access: Access::ReadOnly, meaning: "Word 39: longest calculation time", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "infos_1", offset: 85, access: Access::ReadOnly, meaning: "EnDat 2.2 word 0: supported additional information 1", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "infos_2", offset: 86, access: Access::ReadOnly, meaning: "EnDat 2.2 word 1: supported additional information 2", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "clock_max_khz", offset: 87, access: Access::ReadOnly, meaning: "EnDat 2.2 word 25: fastest clock, in kHz", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "recovery", offset: 88, access: Access::ReadOnly, meaning: "Word 3 of the operating status as set: bits 1..0 = 10: 10 to 30 us, 01: 1.25 to 3.75 us", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "", meaning: "Word of the encoder", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been read", values: Values::Plain, limits: Limits::ANY },
        ] },
        Register { name: "delay", offset: 89, access: Access::ReadOnly, meaning: "Line delay measured at initialisation.", fields: &[
            Field { name: "value", lsb: 0, width: 16, unit: "cycles", meaning: "tD, synchroniser and filter included", values: Values::Plain, limits: Limits::ANY },
            Field { name: "is_read", lsb: 16, width: 1, unit: "", meaning: "It has been measured", values: Values::Plain, limits: Limits::ANY },
        ] },
    ] },
];
