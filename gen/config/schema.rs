//! The keys of a configuration file, and the way from them to a [`Project`].

use super::pins::{assign_pins, card_ports};
use super::protocol::RECEIVER_BUS;
use super::reader::{At, Source, Table};
use super::{base, check_name, line, outputs, protocol, service, stream, trigger, Project};
use crate::board::{self, Assignment, Board};
use crate::error::shorten;
use endat_hdl::bus::HostBus;
use endat_hdl::config::*;
use endat_hdl::protocol::ModeCommand;
use endat_hdl::timing::{cycles_at_most, RECOVERY_MAX_NS, RECOVERY_MIN_NS};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use toml::de::DeTable;

/// Keys that `[endat]` gives for all channels and a `[[channel]]` may give for itself.
const LINE_KEYS: [&str; 9] = [
    "clock_hz",
    "calibration_hz",
    "tst_ns",
    "filter_ns",
    "start_window_ns",
    "tcal_max_ns",
    "recovery_min_ns",
    "recovery_max_ns",
    "cable_m",
];
/// The usual longest calculation time of EnDat 2.2 encoders, in ns.
const TCAL_MAX_NS: u64 = 5_000;
/// Longest name of an encoder, in characters: a column of a report.
const ENCODER_MAX: usize = 40;
/// Longest cable when none is given, in metres.
const CABLE_M: u64 = 100;

/// Where a key of the resolved request was written: path and line.
type Places = BTreeMap<&'static str, (String, usize)>;

/// What the resolved configuration says of a device that has no initial values.
pub const NO_INITIAL_VALUES: &str = "device initial_values false";

/// The key of the table `[device]`.
pub fn read_initial_values(table: &Table<'_, '_>) -> bool {
    table.boolean("initial_values").is_none_or(|at| at.value)
}

/// A channel as read, with the places of its keys.
struct Channel {
    request: ChannelRequest,
    encoder: String,
    places: Places,
}

