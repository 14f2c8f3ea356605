//! `stats`: figures of a recording.

use crate::recorded::FileArgs;
use clap::Args;
use endat_console::error::CommandError;
use endat_console::number::number_if;
use endat_recording::read::Found;
use endat_recording::stats::{Stats, Track};
use endat_terminal::outcome::{to_json, Outcome};
use serde_json::{json, Value};
use std::fmt::Write;

/// Arguments of `stats`.
#[derive(Args)]
pub struct StatsArgs {
    #[command(flatten)]
    files: FileArgs,
    /// Noise is the deviation about parabolas through so many rows each [default: 100]
    #[arg(long, value_name = "ROWS", allow_negative_numbers = true)]
    window: Option<String>,
    /// Rows were left out on purpose, by `log --every` or `--on-cause`, and the text does not say so
    #[arg(long)]
    sparse: bool,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Rows of a window: 10 ms at 10 kHz, in which a shaft's acceleration is even.
const WINDOW: u64 = 100;
/// Width of the longest bar.
const BAR: u64 = 40;

/// Runs the command.
pub fn run(arguments: &StatsArgs) -> Result<Outcome, CommandError> {
    let window =
        number_if("--window", &arguments.window, 4..=1_000_000)?.unwrap_or(WINDOW) as usize;
    let mut stats = None;
    let found = arguments.files.read(arguments.sparse, &mut |head, row| {
        stats
            .get_or_insert_with(|| Stats::new(head, window))
            .push(row);
    })?;
    let stats = stats.unwrap_or_else(|| Stats::new(&found.head, window));
    let stdout = match arguments.json {
        true => to_json(&as_json(&stats, &found, window))?,
        false => as_text(&stats, &found, window),
    };
    let mut messages = found.notes;
    messages.extend(found.misfits.told());
    let unknown = stats.channels.iter().filter_map(|c| c.unknown.as_ref());
    messages.extend(unknown.map(|why| format!("drift, noise: {why}")));
    Ok(Outcome {
        stdout,
        messages,
        exit_code: u8::from(found.misfits.rows > 0),
    })
}

fn track_json(track: &Track) -> Value {
    let bins = track.histogram.bins();
    let bins = bins.iter().map(|(middle, count)| json!([middle, count]));
    json!({
        "unit": track.unit,
        "values": track.count,
        "least": track.range.map(|r| r.0),
        "greatest": track.range.map(|r| r.1),
        "first": track.ends.map(|e| e.0),
        "last": track.ends.map(|e| e.1),
        "noise": track.noise().map(|n| n.0),
        "noise_worst_window": track.noise().map(|n| n.1),
        "drift_per_s": track.drift_per_s(),
        "histogram": bins.collect::<Vec<_>>(),
    })
}

fn as_json(stats: &Stats, found: &Found, window: usize) -> Value {
    let head = &found.head;
    let channels = stats.channels.iter().map(|channel| {
        let mut object = track_json(&channel.track);
        object["bad"] = json!(channel.tally.bad_rows());
        object["causes"] = json!(channel.tally.bad);
        object["beside"] = json!(channel.tally.beside);
        object["step"] = json!(channel.step);
        object["unknown"] = json!(channel.unknown);
        object
    });
    let derived = stats.derived.iter().map(|track| {
        let mut object = track_json(track);
        object["name"] = json!(track.name);
        object
    });
    let rates = stats.rates_hz();
    json!({
        "rows": stats.rows,
        "every": head.every(),
        "duration_s": stats.duration_s(),
        "start_time": head.about["start_time"],
        "trigger_hz": rates.and_then(|r| r.0),
        "row_hz": rates.map(|r| r.1),
        "missing": stats.missing,
        "gaps": stats.gaps,
        "bad_rows": stats.bad_rows,
        "misfits": found.misfits.rows,
        "unaccounted_triggers": found.misfits.triggers,
        "window_rows": window,
        "channels": channels.collect::<Vec<_>>(),
        "derived": derived.collect::<Vec<_>>(),
    })
}

/// A number with six digits that count.
fn figure(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || (1e-3..1e7).contains(&size) {
        let digits = (5.0 - size.max(1e-9).log10().floor()).clamp(0.0, 9.0) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.5e}")
    }
}

