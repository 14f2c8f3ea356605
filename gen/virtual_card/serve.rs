//! A virtual card behind a port that other programs open: a pseudo terminal, or TCP.

use super::{VirtualCard, SECOND};
use crate::error::GenError;
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Where hosts come in.
pub enum Door {
    /// One host after the other over TCP, and beside it who makes faults.
    Tcp(Tcp),
    /// The far end of a pseudo terminal, and the near end, which must stay open.
    #[cfg(unix)]
    Terminal(serialport::TTYPort, serialport::TTYPort),
}

/// How who makes faults begins; no command of a host does.
pub const CONTROL: &str = "endat-inject ";
/// Longest line of faults.
const CONTROL_BYTES: usize = 256;
/// Who has said nothing for so long is a host.
const QUIET: Duration = Duration::from_millis(200);
/// Connections that wait at most.
const WAITING_MAX: usize = 16;

/// Connections to a card.
pub struct Tcp {
    listener: TcpListener,
    host: Option<TcpStream>,
    /// Nobody knows yet what they are, or there is a host; since when.
    waiting: Vec<(TcpStream, Instant)>,
    controls: Vec<TcpStream>,
}

/// What a connection is.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Unknown,
    Host,
    Control,
    Gone,
}

/// By what it has sent, without taking it.
fn kind(stream: &TcpStream, since: Instant) -> Kind {
    let mut begin = [0; CONTROL.len()];
    match stream.peek(&mut begin) {
        Ok(0) => Kind::Gone,
        Ok(count) if begin[..] == *CONTROL.as_bytes() && count == begin.len() => Kind::Control,
        Ok(count) if CONTROL.as_bytes().starts_with(&begin[..count]) => {
            match since.elapsed() > QUIET {
                true => Kind::Host,
                false => Kind::Unknown,
            }
        }
        Ok(_) => Kind::Host,
        Err(e) if e.kind() == ErrorKind::WouldBlock => match since.elapsed() > QUIET {
            true => Kind::Host,
            false => Kind::Unknown,
        },
        Err(_) => Kind::Gone,
    }
}

/// What faults somebody asks for; the card stands still meanwhile, so not for long.
fn line(stream: &mut TcpStream) -> String {
    let begin = Instant::now();
    let mut line = Vec::new();
    let mut byte = [0];
    while line.len() < CONTROL_BYTES && begin.elapsed() < QUIET {
        match stream.read(&mut byte) {
            Ok(1) if byte[0] != b'\n' => line.push(byte[0]),
            _ => break,
        }
    }
    let text = String::from_utf8_lossy(&line);
    text.strip_prefix(CONTROL).unwrap_or_default().to_owned()
}

impl Tcp {
    /// Lets new ones in, and finds out what they are.
    fn sort(&mut self) {
        while let Ok((new, _)) = self.listener.accept() {
            let good = new.set_nonblocking(true).and(new.set_nodelay(true));
            if good.is_ok() && self.waiting.len() < WAITING_MAX {
                self.waiting.push((new, Instant::now()));
            }
        }
        let mut n = 0;
        while n < self.waiting.len() {
            let (stream, since) = &self.waiting[n];
            match kind(stream, *since) {
                Kind::Control => self.controls.push(self.waiting.remove(n).0),
                Kind::Host if self.host.is_none() => self.host = Some(self.waiting.remove(n).0),
                Kind::Gone => drop(self.waiting.remove(n)),
                Kind::Host | Kind::Unknown => n += 1,
            }
        }
    }

    /// Answers those who make faults; only from this machine.
    fn answer(&mut self, mut inject: impl FnMut(&str) -> Result<String, String>) {
        for mut stream in self.controls.drain(..) {
            let is_here = stream.peer_addr().is_ok_and(|a| a.ip().is_loopback());
            let ready = stream.set_nonblocking(false);
            let ready = ready.and(stream.set_read_timeout(Some(QUIET)));
            if ready.and(stream.set_write_timeout(Some(QUIET))).is_err() {
                continue;
            }
            let answer = match is_here {
                true => inject(&line(&mut stream)),
                false => Err("inject: takes no faults from another machine".into()),
            };
            let told = match answer {
                Ok(done) => format!("ok {done}\n"),
                Err(why) => format!("error {why}\n"),
            };
            let _ = stream.write_all(told.as_bytes());
        }
    }
}

impl Door {
    /// Listens at `HOST:PORT`.
    pub fn tcp(address: &str) -> Result<Self, GenError> {
        let fail = |e: std::io::Error| {
            let remedy = match e.kind() {
                ErrorKind::AddrInUse => "give another port (port 0 takes a free one)",
                ErrorKind::PermissionDenied => "give a port from 1024 on (port 0 takes a free one)",
                _ => "give HOST:PORT, for example 127.0.0.1:8888 (port 0 takes a free one)",
            };
            GenError::input(format!("--tcp = {address:?}: {e}; {remedy}"))
        };
        let listener = TcpListener::bind(address).map_err(fail)?;
        listener.set_nonblocking(true).map_err(fail)?;
        Ok(Self::Tcp(Tcp {
            listener,
            host: None,
            waiting: Vec::new(),
            controls: Vec::new(),
        }))
    }