/// Reads a whole file; complaints go to `source`, and `None` means that there was at least one.
pub fn read(source: &Source<'_>) -> Option<Project> {
    let (document, errors) = DeTable::parse_recoverable(source.text());
    for error in &errors {
        let line = error.span().map_or(0, |span| source.line(span.start));
        source.complain_line(line, not_toml(source, error, line));
    }
    if !errors.is_empty() {
        return None;
    }
    let empty = DeTable::new();
    let root = Table::root(source, document.get_ref());
    let name = read_name(&root);
    let host = root.table("host", &empty);
    let bus = read_bus(&host);
    let board_table = root.table("board", &empty);
    let has_uart = bus == Some(HostBus::Uart);
    // A card with a UART is a whole device; one with another bus that leaves the device may be.
    let may_be_device = bus.is_some_and(|bus| !bus.is_internal());
    let has_board = has_uart || may_be_device && root.has("board");
    let board = match has_board {
        true => read_board(&board_table),
        false => None,
    };
    let clock = root.table("clock", &empty);
    let system_limits = limits("system_hz", None);
    let system = clock.required_integer("system_hz", "100_000_000", &system_limits);
    let system_hz = system.as_ref().map(|s| s.value);
    let system_hz = system_hz.filter(|hz| system_limits.contains(*hz));
    if bus == Some(HostBus::Spi) {
        let sck_limits = limits("sck_hz", system_hz);
        let sck = host.integer("sck_hz", &sck_limits);
        if let Some(sck) = sck.filter(|sck| !sck_limits.contains(sck.value)) {
            let (value, text) = (sck.value.to_string(), sck_limits.to_string());
            host.complain(sck.line, "sck_hz", &value, &text);
        }
    }
    let base_address = base::read(&host, bus);
    let endat = root.table("endat", &empty);
    let defaults = read_line_keys(&endat, system_hz);
    let line_table = root.table("line", &empty);
    let line_parts = line::read(&line_table, system_hz);
    let is_aligned = line_parts.is_some_and(|parts| parts.alignment);
    let tables = root.tables("channel");
    let channels: Option<Vec<Option<Channel>>> = tables.as_ref().map(|tables| {
        let channels = tables.iter();
        channels
            .map(|t| match protocol::is_t_format(t)? {
                true => read_t_format(t, system_hz),
                false => read_channel(t, &defaults, system_hz, is_aligned),
            })
            .collect()
    });
    let trigger = root.table("trigger", &empty);
    let sample_limits = limits("sample_hz", system_hz);
    let sample = trigger.required_integer("sample_hz", "10_000", &sample_limits);
    let sources = trigger::read_sources(&trigger);
    let link = root.table("link", &empty);
    let baud_max = board.as_ref().map(|b| b.uart_baud_max);
    let baud_limits = limits("baud", system_hz).at_most(baud_max.unwrap_or(u64::MAX), BAUD_NOTE);
    let baud = match bus {
        Some(HostBus::Uart) => link.required_integer("baud", "2_000_000", &baud_limits),
        _ => None,
    };
    let read_hz = match bus {
        Some(HostBus::Uart) => link.integer("read_hz", &limits("read_hz", system_hz)),
        _ => None,
    };
    let service = root.table("service", &empty);
    let parts = service::read(&service);
    let outputs_table = root.table("outputs", &empty);
    let outputs = outputs::read(&outputs_table, bus, has_board);
    let device = root.table("device", &empty);
    let initial_values = read_initial_values(&device);
    let stream_table = root.table("stream", &empty);
    let stream = stream::read(&stream_table);
    let pins = root.table("pins", &empty);
    if let Some(bus) = bus.filter(|_| !has_uart) {
        let unused = [("link", &link), ("board", &board_table), ("pins", &pins)];
        // The last two belong to a board.
        let unused = &unused[..if has_board { 1 } else { 3 }];
        refuse_unused(&root, bus, unused);
    }
    let is_t_format =
        |c: &Option<Channel>| c.as_ref().is_some_and(|c| c.request.t_format.is_some());
    if channels
        .as_ref()
        .is_some_and(|channels| !channels.is_empty() && channels.iter().all(is_t_format))
    {
        refuse_endat(&root, &service, &line_table);
    }
    if bus == Some(HostBus::Bare) {
        // Further channels would be the same module again.
        if let Some(second) = tables.as_ref().and_then(|t| t.get(1)) {
            let text = "[[channel]]: host.bus = \"none\" makes one encoder port; write one table, and instantiate the port as often as you like";
            second.complain_plain(text.to_owned());
        }
    }
    for table in tables.iter().flatten().chain([
        &clock,
        &endat,
        &trigger,
        &host,
        &service,
        &line_table,
        &stream_table,
        &outputs_table,
        &device,
        &root,
    ]) {
        table.finish();
    }
    // Otherwise they have been refused as a whole.
    if has_board {
        board_table.finish();
    }
    if has_uart {
        link.finish();
    }
    if let (Some(board), Some(system), true) = (&board, &system, system_hz.is_some()) {
        if let Err(text) = board::pll(board.oscillator_hz, system.value) {
            clock.complain(system.line, "system_hz", &system.value.to_string(), &text);
        }
    }
    // The pins of a card with too many channels would only repeat that complaint.
    let count = tables.as_ref().map(Vec::len);
    let count = count.filter(|count| CHANNELS.contains(count));
    let has_interrupt = outputs.is_some_and(|parts| parts.interrupt);
    let assignments = match (&board, bus, count) {
        (Some(board), Some(bus), Some(count)) => {
            let ports = card_ports(bus, has_interrupt, count);
            Some(assign_pins(source, &pins, board, ports))
        }
        _ => None,
    };
    let usual_read_hz = sample.as_ref().map(|s| s.value);
    let usual_read_hz = usual_read_hz
        .filter(|hz| !link.has("read_hz") && limits("read_hz", system_hz).contains(*hz));
    let requests = channels.as_ref().map(|channels| {
        let requests = channels.iter();
        requests
            .map(|c| c.as_ref().map(|c| c.request.clone()))
            .collect()
    });
    let draft = CardDraft {
        system_hz: system.as_ref().map(|s| s.value),
        channels: requests,
        sample_hz: sample.as_ref().map(|s| s.value),
        sources,
        // Without a UART nothing is asked of it: its numbers stand at what every card can do, and nobody looks at them.
        baud: match has_uart {
            true => baud.as_ref().map(|b| b.value),
            false => system_hz.map(|hz| hz / UART_BIT_CYCLES_MIN),
        },
        baud_max: baud_max.filter(|_| has_uart),
        read_hz: match has_uart {
            true => read_hz.as_ref().map(|r| r.value).or(usual_read_hz),
            false => Some(1),
        },
        service: parts.unwrap_or_default(),
        line: line_parts.unwrap_or_default(),
        stream: stream.parts,
        outputs: outputs.unwrap_or_default(),
        initial_values,
        without_uart: !has_uart,
    };
    let channels = channels.unwrap_or_default();
    let card = match draft.resolve() {
        Ok(card) => card,
        Err(problems) => {
            let line = |at: &Option<At<u64>>| at.as_ref().map_or(0, |at| at.line);
            let lines = [
                (Section::Clock, "system_hz", line(&system)),
                (Section::Trigger, "sample_hz", line(&sample)),
                (Section::Link, "baud", line(&baud)),
                (Section::Link, "read_hz", line(&read_hz)),
                (Section::Stream, "fifo_bytes", line(&stream.fifo_bytes)),
                (
                    Section::Stream,
                    "informations",
                    stream.informations.as_ref().map_or(0, |i| i.line),
                ),
                (
                    Section::Stream,
                    "start",
                    stream.start.as_ref().map_or(0, |s| s.line),
                ),
            ];
            let heads: Vec<usize> = tables.iter().flatten().map(|t| t.line).collect();
            for problem in problems {
                report(source, &problem, &channels, &heads, &lines);
            }
            return None;
        }
    };
    let channels: Vec<Channel> = channels.into_iter().collect::<Option<_>>()?;
    let (name, bus) = (name?, bus?);
    let (board, pll, pins) = match has_board {
        false => (None, None, vec![]),
        true => {
            let board = board?;
            let pll = board::pll(board.oscillator_hz, card.system_hz).ok()?;
            (Some(board), Some(pll), assignments?)
        }
    };
    let hash = Sha256::digest(canonical(&card, bus, board.as_ref(), &pins))[..6]
        .iter()
        .map(|b| format!("{b:02x}"))
        .collect::<String>();
    let card = CardConfig {
        hash: u64::from_str_radix(&hash, 16).ok()?,
        ..card
    };
    let encoders = channels.into_iter().map(|c| c.encoder).collect();
    Some(Project {
        name,
        source: source.file.into(),
        card,
        bus,
        base_address: base_address?,
        encoders,
        board,
        pll,
        pins,
        hash,
    })
}

