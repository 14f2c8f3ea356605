//! What the published systems are for, as far as a card has it: usual clock rates, cropped positions, selected causes, the
//! watchdog, requests, additional data, continuous clock; and the monitors of a safe control.

use super::host::SCK_HALF_CYCLES;
use super::{
    clock_ns, cycle_ns, fields, is_own_trigger, longest_ns, real, whole, word_address, Port,
};
use endat_config::template;
use endat_console::error::CommandError;
use endat_hdl::card::channel_registers::RESULT_WORDS;
use endat_hdl::card::second_interface::{MARK, RECORD_WORDS};
use endat_hdl::card::services;
use endat_hdl::config::{CardConfig, ChannelConfig, ChannelSpec, PhaseSource};
use endat_hdl::endat::line_delay::mode;
use endat_hdl::endat::service::program::forced_errors;
use endat_hdl::endat::timing::{
    cycles_at_most, cycles_to_ns, PARAMETER_GAP_MS, RECOVERY_MIN_NS, TST_FROM_HZ, TST_USUAL_NS,
};
use endat_hdl::protocol::ModeCommand;
use endat_hdl::regs::{start, Register, CHANNEL_CONFIG, LINE, RECOVERY, RESULT, SERVICE};
use minijinja::context;
use minijinja::value::{Serde, Value};

/// Rates that encoders and peripherals have in common, in hertz.
const RATES_HZ: [u64; 7] = [
    16_000_000, 8_000_000, 4_000_000, 2_000_000, 1_000_000, 200_000, 100_000,
];
/// Bits of the widest position.
const WIDEST_BITS: u64 = 48;
/// Rates below this take a simulator long.
pub const SLOW_HZ: u64 = 1_000_000;
/// Fields of a request that the bench uses.
const REQUEST_FIELDS: [&str; 3] = [
    "REQUEST_COMMAND",
    "REQUEST_ADDRESS",
    "REQUEST_STATE_FINISHED",
];
/// Clock periods until the mode command is out.
const FRAME_EDGES: u64 = 10;
/// What the watchdog leaves a frame beyond its mode command, in microseconds.
const WATCHED_US: u64 = 2;

/// Steps of the bench, and the tasks that they call.
pub(super) struct Parts {
    pub(super) steps: String,
    pub(super) tasks: String,
}

/// The card with other settings on all EnDat channels, if they fit it.
fn changed(card: &CardConfig, change: impl Fn(&ChannelSpec) -> ChannelSpec) -> Option<CardConfig> {
    let mut card = card.clone();
    let (system_hz, double_edge) = (card.system_hz, card.line.double_edge);
    for (index, channel) in card.channels.iter_mut().enumerate() {
        if channel.is_endat() {
            let request = change(&channel.spec);
            *channel = ChannelConfig::resolve(&request, system_hz, double_edge, index).ok()?;
        }
    }
    Some(card)
}

/// The card with another EnDat clock, if its system clock makes that rate.
fn at_rate(card: &CardConfig, clock_hz: u64) -> Option<CardConfig> {
    if !card.system_hz.is_multiple_of(clock_hz) {
        return None;
    }
    changed(card, |request| ChannelSpec {
        clock_hz,
        tst_ns: if clock_hz >= TST_FROM_HZ {
            TST_USUAL_NS
        } else {
            0
        },
        start_window_ns: (250_000_000 / clock_hz).min(300),
        recovery_min_ns: match clock_hz > SLOW_HZ {
            true => request.recovery_min_ns,
            false => request.recovery_min_ns.max(RECOVERY_MIN_NS),
        },
        ..request.clone()
    })
}

/// A word of the settings of a channel that takes every trigger.
pub fn setting(card: &CardConfig, register: &Register, channel: usize) -> u32 {
    let own = (register.fields.iter()).filter(|f| is_own_trigger(f.name));
    let begins = start(&CHANNEL_CONFIG, register, card, channel);
    own.fold(begins, |word, f| word & !f.mask())
}

/// What a host writes to give the channels the settings of a card; they take every trigger.
fn writes(card: &CardConfig) -> Vec<Value> {
    let channels = card.endat_channels().map(|(n, _)| n);
    let words = channels.flat_map(|n| CHANNEL_CONFIG.registers.iter().map(move |r| (r, n)));
    let words = words.map(|(r, n)| {
        let address = format!("{:03X}", CHANNEL_CONFIG.address(r, n));
        context! { address, value => format!("{:08X}", setting(card, r, n)) }
    });
    words.collect()
}

/// Longest cycle with positions of [`WIDEST_BITS`], in ns.
pub(super) fn widest_ns(card: &CardConfig) -> u64 {
    let widest = changed(card, |request| ChannelSpec {
        position_bits: WIDEST_BITS,
        ..request.clone()
    });
    widest.as_ref().map_or(0, cycle_ns)
}

