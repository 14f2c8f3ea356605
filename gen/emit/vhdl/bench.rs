//! The test bench in VHDL, with encoders and a host of its own. Times, words, fields and causes come from where the Verilog bench has
//! them.

use crate::buses::front;
use crate::front::BenchHost;
use crate::integration::Core;
use crate::protocols::others_on;
use crate::protocols::VhdlParts;
use crate::testbench::host::{
    access_cycles_max, pushes, stream_bits, SCK_HALF_CYCLES, UART_SETTLE_BITS,
};
use crate::testbench::purpose::{at_rates, configured_list, first_measured, setting, tests};
use crate::testbench::text::{fields, real, word_address, words, MARGIN_NS};
use crate::testbench::{
    causes, every_trigger, identification, measuring_frames, ports, result_events, INPUT_CYCLES,
    LAUNCH_NS, RESET_CYCLES, TRIGGER_CYCLES,
};
use endat_config::template::render;
use endat_config::Project;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::services;
use endat_hdl::card::timebase::cycles_per_us;
use endat_hdl::config::CardConfig;
use endat_hdl::endat::service::program::CLEAR_CYCLES;
use endat_hdl::endat::timing::ABORT_US;
use endat_hdl::endat::transaction::cause;
use endat_hdl::regs::{
    start, BLOCK_STRIDE, CARD, CARD_CONFIG, CHANNEL_CONFIG, DIRECT, INTERRUPT, RESULT, SERVICE,
};
use minijinja::context;
use minijinja::value::{Serde, Value};
use std::collections::BTreeSet;

/// Causes that the bench expects.
const CAUSES: [&str; 7] = [
    "no_start_bit",
    "start_window",
    "crc",
    "f1",
    "f2",
    "data_not_falling",
    "trigger_overrun",
];

/// Types, and the encoder on EnDat channels.
const HEAD: &str = include_str!("../templates/vhdl/bench/head.vhd.jinja");
const ENCODER: &str = include_str!("../templates/vhdl/bench/encoder.vhd.jinja");
/// Signals, host and steps of the bench.
const PARTS: [&str; 3] = [
    include_str!("../templates/vhdl/bench/bench.vhd.jinja"),
    include_str!("../templates/vhdl/bench/main.vhd.jinja"),
    include_str!("../templates/vhdl/bench/steps.vhd.jinja"),
];
/// An encoder of another protocol is at rest this long after the start at the latest, besides what its protocol says.
const IDLE_NS: u64 = 100_000;
/// Procedures of hosts that move one word at a time.
const WORDS: &str = include_str!("../templates/vhdl/bench/host/words.vhd");

/// The settings of a card: three words of each channel, 0 of those without an EnDat encoder.
fn settings(card: &CardConfig, word: impl Fn(&CardConfig, usize, usize) -> u32) -> Vec<String> {
    let words = (0..CHANNEL_CONFIG.registers.len()).map(|w| move |n| (n, w));
    let words: Vec<_> = words.collect();
    let channels = (0..card.channels.len()).flat_map(|n| words.iter().map(move |at| at(n)));
    let value = |(n, w): (usize, usize)| match card.channels[n].is_endat() {
        true => word(card, n, w),
        false => 0,
    };
    channels.map(|at| format!("{:08X}", value(at))).collect()
}

/// The configured clock, and the usual rates that this system clock makes.
fn rates(card: &CardConfig) -> Vec<Value> {
    let row = |hz: u64, card: &CardConfig| {
        let words = settings(card, |card, n, w| {
            setting(card, &CHANNEL_CONFIG.registers[w], n)
        });
        context! { hz, words }
    };
    let own = card.endat_channels().map(|(_, c)| c.spec.clock_hz).next();
    let own = row(own.unwrap_or(0), card);
    let usual = at_rates(card).map(|(hz, card)| row(hz, &card));
    std::iter::once(own).chain(usual).collect()
}

/// A word that is 0.
const ZERO: &str = "00000000";