/// What the parser says about a line, and what to do about the usual mistakes.
pub(crate) fn not_toml(source: &Source<'_>, error: &toml::de::Error, line: usize) -> String {
    let message = error.message().replace('\n', ", ");
    let written = source.text().lines().nth(line.saturating_sub(1));
    let (key, value) = written.and_then(|l| l.split_once('=')).unwrap_or_default();
    let value = value.split('#').next().unwrap_or_default().trim();
    let digits = value.len() > 1 && value.chars().all(|c| c.is_ascii_digit() || c == '_');
    let remedy = match () {
        () if digits && value.starts_with('0') => {
            format!("put it in quotes: {} = \"{value}\"", key.trim())
        }
        () if written.is_some_and(|l| l.trim_start().starts_with("[channel]")) => {
            "there is one for each channel: write [[channel]]".into()
        }
        () if message.contains("duplicate key") => {
            let span = error.span().and_then(|span| source.text().get(span));
            format!("{} stands twice, remove one", span.unwrap_or(key).trim())
        }
        () => "correct the line".into(),
    };
    format!("not TOML: {message}; {}", shorten(&remedy))
}

/// The resolved configuration as text, one number a line: what it means, not how the file spells it.
fn canonical(
    card: &CardConfig,
    bus: HostBus,
    board: Option<&Board>,
    pins: &[Assignment],
) -> String {
    let mut lines = vec![
        format!("system_hz {}", card.system_hz),
        format!("sample_period_cycles {}", card.sample_period_cycles),
        format!(
            "sources {} {} {}",
            card.sources.pin, card.sources.timer, card.sources.register
        ),
    ];
    match bus {
        HostBus::Uart => lines.push(format!("uart_bit_cycles {}", card.uart_bit_cycles)),
        bus => lines.push(format!("bus {}", bus.name())),
    }
    if let Some(board) = board {
        lines.push(format!("part {}", board.part));
        lines.push(format!("oscillator_hz {}", board.oscillator_hz));
    }
    if card.line.alignment {
        lines.push(format!(
            "line margin {} double_edge {}",
            card.line.margin, card.line.double_edge
        ));
        let start = card.line.start(card.system_hz);
        if start != Default::default() {
            lines.push(format!(
                "line start {} {} {} {}",
                start.phase_mode, start.fixed_delay, start.majority, start.drift_limit
            ));
        }
    }
    if card.outputs.any() {
        let outputs = card.outputs;
        lines.push(format!(
            "outputs position {} interrupt {}",
            outputs.position, outputs.interrupt
        ));
    }
    if !card.initial_values {
        lines.push(NO_INITIAL_VALUES.into());
    }
    if card.stream.fifo_bytes != 0 {
        lines.push(format!(
            "stream fifo_bytes {} start {}",
            card.stream.fifo_bytes,
            stream::start_name(card.stream.start)
        ));
        if card.stream.informations {
            lines.push("stream informations true".into());
        }
    }
    if card.service.requests {
        let parts = card.service;
        lines.push(format!("service initialise {}", parts.initialise));
        lines.push(format!("service diagnosis {}", parts.diagnosis));
        lines.push(format!("service continuous {}", parts.continuous));
        if parts.infos != [0; LIST] {
            lines.push(format!("service infos {:?}", parts.infos));
        }
        for (n, c) in card.endat_channels() {
            lines.push(format!(
                "channel {n} wants_short {}",
                c.wants_short_recovery()
            ));
        }
    }
    for (n, c) in card.channels.iter().enumerate() {
        if let Some(t_format) = &c.t_format {
            lines.push(format!(
                "channel {n} t_format bit_cycles {} filter_cycles {} request {} gaps {} {}",
                c.period_cycles,
                c.filter_cycles,
                t_format.request.id(),
                t_format.reply_gap_us,
                t_format.field_gap_us
            ));
            continue;
        }
        let numbers = [
            ("period_cycles", c.period_cycles),
            ("first_low_extra_cycles", c.first_low_extra_cycles),
            ("command", u64::from(c.command.code())),
            ("position_bits", u64::from(c.position_bits)),
            ("filter_cycles", c.filter_cycles),
            ("start_window_cycles", c.start_window_cycles),
            ("start_timeout_us", c.start_timeout_us),
            ("recovery_limit_cycles", c.recovery_limit_cycles),
            ("ready_low_cycles", c.ready_low_cycles),
            ("abort_us", c.abort_us),
        ];
        if c.filter_half {
            lines.push(format!("channel {n} filter_half"));
        }
        if c.has_own_calibration(card.system_hz) {
            let cycles = c.calibration_period_cycles(card.system_hz);
            lines.push(format!("channel {n} calibration_period_cycles {cycles}"));
        }
        lines.extend(
            numbers
                .iter()
                .map(|(name, value)| format!("channel {n} {name} {value}")),
        );
    }
    if card.own_triggers() {
        for (n, c) in card.channels.iter().enumerate() {
            let own = c.request.trigger.unwrap_or_default();
            lines.push(format!(
                "channel {n} trigger enabled {} divider {} ignored {}",
                own.enabled,
                own.divider,
                own.ignored()
            ));
        }
    }
    lines.extend(
        pins.iter()
            .map(|pin| format!("pin {} {}", pin.signal, pin.pin)),
    );
    lines.join("\n")
}

