//! The resolved configuration as text: what it means, not how the file spells it. Its hash tells cards apart.
//!
//! Every struct is taken apart field by field, so that the compiler names one that was added and is not in the text.

use super::words::start_name;
use crate::board::{Assignment, Board};
use crate::protocols::other;
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::*;
use sha2::{Digest, Sha256};

/// What the resolved configuration says of a device that has no initial values.
pub const NO_INITIAL_VALUES: &str = "device initial_values false";

/// What it says of stored bits that are checked.
pub const UPSET_GUARDS: &str = "safety upset_guards";

/// Bytes of the hash.
const HASH_BYTES: usize = 6;

/// First digits of the SHA-256 of such a text, hexadecimal.
pub fn hash(text: &str) -> String {
    let digest = Sha256::digest(text);
    digest[..HASH_BYTES]
        .iter()
        .map(|b| format!("{b:02x}"))
        .collect()
}

/// A card, one fact a line.
pub fn of_card(
    card: &CardConfig,
    bus: HostBus,
    board: Option<&Board>,
    pins: &[Assignment],
) -> String {
    let CardConfig {
        system_hz,
        channels,
        sample_period_cycles,
        sources,
        uart_bit_cycles,
        service,
        line,
        stream,
        outputs,
        safety,
        initial_values,
        // What was asked for; what came of it is in the cycles above.
        sample_hz: _,
        baud: _,
        // For reports only.
        read_hz: _,
        hash: _,
    } = card;
    let mut lines = vec![
        format!("system_hz {system_hz}"),
        format!("sample_period_cycles {sample_period_cycles}"),
        format!("sources {}", of_sources(sources)),
    ];
    match bus {
        HostBus::Uart => lines.push(format!("uart_bit_cycles {uart_bit_cycles}")),
        bus => lines.push(format!("bus {}", bus.name())),
    }
    if let Some(board) = board {
        lines.push(format!("part {}", board.part));
        lines.push(format!("oscillator_hz {}", board.oscillator_hz));
        lines.extend(of_device(board));
    }
    lines.extend(of_line(line, *system_hz));
    let OutputParts {
        position,
        interrupt,
    } = outputs;
    if outputs.any() {
        lines.push(format!("outputs position {position} interrupt {interrupt}"));
    }
    let SafetyParts {
        recovery_counter,
        second_interface,
        second_receiver,
        error_test_ms,
        upset_guards,
        restore,
    } = safety;
    if *recovery_counter {
        lines.push("safety recovery_counter".into());
    }
    if *second_interface {
        lines.push("safety second_interface".into());
    }
    if *second_receiver {
        lines.push("safety second_receiver".into());
    }
    if *error_test_ms > 0 {
        lines.push(format!("safety error_test_ms {error_test_ms}"));
    }
    if *upset_guards {
        lines.push(UPSET_GUARDS.into());
    }
    if *restore {
        lines.push("safety restore".into());
    }
    if !initial_values {
        lines.push(NO_INITIAL_VALUES.into());
    }
    lines.extend(of_stream(stream));
    if service.requests {
        lines.extend(of_service(service));
        for (n, c) in card.endat_channels() {
            lines.push(format!(
                "channel {n} wants_short {}",
                c.wants_short_recovery()
            ));
        }
    }
    for (n, c) in channels.iter().enumerate() {
        let facts = of_channel(c, *system_hz).into_iter().chain(of_range(c));
        lines.extend(facts.map(|fact| format!("channel {n} {fact}")));
    }
    if card.own_triggers() {
        for (n, c) in channels.iter().enumerate() {
            let own = c.spec.trigger.unwrap_or_default();
            let OwnTrigger {
                enabled,
                divider,
                sources: _,
            } = own;
            let ignored = own.ignored();
            lines.push(format!(
                "channel {n} trigger enabled {enabled} divider {divider} ignored {ignored}"
            ));
        }
    }
    let of_pin = |pin: &Assignment| format!("pin {} {}", pin.signal, pin.pin);
    lines.extend(pins.iter().map(of_pin));
    lines.join("\n")
}

