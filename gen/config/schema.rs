//! The keys of a configuration file, and the way from them to a [`Project`].

use super::reader::{At, Source, Table};
use super::{check_name, Kind, Project};
use crate::board::{self, Assignment, Board};
use endat_hdl::config::*;
use endat_hdl::protocol::ModeCommand;
use endat_hdl::timing::{cycles_at_most, RECOVERY_MAX_NS, RECOVERY_MIN_NS};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use toml::de::DeTable;

/// Keys that `[endat]` gives for all channels and a `[[channel]]` may give for itself.
const LINE_KEYS: [&str; 8] = [
    "clock_hz",
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
/// Longest cable when none is given, in metres.
const CABLE_M: u64 = 100;

/// Where a key of the resolved request was written: path and line.
type Places = BTreeMap<&'static str, (String, usize)>;

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
        let text = format!(
            "not TOML: {}; correct the line",
            error.message().replace('\n', ", ")
        );
        source.complain_line(line, text);
    }
    if !errors.is_empty() {
        return None;
    }
    let empty = DeTable::new();
    let root = Table::root(source, document.get_ref());
    let name = read_name(&root);
    let clock = root.table("clock", &empty);
    let system = clock.required_integer("system_hz", "100_000_000");
    let endat = root.table("endat", &empty);
    let defaults = read_line_keys(&endat);
    let tables = root.tables("channel");
    let channels: Vec<Option<Channel>> = tables
        .iter()
        .map(|t| read_channel(t, &defaults, system.as_ref()))
        .collect();
    let trigger = root.table("trigger", &empty);
    let sample = trigger.required_integer("sample_hz", "10_000");
    let sources = read_sources(&trigger);
    let link = root.table("link", &empty);
    let baud = link.required_integer("baud", "2_000_000");
    let read_hz = link.integer("read_hz");
    let board_table = root.table("board", &empty);
    let board = read_board(&board_table);
    let pins = root.table("pins", &empty);
    for table in tables
        .iter()
        .chain([&clock, &endat, &trigger, &link, &board_table, &root])
    {
        table.finish();
    }
    if let (Some(board), Some(system)) = (&board, &system) {
        if (SYSTEM_HZ_MIN..=SYSTEM_HZ_MAX).contains(&system.value) {
            if let Err(text) = board::pll(board.oscillator_hz, system.value) {
                clock.complain(system.line, "system_hz", &system.value.to_string(), &text);
            }
        }
    }
    if let (Some(board), Some(baud)) = (&board, &baud) {
        if baud.value > board.uart_baud_max {
            let text = format!(
                "more than {} bit/s, the most that {} passes on; lower it",
                board.uart_baud_max, board.name
            );
            link.complain(baud.line, "baud", &baud.value.to_string(), &text);
        }
    }
    let assignments = board
        .as_ref()
        .map(|board| assign_pins(source, &pins, board, tables.len()));
    // Numbers are judged together, and only when every one of them could be read.
    let (system, sample, baud) = (system?, sample?, baud?);
    let channels: Vec<Channel> = channels.into_iter().collect::<Option<_>>()?;
    let request = CardRequest {
        system_hz: system.value,
        channels: channels.iter().map(|c| c.request.clone()).collect(),
        sample_hz: sample.value,
        sources: sources?,
        baud: baud.value,
        read_hz: read_hz.as_ref().map_or(sample.value, |r| r.value),
    };
    let card = match CardConfig::resolve(&request) {
        Ok(card) => card,
        Err(problems) => {
            let lines = [
                (Section::Clock, "system_hz", &system),
                (Section::Trigger, "sample_hz", &sample),
                (Section::Link, "baud", &baud),
                (
                    Section::Link,
                    "read_hz",
                    read_hz.as_ref().unwrap_or(&sample),
                ),
            ];
            for problem in problems {
                report(source, &problem, &channels, &lines);
            }
            return None;
        }
    };
    let (name, board, pins) = (name?, board?, assignments?);
    let pll = board::pll(board.oscillator_hz, system.value).ok()?;
    let hash = Sha256::digest(canonical(&card, &board, &pins))[..6]
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
        encoders,
        board,
        pll,
        pins,
        hash,
    })
}

