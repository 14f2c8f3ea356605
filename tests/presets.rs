//! Every preset against encoders at the corners of what it says it takes: recovery time, calculation time, rate. Not one fault.
//!
//! The card is the preset's, with a fast UART that pushes a set for each trigger: the set has the cause of every result, and a channel that
//! is quiet after a fault takes no part in the next ones.

use crate::made;
use crate::stream_rig::{Set, FRESH, MISSING, TAKEN, VALID};
use endat_config::{load_preset, Project, PRESETS};
use endat_hdl::card::service_times;
use endat_hdl::card::uart::BIT_CYCLES_MIN;
use endat_hdl::config::{CardConfig, ChannelConfig, StreamStart, DELAY_NS_PER_M};
use endat_hdl::endat::service::program::ServiceTimes;
use endat_hdl::endat::timing::{RECOVERY_MAX_NS, RECOVERY_MIN_NS, SHORT_RECOVERY_MIN_NS};
use endat_hdl::protocol::ModeCommand;
use endat_hdl::protocols::ssi::{asked::Parity, specials::Specials};
use endat_hdl::protocols::t_format::protocol::RATE_TOLERANCE_PPM;
use endat_hdl::regs::Protocol;
use endat_sim::bench::{Bench, Link, PinNames, TFormatLink, Uart};
use endat_sim::encoder::EncoderConfig;
use endat_sim::line::LineConfig;
use endat_sim::ssi::{self, SsiLink};
use endat_sim::t_format;
use endat_sim::{MS, NS, US};
use rtl_design::engine::Compiled;

/// What a crystal may be off, in parts per million.
const CRYSTAL_PPM: i64 = 100;
/// Longest recovery time that can be set to short, in ns (PWM 20).
const SHORT_RECOVERY_MAX_NS: u64 = 3_750;
/// Sets of a long run that must be without a fault; one with a pause of 30 ms in it would not be.
const SETS: usize = 60;
/// Longest start: 1.9 s of initialisation are a few milliseconds here.
const START_MS: u64 = 400;

/// One corner: the shortest or the longest of each time, and the crystal slow or fast.
#[derive(Clone, Copy, Debug)]
struct Corner {
    tm_long: bool,
    tcal_long: bool,
    fast: bool,
    cable_long: bool,
}

impl Corner {
    /// All of them; `n` turns what each channel has, so that few runs see every one on every channel.
    fn number(n: usize) -> Self {
        Self {
            tm_long: n & 1 != 0,
            tcal_long: n & 2 != 0,
            cable_long: n & 4 != 0,
            fast: n & 8 != 0,
        }
    }
}

/// An encoder that the channel's configuration says it takes.
fn encoder(channel: &ChannelConfig, initialise: bool, corner: Corner) -> EncoderConfig {
    let bits = channel.position_bits;
    let mut encoder = match channel.command {
        ModeCommand::SendPosition => EncoderConfig::endat21(bits),
        _ => EncoderConfig::endat22(bits),
    };
    let pick = |range: [u64; 2]| {
        let ns = range[usize::from(corner.tm_long)];
        ns * NS..=ns * NS
    };
    // Before it is told otherwise an encoder has the usual time; the card must take every one of them.
    encoder.tm = pick([RECOVERY_MIN_NS, RECOVERY_MAX_NS]);
    encoder.tm_short = Some(pick([SHORT_RECOVERY_MIN_NS, SHORT_RECOVERY_MAX_NS]));
    if channel.wants_short_recovery() && !initialise {
        // Somebody else has set it.
        encoder.tm = pick([SHORT_RECOVERY_MIN_NS, RECOVERY_MAX_NS]);
    }
    encoder.tcal = match corner.tcal_long {
        true => channel.spec.tcal_max_ns * NS,
        false => US,
    };
    encoder.reset_time = 2 * MS;
    encoder.write_time = MS..=MS;
    encoder.tac = 50 * US..=100 * US;
    encoder
}

fn cable_m(channel: &ChannelConfig, corner: Corner) -> f64 {
    match corner.cable_long {
        true => channel.spec.cable_m as f64,
        false => 0.5,
    }
}

