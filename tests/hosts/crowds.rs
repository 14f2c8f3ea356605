//! Programs that serve others, beside clients that never read, that flood, that say nothing, and that come in crowds.

use super::{slow_card, Served};
use crate::program::{bad, endat, good, run, Dir};
use endat_card::Door;
use std::fs;
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The longest wait of a client that does nothing wrong, beside any others.
const WAIT_MAX: Duration = Duration::from_secs(1);
/// Between two questions of such a client.
const PAUSE: Duration = Duration::from_millis(10);

/// A program that serves, and the addresses that it has printed.
struct Program {
    process: Child,
    addresses: Vec<String>,
}

impl Program {
    fn new(arguments: &[&str], lines: usize) -> Self {
        let mut command = endat();
        let command = command.args(arguments);
        let mut process = command
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let told = BufReader::new(process.stdout.take().unwrap());
        let lines = told.lines().take(lines).map(|line| {
            let line = line.unwrap();
            line.trim_start_matches("control ")
                .trim_start_matches("data ")
                .trim_start_matches("tcp:")
                .to_owned()
        });
        Self {
            addresses: lines.collect(),
            process,
        }
    }

    /// Resident memory in kilobytes.
    fn memory(&self) -> u64 {
        let file = format!("/proc/{}/status", self.process.id());
        let status = fs::read_to_string(file).unwrap_or_default();
        let line = status.lines().find_map(|l| l.strip_prefix("VmRSS:"));
        line.map_or(0, |l| l.trim().trim_end_matches(" kB").parse().unwrap())
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// Clients that do something wrong until they are dropped.
struct Crowd {
    stop: Arc<AtomicBool>,
    /// Bytes that they have sent, and how often one of them was closed.
    sent: Arc<AtomicU64>,
    closed: Arc<AtomicU64>,
    threads: Vec<JoinHandle<()>>,
}

impl Crowd {
    fn new() -> Self {
        Self {
            stop: Arc::default(),
            sent: Arc::default(),
            closed: Arc::default(),
            threads: Vec::new(),
        }
    }

    /// So many connections that send this, over and over; they read what comes, or they do not.
    fn add(&mut self, address: &str, count: usize, text: Vec<u8>, reads: bool) {
        let (stop, sent, closed) = (self.stop.clone(), self.sent.clone(), self.closed.clone());
        let address = address.to_owned();
        let open = move || {
            let stream = TcpStream::connect(&address).ok()?;
            stream.set_nonblocking(true).ok()?;
            Some((stream, 0usize))
        };
        self.threads.push(thread::spawn(move || {
            let mut all: Vec<_> = (0..count).map(|_| open()).collect();
            let mut buffer = vec![0; 1 << 16];
            let waits = |e: &std::io::Error| e.kind() == ErrorKind::WouldBlock;
            while !stop.load(Ordering::Relaxed) {
                for one in &mut all {
                    let Some((stream, at)) = one else {
                        *one = open();
                        continue;
                    };
                    let mut is_gone = false;
                    match stream.write(&text[*at..]) {
                        Ok(0) => {}
                        Ok(count) => {
                            sent.fetch_add(count as u64, Ordering::Relaxed);
                            *at = (*at + count) % text.len();
                        }
                        Err(e) => is_gone |= !waits(&e),
                    }
                    match reads.then(|| stream.read(&mut buffer)) {
                        Some(Ok(0)) => is_gone = true,
                        Some(Err(e)) => is_gone |= !waits(&e),
                        _ => {}
                    }
                    if is_gone {
                        closed.fetch_add(1, Ordering::Relaxed);
                        *one = None;
                    }
                }
                thread::sleep(Duration::from_millis(1));
            }
        }));
    }

    fn end(self) {
        self.stop.store(true, Ordering::Relaxed);
        self.threads.into_iter().for_each(|t| t.join().unwrap());
    }
}

/// Asks this until the time is over; the longest wait for an answer.
fn longest_wait(address: &str, question: &str, end: Instant) -> Duration {
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(20 * WAIT_MAX)).unwrap();
    let mut answers = BufReader::new(stream.try_clone().unwrap());
    let mut longest = Duration::ZERO;
    while Instant::now() < end {
        let begin = Instant::now();
        (&stream).write_all(question.as_bytes()).unwrap();
        let mut answer = String::new();
        answers.read_line(&mut answer).unwrap();
        assert!(answer.starts_with("OK ="), "{answer}");
        longest = longest.max(begin.elapsed());
        thread::sleep(PAUSE);
    }
    longest
}

/// A line to the control port, and its answer.
fn told(control: &TcpStream, line: &str) -> String {
    let mut stream = control;
    stream.write_all(line.as_bytes()).unwrap();
    let mut answer = String::new();
    BufReader::new(stream).read_line(&mut answer).unwrap();
    answer
}

/// What came of acquisitions.
#[derive(Debug, Default)]
struct Recorded {
    /// The longest pause between two pieces of data.
    pause: Duration,
    bytes: u64,
    rows: u64,
    /// A machine that has no time for the card makes gaps, which end an acquisition.
    overruns: u64,
}

/// Records until the acquisition is disarmed, and arms the next one where one ends by itself.
fn record(address: &str, control: &str) -> JoinHandle<Recorded> {
    let boss = TcpStream::connect(control).unwrap();
    let mut stream = TcpStream::connect(address).unwrap();
    stream.write_all(b"XML FRAMED RAW\n").unwrap();
    stream.set_read_timeout(Some(20 * WAIT_MAX)).unwrap();
    let mut ok = [0; 3];
    stream.read_exact(&mut ok).unwrap();
    assert_eq!(&ok, b"OK\n");
    thread::spawn(move || {
        let mut all = Recorded::default();
        let mut last: Vec<u8> = Vec::new();
        let mut buffer = [0; 1 << 16];
        let mut heard = None;
        loop {
            let count = stream.read(&mut buffer).expect("data, or the end");
            let pause = heard.map_or(Duration::ZERO, |h: Instant| h.elapsed());
            all.pause = all.pause.max(pause);
            heard = Some(Instant::now());
            all.bytes += count as u64;
            last.extend_from_slice(&buffer[..count]);
            last.drain(..last.len().saturating_sub(64));
            let text = String::from_utf8_lossy(&last);
            let end = text.rfind("END ").map(|at| text[at..].to_owned());
            let Some(line) = end.filter(|line| line.ends_with('\n')) else {
                assert_ne!(count, 0, "closed without an end");
                continue;
            };
            all.rows += line.split(' ').nth(1).unwrap().parse::<u64>().unwrap();
            if line.ends_with("Disarmed\n") {
                return all;
            }
            assert!(line.ends_with("Data overrun\n"), "{line}");
            all.overruns += 1;
            last.clear();
            assert_eq!(told(&boss, "*PCAP.ARM=\n"), "OK\n");
        }
    })
}

/// A card at 10 kHz in real time, a server of it, and crowds at both of its ports for so long: the good clients' longest wait is below a
/// second, every row arrives, and memory stays as it is.
fn a_server_beside_crowds(time: Duration) {
    let card = Program::new(&["card", "--load", "--tcp", "127.0.0.1:0"], 1);
    let port = format!("tcp:{}", card.addresses[0]);
    let serve = [
        "serve",
        "--control-port",
        "0",
        "--data-port",
        "0",
        "--port",
        &port,
    ];
    let server = Program::new(&serve, 2);
    let [control, data] = &server.addresses[..] else {
        panic!("{:?}", server.addresses);
    };
    let recording = record(data, control);
    let boss = TcpStream::connect(control).unwrap();
    assert_eq!(told(&boss, "*PCAP.ARM=\n"), "OK\n");
    let begin = Instant::now();
    let mut crowd = Crowd::new();
    crowd.add(control, 1, b"*BLOCKS?\n".repeat(2_000), false);
    crowd.add(control, 2, b"*CHANGES?\n*IDN?\n".repeat(2_000), true);
    crowd.add(control, 1, vec![b'\n'; 100_000], true);
    crowd.add(control, 200, b"*IDN".to_vec(), true);
    crowd.add(data, 1, b"XML\n".repeat(2_000), false);
    // It takes the form of its data, and then nothing.
    let mut idle = TcpStream::connect(data).unwrap();
    idle.write_all(b"XML FRAMED SCALED\n").unwrap();
    let (early, end) = (begin + time / 5, begin + time);
    let first = longest_wait(control, "*IDN?\n", early);
    let before = server.memory();
    let wait = longest_wait(control, "*IDN?\n", end).max(first);
    let after = server.memory();
    let sent = crowd.sent.load(Ordering::Relaxed);
    crowd.end();
    assert_eq!(told(&boss, "*PCAP.DISARM=\n"), "OK\n");
    let all = recording.join().unwrap();
    println!(
        "longest wait {wait:?}, {all:?}, {sent} bytes of others, memory {before} to {after} kB"
    );
    assert!(wait < WAIT_MAX, "{wait:?}");
    // A busy machine has fewer than ten thousand rows a second.
    assert!(all.pause < WAIT_MAX && all.overruns < 5, "{all:?}");
    assert!(all.rows as f64 > 1_000.0 * time.as_secs_f64(), "{all:?}");
    assert!(all.bytes > all.rows * 64, "{all:?}");
    assert!(after * 10 <= before * 11, "{before} to {after} kB");
}

/// Catches a client that stops all others: one that never reads, floods of lines, 200 connections that say half a line.
#[test]
fn a_server_answers_within_a_second_beside_clients_that_never_read_or_flood() {
    a_server_beside_crowds(Duration::from_millis(2_500));
}

#[test]
#[ignore = "slow: ten minutes of serve beside clients that never read, that flood, and 200 connections"]
fn a_server_answers_within_a_second_for_ten_minutes_beside_crowds() {
    a_server_beside_crowds(Duration::from_secs(600));
}

/// Zeros, which are no command of a card, beside 200 connections that wait, for so long.
fn a_card_beside_crowds(time: Duration) {
    let card = Program::new(&["card", "--preset", "demo", "--tcp", "127.0.0.1:0"], 1);
    let address = &card.addresses[0];
    let port = format!("tcp:{address}");
    let good = run(&["reg", "read", "card.id", "--port", &port]);
    assert_eq!(good.exit_code, 0, "{good:?}");
    let mut crowd = Crowd::new();
    crowd.add(address, 1, vec![0; 1 << 16], true);
    thread::sleep(time / 5);
    crowd.add(address, 200, vec![0], true);
    thread::sleep(time / 5);
    let before = card.memory();
    thread::sleep(3 * time / 5);
    let after = card.memory();
    let sent = crowd.sent.load(Ordering::Relaxed);
    crowd.end();
    println!("{sent} bytes taken, memory {before} to {after} kB");
    assert!(after * 10 <= before * 11, "{before} to {after} kB");
    // A program that comes then has the card as before, when the card has seen that the crowd has gone.
    let begin = Instant::now();
    loop {
        let good = run(&["reg", "read", "card.id", "--port", &port]);
        if good.exit_code == 0 {
            break;
        }
        assert!(begin.elapsed() < Duration::from_secs(60), "{good:?}");
    }
    println!("free after {:.1} s", begin.elapsed().as_secs_f64());
}

/// Catches a card that keeps whatever comes.
#[test]
fn a_card_keeps_no_more_than_it_can_carry_out() {
    a_card_beside_crowds(Duration::from_millis(3_000));
}

#[test]
#[ignore = "slow: ten minutes of a card beside a client that floods and 200 connections"]
fn a_card_keeps_no_more_than_it_can_carry_out_for_ten_minutes() {
    a_card_beside_crowds(Duration::from_secs(600));
}

/// Catches a connection that says nothing and has the card all the same.
#[test]
fn a_connection_that_says_nothing_keeps_nobody_out() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let silent = TcpStream::connect(card.name.trim_start_matches("tcp:")).unwrap();
    thread::sleep(Duration::from_millis(400));
    let begin = Instant::now();
    let good = run(&["reg", "read", "card.id", "--port", &card.name]);
    assert_eq!(good.exit_code, 0, "{good:?}");
    assert!(begin.elapsed() < Duration::from_secs(10));
    let mut told = String::new();
    silent
        .set_read_timeout(Some(Duration::from_secs(20)))
        .unwrap();
    (&silent).read_to_string(&mut told).unwrap();
    assert_eq!(told, "endat-card: in use by another connection\n");
}