fn read_name(root: &Table<'_, '_>) -> Option<String> {
    let name = root.required_string("name", "\"my_card\"")?;
    match check_name(&name.value) {
        Ok(()) => Some(name.value),
        Err(text) => {
            root.complain(name.line, "name", &format!("{:?}", name.value), &text);
            None
        }
    }
}

/// What was written for the keys of a line; `None` for what could not be read.
type LineKeys = BTreeMap<&'static str, Option<(String, At<u64>)>>;

fn read_line_keys(table: &Table<'_, '_>, system_hz: Option<u64>) -> LineKeys {
    let written = LINE_KEYS.iter().filter_map(|key| {
        let value = table.integer(key, &limits(key, system_hz));
        let place = |at| (table.name(key), at);
        table.has(key).then(|| (*key, value.map(place)))
    });
    written.collect()
}

fn read_channel(
    table: &Table<'_, '_>,
    defaults: &LineKeys,
    system_hz: Option<u64>,
    is_aligned: bool,
) -> Option<Channel> {
    let encoder = read_encoder(table);
    let own = trigger::read_own(table);
    let limits = limits("position_bits", system_hz);
    let position = table.required_integer("position_bits", "29", &limits);
    let command = table.required_string("command", "\"111000\"");
    table.offer(ModeCommand::POSITION.map(|c| format!("{:06b}", c.code())));
    let command = command.and_then(|c| read_command(table, c));
    let mut keys = defaults.clone();
    keys.extend(read_line_keys(table, system_hz));
    if !keys.contains_key("clock_hz") {
        let text = format!(
            "{}: is missing; add `clock_hz = 3_125_000` here or in [endat]",
            table.name("clock_hz")
        );
        table.complain_plain(text);
    }
    let (encoder, position, command) = (encoder?, position?, command?);
    let mut values = BTreeMap::new();
    let mut places = Places::new();
    let (own, divider_line) = own?;
    places.insert("divider", (table.name("divider"), divider_line));
    for (key, written) in keys {
        let (path, at) = written?;
        values.insert(key, at.value);
        places.insert(key, (path, at.line));
    }
    let value = |key: &str| values.get(key).copied();
    let clock_hz = value("clock_hz")?;
    places.insert(
        "position_bits",
        (table.name("position_bits"), position.line),
    );
    places.insert("channel", (table.name("position_bits"), table.line));
    let request = ChannelRequest {
        clock_hz,
        calibration_hz: value("calibration_hz"),
        tst_ns: value("tst_ns").unwrap_or(ChannelRequest::usual_tst_ns(clock_hz)),
        command,
        position_bits: position.value,
        filter_ns: value("filter_ns").unwrap_or(0),
        start_window_ns: value("start_window_ns")
            .unwrap_or_else(|| usual_window_ns(clock_hz, system_hz.unwrap_or(0), is_aligned)),
        tcal_max_ns: value("tcal_max_ns").unwrap_or(TCAL_MAX_NS),
        recovery_min_ns: value("recovery_min_ns").unwrap_or(RECOVERY_MIN_NS),
        recovery_max_ns: value("recovery_max_ns").unwrap_or(RECOVERY_MAX_NS),
        cable_m: value("cable_m").unwrap_or(CABLE_M),
        t_format: None,
        trigger: own,
    };
    Some(Channel {
        request,
        encoder,
        places,
    })
}

