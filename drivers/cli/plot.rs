//! `plot`: a recording as a drawing.

use crate::recorded::FileArgs;
use clap::Args;
use endat_console::error::CommandError;
use endat_console::number::decimal_if;
use endat_draw::is_drawing;
use endat_recording::picture::{Extras, Picture};
use endat_terminal::files::{check_all, write_all, File};
use endat_terminal::outcome::Outcome;
use std::path::PathBuf;

/// Arguments of `plot`.
#[derive(Args)]
pub struct PlotArgs {
    #[command(flatten)]
    files: FileArgs,
    /// Write the drawing into this file, which ends in .svg [default: the name of the recording, with .svg]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Draw channel 0 minus channel 1, too
    #[arg(long)]
    difference: bool,
    /// Draw how fast each channel moves, too
    #[arg(long)]
    velocity: bool,
    /// Begin at this time of the recording, in seconds
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    from: Option<String>,
    /// End at this time
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    to: Option<String>,
}

/// What drawings end in.
const SUFFIX: &str = "svg";
/// Longest recording: a time beyond is a slip.
const SECONDS_MAX: f64 = 1e9;

/// Runs the command.
pub fn run(arguments: &PlotArgs) -> Result<Outcome, CommandError> {
    let from = decimal_if("--from", &arguments.from, 0.0..=SECONDS_MAX)?.unwrap_or(0.0);
    let to = decimal_if("--to", &arguments.to, 0.0..=SECONDS_MAX)?.unwrap_or(f64::INFINITY);
    if to <= from {
        return Err(CommandError::input(format!(
            "--to = {to}: is not behind --from = {from}; give a later time"
        )));
    }
    let path = arguments.out.clone();
    let path = path.unwrap_or_else(|| arguments.files.files[0].with_extension(SUFFIX));
    let is_drawing_name = path
        .extension()
        .is_some_and(|s| s.eq_ignore_ascii_case(SUFFIX));
    if !is_drawing_name {
        return Err(CommandError::input(format!(
            "--out = {}: is no name of a drawing, which is SVG; give one that ends in .{SUFFIX} (any browser shows it, Inkscape and others make PNG or PDF of it)",
            path.display()
        )));
    }
    let mut file = File {
        option: "--out",
        path,
        text: String::new(),
        is_ours: is_drawing,
    };
    // Before an hour is read.
    check_all(&[&file])?;
    let extras = Extras {
        difference: arguments.difference,
        velocity: arguments.velocity,
    };
    let mut picture = None;
    let (mut rows, mut missing) = (0u64, 0u64);
    let found = arguments.files.read(false, &mut |head, row| {
        let new = || Picture::new(&head.units, &head.derived, head.judge(), extras);
        let picture = picture.get_or_insert_with(new);
        if (from..=to).contains(&row.time_s) {
            rows += 1;
            missing += row.missing;
            picture.push(row);
        }
    })?;
    let needed = match (arguments.velocity, arguments.difference) {
        (true, _) => found.head.units.len(),
        (_, true) => 2.min(found.head.units.len()),
        _ => 0,
    };
    if let Some(why) = (0..needed).find_map(|n| found.head.unknown(n)) {
        let flag = if arguments.velocity {
            "velocity"
        } else {
            "difference"
        };
        return Err(CommandError::input(format!(
            "--{flag}: {why}, or leave it out"
        )));
    }
    let Some(picture) = picture.filter(|_| rows > 0) else {
        return Err(CommandError::input(format!(
            "--from = {from}, --to = {to}: there are no rows between; give other times"
        )));
    };
    if arguments.difference && !picture.has_difference() {
        return Err(CommandError::input(
            "--difference: takes two channels of one unit, which this recording has not; leave it out",
        ));
    }
    let head = &found.head;
    let of = match head.every() {
        1 => String::new(),
        every => format!(", one of {every} rows and every one with a fault"),
    };
    let start = head.about["start_time"].as_str();
    let begun = start.map_or(String::new(), |start| format!(", begun {start}"));
    let subtitle = format!("{rows} rows{of}, {missing} triggers missing{begun}");
    file.text = picture.svg(&arguments.files.names(), &subtitle);
    let mut messages = found.notes;
    messages.extend(found.misfits.told());
    messages.extend(write_all(&[file])?);
    Ok(Outcome {
        messages,
        ..Outcome::default()
    })
}
