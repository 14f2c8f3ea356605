//! The Verilog test bench that is emitted with a card: everything in it follows from the configuration and the register table.
//! Every channel has an encoder of its protocol there: models of their own, which share no code with the core.
//! Of an initialisation it looks at the beginning only: the whole of it is longer than anybody simulates in Verilog.

pub(crate) mod host;
pub(crate) mod purpose;
pub(crate) mod text;

use crate::protocols::others_on;
use crate::protocols::BenchParts;
use endat_config::template;
use endat_config::Project;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::timebase::cycles_per_us;
use endat_hdl::card::{service_times, services};
use endat_hdl::config::{CardConfig, ChannelConfig, PhaseSource};
use endat_hdl::endat::channel::CALIBRATION_FRAMES;
use endat_hdl::endat::service::program::{program, ServiceTimes, CLEAR_CYCLES};
use endat_hdl::endat::timing::{cycles_at_least, cycles_at_most, cycles_to_ns};
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::{INFO_BITS, SUPPLEMENT_PULSES};
use endat_hdl::regs::{
    start, BLOCK_STRIDE, CARD, CARD_CONFIG, CHANNEL_CONFIG, DIRECT, INTERRUPT, LINE, RESULT,
    SERVICE,
};
use minijinja::context;
use minijinja::value::{Serde, Value};
use serde::Serialize;
use text::{clock_ns, fields, real, whole, word_address, words, MARGIN_NS};

/// After a clock that stopped, the bench's encoder waits this long before it takes the frame for ended, in ns.
const ENCODER_GIVES_UP_NS: u64 = 15_000;
/// Delay that the bench's encoder adds between a clock edge and its data, in ns.
pub const LAUNCH_NS: u64 = 12;
/// Clock edges from the trigger at its pin to the first falling edge of an EnDat clock: synchroniser, edge detection, strobe, transaction, clock generator, pin.
pub const TRIGGER_CYCLES: u64 = 6;
/// System clock cycles between the end of the timer's period and the first falling clock edge.
const TIMER_CYCLES: u64 = 5;
/// The card is ready, and has reported everything, this long after the end of a frame at the encoder, in ns; the cable comes on top.
const RESULT_NS: u64 = 4_000;
/// Cycles that synchroniser and edge detection add to the measured line delay (the filter's come on top).
pub const INPUT_CYCLES: u64 = 3;

/// A channel and the encoder on it.
#[derive(Serialize)]
pub struct Port {
    /// Its number on the card.
    pub index: usize,
    command: String,
    has_f2: u8,
    position_bits: u32,
    tcal_ns: String,
    tm_ns: String,
    cable_ns: String,
    filter_cycles: u64,
    slow_period_cycles: u64,
    recovery_cycles: u64,
    delay_cycles: u64,
    run_late: u64,
}

impl Port {
    /// The channel of a card, as the bench sees it.
    pub fn new(card: &CardConfig, index: usize, channel: &ChannelConfig) -> Self {
        let request = &channel.spec;
        let (low, high) = (request.recovery_min_ns, request.recovery_max_ns);
        let tm_ns = low + (high - low) / 4;
        // Every channel has another cable, the last one the longest that is allowed for.
        let share = (index + 1) as f64 / card.channels.len() as f64;
        let cable_ns = ((request.delay_max_ns() - LAUNCH_NS) as f64 * share / 2.0).floor() - 0.7;
        // Rounded once: a cycle is no whole number of ns at some clocks.
        let round_trip_s = (2.0 * cable_ns + LAUNCH_NS as f64) * 1e-9;
        let round_trip_cycles = (round_trip_s * card.system_hz as f64) as u64;
        let delay_cycles = round_trip_cycles + INPUT_CYCLES + channel.filter_cycles;
        Self {
            index,
            command: format!("{:06b}", channel.command.code()),
            has_f2: u8::from(channel.command.has_f2()),
            position_bits: channel.position_bits,
            tcal_ns: whole(request.tcal_max_ns),
            tm_ns: whole(tm_ns),
            cable_ns: real(cable_ns),
            filter_cycles: channel.filter_cycles,
            slow_period_cycles: channel.calibration_period_cycles(card.system_hz),
            recovery_cycles: cycles_at_most(tm_ns, card.system_hz),
            delay_cycles,
            // And what the receiver needs itself.
            run_late: delay_cycles / channel.period_cycles + 2,
        }
    }
}

