//! Long work on many processors: how many, and how far it is.

use crate::colour;
use clap::Args;
use endat_console::error::CommandError;
use endat_console::number::number;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// Most threads.
const THREADS_MAX: u64 = 1024;

/// How many threads work.
#[derive(Args)]
pub struct ThreadsArgs {
    /// Threads [default: one for each processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    threads: Option<String>,
}

impl ThreadsArgs {
    /// Whether somebody has chosen.
    pub fn is_given(&self) -> bool {
        self.threads.is_some()
    }

    /// Their number; 0 = one for each processor.
    pub fn count(&self) -> Result<usize, CommandError> {
        match &self.threads {
            Some(text) => Ok(number("--threads", text, 1..=THREADS_MAX)? as usize),
            None => Ok(0),
        }
    }
}

/// The bar that is on the terminal, if there is one: messages come above it.
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);
/// How often a bar moves while nothing is done.
const TICK: Duration = Duration::from_millis(200);

fn shown() -> MutexGuard<'static, Option<ProgressBar>> {
    SHOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How far long work is: a bar with the time that is left on a terminal, and lines elsewhere.
pub struct Progress {
    of: Option<u64>,
    what: &'static str,
    bar: Option<ProgressBar>,
    begin: Instant,
    done: AtomicU64,
}

/// Whether a bar can be drawn.
fn has_bar() -> bool {
    let is_dumb = std::env::var_os("TERM").is_none_or(|term| term == "dumb");
    io::stderr().is_terminal() && !is_dumb
}

/// What a bar looks like: with and without an end.
fn style(of: Option<u64>) -> ProgressStyle {
    let template = match of {
        Some(_) => "[{bar:30}] {pos} of {len} {msg}, {eta} left",
        None => "{spinner} {pos} {msg}, {elapsed}",
    };
    let style = ProgressStyle::with_template(template);
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    style.progress_chars("=> ").tick_chars("|/-\\ ")
}

impl Progress {
    /// Of so many, if that is known.
    pub fn new(of: Option<u64>, what: &'static str) -> Self {
        Self::drawn(of, what, has_bar())
    }

    /// The same without a bar, where rows go to the same terminal.
    pub fn quiet(what: &'static str) -> Self {
        Self::drawn(None, what, false)
    }

    fn drawn(of: Option<u64>, what: &'static str, has_bar: bool) -> Self {
        let bar = has_bar.then(|| {
            let bar = ProgressBar::with_draw_target(of, ProgressDrawTarget::stderr());
            bar.set_style(style(of));
            bar.set_message(what);
            bar.enable_steady_tick(TICK);
            *shown() = Some(bar.clone());
            bar
        });
        Self {
            of,
            what,
            bar,
            begin: Instant::now(),
            done: AtomicU64::new(0),
        }
    }

    /// So many are done.
    pub fn at(&self, done: u64) {
        match &self.bar {
            Some(bar) => bar.set_position(done),
            None => self
                .line(done, self.begin.elapsed())
                .iter()
                .for_each(|line| tell(line)),
        }
    }

    /// A line for each tenth.
    fn line(&self, done: u64, took: Duration) -> Option<String> {
        let (of, what) = (self.of?, self.what);
        let tenth = |n: u64| 10 * n.min(of) / of.max(1);
        let before = self.done.fetch_max(done, Ordering::Relaxed);
        if tenth(before) >= tenth(done) {
            return None;
        }
        let left = took.mul_f64(of.saturating_sub(done) as f64 / done as f64);
        let left = match left.as_secs() {
            0 => String::new(),
            seconds => format!(", {seconds} s left"),
        };
        Some(format!("{done} of {of} {what}{left}"))
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
            *shown() = None;
        }
    }
}

/// Tells how many of `of` are done.
pub fn progress(of: usize, what: &'static str) -> impl Fn(usize) + Sync {
    let progress = Progress::new(Some(of as u64), what);
    move |done: usize| progress.at(done as u64)
}

/// Work in steps that have names: the one that is under way stands beside the bar, and in a line of its own elsewhere.
pub struct Steps {
    progress: Progress,
}

impl Steps {
    /// Of so many, if that is known.
    pub fn new(of: Option<u64>) -> Self {
        let progress = Progress::new(of, "steps");
        Self { progress }
    }

    /// A step begins; those before it are done.
    pub fn begin(&self, name: &str) {
        let done = self.progress.done.fetch_add(1, Ordering::Relaxed);
        match &self.progress.bar {
            Some(bar) => {
                bar.set_position(done);
                bar.set_message(format!("steps: {name}"));
            }
            None => tell(name),
        }
    }
}

/// Does something with the bar out of the way.
fn beside_bar(write: impl FnOnce()) {
    let bar = shown().clone();
    match bar {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

/// Tells on stderr what is done now.
pub fn tell(text: &str) {
    // A progress line that cannot be written is no reason to stop.
    beside_bar(|| {
        let _ = writeln!(io::stderr(), "{text}");
    });
}

/// The program that runs: its messages begin with its name.
static PROGRAM: OnceLock<&str> = OnceLock::new();

/// Says which program runs; the first call counts.
pub fn set_program(name: &'static str) {
    let _ = PROGRAM.set(name);
}

/// The name of the program that runs; empty in a library of others.
pub fn program() -> &'static str {
    PROGRAM.get().copied().unwrap_or_default()
}

/// Prints a message on stderr while the work goes on, after the program's name.
pub fn say(text: &str) {
    beside_bar(|| colour::to_stderr(program(), text, false));
}

/// Raised by Ctrl-C.
pub fn interrupted() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = flag.clone();
    // Only the first handler counts; a second one in the same process is a test.
    let _ = ctrlc::set_handler(move || raised.store(true, Ordering::Relaxed));
    flag
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_a_line_for_each_tenth_with_the_time_that_is_left() {
        let progress = Progress::drawn(Some(200), "cases", false);
        let at = |done, seconds| progress.line(done, Duration::from_secs(seconds));
        assert_eq!(at(19, 1), None);
        assert_eq!(at(21, 2).unwrap(), "21 of 200 cases, 17 s left");
        assert_eq!(at(21, 3), None);
        // Threads tell in any order.
        assert_eq!(at(20, 3), None);
        assert_eq!(at(200, 9).unwrap(), "200 of 200 cases");
        assert_eq!(Progress::drawn(None, "rows", false).line(5, TICK), None);
    }
}
