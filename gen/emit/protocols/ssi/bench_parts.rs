//! The SSI encoders of a test bench: who is on which line, and what the bench does with them.

use crate::protocols::{BenchParts, VhdlParts};
use crate::testbench::text::{real, whole};
use endat_config::template;
use endat_console::error::CommandError;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_hdl::endat::channel::TIMESTAMP_TO_FIRST_FALL_CYCLES;
use endat_hdl::endat::timing::cycles_to_ns;
use endat_hdl::protocols::ssi::asked::Parity;
use endat_hdl::protocols::ssi::cause;
use endat_hdl::protocols::ssi::protocol::bit_delay_most_ns;
use endat_hdl::protocols::ssi::specials::{Special, SHOWN_MAX, SPECIALS_MAX};
use endat_hdl::protocols::SsiSpec;
use endat_regs::Protocol;
use minijinja::context;
use minijinja::value::Serde;
use serde::Serialize;

/// After a frame that went wrong the line is HIGH at the latest after this beyond the recovery time, in ns.
pub const IDLE_NS: u64 = 0;

/// A channel and the encoder on it.
#[derive(Serialize)]
struct Port {
    index: usize,
    position_bits: u32,
    gray: u8,
    twice: u8,
    /// Of the position: bits behind it.
    parity: u8,
    odd: u8,
    /// Special bits before the position, and after it.
    before: usize,
    after: usize,
    /// Of those after it: the place of a parity bit, and of a CRC.
    check_at: usize,
    check_odd: u8,
    crc_at: usize,
    has_parity: bool,
    held: u8,
    bit_delay_ns: String,
    tm_ns: String,
    late_ns: String,
    cable_ns: String,
    half_ns: String,
    first_low_ns: String,
    /// Special bits that may be anything, and those that are 1 if all is well, as the bits of a literal.
    any: String,
    well: String,
    #[serde(skip)]
    mask: String,
}

impl Port {
    fn new(card: &CardConfig, index: usize, channel: &ChannelConfig, asked: &SsiSpec) -> Self {
        let ns = |cycles: u64| cycles_to_ns(cycles, card.system_hz);
        let most_ns =
            bit_delay_most_ns(channel.period_cycles, channel.filter_cycles, card.system_hz);
        // The encoder is as slow as it may be, and the cable, both ways, takes the rest of the period, but for a little: no bit changes in the
        // very moment in which it is taken.
        let left_ns = most_ns as f64 - asked.bit_delay_ns as f64 - 1.4;
        let cable_ns = (left_ns / 2.0).max(0.0);
        let bit_delay_ns = asked.bit_delay_ns as f64 + left_ns.min(0.0);
        let special = Bits::new(asked);
        let literal = |bits: u64| format!("{bits:0width$b}", width = SPECIALS_MAX);
        Self {
            index,
            position_bits: channel.position_bits,
            gray: asked.gray.into(),
            twice: asked.twice.into(),
            parity: asked.has_parity().into(),
            odd: u8::from(asked.parity == Parity::Odd),
            before: asked.before.bits(),
            after: asked.after.bits(),
            check_at: place(asked, Special::is_parity),
            check_odd: asked.after.iter().any(|s| s == Special::ParityOdd).into(),
            crc_at: place(asked, |s| s == Special::Crc6),
            has_parity: asked.has_parity() || asked.after.iter().any(Special::is_parity),
            held: asked.holds_end.into(),
            bit_delay_ns: real(bit_delay_ns.max(0.0)),
            tm_ns: whole(channel.spec.recovery_max_ns),
            late_ns: whole(late_ns(card, channel)),
            cable_ns: real(cable_ns),
            half_ns: whole(ns(channel.period_cycles / 2)),
            first_low_ns: whole(ns(
                channel.period_cycles / 2 + channel.first_low_extra_cycles
            )),
            any: literal(special.any),
            well: literal(special.well),
            mask: format!("{:012X}", (1u64 << channel.position_bits) - 1),
        }
    }
}

/// Number of a bit after the position, from 0; one that there is not if it is not there.
fn place(asked: &SsiSpec, is: fn(Special) -> bool) -> usize {
    let all = asked.after.iter();
    let before: usize = all.take_while(|s| !is(*s)).map(Special::bits).sum();
    match asked.after.iter().any(is) {
        true => before,
        false => SPECIALS_MAX,
    }
}

