//! `bench comparison`: the page that compares published systems with the same work on this core.
//!
//! Sources: Kim et al., "Implementation of EnDat Interface Master Using Configurable Logic Block in MCU", Electronics 2024, 13, 1101; TI, "EnDat
//! Protocol Design", AM243x motor control SDK 09.01; ArtInChip, manual of ENDAT-IF (M6800); Liu et al., "Angle encoder data acquisition system based
//! on FPGA", 2024; Kang et al., "A FPGA implementation of a rotary machine receiver", 2004.

use super::comparison_t_format::asynchronous;
use super::comparison_table::{Basis, Table, HEAD, STATUS};
use super::measured::area;
use super::preset_run::{project, run, ChannelRun, Conditions};
use super::{cycle_times, fault, CycleTime, CycleTimeOptions};
use endat_config::Project;
use endat_console::error::CommandError;
use endat_draw::decimal;
use endat_hdl::card::direct::CROP_CYCLES;
use endat_hdl::config::CHANNELS;
use endat_hdl::config::{filter_longest, ChannelConfig, ChannelSpec};
use endat_hdl::endat::timing::{
    PERIOD_CYCLES_MIN, PERIOD_CYCLES_MIN_DOUBLE, RECOVERY_MIN_NS, TST_FROM_HZ, TST_USUAL_NS,
};
use endat_hdl::endat::{channel::Channel, channel::FixedTimes};
use endat_hdl::protocol::ModeCommand;
use endat_sim::scenario::{self, RunOptions};
use endat_sim::{Time, NS, US};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;

/// Cables, in metres, from short to long, that a preset is tried on.
const CABLES_M: [u64; 4] = [20, 100, 150, 780];
/// Triggers of a run.
const TRIGGERS: usize = 8;

fn us(time: Time) -> String {
    format!("{} us", decimal(time as f64 / US as f64, 2))
}

/// Whether every trigger brought its position on every channel.
fn is_good(channels: &[ChannelRun]) -> bool {
    channels.iter().all(|c| c.good == TRIGGERS)
}

/// The run of a preset at these conditions, of which every position must be right.
fn good(project: &Project, conditions: Conditions) -> Result<Vec<ChannelRun>, CommandError> {
    let channels = run(project, conditions)?;
    match is_good(&channels) {
        true => Ok(channels),
        false => Err(fault(&format!("{}: {channels:?}", project.name))),
    }
}

/// The longest of the cables with which every position is right, and with which shorter ones are, too; none = 0.
fn longest(project: &Project, conditions: Conditions) -> Result<String, CommandError> {
    let mut longest_m = 0;
    for cable_m in CABLES_M {
        let project = changed(project, |request| request.cable_m = cable_m)?;
        let conditions = Conditions {
            cable_m: cable_m as f64,
            ..conditions
        };
        if !is_good(&run(&project, conditions)?) {
            break;
        }
        longest_m = cable_m;
    }
    Ok(match CABLES_M.last() == Some(&longest_m) {
        true => format!("the delay of {longest_m} m, the longest tried"),
        false => format!("the delay of {longest_m} m"),
    })
}

/// The project with other requests of its channels.
fn changed(project: &Project, change: impl Fn(&mut ChannelSpec)) -> Result<Project, CommandError> {
    let mut project = project.clone();
    let (system_hz, double_edge) = (project.card.system_hz, project.card.line.double_edge);
    for (index, channel) in project.card.channels.iter_mut().enumerate() {
        let mut request = channel.spec.clone();
        change(&mut request);
        let resolved = ChannelConfig::resolve(&request, system_hz, double_edge, index);
        *channel = resolved.map_err(|problems| fault(&format!("{problems:?}")))?;
    }
    Ok(project)
}

/// Another EnDat clock, with the first low phase and the start window that go with it.
fn at_clock(request: &mut ChannelSpec, clock_hz: u64) {
    request.clock_hz = clock_hz;
    request.tst_ns = if clock_hz >= TST_FROM_HZ {
        TST_USUAL_NS
    } else {
        0
    };
    request.start_window_ns = (250_000_000 / clock_hz).min(300);
    request.filter_ns = 0;
}

/// How many channels a card may have.
fn channels_told() -> String {
    let (fewest, most) = (CHANNELS.start(), CHANNELS.end());
    format!("{fewest} to {most} from the same description")
}

