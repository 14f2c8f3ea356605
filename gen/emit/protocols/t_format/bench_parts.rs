//! The T-format encoders of a test bench: who is on which line, and what the bench does with them.

use crate::protocols::{BenchParts, VhdlParts};
use crate::testbench::text::{fields, real, whole, words, Bits, MARGIN_NS};
use endat_config::template;
use endat_console::error::CommandError;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_hdl::endat::channel::TIMESTAMP_TO_FIRST_FALL_CYCLES;
use endat_hdl::endat::timing::{cycles_at_least, cycles_to_ns};
use endat_hdl::protocols::t_format::cause;
use endat_hdl::protocols::t_format::protocol::{
    control, Content, Request, BIT_HZ, FAST_BIT_HZ, FIELD_BITS, RATE_TOLERANCE_PPM, REST_US,
    WAIT_GRACE_US,
};
use endat_hdl::protocols::{Spoken, TFormatSpec};
use endat_hdl::regs::{Block, Protocol, T_FORMAT};
use minijinja::context;
use minijinja::value::{Serde, Value};
use serde::Serialize;
use std::collections::BTreeMap;

/// What an edge may be off beside the rate, in bits: clock cycles of the receiver.
const EDGE_BITS: f64 = 0.025;
/// Longest cable each way, in ns: 100 m.
const CABLE_NS: f64 = 500.0;
/// The encoders' own clocks are wrong by this.
pub const RATE_ERROR: f64 = 0.01;

/// A cable each way of this share of the longest one, and what it leaves an encoder of the longest pause before the reply: both ways
/// belong to that.
pub fn cable_and_gap_ns(share: f64, reply_gap_us: u64) -> (f64, f64) {
    let gap_ns = 1_000.0 * reply_gap_us as f64;
    let cable_ns = (CABLE_NS * share).min(gap_ns / 4.0).floor() - 0.7;
    (cable_ns, gap_ns - 2.0 * cable_ns)
}

/// A channel and the encoder on it.
#[derive(Serialize)]
struct Port {
    index: usize,
    fast: u8,
    request: u8,
    own_rate: String,
    reply_gap_ns: String,
    field_gap_ns: String,
    cable_ns: String,
    /// From the first clock edge of an EnDat channel to the start bit, of the same trigger.
    start_cycles: u64,
    #[serde(skip)]
    mask: String,
    has_single: u8,
    has_multi: u8,
    has_identity: u8,
    has_alarm: u8,
    /// For the VHDL bench: nominal length of a bit, and a letter for each field of the reply.
    bit_ns: String,
    reply: String,
}

impl Port {
    fn new(card: &CardConfig, index: usize, channel: &ChannelConfig, wanted: &TFormatSpec) -> Self {
        let has = |content: Content| wanted.request.reply().contains(&content);
        let (has_single, has_multi) = (has(Content::SingleTurn), has(Content::MultiTurn));
        // Every channel has another cable.
        let share = (index + 1) as f64 / card.channels.len() as f64;
        let (cable_ns, reply_gap_ns) = cable_and_gap_ns(share, wanted.reply_gap_us);
        let part = |has: bool| if has { 0xFF_FFFFu64 } else { 0 };
        Self {
            index,
            fast: u8::from(wanted.bit_hz == FAST_BIT_HZ),
            request: wanted.request.id(),
            own_rate: real(
                1.0 + if index.is_multiple_of(2) {
                    RATE_ERROR
                } else {
                    -RATE_ERROR
                },
            ),
            reply_gap_ns: real(reply_gap_ns),
            field_gap_ns: whole(1_000 * wanted.field_gap_us),
            cable_ns: real(cable_ns),
            start_cycles: channel.period_cycles / 2 - 1,
            mask: format!("{:06X}{:06X}", part(has_multi), part(has_single)),
            has_single: has_single.into(),
            has_multi: has_multi.into(),
            has_identity: has(Content::EncoderId).into(),
            has_alarm: has(Content::Alarm).into(),
            bit_ns: real(1e9 / wanted.bit_hz as f64),
            reply: letters(&wanted.request),
        }
    }
}

/// A letter for each field of a reply, spaces after the last one.
fn letters(request: &Request) -> String {
    let letter = |content: &Content| match content {
        Content::Control => 'C',
        Content::Status => 'S',
        Content::SingleTurn => 'A',
        Content::MultiTurn => 'M',
        Content::EncoderId => 'I',
        Content::Alarm => 'L',
        Content::Address | Content::Data => ' ',
        Content::Crc => 'X',
    };
    let letters: String = request.reply().iter().map(letter).collect();
    format!("{letters:width$}", width = fields_max())
}

