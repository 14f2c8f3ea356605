//! `log`: sample sets into a file, as CSV or JSON lines.

pub mod count;
pub mod sheet;

use super::super::number::{decimal_if, number_if};
use super::super::pictures::{check_all, folder, write_all, File};
use super::super::Outcome;
use super::{interrupted, settled, told, AnyCard, PortArgs};
use crate::error::GenError;
use clap::Args;
use count::{Count, Judge};
use endat_host::feed::Feed;
use endat_host::transport::LinkState;
use endat_host::{HostError, Transport};
use endat_regs::Part;
use endat_sim::diagram::{is_drawing, series_svg};
use sheet::{Format, Lines, Sheet};
use std::collections::VecDeque;
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Arguments of `log`.
#[derive(Args)]
pub struct LogArgs {
    #[command(flatten)]
    port: PortArgs,
    /// Stop after so many sample sets [default: until Ctrl-C]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    samples: Option<String>,
    /// Stop after so many seconds
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seconds: Option<String>,
    /// Write into this file [default: to stdout]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace the file if it is there
    #[arg(long, requires = "out")]
    force: bool,
    /// Draw the positions over time, at the end
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Form of the file
    #[arg(long, value_enum, default_value = "csv")]
    format: Format,
    /// Read results one after the other, even if the card can stream
    #[arg(long)]
    poll: bool,
    /// Exit with 1 if more than this share of the rows is bad, in per cent [default: 1]
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true)]
    bad_max: Option<String>,
}

/// Bad rows that are still a good run, in per cent: a plug that is moved, not a wrong configuration.
const BAD_MAX_PERCENT: f64 = 1.0;

/// How long an empty stream is waited for before the end is looked for again.
const SLICE: Duration = Duration::from_millis(100);
/// Nothing for this long: something is wrong.
const SILENCE: Duration = Duration::from_secs(20);
/// Between two lines of progress.
const PROGRESS: Duration = Duration::from_secs(2);

/// When to stop.
struct End {
    samples: Option<u64>,
    seconds: Option<u64>,
}

/// Runs the command.
pub fn run(arguments: &LogArgs) -> Result<Outcome, GenError> {
    let limit = |flag, text| number_if(flag, text, 1..=u64::from(u32::MAX));
    let end = End {
        samples: limit("--samples", &arguments.samples)?,
        seconds: limit("--seconds", &arguments.seconds)?,
    };
    let bad_max = decimal_if("--bad-max", &arguments.bad_max, 0.0..=100.0)?;
    let bad_max = bad_max.unwrap_or(BAD_MAX_PERCENT);
    let mut drawing = arguments.svg.clone().map(|path| File {
        option: "--svg",
        path,
        text: String::new(),
        is_ours: is_drawing,
    });
    let rows = arguments.out.clone().map(|path| File {
        option: "--out",
        path,
        text: String::new(),
        // What may be replaced is for --force to say.
        is_ours: |_| true,
    });
    // Refused before the first sample, not after the last.
    check_all(&rows.iter().chain(&drawing).collect::<Vec<_>>())?;
    let mut card = arguments.port.open()?;
    settled(&mut card)?;
    let remedy = format!(
        "as with `endat-gen reg write card_config.trigger_sources.timer 1 --port {}`",
        arguments.port.name()
    );
    card.needs_trigger(&remedy).map_err(told)?;
    let scales = card.scales().map_err(told)?;
    let (out, name) = open(arguments)?;
    let failed =
        |e: io::Error| GenError::input(format!("{name}: cannot write: {e}; is the disk full?"));
    let system_hz = f64::from(card.identity().system_hz.max(1));
    let additional_data = card.identity().stream_additional_data;
    let mut sheet =
        Sheet::new(arguments.format, out, scales, system_hz, additional_data).map_err(failed)?;
    let judge = Judge {
        own_triggers: card.identity().has(Part::OwnTrigger),
    };
    if drawing.is_some() {
        sheet.keep(judge);
    }
    let mut feed = Feed::begin(&mut card, arguments.poll).map_err(told)?;
    let stop = interrupted();
    let mut count = Count::new(judge);
    let mut progress = Progress::new(end.samples);
    let result = record(
        &mut card,
        &mut feed,
        &mut sheet,
        (&mut count, &mut progress),
        &end,
        &stop,
    );
    progress.clear();
    // Whatever ended it: the card is quiet again, the file whole, and what was measured is told and drawn.
    let (is_stream, lost_in_card) = (feed.streams(), feed.lost_in_card());
    let calm = feed.end(&mut card);
    let flushed = sheet.out.flush();
    let head = format!(
        "{name}: {} sample sets in {:.3} s of the card's time",
        count.rows, sheet.span_s
    );
    let lost = is_stream.then(|| (lost_in_card, card.bridge().decoder().damaged()));
    let text = head + &missing(count.missing, lost);
    let mut messages = vec![format!("{text}; {}", count.told())];
    let is_bad = count.bad_percent() > bad_max;
    if is_bad {
        messages.push(format!(
            "bad rows = {:.1} %: more than {bad_max} %; `endat-gen explain CAUSE` tells what helps, `endat-gen read` why triggers are not taken; --bad-max allows more",
            count.bad_percent()
        ));
    }
    let mut exit_code = u8::from(is_bad || is_stream && count.missing > 0);
    let mut fail = |error: GenError, messages: &mut Vec<String>| {
        exit_code = exit_code.max(error.exit_code());
        messages.extend_from_slice(error.messages());
    };
    // Before the drawing: on a full disk neither can be written, and the rows are what was asked for.
    match result.and(flushed.map_err(Failure::Write)) {
        // A reader that has gone away (`| head`) is the end, not an error.
        Err(Failure::Write(e)) if e.kind() == io::ErrorKind::BrokenPipe => messages.clear(),
        Err(Failure::Write(e)) => fail(failed(e), &mut messages),
        Err(Failure::Card(e)) => fail(e, &mut messages),
        Ok(()) => {
            if let Err(error) = calm {
                fail(told(error), &mut messages);
            }
        }
    }
    if let (Some(file), Some(plot)) = (&mut drawing, &sheet.plot) {
        let subtitle = format!(
            "{} sample sets, {} triggers missing, {}",
            count.rows,
            count.missing,
            count.told()
        );
        let title = format!("Positions of {}", arguments.port.name());
        file.text = series_svg(plot, &title, &subtitle);
        match write_all(&drawing.into_iter().collect::<Vec<_>>()) {
            Ok(written) => messages.extend(written),
            Err(error) => fail(error, &mut messages),
        }
    }
    Ok(Outcome {
        messages,
        exit_code,
        ..Outcome::default()
    })
}

