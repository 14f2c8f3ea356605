//! `shmoo`: maps of where frames are good.

use super::work::{progress, ThreadsArgs};
use super::{to_json, Outcome};
use clap::{Args, ValueEnum};
use endat_console::error::{shown, CommandError};
use endat_console::number::number;
use endat_draw::decimal;
use endat_draw::is_drawing;
use endat_hdl::config::{SYSTEM_HZ_MAX, SYSTEM_HZ_MIN};
use endat_hdl::endat::timing;
use endat_hdl::protocol::{ModeCommand, POSITION_BITS};
use endat_sim::diagram::map_svg;
use endat_sim::shmoo::{
    is_table, Axis, Conditions, Fate, Map, Phase, Plan, Quantity, ReceiverKind, DECIMALS,
};
use endat_terminal::files::{check_all, write_all, File};
use serde_json::json;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Arguments of `shmoo`.
#[derive(Args)]
pub struct ShmooArgs {
    /// What goes across: NAME=FROM:TO:STEP or NAME=A,B,... [default: cable_m=0:150:5]
    #[arg(long, value_name = "AXIS")]
    x: Option<String>,
    /// What goes upwards [default: clock_mhz=0.3,0.5,1,2,3.2,4,5.12,6.4,8,9.143,10.667,12.8,16, up to a quarter of the system clock]
    #[arg(long, value_name = "AXIS")]
    y: Option<String>,
    /// What is the same everywhere: NAME=VALUE; may be given more than once
    #[arg(long, value_name = "NAME=VALUE")]
    at: Vec<String>,
    /// System clock in hertz
    #[arg(
        long,
        value_name = "HZ",
        default_value = "128_000_000",
        allow_negative_numbers = true
    )]
    system_hz: String,
    /// Width of the position
    #[arg(
        long,
        value_name = "BITS",
        default_value = "25",
        allow_negative_numbers = true
    )]
    bits: String,
    /// Mode command
    #[arg(long, value_enum, default_value = "111000")]
    command: Command,
    /// Where the phase of the samples comes from [default: tracked; of eye: fixed]
    #[arg(long, value_enum)]
    phase: Option<PhaseArg>,
    /// Look at DATA on both edges of the system clock
    #[arg(long)]
    double_edge: bool,
    /// Each sample is the majority of itself and its neighbours
    #[arg(long)]
    majority: bool,
    /// Frames of each channel at the full clock
    #[arg(
        long,
        value_name = "N",
        default_value = "6",
        allow_negative_numbers = true
    )]
    frames: String,
    /// Channels in each cell, each with random numbers of its own
    #[arg(
        long,
        value_name = "N",
        default_value = "2",
        allow_negative_numbers = true
    )]
    runs: String,
    /// Seed of the random numbers
    #[arg(
        long,
        value_name = "S",
        default_value = "1",
        allow_negative_numbers = true
    )]
    seed: String,
    #[command(flatten)]
    threads: ThreadsArgs,
    /// Draw the map
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write the map as a table
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Command {
    /// EnDat 2.1
    #[value(name = "000111")]
    SendPosition,
    /// EnDat 2.2
    #[value(name = "111000")]
    SendPositionAddInfo,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum PhaseArg {
    /// The mean over many edges
    Tracked,
    /// The start bit of each frame
    Frame,
    /// A register, set to the delay of the line
    Fixed,
    /// One cycle for each frame after its start bit: a channel without alignment
    Step,
}

/// The clock rates of a map for which none are given, in MHz.
const CLOCKS_MHZ: [f64; 13] = [
    0.3, 0.5, 1.0, 2.0, 3.2, 4.0, 5.12, 6.4, 8.0, 9.143, 10.667, 12.8, 16.0,
];
/// Most values of an axis.
const VALUES_MAX: usize = 200;
/// Most channels of a map.
const CHANNELS_MAX: usize = 100_000;
/// Most frames of a channel.
const FRAMES_MAX: u64 = 10_000;

/// System clock in hertz, and the receiver that works with it.
type Clocks = (u64, ReceiverKind);

/// Runs `eye`: the sample is moved over the bit, and the jitter upwards.
pub fn eye(arguments: ShmooArgs) -> Result<Outcome, CommandError> {
    if let Some(phase) = arguments.phase.filter(|p| *p != PhaseArg::Fixed) {
        let name = phase.to_possible_value();
        let name = name.as_ref().map_or("?", |n| n.get_name());
        return Err(CommandError::input(format!(
            "--phase = {name}: eye moves the sample, which only a phase from a register allows; leave it out, or use shmoo"
        )));
    }
    let or = |given: Option<String>, usual: &str| Some(given.unwrap_or_else(|| usual.into()));
    run(&ShmooArgs {
        x: or(arguments.x, "offset_percent=-60:60:2.5"),
        y: or(arguments.y, "jitter_ns=0:60:2.5"),
        phase: Some(PhaseArg::Fixed),
        ..arguments
    })
}

/// Runs the command.
pub fn run(arguments: &ShmooArgs) -> Result<Outcome, CommandError> {
    let plan = plan(arguments)?;
    let file = |option, path: &Option<PathBuf>, is_ours| {
        path.clone().map(|path| File {
            option,
            path,
            text: String::new(),
            is_ours,
        })
    };
    let mut svg = file("--svg", &arguments.svg, is_drawing);
    let mut csv = file("--csv", &arguments.csv, is_table);
    // Before the long work, not after it.
    check_all(&[&svg, &csv].into_iter().flatten().collect::<Vec<_>>())?;
    let told = progress(plan.channels(), "channels");
    let map = plan
        .run(arguments.threads.count()?, told)
        .map_err(|e| CommandError::fault("shmoo", &e))?;
    if let Some(svg) = &mut svg {
        svg.text = map_svg(&map, &title(&plan));
    }
    if let Some(csv) = &mut csv {
        csv.text = map.csv();
    }
    let files: Vec<File> = svg.into_iter().chain(csv).collect();
    Ok(Outcome {
        messages: write_all(&files)?,
        stdout: match arguments.json {
            true => to_json(&as_json(&map))?,
            false => as_text(&map),
        },
        ..Outcome::default()
    })
}

fn title(plan: &Plan) -> String {
    let what = |axis: &Axis| axis.quantity.title();
    match (plan.x.quantity, plan.y.quantity) {
        (Quantity::Offset, Quantity::Jitter) => {
            "Eye: where the sample may be, and how much jitter it stands".into()
        }
        (Quantity::Cable, Quantity::Clock) | (Quantity::Clock, Quantity::Cable) => {
            "Cable and clock: where every frame is good, and by what margin".into()
        }
        _ => format!(
            "Where every frame is good: {} over {}",
            what(&plan.y),
            what(&plan.x)
        ),
    }
}

fn plan(arguments: &ShmooArgs) -> Result<Plan, CommandError> {
    let widths = (*POSITION_BITS.start()).into()..=(*POSITION_BITS.end()).into();
    let system_clocks = SYSTEM_HZ_MIN..=SYSTEM_HZ_MAX;
    let system_hz = number("--system-hz", &arguments.system_hz, system_clocks)?;
    let bits = number("--bits", &arguments.bits, widths)? as u32;
    let command = match arguments.command {
        Command::SendPosition => ModeCommand::SendPosition,
        Command::SendPositionAddInfo => ModeCommand::SendPositionAddInfo,
    };
    let mut conditions = Conditions::new(system_hz, command, bits);
    conditions.receiver = ReceiverKind {
        phase: match arguments.phase.unwrap_or(PhaseArg::Tracked) {
            PhaseArg::Tracked => Phase::Tracked,
            PhaseArg::Frame => Phase::Frame,
            PhaseArg::Fixed => Phase::Fixed,
            PhaseArg::Step => Phase::Step,
        },
        double_edge: arguments.double_edge,
        majority: arguments.majority,
    };
    if conditions.receiver.majority && conditions.receiver.phase == Phase::Step {
        return Err(CommandError::input(
            "--phase = step: a channel without alignment has no --majority; leave that out, or choose another --phase",
        ));
    }
    let clocks = (system_hz, conditions.receiver);
    let mut set = vec![];
    for text in &arguments.at {
        let (quantity, value) = named("--at", text)?;
        if set.contains(&quantity) {
            return Err(CommandError::input(format!(
                "--at = {}: {} is set twice; leave one out",
                shown(text),
                quantity.name()
            )));
        }
        set.push(quantity);
        conditions.set(quantity, one("--at", text, quantity, value, clocks)?);
    }
    let offset = Quantity::Offset.name();
    let given = arguments.at.iter().map(|text| ("--at", text));
    let axes = [("--x", &arguments.x), ("--y", &arguments.y)];
    let given = given.chain(
        axes.iter()
            .filter_map(|(flag, t)| Some((*flag, t.as_ref()?))),
    );
    let mut moved = given.filter(|(_, text)| text.starts_with(offset));
    if let (Some((flag, text)), true) = (moved.next(), conditions.receiver.phase != Phase::Fixed) {
        return Err(CommandError::input(format!(
            "{flag} = {}: moves the sample, which only a phase from a register allows; add --phase fixed, or use eye",
            shown(text)
        )));
    }
    let (_, fastest) = Quantity::Clock.range(system_hz, conditions.receiver);
    let mut clocks_mhz: Vec<f64> = CLOCKS_MHZ.into_iter().collect();
    clocks_mhz.retain(|mhz| *mhz <= fastest);
    if clocks_mhz.is_empty() {
        // At a slow system clock.
        clocks_mhz.push(fastest);
    }
    let usual = |axis: &str| match axis {
        "--x" => Axis {
            quantity: Quantity::Cable,
            values: (0..=30).map(|i| 5.0 * f64::from(i)).collect(),
        },
        _ => Axis {
            quantity: Quantity::Clock,
            values: clocks_mhz.clone(),
        },
    };
    let axis = |flag: &str, text: &Option<String>| match text {
        Some(text) => axis(flag, text, clocks),
        None => Ok(usual(flag)),
    };
    let (x, y) = (axis("--x", &arguments.x)?, axis("--y", &arguments.y)?);
    if x.quantity == y.quantity {
        return Err(CommandError::input(format!(
            "--y = {}: is what --x has as well; give another quantity",
            x.quantity.name()
        )));
    }
    if let Some(quantity) = set.iter().find(|q| [x.quantity, y.quantity].contains(q)) {
        return Err(CommandError::input(format!(
            "--at = {}: is an axis; leave it out, or give another --x or --y",
            quantity.name()
        )));
    }
    let runs = number("--runs", &arguments.runs, 1..=1000)? as usize;
    let frames = number("--frames", &arguments.frames, 1..=FRAMES_MAX)? as usize;
    let plan = Plan {
        x,
        y,
        conditions,
        runs,
        frames,
        seed: number("--seed", &arguments.seed, 0..=u64::MAX)?,
    };
    let channels = plan.channels();
    if channels > CHANNELS_MAX {
        return Err(CommandError::input(format!(
            "--runs = {runs}: {channels} channels in all cells together, at most {CHANNELS_MAX}; make fewer, or fewer values of --x and --y"
        )));
    }
    Ok(plan)
}

/// How a quantity may be written with this option.
fn example(flag: &str, name: &str) -> String {
    let quantity = Quantity::ALL.into_iter().find(|q| q.name() == name);
    let (one, axis) = match quantity.unwrap_or(Quantity::Cable) {
        Quantity::Cable => ("50", "0:100:10"),
        Quantity::Clock => ("0.2", "0.1,0.2"),
        Quantity::Delay => ("100", "0:500:50"),
        Quantity::Jitter => ("20", "0:100:10"),
        Quantity::Distortion => ("10", "-50:50:10"),
        Quantity::Noise => ("10", "0:100:10"),
        Quantity::Filter => ("2", "0:4:1"),
        Quantity::Offset => ("10", "-40:40:10"),
    };
    format!("{name}={}", if flag == "--at" { one } else { axis })
}

/// A quantity and what stands behind its name.
fn named<'t>(flag: &str, text: &'t str) -> Result<(Quantity, &'t str), CommandError> {
    let (name, rest) = text.split_once('=').unwrap_or((text, ""));
    match Quantity::ALL.into_iter().find(|q| q.name() == name) {
        Some(quantity) if !rest.is_empty() => Ok((quantity, rest)),
        Some(_) => Err(CommandError::input(format!(
            "{flag} = {}: has no value; write, for example, {}",
            shown(text),
            example(flag, name)
        ))),
        None => Err(CommandError::input(format!(
            "{flag} = {}: begins with no quantity, as there are {}; write, for example, {}",
            shown(text),
            Quantity::ALL.map(Quantity::name).join(", "),
            example(flag, Quantity::Cable.name())
        ))),
    }
}