fn t_format_encoder(channel: &ChannelConfig, corner: Corner) -> t_format::EncoderConfig {
    let request = *channel.spoken.t_format().unwrap();
    let ppm = RATE_TOLERANCE_PPM as i64;
    t_format::EncoderConfig {
        bit_hz: request.bit_hz,
        rate_error_ppm: if corner.tcal_long { ppm } else { -ppm },
        reply_gap: match corner.tm_long {
            // The reply is there before the pause ends.
            true => request.reply_gap_us * US - US / 2,
            false => 2 * US,
        },
        status: 0,
        alarm: 0,
        ..t_format::EncoderConfig::default()
    }
}

/// The slowest bits and the longest recovery time that a channel takes, or the shortest, at the end of a cable.
fn ssi_link(channel: &ChannelConfig, corner: Corner) -> SsiLink {
    let asked = channel.spoken.ssi().unwrap();
    let spec = &channel.spec;
    // No preset has a parity or CRC among them.
    let well = |specials: &Specials| {
        let levels = specials
            .iter()
            .map(|s| s.cause().is_some_and(|(_, bad)| !bad));
        levels.map(ssi::Extra::Level).collect()
    };
    let config = ssi::EncoderConfig {
        before: well(&asked.before),
        after: well(&asked.after),
        position_bits: channel.position_bits,
        gray: asked.gray,
        repeats: asked.twice,
        parity: asked.has_parity().then_some(asked.parity == Parity::Odd),
        tm: NS
            * match corner.tm_long {
                true => spec.recovery_max_ns,
                false => spec.recovery_min_ns,
            },
        bit_delay: NS
            * if corner.tcal_long {
                asked.bit_delay_ns
            } else {
                10
            },
        ..ssi::EncoderConfig::default()
    };
    // Each way.
    let cable_ns = cable_m(channel, corner) * DELAY_NS_PER_M as f64 / 2.0;
    SsiLink::new(config, cable_ns as u64 * NS)
}

/// The card of a preset that pushes what it receives, made once for all corners.
fn pushing(project: &Project) -> (CardConfig, Compiled) {
    let mut card = project.card.clone();
    card.stream.fifo_bytes = 8192;
    card.stream.start = StreamStart::Push;
    card.uart_bit_cycles = BIT_CYCLES_MIN;
    card.sources.timer = true;
    card.sources.pin = false;
    let times = ServiceTimes {
        power_up_ms: 2,
        after_pulse_ms: 2,
        reset_ms: 3,
        write_ms: 2,
        ..service_times(&card)
    };
    let engine = made::uart_card(&card, &times, 5_000);
    (card, engine)
}