/// An alarm that special bits can say.
#[derive(Serialize)]
struct Alarm {
    name: &'static str,
    cause: u64,
    /// A bit for each channel that has it.
    bits: String,
}

/// Special bits of all channels, as lists of numbers, that of channel 0 last.
#[derive(Serialize)]
struct AllSpecials {
    crc: String,
    any: String,
    well: String,
    alarms: Vec<Alarm>,
    shown: String,
    tail: String,
}

/// Special bits of a channel, the last one in bit 0.
#[derive(Clone, Default)]
struct Bits {
    any: u64,
    well: u64,
    alarms: [u64; ALARMS.len()],
    shown: u64,
    tail: u32,
    has_crc: bool,
}

const ALARMS: [(&str, u64); 3] = [
    ("ENCODER_ALARM", cause::ALARM),
    ("POWER_FAIL", cause::POWER_FAIL),
    ("NOT_VALID", cause::NOT_VALID),
];

impl Bits {
    fn new(asked: &SsiSpec) -> Self {
        let mut bits = Self::default();
        let mut all: Vec<Special> = asked.specials().collect();
        all.reverse();
        let (mut place, mut shown) = (0, vec![]);
        for special in all {
            let bit = 1 << place;
            place += special.bits() as u32;
            if special.is_shown() {
                shown.push(bit);
            }
            bits.has_crc |= special == Special::Crc6;
            match special.cause() {
                None if special.is_check() => {}
                None => bits.any |= bit,
                Some((cause, level)) => {
                    bits.well |= if level { 0 } else { bit };
                    let rows = ALARMS.iter().zip(&mut bits.alarms);
                    // One bit for each.
                    let row = rows.into_iter().find(|((_, of), _)| *of == cause);
                    row.into_iter().for_each(|(_, mask)| *mask = bit);
                }
            }
        }
        let first: u64 = shown.first().copied().unwrap_or(1);
        bits.tail = first.trailing_zeros();
        bits.shown = shown.iter().sum::<u64>() >> bits.tail & ((1 << SHOWN_MAX) - 1);
        bits
    }
}

impl AllSpecials {
    /// None if no channel has any.
    fn new(card: &CardConfig) -> Option<Self> {
        let of = |c: &ChannelConfig| c.spoken.ssi().map(Bits::new).unwrap_or_default();
        let has = |c: &ChannelConfig| c.spoken.ssi().is_some_and(SsiSpec::has_specials);
        card.channels.iter().any(has).then_some(())?;
        let channels: Vec<Bits> = card.channels.iter().map(of).collect();
        let list = |width: usize, of: &dyn Fn(&Bits) -> u64| {
            let all = channels.iter().rev();
            let numbers: Vec<String> = all.map(|c| format!("{width}'d{}", of(c))).collect();
            numbers.join(", ")
        };
        let alarm = |n: usize| {
            let (name, cause) = ALARMS[n];
            let is_there = channels.iter().any(|c| c.alarms[n] != 0);
            is_there.then(|| Alarm {
                name,
                cause,
                bits: list(SPECIALS_MAX, &|c| c.alarms[n]),
            })
        };
        let crc = channels
            .iter()
            .rev()
            .map(|c| u8::from(c.has_crc).to_string());
        Some(Self {
            crc: crc.collect(),
            any: list(SPECIALS_MAX, &|c| c.any),
            well: list(SPECIALS_MAX, &|c| c.well),
            alarms: (0..ALARMS.len()).filter_map(alarm).collect(),
            shown: list(SHOWN_MAX, &|c| c.shown),
            tail: list(4, &|c| c.tail.into()),
        })
    }
}

/// By how much a recovery time is too long for certain, in ns: the port waits from a period after the last edge on, and for the cable.
fn late_ns(card: &CardConfig, channel: &ChannelConfig) -> u64 {
    let cycles = 3 * channel.period_cycles + channel.recovery_limit_cycles;
    cycles_to_ns(cycles, card.system_hz) - channel.spec.recovery_max_ns
}

/// The SSI channels of a card.
fn speakers(card: &CardConfig) -> impl Iterator<Item = (usize, &ChannelConfig, &SsiSpec)> + Clone {
    let channels = card.channels.iter().enumerate();
    channels.filter_map(|(n, c)| Some((n, c, c.spoken.ssi()?)))
}

