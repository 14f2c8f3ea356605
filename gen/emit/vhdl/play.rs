//! The run that the bench of a core plays again: the design in the compiled engine, encoder models on its lines, a host at its bus.

use super::host::Host;
use crate::buses::parallel::Dsp;
use crate::encoders;
use crate::front::Controller;
use crate::protocols::other;
use crate::protocols::t_format::encoder::sound;
use endat_config::{Project, Receiver};
use endat_console::error::CommandError;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::service_times;
use endat_hdl::config::{CardConfig, ChannelConfig};
use endat_hdl::endat::channel::CALIBRATION_FRAMES;
use endat_hdl::endat::service::program::{program, ServiceTimes, CLEAR_CYCLES};
use endat_hdl::endat::timing::{cycles_at_least, RECOVERY_MAX_NS};
use endat_hdl::protocols::t_format::protocol::{BIT_HZ, SYSTEM_HZ};
use endat_hdl::regs::{start, CARD, CHANNEL_CONFIG, RESULT};
use endat_sim::bench::{Bench, ChannelSettings, Link, PinNames};
use endat_sim::line::LineConfig;
use endat_sim::{Time, NS, US};
use rtl_design::elaborate::{Design, Direction, Memory};
use rtl_design::engine::{Compiled, Port};

/// Triggers behind those that measure the delay; after a long measurement one will do, for simulators are slow.
const TRIGGERS: usize = 2;
const TRIGGERS_ALIGNED: usize = 1;
/// Cable to each encoder, in metres.
const CABLE_M: f64 = 10.0;
/// Longest that an encoder computes.
const TCAL: Time = 2 * US;
/// What follows a frame until all of it is seen at the outputs, and what a service does before it takes a trigger, in ns.
const AFTER_NS: u64 = 5_000;
const SERVICE_NS: u64 = 30_000;
/// Cycles of a reset, and behind it.
const RESET_CYCLES: u64 = 8;
const BEHIND_CYCLES: u64 = 100;
/// Words of identification, and of a result.
const IDENTIFICATION_WORDS: u64 = 4;
const RESULT_WORDS: u64 = 4;
/// Memory of the program of a service.
const PROGRAM: &str = "program";

/// Levels at the ports of a core, step by step.
pub struct Played {
    /// The ports but the clock, and for each step their values just before the edge of the clock that ends it.
    pub ports: Vec<Port>,
    /// See `ports`.
    pub steps: Vec<Vec<u128>>,
    /// A step is half a period of the clock: the design looks at both edges. The first step ends with a falling one.
    pub is_double: bool,
    /// Outputs mean something from this step on: registers without start values are anything before a reset.
    pub known_from: usize,
    /// System clock in hertz.
    pub system_hz: u64,
    /// Good positions that the host has read, or that a port without a bus has shown.
    pub good: usize,
    /// The design with the program that is played: the initialisation takes two seconds, and is left out.
    pub design: Design,
    /// It is another one than the core's own.
    pub has_program: bool,
}

/// Whether a memory has the program of a service.
pub(super) fn is_program(memory: &Memory) -> bool {
    memory.name == PROGRAM
}

/// The design whose services do not initialise their encoders, if they do.
fn without_initialisation(card: &CardConfig, design: &Design) -> Option<Design> {
    let times = service_times(card);
    if !times.initialise {
        return None;
    }
    let initialise = false;
    let words = program(&ServiceTimes {
        initialise,
        ..times
    });
    let mut design = design.clone();
    let memories = design.modules.iter_mut().flat_map(|m| &mut m.memories);
    for memory in memories.filter(|m| is_program(m)) {
        memory.start = words.iter().map(|word| u128::from(*word)).collect();
    }
    Some(design)
}

/// An encoder on a cable.
fn link(channel: &ChannelConfig, n: usize) -> Link {
    let mut encoder = encoders::turning(channel, n);
    encoder.tcal = TCAL;
    let request = &channel.spec;
    let tm = Time::from(request.recovery_min_ns.midpoint(request.recovery_max_ns)) * NS;
    encoder.tm = tm..=tm;
    Link::new(LineConfig::cable(CABLE_M).seed(n as u64 + 1), encoder)
}

