//! Connections to a virtual card over TCP: one host after the other, and beside it whoever makes faults.
//!
//! A card has one host. A second connection waits a moment, in case the first one is just leaving, and is then told that the card is in use.
//! One that says nothing keeps nobody out.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::time::{Duration, Instant};

/// How who makes faults begins; no command of a host does.
pub const CONTROL: &str = "endat-inject ";
/// How the line begins that a connection gets instead of the card; no answer of a card does.
const IN_USE: &str = endat_host::transport::REFUSAL;
/// Longest line of faults.
const CONTROL_BYTES: usize = 256;
/// Who has said nothing for so long is a host.
const QUIET: Duration = Duration::from_millis(200);
/// A line of faults is whole after this, or never.
const LINE: Duration = Duration::from_secs(2);
/// A host that is leaving has left after this.
const LEAVING: Duration = Duration::from_secs(1);
/// Nothing came ever, and nothing went: the connection is closed after this.
const SILENT: Duration = Duration::from_secs(10);
/// Nothing came and nothing went for so long: another connection may have the card.
const IDLE: Duration = Duration::from_secs(60);
/// A host that takes nothing for so long has left.
const PATIENCE: Duration = Duration::from_secs(1);
/// A host that sends more than the card takes, and for so long, is none: no command waits for so many others.
const FLOOD: Duration = Duration::from_secs(5);
/// Bytes that a host may leave.
const OUTBOX_MAX: usize = 1 << 20;
/// Connections that wait at most.
const WAITING_MAX: usize = 16;
/// New connections that are looked at in one go.
const NEW_MAX: usize = 64;

/// What a connection is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Nobody knows yet.
    Unknown,
    /// It has sent something that is for the card.
    Speaker,
    /// It says nothing.
    Mute,
    /// It makes faults, and its line is whole.
    Control,
    Gone,
}

/// By what it has sent, without taking it.
fn kind(stream: &TcpStream, since: Instant) -> Kind {
    let mut begin = [0; CONTROL_BYTES];
    let control = CONTROL.as_bytes();
    let is_over = |limit| since.elapsed() > limit;
    match stream.peek(&mut begin) {
        Ok(0) => Kind::Gone,
        Ok(count) if begin[..count].starts_with(control) => {
            match begin[..count].contains(&b'\n') || count == CONTROL_BYTES {
                true => Kind::Control,
                false if is_over(LINE) => Kind::Gone,
                false => Kind::Unknown,
            }
        }
        Ok(count) if control.starts_with(&begin[..count]) && !is_over(QUIET) => Kind::Unknown,
        Ok(_) => Kind::Speaker,
        Err(e) if e.kind() == ErrorKind::WouldBlock => match is_over(QUIET) {
            true => Kind::Mute,
            false => Kind::Unknown,
        },
        Err(_) => Kind::Gone,
    }
}

/// Says why a connection does not get the card, and closes it.
fn refuse(mut stream: TcpStream, since: Option<Instant>) {
    let for_long = since.map_or(String::new(), |s| {
        format!(" for {} s", s.elapsed().as_secs())
    });
    let text = format!("{IN_USE}in use by another connection{for_long}\n");
    let _ = stream.write_all(text.as_bytes());
    let _ = stream.shutdown(Shutdown::Write);
    // What has come and is not read would take the line away from the other end.
    let mut buffer = [0; 4096];
    for _ in 0..16 {
        if !matches!(stream.read(&mut buffer), Ok(1..)) {
            break;
        }
    }
}

/// Who has the card.
struct Host {
    stream: TcpStream,
    since: Instant,
    /// It has sent something.
    has_spoken: bool,
    /// When something came or went last.
    heard: Instant,
    /// Since when it has sent more than the card takes.
    floods: Option<Instant>,
    outbox: VecDeque<u8>,
    /// When the outbox was last empty, or some of it went.
    taken: Instant,
}

impl Host {
    fn new(stream: TcpStream) -> Self {
        let now = Instant::now();
        Self {
            stream,
            since: now,
            has_spoken: false,
            heard: now,
            floods: None,
            outbox: VecDeque::new(),
            taken: now,
        }
    }

    /// Bytes that have come, and whether the connection is still good.
    fn read(&mut self, buffer: &mut [u8]) -> (usize, bool) {
        let (count, is_good) = self.read_some(buffer);
        match count == buffer.len() {
            true => {
                let since = self.floods.get_or_insert_with(Instant::now);
                (count, is_good && since.elapsed() < FLOOD)
            }
            false => {
                self.floods = None;
                (count, is_good)
            }
        }
    }

    fn read_some(&mut self, buffer: &mut [u8]) -> (usize, bool) {
        // Nothing that has come could be read, and nothing would be the end.
        if buffer.is_empty() {
            return (0, true);
        }
        match self.stream.read(buffer) {
            Ok(0) => (0, false),
            Ok(count) => {
                self.has_spoken = true;
                self.heard = Instant::now();
                (count, true)
            }
            Err(e) => {
                let waits = [ErrorKind::WouldBlock, ErrorKind::Interrupted];
                (0, waits.contains(&e.kind()))
            }
        }
    }

