//! `monitor`: positions, rate, health and margin, live: a screen of its own on a terminal, lines elsewhere.

mod full;
mod look;
mod screen;
mod text;

use crate::port::{scales, settled, AnyCard, RangedPort};
use clap::Args;
use endat_console::error::CommandError;
use endat_console::number::{decimal_if, number_if};
use endat_host::units::Scale;
use endat_terminal::outcome::Outcome;
use endat_terminal::work::interrupted;
use look::Watcher;
use serde_json::json;
use std::io::{IsTerminal, Write};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Arguments of `monitor`.
#[derive(Args)]
pub struct MonitorArgs {
    #[command(flatten)]
    port: RangedPort,
    /// Show so many times [default: until q or Ctrl-C]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    count: Option<String>,
    /// Seconds from one to the next [default: 0.2]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    every: Option<String>,
    /// Lines, on a terminal, too
    #[arg(long)]
    plain: bool,
    /// A line of JSON for each look
    #[arg(long, conflicts_with = "plain")]
    json: bool,
}

/// How often, and how many times.
#[derive(Clone, Copy)]
struct Pace {
    every: Duration,
    count: Option<u64>,
}

/// A card that answers, and what is known of it.
struct Opened {
    card: AnyCard,
    scales: Vec<Scale>,
    watcher: Watcher,
}

impl Opened {
    fn new(port: &RangedPort) -> Result<Self, CommandError> {
        let mut card = port.open()?;
        settled(&mut card)?;
        let scales = scales(&mut card)?;
        let watcher = Watcher::new(&card)?;
        Ok(Self {
            card,
            scales,
            watcher,
        })
    }
}

/// Runs the command.
pub fn run(arguments: &MonitorArgs) -> Result<Outcome, CommandError> {
    let count = number_if("--count", &arguments.count, 1..=u64::from(u32::MAX))?;
    let every = decimal_if("--every", &arguments.every, 0.0..=3_600.0)?;
    let every = Duration::from_secs_f64(every.unwrap_or(0.2));
    let pace = Pace { every, count };
    let is_dumb = std::env::var_os("TERM").is_none_or(|term| term == "dumb");
    let is_full = std::io::stdout().is_terminal() && !is_dumb;
    match is_full && !arguments.plain && !arguments.json {
        true => full::run(&arguments.port, pace),
        false => in_lines(arguments, pace),
    }
}

fn in_lines(arguments: &MonitorArgs, pace: Pace) -> Result<Outcome, CommandError> {
    let Opened {
        mut card,
        scales,
        mut watcher,
    } = Opened::new(&arguments.port)?;
    let stop = interrupted();
    let mut stdout = std::io::stdout();
    let mut done = 0;
    while !stop.load(Ordering::Relaxed) && pace.count != Some(done) {
        let begin = Instant::now();
        let text = match (watcher.look(&mut card), arguments.json) {
            (Ok(look), false) => text::lines(&look, &scales) + "\n",
            (Ok(look), true) => format!("{}\n", look.json(&scales)),
            // A card that is unplugged may come back.
            (Err(error @ CommandError::CheckFailed(_)), false) => format!("{error}\n\n"),
            (Err(error @ CommandError::CheckFailed(_)), true) => {
                format!("{}\n", json!({"error": error.to_string()}))
            }
            (Err(error), _) => return Err(error),
        };
        let written = stdout.write_all(text.as_bytes());
        if written.and_then(|()| stdout.flush()).is_err() {
            break;
        }
        done += 1;
        if pace.count != Some(done) {
            std::thread::sleep(pace.every.saturating_sub(begin.elapsed()));
        }
    }
    Ok(Outcome::default())
}