/// Fields of the longest reply.
fn fields_max() -> usize {
    let fields = Request::ALL.iter().map(|request| request.reply().len());
    fields.max().unwrap_or(0)
}

/// Tolerance of an edge of a request, in bits.
fn tolerance() -> f64 {
    FIELD_BITS as f64 * RATE_TOLERANCE_PPM as f64 / 1e6 + EDGE_BITS
}

/// From a reply to the next request, in ns: the receiver's rest begins within the last delimiter.
const REST_NS: u64 = 500 * (REST_US - 1);

/// The T-format channels of a card.
fn speakers(card: &CardConfig) -> impl Iterator<Item = (usize, &ChannelConfig, &TFormatSpec)> {
    let channels = card.channels.iter().enumerate();
    channels.filter_map(|(n, c)| Some((n, c, c.spoken.t_format()?)))
}

/// The encoders on these channels.
fn ports(card: &CardConfig) -> Vec<Port> {
    let ports = speakers(card).map(|(n, c, wanted)| Port::new(card, n, c, wanted));
    ports.collect()
}

/// The shortest exchange of a card's T-format channels, in system clock cycles.
fn shortest_cycles(card: &CardConfig) -> u64 {
    let exchanges =
        speakers(card).map(|(_, c, wanted)| c.period_cycles * wanted.request.wire_bits());
    exchanges.min().unwrap_or(0)
}

/// The parts of the VHDL bench for the T-format channels of a card.
pub fn vhdl_parts(name: &str, card: &CardConfig) -> Result<VhdlParts, CommandError> {
    let longest = speakers(card).map(|(_, c, _)| c.cycle_max_cycles(card.system_hz));
    let ports = ports(card);
    let channels: Vec<usize> = ports.iter().map(|p| p.index).collect();
    let causes = CAUSES.into_iter().collect::<BTreeMap<_, _>>();
    let facts = context! {
        name,
        channels => Serde(ports),
        numbers => channels,
        count => card.channels.len(),
        direct => card.outputs.position,
        fields_max => fields_max(),
        tolerance => real(tolerance()),
        rest_ns => REST_NS,
        sync => format!("{:03b}", control(0) & 7),
        causes => Serde(causes),
        trigger_overrun => cause::TRIGGER_OVERRUN,
    };
    let template = include_str!("../../templates/vhdl/bench/t_format.vhd.jinja");
    Ok(VhdlParts {
        word: Protocol::TFormat.row().word,
        longest_cycles: longest.max().unwrap_or(0) + cycles_at_least(IDLE_NS, card.system_hz),
        shortest_cycles: shortest_cycles(card),
        unchecked: Some("requests of the host on T-format channels"),
        texts: VhdlParts::texts(template, &facts)?,
    })
}

/// A request as the encoder knows it: fields that it hears, and what it puts into the reply.
#[derive(Serialize)]
struct Exchange {
    id: u8,
    sent: usize,
    reply: Vec<String>,
}

impl Exchange {
    fn new(request: &Request) -> Self {
        let (mut single, mut multi) = (0, 0);
        let byte = |name: &str, count: &mut u32, first: u32| {
            let lsb = first + 8 * *count;
            *count += 1;
            format!("{name}[{}:{lsb}]", lsb + 7)
        };
        let field = |content: &Content| match content {
            Content::Control => "control".into(),
            Content::Status => "state".into(),
            Content::SingleTurn => byte("position", &mut single, 0),
            Content::MultiTurn => byte("position", &mut multi, 24),
            Content::EncoderId => "encoder_id".into(),
            Content::Alarm => "alarm".into(),
            Content::Address => "address".into(),
            Content::Data => "content".into(),
            Content::Crc => "sum".into(),
        };
        Self {
            id: request.id(),
            sent: request.sent().len(),
            reply: request.reply().iter().map(field).collect(),
        }
    }
}

/// T-format causes by the names that the bench has for them.
const CAUSES: [(&str, u64); 13] = [
    ("LINE_NOT_IDLE", cause::LINE_NOT_IDLE),
    ("NO_ANSWER", cause::NO_ANSWER),
    ("HEADER", cause::HEADER),
    ("CONTROL_PARITY", cause::CONTROL_PARITY),
    ("ECHO", cause::ECHO),
    ("DELIMITER", cause::DELIMITER),
    ("FIELD_TIMEOUT", cause::FIELD_TIMEOUT),
    ("CRC", cause::CRC),
    ("REQUEST_PARITY", cause::REQUEST_PARITY),
    ("REQUEST_DELIMITER", cause::REQUEST_DELIMITER),
    ("EEPROM_BUSY", cause::EEPROM_BUSY),
    ("COUNTING_ERROR", cause::COUNTING_ERROR),
    ("MULTI_TURN_ALARM", cause::MULTI_TURN_ALARM),
];

