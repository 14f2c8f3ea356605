//! A client connection: whole lines come in, answers and data go out. Both directions have limited buffers: the server stops reading a client that sends more than
//! it receives, and drops one that receives nothing.

use super::control::Seen;
use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Longest line from a client.
const LINE_MAX: usize = 4096;
/// Bytes of lines that wait for their answers. The rest stays in the buffers of the system, and then with the client.
const INBOX_MAX: usize = 1 << 14;
/// Most unread bytes of answers; until the client reads some, its lines wait.
const ANSWERS_MAX: usize = 1 << 16;
/// Most unread bytes of data.
const DATA_MAX: usize = 1 << 23;
/// Answers are sent in pieces of about this size.
const PIECE: usize = 1 << 12;
/// A client is dropped if a byte has waited this long.
pub const PATIENCE: Duration = Duration::from_secs(5);

/// Bytes to send, and the time since which the first of them has waited.
struct Piece {
    bytes: Vec<u8>,
    since: Instant,
}

/// A connection.
pub struct Client {
    stream: TcpStream,
    patience: Duration,
    /// Received bytes; lines before `taken` have been answered, and up to `searched` there is no further line end.
    inbox: Vec<u8>,
    taken: usize,
    searched: usize,
    outbox: VecDeque<Piece>,
    /// Sent bytes of the first piece, and unsent bytes of all pieces.
    sent: usize,
    waiting: usize,
    /// Values reported to the client.
    pub seen: Seen,
    /// Time of the last received byte.
    heard: Instant,
    /// The client sends nothing more.
    has_ended: bool,
    is_gone: bool,
}

impl Client {
    /// A non-blocking connection.
    pub fn new(stream: TcpStream, patience: Duration) -> io::Result<Self> {
        stream.set_nonblocking(true)?;
        stream.set_nodelay(true)?;
        Ok(Self {
            stream,
            patience,
            inbox: Vec::new(),
            taken: 0,
            searched: 0,
            outbox: VecDeque::new(),
            sent: 0,
            waiting: 0,
            seen: Seen::new(),
            heard: Instant::now(),
            has_ended: false,
            is_gone: false,
        })
    }

    /// Time of the last received byte.
    pub fn heard(&self) -> Instant {
        self.heard
    }

    /// Bytes that the client has not read.
    pub fn waiting(&self) -> usize {
        self.waiting
    }

    /// The client has been dropped, or has left.
    pub fn is_gone(&self) -> bool {
        self.is_gone
    }

    /// The client sends nothing more, and may have left.
    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// The client sends nothing more, and has received every answer.
    pub fn is_served(&self) -> bool {
        self.has_ended && self.outbox.is_empty() && !self.has_line()
    }

    fn has_line(&self) -> bool {
        self.inbox[self.searched..].contains(&b'\n')
    }

