//! A virtual card behind a port that other programs open: a pseudo terminal, or TCP.

use super::tcp::Tcp;
use super::{VirtualCard, SECOND};
use endat_console::error::CommandError;
use std::io::ErrorKind;
#[cfg(unix)]
use std::io::{Read, Write};
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

/// Bytes of a host that the card has not taken yet; more stays with the host. A command has some thousand at most.
const INBOX_MAX: usize = 1 << 13;

impl Door {
    /// Listens at `HOST:PORT`.
    pub fn tcp(address: &str) -> Result<Self, CommandError> {
        let fail = |e: std::io::Error| {
            let remedy = match e.kind() {
                ErrorKind::AddrInUse => "give another port (port 0 takes a free one)",
                ErrorKind::PermissionDenied => "give a port from 1024 on (port 0 takes a free one)",
                _ => "give HOST:PORT, for example 127.0.0.1:8888 (port 0 takes a free one)",
            };
            CommandError::input(format!("--tcp = {address:?}: {e}; {remedy}"))
        };
        Tcp::bind(address).map_err(fail).map(Self::Tcp)
    }

    /// Makes a pseudo terminal.
    #[cfg(unix)]
    pub fn terminal() -> Result<Self, CommandError> {
        let fail = |e: serialport::Error| {
            CommandError::input(format!("pseudo terminal: {e}; use --tcp HOST:PORT"))
        };
        let (mut far, near) = serialport::TTYPort::pair().map_err(fail)?;
        serialport::SerialPort::set_timeout(&mut far, Duration::from_millis(1)).map_err(fail)?;
        Ok(Self::Terminal(far, near))
    }

    /// What a host gives as its port.
    pub fn name(&self) -> String {
        match self {
            Self::Tcp(tcp) => tcp.name(),
            #[cfg(unix)]
            Self::Terminal(_, near) => {
                serialport::SerialPort::name(near).unwrap_or_else(|| "?".into())
            }
        }
    }

    /// Whether somebody is there; at a pseudo terminal nobody knows.
    fn is_open(&self) -> bool {
        match self {
            Self::Tcp(tcp) => tcp.has_host(),
            #[cfg(unix)]
            Self::Terminal(..) => true,
        }
    }

    /// Bytes that have come, as many as there is room for; none is no error.
    fn read(&mut self, room: usize) -> Vec<u8> {
        match self {
            Self::Tcp(tcp) => tcp.read(room),
            #[cfg(unix)]
            Self::Terminal(far, _) => match serialport::SerialPort::bytes_to_read(far) {
                Ok(1..) if room > 0 => {
                    let mut buffer = [0; 4096];
                    let buffer = &mut buffer[..room.min(4096)];
                    let count = far.read(buffer).unwrap_or(0);
                    buffer[..count].to_vec()
                }
                _ => Vec::new(),
            },
        }
    }

    /// Gives bytes to the host; what nobody takes is lost, as on a real line.
    fn write(&mut self, bytes: &[u8]) {
        match self {
            Self::Tcp(tcp) => tcp.write(bytes),
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
        let bytes = door.read(INBOX_MAX.saturating_sub(card.untaken()));
        door.answer(|words| card.inject(words));
        card.send_bytes(&bytes);
        card.run(slices_us.next().unwrap_or(SLICES_US[0]) * card.cycles_per_us);
        let answer = card.take_bytes();
        door.write(&answer);
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
