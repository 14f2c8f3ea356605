//! A T-format receiver: its keys, and what they come to.

use super::canonical::{hash, NO_INITIAL_VALUES};
use super::channel::read_encoder;
use super::check_name;
use super::device::read_initial_values;
use super::document::parse;
use super::protocol::{read_bit_hz, read_request, RECEIVER_BUS, T_FORMAT};
use super::reader::{Source, Table};
use endat_hdl::config::limits;
use endat_hdl::t_format::dsp::TFormatStart;
use endat_hdl::t_format::protocol::FAST_BIT_HZ;
use toml::de::DeTable;

/// A checked configuration of a receiver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Receiver {
    /// Name of the folder, the files and the top module.
    pub name: String,
    /// Encoder, for people; may be empty.
    pub encoder: String,
    /// What it starts with.
    pub start: TFormatStart,
    /// The device gives registers their start values when it is configured.
    pub initial_values: bool,
    /// First 12 hexadecimal digits of the SHA-256 of the resolved configuration.
    pub hash: String,
}

/// Tables of a card that a receiver has nothing for.
const TABLES_OF_CARDS: [&str; 10] = [
    "board", "clock", "endat", "line", "link", "outputs", "safety", "service", "stream", "trigger",
];
/// Longest filter at the fast rate and a clock of 20 MHz, where a bit has four clocks.
const FAST_FILTER_CYCLES_MAX: u64 = 1;

/// The line that makes a text the configuration of a receiver.
pub fn receiver_line(text: &str) -> Option<usize> {
    let (document, _) = DeTable::parse_recoverable(text);
    let host = document.get_ref().get("host")?;
    let bus = host.get_ref().as_table()?.get("bus")?;
    let is_ours = bus.get_ref().as_str() == Some(RECEIVER_BUS);
    is_ours.then(|| Source::new("", text).line(bus.span().start))
}

/// Reads a whole file; complaints go to `source`, and `None` means that there was at least one.
pub fn read(source: &Source<'_>) -> Option<Receiver> {
    let document = parse(source)?;
    let empty = DeTable::new();
    let root = Table::root(source, &document);
    let name = root.required_string("name", "\"my_receiver\"");
    if let Some(name) = &name {
        if let Err(text) = check_name(&name.value) {
            root.complain(name.line, "name", &format!("{:?}", name.value), &text);
        }
    }
    let host = root.table("host", &empty);
    host.string("bus");
    let channels = root.tables("channel").unwrap_or_default();
    if channels.is_empty() && source.is_good() {
        let text = "[[channel]]: is missing; add one table with protocol = \"t_format\"";
        root.complain_plain(text.into());
    }
    if let Some(second) = channels.get(1) {
        let text = "[[channel]]: a receiver has one encoder; write one table, and instantiate the receiver as often as you like";
        second.complain_plain(text.into());
    }
    let channel = channels.first().and_then(read_channel);
    for key in TABLES_OF_CARDS {
        let text = "is a table of cards, and host.bus = \"dsp\" makes this a T-format receiver; remove it, or choose another host.bus";
        root.refuse_table(key, text);
    }
    let device = root.table("device", &empty);
    let initial_values = read_initial_values(&device);
    for table in channels.iter().chain([&host, &device, &root]) {
        table.finish();
    }
    let (encoder, start) = channel?;
    let mut canonical = format!(
        "t_format settings {} request {}",
        start.word(),
        start.request_id
    );
    if !initial_values {
        canonical += &format!("\n{NO_INITIAL_VALUES}");
    }
    Some(Receiver {
        name: name?.value,
        encoder,
        start,
        initial_values,
        hash: hash(&canonical),
    })
}

fn read_channel(table: &Table<'_, '_>) -> Option<(String, TFormatStart)> {
    let usual = TFormatStart::default();
    let protocol = table.required_string("protocol", "\"t_format\"");
    if let Some(protocol) = protocol.filter(|p| p.value != T_FORMAT) {
        let text = "the bus \"dsp\" is that of a T-format receiver; use \"t_format\", or another host.bus for EnDat";
        table.complain(
            protocol.line,
            "protocol",
            &format!("{:?}", protocol.value),
            text,
        );
    }
    let encoder = read_encoder(table);
    let fast = read_bit_hz(table).is_some_and(|bit| bit.value == FAST_BIT_HZ);
    let request = read_request(table, |_| true);
    let number = |key: &'static str, usual: u64| {
        let limits = match (key, fast) {
            ("filter_cycles", true) => {
                limits(key, None).at_most(FAST_FILTER_CYCLES_MAX, "a bit has four clocks of 20 MHz")
            }
            _ => limits(key, None),
        };
        let Some(at) = table.integer(key, &limits) else {
            return usual;
        };
        if !limits.contains(at.value) {
            table.complain(at.line, key, &at.value.to_string(), &limits.to_string());
        }
        at.value
    };
    let start = TFormatStart {
        fast,
        reply_gap_us: number("reply_gap_us", usual.reply_gap_us),
        field_gap_us: number("field_gap_us", usual.field_gap_us),
        filter_cycles: number("filter_cycles", usual.filter_cycles),
        request_id: request.map_or(usual.request_id, |r| r.value.id()),
    };
    Some((encoder?, start))
}