/// Words that the host writes before the first trigger, besides the settings.
fn writes(card: &CardConfig) -> Vec<Value> {
    let why = |value: Value, address: &str, word: &str, why: &str| {
        let text = |name: &str| value.get_attr(name).ok().map(|v| v.to_string());
        let word = text(word).unwrap_or_else(|| ZERO.into());
        context! { address => text(address), value => word, why }
    };
    let measured = first_measured(card);
    let measured = measured.into_iter().map(|port| {
        why(
            port,
            "alignment",
            "measured",
            "these cables are not the configured one",
        )
    });
    let forced = tests(card).into_iter();
    let forced = forced.map(|port| why(port, "period", "", "no forced errors"));
    let listed = card
        .endat_channels()
        .filter(|_| !configured_list(card).is_empty());
    let listed = listed.map(|(n, _)| {
        let address = word_address(&SERVICE, "list_length", n);
        context! { address, value => ZERO, why => "no additional data" }
    });
    let all = every_trigger(card).into_iter().enumerate();
    let all = all.filter(|(n, _)| !card.channels[*n].is_endat()).map(|(_, write)| {
        let address = write.get_attr("address").ok().and_then(|a| a.as_usize());
        let address = address.map(|a| format!("{a:03X}"));
        context! { address, value => write.get_attr("value").ok(), why => "the channel takes every trigger" }
    });
    measured.chain(forced).chain(listed).chain(all).collect()
}

/// The parts of a card that the bench does not check.
fn unchecked(card: &CardConfig) -> Vec<&'static str> {
    let parts = [
        (card.service.requests, "requests and additional data"),
        (card.service.continuous, "continuous clock"),
        (card.service.diagnosis, "causes of the diagnosis, watchdog"),
        (card.safety.recovery_counter, "recovery counter"),
        (card.safety.error_test_ms != 0, "forced errors"),
        (card.safety.second_interface, "second interface"),
        (card.line.margin, "histograms of the edges"),
        (card.line.alignment, "fixed phase"),
        (card.stream.fifo_bytes != 0, "stream"),
        (card.sources.timer, "period of the timer"),
    ];
    let missing = parts.into_iter().filter(|(has_part, _)| *has_part);
    missing.map(|(_, name)| name).collect()
}

/// Cycles by which a measured line delay may be above the one that is there: the mean of many edges, and half cycles, are rounded otherwise.
fn delay_spare(card: &CardConfig) -> u64 {
    match card.line.alignment || card.line.double_edge {
        true => 12,
        false => 2,
    }
}

/// The ports of the bus, and the signal at each: those that Verilog ties to a literal have a signal of their name.
fn connections(host: &BenchHost) -> Vec<Value> {
    let row = |(port, net): &(&'static str, &'static str)| {
        let net = if net.contains('\'') { *port } else { *net };
        context! { port => *port, net }
    };
    host.connections.iter().map(row).collect()
}