/// Catches a program that is told nothing but that a card is silent, which another program has.
#[test]
fn a_second_program_is_told_that_the_card_is_in_use() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let mut first = TcpStream::connect(card.name.trim_start_matches("tcp:")).unwrap();
    // A word of the card.
    first.write_all(&[2, 1, 0, 0, 0, 0]).unwrap();
    let mut word = [0; 4];
    first.read_exact(&mut word).unwrap();
    assert_eq!(&word, b"EnDt");
    let told = bad(&["reg", "read", "card.id", "--port", &card.name], 1);
    let begin = format!("{}: in use by another connection for ", card.name);
    assert!(told.starts_with(&begin), "{told}");
    assert!(
        told.ends_with(" s; end the program that uses it, or try again later"),
        "{told}"
    );
    // Any other program can read it, too.
    let mut other = TcpStream::connect(card.name.trim_start_matches("tcp:")).unwrap();
    other.write_all(&[2, 1, 0, 0, 0, 0]).unwrap();
    let mut line = String::new();
    other.read_to_string(&mut line).unwrap();
    assert!(
        line.starts_with("endat-card: in use by another connection for "),
        "{line}"
    );
    // The first one still has it.
    first.write_all(&[2, 1, 0, 0, 0, 0]).unwrap();
    first.read_exact(&mut word).unwrap();
    assert_eq!(&word, b"EnDt");
}