/// Places in a bit of the preset's fastest channel, and how few there may be.
fn samples_told(project: &Project) -> String {
    let periods = project.card.channels.iter().map(|c| c.period_cycles);
    let places = 1 + u64::from(project.card.line.double_edge);
    format!(
        "{}; works from {PERIOD_CYCLES_MIN} on, from {PERIOD_CYCLES_MIN_DOUBLE} with double edge",
        periods.min().unwrap_or_default() * places
    )
}

/// What somebody's frames back to back come to here.
fn back_to_back<'r>(rows: &'r [CycleTime], who: &str) -> Result<&'r CycleTime, CommandError> {
    let row = rows
        .iter()
        .find(|r| r.published.is_some_and(|p| p.who == who));
    row.filter(|r| r.failure.is_none())
        .ok_or_else(|| fault(&format!("no row of {who}")))
}

fn clb(rows: &[CycleTime]) -> Result<Table, CommandError> {
    let project = project("clb_2mhz")?;
    let conditions = Conditions {
        cable_m: 3.0,
        short_tm: 10 * US,
        period: 62_500 * NS,
        triggers: TRIGGERS,
    };
    let channel = &good(&project, conditions)?[0];
    let row = back_to_back(rows, "Kim et al.")?;
    let mut table = Table::new(
        "Controller with a logic block: `clb_2mhz`",
        "Kim et al. 2024",
    );
    table.row(
        Basis::Measured,
        "36 bits, 2 MHz, 000111: entire cycle",
        "about 35 us",
        {
            let cycle = decimal(row.cycle_us, 2);
            let limit = decimal(row.frame_limit_us, 2);
            let frame = us(channel.frame);
            format!("{cycle} us with the shortest recovery time, 10 us; the frame alone {frame}, of which the protocol needs {limit} us")
        },
    );
    table.row(
        Basis::Measured,
        "trigger to the position at the control loop, cable of 3 m",
        "–",
        us(channel.position),
    );
    table.row(
        Basis::Measured,
        "left of the control cycle of 62.5 us",
        "about 27.5 us after the entire cycle",
        {
            let left = decimal(62.5 - row.cycle_us, 2);
            let early = us(62_500 * NS - channel.position);
            format!(
                "{left} us after the entire cycle; the position is available {early} before its end"
            )
        },
    );
    let most = decimal(row.cycles_per_s, 0);
    table.row(
        Basis::Measured,
        "cycles per second",
        "16 000",
        format!("16 000; at most {most}"),
    );
    table.words(
        "propagation delay compensation",
        "none; 2 MHz is the highest rate without it",
        "measured, then followed in each frame",
    );
    let longest = longest(&project, conditions)?;
    table.row(
        Basis::Measured,
        "cable with every position right, at 2 MHz",
        "–",
        longest,
    );
    table.words(
        "CRC",
        "\"without propagation delay compensation or CRC errors\"; where it is checked: –",
        "two in hardware, compared",
    );
    table.note("A receiver without compensation samples half a period after its own clock edge: at 2 MHz that is 250 ns, or 20 m of cable there and back.");
    Ok(table)
}

fn ti(rows: &[CycleTime]) -> Result<Table, CommandError> {
    let preset = project("ti_three_channel")?;
    let conditions = Conditions {
        cable_m: 100.0,
        short_tm: 1_250 * NS,
        period: 125 * US,
        triggers: TRIGGERS,
    };
    let channels = good(&preset, conditions)?;
    let each = |c: &ChannelRun| {
        let (bits, mhz) = (c.position_bits, decimal(c.clock_hz / 1e6, 1));
        format!("{bits} bits at {mhz} MHz in {}", us(c.frame))
    };
    let each: Vec<String> = channels.iter().map(each).collect();
    let row = back_to_back(rows, "TI")?;
    let mut table = Table::new("Three channels: `ti_three_channel`", "TI AM243x");
    table.row(
        Basis::Description,
        "channels",
        "3",
        format!("3; {}", channels_told()),
    );
    table.row(
        Basis::Measured,
        "encoders of different make, each at its own rate, 100 m of cable",
        "one clock for all",
        each.join("; "),
    );
    table.row(
        Basis::Measured,
        "encoders of same make, one trigger",
        "yes",
        same_make()?,
    );
    table.row(Basis::Measured, "8 MHz", "100 m", longest_at(8_000_000)?);
    table.row(Basis::Measured, "16 MHz", "20 m", longest_at(16_000_000)?);
    table.row(
        Basis::Description,
        "samples in a bit at 16 MHz",
        "8",
        samples_told(&preset),
    );
    table.words(
        "delay",
        "measured at the start, 200 kHz",
        "the same, then the mean of many edges follows it",
    );
    table.words("CRC", "6 bits, as the page says", "5 bits, as EnDat has");
    let cycle = decimal(row.cycle_us, 2);
    table.row(
        Basis::Measured,
        "37 bits at 8 MHz, from position to position",
        "–",
        format!("{cycle} us"),
    );
    Ok(table)
}