/// Where the rows go, and what that is called.
fn open(arguments: &LogArgs) -> Result<(Box<dyn Write>, String), GenError> {
    Ok(match &arguments.out {
        None => (Box::new(Lines::to(Box::new(io::stdout()))), "stdout".into()),
        Some(path) => {
            let mut options = fs::File::options();
            options.write(true);
            // Nothing is lost on a device.
            let is_device = fs::metadata(path).is_ok_and(|m| !m.is_file());
            let options = match arguments.force {
                _ if is_device => &mut options,
                true => options.create(true).truncate(true),
                false => options.create_new(true),
            };
            let file = fs::create_dir_all(folder(path)).and_then(|()| options.open(path));
            let file = file.map_err(|e| match e.kind() {
                io::ErrorKind::AlreadyExists => GenError::input(format!(
                    "--out = {}: is there already; give another file with --out, or replace it with --force",
                    path.display()
                )),
                _ => GenError::io("write", path, &e, "give another file with --out"),
            })?;
            (Box::new(Lines::file(file)), path.display().to_string())
        }
    })
}

/// What is missing among the rows; a stream knows what was dropped in the card and what was damaged.
fn missing(count: u64, stream: Option<(u64, u64)>) -> String {
    match stream {
        Some((lost_in_card, damaged)) => format!(
            "; {count} triggers missing, {lost_in_card} of them dropped in the card; {damaged} frames damaged on the line"
        ),
        None => format!(
            "; read one by one: {count} results in between not read (a card with [stream] gives them all)"
        ),
    }
}

/// Lines of progress: one that is written over on a terminal, one after the other in a file.
struct Progress {
    of: Option<u64>,
    is_terminal: bool,
    shown: Instant,
    is_there: bool,
}

impl Progress {
    fn new(of: Option<u64>) -> Self {
        Self {
            of,
            is_terminal: io::stderr().is_terminal(),
            shown: Instant::now(),
            is_there: false,
        }
    }

    fn show(&mut self, rows: u64) {
        let is_wanted = self.is_terminal || self.of.is_some();
        if !is_wanted || self.shown.elapsed() < PROGRESS {
            return;
        }
        self.shown = Instant::now();
        self.is_there = true;
        let text = self.text(rows);
        let _ = io::stderr().write_all(text.as_bytes());
    }