/// The longest of a time over all EnDat channels, in cycles, as ns.
fn longest_ns(card: &CardConfig, cycles: impl Fn(&ChannelConfig) -> u64) -> u64 {
    let most = card.endat_channels().map(|(_, c)| cycles(c)).max();
    cycles_to_ns(most.unwrap_or(0), card.system_hz)
}

/// The program of a service as Verilog literals.
fn program_words(times: &ServiceTimes) -> Vec<String> {
    let words = program(times).into_iter();
    words.map(|w| format!("20'h{w:05x}")).collect()
}

/// The program that the services of a card run in the bench, if it is not their own: of an initialisation there is the beginning only.
fn program_text(card: &CardConfig) -> Result<String, CommandError> {
    let times = service_times(card);
    if !times.initialise {
        return Ok(String::new());
    }
    let without = ServiceTimes {
        initialise: false,
        ..times
    };
    let program = program_words(&without);
    template::render(
        "bench_program",
        include_str!("templates/bench_program.v.jinja"),
        &context! { program, services => services(card), initial_values => card.initial_values },
    )
}

/// How a bench tells what it checks (more values may stand before that), and that it has failed.
pub fn tell(name: &str, before: &str, values: &str) -> Result<String, CommandError> {
    template::render(
        "bench_tell",
        include_str!("templates/bench_tell.v.jinja"),
        &context! { name, before, values },
    )
}

/// What the bench of a card that initialises its encoders does first.
fn power_up(card: &CardConfig, ports: &[Port], has_others: bool) -> Result<String, CommandError> {
    if !card.service.initialise {
        return Ok(String::new());
    }
    let times = ServiceTimes::at(card.system_hz);
    let period = card
        .endat_channels()
        .map(|(_, c)| c.calibration_period_cycles(card.system_hz));
    template::render(
        "power_up",
        include_str!("templates/power_up.v.jinja"),
        &context! {
            channels => Serde(ports),
            has_others,
            // A delay that is known from the start is not measured at a slow clock.
            is_measured => card.line.phase != PhaseSource::Fixed,
            services => services(card),
            power_up_ms => times.power_up_ms,
            after_pulse_ms => times.after_pulse_ms,
            period_ns => real(period.max().unwrap_or(0) as f64 * 1e9 / card.system_hz as f64),
        },
    )
}

/// Words of RAM of each channel that are 0 after the reset of a card without initial values.
fn cleared(card: &CardConfig) -> Vec<Value> {
    if card.initial_values {
        return vec![];
    }
    let words = [
        (card.line.margin, &LINE, "edges_0"),
        (card.line.margin, &LINE, "edges_31"),
        (card.service.requests, &SERVICE, "frames_good"),
        (card.service.requests, &SERVICE, "bad_infos"),
    ];
    let words = words.into_iter().filter(|(has_part, ..)| *has_part);
    let words = words.flat_map(|(_, block, name)| {
        let channels = card.endat_channels();
        channels.map(move |(n, _)| context! { name, address => word_address(block, name, n) })
    });
    words.collect()
}

/// A reset of so many cycles brings a card from anything to its start values; a board top's is as long.
pub const RESET_CYCLES: u64 = 4;

/// From a trigger to the end of everything, in ns.
fn cycle_ns(card: &CardConfig) -> u64 {
    let hz = card.system_hz;
    // Whatever is selected comes with it, and may be selected in it.
    let more = |c: &ChannelConfig| match card.service.requests && c.is_endat() {
        true => c.longest_frame_cycles(hz) - c.frame_time(hz).frame_cycles,
        false => 0,
    };
    let exchange = |c: &ChannelConfig| cycles_to_ns(c.cycle_max_cycles(hz) + more(c), hz);
    let exchange_ns = card.channels.iter().map(exchange).max().unwrap_or(0);
    let idle_ns = others_on(card).map(|other| other.idle_ns()).max();
    exchange_ns + MARGIN_NS + idle_ns.unwrap_or(0)
}