/// One channel of the preset at this rate, on all cables.
fn longest_at(clock_hz: u64) -> Result<String, CommandError> {
    let mut project = project("ti_three_channel")?;
    project.card.channels.truncate(1);
    let project = changed(&project, |request| at_clock(request, clock_hz))?;
    let conditions = Conditions {
        cable_m: 0.0,
        short_tm: 1_250 * NS,
        period: 125 * US,
        triggers: TRIGGERS,
    };
    longest(&project, conditions)
}

/// Three equal channels: whether their clocks are the same, edge by edge.
fn same_make() -> Result<String, CommandError> {
    let mut project = project("ti_three_channel")?;
    let first = project.card.channels[0].clone();
    project.card.channels = vec![first; 3];
    let conditions = Conditions {
        cable_m: 20.0,
        short_tm: 1_250 * NS,
        period: 62_500 * NS,
        triggers: TRIGGERS,
    };
    let channels = good(&project, conditions)?;
    let first = &channels[0];
    let same = channels
        .iter()
        .all(|c| (c.frame, c.pulses) == (first.frame, first.pulses));
    match same {
        true => Ok(format!(
            "yes: {} pulses in {} on each",
            first.pulses,
            us(first.frame)
        )),
        false => Err(fault(&format!("not the same: {channels:?}"))),
    }
}

fn artinchip() -> Result<Table, CommandError> {
    let preset = project("artinchip_endat_if")?;
    let mut rates = vec![];
    for clock_hz in [16, 8, 4, 2, 1]
        .map(|mhz| mhz * 1_000_000)
        .into_iter()
        .chain([200_000, 100_000])
    {
        let project = changed(&preset, |request| {
            at_clock(request, clock_hz);
            request.recovery_min_ns = RECOVERY_MIN_NS;
        })?;
        let conditions = Conditions {
            cable_m: 10.0,
            short_tm: 10 * US,
            period: 600 * US,
            triggers: TRIGGERS,
        };
        let channel = &good(&project, conditions)?[0];
        rates.push(decimal(channel.clock_hz / 1e6, 1));
    }
    let cycle_ns = 1e9 / preset.card.system_hz as f64;
    let places = 1 + u64::from(preset.card.line.double_edge);
    let step_ns = cycle_ns / places as f64;
    let steps = filter_longest(places);
    let crop_ns = CROP_CYCLES as f64 * cycle_ns;
    let mut table = Table::new(
        "Peripheral of a servo processor: `artinchip_endat_if`",
        "ArtInChip ENDAT-IF",
    );
    table.row(
        Basis::Measured,
        "rates at run time, MHz",
        "16, 8, 4, 2, 1, 0.2, 0.1",
        format!(
            "{}, and every other whole number of system clocks",
            rates.join(", ")
        ),
    );
    table.row(
        Basis::Description,
        "ports",
        "–",
        format!("2; {}", channels_told()),
    );
    table.row(
        Basis::Description,
        "mode commands",
        "10",
        ModeCommand::ALL.len().to_string(),
    );
    table.row(
        Basis::Description,
        "step of the input filter",
        "4.1 ns",
        format!("{} ns, 0 to {steps} steps", decimal(step_ns, 1)),
    );
    table.row(
        Basis::Description,
        "cropped position to the current loop",
        "16 bits in the example",
        format!(
            "up to {} bits, {} ns after the result",
            CROP_CYCLES - 1,
            decimal(crop_ns, 0)
        ),
    );
    table.words(
        "errors to the current loop",
        "OR of selected ones",
        "OR of selected causes, alarm too",
    );
    table.words("watchdog", "driver off, 30 ms, then DATA LOW for tR; does not watch continuous mode, 101010, 100011 and 011100", "the same");
    table.words(
        "status bits",
        "15",
        "all of them: [table](#status-bits-of-endat-if)",
    );
    table.note("The filter step here is half a system clock of 128 MHz, since DATA is sampled on both edges; theirs is a clock of 240 MHz.");
    Ok(table)
}

