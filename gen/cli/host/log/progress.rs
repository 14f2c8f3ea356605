//! What is told while a log goes on.

use endat_host::transport::LinkState;
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Nothing for this long: something is wrong.
pub const SILENCE: Duration = Duration::from_secs(20);
/// Between two lines of progress.
const PROGRESS: Duration = Duration::from_secs(2);

/// Lines of progress: one that is written over on a terminal, one after the other in a file.
pub struct Progress {
    of: Option<u64>,
    is_terminal: bool,
    shown: Instant,
    is_there: bool,
}

impl Progress {
    pub fn new(of: Option<u64>) -> Self {
        Self {
            of,
            is_terminal: io::stderr().is_terminal(),
            shown: Instant::now(),
            is_there: false,
        }
    }

    pub fn show(&mut self, rows: u64) {
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
    pub fn clear(&self) {
        if self.is_terminal && self.is_there {
            let _ = io::stderr().write_all(b"\r\x1b[K");
        }
    }
}

/// Says so when the link is lost, and when it is back.
pub struct Watch {
    pub last: LinkState,
}

impl Watch {
    /// What is to be told of the link, as it is now.
    pub fn news(&mut self, now: LinkState) -> Vec<String> {
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