    /// Makes a pseudo terminal.
    #[cfg(unix)]
    pub fn terminal() -> Result<Self, GenError> {
        let fail = |e: serialport::Error| {
            GenError::input(format!("pseudo terminal: {e}; use --tcp HOST:PORT"))
        };
        let (mut far, near) = serialport::TTYPort::pair().map_err(fail)?;
        serialport::SerialPort::set_timeout(&mut far, Duration::from_millis(1)).map_err(fail)?;
        Ok(Self::Terminal(far, near))
    }

    /// What a host gives as its port.
    pub fn name(&self) -> String {
        match self {
            Self::Tcp(tcp) => tcp
                .listener
                .local_addr()
                .map_or_else(|_| "tcp:?".into(), |a| format!("tcp:{a}")),
            #[cfg(unix)]
            Self::Terminal(_, near) => {
                serialport::SerialPort::name(near).unwrap_or_else(|| "?".into())
            }
        }
    }

    /// Whether somebody is there; at a pseudo terminal nobody knows.
    fn is_open(&self) -> bool {
        match self {
            Self::Tcp(tcp) => tcp.host.is_some(),
            #[cfg(unix)]
            Self::Terminal(..) => true,
        }
    }

    /// Bytes that have come; none is no error.
    fn read(&mut self) -> Vec<u8> {
        let mut buffer = [0; 4096];
        match self {
            Self::Tcp(tcp) => {
                tcp.sort();
                let Some(open) = &mut tcp.host else {
                    return Vec::new();
                };
                match open.read(&mut buffer) {
                    Ok(0) => tcp.host = None,
                    Ok(count) => return buffer[..count].to_vec(),
                    Err(e) if e.kind() == ErrorKind::WouldBlock => {}
                    Err(_) => tcp.host = None,
                }
                Vec::new()
            }
            #[cfg(unix)]
            Self::Terminal(far, _) => match serialport::SerialPort::bytes_to_read(far) {
                Ok(1..) => {
                    let count = far.read(&mut buffer).unwrap_or(0);
                    buffer[..count].to_vec()
                }
                _ => Vec::new(),
            },
        }
    }

    /// Gives bytes to the host; what nobody takes is lost, as on a real line.
    fn write(&mut self, bytes: &[u8]) {
        match self {
            Self::Tcp(tcp) => {
                if let Some(open) = &mut tcp.host {
                    let _ = open.set_nonblocking(false);
                    let _ = open.set_write_timeout(Some(Duration::from_secs(1)));
                    if open.write_all(bytes).is_err() {
                        tcp.host = None;
                    } else {
                        let _ = open.set_nonblocking(true);
                    }
                }
            }
            #[cfg(unix)]
            Self::Terminal(far, _) => {
                let _ = far.write_all(bytes);
            }
        }
    }
}

impl Door {
    /// Answers those who make faults.
    fn answer(&mut self, inject: impl FnMut(&str) -> Result<String, String>) {
        match self {
            Self::Tcp(tcp) => tcp.answer(inject),
            #[cfg(unix)]
            Self::Terminal(..) => {}
        }
    }
}

/// How fast a card ran.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Simulated seconds.
    pub simulated_s: f64,
    /// Seconds by the clock on the wall.
    pub wall_s: f64,
}

impl Pace {
    /// Simulated time for each second.
    pub fn ratio(&self) -> f64 {
        self.simulated_s / self.wall_s.max(1e-9)
    }
}

/// Simulated times between two looks at the port, in turn: together no multiple of a usual trigger period, so that the accesses of a host
/// fall at every phase of the triggers.
const SLICES_US: [u64; 7] = [100, 61, 89, 73, 107, 67, 94];
/// Time between two reports.
const REPORT: Duration = Duration::from_secs(2);

/// Runs a card behind a door, never faster than real time, until `stop` is raised or `limit` is over; tells its pace now and
/// then.
pub fn serve(
    card: &mut VirtualCard,
    door: &mut Door,
    stop: &AtomicBool,
    limit: Option<Duration>,
    mut report: impl FnMut(Pace),
) {
    card.keep_time();
    let begin = Instant::now();
    let first = card.now();
    let simulated = |card: &VirtualCard| (card.now() - first) as f64 / SECOND;
    let mut reported = begin;
    let mut at_report = (0.0, 0.0);
    let mut slices_us = SLICES_US.into_iter().cycle();
    let is_over = || limit.is_some_and(|l| begin.elapsed() >= l);
    while !stop.load(Ordering::Relaxed) && !is_over() {
        let was_open = door.is_open();
        let bytes = door.read();
        door.answer(|words| card.inject(words));
        card.send_bytes(&bytes);
        card.run(slices_us.next().unwrap_or(SLICES_US[0]) * card.cycles_per_us);
        let answer = card.take_bytes();
        if !answer.is_empty() {
            door.write(&answer);
        }
        if was_open && !door.is_open() {
            // The next host's bytes must not end a command of this one.
            card.forget_host();
        }
        let (wall, now) = (begin.elapsed().as_secs_f64(), simulated(card));
        if now > wall {
            std::thread::sleep(Duration::from_secs_f64((now - wall).min(0.01)));
        }
        if reported.elapsed() >= REPORT {
            reported = Instant::now();
            report(Pace {
                simulated_s: now - at_report.0,
                wall_s: wall - at_report.1,
            });
            at_report = (now, wall);
        }
    }
}
