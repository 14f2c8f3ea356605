//! What the numbers and bits of a field stand for, where each has a meaning of its own.

use crate::line_delay::mode;
use crate::protocol::ModeCommand;
use crate::service::map::request_state;
use crate::t_format::cause as t_format;
use crate::transaction::cause;

/// A number, or a bit, with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Named {
    /// Name, unique in its field; small letters, digits and underscores.
    pub name: &'static str,
    /// The field's number; of a bit its place, counted from the field's lowest bit.
    pub number: u32,
    /// What it stands for.
    pub meaning: &'static str,
}

/// How the content of a field is to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// As a number, or as bits that the field's meaning explains.
    Plain,
    /// Each of these numbers has a meaning of its own.
    Codes(&'static [Named]),
    /// Each of these bits has a meaning of its own.
    Bits(&'static [Named]),
}

const fn named(name: &'static str, number: u32, meaning: &'static str) -> Named {
    Named {
        name,
        number,
        meaning,
    }
}

/// Names of EnDat's causes; `frames_<name>` counts them.
const CAUSE_NAMES: [&str; cause::COUNT as usize] = [
    "none",
    "data_not_low",
    "no_start_bit",
    "start_window",
    "crc",
    "f1",
    "f2",
    "data_not_falling",
    "trigger_overrun",
    "unknown_command",
    "info_missing",
    "no_encoder",
    "stuck_high",
    "stuck_low",
    "late_start",
    "watchdog",
    "own_echo",
    "recovery_too_short",
];

/// Names of T-format's causes; a result has those that EnDat has too under EnDat's number.
const T_FORMAT_NAMES: [&str; t_format::COUNT as usize] = [
    "none",
    "unknown_command",
    "line_not_idle",
    "no_answer",
    "no_header",
    "control_parity",
    "reply_echo",
    "delimiter",
    "field_missing",
    "reply_crc",
    "request_parity",
    "request_delimiter",
    "eeprom_busy",
    "counting_error",
    "multi_turn_alarm",
    "upset",
    "trigger_overrun",
];

/// T-format's causes, as an exchange of the host has them: those before the trigger overrun.
pub const T_FORMAT_CAUSES: [Named; t_format::TRIGGER_OVERRUN as usize] = {
    let mut all = [named("", 0, ""); t_format::TRIGGER_OVERRUN as usize];
    let mut code = 0;
    while code < all.len() {
        let meaning = t_format::name(code as u64);
        all[code] = named(T_FORMAT_NAMES[code], code as u32, meaning);
        code += 1;
    }
    all
};

/// Primary causes of both protocols.
pub const CAUSES: [Named; cause::ALL_COUNT as usize] = {
    let mut all = [named("", 0, ""); cause::ALL_COUNT as usize];
    let upset = cause::UPSET;
    all[upset as usize] = named("upset", upset as u32, cause::name(upset));
    let mut code = 0;
    while code < CAUSE_NAMES.len() {
        all[code] = named(CAUSE_NAMES[code], code as u32, cause::name(code as u64));
        code += 1;
    }
    code = 0;
    while code < T_FORMAT_NAMES.len() {
        let at = t_format::of_card(code as u64) as usize;
        if at >= CAUSE_NAMES.len() {
            let meaning = t_format::name(code as u64);
            all[at] = named(T_FORMAT_NAMES[code], at as u32, meaning);
        }
        code += 1;
    }
    all
};

/// The raw flag of a cause, in a field that begins with this raw flag.
const fn flag_of(code: u64, first: u32) -> Named {
    let place = cause::flag(code).trailing_zeros() - first;
    named(CAUSE_NAMES[code as usize], place, cause::name(code))
}

/// Raw flags that stand beside the evidence.
pub const EVIDENCE_FLAGS: [Named; 12] = [
    flag_of(cause::DATA_NOT_LOW, 0),
    flag_of(cause::NO_START_BIT, 0),
    flag_of(cause::START_WINDOW, 0),
    flag_of(cause::CRC, 0),
    flag_of(cause::F1, 0),
    flag_of(cause::F2, 0),
    flag_of(cause::DATA_NOT_FALLING, 0),
    flag_of(cause::TRIGGER_OVERRUN, 0),
    named(
        "parallel_crc",
        cause::flag::PARALLEL_CRC.trailing_zeros(),
        "parallel CRC",
    ),
    named(
        "tail_low",
        cause::flag::TAIL_LOW.trailing_zeros(),
        "data not high after the frame",
    ),
    flag_of(cause::UNKNOWN_COMMAND, 0),
    flag_of(cause::INFO_MISSING, 0),
];

const LINE_FIRST: u32 = EVIDENCE_FLAGS.len() as u32;

/// Raw flags that stand in the status.
pub const LINE_FLAGS: [Named; 8] = [
    flag_of(cause::NO_ENCODER, LINE_FIRST),
    flag_of(cause::STUCK_HIGH, LINE_FIRST),
    flag_of(cause::STUCK_LOW, LINE_FIRST),
    flag_of(cause::LATE_START, LINE_FIRST),
    flag_of(cause::WATCHDOG, LINE_FIRST),
    flag_of(cause::OWN_ECHO, LINE_FIRST),
    flag_of(cause::RECOVERY_TOO_SHORT, LINE_FIRST),
    named(
        "upset",
        cause::flag(cause::UPSET).trailing_zeros() - LINE_FIRST,
        cause::name(cause::UPSET),
    ),
];

/// Sources of the phase.
pub const PHASE_MODES: [Named; 3] = [
    named("tracked", mode::TRACKED as u32, "mean over many edges"),
    named("fixed", mode::FIXED as u32, "fixed_delay"),
    named("frame", mode::FRAME as u32, "start bit of each frame"),
];

/// What a card has.
pub const FEATURES: [Named; 16] = [
    named("endat22", 0, "EnDat 2.2 position frames (111000)"),
    named("line_delay", 1, "line delay is measured"),
    named("trigger_pin", 2, "trigger pin"),
    named("trigger_timer", 3, "trigger timer"),
    named("requests", 4, "requests"),
    named("initialise", 5, "initialisation"),
    named("diagnosis", 6, "diagnosis of the line"),
    named("continuous", 7, "continuous clock"),
    named(
        "alignment",
        8,
        "phase at the host's choice, mean over many edges",
    ),
    named("margin", 9, "margin of the samples"),
    named("double_edge", 10, "DATA on both edges of the system clock"),
    named("stream", 11, "stream of sample sets"),
    named("direct", 12, "direct outputs"),
    named("interrupt", 13, "interrupt"),
    named("t_format", 14, "T-format channels"),
    named(
        "own_trigger",
        15,
        "enable, divider and sources of triggers of each channel",
    ),
];

/// Steps of the initialisation, in their order.
pub const STEPS: [Named; 35] = [
    named("none", 0, "none"),
    named("reset", 1, "reset"),
    named("select_b9", 2, "select memory area 0xB9"),
    named("read_alarms", 3, "read alarms"),
    named("read_warnings", 4, "read warnings"),
    named("clear_alarms", 5, "write 0 to word 0"),
    named("clear_warnings", 6, "write 0 to word 1"),
    named("select_a1", 7, "select memory area 0xA1"),
    named("read_position_bits", 8, "read position_bits"),
    named("take_width", 9, "take over the position width"),
    named("read_encoder_type", 10, "read encoder_type"),
    named("read_signal_periods_low", 11, "read signal_periods_low"),
    named("select_a3", 12, "select memory area 0xA3"),
    named("read_signal_periods_high", 13, "read signal_periods_high"),
    named("read_revolutions", 14, "read revolutions"),
    named("read_steps_low", 15, "read steps_low"),
    named("read_steps_high", 16, "read steps_high"),
    named("read_id_0", 17, "read id_0"),
    named("read_id_1", 18, "read id_1"),
    named("read_id_2", 19, "read id_2"),
    named("read_serial_0", 20, "read serial_0"),
    named("read_serial_1", 21, "read serial_1"),
    named("read_serial_2", 22, "read serial_2"),
    named("select_a5", 23, "select memory area 0xA5"),
    named("read_commands", 24, "read commands"),
    named("read_tcal", 25, "read tcal"),
    named("find_endat22", 26, "find out whether it knows EnDat 2.2"),
    named("select_bd", 27, "select memory area 0xBD"),
    named("read_infos_1", 28, "read infos_1"),
    named("read_infos_2", 29, "read infos_2"),
    named("read_clock_max_khz", 30, "read clock_max_khz"),
    named("choose_clock", 31, "choose the clock"),
    named("select_b9_again", 32, "select memory area 0xB9"),
    named("read_recovery", 33, "read recovery"),
    named("set_recovery", 34, "set the recovery time"),
];

/// What sets a bit of a channel in the interrupt's status.
pub const INTERRUPT_EVENTS: [Named; 4] = [
    named("result", 0, "a new result"),
    named(
        "error",
        1,
        "a result whose cause is one of direct.error_causes",
    ),
    named("alarm", 2, "the alarm has come on"),
    named("request", 3, "the frame of a request has ended"),
];

const fn error(name: &'static str, code: u16) -> Named {
    named(name, code as u32, request_state::name(code))
}

/// What became of a request.
pub const REQUEST_ERRORS: [Named; 10] = [
    error("fulfilled", request_state::OK),
    error("no_answer", request_state::SILENT),
    error("address_echo", request_state::ADDRESS_ECHO),
    error("data_echo", request_state::DATA_ECHO),
    error("crc", request_state::CRC),
    error("unknown_command", request_state::UNKNOWN),
    error("frame", request_state::FRAME),
    error("busy_timeout", request_state::BUSY_TIMEOUT),
    error("no_trigger", request_state::NO_TRIGGER),
    error("cancelled", request_state::CANCELLED),
];

const fn command(name: &'static str, command: ModeCommand, meaning: &'static str) -> Named {
    named(name, command.code() as u32, meaning)
}

const SEND_POSITION: Named = command(
    "send_position",
    ModeCommand::SendPosition,
    "000111 send position (EnDat 2.1)",
);
const SEND_POSITION_ADD_INFO: Named = command(
    "send_position_add_info",
    ModeCommand::SendPositionAddInfo,
    "111000 send position with additional information (EnDat 2.2)",
);

/// Mode commands that a trigger sends.
pub const POSITION_COMMANDS: [Named; 2] = [SEND_POSITION, SEND_POSITION_ADD_INFO];

/// Mode commands that a request takes.
pub const MODE_COMMANDS: [Named; 14] = [
    SEND_POSITION,
    command(
        "select_memory",
        ModeCommand::SelectMemory,
        "001110 selection of memory area",
    ),
    command(
        "receive_parameter",
        ModeCommand::ReceiveParameter,
        "011100 receive parameter",
    ),
    command(
        "send_parameter",
        ModeCommand::SendParameter,
        "100011 send parameter",
    ),
    command(
        "receive_reset",
        ModeCommand::ReceiveReset,
        "101010 receive reset",
    ),
    command(
        "send_test_values",
        ModeCommand::SendTestValues,
        "010101 send test values",
    ),
    command(
        "receive_test_command",
        ModeCommand::ReceiveTestCommand,
        "110001 receive test command",
    ),
    SEND_POSITION_ADD_INFO,
    command(
        "position_select_memory",
        ModeCommand::PositionSelectMemory,
        "001001 send position, then selection of memory area or additional information",
    ),
    command(
        "position_receive_parameter",
        ModeCommand::PositionReceiveParameter,
        "011011 send position, then receive parameter",
    ),
    command(
        "position_send_parameter",
        ModeCommand::PositionSendParameter,
        "100100 send position, then send parameter",
    ),
    command(
        "position_error_reset",
        ModeCommand::PositionErrorReset,
        "101101 send position, then receive error reset",
    ),
    command(
        "position_test_command",
        ModeCommand::PositionTestCommand,
        "110110 send position, then receive test command",
    ),
    command(
        "receive_communication",
        ModeCommand::ReceiveCommunication,
        "010010 receive communication command",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::regs::{BLOCKS, SERVICE};
    use crate::service::map::word;
    use crate::service::program::{step_name, steps};

    /// Catches a cause that is inserted in one list and not in the other.
    #[test]
    fn each_cause_has_the_name_of_its_counter() {
        for cause in &CAUSES[..CAUSE_NAMES.len()] {
            let name = match cause.name {
                "none" => "frames_good".to_owned(),
                name => format!("frames_{name}"),
            };
            let counter = SERVICE.register(&name).unwrap_or_else(|| panic!("{name}"));
            let place = u32::from(word::COUNTERS) + cause.number;
            assert_eq!(u32::from(counter.offset), place, "{name}");
        }
    }

    /// Catches a mode command whose text shows another code, and one that is left out.
    #[test]
    fn commands_are_those_of_the_protocol() {
        for (listed, command) in MODE_COMMANDS.iter().zip(ModeCommand::ALL) {
            assert_eq!(listed.number, u32::from(command.code()), "{command:?}");
            let bits = format!("{:06b} ", command.code());
            assert!(listed.meaning.starts_with(&bits), "{}", listed.meaning);
        }
    }

    /// Catches a step that is inserted in one list and not in the other.
    #[test]
    fn steps_are_those_of_the_initialisation() {
        let listed = STEPS[1..].iter().map(|s| s.meaning.to_owned());
        let done: Vec<String> = steps().into_iter().map(step_name).collect();
        assert_eq!(listed.collect::<Vec<_>>(), done);
        assert!((0..).zip(STEPS).all(|(number, step)| step.number == number));
    }

    /// Catches a code that the field cannot hold, two with one name or number, and an identifier that a language refuses.
    #[test]
    fn values_fit_their_fields() {
        let fields = BLOCKS
            .iter()
            .flat_map(|b| b.registers)
            .flat_map(|r| r.fields);
        let mut lists = 0;
        for field in fields {
            let (listed, limit) = match field.values {
                Values::Plain => continue,
                Values::Codes(listed) => (listed, 1 << field.width),
                Values::Bits(listed) => (listed, field.width),
            };
            lists += 1;
            for (index, value) in listed.iter().enumerate() {
                assert!(value.number < limit, "{} {}", field.name, value.name);
                let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
                assert!(value.name.starts_with(|c: char| c.is_ascii_lowercase()));
                assert!(value.name.chars().all(plain), "{}", value.name);
                let twin = |v: &Named| v.name == value.name || v.number == value.number;
                assert!(!listed[..index].iter().any(twin), "{}", value.name);
            }
        }
        assert_eq!(lists, 35);
    }
}