/// Whether a field of the word `frame` says which triggers a channel takes.
fn is_own_trigger(field: &str) -> bool {
    field == "skip" || field.starts_with("ignore_")
}

/// The bench moves a start bit so many cycles beyond its window.
fn beyond_cycles(card: &CardConfig) -> u64 {
    match card.line.double_edge {
        true => 4,
        false => 2,
    }
}

/// On a cable that holds more clock periods CLOCK waits for the answer, and the bench's encoder does not know when an early start bit is due.
const PERIODS_MAX: u64 = 4;

/// Whether the bench moves start bits. A start bit outside its window must be at most half a bit from its place, CLOCK must not wait, and no
/// additional data may come with the frame.
fn moves_starts(card: &CardConfig, ports: &[Port]) -> bool {
    let has_room = |c: &ChannelConfig, port: &Port| {
        port.delay_cycles <= PERIODS_MAX * c.period_cycles
            && 2 * (c.start_window_cycles + beyond_cycles(card)) <= c.period_cycles
    };
    let mut channels = card.endat_channels().zip(ports);
    let has_list = !purpose::configured_list(card).is_empty();
    !card.line.alignment && !has_list && channels.all(|((_, c), port)| has_room(c, port))
}

/// EnDat channels whose start bits move beyond their windows in one direction: late ones would be at most half a bit long.
fn early_only(card: &CardConfig) -> Vec<usize> {
    // The delay that has followed start bits may be a cycle off.
    let cycles = |c: &ChannelConfig| c.start_window_cycles + beyond_cycles(card) + 1;
    let is_short = |c: &ChannelConfig| 2 * cycles(c) >= c.period_cycles;
    let channels = card.endat_channels();
    let short = channels.filter(|(_, c)| is_short(c));
    short.map(|(index, _)| index).collect()
}

/// EnDat channels, and how far from its place a start bit may be.
fn windows(card: &CardConfig) -> Vec<Value> {
    let channels = card.endat_channels();
    let row =
        |(index, c): (usize, &ChannelConfig)| context! { index, cycles => c.start_window_cycles };
    channels.map(row).collect()
}

/// The bits of the position that results of each channel that is not EnDat bring.
fn masks(others: &[BenchParts]) -> Vec<Value> {
    let all = others.iter().flat_map(|parts| parts.masks.clone());
    all.map(|(index, mask)| context! { index, mask }).collect()
}

/// Position bits of every channel, the last one first; 0 where it is not EnDat.
fn widths(card: &CardConfig) -> String {
    let bits = |c: &ChannelConfig| if c.is_endat() { c.position_bits } else { 0 };
    let each = card
        .channels
        .iter()
        .rev()
        .map(|c| format!("6'd{}", bits(c)));
    format!("{{{}}}", each.collect::<Vec<_>>().join(", "))
}

/// The model of an EnDat encoder.
fn encoder(name: &str) -> Result<String, CommandError> {
    template::render(
        "encoder",
        include_str!("templates/encoder.v.jinja"),
        &context! { name },
    )
}

