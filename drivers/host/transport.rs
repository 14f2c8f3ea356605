//! Byte links to a card.

use crate::HostError;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// A link of bytes.
pub trait Transport {
    /// Sends all of `bytes`.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Waits at most `wait` for bytes, and returns their number: 0 = none. A wait of zero returns bytes already received.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize>;

    /// Time of the link, from any start; timeouts use it. The time of a simulated card may be slower than real time.
    fn elapsed(&self) -> Duration {
        static BEGIN: OnceLock<Instant> = OnceLock::new();
        BEGIN.get_or_init(Instant::now).elapsed()
    }

    /// True if the link is open, and how often it was lost before.
    fn state(&self) -> LinkState {
        LinkState::default()
    }

    /// Reason why the other end closed the link last, in its words; `None` since the last answer.
    fn refusal(&self) -> Option<&str> {
        None
    }
}

/// Start of the line that a virtual card sends to a rejected connection. No answer of a card begins like this.
pub const REFUSAL: &str = "endat-card: ";

/// State of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkState {
    /// The link is open.
    pub is_open: bool,
    /// How often the link was lost and reopened.
    pub reopened: u64,
}

impl Default for LinkState {
    fn default() -> Self {
        Self {
            is_open: true,
            reopened: 0,
        }
    }
}

impl<T: Transport + ?Sized> Transport for Box<T> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        (**self).send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        (**self).receive(buffer, wait)
    }

    fn elapsed(&self) -> Duration {
        (**self).elapsed()
    }

    fn state(&self) -> LinkState {
        (**self).state()
    }

    fn refusal(&self) -> Option<&str> {
        (**self).refusal()
    }
}

/// A time-out is not an error: no bytes were received.
fn or_nothing(result: io::Result<usize>) -> io::Result<usize> {
    match result {
        Err(e)
            if [
                ErrorKind::TimedOut,
                ErrorKind::WouldBlock,
                ErrorKind::Interrupted,
            ]
            .contains(&e.kind()) =>
        {
            Ok(0)
        }
        other => other,
    }
}

/// Ports treat a wait of zero as endless, or reject it.
const SHORTEST: Duration = Duration::from_millis(1);

struct Serial(Box<dyn serialport::SerialPort>);

impl Transport for Serial {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)?;
        self.0.flush()
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        if wait.is_zero() && self.0.bytes_to_read()? == 0 {
            return Ok(0);
        }
        self.0.set_timeout(wait.max(SHORTEST))?;
        or_nothing(self.0.read(buffer))
    }
}

struct Tcp(TcpStream);

impl Transport for Tcp {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.0.set_nonblocking(wait.is_zero())?;
        if !wait.is_zero() {
            self.0.set_read_timeout(Some(wait.max(SHORTEST)))?;
        }
        let result = self.0.read(buffer);
        self.0.set_nonblocking(false)?;
        match result {
            // The end of a closed socket; a time-out is a separate error.
            Ok(0) => Err(ErrorKind::ConnectionAborted.into()),
            Ok(count) if buffer[..count].starts_with(REFUSAL.as_bytes()) => {
                let text = String::from_utf8_lossy(&buffer[REFUSAL.len()..count]);
                Err(io::Error::new(ErrorKind::ResourceBusy, text.trim_end()))
            }
            other => or_nothing(other),
        }
    }
}

/// Timeout for opening a TCP connection.
const CONNECT_WAIT: Duration = Duration::from_secs(3);

fn open_once(address: &str, baud: u32) -> io::Result<Box<dyn Transport>> {
    if let Some(socket) = address.strip_prefix("tcp:") {
        use std::net::ToSocketAddrs;
        let mut last = io::Error::new(ErrorKind::NotFound, "the name has no address");
        for address in socket.to_socket_addrs()? {
            match TcpStream::connect_timeout(&address, CONNECT_WAIT) {
                Ok(stream) => {
                    stream.set_nodelay(true)?;
                    return Ok(Box::new(Tcp(stream)));
                }
                Err(e) => last = e,
            }
        }
        return Err(last);
    }
    let port = serialport::new(address, baud).open();
    Ok(Box::new(Serial(port.map_err(io::Error::from)?)))
}

