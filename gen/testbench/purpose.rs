//! What the published systems are for, as far as a card has it: usual clock rates, cropped positions, selected causes, the watchdog.

use super::{clock_ns, cycle_ns, is_own_trigger, real, whole, Port};
use crate::error::GenError;
use crate::template;
use endat_hdl::config::{CardConfig, ChannelConfig, ChannelRequest};
use endat_hdl::regs::{CHANNEL_CONFIG, SERVICE};
use endat_hdl::timing::{cycles_to_ns, RECOVERY_MIN_NS, TST_FROM_HZ, TST_USUAL_NS};
use minijinja::context;
use minijinja::value::{Serde, Value};

/// Rates that encoders and peripherals have in common, in hertz.
const RATES_HZ: [u64; 7] = [
    16_000_000, 8_000_000, 4_000_000, 2_000_000, 1_000_000, 200_000, 100_000,
];
/// Rates below this take a simulator long.
const SLOW_HZ: u64 = 1_000_000;
/// Clock periods until the mode command is out.
const FRAME_EDGES: u64 = 10;
/// What the watchdog leaves a frame beyond its mode command, in microseconds.
const WATCHED_US: u64 = 2;

/// Steps of the bench, and the tasks that they call.
pub(super) struct Parts {
    pub(super) steps: String,
    pub(super) tasks: String,
}

/// The card with another EnDat clock on all EnDat channels, if its system clock makes that rate and everything else fits it.
fn at_rate(card: &CardConfig, clock_hz: u64) -> Option<CardConfig> {
    if !card.system_hz.is_multiple_of(clock_hz) {
        return None;
    }
    let mut card = card.clone();
    let (system_hz, double_edge) = (card.system_hz, card.line.double_edge);
    for (index, channel) in card.channels.iter_mut().enumerate() {
        if channel.t_format.is_some() {
            continue;
        }
        let recovery_min_ns = match clock_hz > SLOW_HZ {
            true => channel.request.recovery_min_ns,
            false => channel.request.recovery_min_ns.max(RECOVERY_MIN_NS),
        };
        let request = ChannelRequest {
            clock_hz,
            tst_ns: if clock_hz >= TST_FROM_HZ {
                TST_USUAL_NS
            } else {
                0
            },
            start_window_ns: (250_000_000 / clock_hz).min(300),
            recovery_min_ns,
            ..channel.request.clone()
        };
        *channel = ChannelConfig::resolve(&request, system_hz, double_edge, index).ok()?;
    }
    Some(card)
}

/// What a host writes to give the channels the settings of a card; they take every trigger.
fn writes(card: &CardConfig) -> Vec<Value> {
    let channels = card.endat_channels().map(|(n, _)| n);
    let words = channels.flat_map(|n| CHANNEL_CONFIG.registers.iter().map(move |r| (r, n)));
    let words = words.map(|(r, n)| {
        let own = r.fields.iter().filter(|f| is_own_trigger(f.name));
        let value = own.fold(r.start(card, n), |word, f| word & !f.mask());
        let address = format!("{:03X}", CHANNEL_CONFIG.address(r, n));
        context! { address, value => format!("{value:08X}") }
    });
    words.collect()
}

fn rates(card: &CardConfig) -> Vec<Value> {
    let possible = RATES_HZ
        .into_iter()
        .filter_map(|hz| Some((hz, at_rate(card, hz)?)));
    let rates = possible.map(|(hz, changed)| {
        let period_cycles = card.system_hz / hz;
        context! {
            is_slow => hz < SLOW_HZ,
            writes => writes(&changed),
            cycle_ns => whole(cycle_ns(&changed)),
            period_ns => real(period_cycles as f64 * clock_ns(card.system_hz)),
        }
    });
    rates.collect()
}

/// Channels with a watchdog: where it is set, and a time in which the mode command is out and no answer has come.
fn watched(card: &CardConfig) -> Vec<Value> {
    let limits = SERVICE
        .register("limits")
        .filter(|_| card.service.diagnosis);
    let channels = limits
        .into_iter()
        .flat_map(|r| card.endat_channels().map(move |c| (r, c)));
    let channels = channels.map(|(r, (n, c))| {
        let command = c.first_low_extra_cycles + FRAME_EDGES * c.period_cycles;
        let command_us = cycles_to_ns(command, card.system_hz).div_ceil(1_000);
        context! {
            index => n,
            address => format!("{:03X}", SERVICE.address(r, n)),
            limit_us => command_us + WATCHED_US,
        }
    });
    channels.collect()
}

impl Parts {
    pub(super) fn new(card: &CardConfig, ports: &[Port]) -> Result<Self, GenError> {
        let context = context! {
            rates => rates(card),
            own_rate => writes(card),
            direct => card.outputs.position,
            watchdog => watched(card),
            power_up => card.service.initialise,
            channels => Serde(ports),
        };
        let steps = include_str!("../templates/bench_purpose.v.jinja");
        let tasks = include_str!("../templates/bench_purpose_tasks.v.jinja");
        Ok(Self {
            steps: template::render("bench_purpose", steps, &context)?,
            tasks: template::render("bench_purpose_tasks", tasks, &context)?,
        })
    }
}
