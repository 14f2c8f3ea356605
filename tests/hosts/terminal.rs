//! The program at a terminal: the screen of `monitor`, the bar of `log`, colours.

use super::{quicker_service_port, slow_card, Served};
use crate::program::{endat, signal, Dir};
use endat_card::Door;
use serialport::{SerialPort, TTYPort};
use std::fs::File;
use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longest wait for something on the terminal, or for the end.
const PATIENCE: Duration = Duration::from_secs(60);
/// What leaves the screen that the program has taken.
const LEFT: &str = "\x1b[?1049l";

/// A terminal, and the program at it.
struct Terminal {
    master: TTYPort,
    child: Child,
    seen: String,
    /// Stays open, so that what the program has written last is not lost.
    _slave: TTYPort,
}

/// The end of a text, as much as is worth to be shown.
fn last(text: &str) -> String {
    let count = text.chars().count();
    text.chars().skip(count.saturating_sub(500)).collect()
}

impl Terminal {
    fn new(arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let (mut master, slave) = TTYPort::pair().unwrap();
        master.set_timeout(Duration::from_millis(50)).unwrap();
        let name = slave.name().unwrap();
        let size = Command::new("stty")
            .args(["-F", &name, "rows", "24", "cols", "80"])
            .status();
        assert!(size.unwrap().success());
        let end = || Stdio::from(File::options().read(true).write(true).open(&name).unwrap());
        let mut command = endat();
        for name in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE"] {
            command.env_remove(name);
        }
        let command = command.args(arguments).env("TERM", "xterm");
        let command = command.envs(environment.iter().copied());
        let child = command.stdin(end()).stdout(end()).stderr(end()).spawn();
        Self {
            master,
            child: child.unwrap(),
            seen: String::new(),
            _slave: slave,
        }
    }

    fn read(&mut self) -> bool {
        let mut bytes = [0; 4096];
        let count = self.master.read(&mut bytes).unwrap_or(0);
        self.seen += &String::from_utf8_lossy(&bytes[..count]);
        count > 0
    }

    /// Waits until a text has come since the last wait.
    fn wait(&mut self, text: &str) {
        let begin = Instant::now();
        loop {
            if let Some(at) = self.seen.find(text) {
                self.seen.drain(..at);
                return;
            }
            self.read();
            assert!(begin.elapsed() < PATIENCE, "{text}: {:?}", last(&self.seen));
        }
    }

    fn press(&mut self, keys: &str) {
        self.master.write_all(keys.as_bytes()).unwrap();
    }

    /// Waits for the end: all that came since the last wait, and the exit code.
    fn end(&mut self) -> (String, Option<i32>) {
        let begin = Instant::now();
        let code = loop {
            self.read();
            if let Some(status) = self.child.try_wait().unwrap() {
                break status.code();
            }
            assert!(begin.elapsed() < PATIENCE, "{:?}", last(&self.seen));
        };
        while self.read() {}
        (std::mem::take(&mut self.seen), code)
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // Nothing to end where it has ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Catches a screen that hears no key, and a terminal that is left as the screen had it.
#[test]
fn the_screen_of_monitor_hears_keys_and_gives_the_terminal_back() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let monitor = ["monitor", "--port", &card.name, "--every", "0.05"];
    let mut terminal = Terminal::new(&monitor, &[]);
    terminal.wait("positions");
    terminal.wait("good");
    terminal.press("z");
    terminal.wait("deg z");
    terminal.press("?");
    terminal.wait("keys");
    terminal.press("xq");
    let (seen, code) = terminal.end();
    assert_eq!(code, Some(0), "{seen:?}");
    assert!(seen.contains(LEFT), "{seen:?}");
    for (end, environment) in [("\x03", [("NO_COLOR", "1")]), ("", [("NO_COLOR", "")])] {
        let mut terminal = Terminal::new(&monitor, &environment);
        terminal.wait("positions");
        let has_colour = |text: &str| text.contains("\x1b[38;5;2");
        let at_first = terminal.seen.clone();
        terminal.wait("good");
        let seen = at_first + &terminal.seen;
        assert_eq!(has_colour(&seen), environment[0].1.is_empty(), "{seen:?}");
        terminal.press(end);
        if end.is_empty() {
            signal(&terminal.child, "TERM");
        }
        let (seen, code) = terminal.end();
        assert_eq!(code, Some(0), "{end:?}: {seen:?}");
        assert!(seen.contains(LEFT), "{end:?}: {seen:?}");
    }
}

/// Catches a screen that goes with its card.
#[test]
fn the_screen_of_monitor_goes_on_when_the_card_is_back() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let name = card.name.clone();
    let mut terminal = Terminal::new(&["monitor", "--port", &name], &[]);
    terminal.wait("good");
    drop(card);
    // The answer that does not come is told in the place of `live`.
    terminal.wait("answer");
    let address = name.trim_start_matches("tcp:").to_owned();
    let again = move || {
        // The system keeps the port for a moment.
        let tries = (0..100).find_map(|_| {
            std::thread::sleep(Duration::from_millis(100));
            Door::tcp(&address).ok()
        });
        tries.unwrap()
    };
    let _card = Served::new(slow_card(), again);
    terminal.wait("live");
    terminal.press("q");
    assert_eq!(terminal.end().1, Some(0));
}

/// Catches a bar in a file, and none on a terminal.
#[test]
fn long_work_has_a_bar_on_a_terminal_and_lines_elsewhere() {
    let dir = Dir::new("bar");
    let out = dir.path("rows.csv");
    let log = [
        "log",
        "--port",
        quicker_service_port(),
        "--samples",
        "300",
        "--force",
        "--out",
        &out,
    ];
    let mut terminal = Terminal::new(&log, &[]);
    let (seen, code) = terminal.end();
    assert_eq!(code, Some(0), "{seen:?}");
    assert!(
        seen.contains(" of 300 sample sets, ") && seen.contains(" left") && seen.contains("[="),
        "{seen:?}"
    );
    // The message behind it has its colour.
    assert!(seen.contains("\x1b[1mendat:\x1b[0m "), "{seen:?}");
    let output = endat().args(log).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(!told.contains('\x1b') && !told.contains('['), "{told}");
    let is_line = |line: &str| line.starts_with("30 of 300 sample sets");
    assert!(told.lines().any(is_line), "{told}");
}

/// Catches colour in a file, and where nobody wants it.
#[test]
fn colour_is_for_terminals_and_for_those_who_want_it() {
    let help = |environment: &[(&str, &str)]| {
        let mut terminal = Terminal::new(&["--help"], environment);
        terminal.end().0.contains("\x1b[")
    };
    assert!(help(&[]));
    assert!(!help(&[("NO_COLOR", "1")]));
    let file = |name: &str, value: &str| {
        let output = endat().arg("--help").env(name, value).output().unwrap();
        output.stdout.contains(&0x1b)
    };
    assert!(!file("TERM", "xterm"));
    assert!(file("CLICOLOR_FORCE", "1"));
}