/// Runs a card with encoders at corners that begin with number `first`, until so many sets in a row are without a fault; returns the problems.
fn run((card, engine): &(CardConfig, Compiled), first: usize, sets: usize) -> Vec<String> {
    let channels = card.channels.len();
    // Other channels have other corners, but there is one crystal.
    let corner = |n: usize| Corner {
        fast: Corner::number(first).fast,
        ..Corner::number(first + 3 * n)
    };
    let mut links = vec![];
    for (n, channel) in card.channels.iter().enumerate() {
        if channel.is_endat() {
            let line = LineConfig::cable(cable_m(channel, corner(n)));
            let mut encoder = encoder(channel, card.service.initialise, corner(n));
            encoder.seed = n as u64 + 1;
            links.push((PinNames::card(n), Link::new(line, encoder)));
        }
    }
    let ppm = if corner(0).fast {
        CRYSTAL_PPM
    } else {
        -CRYSTAL_PPM
    };
    let system_hz = (card.system_hz as i64 + card.system_hz as i64 / 1_000_000 * ppm) as u64;
    let mut bench = Bench::new(engine.clone(), system_hz, links);
    for (n, channel) in card.channels.iter().enumerate() {
        let names = PinNames::card(n);
        match channel.protocol() {
            Protocol::Endat => {}
            Protocol::TFormat => {
                let link = TFormatLink::new(t_format_encoder(channel, corner(n)), 50 * NS);
                bench.add_t_format(&names, link);
            }
            Protocol::Ssi => {
                bench.add_other(&names, Box::new(ssi_link(channel, corner(n))));
            }
        }
    }
    if card.line.double_edge {
        bench.set_double_edge();
    }
    let mut uart = Uart::new(&mut bench, card.uart_bit_cycles);
    bench.reset();
    let mut wrong = vec![];
    let (mut frame, mut good, mut last) = (vec![], 0, None);
    let of_sets = sets as u64 * card.sample_period_cycles;
    let end = bench.cycle() + START_MS * (card.system_hz / 1_000) + of_sets;
    while good < sets {
        if bench.cycle() > end {
            wrong.push(format!("{good} good sets, and {START_MS} ms more"));
            break;
        }
        uart.tick(&mut bench);
        let Some(byte) = uart.received().pop_front() else {
            continue;
        };
        if byte != 0 {
            frame.push(byte);
            continue;
        }
        let set = Set::decode(&std::mem::take(&mut frame)).unwrap();
        assert_eq!(set.parts.len(), channels);
        let faulty = |status: u16| status & (0x1f | TAKEN | VALID | FRESH | MISSING);
        let is_good = set
            .parts
            .iter()
            .all(|part| faulty(part.status) == TAKEN | VALID | FRESH);
        // Until every channel has calibrated and initialised there is nothing to hold against it.
        if good == 0 && !is_good {
            continue;
        }
        if last.is_some_and(|last: u16| last.wrapping_add(1) != set.sequence) || !is_good {
            wrong.push(format!("set {}: {:x?}", set.sequence, set.parts));
            break;
        }
        last = Some(set.sequence);
        good += 1;
    }
    for (link, n) in (0..bench.link_count()).map(|n| (n, corner(n))) {
        // A pulse on purpose wakes an encoder up; otherwise nothing is done that encoders do not allow.
        if !card.service.initialise && !bench.violations(link).is_empty() {
            wrong.push(format!("{n:?}: {:?}", bench.violations(link)));
        }
    }
    for other in bench.others().filter(|o| o.protocol() == Protocol::Ssi) {
        wrong.extend(other.complaints());
    }
    wrong
}

/// A preset is a promise: an encoder within its limits gives positions and nothing else.
fn runs_without_a_fault(name: &str, corners: &[usize], sets: usize) {
    let project = load_preset(name).unwrap();
    let made = pushing(&project);
    for first in corners {
        let wrong = run(&made, *first, sets);
        let corner = Corner::number(*first);
        assert!(wrong.is_empty(), "{name}, {corner:?}: {wrong:#?}");
    }
    // Its limits are those of all encoders that accept its command.
    for channel in &project.card.channels {
        if channel.is_endat() {
            let request = &channel.spec;
            assert!(
                request.recovery_min_ns <= RECOVERY_MIN_NS
                    && request.recovery_max_ns >= RECOVERY_MAX_NS,
                "{name}: recovery {}..{} ns",
                request.recovery_min_ns,
                request.recovery_max_ns
            );
        }
    }
}

/// Names of presets, by whether their cards initialise encoders.
fn presets(initialise: bool) -> impl Iterator<Item = &'static str> {
    let all = PRESETS.iter().map(|(name, _)| *name);
    all.filter(move |name| load_preset(name).unwrap().card.service.initialise == initialise)
}

/// Every protocol once, at one corner or the opposite one. In `cargo test` cards with a service initialise encoders.
#[test]
fn presets_run_without_a_fault_at_a_corner_of_their_encoders() {
    runs_without_a_fault("mixed_protocols", &[0], 20);
    runs_without_a_fault("ssi_two_channel", &[15], 20);
}

/// Each limit is at either end twice, or more often.
#[test]
#[ignore = "slow: every preset at half of the corners of its encoders"]
fn presets_run_without_a_fault_at_corners_of_their_encoders() {
    for name in presets(false) {
        runs_without_a_fault(name, &[0, 3, 5, 6, 9, 10, 12, 15], SETS);
    }
}

#[test]
#[ignore = "slow: every preset that initialises at two corners of its encoders"] // each channel has another corner anyway
fn presets_that_initialise_run_without_a_fault_at_corners_of_their_encoders() {
    for name in presets(true) {
        runs_without_a_fault(name, &[1, 14], SETS);
    }
}