/// The bench of a card; none for a port without a bus. `program` is the second architecture of the services' sequencers, if they need one.
pub fn artifact(
    project: &Project,
    core: &Core<'_>,
    program: &str,
) -> Result<Option<Artifact>, CommandError> {
    let Some(host) = &front(project.bus).bench_host else {
        return Ok(None);
    };
    let card = &project.card;
    let ports = ports(card);
    let count = card.channels.len();
    let settle_cycles = match project.bus {
        HostBus::Uart => UART_SETTLE_BITS as u64 * card.uart_bit_cycles,
        _ => access_cycles_max(card) as u64,
    };
    let others = others_on(card).map(|other| other.vhdl_bench(core.name, card));
    let others: Vec<VhdlParts> = others.collect::<Result<_, _>>()?;
    let idle_ns = others_on(card).map(|other| other.idle_ns() + IDLE_NS);
    let shortest = others.iter().map(|parts| parts.shortest_cycles).min();
    let longest = others.iter().map(|parts| parts.longest_cycles).max();
    let facts = context! {
        others => Serde(&others),
        others_longest_cycles => longest.unwrap_or(0),
        others_within_cycles => shortest.unwrap_or(0) / 4,
        name => core.name,
        origin => core.origin(),
        initial_values => card.initial_values,
        reset_cycles => RESET_CYCLES,
        clear_cycles => CLEAR_CYCLES,
        services => services(card),
        program,
        unchecked => unchecked(card).into_iter().chain(others.iter().filter_map(|p| p.unchecked)).collect::<Vec<_>>(),
        first => ports.first().map_or(0, |port| port.index),
        last => ports.last().map_or(0, |port| port.index),
        channels => Serde(&ports),
        count,
        system_hz => card.system_hz,
        cycles_per_us => cycles_per_us(card.system_hz),
        margin_ns => MARGIN_NS,
        settle_cycles,
        trigger_cycles_max => TRIGGER_CYCLES,
        abort_us => ABORT_US,
        measuring_frames => measuring_frames(card),
        delay_spare => delay_spare(card),
        launch_ns => LAUNCH_NS,
        input_cycles => INPUT_CYCLES,
        rates => rates(card),
        start_words => settings(card, |card, n, w| start(&CHANNEL_CONFIG, &CHANNEL_CONFIG.registers[w], card, n)),
        parallel_crc => cause::flag::PARALLEL_CRC.trailing_zeros(),
        all_channels => format!("{:08X}", (1u32 << count) - 1),
        writes => writes(card),
        timer => card.sources.timer,
        identification => identification(card),
        has_irq => project.bus != HostBus::Uart,
        interrupt => card.outputs.interrupt.then(|| result_events(card)),
        direct => card.outputs.position,
        second => card.safety.second_interface,
        block_stride => BLOCK_STRIDE,
        direct_stride => DIRECT.stride,
        idle_ns => idle_ns.max().unwrap_or(0),
        pushes => pushes(project.bus, card),
        frame_bits => stream_bits(card),
        baud => card.baud,
        sck_half_cycles => real(SCK_HALF_CYCLES),
        access_cycles_max => host.moves_words.then(|| access_cycles_max(card)),
        connections => connections(host),
        causes => causes(&CAUSES),
    };
    let of_host =
        |part: &str, text: &str| render("vhdl_host", text, &context! { part, ..facts.clone() });
    let words_of_host = match host.moves_words {
        true => of_host("procedures", WORDS)?,
        false => String::new(),
    };
    let context = context! {
        host_signals => of_host("signals", host.vhdl)?,
        host_processes => of_host("processes", host.vhdl)?,
        host_procedures => of_host("procedures", host.vhdl)? + &words_of_host,
        host_steps => of_host("steps", host.vhdl)?,
        ..facts
    };
    let text = |map: &str| {
        let context = context! { map, ..context.clone() };
        let encoder = (!ports.is_empty()).then_some(ENCODER);
        let part = |part: &str| render("bench.vhd", part, &context);
        let head = std::iter::once(HEAD).chain(encoder).map(part);
        let encoders = others.iter().filter_map(|parts| parts.texts.get("encoder"));
        let all = head.chain(encoders.cloned().map(Ok));
        all.chain(PARTS.into_iter().map(part))
            .collect::<Result<String, _>>()
    };
    let map = register_map(&text("")?);
    Ok(Some(Artifact::new(
        format!("{}_tb.vhd", core.name),
        text(&map)?,
    )))
}

/// Constants for the words and fields that a text uses.
fn register_map(text: &str) -> String {
    let blocks = [
        &CARD,
        &CARD_CONFIG,
        &CHANNEL_CONFIG,
        &RESULT,
        &INTERRUPT,
        &DIRECT,
    ];
    let used = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let used: BTreeSet<&str> = used.collect();
    let is_used = |name: &str| used.contains(name);
    let words = blocks.into_iter().flat_map(words);
    let words = words.filter(|word| is_used(&word.name));
    let words = words.map(|w| format!("    constant {} : natural := 16#{}#;\n", w.name, w.address));
    let fields = blocks.into_iter().flat_map(fields);
    let fields = fields.filter(|field| is_used(&format!("{}_F", field.name)));
    let fields = fields.map(|f| {
        format!(
            "    constant {}_F : field_t := ({}, {});\n",
            f.name, f.lsb, f.width
        )
    });
    words.chain(fields).collect()
}
