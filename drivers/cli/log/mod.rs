//! `log`: sample sets into files, as CSV, JSON lines or Parquet.

mod options;
mod progress;

use crate::port::{needs_trigger, patiently, place, settled, told, AnyCard};
use endat_console::error::CommandError;
use endat_console::number::{decimal_if, number_if};
use endat_draw::is_drawing;
use endat_host::feed::{Feed, Row};
use endat_host::{HostError, Transport};
use endat_recording::count::{Count, Judge};
use endat_recording::picture::Picture;
use endat_recording::recorder::Recorder;
use endat_recording::resume;
use endat_recording::sheet::Format;
use endat_regs::Part;
use endat_terminal::files::{check_all, folder, write_all, File};
use endat_terminal::outcome::Outcome;
use endat_terminal::work::interrupted;
use endat_terminal::work::{say, Progress};
pub use options::LogArgs;
use progress::{Watch, SILENCE};
use std::collections::VecDeque;
use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{channel, Receiver, RecvTimeoutError, Sender};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

/// Bad rows that are still a good run, in per cent: a plug that is moved, not a wrong configuration.
const BAD_MAX_PERCENT: f64 = 1.0;

/// How long an empty stream is waited for before the end is looked for again.
const SLICE: Duration = Duration::from_millis(100);
/// Rows stand in a file after so long at most.
const FLUSH: Duration = Duration::from_secs(1);
/// A card whose timer runs, and that is silent for so long, has stopped.
const STOPPED: Duration = Duration::from_secs(2);

/// When to stop.
struct End {
    samples: Option<u64>,
    seconds: Option<u64>,
    /// Rows go to the terminal, where a bar would be among them.
    is_quiet: bool,
}

impl End {
    fn progress(&self) -> Progress {
        match (self.is_quiet, self.samples, self.seconds) {
            (true, ..) => Progress::quiet("sample sets"),
            (_, None, Some(seconds)) => Progress::new(Some(seconds), "s"),
            (_, samples, _) => Progress::new(samples, "sample sets"),
        }
    }
}

