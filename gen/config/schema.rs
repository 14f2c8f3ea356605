//! The way from a configuration file to a [`Project`].

use super::channel::{check_overridden, read_endat, read_line_keys, read_other, Channel};
use super::device::read_initial_values;
use super::document::parse;
use super::keys;
use super::pins::{assign_pins, read_board, OnBoard};
use super::reader::{At, Source, Table};
use super::{
    base, canonical, check_name, line, outputs, protocol, safety, service, stream, trigger, Project,
};
use crate::board::{card_ports, Assignment, Board, MorePorts};
use crate::extras;
use crate::protocols;
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::*;
use endat_regs::Protocol;
use toml::de::DeTable;

/// The tables of a file; what is not there is empty.
struct Tables<'s, 't> {
    root: Table<'s, 't>,
    host: Table<'s, 't>,
    board: Table<'s, 't>,
    clock: Table<'s, 't>,
    endat: Table<'s, 't>,
    line: Table<'s, 't>,
    trigger: Table<'s, 't>,
    link: Table<'s, 't>,
    service: Table<'s, 't>,
    outputs: Table<'s, 't>,
    safety: Table<'s, 't>,
    device: Table<'s, 't>,
    stream: Table<'s, 't>,
    pins: Table<'s, 't>,
}

impl<'s, 't> Tables<'s, 't> {
    fn new(root: Table<'s, 't>, empty: &'s DeTable<'t>) -> Self {
        let table = |key| root.table(key, empty);
        Self {
            host: table("host"),
            board: table("board"),
            clock: table("clock"),
            endat: table("endat"),
            line: table("line"),
            trigger: table("trigger"),
            link: table("link"),
            service: table("service"),
            outputs: table("outputs"),
            safety: table("safety"),
            device: table("device"),
            stream: table("stream"),
            pins: table("pins"),
            root,
        }
    }

    /// Complains about keys that nobody has asked for.
    fn finish(&self, written: &Written<'s, 't>) {
        for table in written.channel_tables.iter().flatten().chain([
            &self.clock,
            &self.endat,
            &self.trigger,
            &self.host,
            &self.service,
            &self.line,
            &self.stream,
            &self.outputs,
            &self.safety,
            &self.device,
            &self.root,
        ]) {
            table.finish();
        }
        // Otherwise they have been refused as a whole.
        if written.has_board {
            self.board.finish();
        }
        if written.has_uart() {
            self.link.finish();
        }
    }
}

/// What stands in a file, as far as it could be read.
struct Written<'s, 't> {
    bus: Option<HostBus>,
    has_board: bool,
    board: Option<Board>,
    /// True if the option `--board` names the board.
    is_option: bool,
    system: Option<At<u64>>,
    base_address: Option<u32>,
    line: Option<LineParts>,
    channel_tables: Option<Vec<Table<'s, 't>>>,
    channels: Option<Vec<Option<Channel>>>,
    sample: Option<At<u64>>,
    sources: Option<TriggerSources>,
    baud: Option<At<u64>>,
    read_hz: Option<At<u64>>,
    service: Option<ServiceParts>,
    outputs: Option<OutputParts>,
    safety: Option<SafetyParts>,
    initial_values: bool,
    stream: stream::Written,
}

