//! A T-format receiver: its keys, and what they come to.

use super::canonical::{hash, NO_INITIAL_VALUES, UPSET_GUARDS};
use super::channel::read_encoder;
use super::check_name;
use super::device::read_initial_values;
use super::document::parse;
use super::extras;
use super::keys::{tables, BUS, CARD_FORM, CHANNELS, KEYS, NAME, PROTOCOL, RECEIVER_FORM};
use super::reader::{Source, Table};
use super::safety::read_guards;
use super::words::RECEIVER_BUS;
use crate::form::key::Key;
use crate::protocols::t_format::keys::{FIELD_GAP_US, FILTER_CYCLES, REPLY_GAP_US};
use crate::protocols::t_format::reading::{read_bit_hz, read_request};
use endat_hdl::protocols::t_format::dsp::TFormatStart;
use endat_hdl::protocols::t_format::protocol::{BIT_HZ, FAST_BIT_HZ};
use endat_regs::Protocol;
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
    /// What its emission has besides, as words of [`crate::extras`].
    pub with: Vec<String>,
    /// Stored bits are checked.
    pub upset_guards: bool,
    /// First 12 hexadecimal digits of the SHA-256 of the resolved configuration.
    pub hash: String,
}

impl Receiver {
    /// Rate of its encoder, in hertz.
    pub const fn bit_hz(&self) -> u64 {
        if self.start.fast {
            FAST_BIT_HZ
        } else {
            BIT_HZ
        }
    }
}

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
    let document = parse(source, KEYS)?;
    let empty = DeTable::new();
    let root = Table::root(source, &document);
    let name = root.string(&NAME);
    // Not the example of a card.
    root.require_as(&NAME, "\"my_receiver\"");
    if let Some(name) = &name {
        if let Err(text) = check_name(&name.value) {
            root.complain(name.line, NAME.name, &format!("{:?}", name.value), &text);
        }
    }
    let with = extras::read(&root);
    let host = root.table("host", &empty);
    host.string(&BUS);
    let channels = root.tables(CHANNELS).unwrap_or_default();
    if channels.is_empty() && source.is_good() {
        let text = "[[channel]]: is missing; add one table with protocol = \"t_format\"";
        root.complain_plain(text.into());
    }
    if let Some(second) = channels.get(1) {
        let text = "[[channel]]: a receiver has one encoder; write one table, and instantiate the receiver as often as you like";
        second.complain_plain(text.into());
    }
    let channel = channels.first().and_then(read_channel);
    let ours = tables(RECEIVER_FORM);
    for key in tables(CARD_FORM).into_iter().filter(|t| !ours.contains(t)) {
        let text = "is a table of cards, and host.bus = \"dsp\" makes this a T-format receiver; remove it, or choose another host.bus";
        root.refuse_table(key, text);
    }
    let device = root.table("device", &empty);
    let initial_values = read_initial_values(&device);
    let safety = root.table("safety", &empty);
    let upset_guards = read_guards(&safety);
    // A second channel is refused as a whole.
    for table in channels
        .iter()
        .take(1)
        .chain([&host, &safety, &device, &root])
    {
        table.finish();
    }
    let (encoder, start) = channel?;
    let mut canonical = format!(
        "t_format settings {} request {}",
        start.word(),
        start.request_id
    );
    if upset_guards {
        canonical += &format!("\n{UPSET_GUARDS}");
    }
    if !initial_values {
        canonical += &format!("\n{NO_INITIAL_VALUES}");
    }
    Some(Receiver {
        name: name?.value,
        encoder,
        start,
        initial_values,
        with,
        upset_guards,
        hash: hash(&canonical),
    })
}

fn read_channel(table: &Table<'_, '_>) -> Option<(String, TFormatStart)> {
    let usual = TFormatStart::default();
    let protocol = table.string(&PROTOCOL);
    table.require_as(&PROTOCOL, "\"t_format\"");
    if let Some(protocol) = protocol.filter(|p| p.value != Protocol::TFormat.row().word) {
        let text = "the bus \"dsp\" is that of a T-format receiver; use \"t_format\", or choose another host.bus";
        let shown = format!("{:?}", protocol.value);
        table.complain(protocol.line, PROTOCOL.name, &shown, text);
    }
    let encoder = read_encoder(table);
    let fast = read_bit_hz(table).is_some_and(|bit| bit.value == FAST_BIT_HZ);
    let request = read_request(table, |_| true);
    let number = |key: &'static Key| {
        let limits = key.limits(None);
        let limits = match fast && key.name == FILTER_CYCLES.name {
            true => limits.at_most(FAST_FILTER_CYCLES_MAX, "a bit has four clocks of 20 MHz"),
            false => limits,
        };
        let Some(at) = table.integer(key, &limits) else {
            return key.usual_number();
        };
        table.check(key, &at, &limits);
        at.value
    };
    let start = TFormatStart {
        fast,
        reply_gap_us: number(&REPLY_GAP_US),
        field_gap_us: number(&FIELD_GAP_US),
        filter_cycles: number(&FILTER_CYCLES),
        request_id: request.map_or(usual.request_id, |r| r.value.id()),
    };
    Some((encoder?, start))
}
