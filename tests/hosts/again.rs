//! A log whose link is lost and found again: the card has run on, was restarted, or is another one.

use super::{card_of, changed, slow_card, Served, QUICKER};
#[cfg(unix)]
use crate::program;
use crate::tools;
use endat_card::{Door, VirtualCard};
use endat_config::Project;
use endat_host::feed::Feed;
use endat_host::transport::LinkState;
#[cfg(unix)]
use endat_host::transport::Port;
use endat_host::{Bridge, Card, Transport};
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::fs;
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Longest wait for anything here; a machine that does nothing else takes some seconds.
const PATIENCE: Duration = Duration::from_secs(120);

/// A log in a thread.
struct Log {
    out: PathBuf,
    svg: PathBuf,
    thread: JoinHandle<endat_terminal::outcome::Outcome>,
}

impl Log {
    fn new(folder: &str, port: &str, more: &[&str]) -> Self {
        let folder = tools::folder(folder);
        let (out, svg) = (folder.join("rows.csv"), folder.join("rows.svg"));
        let text = |path: &Path| path.to_str().unwrap().to_owned();
        let mut words: Vec<String> = ["endat", "log", "--force", "--port", port]
            .map(Into::into)
            .into();
        words.extend(["--out".into(), text(&out), "--svg".into(), text(&svg)]);
        words.extend(more.iter().map(|w| (*w).to_owned()));
        let _ = fs::remove_file(&out);
        Self {
            out,
            svg,
            thread: thread::spawn(move || endat::run(words)),
        }
    }

    /// Waits until so many lines are in the file.
    fn wait_for(&self, lines: usize) {
        let begin = Instant::now();
        while fs::read_to_string(&self.out).map_or(0, |t| t.lines().count()) < lines {
            assert!(begin.elapsed() < PATIENCE, "no rows");
            thread::sleep(Duration::from_millis(50));
        }
    }

    /// What it has told, and the columns `trigger`, `time_s` and `missing` of its rows.
    fn end(self) -> (endat_terminal::outcome::Outcome, Vec<(u64, f64, u64)>) {
        let begin = Instant::now();
        while !self.thread.is_finished() {
            let out = self.out.display();
            assert!(begin.elapsed() < PATIENCE, "{out}: the log goes on");
            thread::sleep(Duration::from_millis(50));
        }
        let outcome = self.thread.join().unwrap();
        let text = fs::read_to_string(&self.out).unwrap();
        assert!(text.ends_with('\n'));
        assert!(fs::read_to_string(&self.svg)
            .unwrap()
            .contains("channel 1 (deg)"));
        let rows = text.lines().skip(1).map(|line| {
            let mut fields = line.split(',');
            let mut next = || fields.next().unwrap();
            (
                next().parse().unwrap(),
                next().parse().unwrap(),
                next().parse().unwrap(),
            )
        });
        (outcome, rows.collect())
    }
}

/// How a card is served: [`Served::new`] or [`Served::loaded`].
type Serve = fn(Project, Box<dyn FnOnce() -> Door + Send>) -> Served;
/// Cards that are simulated, and cards whose sets are made.
const SIMULATED: Serve = |project, door| Served::new(project, door);
const MADE: Serve = |project, door| Served::loaded(project, door);

fn served(serve: Serve) -> Served {
    serve(slow_card(), Box::new(|| Door::tcp("127.0.0.1:0").unwrap()))
}

/// A card at an address that another one has just had.
fn served_at(address: &str, project: Project, serve: Serve) -> Served {
    let address = address.trim_start_matches("tcp:").to_owned();
    serve(
        project,
        Box::new(move || {
            let begin = Instant::now();
            // The system keeps the port for a moment.
            loop {
                match Door::tcp(&address) {
                    Ok(door) => return door,
                    Err(error) => assert!(begin.elapsed() < PATIENCE, "{error}"),
                }
                thread::sleep(Duration::from_millis(100));
            }
        }),
    )
}

/// A card that makes its sets by arithmetic, as many as a real one, in a process that can be stopped.
#[cfg(unix)]
struct Asleep(std::process::Child);