/// Remedy for an address that could not be opened.
fn remedy(address: &str, error: ErrorKind) -> &'static str {
    let has_port = |socket: &str| {
        let port = socket.rsplit_once(':').map(|(_, port)| port.parse::<u16>());
        matches!(port, Some(Ok(1..)))
    };
    match address.strip_prefix("tcp:") {
        Some(socket) if !has_port(socket) => {
            "write tcp:HOST:PORT, with a number from 1 to 65535 as PORT"
        }
        Some(_) if error == ErrorKind::ConnectionRefused => {
            "the connection was refused: is `card`, or the serial server, running with that port?"
        }
        None if has_port(address) => "write tcp: before it, or give the card's serial port",
        _ => "give the card's serial port, or tcp:HOST:PORT",
    }
}

/// A port that is reopened after it was unplugged and has come back.
pub struct Port {
    address: String,
    baud: u32,
    open: Option<Box<dyn Transport>>,
    reopened: u64,
    refusal: Option<String>,
}

/// Names of the serial ports of this machine.
pub fn serial_ports() -> Vec<String> {
    let ports = serialport::available_ports().unwrap_or_default();
    ports.into_iter().map(|port| port.port_name).collect()
}

impl Port {
    /// Opens `tcp:HOST:PORT`, or the serial port with this name and baud rate.
    pub fn open(address: &str, baud: u32) -> Result<Self, HostError> {
        let open = open_once(address, baud).map_err(|error| HostError::Link {
            address: address.to_owned(),
            action: "cannot be opened",
            remedy: remedy(address, error.kind()),
            error,
        })?;
        Ok(Self {
            address: address.to_owned(),
            baud,
            open: Some(open),
            reopened: 0,
            refusal: None,
        })
    }

    /// How often it was reopened.
    pub fn reopened(&self) -> u64 {
        self.reopened
    }

    /// Uses the open port; a failing port is closed, and retried with the next call.
    fn with(
        &mut self,
        wait: Duration,
        act: impl FnOnce(&mut dyn Transport) -> io::Result<usize>,
    ) -> io::Result<usize> {
        if self.open.is_none() {
            match open_once(&self.address, self.baud) {
                Ok(port) => {
                    self.open = Some(port);
                    self.reopened += 1;
                }
                Err(_) => {
                    std::thread::sleep(wait.min(Duration::from_millis(100)));
                    return Ok(0);
                }
            }
        }
        let result = match &mut self.open {
            Some(port) => act(port.as_mut()),
            None => Ok(0),
        };
        match &result {
            Ok(0) => {}
            Ok(_) => self.refusal = None,
            Err(error) => {
                self.open = None;
                let is_busy = error.kind() == ErrorKind::ResourceBusy;
                let told = is_busy.then(|| format!("{}: {error}", self.address));
                self.refusal = told.or(self.refusal.take());
            }
        }
        result.or(Ok(0))
    }
}

impl Transport for Port {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.with(Duration::ZERO, |port| port.send(bytes).map(|()| 0))
            .map(|_| ())
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let end = Instant::now() + wait;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            let count = self.with(left, |port| port.receive(buffer, left))?;
            if count > 0 || Instant::now() >= end {
                return Ok(count);
            }
        }
    }

    fn state(&self) -> LinkState {
        LinkState {
            is_open: self.open.is_some(),
            reopened: self.reopened,
        }
    }

    fn refusal(&self) -> Option<&str> {
        self.refusal.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use super::{remedy, ErrorKind};

    #[test]
    fn an_address_that_is_nearly_one_is_mended() {
        let remedy = |address| remedy(address, ErrorKind::NotFound);
        let plain = remedy("/dev/ttyUSB0");
        for (address, told) in [
            ("127.0.0.1:5000", "write tcp: before it"),
            ("tcp:card", "write tcp:HOST:PORT"),
            ("tcp:card:99999", "write tcp:HOST:PORT"),
            ("tcp:card:0", "write tcp:HOST:PORT"),
            ("tcp:card:5000", plain),
            ("tcp:[::1]:5000", plain),
            ("COM3", plain),
        ] {
            assert!(remedy(address).starts_with(told), "{address}");
        }
    }

    #[test]
    fn a_port_at_which_nobody_listens_is_told_as_that() {
        let told = remedy("tcp:card:5000", ErrorKind::ConnectionRefused);
        assert!(told.contains("is `card`"), "{told}");
    }
}
