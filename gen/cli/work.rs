//! Long work on many processors: how many, and how far it is.

use super::number::number;
use crate::error::GenError;
use clap::Args;
use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

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
    pub fn count(&self) -> Result<usize, GenError> {
        match &self.threads {
            Some(text) => Ok(number("--threads", text, 1..=THREADS_MAX)? as usize),
            None => Ok(0),
        }
    }
}

/// Tells on stderr, at each tenth, how many of `of` are done.
pub fn progress(of: usize, what: &'static str) -> impl Fn(usize) + Sync {
    let shown_percent = AtomicUsize::new(0);
    move |done: usize| {
        let percent = 100 * done / of;
        if shown_percent.fetch_max(percent, Ordering::Relaxed) / 10 < percent / 10 {
            tell(&format!("{done} of {of} {what}"));
        }
    }
}

/// Tells on stderr what is done now.
pub fn tell(text: &str) {
    // A progress line that cannot be written is no reason to stop.
    let _ = writeln!(std::io::stderr(), "{text}");
}