#[cfg(unix)]
impl Asleep {
    fn begun() -> (Self, Port) {
        let mut command = program::endat();
        command.args(["card", "--preset", "s6_two_channel", "--load"]);
        let (process, name) = program::begun(command.args(["--tcp", "127.0.0.1:0"]));
        let link = Port::open(name.trim(), 3_000_000).unwrap();
        (Self(process), link)
    }

    fn signal(&self, name: &str) {
        program::signal(&self.0, name);
    }
}

#[cfg(unix)]
impl Drop for Asleep {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Catches a host that takes a card for a restarted one while it only sleeps, throws away for seconds what it sends when it wakes, and
/// counts that as missing. Whether it wakes while it is asked as the one that it was, or as a restarted one.
#[cfg(unix)]
#[test]
fn a_card_that_slept_is_heard_as_soon_as_it_wakes() {
    let (asleep, link) = Asleep::begun();
    let mut card = Card::find(Bridge::new(link)).unwrap();
    let mut feed = Feed::begin(&mut card, false).unwrap();
    let mut rows = VecDeque::new();
    let slice = Duration::from_millis(20);
    let mut listen = |until: &mut dyn FnMut(usize) -> bool| {
        let begin = Instant::now();
        let (mut all, mut missing) = (0, 0);
        while !until(all) {
            assert!(begin.elapsed() < PATIENCE, "{all} rows");
            feed.fill(&mut card, &mut rows, slice).unwrap();
            all += rows.len();
            missing += rows.drain(..).map(|row| row.missing).sum::<u64>();
        }
        (begin.elapsed(), missing)
    };
    for sleep in [Duration::from_millis(1_600), Duration::from_millis(3_900)] {
        listen(&mut |rows| rows > 5_000);
        asleep.signal("STOP");
        let begin = Instant::now();
        thread::scope(|scope| {
            scope.spawn(|| {
                thread::sleep(sleep);
                asleep.signal("CONT");
            });
            // A single call that waits too long or throws rows away counts, too.
            let (took, missing) = listen(&mut |rows| begin.elapsed() > sleep && rows > 10_000);
            // Its answers to what it was asked asleep stand in the way of some.
            assert!(
                took < sleep + Duration::from_secs(2) && missing < 100,
                "{sleep:?}: {took:?}, {missing} missing"
            );
        });
    }
}

/// A line that is dead from a moment to another one, while the card goes on.
#[cfg(unix)]
struct Dead {
    line: Port,
    times: Rc<Cell<[Instant; 2]>>,
}

#[cfg(unix)]
impl Dead {
    fn is_now(&self) -> bool {
        let [from, to] = self.times.get();
        (from..to).contains(&Instant::now())
    }
}

#[cfg(unix)]
impl Transport for Dead {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self.is_now() {
            true => Ok(()),
            false => self.line.send(bytes),
        }
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let end = Instant::now() + wait;
        while self.is_now() {
            let left = end.saturating_duration_since(Instant::now());
            if self
                .line
                .receive(buffer, left.min(Duration::from_millis(10)))?
                == 0
                && left.is_zero()
            {
                return Ok(0);
            }
        }
        self.line
            .receive(buffer, end.saturating_duration_since(Instant::now()))
    }
}

/// Catches 65 536 triggers that nobody counts: a set has 16 bits of its trigger's number, and the card is asked for the rest, also if it
/// was heard again while it was asked, before it has answered.
#[cfg(unix)]
#[test]
#[ignore = "slow: a line that is dead for 65 536 triggers"]
fn what_a_card_counted_on_a_dead_line_is_missing_to_the_last_one() {
    let (_ended, line) = Asleep::begun();
    let times = Rc::new(Cell::new([Instant::now(); 2]));
    let line = Dead {
        line,
        times: times.clone(),
    };
    let mut card = Card::find(Bridge::new(line)).unwrap();
    let mut feed = Feed::begin(&mut card, false).unwrap();
    let mut rows = VecDeque::new();
    let slice = Duration::from_millis(20);
    // As many as 16 bits count, and some; the host asks for the second time then.
    let pause = Duration::from_millis(8_000);
    let from = Instant::now() + Duration::from_millis(300);
    times.set([from, from + pause]);
    while Instant::now() < from + pause + Duration::from_secs(1) {
        feed.fill(&mut card, &mut rows, slice).unwrap();
    }
    let missing: u64 = rows.iter().map(|row| row.missing).sum();
    let first = rows.front().unwrap().trigger;
    let last = rows.back().unwrap().trigger;
    // All of a pause at 10 kHz.
    assert!((70_000..90_000).contains(&missing), "{missing}");
    assert_eq!(last - first + 1, rows.len() as u64 + missing);
}