/// The test bench of a card; none for a port without a bus.
pub fn artifact(project: &Project) -> Result<Option<Artifact>, CommandError> {
    let card = &project.card;
    let Some(host) = host::host(project.bus, card)? else {
        return Ok(None);
    };
    let hz = card.system_hz;
    let sleeps = card.service.initialise || !card.initial_values;
    let others = others_on(card).map(|other| other.bench(&project.name, card, sleeps));
    let others: Vec<BenchParts> = others.collect::<Result<_, _>>()?;
    let cycle_ns = cycle_ns(card);
    let after_frame = |c: &ChannelConfig| c.cycle_max_cycles(hz) - c.frame_time(hz).frame_cycles;
    let calibration_ns =
        longest_ns(card, |c| c.calibration_cycles(hz) + after_frame(c)) + MARGIN_NS;
    // What a list has selected comes with the frames that measure, too.
    let additional_data = |c: &ChannelConfig| {
        u64::from(2 * INFO_BITS + SUPPLEMENT_PULSES) * c.calibration_period_cycles(hz)
    };
    let additional_data_ns = match purpose::configured_list(card).is_empty() {
        true => 0,
        false => longest_ns(card, additional_data),
    };
    let calibration_ns = (calibration_ns + additional_data_ns).max(cycle_ns)
        * measuring_frames(card) as u64
        + cycle_ns;
    let timeout = |c: &ChannelConfig| {
        c.recovery_limit_cycles + cycles_at_least(1_000 * c.start_timeout_us, hz)
    };
    let frames = card.endat_channels().map(|(_, c)| c.frame_time(hz));
    let exchanges = others.iter().map(|parts| parts.shortest_cycles);
    let shortest_frame = frames.map(|f| f.frame_cycles).chain(exchanges).min();
    let abort_us = card.endat_channels().map(|(_, c)| c.abort_us).max();
    let ports = ports(card);
    let encoder = encoder(&project.name)?;
    let power_up = power_up(card, &ports, !others.is_empty())?;
    let purpose = purpose::Parts::new(card, &ports)?;
    let blocks = [&CARD, &CARD_CONFIG, &CHANNEL_CONFIG, &RESULT];
    let blocks = blocks
        .into_iter()
        .chain(card.outputs.interrupt.then_some(&INTERRUPT))
        .chain(card.outputs.position.then_some(&DIRECT));
    // Cards without requests have no additional data in their results.
    let has_infos = card.service.requests;
    let context = context! {
        result_words => if has_infos { 8 } else { 6 },
        program => program_text(card)?,
        power_up,
        sleeps,
        initial_values => card.initial_values,
        reset_cycles => RESET_CYCLES,
        cleared => cleared(card),
        clear_cycles => CLEAR_CYCLES,
        services => services(card),
        purpose => purpose.steps,
        purpose_tasks => purpose.tasks,
        tell => tell(&project.name, "", "")?,
        direct_stride => DIRECT.stride,
        name => project.name.as_str(),
        version => env!("CARGO_PKG_VERSION"),
        hash => project.hash.as_str(),
        encoder,
        first => ports.first().map_or(0, |p| p.index),
        last => ports.last().map_or(0, |p| p.index),
        count => card.channels.len(),
        brings => if others.is_empty() { "ENDAT" } else { "BRINGS" },
        others => Serde(&others),
        endat => ports.iter().map(|p| p.index).collect::<Vec<_>>(),
        silent => others.iter().flat_map(|parts| parts.silent.clone()).collect::<Vec<_>>(),
        masks => masks(&others),
        channels => Serde(&ports),
        host => host.text,
        connections => Serde(host.connections),
        settle_ns => real(host.settle_ns),
        pushes => host::pushes(project.bus, card),
        clk_ns => real(clock_ns(hz)),
        calibration_ns => whole(calibration_ns),
        measuring_frames => measuring_frames(card),
        cycle_ns => whole(cycle_ns),
        fault_ns => whole(cycle_ns + longest_ns(card, timeout) + ENCODER_GIVES_UP_NS),
        abort_ns => whole(1_000 * abort_us.unwrap_or(0) + MARGIN_NS),
        overrun_ns => whole(cycles_to_ns(shortest_frame.unwrap_or(0) / 2, hz)),
        trigger_cycles => TRIGGER_CYCLES,
        result_ns => whole(RESULT_NS + longest_ns(card, |c| cycles_at_least(c.spec.delay_max_ns(), hz))),
        widths => widths(card),
        words => Serde(blocks.into_iter().flat_map(words).filter(|w| has_infos || !w.name.starts_with("RESULT_INFO_")).collect::<Vec<_>>()),
        has_irq => project.bus != HostBus::Uart,
        interrupt => card.outputs.interrupt.then(|| result_events(card)),
        has_list => !purpose::configured_list(card).is_empty(),
        direct => card.outputs.position,
        second => card.safety.second_interface,
        fields => Serde([CARD_CONFIG, CHANNEL_CONFIG, RESULT, DIRECT].iter().flat_map(fields).filter(|f| has_infos || !f.name.starts_with("INFO_")).collect::<Vec<_>>()),
        block_stride => BLOCK_STRIDE,
        causes => causes(&CAUSES),
        identification => identification(card),
        timer => card.sources.timer,
        requests => card.service.requests,
        continuous => card.service.continuous,
        every_trigger => every_trigger(card),
        measures => purpose::first_measured(card),
        tests => purpose::tests(card),
        windows => windows(card),
        early_only => early_only(card),
        moves_starts => moves_starts(card, &ports),
        beyond_cycles => beyond_cycles(card),
        diagnosis => card.service.diagnosis,
        us_cycles => cycles_per_us(hz),
        timer_cycles => TIMER_CYCLES,
        widest_ns => whole(purpose::widest_ns(card)),
        alignment => card.line.alignment,
        double_edge => card.line.double_edge,
        bus => project.bus.name(),
    };
    let context = with_parts(&context)?;
    let text = template::render(
        "testbench",
        include_str!("templates/testbench.v.jinja"),
        &context,
    )?;
    Ok(Some(Artifact::new(format!("{}_tb.v", project.name), text)))
}