/// A channel that speaks T-format; the numbers of EnDat in it mean nothing.
fn read_t_format(table: &Table<'_, '_>, system_hz: Option<u64>) -> Option<Channel> {
    let encoder = read_encoder(table)?;
    let (wanted, filter_ns, lines) = protocol::read(table, system_hz);
    let (own, divider_line) = trigger::read_own(table)?;
    let mut places = Places::new();
    places.insert("divider", (table.name("divider"), divider_line));
    for (key, line) in lines {
        places.insert(key, (table.name(key), line));
    }
    places.insert("channel", (table.name("protocol"), table.line));
    let request = ChannelRequest {
        clock_hz: wanted.bit_hz,
        calibration_hz: None,
        tst_ns: 0,
        command: ModeCommand::SendPosition,
        position_bits: 0,
        filter_ns,
        start_window_ns: 0,
        tcal_max_ns: 0,
        recovery_min_ns: RECOVERY_MIN_NS,
        recovery_max_ns: RECOVERY_MAX_NS,
        cable_m: 0,
        t_format: Some(wanted),
        trigger: own,
    };
    Some(Channel {
        request,
        encoder,
        places,
    })
}

/// Complains about what only EnDat channels have, on a card without any.
fn refuse_endat(root: &Table<'_, '_>, service: &Table<'_, '_>, line: &Table<'_, '_>) {
    let text = "takes a channel that speaks EnDat, and this card has none; leave the list empty";
    for table in [service, line] {
        if let Some(part) = table.strings("parts").unwrap_or_default().first() {
            table.complain(part.line, "parts", &format!("{:?}", part.value), text);
        }
    }
    if root.has("endat") {
        root.complain_plain(
            "[endat]: no channel of this card speaks EnDat; remove the table".into(),
        );
    }
}

/// The encoder's name, which goes into reports and comments; empty when none is given.
pub(crate) fn read_encoder(table: &Table<'_, '_>) -> Option<String> {
    let Some(encoder) = table.string("encoder") else {
        return (!table.has("encoder")).then(String::new);
    };
    let invisible = |c: &char| {
        c.is_control()
            || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
    };
    let count = encoder.value.chars().count();
    let text = if let Some(bad) = encoder.value.chars().find(invisible) {
        format!("has the character {bad:?}, which cannot be seen; remove it")
    } else if count > ENCODER_MAX {
        format!("has {count} characters, at most {ENCODER_MAX} are allowed; shorten it")
    } else {
        return Some(encoder.value);
    };
    table.complain(
        encoder.line,
        "encoder",
        &format!("{:?}", encoder.value),
        &text,
    );
    None
}