/// The causes, for a template.
pub fn causes() -> Vec<Value> {
    let causes = CAUSES.into_iter();
    causes.map(|(name, code)| context! { name, code }).collect()
}

/// The module of the encoder, for the bench of `name`.
pub fn encoder(name: &str) -> Result<String, CommandError> {
    let bit_ns = |hz: u64| 1e9 / hz as f64;
    template::render(
        "t_format_encoder",
        include_str!("../../templates/t_format_encoder.v.jinja"),
        &context! {
            name,
            bit_ns => real(bit_ns(BIT_HZ)),
            fast_bit_ns => real(bit_ns(FAST_BIT_HZ)),
            tolerance => real(tolerance()),
            rest_ns => whole(REST_NS),
            // By the clock of the receiver, which may be slower.
            late_ns => real(1_000.0 * WAIT_GRACE_US as f64 + bit_ns(BIT_HZ) / 4.0),
            sync => control(0) & 7,
            write_id => Request::WriteEeprom.id(),
            causes => causes(),
            requests => Serde(Request::ALL.iter().map(Exchange::new).collect::<Vec<_>>()),
        },
    )
}

/// After a reply that came late or not whole, the line is idle at the latest after this, in ns.
pub const IDLE_NS: u64 = 25_000;

/// What the bench of a card with T-format channels has besides.
pub fn parts(name: &str, card: &CardConfig, sleeps: bool) -> Result<BenchParts, CommandError> {
    let ports = ports(card);
    let silent = ports.iter().filter(|p| p.has_single + p.has_multi == 0);
    let silent = silent.map(|p| p.index).collect();
    let masks = ports.iter().map(|p| (p.index, p.mask.clone())).collect();
    let numbers = ports.iter().map(|p| p.index).collect();
    let context = context! {
        name,
        sleeps,
        channels => Serde(ports),
        count => card.channels.len(),
        direct => card.outputs.position,
        words => Serde(words(&T_FORMAT).collect::<Vec<_>>()),
        fields => Serde(fields_of(&T_FORMAT)),
        causes => causes(),
        unknown_request => cause::UNKNOWN_REQUEST,
        trigger_overrun => cause::TRIGGER_OVERRUN,
        host_ns => whole(host_ns(card)),
        clock_pin_cycles => TIMESTAMP_TO_FIRST_FALL_CYCLES,
        ids => Request::ALL.iter().map(|r| r.id()).collect::<Vec<_>>(),
        unknown => (0..16).find(|id| Request::from_id(*id).is_none()),
        read_id => Request::ReadEeprom.id(),
        write_id => Request::WriteEeprom.id(),
    };
    let part = |name: &str, text: &str| template::render(name, text, &context);
    Ok(BenchParts {
        name: Protocol::TFormat.name(),
        word: Protocol::TFormat.row().word,
        channels: numbers,
        encoder: encoder(name)?,
        ports: part(
            "t_format_ports",
            include_str!("../../templates/t_format_ports.v.jinja"),
        )?,
        steps: part(
            "t_format_steps",
            include_str!("../../templates/t_format_steps.v.jinja"),
        )?,
        silent,
        masks,
        shortest_cycles: shortest_cycles(card),
    })
}

/// Names that other blocks have, too, get that of the block.
fn fields_of(block: &Block) -> Vec<Bits> {
    let named = |mut bits: Bits| {
        bits.name = format!("T_FORMAT_{}", bits.name);
        bits
    };
    fields(block).map(named).collect()
}

/// The longest exchange of any request at any channel, in ns.
fn host_ns(card: &CardConfig) -> u64 {
    let longest = |channel: &ChannelConfig| {
        let wanted = *channel.spoken.t_format()?;
        let of = |request: Request| {
            let mut channel = channel.clone();
            channel.spoken = Spoken::TFormat(TFormatSpec { request, ..wanted });
            channel.cycle_max_cycles(card.system_hz)
        };
        Request::ALL.into_iter().map(of).max()
    };
    let cycles = card.channels.iter().filter_map(longest).max();
    cycles_to_ns(cycles.unwrap_or(0), card.system_hz) + MARGIN_NS
}