fn card(rows: &[CycleTime]) -> Result<Table, CommandError> {
    let flow = scenario::named("paper-flow").ok_or_else(|| fault(&"no scenario"))?;
    let mut channel = Channel::new(FixedTimes {
        abort_us: flow.channels[0].settings.abort_us,
        ..FixedTimes::at(flow.system_hz)
    });
    channel.connect_all();
    let design = elaborate(&channel, "channel").map_err(|e| fault(&e))?;
    let engine = Compiled::new(&design).map_err(|e| fault(&e))?;
    let (bench, report) = flow.run_channel(0, engine, RunOptions::default());
    if let Some(complaint) = report.complaints().first() {
        return Err(fault(&format!("{}: {complaint}", flow.name)));
    }
    // The first result is of frame 1; frame 0 measures the delay.
    let result = bench.results().first().ok_or_else(|| fault(&"no result"))?;
    let row = back_to_back(rows, "Liu et al.")?;
    let (lut, ff) = area("card_stream", "xc6s");
    let mut table = Table::new("Acquisition card: `s6_two_channel`", "Liu et al. 2024");
    table.row(
        Basis::Measured,
        "sampling of two RCN 8510, 3.125 MHz",
        "10 kHz",
        {
            let most = decimal(row.cycles_per_s / 1e3, 1);
            format!("10 kHz; at most {most} kHz with the same settings")
        },
    );
    table.row(
        Basis::Measured,
        "one frame from position to position",
        "cycle of 100 us",
        format!("{} us", decimal(row.cycle_us, 2)),
    );
    let gui = back_to_back(rows, "receiver with GUI")?.cycle_us;
    table.row(
        Basis::Measured,
        "25 bits, 2 MHz, from position to position",
        "40 us (a receiver with serial GUI, scholarmate.com/S/Nlp49a; width and clock: –)",
        format!("{} us", decimal(gui, 2)),
    );
    table.row(Basis::Measured, "captured frame: F1 F2, CRC", "01, 1D", {
        let frame = bench.frames(0).get(1).ok_or_else(|| fault(&"no frame"))?;
        let bit = |on| if on { '1' } else { '0' };
        let (f1, f2) = (bit(frame.errors.0), frame.errors.1.map_or('-', bit));
        format!(
            "{f1}{f2}, {:02X} received, {:02X} computed, position {:#010X}",
            result.crc_received, result.crc_computed, result.position
        )
    });
    table.row(
        Basis::Measured,
        "ways out of the flow chart",
        "start time-out, wrong start bit, error bits, CRC",
        {
            let causes: Vec<String> = bench
                .results()
                .iter()
                .map(|r| r.cause.to_string())
                .collect();
            format!(
                "causes {} in scenario `paper-flow`; the last position is held",
                causes.join(" ")
            )
        },
    );
    table.words(
        "signal `link`",
        "frame ended well, position taken",
        "`result_strobe` with `fresh`",
    );
    table.words(
        "signal `check`",
        "CRC is right",
        "`crc_received` = `crc_computed`, cause not 4",
    );
    table.words("signal `err`", "F1 F2", "flags F1 and F2, causes 5 and 6");
    table.words(
        "signal `dir`",
        "direction of the transceiver",
        "`endat_data_oe`",
    );
    table.row(
        Basis::Synthesis,
        "area",
        "device of 9152 logic cells",
        format!("{lut} LUT6, {ff} FF"),
    );
    Ok(table)
}

/// The frames that tables of the page measure.
const TIMES: CycleTimeOptions = CycleTimeOptions {
    position_bits: None,
    cable_m: 1,
    tcal_ns: 5_000,
    tm_ns: 10_000,
};

/// Two tables of the page, which take seconds: a measured one, and one of figures from synthesis.
///
/// # Errors
/// As [`comparison`].
pub fn comparison_sample() -> Result<[String; 2], CommandError> {
    let times = cycle_times(TIMES)?;
    Ok([clb(&times.rows)?, asynchronous()?].map(|table| table.to_string()))
}

/// The page.
pub fn comparison() -> Result<String, CommandError> {
    let times = cycle_times(TIMES)?;
    let rows = &times.rows;
    let mut page = HEAD.to_owned();
    for table in [
        clb(rows)?,
        ti(rows)?,
        artinchip()?,
        card(rows)?,
        asynchronous()?,
    ] {
        page += &table.to_string();
    }
    Ok(page + STATUS)
}