/// A quarter of a period, as far as the counter of the start window reaches.
fn usual_window_ns(clock_hz: u64, system_hz: u64, is_aligned: bool) -> u64 {
    if clock_hz == 0 || system_hz == 0 {
        return 0;
    }
    let cycle_ns = 1_000_000_000u64.div_ceil(system_hz);
    let bit_ns = 1_000_000_000 / clock_hz;
    // The mean phase stands jitter of half a bit; a quarter is for one that goes from frame to frame.
    let part = if is_aligned { 2 } else { 4 };
    let mut window_ns = (bit_ns / part).max(cycle_ns);
    let most = (1 << START_WINDOW_BITS) - 1;
    if cycles_at_most(window_ns, system_hz) > most {
        window_ns = most * 1_000_000_000 / system_hz;
    }
    window_ns
}

fn read_command(table: &Table<'_, '_>, command: At<String>) -> Option<ModeCommand> {
    let digits = command.value.replace('_', "");
    let code = u8::from_str_radix(&digits, 2)
        .ok()
        .filter(|_| digits.len() == 6);
    let known = "use 111000 (EnDat 2.2 position) or 000111 (EnDat 2.1 position)";
    let found = code
        .and_then(ModeCommand::from_code)
        .filter(|c| ModeCommand::POSITION.contains(c));
    if found.is_none() {
        let text = match code {
            Some(_) => format!("is not a mode command that a trigger can send; {known}"),
            None => format!("a mode command is six binary digits in quotes; {known}"),
        };
        table.complain(
            command.line,
            "command",
            &format!("{:?}", command.value),
            &text,
        );
    }
    found
}

/// The bus; `None` for what is no bus.
fn read_bus(table: &Table<'_, '_>) -> Option<HostBus> {
    let name = table.string("bus");
    table.offer(HostBus::ALL.iter().map(|b| b.name()).chain([RECEIVER_BUS]));
    let Some(name) = name else {
        return (!table.has("bus")).then(HostBus::default);
    };
    let bus = HostBus::from_name(&name.value);
    if bus.is_none() {
        let known: Vec<&str> = HostBus::ALL.map(HostBus::name).to_vec();
        let text = format!(
            "unknown bus; use {}, or dsp for a T-format receiver",
            known.join(", ")
        );
        table.complain(name.line, "bus", &format!("{:?}", name.value), &text);
    }
    bus
}

/// Complains about tables that a card with this bus has no use for.
fn refuse_unused(root: &Table<'_, '_>, bus: HostBus, tables: &[(&str, &Table<'_, '_>)]) {
    let name = bus.name();
    for (key, table) in tables.iter().filter(|(key, _)| root.has(key)) {
        let text = match *key {
            "link" => format!("[link]: host.bus = \"{name}\" has no UART, and [link] is about its rate; remove the table"),
            _ if bus.is_internal() => format!("[{key}]: host.bus = \"{name}\" stays inside the chip, so the card has no board top and no pins of its own; remove the table"),
            _ => format!("[{key}]: says which pins of a board the signals are on, and there is no board; add [board], or remove the table"),
        };
        table.complain_plain(text);
    }
}

fn read_board(table: &Table<'_, '_>) -> Option<Board> {
    let name = table.required_string("name", "\"papilio_pro\"");
    table.offer(board::names());
    let name = name?;
    match Board::named(&name.value) {
        Ok(board) => Some(board),
        Err(text) => {
            table.complain(name.line, "name", &format!("{:?}", name.value), &text);
            None
        }
    }
}

/// Turns a problem of the numbers into a complaint about the line that the number stands on.
fn report(
    source: &Source<'_>,
    problem: &Problem,
    channels: &[Option<Channel>],
    heads: &[usize],
    lines: &[(Section, &str, usize)],
) {
    let key = problem.key;
    let (path, line) = match problem.section {
        Section::Channel(index) if key == "channel" => {
            ("channel".into(), heads.get(index).copied().unwrap_or(0))
        }
        Section::Channel(index) => {
            let places = channels.get(index).and_then(Option::as_ref);
            let place = places.and_then(|c| c.places.get(key).or(c.places.get("channel")));
            let (path, line) = place.cloned().unwrap_or_default();
            let inherited = path.ends_with(key);
            let own = || format!("channel[{index}].{key}");
            (if inherited { path } else { own() }, line)
        }
        section => {
            let found = lines.iter().find(|(s, k, _)| *s == section && *k == key);
            let table = match section {
                Section::Clock => "clock",
                Section::Trigger => "trigger",
                Section::Stream => "stream",
                _ => "link",
            };
            (
                format!("{table}.{key}"),
                found.map_or(0, |(.., line)| *line),
            )
        }
    };
    source.complain_line(
        line,
        format!("{path} = {}: {}", problem.value, problem.text),
    );
}