impl<'s, 't> Written<'s, 't> {
    fn read(source: &Source<'_>, t: &Tables<'s, 't>, other: Option<&Board>) -> Self {
        let bus = read_bus(&t.host);
        let has_uart = bus == Some(HostBus::Uart);
        // A card whose bus leaves the device may be a whole device.
        let may_be_device = bus.is_some_and(|bus| !bus.is_internal());
        let has_board = may_be_device && (other.is_some() || t.root.has("board"));
        let board = has_board.then(|| read_board(source, &t.board, other));
        let board = board.flatten();
        if let (Some(other), Some(bus)) = (other, bus.filter(|bus| bus.is_internal())) {
            let text = format!("host.bus = \"{}\": stays inside the chip, so the card has no board top; leave --board {} out", bus.name(), other.name);
            t.host.complain_plain(text);
        }
        let system_limits = keys::SYSTEM_HZ.limits(None);
        let system = t.clock.required_integer(&keys::SYSTEM_HZ, &system_limits);
        let system_hz = system.as_ref().map(|s| s.value);
        let system_hz = system_hz.filter(|hz| system_limits.contains(*hz));
        base::check_sck(&t.host, bus, system_hz);
        let base_address = base::read(&t.host, bus);
        let defaults = read_line_keys(&t.endat, system_hz);
        let channel_tables = t.root.tables(keys::CHANNELS);
        let tables = channel_tables.iter().flatten();
        let may_speak = tables.clone().any(protocol::may_be_endat) || tables.count() == 0;
        let line = line::read(&t.line, system_hz, may_speak);
        let is_aligned = line.is_some_and(|parts| parts.alignment);
        let read_channel = |table| match protocols::other(protocol::read(table)?) {
            Some(other) => read_other(other, table, system_hz),
            None => read_endat(table, &defaults, system_hz, is_aligned),
        };
        let channels = channel_tables.as_ref();
        let channels: Option<Vec<Option<Channel>>> =
            channels.map(|tables| tables.iter().map(read_channel).collect());
        let read = channels.as_deref().unwrap_or_default();
        check_overridden(&t.endat, &defaults, read, system_hz);
        // One that could not be read may be of any protocol.
        let speaks = |c: &Option<Channel>| c.as_ref().is_none_or(|c| c.speaks(Protocol::Endat));
        let has_endat = channels.iter().flatten().any(speaks);
        let sample_limits = keys::SAMPLE_HZ.limits(system_hz);
        let sample = t.trigger.required_integer(&keys::SAMPLE_HZ, &sample_limits);
        let sources = trigger::read_sources(&t.trigger, &keys::TRIGGER_SOURCES);
        let baud_max = board.as_ref().map_or(u64::MAX, |b| b.uart_baud_max);
        let baud_limits = keys::BAUD.limits(system_hz).at_most(baud_max, BAUD_NOTE);
        let baud = || t.link.required_integer(&keys::BAUD, &baud_limits);
        let read_limits = keys::READ_HZ.limits(system_hz);
        let read_hz = || t.link.integer(&keys::READ_HZ, &read_limits);
        let service = service::read(&t.service, has_endat);
        let around = safety::Around {
            bus,
            has_endat,
            double_edge: line.is_some_and(|parts| parts.double_edge),
            // What could not be read may have them.
            has_requests: service.is_none_or(|parts| parts.requests),
        };
        Self {
            baud: has_uart.then(baud).flatten(),
            read_hz: has_uart.then(read_hz).flatten(),
            service,
            outputs: outputs::read(&t.outputs, bus, has_board),
            safety: safety::read(&t.safety, around),
            initial_values: read_initial_values(&t.device),
            stream: stream::read(&t.stream),
            bus,
            has_board,
            board,
            is_option: other.is_some(),
            system,
            base_address,
            line,
            channel_tables,
            channels,
            sample,
            sources,
        }
    }

    fn has_uart(&self) -> bool {
        self.bus == Some(HostBus::Uart)
    }

    /// The system clock, if it may be.
    fn system_hz(&self) -> Option<u64> {
        let system_hz = self.system.as_ref().map(|s| s.value);
        system_hz.filter(|hz| keys::SYSTEM_HZ.limits(None).contains(*hz))
    }

    /// Complains about tables that this card has nothing for.
    fn refuse_useless(&self, t: &Tables<'s, 't>) {
        if let Some(bus) = self.bus {
            let of_uart = [("link", &t.link)].into_iter();
            let of_board = [("board", &t.board), ("pins", &t.pins)].into_iter();
            let of_uart = of_uart.filter(|_| !self.has_uart());
            let of_board = of_board.filter(|_| !self.has_board);
            refuse_unused(&t.root, bus, of_uart.chain(of_board));
        }
        let is_other = |c: &Option<Channel>| c.as_ref().is_some_and(|c| !c.speaks(Protocol::Endat));
        let channels = self.channels.as_ref().filter(|all| !all.is_empty());
        if channels.is_some_and(|all| all.iter().all(is_other)) {
            refuse_endat(&t.root, &t.service, &t.line);
        }
        if self.bus == Some(HostBus::Bare) {
            // Further channels would be the same module again.
            if let Some(second) = self.channel_tables.as_ref().and_then(|t| t.get(1)) {
                let text = "[[channel]]: host.bus = \"none\" makes one encoder port; write one table, and instantiate the port as often as you like";
                second.complain_plain(text.to_owned());
            }
        }
    }