    /// Gives what the host takes; whether it still does.
    fn flush(&mut self) -> bool {
        if self.outbox.is_empty() {
            self.taken = Instant::now();
        }
        while !self.outbox.is_empty() {
            let (bytes, _) = self.outbox.as_slices();
            match self.stream.write(bytes) {
                Ok(0) => return false,
                Ok(count) => {
                    self.outbox.drain(..count);
                    self.taken = Instant::now();
                    self.heard = self.taken;
                }
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) if e.kind() == ErrorKind::WouldBlock => {
                    return self.taken.elapsed() < PATIENCE && self.outbox.len() < OUTBOX_MAX;
                }
                Err(_) => return false,
            }
        }
        true
    }
}

/// Connections to a card.
pub struct Tcp {
    listener: TcpListener,
    host: Option<Host>,
    /// Nobody knows yet what they are, or there is a host; since when.
    waiting: Vec<(TcpStream, Instant)>,
    controls: Vec<TcpStream>,
}

impl Tcp {
    /// Listens at `HOST:PORT`.
    pub fn bind(address: &str) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            listener,
            host: None,
            waiting: Vec::new(),
            controls: Vec::new(),
        })
    }

    /// What a host gives as its port.
    pub fn name(&self) -> String {
        let address = self.listener.local_addr();
        address.map_or_else(|_| "tcp:?".into(), |a| format!("tcp:{a}"))
    }

    /// Whether there is a host.
    pub fn has_host(&self) -> bool {
        self.host.is_some()
    }

    /// Lets new ones in, and finds out what they are.
    fn sort(&mut self) {
        for _ in 0..NEW_MAX {
            let Ok((new, _)) = self.listener.accept() else {
                break;
            };
            if new
                .set_nonblocking(true)
                .and(new.set_nodelay(true))
                .is_err()
            {
                continue;
            }
            match self.waiting.len() < WAITING_MAX {
                true => self.waiting.push((new, Instant::now())),
                false => refuse(new, self.host.as_ref().map(|h| h.since)),
            }
        }
        let kinds: Vec<Kind> = self
            .waiting
            .iter()
            .map(|(s, since)| kind(s, *since))
            .collect();
        let has_speaker = kinds.contains(&Kind::Speaker);
        let is_silent = |host: &Host| !host.has_spoken && host.heard.elapsed() > SILENT;
        let is_idle = |host: &Host| has_speaker && host.heard.elapsed() > IDLE;
        if self
            .host
            .as_ref()
            .is_some_and(|h| is_silent(h) || is_idle(h))
        {
            // The next one has its turn when the card has forgotten this one.
            self.host = None;
            return;
        }
        let all = std::mem::take(&mut self.waiting).into_iter().zip(kinds);
        for ((stream, since), kind) in all {
            let keeps_out = self.host.as_ref().is_some_and(|host| host.has_spoken);
            match kind {
                Kind::Gone => {}
                Kind::Control => self.controls.push(stream),
                Kind::Speaker if !keeps_out => {
                    let mute = self.host.replace(Host::new(stream));
                    if let Some(mute) = mute {
                        refuse(mute.stream, None);
                    }
                    // It is known to have something to say.
                    self.host.iter_mut().for_each(|host| host.has_spoken = true);
                }
                Kind::Mute if self.host.is_none() && !has_speaker => {
                    self.host = Some(Host::new(stream));
                }
                Kind::Speaker if since.elapsed() > LEAVING => {
                    refuse(stream, self.host.as_ref().map(|host| host.since));
                }
                Kind::Mute if since.elapsed() > SILENT => {}
                _ => self.waiting.push((stream, since)),
            }
        }
    }

    /// Bytes that have come from the host, as many as there is room for; none is no error.
    pub fn read(&mut self, room: usize) -> Vec<u8> {
        self.sort();
        let mut buffer = [0; 4096];
        let buffer = &mut buffer[..room.min(4096)];
        let Some(host) = &mut self.host else {
            return Vec::new();
        };
        let (count, is_good) = host.read(buffer);
        if !is_good {
            self.host = None;
        }
        buffer[..count].to_vec()
    }

    /// Gives bytes to the host; what it does not take is lost, and so is the host.
    pub fn write(&mut self, bytes: &[u8]) {
        if let Some(host) = &mut self.host {
            host.outbox.extend(bytes);
            if !host.flush() {
                self.host = None;
            }
        }
    }

    /// Answers those who make faults; only from this machine.
    pub fn answer(&mut self, mut inject: impl FnMut(&str) -> Result<String, String>) {
        for mut stream in self.controls.drain(..) {
            let is_here = stream.peer_addr().is_ok_and(|a| a.ip().is_loopback());
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

/// What faults somebody asks for; the line has come.
fn line(stream: &mut TcpStream) -> String {
    let mut buffer = [0; CONTROL_BYTES];
    let count = stream.read(&mut buffer).unwrap_or(0);
    let line = buffer[..count].split(|b| *b == b'\n').next();
    let text = String::from_utf8_lossy(line.unwrap_or_default());
    text.strip_prefix(CONTROL).unwrap_or_default().to_owned()
}