/// One value of a quantity.
fn one(
    flag: &str,
    text: &str,
    quantity: Quantity,
    value: &str,
    clocks: Clocks,
) -> Result<f64, CommandError> {
    let (low, high) = quantity.range(clocks.0, clocks.1);
    let fail = |what: String| {
        Err(CommandError::input(format!(
            "{flag} = {}: {what}",
            shown(text)
        )))
    };
    match value.trim().parse::<f64>() {
        // The limits of a clock are rounded where they are shown.
        Ok(value) if quantity == Quantity::Filter && value.fract() != 0.0 => fail(format!(
            "{value} is no whole number of cycles; give one from {} to {}",
            decimal(low, DECIMALS),
            decimal(high, DECIMALS)
        )),
        Ok(value) if value >= low - 1e-4 && value <= high + 1e-4 => Ok(value.clamp(low, high)),
        Ok(_) => fail(format!(
            "{} = {} is outside {}..{}; give a value in that range",
            quantity.name(),
            value.trim(),
            decimal(low, DECIMALS),
            decimal(high, DECIMALS)
        )),
        Err(_) => fail(format!(
            "{} is not a number; write 12.5, for example",
            shown(value)
        )),
    }
}

fn axis(flag: &str, text: &str, clocks: Clocks) -> Result<Axis, CommandError> {
    let (quantity, values) = named(flag, text)?;
    let one = |value: &str| one(flag, text, quantity, value, clocks);
    let fail = |what: &str| CommandError::input(format!("{flag} = {}: {what}", shown(text)));
    let many = format!("has more than {VALUES_MAX} values; make fewer");
    let parts: Vec<&str> = values.split(':').collect();
    let values: Vec<f64> = match parts[..] {
        [list] => list.split(',').map(one).collect::<Result<_, _>>()?,
        [from, to, step] => {
            let (from, to) = (one(from)?, one(to)?);
            let step: f64 = step.trim().parse().unwrap_or(0.0);
            if !(step.is_finite() && step > 0.0 && to > from) {
                return Err(fail(
                    "FROM:TO:STEP goes up in steps above 0; write 0:150:5, for example",
                ));
            }
            // What adding up leaves out of the last step does not lose it.
            let steps = ((to - from) / step + 1e-6).floor();
            if steps >= VALUES_MAX as f64 {
                return Err(fail(&many));
            }
            (0..=steps as u32)
                .map(|i| from + step * f64::from(i))
                .collect()
        }
        _ => {
            return Err(fail(
                "is neither FROM:TO:STEP nor a list A,B,...; write one of them",
            ))
        }
    };
    if values.len() < 2 {
        return Err(fail("has one value; give at least two, or use --at"));
    }
    if values.len() > VALUES_MAX {
        return Err(fail(&many));
    }
    if !values.windows(2).all(|pair| pair[0] < pair[1]) {
        return Err(fail(
            "does not go up from value to value; put them in order",
        ));
    }
    if quantity == Quantity::Clock {
        let cycles = |mhz: &f64| timing::period_cycles((mhz * 1e6).round() as u64, clocks.0);
        let same = values
            .windows(2)
            .find(|pair| cycles(&pair[0]) == cycles(&pair[1]));
        if let Some(pair) = same {
            return Err(fail(&format!(
                "{} and {} MHz are both {} cycles of the system clock; leave one out, or make --system-hz higher",
                decimal(pair[0], DECIMALS),
                decimal(pair[1], DECIMALS),
                cycles(&pair[0])
            )));
        }
    }
    Ok(Axis { quantity, values })
}