/// A card, and a port without a bus.
pub fn card(project: &Project, design: &Design) -> Result<Played, CommandError> {
    let card = &project.card;
    let other = without_initialisation(card, design);
    let has_program = other.is_some();
    let design = other.unwrap_or_else(|| design.clone());
    let mut bench = bench_of(project, &design)?;
    let mut host = Host::new(project.bus, card, &mut bench);
    let known_from = power_up(card, &mut host, &mut bench);
    let good = life(project, &mut host, &mut bench);
    Ok(played(bench, known_from, good, design, has_program))
}

/// The design of a card with its encoders.
fn bench_of(project: &Project, design: &Design) -> Result<Bench<Compiled>, CommandError> {
    let card = &project.card;
    let engine = Compiled::new(design).map_err(|e| CommandError::fault("design", &e))?;
    let is_bare = project.bus == HostBus::Bare;
    let names = |n: usize| match is_bare {
        true => PinNames::channel(),
        false => PinNames::card(n),
    };
    let links = card.endat_channels().map(|(n, c)| (names(n), link(c, n)));
    let mut bench = Bench::new(engine, card.system_hz, links.collect());
    for (n, channel) in card.channels.iter().enumerate().filter(|_| !is_bare) {
        if let Some(other) = other(channel.protocol()) {
            bench.add_other(&PinNames::card(n), other.sound(channel, n));
        }
    }
    if is_bare {
        for (_, channel) in card.endat_channels() {
            let (hz, bits) = (channel.spec.clock_hz, channel.position_bits);
            let settings = ChannelSettings::new(card.system_hz, hz, channel.command, bits);
            bench.configure(&settings);
        }
    }
    if card.line.double_edge {
        bench.set_double_edge();
    }
    bench.record_cycles();
    Ok(bench)
}

/// What happens before the first trigger; the cycle from which on outputs are known.
fn power_up(card: &CardConfig, host: &mut Host, bench: &mut Bench<Compiled>) -> usize {
    if card.initial_values {
        // There is no reset: an encoder channel would be quiet for 30 ms behind it.
        host.run(bench, BEHIND_CYCLES);
        return 0;
    }
    reset(bench, |bench, cycles| host.run(bench, cycles));
    let known_from = bench.cycle();
    host.run(bench, BEHIND_CYCLES);
    if card.service.requests {
        host.run(bench, CLEAR_CYCLES);
    }
    known_from as usize
}

/// A reset; `run` lets cycles pass.
fn reset(bench: &mut Bench<Compiled>, run: impl FnOnce(&mut Bench<Compiled>, u64)) {
    let reset = match bench.has_port("rst_i") {
        true => "rst_i",
        false => "reset",
    };
    bench.set(reset, 1);
    run(bench, RESET_CYCLES);
    bench.set(reset, 0);
}

/// Identification, triggers with their results, a setting that is written and read, a reset; how many good positions have come.
fn life(project: &Project, host: &mut Host, bench: &mut Bench<Compiled>) -> usize {
    let card = &project.card;
    let cycles = |ns| cycles_at_least(ns, card.system_hz);
    host.read(bench, u64::from(CARD.base), IDENTIFICATION_WORDS);
    if card.service.requests {
        host.run(bench, cycles(SERVICE_NS));
    }
    let longest =
        |f: &dyn Fn(&ChannelConfig) -> u64| card.channels.iter().map(f).max().unwrap_or(0);
    let frame = longest(&|c| c.frame_time(card.system_hz).frame_cycles);
    let measuring = longest(&|c| match c.is_endat() {
        true => c.calibration_cycles(card.system_hz),
        false => 0,
    });
    let replies = longest(&|c| match c.is_endat() {
        true => 0,
        false => c.cycle_max_cycles(card.system_hz),
    });
    let after = cycles(RECOVERY_MAX_NS + AFTER_NS) + cycles(TCAL / NS);
    let (measuring_frames, triggers) = match card.line.alignment {
        true => (CALIBRATION_FRAMES, TRIGGERS_ALIGNED),
        false => (1, TRIGGERS),
    };
    let mut good = 0;
    for trigger in 0..measuring_frames + triggers {
        bench.trigger();
        let is_first = trigger < measuring_frames;
        let first = if is_first { measuring } else { 0 };
        host.run(bench, frame.max(first).max(replies) + after);
        if is_first {
            continue;
        }
        for channel in 0..card.channels.len() {
            let status = u64::from(RESULT.address(RESULT.word("status"), channel));
            let words = host.read(bench, status, RESULT_WORDS);
            let fresh = RESULT.field("status", "fresh").mask();
            good += usize::from(words.first().is_some_and(|word| word & fresh != 0));
        }
    }
    good += bench.results().iter().filter(|result| result.fresh).count();
    let frame_word = CHANNEL_CONFIG.word("frame");
    let address = u64::from(CHANNEL_CONFIG.address(frame_word, 0));
    host.write(
        bench,
        address,
        start(&CHANNEL_CONFIG, frame_word, card, 0) ^ 1,
    );
    host.read(bench, address, 1);
    reset(bench, |bench, cycles| host.run(bench, cycles));
    host.run(bench, BEHIND_CYCLES);
    good
}