/// The shortest frame of a card's SSI channels, in system clock cycles.
fn shortest_cycles(card: &CardConfig) -> u64 {
    let frames =
        speakers(card).map(|(_, c, asked)| c.period_cycles * asked.clocks(c.position_bits));
    frames.min().unwrap_or(0)
}

/// The parts of the VHDL bench for the SSI channels of a card.
pub fn vhdl_parts(name: &str, card: &CardConfig) -> Result<VhdlParts, CommandError> {
    let ports = speakers(card).map(|(n, c, asked)| Port::new(card, n, c, asked));
    let ports: Vec<Port> = ports.collect();
    let channels: Vec<usize> = ports.iter().map(|p| p.index).collect();
    let mut specials = speakers(card).flat_map(|(_, _, asked)| asked.specials());
    let has_alarms = specials.any(|special| special.cause().is_some());
    let facts = context! {
        name,
        channels => Serde(ports),
        numbers => channels,
        count => card.channels.len(),
        direct => card.outputs.position,
        data_not_high => cause::DATA_NOT_HIGH,
        data_not_low_after => cause::DATA_NOT_LOW_AFTER,
        position_parity => cause::PARITY,
        position_crc => cause::CRC,
        copies_differ => cause::COPIES_DIFFER,
        trigger_overrun => cause::TRIGGER_OVERRUN,
        recovery_too_long => cause::RECOVERY_TOO_LONG,
        late_ns => whole(speakers(card).map(|(_, c, _)| late_ns(card, c)).max().unwrap_or(0)),
    };
    let template = include_str!("../../templates/vhdl/bench/ssi.vhd.jinja");
    let longest = speakers(card).map(|(_, c, _)| c.cycle_max_cycles(card.system_hz));
    Ok(VhdlParts {
        word: Protocol::Ssi.row().word,
        longest_cycles: longest.max().unwrap_or(0),
        shortest_cycles: shortest_cycles(card),
        unchecked: has_alarms.then_some("alarms of SSI special bits"),
        texts: VhdlParts::texts(template, &facts)?,
    })
}

/// What the bench of a card with SSI channels has besides.
pub fn parts(name: &str, card: &CardConfig, sleeps: bool) -> Result<BenchParts, CommandError> {
    let speakers = speakers(card);
    let latest_ns = speakers.clone().map(|(_, c, _)| late_ns(card, c)).max();
    let shortest_cycles = shortest_cycles(card);
    let ports: Vec<Port> = speakers
        .map(|(n, c, asked)| Port::new(card, n, c, asked))
        .collect();
    let masks = ports.iter().map(|p| (p.index, p.mask.clone())).collect();
    let numbers = ports.iter().map(|p| p.index).collect();
    let held = ports.iter().any(|p| p.held != 0);
    let context = context! {
        held,
        specials => Serde(AllSpecials::new(card)),
        position_crc => cause::CRC,
        name,
        sleeps,
        channels => Serde(ports),
        count => card.channels.len(),
        data_not_high => cause::DATA_NOT_HIGH,
        data_not_low_after => cause::DATA_NOT_LOW_AFTER,
        position_parity => cause::PARITY,
        copies_differ => cause::COPIES_DIFFER,
        trigger_overrun => cause::TRIGGER_OVERRUN,
        recovery_too_long => cause::RECOVERY_TOO_LONG,
        late_ns => whole(latest_ns.unwrap_or(0)),
        clock_pin_cycles => TIMESTAMP_TO_FIRST_FALL_CYCLES,
        system_ns => real(1e9 / card.system_hz as f64),
    };
    let part = |name: &str, text: &str| template::render(name, text, &context);
    Ok(BenchParts {
        name: Protocol::Ssi.name(),
        word: Protocol::Ssi.row().word,
        channels: numbers,
        encoder: part(
            "ssi_encoder",
            include_str!("../../templates/ssi_encoder.v.jinja"),
        )?,
        ports: part(
            "ssi_ports",
            include_str!("../../templates/ssi_ports.v.jinja"),
        )?,
        steps: part(
            "ssi_steps",
            include_str!("../../templates/ssi_steps.v.jinja"),
        )?,
        silent: vec![],
        masks,
        shortest_cycles,
    })
}