    /// The pins of a card that is a whole device.
    fn pins(&self, source: &Source<'_>, t: &Tables<'s, 't>) -> Option<Vec<Assignment>> {
        if let (Some(board), Some(system), Some(_)) = (&self.board, &self.system, self.system_hz())
        {
            if let Err(text) = board.pll(system.value) {
                let value = system.value.to_string();
                let key = keys::SYSTEM_HZ.name;
                t.clock.complain(system.line, key, &value, &text);
            }
        }
        // The pins of a card with too many channels would only repeat that complaint.
        let count = self.channel_tables.as_ref().map(Vec::len);
        let count = count.filter(|count| CHANNELS.contains(count))?;
        let more = MorePorts {
            interrupt: self.outputs.is_some_and(|parts| parts.interrupt),
            second_interface: self.safety.is_some_and(|parts| parts.second_interface),
        };
        let ports = card_ports(self.bus?, more, count);
        let on = OnBoard {
            board: self.board.as_ref()?,
            table: &t.board,
            is_option: self.is_option,
            system_hz: self.system_hz(),
        };
        Some(assign_pins(source, &t.pins, &on, ports))
    }

    fn draft(&self, t: &Tables<'s, 't>) -> CardDraft {
        let has_uart = self.has_uart();
        let system_hz = self.system_hz();
        let value = |at: &Option<At<u64>>| at.as_ref().map(|at| at.value);
        let read_limits = keys::READ_HZ.limits(system_hz);
        let has_read_hz = t.link.has(keys::READ_HZ.name);
        let usual_read_hz =
            value(&self.sample).filter(|hz| !has_read_hz && read_limits.contains(*hz));
        let request = |c: &Option<Channel>| c.as_ref().map(|c| c.spec.clone());
        CardDraft {
            system_hz: value(&self.system),
            channels: self
                .channels
                .as_ref()
                .map(|all| all.iter().map(request).collect()),
            sample_hz: value(&self.sample),
            sources: self.sources,
            // Without a UART nothing is asked of it: its numbers stand at what every card can do, and nobody looks at them.
            baud: match has_uart {
                true => value(&self.baud),
                false => system_hz.map(|hz| hz / UART_BIT_CYCLES_MIN),
            },
            baud_max: self
                .board
                .as_ref()
                .map(|b| b.uart_baud_max)
                .filter(|_| has_uart),
            read_hz: match has_uart {
                true => value(&self.read_hz).or(usual_read_hz),
                false => Some(1),
            },
            service: self.service.unwrap_or_default(),
            line: self.line.unwrap_or_default(),
            // A service that could not be read may have what the stream takes.
            stream: StreamParts {
                additional_data: self.stream.parts.additional_data && self.service.is_some(),
                ..self.stream.parts
            },
            outputs: self.outputs.unwrap_or_default(),
            safety: self.safety.unwrap_or_default(),
            initial_values: self.initial_values,
            without_uart: !has_uart,
        }
    }

    /// Complains about numbers that do not go together, each at its line.
    fn tell(&self, source: &Source<'_>, problems: &[Problem]) {
        fn line<T>(at: &Option<At<T>>) -> usize {
            at.as_ref().map_or(0, |at| at.line)
        }
        let stream = &self.stream;
        let lines = [
            (Section::Clock, &keys::SYSTEM_HZ, line(&self.system)),
            (Section::Trigger, &keys::SAMPLE_HZ, line(&self.sample)),
            (Section::Link, &keys::BAUD, line(&self.baud)),
            (Section::Link, &keys::READ_HZ, line(&self.read_hz)),
            (Section::Stream, &keys::FIFO_BYTES, line(&stream.fifo_bytes)),
            (
                Section::Stream,
                &keys::ADDITIONAL_DATA,
                line(&stream.additional_data),
            ),
            (Section::Stream, &keys::STREAM_START, line(&stream.start)),
        ]
        .map(|(section, key, line)| (section, key.name, line));
        let heads: Vec<usize> = self
            .channel_tables
            .iter()
            .flatten()
            .map(|t| t.line)
            .collect();
        let channels = self.channels.as_deref().unwrap_or_default();
        for problem in problems {
            report(source, problem, channels, &heads, &lines);
        }
    }
}