/// Catches a restarted count that is taken for one that has wrapped, and another card's rows in the file of the one before.
#[test]
fn a_log_ends_with_its_card_and_invents_nothing() {
    ends_with_its_card(MADE, &["restart", "other"]);
}

#[test]
#[ignore = "slow: a log that ends with a simulated card, by stream and one by one"]
fn a_log_ends_with_its_simulated_card_and_invents_nothing() {
    ends_with_its_card(SIMULATED, &["restart", "restart_poll", "other"]);
}

fn ends_with_its_card(serve: Serve, names: &[&str]) {
    let other = || {
        changed(
            "s6_two_channel",
            &[&QUICKER[..5], &[("sample_hz = 10_000", "sample_hz = 900")]].concat(),
        )
    };
    let rows = [
        ("restart", slow_card(), &[][..], "the card was restarted"),
        (
            "restart_poll",
            slow_card(),
            &["--poll"],
            "the card was restarted",
        ),
        (
            "other",
            other(),
            &[],
            "another card answers: its configuration hash is 0x",
        ),
    ];
    let rows = rows.into_iter().filter(|row| names.contains(&row.0));
    for (name, again, more, told) in rows {
        let card = served(serve);
        let port = card.name.clone();
        let log = Log::new(&format!("host_again_{name}_{}", names.len()), &port, more);
        log.wait_for(20);
        drop(card);
        let _again = served_at(&port, again, serve);
        let (outcome, rows) = log.end();
        assert_eq!(outcome.exit_code, 1, "{name}: {outcome:?}");
        let reason = outcome.messages.iter().find(|m| m.contains(told));
        let reason = reason.unwrap_or_else(|| panic!("{name}: {outcome:?}"));
        let count = format!("after {} sample sets", rows.len());
        assert!(reason.contains(&count), "{name}: {outcome:?}");
        let head = &outcome.messages[0];
        let is_clean = more.contains(&"--poll") || head.contains("; 0 triggers missing, ");
        // The frame that was cut with the link, and nothing that the question has brought.
        let frames = [
            "; 0 frames damaged",
            "; 1 frames damaged",
            "; read one by one",
        ];
        let is_clean = is_clean && frames.iter().any(|f| head.contains(f));
        assert!(is_clean, "{name}: {outcome:?}");
        let last = rows.last().unwrap();
        // A count or a clock that began anew would be 65 536 triggers, or 42 s, on.
        assert!(last.0 < 30_000 && last.1 < 30.0, "{name}: {last:?}");
        assert!(
            rows.iter().all(|r| more.contains(&"--poll") || r.2 < 1_000),
            "{name}"
        );
    }
}

/// A line between host and card that can be cut, while the card runs on.
struct Line {
    door: TcpListener,
    card: String,
}

impl Line {
    fn new(card: &Served) -> Self {
        Self {
            door: TcpListener::bind("127.0.0.1:0").unwrap(),
            card: card.name.trim_start_matches("tcp:").to_owned(),
        }
    }

    /// Takes a host, connects it, and gives the two ends.
    fn connect(&self) -> [TcpStream; 2] {
        let begin = Instant::now();
        self.door.set_nonblocking(true).unwrap();
        let host = loop {
            match self.door.accept() {
                Ok((host, _)) => break host,
                Err(error) => assert!(begin.elapsed() < PATIENCE, "no host: {error}"),
            }
            thread::sleep(Duration::from_millis(10));
        };
        host.set_nonblocking(false).unwrap();
        let card = TcpStream::connect(&self.card).unwrap();
        for (from, to) in [(&host, &card), (&card, &host)] {
            let (mut from, mut to) = (from.try_clone().unwrap(), to.try_clone().unwrap());
            thread::spawn(move || {
                let mut buffer = [0; 4096];
                while let Ok(count @ 1..) = from.read(&mut buffer) {
                    if to.write_all(&buffer[..count]).is_err() {
                        break;
                    }
                }
            });
        }
        [host, card]
    }
}