    fn text(&self, rows: u64) -> String {
        let of = self.of.map_or(String::new(), |n| format!(" of {n}"));
        match self.is_terminal {
            true => format!("\r{rows}{of} sample sets\x1b[K"),
            false => format!("{rows}{of} sample sets\n"),
        }
    }

    /// What comes next begins a line.
    fn clear(&self) {
        if self.is_terminal && self.is_there {
            let _ = io::stderr().write_all(b"\r\x1b[K");
        }
    }
}

enum Failure {
    Card(GenError),
    Write(io::Error),
}

/// Says so when the link is lost, and when it is back.
struct Watch {
    last: LinkState,
}

impl Watch {
    /// What is to be told of the link, as it is now.
    fn news(&mut self, now: LinkState) -> Vec<String> {
        let before = std::mem::replace(&mut self.last, now);
        let is_lost = before.is_open && (!now.is_open || now.reopened > before.reopened);
        let is_back = now.is_open && now.reopened > before.reopened;
        let lost = format!("connection lost, trying for {} s", SILENCE.as_secs());
        let back = "connection is back".to_owned();
        let both = [(is_lost, lost), (is_back, back)];
        both.into_iter()
            .filter_map(|(is_so, text)| is_so.then_some(text))
            .collect()
    }
}

/// A card that does not answer may do so again; one that is another one ends the log.
fn still(filled: Result<(), HostError>, rows: u64) -> Result<(), Failure> {
    match filled {
        Ok(()) | Err(HostError::Silent { .. }) => Ok(()),
        Err(HostError::Refused(text)) => Err(Failure::Card(GenError::CheckFailed(vec![format!(
            "{text}; this was after {rows} sample sets, which are in the file; begin another log"
        )]))),
        Err(error) => Err(Failure::Card(told(error))),
    }
}

fn record<W: Write>(
    card: &mut AnyCard,
    feed: &mut Feed,
    sheet: &mut Sheet<W>,
    (count, progress): (&mut Count, &mut Progress),
    end: &End,
    stop: &AtomicBool,
) -> Result<(), Failure> {
    let begin = Instant::now();
    let (mut heard, mut flushed) = (begin, begin);
    let mut rows = VecDeque::new();
    let mut watch = Watch {
        last: card.bridge().transport().state(),
    };
    loop {
        let filled = feed.fill(card, &mut rows, SLICE);
        for text in watch.news(card.bridge().transport().state()) {
            progress.clear();
            let _ = writeln!(io::stderr(), "endat-gen: {text}");
        }
        still(filled, count.rows)?;
        if !rows.is_empty() {
            heard = Instant::now();
        }
        while let Some(row) = rows.pop_front() {
            sheet.row(&row).map_err(Failure::Write)?;
            count.note(&row);
            if end.samples == Some(count.rows) {
                return Ok(());
            }
        }
        let is_over = end
            .seconds
            .is_some_and(|s| begin.elapsed() >= Duration::from_secs(s));
        if is_over || stop.load(Ordering::Relaxed) {
            return Ok(());
        }
        if heard.elapsed() > SILENCE {
            let why = match watch.last.is_open {
                true => "is a trigger enabled (`endat-gen reg read card_config`), is the card plugged in?",
                false => "the connection is lost; is the card plugged in?",
            };
            return Err(Failure::Card(GenError::CheckFailed(vec![format!(
                "no sample for {} s; {why} {} sets are in the file",
                SILENCE.as_secs(),
                count.rows
            )])));
        }
        if flushed.elapsed() >= Duration::from_secs(1) {
            flushed = Instant::now();
            sheet.out.flush().map_err(Failure::Write)?;
        }
        progress.show(count.rows);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_stays_on_one_line_of_a_terminal() {
        let mut progress = Progress::new(Some(9));
        progress.is_terminal = true;
        assert_eq!(progress.text(5), "\r5 of 9 sample sets\x1b[K");
        progress.is_terminal = false;
        assert_eq!(progress.text(5), "5 of 9 sample sets\n");
    }

    #[test]
    fn a_lost_link_is_told_once_and_so_is_its_return() {
        let mut watch = Watch {
            last: LinkState::default(),
        };
        let mut told = |is_open, reopened| watch.news(LinkState { is_open, reopened });
        assert_eq!(told(true, 0), [""; 0]);
        assert_eq!(told(false, 0), ["connection lost, trying for 20 s"]);
        assert_eq!(told(false, 0), [""; 0]);
        assert_eq!(told(true, 1), ["connection is back"]);
        // Lost and back between two looks.
        assert_eq!(told(true, 2).len(), 2);
        assert_eq!(told(true, 2), [""; 0]);
    }
}