    /// Reads received bytes, up to the limit of the buffer.
    pub fn read(&mut self) {
        let mut buffer = [0; 4096];
        while !self.has_ended
            && !self.is_gone
            && self.waiting < ANSWERS_MAX
            && self.inbox.len() < INBOX_MAX
        {
            match self.stream.read(&mut buffer) {
                Ok(0) => self.has_ended = true,
                Ok(count) => {
                    self.inbox.extend_from_slice(&buffer[..count]);
                    self.heard = Instant::now();
                }
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) if e.kind() == ErrorKind::WouldBlock => break,
                Err(_) => self.is_gone = true,
            }
        }
    }

    /// The next whole line; `None` while the client leaves answers unread.
    pub fn line(&mut self) -> Option<String> {
        if self.is_gone || self.waiting >= ANSWERS_MAX {
            return None;
        }
        let more = &self.inbox[self.searched..];
        if let Some(length) = more.iter().position(|b| *b == b'\n') {
            let end = self.searched + length;
            let line = String::from_utf8_lossy(&self.inbox[self.taken..end]).into_owned();
            self.taken = end + 1;
            self.searched = self.taken;
            return Some(line);
        }
        self.inbox.drain(..self.taken);
        self.taken = 0;
        self.searched = self.inbox.len();
        self.is_gone |= self.inbox.len() > LINE_MAX;
        None
    }

    /// Queues bytes of an answer, or of data.
    pub fn send(&mut self, bytes: &[u8]) {
        self.waiting += bytes.len();
        self.is_gone |= self.waiting > DATA_MAX;
        match self.outbox.back_mut() {
            Some(last) if last.bytes.len() + bytes.len() <= PIECE => {
                last.bytes.extend_from_slice(bytes);
            }
            _ => self.outbox.push_back(Piece {
                bytes: bytes.to_vec(),
                since: Instant::now(),
            }),
        }
    }

    /// Sends what the client accepts now; drops it if a piece has waited for too long.
    pub fn flush(&mut self) {
        while let Some(piece) = self.outbox.front().filter(|_| !self.is_gone) {
            match self.stream.write(&piece.bytes[self.sent..]) {
                Ok(count) => {
                    self.sent += count;
                    self.waiting -= count;
                    if self.sent == piece.bytes.len() {
                        self.sent = 0;
                        self.outbox.pop_front();
                    } else if count == 0 {
                        self.is_gone = true;
                    }
                }
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) if e.kind() == ErrorKind::WouldBlock => {
                    self.is_gone = piece.since.elapsed() > self.patience;
                    break;
                }
                Err(_) => self.is_gone = true,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    /// A client, and its remote end.
    fn pair(patience: Duration) -> (Client, TcpStream) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let far = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let (near, _) = listener.accept().unwrap();
        (Client::new(near, patience).unwrap(), far)
    }

    fn all_lines(client: &mut Client, count: usize) -> Vec<String> {
        let mut lines = Vec::new();
        let begin = Instant::now();
        while lines.len() < count && begin.elapsed() < Duration::from_secs(30) {
            client.read();
            lines.extend(std::iter::from_fn(|| client.line()));
        }
        lines
    }

    /// Catches a search that restarts at the first byte with every line, and a line that is lost between two reads.
    #[test]
    fn a_megabyte_of_lines_is_taken_apart_once_and_in_order() {
        let (mut client, mut far) = pair(PATIENCE);
        let mut text: String = (0..60_000).map(|n| format!("{n}\n")).collect();
        text += &"\n".repeat(300_000);
        let sender = std::thread::spawn(move || far.write_all(text.as_bytes()).map(|()| far));
        let lines = all_lines(&mut client, 360_000);
        assert_eq!(lines.len(), 360_000);
        let counted = lines[..60_000].iter().enumerate();
        assert!(counted.into_iter().all(|(n, line)| *line == n.to_string()));
        assert!(client.inbox.capacity() <= 2 * INBOX_MAX);
        drop(sender.join().unwrap());
    }

    /// Catches an unlimited queue of answers, and lines that are read although the client does not read their answers.
    #[test]
    fn a_client_that_takes_nothing_is_not_read_and_then_dropped() {
        let (mut client, mut far) = pair(Duration::from_millis(200));
        far.set_write_timeout(Some(Duration::from_millis(50)))
            .unwrap();
        let begin = Instant::now();
        let mut most = 0;
        while !client.is_gone() {
            assert!(begin.elapsed() < Duration::from_secs(30));
            let _ = far.write(&b"*BLOCKS?\n".repeat(1_000));
            client.read();
            while client.line().is_some() {
                client.send(&[b'!'; 400]);
            }
            client.flush();
            most = most.max(client.waiting());
        }
        assert!((ANSWERS_MAX..ANSWERS_MAX + 401).contains(&most), "{most}");
    }

    /// Catches lost answers for a client that has stopped sending.
    #[test]
    fn a_client_that_sends_nothing_more_has_its_answers() {
        let (mut client, mut far) = pair(PATIENCE);
        far.write_all(b"one\ntwo\nthr").unwrap();
        far.shutdown(std::net::Shutdown::Write).unwrap();
        let lines = all_lines(&mut client, 2);
        assert_eq!(lines, ["one", "two"]);
        client.send(b"yes\n");
        assert!(!client.is_served());
        while !client.is_served() {
            client.read();
            assert_eq!(client.line(), None);
            client.flush();
        }
        drop(client);
        let mut answer = String::new();
        far.read_to_string(&mut answer).unwrap();
        assert_eq!(answer, "yes\n");
    }
}