/// Catches a log that gives up a card which has run on, or does not count what was missed.
#[test]
fn a_log_goes_on_when_only_the_link_was_lost() {
    goes_on(MADE, &[&["--samples", "1000"]]);
}

#[test]
#[ignore = "slow: a log of a simulated card whose link is lost, by stream and one by one"]
fn a_log_of_a_simulated_card_goes_on_when_only_the_link_was_lost() {
    let poll = ["--samples", "200", "--poll"];
    goes_on(SIMULATED, &[&["--samples", "400"], &poll]);
}

fn goes_on(serve: Serve, logs: &[&[&str]]) {
    for &more in logs {
        let card = served(serve);
        let line = Line::new(&card);
        let port = format!("tcp:{}", line.door.local_addr().unwrap());
        let folder = format!("host_again_{}_{}", logs.len(), more.len());
        let log = Log::new(&folder, &port, more);
        let ends = line.connect();
        log.wait_for(20);
        for end in ends {
            end.shutdown(Shutdown::Both).unwrap();
        }
        thread::sleep(Duration::from_millis(700));
        let _ends = line.connect();
        let (outcome, rows) = log.end();
        let wanted: usize = more[1].parse().unwrap();
        assert_eq!(rows.len(), wanted, "{outcome:?}");
        let is_stream = more.len() == 2;
        let missing: u64 = rows.iter().map(|r| r.2).sum();
        assert!(missing > 0, "{outcome:?}");
        if is_stream {
            assert_eq!(outcome.exit_code, 1, "what is missing is told: {outcome:?}");
            let told = format!("; {missing} triggers missing, ");
            assert!(outcome.messages[0].contains(&told), "{outcome:?}");
        }
        for pair in rows.windows(2) {
            let [before, row] = pair else { unreachable!() };
            assert_eq!(row.0, before.0 + 1 + row.2);
            // The preset's slow triggers are a millisecond apart.
            let late = row.1 - before.1 - 1e-3 * (row.0 - before.0) as f64;
            assert!(late.abs() < if is_stream { 1e-6 } else { 1e-2 }, "{pair:?}");
        }
    }
}

/// A card that may be exchanged for another one while nobody looks.
struct Plug {
    card: Rc<RefCell<VirtualCard>>,
    reopened: Rc<Cell<u64>>,
}

impl Transport for Plug {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.card.borrow_mut().send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.card.borrow_mut().receive(buffer, wait)
    }

    fn state(&self) -> LinkState {
        LinkState {
            is_open: true,
            reopened: self.reopened.get(),
        }
    }
}

/// Catches a restart that is not seen because the card has soon counted more triggers than before, and one that is seen where there was none.
#[test]
fn a_restart_is_seen_by_more_than_its_count() {
    let project = slow_card();
    let inside = Rc::new(RefCell::new(card_of(&project)));
    let reopened = Rc::new(Cell::new(0));
    let plug = Plug {
        card: inside.clone(),
        reopened: reopened.clone(),
    };
    let mut card = Card::find(Bridge::new(plug)).unwrap();
    let mut feed = Feed::begin(&mut card, true).unwrap();
    let mut fill = || {
        reopened.set(reopened.get() + 1);
        feed.fill(&mut card, &mut VecDeque::new(), Duration::ZERO)
    };
    fill().unwrap();
    let mut begun_anew = card_of(&project);
    begun_anew.run(2 * inside.borrow_mut().bench().cycle());
    *inside.borrow_mut() = begun_anew;
    let told = fill().unwrap_err().to_string();
    assert!(
        told.contains("the mark in card_config.hold.scratch is gone"),
        "{told}"
    );
}