/// A T-format receiver: requests of the processor, replies, the registers read.
pub fn receiver(receiver: &Receiver, design: &Design) -> Result<Played, CommandError> {
    let engine = Compiled::new(design).map_err(|e| CommandError::fault("design", &e))?;
    let system_hz = SYSTEM_HZ[0];
    let mut bench = Bench::new(engine, system_hz, vec![]);
    let names = PinNames {
        // There is no clock line; the name of any output will do.
        clock: "encoder_data_o".into(),
        data_o: "encoder_data_o".into(),
        data_oe: "encoder_data_oe".into(),
        data_i: "encoder_data_i".into(),
        ..PinNames::channel()
    };
    bench.add_t_format(&names, sound(BIT_HZ, 0));
    Dsp.rest(&mut bench);
    bench.record_cycles();
    let mut known_from = 0;
    if !receiver.initial_values {
        reset(&mut bench, Bench::run_cycles);
        known_from = bench.cycle() as usize;
    }
    bench.run_cycles(BEHIND_CYCLES);
    let mut good = 0;
    let exchange = cycles_at_least(200_000, system_hz);
    for id in [u32::from(receiver.start.request_id), 0, 1, 2] {
        Dsp.write(&mut bench, 0, id);
        bench.run_cycles(exchange);
        let words = Dsp.read(&mut bench, 0, 8, true);
        good += usize::from(words[1] >> 7 & 1 == 1);
    }
    bench.trigger();
    bench.run_cycles(exchange);
    reset(&mut bench, Bench::run_cycles);
    bench.run_cycles(BEHIND_CYCLES);
    Ok(played(bench, known_from, good, design.clone(), false))
}

/// What the bench has noted.
fn played(
    bench: Bench<Compiled>,
    known_from: usize,
    good: usize,
    design: Design,
    has_program: bool,
) -> Played {
    let clocks: Vec<&String> = (design.top().ports.iter())
        .filter(|p| p.is_clock && p.direction == Direction::Input)
        .map(|p| &design.top().nets[p.net].name)
        .collect();
    let (mut ports, mut rows, mut middle) = (vec![], vec![], vec![]);
    if let Some(cycles) = bench.cycles() {
        let is_kept = |at: &usize| !clocks.contains(&&cycles.ports[*at].name);
        let kept: Vec<usize> = (0..cycles.ports.len()).filter(is_kept).collect();
        let row = |row: &Vec<u128>| kept.iter().map(|at| row[*at]).collect::<Vec<u128>>();
        ports = kept.iter().map(|at| cycles.ports[*at].clone()).collect();
        rows = cycles.rows.iter().map(row).collect();
        middle = cycles.middle.iter().map(row).collect();
    }
    let is_double = !middle.is_empty();
    let steps = match is_double {
        false => rows,
        true => middle
            .into_iter()
            .zip(rows)
            .flat_map(|(m, r)| [m, r])
            .collect(),
    };
    Played {
        ports,
        steps,
        is_double,
        known_from: if is_double {
            2 * known_from
        } else {
            known_from
        },
        system_hz: bench.system_hz(),
        good,
        design,
        has_program,
    }
}