/// Reads a whole file; complaints go to `source`, and `None` means that there was at least one.
/// The card comes onto the board `other`, if there is one, instead of its own.
pub fn read(source: &Source<'_>, other: Option<&Board>) -> Option<Project> {
    let document = parse(source, keys::KEYS)?;
    let empty = DeTable::new();
    let root = Table::root(source, &document);
    let name = read_name(&root);
    let with = extras::read(&root);
    let tables = Tables::new(root, &empty);
    let written = Written::read(source, &tables, other);
    written.refuse_useless(&tables);
    tables.finish(&written);
    let assignments = written.pins(source, &tables);
    let card = match written.draft(&tables).resolve() {
        Ok(card) => card,
        Err(problems) => {
            written.tell(source, &problems);
            return None;
        }
    };
    let channels: Vec<Channel> = written.channels?.into_iter().collect::<Option<_>>()?;
    let (name, bus) = (name?, written.bus?);
    let (board, pll, pins) = match written.has_board {
        false => (None, None, vec![]),
        true => {
            let board = written.board?;
            let pll = board.pll(card.system_hz).ok()?;
            (Some(board), Some(pll), assignments?)
        }
    };
    let hash = canonical::hash(&canonical::of_card(&card, bus, board.as_ref(), &pins));
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
        base_address: written.base_address?,
        encoders,
        board,
        pll,
        pins,
        hash,
        with,
    })
}

fn read_name(root: &Table<'_, '_>) -> Option<String> {
    let name = root.required_string(&keys::NAME)?;
    match check_name(&name.value) {
        Ok(()) => Some(name.value),
        Err(text) => {
            root.complain(
                name.line,
                keys::NAME.name,
                &format!("{:?}", name.value),
                &text,
            );
            None
        }
    }
}

/// Complains about what only EnDat channels have, on a card without any.
fn refuse_endat(root: &Table<'_, '_>, service: &Table<'_, '_>, line: &Table<'_, '_>) {
    let text = "takes a channel that speaks EnDat, and this card has none; leave the list empty";
    for (table, key) in [(service, &keys::SERVICE_PARTS), (line, &keys::LINE_PARTS)] {
        if let Some(part) = table.strings(key).unwrap_or_default().first() {
            table.complain(part.line, key.name, &format!("{:?}", part.value), text);
        }
    }
    if root.has(keys::COMMON) {
        root.complain_plain(
            "[endat]: no channel of this card speaks EnDat; remove the table".into(),
        );
    }
}

/// The bus; `None` for what is no bus.
fn read_bus(table: &Table<'_, '_>) -> Option<HostBus> {
    let Some(name) = table.string(&keys::BUS) else {
        return (!table.has(keys::BUS.name)).then(HostBus::default);
    };
    let bus = HostBus::from_name(&name.value);
    if bus.is_none() {
        let known: Vec<&str> = HostBus::ALL.map(HostBus::name).to_vec();
        let text = format!(
            "unknown bus; use {}, dsp (a T-format receiver)",
            known.join(", ")
        );
        table.complain(
            name.line,
            keys::BUS.name,
            &format!("{:?}", name.value),
            &text,
        );
    }
    bus
}

/// Complains about tables that a card with this bus has no use for.
fn refuse_unused<'a, 's: 'a, 't: 'a>(
    root: &Table<'s, 't>,
    bus: HostBus,
    tables: impl Iterator<Item = (&'a str, &'a Table<'s, 't>)>,
) {
    let name = bus.name();
    for (key, table) in tables.filter(|(key, _)| root.has(key)) {
        let text = match key {
            "link" => format!("[link]: host.bus = \"{name}\" has no UART, and [link] is about its rate; remove the table"),
            _ if bus.is_internal() => format!("[{key}]: host.bus = \"{name}\" stays inside the chip, so the card has no board top and no pins of its own; remove the table"),
            _ => format!("[{key}]: says which pins of a board the signals are on, and there is no board; add [board], or remove the table"),
        };
        table.complain_plain(text);
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