/// Catches a log whose memory grows with what it has written, and files that do not go on.
#[test]
#[ignore = "slow: two minutes of log at full speed, which are hours of a card, in constant memory"]
fn a_log_at_full_speed_stays_in_its_memory() {
    let dir = Dir::new("log_memory");
    let out = dir.path("day.parquet");
    let log = ["log", "--port", "load", "--seconds", "120", "--out", &out];
    let mut log = Program::new(&log, 0);
    let begin = Instant::now();
    let (mut early, mut late) = (0, 0);
    let status = loop {
        if let Some(status) = log.process.try_wait().unwrap() {
            break status;
        }
        let most = match begin.elapsed() < Duration::from_secs(40) {
            true => &mut early,
            false => &mut late,
        };
        *most = log.memory().max(*most);
        thread::sleep(Duration::from_millis(200));
    };
    assert!(status.success(), "{status}");
    let mut files: Vec<String> = dir.files().into_iter().map(|(name, _)| name).collect();
    // The first one has no number.
    files.sort_by_key(|name| name.replace("day.", "day-0001."));
    println!("{early} kB, then {late} kB; {} files", files.len());
    assert!(late * 10 <= early * 11, "{early} to {late} kB");
    assert_eq!(files[0], out);
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let begin = Instant::now();
    let told = good(&[&["stats", "--json"][..], &files].concat());
    let told: serde_json::Value = serde_json::from_str(&told).unwrap();
    println!("{} rows, read in {:?}", told["rows"], begin.elapsed());
    assert_eq!((&told["missing"], &told["misfits"]), (&0.into(), &0.into()));
}