/// What else is in the files of a board top; all else follows from part, oscillator and pins.
fn of_device(board: &Board) -> Vec<String> {
    let device = board.device.iter();
    let device = device.map(|(key, word)| format!("device {key} {word}"));
    let standards = board.iostandards.iter();
    let standards = standards.map(|(pin, standard)| format!("iostandard {pin} {standard}"));
    let low = board
        .low_active
        .iter()
        .map(|pin| format!("low_active {pin}"));
    device.chain(standards).chain(low).collect()
}

fn of_sources(sources: &TriggerSources) -> String {
    let TriggerSources {
        pin,
        timer,
        register,
    } = sources;
    format!("{pin} {timer} {register}")
}

fn of_line(line: &LineParts, system_hz: u64) -> Vec<String> {
    let LineParts {
        alignment,
        margin,
        double_edge,
        // What they come to is in the start values.
        phase: _,
        fixed_delay_ns: _,
        drift_limit_ns: _,
        samples: _,
    } = line;
    if !alignment {
        return vec![];
    }
    let mut lines = vec![format!("line margin {margin} double_edge {double_edge}")];
    let start = line.start(system_hz);
    if start != Default::default() {
        lines.push(format!(
            "line start {} {} {} {}",
            start.phase_mode, start.fixed_delay, start.majority, start.drift_limit
        ));
    }
    lines
}

fn of_stream(stream: &StreamParts) -> Vec<String> {
    let StreamParts {
        fifo_bytes,
        start,
        additional_data,
    } = stream;
    if *fifo_bytes == 0 {
        return vec![];
    }
    let mut lines = vec![format!(
        "stream fifo_bytes {fifo_bytes} start {}",
        start_name(*start)
    )];
    if *additional_data {
        lines.push("stream additional_data true".into());
    }
    lines
}

fn of_service(service: &ServiceParts) -> Vec<String> {
    let ServiceParts {
        requests: _,
        diagnosis,
        continuous,
        initialise,
        infos,
    } = service;
    let mut lines = vec![
        format!("service initialise {initialise}"),
        format!("service diagnosis {diagnosis}"),
        format!("service continuous {continuous}"),
    ];
    if *infos != [0; LIST] {
        lines.push(format!("service infos {infos:?}"));
    }
    lines
}

/// The range of the position, if the file gives one.
fn of_range(channel: &ChannelConfig) -> Option<String> {
    match channel.turn_bits() {
        Some([single, multi]) => Some(format!("turns {single} {multi}")),
        None => channel.spec.range.map(|_| "linear".to_owned()),
    }
}

fn of_channel(channel: &ChannelConfig, system_hz: u64) -> Vec<String> {
    let ChannelConfig {
        period_cycles,
        first_low_extra_cycles,
        command,
        position_bits,
        filter_cycles,
        filter_half,
        start_window_cycles,
        start_timeout_us,
        recovery_limit_cycles,
        ready_low_cycles,
        abort_us,
        spoken,
        // What it comes to is in the cycles above, and in what is asked of the channel below.
        spec: _,
    } = channel;
    if let Some(other) = other(spoken.protocol()) {
        return vec![other.canonical(channel)];
    }
    let mut lines = Vec::new();
    if *filter_half {
        lines.push("filter_half".to_owned());
    }
    if channel.has_own_calibration(system_hz) {
        let cycles = channel.calibration_period_cycles(system_hz);
        lines.push(format!("calibration_period_cycles {cycles}"));
    }
    let numbers = [
        ("period_cycles", *period_cycles),
        ("first_low_extra_cycles", *first_low_extra_cycles),
        ("command", command.code().into()),
        ("position_bits", (*position_bits).into()),
        ("filter_cycles", *filter_cycles),
        ("start_window_cycles", *start_window_cycles),
        ("start_timeout_us", *start_timeout_us),
        ("recovery_limit_cycles", *recovery_limit_cycles),
        ("ready_low_cycles", *ready_low_cycles),
        ("abort_us", *abort_us),
    ];
    lines.extend(numbers.map(|(name, value)| format!("{name} {value}")));
    lines
}