fn track_text(text: &mut String, track: &Track, step: Option<f64>, is_counted: bool) {
    let unit = &track.unit;
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<18}{value}");
    };
    line("values", track.count.to_string());
    let (Some((low, high)), Some((first, last))) = (track.range, track.ends) else {
        return;
    };
    line(
        "range",
        format!("{} to {} {unit}", figure(low), figure(high)),
    );
    line(
        "first, last",
        format!("{}, {} {unit}", figure(first), figure(last)),
    );
    if !is_counted {
        line("drift, noise", "not known: see --range".into());
        return;
    }
    if let Some(drift) = track.drift_per_s() {
        line("drift", format!("{} {unit}/s", figure(drift)));
    }
    let Some((noise, worst)) = track.noise() else {
        line("noise", "no whole window of good rows".into());
        return;
    };
    let steps = step.map_or(String::new(), |s| {
        format!(", {:.2} measuring steps", noise / s)
    });
    line("noise", format!("{} {unit} rms{steps}", figure(noise)));
    line("worst window", format!("{} {unit} rms", figure(worst)));
    let bins = track.histogram.bins();
    let most = bins.iter().map(|b| b.1).max().unwrap_or(1).max(1);
    for (middle, count) in bins {
        // One of millions is seen, too.
        let bar = (count * BAR).div_ceil(most) as usize;
        let _ = writeln!(
            text,
            "  {:>16} {count:>10} {}",
            figure(middle),
            "#".repeat(bar)
        );
    }
}

fn as_text(stats: &Stats, found: &Found, window: usize) -> String {
    let (head, misfits) = (&found.head, &found.misfits);
    let mut text = format!("rows                {}\n", stats.rows);
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<20}{value}");
    };
    if head.every() > 1 {
        line(
            "kept",
            format!("one of {} rows, and every one with a fault", head.every()),
        );
    }
    if let Some(start) = head.about["start_time"].as_str() {
        line("begun", start.to_owned());
    }
    line("duration", format!("{} s", figure(stats.duration_s())));
    if let Some((triggers, rows)) = stats.rates_hz() {
        let triggers = triggers.map_or(String::new(), |hz| format!("{} triggers/s, ", figure(hz)));
        line("rate", format!("{triggers}{} rows/s", figure(rows)));
    }
    line(
        "missing",
        format!("{} triggers, {} times", stats.missing, stats.gaps),
    );
    if misfits.rows > 0 {
        line(
            "do not fit",
            format!(
                "{} rows; {} triggers are neither rows nor missing",
                misfits.rows, misfits.triggers
            ),
        );
    }
    let percent = stats.bad_rows as f64 * 100.0 / stats.rows.max(1) as f64;
    // Rows that were left out were good, and count nowhere.
    let of = if head.every() > 1 {
        " of the rows that were kept"
    } else {
        ""
    };
    line(
        "bad rows",
        format!("{} ({percent:.3} %{of})", stats.bad_rows),
    );
    line(
        "noise",
        format!("deviation about parabolas through {window} rows each"),
    );
    for channel in &stats.channels {
        let _ = writeln!(text, "\n{}", channel.track.name);
        let _ = writeln!(text, "  {:<18}{}", "bad", channel.tally.bad_rows());
        for (cause, count) in &channel.tally.bad {
            let _ = writeln!(text, "    {cause:<16}{count}");
        }
        if !channel.tally.beside.is_empty() {
            let _ = writeln!(text, "  beside good ones");
        }
        for (cause, count) in &channel.tally.beside {
            let _ = writeln!(text, "    {cause:<16}{count}");
        }
        let is_counted = channel.unknown.is_none();
        track_text(&mut text, &channel.track, channel.step, is_counted);
    }
    for track in &stats.derived {
        let _ = writeln!(text, "\n{}", track.name);
        track_text(&mut text, track, None, true);
    }
    text
}