/// Frames that measure the line delay of a channel.
pub fn measuring_frames(card: &CardConfig) -> usize {
    match card.line.alignment {
        true => CALIBRATION_FRAMES,
        false => 1,
    }
}

/// The EnDat channels and their encoders.
pub fn ports(card: &CardConfig) -> Vec<Port> {
    let channels = card.endat_channels();
    channels.map(|(i, c)| Port::new(card, i, c)).collect()
}

/// Adds the parts of the bench whose templates are files of their own.
fn with_parts(context: &Value) -> Result<Value, CommandError> {
    let part = |name: &str, text: &str| template::render(name, text, context);
    let results = include_str!("templates/bench_results.v.jinja");
    let limits = include_str!("templates/bench_limits.v.jinja");
    let limits_tasks = include_str!("templates/bench_limits_tasks.v.jinja");
    Ok(context! {
        results => part("bench_results", results)?,
        limits => part("bench_limits", limits)?,
        limits_tasks => part("bench_limits_tasks", limits_tasks)?,
        ..context.clone()
    })
}

/// The event of a new result of each channel, the first of its four.
pub fn result_events(card: &CardConfig) -> String {
    let events: u32 = (0..card.channels.len()).map(|n| 1 << (4 * n)).sum();
    format!("{events:08X}")
}

/// Causes that the bench waits for.
const CAUSES: [&str; 10] = [
    "data_not_low",
    "no_start_bit",
    "start_window",
    "crc",
    "f1",
    "f2",
    "data_not_falling",
    "trigger_overrun",
    "unknown_command",
    "watchdog",
];

/// These causes with their codes.
pub fn causes(names: &[&str]) -> Vec<Value> {
    let rows = names
        .iter()
        .flat_map(|name| cause::ALL.iter().find(|c| c.name == *name));
    rows.map(|c| context! { name => c.name.to_uppercase(), code => c.code })
        .collect()
}

/// Constant words from the first one on: they say which card this is.
pub fn identification(card: &CardConfig) -> Vec<String> {
    let constant = CARD
        .registers
        .iter()
        .take_while(|r| r.name != "trigger_count");
    constant
        .map(|r| format!("{:08X}", start(&CARD, r, card, 0)))
        .collect()
}

/// What a host writes so that channels take every trigger: the bench is about such.
pub fn every_trigger(card: &CardConfig) -> Vec<Value> {
    let Some(frame) = CHANNEL_CONFIG
        .register("frame")
        .filter(|_| card.own_triggers())
    else {
        return vec![];
    };
    let write = |channel| {
        let address = CHANNEL_CONFIG.address(frame, channel);
        context! { address, value => format!("{:08X}", purpose::setting(card, frame, channel)) }
    };
    (0..card.channels.len()).map(write).collect()
}