/// The map in letters, and what they mean.
fn as_text(map: &Map) -> String {
    let (x, y) = (&map.plan.x, &map.plan.y);
    let labels: Vec<String> = y.values.iter().map(|v| decimal(*v, DECIMALS)).collect();
    let room = labels.iter().map(String::len).max().unwrap_or(0);
    let mut text = format!("{}\n", y.quantity.name());
    for (row, label) in labels.iter().enumerate().rev() {
        let letter = |column: usize| match map.cell(column, row).margin() {
            // Tenths of a bit, 0 to 5.
            Some(margin) => ((10.0 * margin) as usize).min(5).to_string(),
            None => map.cell(column, row).fate().letter().to_string(),
        };
        let cells: String = (0..x.values.len()).map(letter).collect();
        let _ = writeln!(text, "{label:>room$} |{cells}");
    }
    let (first, last) = (x.values[0], x.values[x.values.len() - 1]);
    let _ = writeln!(
        text,
        "{:>room$} +{}\n{:>room$}  {} = {} to {}",
        "",
        "-".repeat(x.values.len()),
        "",
        x.quantity.name(),
        decimal(first, DECIMALS),
        decimal(last, DECIMALS)
    );
    let _ = writeln!(
        text,
        "{} of {} cells with every frame good; a digit is the margin of its worst sample in tenths of a bit (5 = in the middle)",
        map.passed(),
        map.cells.len()
    );
    for fate in Fate::ALL.into_iter().filter(|f| *f != Fate::Good) {
        let count = map.count(fate);
        if count > 0 {
            let _ = writeln!(text, "{} = {} ({count} cells)", fate.letter(), fate.title());
        }
    }
    text
}

fn as_json(map: &Map) -> serde_json::Value {
    let (x, y) = (&map.plan.x, &map.plan.y);
    let cells = map.cells.iter().map(|cell| {
        let counts = Fate::ALL.map(|fate| (fate.column().to_owned(), json!(cell.count(fate))));
        json!({
            "fate": cell.fate().column(),
            "margin": cell.margin(),
            "frames": serde_json::Map::from_iter(counts),
        })
    });
    json!({
        "x": {"name": x.quantity.name(), "values": x.values},
        "y": {"name": y.quantity.name(), "values": y.values},
        "passed": map.passed(),
        "cells": cells.collect::<Vec<_>>(),
    })
}