/// The card at every usual rate that its system clock makes, in hertz.
pub fn at_rates(card: &CardConfig) -> impl Iterator<Item = (u64, CardConfig)> + '_ {
    (RATES_HZ.into_iter()).filter_map(|hz| Some((hz, at_rate(card, hz)?)))
}

fn rates(card: &CardConfig) -> Vec<Value> {
    let rates = at_rates(card).map(|(hz, changed)| {
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

/// Where a word of a channel's service stands.
fn service_address(name: &str, channel: usize) -> String {
    word_address(&SERVICE, name, channel)
}

/// Channels with a watchdog: where it is set, and a time in which the mode command is out and no answer has come.
fn watched(card: &CardConfig) -> Vec<Value> {
    if !card.service.diagnosis {
        return vec![];
    }
    let channels = card.endat_channels().map(|(n, c)| {
        let command = c.first_low_extra_cycles + FRAME_EDGES * c.period_cycles;
        let command_us = cycles_to_ns(command, card.system_hz).div_ceil(1_000);
        context! {
            index => n,
            address => service_address("limits", n),
            limit_us => command_us + WATCHED_US,
        }
    });
    channels.collect()
}

/// Frames that fit into each half of a run of continuous clock.
const RUN_FRAMES: u64 = 3;

/// Clock periods in which the receiver sees that a frame of a run is over.
const RUN_EDGES: u64 = 4;

/// The card with the command of the continuous clock on its EnDat channels, if it has one.
fn running(card: &CardConfig) -> Option<CardConfig> {
    let command = ModeCommand::SendPosition;
    let run = |request: &ChannelSpec| ChannelSpec {
        command,
        recovery_min_ns: request.recovery_min_ns.max(RECOVERY_MIN_NS),
        ..request.clone()
    };
    changed(card, run).filter(|_| card.service.continuous)
}

/// Frames of a run, at the most, that are on their way there and back: the encoder has begun them, and the end of the run overtakes them.
fn frames_on_cable(channel: &ChannelConfig, delay_cycles: u64, system_hz: u64) -> u64 {
    let lead = cycles_at_most(channel.spec.tcal_max_ns, system_hz);
    let answer = u64::from(channel.command.answer_bits(channel.position_bits));
    let frame = lead + answer * channel.period_cycles;
    (delay_cycles + RUN_EDGES * channel.period_cycles) / frame
}

/// Channels of that card: where the clock is told to go on.
fn runs(card: &CardConfig, ports: &[Port]) -> Vec<Value> {
    let channels = card.endat_channels().zip(ports).map(|((n, c), port)| {
        context! {
            on_cable => frames_on_cable(c, port.delay_cycles, card.system_hz),
            index => n,
            address => service_address("continuous", n),
            flip => (1u64 << c.position_bits) - 1,
        }
    });
    channels.collect()
}

/// Clock periods that command and answer of a request may have more than those of a position.
const REQUEST_MORE_PERIODS: u64 = 2 * 24;

/// Channels whose service takes requests: where they are written, and what is asked for.
fn requests(card: &CardConfig) -> Vec<Value> {
    if !card.service.requests {
        return vec![];
    }
    let channels = card.endat_channels().map(|(n, _)| {
        context! {
            index => n,
            request => service_address("request", n),
            state => service_address("request_state", n),
            answer => service_address("answer", n),
            // Both levels of every bit.
            addresses => [format!("{:02X}", 0x0D + n), format!("{:02X}", !(0x0D + n) & 0xFF)],
        }
    });
    channels.collect()
}

/// Channels whose recovery time is measured a second time, and where.
fn counters(card: &CardConfig) -> Vec<Value> {
    if !card.safety.recovery_counter {
        return vec![];
    }
    let channels = card.endat_channels().map(|(n, c)| {
        context! {
            index => n,
            filter_cycles => c.filter_cycles,
            edges => word_address(&RECOVERY, "edges", n),
            counter => word_address(&RECOVERY, "counter", n),
        }
    });
    channels.collect()
}

/// Channels with forced errors on a schedule: where the schedule is, and what became of it.
pub fn tests(card: &CardConfig) -> Vec<Value> {
    if card.safety.error_test_ms == 0 {
        return vec![];
    }
    let channels = card.endat_channels().map(|(n, _)| {
        context! {
            index => n,
            period => service_address("error_test", n),
            period_ms => card.safety.error_test_ms,
            request_ns => whole(request_ns(card)),
            state => service_address("error_test_state", n),
        }
    });
    channels.collect()
}

/// What an answer of the second interface is compared with, if there is one.
fn second(card: &CardConfig) -> Option<Value> {
    card.safety.second_interface.then(|| {
        context! {
            mark => MARK,
            channels => card.channels.len(),
            words => RECORD_WORDS,
            read => if card.service.requests { RECORD_WORDS } else { RESULT_WORDS },
            hash => format!("{:08X}", card.hash >> 16),
            // The age has gone on since; what stands above it is of the result.
            age => usize::from(RESULT.register("age_recovery").map_or(0, |r| r.offset)),
            age_bits => RESULT.field("age_recovery", "age_us").width,
            sck_half_ns => real(SCK_HALF_CYCLES * clock_ns(card.system_hz)),
        }
    })
}

/// Channels whose phase is at the host's choice: where it is set, and the word for each choice.
pub(super) fn phases(card: &CardConfig) -> Vec<Value> {
    let Some(word) = LINE.register("alignment").filter(|_| card.line.alignment) else {
        return vec![];
    };
    let at = LINE.field("alignment", "mode");
    let address = |name: &str, n: usize| word_address(&LINE, name, n);
    let channels = card.endat_channels().map(|(n, _)| {
        let begins = start(&LINE, word, card, n) & !at.mask();
        let with = |mode: u64| format!("{:08X}", begins | (mode as u32) << at.lsb);
        context! {
            alignment => address("alignment", n),
            fixed_delay => address("fixed_delay", n),
            phase => address("phase", n),
            measured => with(match card.line.phase {
                PhaseSource::Frame => mode::FRAME,
                PhaseSource::Tracked | PhaseSource::Fixed => mode::TRACKED,
            }),
            fixed => with(mode::FIXED),
        }
    });
    channels.collect()
}

/// The same, where the configuration knows a delay that is not the bench's: there it is measured.
pub fn first_measured(card: &CardConfig) -> Vec<Value> {
    match card.line.phase {
        PhaseSource::Fixed => phases(card),
        PhaseSource::Tracked | PhaseSource::Frame => vec![],
    }
}

/// MRS codes that the services of a card select in turn after reset.
pub fn configured_list(card: &CardConfig) -> &[u8] {
    let list = &card.service.infos;
    let length = list.iter().position(|code| *code == 0);
    &list[..length.unwrap_or(list.len())]
}

/// What the bench selects on a card that has no list of its own: a temperature, and the sources of errors.
const USUAL_LIST: [u8; 2] = [0x4C, 0x59];
/// What ends additional data 1 and 2.
const NO_INFOS: [u8; 2] = [0x4F, 0x5F];

/// Channels whose encoders send additional data: where the list stands, the slots, and what the host writes there, if it has to.
fn infos(card: &CardConfig) -> Vec<Value> {
    if !card.service.requests {
        return vec![];
    }
    let own = configured_list(card);
    let list = if own.is_empty() { &USUAL_LIST } else { own };
    let channels = card.endat_channels().filter(|(_, c)| c.command.has_f2());
    let channels = channels.map(|(n, _)| {
        let codes = list.iter().enumerate().map(|(i, code)| {
            context! {
                place => service_address(&format!("list_{i}"), n),
                slot => service_address(&format!("slot_{i}"), n),
                mrs => format!("{code:02X}"),
            }
        });
        context! {
            index => n,
            codes => codes.collect::<Vec<_>>(),
            length => service_address("list_length", n),
            request => service_address("request", n),
        }
    });
    channels.collect()
}

/// Such a request takes no longer than this, in nanoseconds.
fn request_ns(card: &CardConfig) -> u64 {
    let more = longest_ns(card, |c| REQUEST_MORE_PERIODS * c.period_cycles);
    cycle_ns(card) + more
}

impl Parts {
    pub(super) fn new(card: &CardConfig, ports: &[Port]) -> Result<Self, CommandError> {
        let run = running(card);
        let runs = run
            .iter()
            .flat_map(|run| runs(run, ports))
            .collect::<Vec<_>>();
        let is_on_cable = |run: &Value| run.get_attr("on_cable").is_ok_and(|n| n != Value::from(0));
        let context = context! {
            overtakes => runs.iter().any(is_on_cable),
            rates => rates(card),
            own_rate => writes(card),
            direct => card.outputs.position,
            watchdog => watched(card),
            requests => requests(card),
            request_fields => Serde(fields(&SERVICE).filter(|f| REQUEST_FIELDS.contains(&f.name.as_str())).collect::<Vec<_>>()),
            infos => infos(card),
            counters => counters(card),
            tests => tests(card),
            forced_errors => forced_errors(card.safety.second_receiver),
            second => second(card),
            phases => phases(card),
            phase_bits => LINE.field("phase", "tracked").width,
            has_list => !configured_list(card).is_empty(),
            no_infos => NO_INFOS.map(|code| format!("{code:02X}")),
            select => ModeCommand::PositionSelectMemory.code(),
            runs,
            run_writes => run.iter().flat_map(writes).collect::<Vec<_>>(),
            run_ns => whole(RUN_FRAMES * cycle_ns(card)),
            run_frames => 2 * RUN_FRAMES - 1,
            send_parameter => ModeCommand::SendParameter.code(),
            request_ns => whole(request_ns(card)),
            gap_ms => 2 + PARAMETER_GAP_MS,
            services => services(card),
            power_up => card.service.initialise,
            initial_values => card.initial_values,
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
