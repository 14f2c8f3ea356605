//! A virtual card behind a port that other programs open: a pseudo terminal, or TCP.

use super::{VirtualCard, SECOND};
use crate::error::GenError;
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Where hosts come in.
pub enum Door {
    /// One host after the other over TCP.
    Tcp(TcpListener, Option<TcpStream>),
    /// The far end of a pseudo terminal, and the near end, which must stay open.
    #[cfg(unix)]
    Terminal(serialport::TTYPort, serialport::TTYPort),
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
        Ok(Self::Tcp(listener, None))
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
            Self::Tcp(listener, _) => listener
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
            Self::Tcp(_, stream) => stream.is_some(),
            #[cfg(unix)]
            Self::Terminal(..) => true,
        }
    }

    /// Bytes that have come; none is no error.
    fn read(&mut self) -> Vec<u8> {
        let mut buffer = [0; 4096];
        match self {
            Self::Tcp(listener, stream) => {
                if stream.is_none() {
                    if let Ok((new, _)) = listener.accept() {
                        let good = new.set_nonblocking(true).and(new.set_nodelay(true));
                        *stream = good.is_ok().then_some(new);
                    }
                }
                let Some(open) = stream else {
                    return Vec::new();
                };
                match open.read(&mut buffer) {
                    Ok(0) => *stream = None,
                    Ok(count) => return buffer[..count].to_vec(),
                    Err(e) if e.kind() == ErrorKind::WouldBlock => {}
                    Err(_) => *stream = None,
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
            Self::Tcp(_, stream) => {
                if let Some(open) = stream {
                    let _ = open.set_nonblocking(false);
                    let _ = open.set_write_timeout(Some(Duration::from_secs(1)));
                    if open.write_all(bytes).is_err() {
                        *stream = None;
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

/// Simulated time between two looks at the port.
const SLICE_US: u64 = 100;
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
    let begin = Instant::now();
    let first = card.now();
    let simulated = |card: &VirtualCard| (card.now() - first) as f64 / SECOND;
    let mut reported = begin;
    let mut at_report = (0.0, 0.0);
    let is_over = || limit.is_some_and(|l| begin.elapsed() >= l);
    while !stop.load(Ordering::Relaxed) && !is_over() {
        let was_open = door.is_open();
        let bytes = door.read();
        card.send_bytes(&bytes);
        card.run(SLICE_US * card.cycles_per_us);
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