/// The resolved configuration as text, one number a line: what it means, not how the file spells it.
fn canonical(card: &CardConfig, board: &Board, pins: &[Assignment]) -> String {
    let mut lines = vec![
        format!("system_hz {}", card.system_hz),
        format!("sample_period_cycles {}", card.sample_period_cycles),
        format!(
            "sources {} {} {}",
            card.sources.pin, card.sources.timer, card.sources.register
        ),
        format!("uart_bit_cycles {}", card.uart_bit_cycles),
        format!("part {}", board.part),
        format!("oscillator_hz {}", board.oscillator_hz),
    ];
    for (n, c) in card.channels.iter().enumerate() {
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
        lines.extend(
            numbers
                .iter()
                .map(|(name, value)| format!("channel {n} {name} {value}")),
        );
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

fn read_line_keys(table: &Table<'_, '_>) -> BTreeMap<&'static str, (String, At<u64>)> {
    let read = LINE_KEYS
        .iter()
        .filter_map(|key| Some((*key, (table.name(key), table.integer(key)?))));
    read.collect()
}

fn read_channel(
    table: &Table<'_, '_>,
    defaults: &BTreeMap<&'static str, (String, At<u64>)>,
    system: Option<&At<u64>>,
) -> Option<Channel> {
    let encoder = table.string("encoder").map_or(String::new(), |e| e.value);
    let position = table.required_integer("position_bits", "29");
    let command = table.required_string("command", "\"111000\"");
    let command = command.and_then(|c| read_command(table, c));
    let mut keys = defaults.clone();
    keys.extend(read_line_keys(table));
    let value = |key: &str| keys.get(key).map(|(_, at)| at.value);
    if value("clock_hz").is_none() && !table.has("clock_hz") {
        let text = format!(
            "{}: is missing; add `clock_hz = 3_125_000` here or in [endat]",
            table.name("clock_hz")
        );
        table.complain_plain(text);
    }
    let mut places: Places = keys
        .iter()
        .map(|(key, (path, at))| (*key, (path.clone(), at.line)))
        .collect();
    let (position, command, clock_hz) = (position?, command?, value("clock_hz")?);
    places.insert(
        "position_bits",
        (table.name("position_bits"), position.line),
    );
    places.insert("channel", (table.name("position_bits"), table.line));
    let request = ChannelRequest {
        clock_hz,
        tst_ns: value("tst_ns").unwrap_or(ChannelRequest::usual_tst_ns(clock_hz)),
        command,
        position_bits: position.value,
        filter_ns: value("filter_ns").unwrap_or(0),
        start_window_ns: value("start_window_ns")
            .unwrap_or_else(|| usual_window_ns(clock_hz, system.map_or(0, |s| s.value))),
        tcal_max_ns: value("tcal_max_ns").unwrap_or(TCAL_MAX_NS),
        recovery_min_ns: value("recovery_min_ns").unwrap_or(RECOVERY_MIN_NS),
        recovery_max_ns: value("recovery_max_ns").unwrap_or(RECOVERY_MAX_NS),
        cable_m: value("cable_m").unwrap_or(CABLE_M),
    };
    Some(Channel {
        request,
        encoder,
        places,
    })
}

/// A quarter of a period, as far as the counter of the start window reaches.
fn usual_window_ns(clock_hz: u64, system_hz: u64) -> u64 {
    if clock_hz == 0 || system_hz == 0 {
        return 0;
    }
    let cycle_ns = 1_000_000_000u64.div_ceil(system_hz);
    let mut window_ns = (250_000_000 / clock_hz).max(cycle_ns);
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
    let found = code.and_then(ModeCommand::from_code);
    if found.is_none() {
        let text = match code {
            Some(_) => format!("is not a mode command that this core sends; {known}"),
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

fn read_sources(table: &Table<'_, '_>) -> Option<TriggerSources> {
    let Some(words) = table.strings("sources") else {
        return Some(TriggerSources {
            pin: true,
            timer: true,
            register: true,
        });
    };
    let mut sources = TriggerSources::default();
    let mut good = true;
    for word in words {
        let source = match word.value.as_str() {
            "pin" => &mut sources.pin,
            "timer" => &mut sources.timer,
            "register" => &mut sources.register,
            _ => {
                table.complain(
                    word.line,
                    "sources",
                    &format!("{:?}", word.value),
                    "unknown trigger; use pin, timer, register",
                );
                good = false;
                continue;
            }
        };
        if std::mem::replace(source, true) {
            table.complain(
                word.line,
                "sources",
                &format!("{:?}", word.value),
                "stands twice; remove one",
            );
            good = false;
        }
    }
    good.then_some(sources)
}

fn read_board(table: &Table<'_, '_>) -> Option<Board> {
    let name = table.required_string("name", "\"papilio_pro\"")?;
    match Board::named(&name.value) {
        Ok(board) => Some(board),
        Err(text) => {
            table.complain(name.line, "name", &format!("{:?}", name.value), &text);
            None
        }
    }
}

/// The ports of the board top except the oscillator, in their order.
pub fn card_ports(channels: usize) -> Vec<(String, Kind)> {
    let mut ports = vec![
        ("trigger_i".to_owned(), Kind::Trigger),
        ("uart_rx_i".to_owned(), Kind::UartInput),
        ("uart_tx_o".to_owned(), Kind::UartOutput),
    ];
    for n in 0..channels {
        ports.push((format!("endat_clk{n}_o"), Kind::Transceiver));
        ports.push((format!("endat_data{n}_o"), Kind::Transceiver));
        ports.push((format!("endat_data{n}_oe"), Kind::Transceiver));
        ports.push((format!("endat_data{n}_i"), Kind::EncoderData));
    }
    ports.push(("led_status_o".to_owned(), Kind::Led));
    ports.extend((0..channels).map(|n| (format!("led_channel{n}_o"), Kind::Led)));
    ports
}

/// Name of the oscillator port of the board top.
pub const OSCILLATOR_PORT: &str = "osc_i";

fn assign_pins(
    source: &Source<'_>,
    pins: &Table<'_, '_>,
    board: &Board,
    channels: usize,
) -> Vec<Assignment> {
    let ports = card_ports(channels.min(*CHANNELS.end()));
    let moved = pins.free_strings();
    for (signal, at) in &moved {
        if !ports.iter().any(|(port, _)| port == signal) {
            let names: Vec<&str> = ports.iter().map(|(port, _)| port.as_str()).collect();
            let text = format!("no such signal; signals: {}", names.join(", "));
            pins.complain(at.line, signal, &format!("{:?}", at.value), &text);
        }
    }
    let mut all = vec![Assignment {
        signal: OSCILLATOR_PORT.into(),
        kind: Kind::Oscillator,
        pin: board.oscillator_pin.clone(),
        position: String::new(),
    }];
    for (signal, kind) in ports {
        let user = moved.iter().find(|(s, _)| *s == signal).map(|(_, at)| at);
        let Some(word) = user
            .map(|at| &at.value)
            .or_else(|| board.usual_place(&signal))
        else {
            let text = format!(
                "{}: {} has no usual pin for it; add, for example, `{signal} = \"A0\"` to [pins]",
                pins.name(&signal),
                board.name
            );
            source.complain_line(pins.line, text);
            continue;
        };
        let line = user.map_or(pins.line, |at| at.line);
        let pin = match board.pin(word) {
            Ok(pin) => pin,
            Err(text) => {
                pins.complain(line, &signal, &format!("{word:?}"), &text);
                continue;
            }
        };
        if let Some(other) = all.iter().find(|a: &&Assignment| a.pin == pin) {
            // The one that the file has moved is the one to complain about, whichever comes first.
            let moved_other = moved
                .iter()
                .find(|(s, _)| *s == other.signal)
                .map(|(_, at)| at);
            let (mover, at, place) = match (user, moved_other) {
                (None, Some(at)) => (other.signal.as_str(), at.line, &at.value),
                _ => (signal.as_str(), line, word),
            };
            let taken = if mover == signal {
                &other.signal
            } else {
                &signal
            };
            let text =
                format!("{pin} already carries {taken}; choose a free pin for one of the two");
            pins.complain(at, mover, &format!("{place:?}"), &text);
            continue;
        }
        let position = board.position(&pin);
        all.push(Assignment {
            signal,
            kind,
            pin,
            position,
        });
    }
    all
}

/// Turns a problem of the numbers into a complaint about the line that the number stands on.
fn report(
    source: &Source<'_>,
    problem: &Problem,
    channels: &[Channel],
    lines: &[(Section, &str, &At<u64>)],
) {
    let (path, line) = match problem.section {
        Section::Channel(index) => {
            let place = channels
                .get(index)
                .and_then(|c| c.places.get(problem.key).or(c.places.get("channel")));
            let (path, line) = place.cloned().unwrap_or(("channel".into(), 0));
            let inherited = path.ends_with(problem.key);
            (
                if inherited {
                    path
                } else {
                    format!("channel[{index}].{}", problem.key)
                },
                line,
            )
        }
        section => {
            let line = lines
                .iter()
                .find(|(s, key, _)| *s == section && *key == problem.key)
                .map_or(0, |(_, _, at)| at.line);
            let table = match section {
                Section::Clock => "clock",
                Section::Trigger => "trigger",
                _ => "link",
            };
            (format!("{table}.{}", problem.key), line)
        }
    };
    let path = if channels.is_empty() && problem.key == "channel" {
        "channel".into()
    } else {
        path
    };
    source.complain_line(
        line,
        format!("{path} = {}: {}", problem.value, problem.text),
    );
}