/// Runs the command.
pub fn run(arguments: &LogArgs) -> Result<Outcome, CommandError> {
    let limit = |flag, text| number_if(flag, text, 1..=u64::from(u32::MAX));
    let end = End {
        samples: limit("--samples", &arguments.samples)?,
        seconds: limit("--seconds", &arguments.seconds)?,
        is_quiet: arguments.out.is_none() && io::stdout().is_terminal(),
    };
    let bad_max = decimal_if("--bad-max", &arguments.bad_max, 0.0..=100.0)?;
    let bad_max = bad_max.unwrap_or(BAD_MAX_PERCENT);
    let checked = arguments.checked()?;
    let drawing = arguments.svg.clone().map(|path| File {
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
    needs_trigger(&mut card, &arguments.port)?;
    let judge = Judge {
        own_triggers: card.identity().has(Part::OwnTrigger),
    };
    let wishes = arguments.wishes(checked, &mut card, judge)?;
    let says_when = wishes.about_in_text || wishes.format == Format::Parquet;
    resume::check(&wishes.target, &wishes.layout, says_when)?
        .iter()
        .for_each(|text| say(text));
    let made = arguments.out.as_deref().map(folder).filter(|f| !f.exists());
    let recorder = Recorder::begin(wishes)?;
    if let Some(folder) = made.filter(|f| f.exists()) {
        say(&format!(
            "--out: the folder {} has been made",
            folder.display()
        ));
    }
    let timer = place(&card, "card_config.trigger_sources.timer")?;
    let has_timer = card.read(&timer).map_err(told)? == 1;
    let begin = || Feed::begin(&mut card, arguments.poll).map_err(told);
    let mut feed = patiently(arguments.port.name(), begin)?;
    let mut count = Count::new(judge);
    let (result, recorder) = record(&mut card, &mut feed, recorder, &mut count, &end);
    // Whatever ended it: the card is quiet again, the file whole, and what was measured is told and drawn.
    let is_stream = feed.streams();
    let lost = is_stream.then(|| (feed.lost_in_card(), card.bridge().decoder().damaged()));
    let calm = feed.end(&mut card);
    let mut messages = vec![format!(
        "{}{}; {}",
        head(&recorder, &count),
        missing(count.missing, lost),
        count.told()
    )];
    let is_bad = count.bad_percent() > bad_max;
    if is_bad {
        messages.push(format!(
            "bad rows = {:.1} %: more than {bad_max} %; `endat explain CAUSE` tells what helps, `endat read` why triggers are not taken; --bad-max allows more",
            count.bad_percent()
        ));
    }
    // What comes by itself had stopped.
    let silent = result.as_ref().ok().copied();
    let stopped = silent.filter(|silent| has_timer && *silent > STOPPED);
    if let Some(silent) = stopped {
        messages.push(format!(
            "nothing came for the last {:.1} s: triggers of that time are not counted as missing; is the card plugged in, is its timer still enabled?",
            silent.as_secs_f64()
        ));
    }
    let known = messages.len();
    messages.extend(recorder.impossible());
    let is_impossible = messages.len() > known;
    let mut exit_code =
        u8::from(is_impossible || is_bad || is_stream && count.missing > 0 || stopped.is_some());
    let mut fail = |error: CommandError, messages: &mut Vec<String>| {
        exit_code = exit_code.max(error.exit_code());
        messages.extend_from_slice(error.messages());
    };
    // Before the drawing: on a full disk neither can be written, and the rows are what was asked for.
    match result {
        // A reader that has gone away (`| head`) is the end, not an error.
        Err(Failure::Write(e)) if e.kind() == io::ErrorKind::BrokenPipe => messages.clear(),
        Err(Failure::Write(e)) => {
            let why = match e.kind() {
                io::ErrorKind::FileTooLarge => "a file of this size is not allowed (ulimit -f); raise the limit, or begin files that are smaller with --file-mb".into(),
                _ => format!("{e}; is the disk full?"),
            };
            let text = format!("{}: cannot write: {why}", recorder.name());
            fail(CommandError::input(text), &mut messages);
        }
        Err(Failure::Card(e)) => fail(e, &mut messages),
        Ok(_) => {
            if let Err(error) = calm {
                fail(told(error), &mut messages);
            }
        }
    }
    if let (Some(mut file), Some(picture)) = (drawing, recorder.picture()) {
        file.text = drawn(picture, &count, arguments.port.name());
        match write_all(&[file]) {
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

/// The drawing with its title.
fn drawn(picture: &Picture, count: &Count, port: &str) -> String {
    let (rows, missing, told) = (count.rows, count.missing, count.told());
    let subtitle = format!("{rows} sample sets, {missing} triggers missing, {told}");
    picture.svg(&format!("Positions of {port}"), &subtitle)
}

/// What was recorded, and where it is.
fn head(recorder: &Recorder, count: &Count) -> String {
    let files = match recorder.parts() {
        0 => "no event, no file".to_owned(),
        1 => recorder.name(),
        parts => format!("{} and {} before it", recorder.name(), parts - 1),
    };
    let kept = match recorder.is_selective() {
        true => format!(", {} of them written,", recorder.written()),
        false => String::new(),
    };
    format!(
        "{files}: {} sample sets{kept} in {:.3} s of the card's time",
        count.rows,
        recorder.span_s()
    )
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

enum Failure {
    Card(CommandError),
    Write(io::Error),
}

/// A card that does not answer may do so again; one that is another one ends the log.
fn still(filled: Result<(), HostError>, rows: u64) -> Result<(), Failure> {
    match filled {
        Ok(()) | Err(HostError::Silent { .. }) => Ok(()),
        Err(HostError::Refused(text)) => {
            Err(Failure::Card(CommandError::CheckFailed(vec![format!(
            "{text}; this was after {rows} sample sets, which are in the file; begin another log"
        )])))
        }
        Err(error) => Err(Failure::Card(told(error))),
    }
}

/// Rows that wait for the disk at most: half a minute at 10 kHz. What comes then is lost in the card, and counted.
const WAITING_MAX: usize = 300_000;
/// How long a full queue is waited for before it is looked at again.
const FULL: Duration = Duration::from_millis(1);

/// Rows on their way to the disk.
struct Queue {
    give: Sender<Vec<Row>>,
    waiting: Arc<AtomicUsize>,
}

impl Queue {
    /// False if nobody takes them any more.
    fn put(&self, rows: Vec<Row>) -> bool {
        let count = rows.len();
        self.waiting.fetch_add(count, Ordering::Relaxed);
        let mut is_taken = self.give.send(rows).is_ok();
        while is_taken && self.waiting.load(Ordering::Relaxed) > WAITING_MAX {
            thread::sleep(FULL);
            is_taken = self.give.send(Vec::new()).is_ok();
        }
        is_taken
    }
}

/// Gives rows to the files, until there are no more or no more are wanted.
fn write(
    mut recorder: Recorder,
    rows: &Receiver<Vec<Row>>,
    waiting: &AtomicUsize,
) -> (io::Result<()>, Recorder) {
    let mut flushed = Instant::now();
    let mut all = || loop {
        match rows.recv_timeout(FLUSH) {
            Ok(batch) => {
                waiting.fetch_sub(batch.len(), Ordering::Relaxed);
                for row in batch {
                    if recorder.is_over() {
                        return Ok(());
                    }
                    recorder.row(row)?;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        if recorder.is_over() {
            return Ok(());
        }
        if flushed.elapsed() >= FLUSH {
            flushed = Instant::now();
            recorder.tick()?;
        }
    };
    let result = all();
    let ended = recorder.end();
    (result.and(ended), recorder)
}

/// Takes rows of the card while another thread writes: a disk that is slow for seconds loses nothing.
fn record(
    card: &mut AnyCard,
    feed: &mut Feed,
    recorder: Recorder,
    count: &mut Count,
    end: &End,
) -> (Result<Duration, Failure>, Recorder) {
    let (give, take) = channel();
    let waiting = Arc::new(AtomicUsize::new(0));
    let queue = Queue {
        give,
        waiting: waiting.clone(),
    };
    let writer = thread::spawn(move || write(recorder, &take, &waiting));
    let progress = end.progress();
    let taken = take_rows(card, feed, &queue, (count, &progress), end);
    drop(queue);
    drop(progress);
    let (written, recorder) = writer
        .join()
        .unwrap_or_else(|e| std::panic::resume_unwind(e));
    let taken = taken.and_then(|silent| written.map(|()| silent).map_err(Failure::Write));
    (taken, recorder)
}

/// Gives how long nothing had come at the end.
fn take_rows(
    card: &mut AnyCard,
    feed: &mut Feed,
    queue: &Queue,
    (count, progress): (&mut Count, &Progress),
    end: &End,
) -> Result<Duration, Failure> {
    let stop = interrupted();
    let begin = Instant::now();
    let mut heard = begin;
    let mut rows = VecDeque::new();
    let mut watch = Watch {
        last: card.bridge().transport().state(),
    };
    loop {
        let filled = feed.fill(card, &mut rows, SLICE);
        for text in watch.news(card.bridge().transport().state()) {
            say(&text);
        }
        still(filled, count.rows)?;
        if !rows.is_empty() {
            heard = Instant::now();
        }
        let left = end.samples.map_or(u64::MAX, |n| n - count.rows);
        rows.truncate(usize::try_from(left).unwrap_or(usize::MAX));
        rows.iter().for_each(|row| count.note(row));
        // Nobody takes them any more: the disk is full, or all events are there.
        let is_over = !queue.put(rows.drain(..).collect())
            || end.samples == Some(count.rows)
            || (end.seconds).is_some_and(|s| begin.elapsed() >= Duration::from_secs(s));
        if is_over || stop.load(Ordering::Relaxed) {
            return Ok(heard.elapsed());
        }
        if heard.elapsed() > SILENCE {
            let why = match watch.last.is_open {
                true => {
                    "is a trigger enabled (`endat reg read card_config`), is the card plugged in?"
                }
                false => "the connection is lost; is the card plugged in?",
            };
            return Err(Failure::Card(CommandError::CheckFailed(vec![format!(
                "no sample for {} s; {why} {} sets are in the file",
                SILENCE.as_secs(),
                count.rows
            )])));
        }
        progress.at(match (end.samples, end.seconds) {
            (None, Some(_)) => begin.elapsed().as_secs(),
            _ => count.rows,
        });
    }
}
