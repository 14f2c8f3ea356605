//! Connections of both ports, and the acquisition.

use super::control::{answer, changes, Seen, State, Wish};
use super::data::Times;
use super::{data, Column};
use crate::feed::{Feed, Row};
use crate::{Card, HostError, Transport};
use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::time::{Duration, Instant, SystemTime};

/// Port that clients send commands to.
pub const CONTROL_PORT: u16 = 8888;
/// Port that clients read data from.
pub const DATA_PORT: u16 = 8889;

/// Longest line of a client.
const LINE_MAX: usize = 4096;
/// A client that does not take its data for so long is given up.
const PATIENCE: Duration = Duration::from_secs(2);
/// Wait for rows, and so for anything else.
const SLICE: Duration = Duration::from_millis(10);

/// Where the server listens.
pub struct Ports {
    control: TcpListener,
    data: TcpListener,
}

impl Ports {
    /// Listens on both ports of an address; 0 takes a free one.
    pub fn open(host: &str, control: u16, data: u16) -> io::Result<Self> {
        let open = |port| {
            let listener = TcpListener::bind((host, port))?;
            listener.set_nonblocking(true)?;
            Ok::<_, io::Error>(listener)
        };
        Ok(Self {
            control: open(control)?,
            data: open(data)?,
        })
    }

    /// Addresses of control and data.
    pub fn addresses(&self) -> io::Result<[SocketAddr; 2]> {
        Ok([self.control.local_addr()?, self.data.local_addr()?])
    }
}

/// A connection, and the beginning of its next line.
struct Client {
    stream: TcpStream,
    line: Vec<u8>,
    /// What it has been told of values.
    seen: Seen,
    is_gone: bool,
}

impl Client {
    fn accept(listener: &TcpListener) -> Option<Self> {
        let (stream, _) = listener.accept().ok()?;
        let is_ready = stream
            .set_nonblocking(true)
            .and(stream.set_nodelay(true))
            .and(stream.set_write_timeout(Some(PATIENCE)));
        is_ready.ok()?;
        Some(Self {
            stream,
            line: Vec::new(),
            seen: Seen::new(),
            is_gone: false,
        })
    }

    /// Whole lines that have come.
    fn lines(&mut self) -> Vec<String> {
        let mut buffer = [0; 1024];
        loop {
            match self.stream.read(&mut buffer) {
                Ok(0) => {
                    self.is_gone = true;
                    break;
                }
                Ok(count) => self.line.extend(&buffer[..count]),
                Err(e) if e.kind() == ErrorKind::WouldBlock => break,
                Err(_) => {
                    self.is_gone = true;
                    break;
                }
            }
        }
        let mut lines = Vec::new();
        while let Some(end) = self.line.iter().position(|b| *b == b'\n') {
            let line: Vec<u8> = self.line.drain(..=end).collect();
            lines.push(String::from_utf8_lossy(&line[..end]).into_owned());
        }
        if self.line.len() > LINE_MAX {
            self.is_gone = true;
        }
        lines
    }

    fn send(&mut self, bytes: &[u8]) {
        let sent = self
            .stream
            .set_nonblocking(false)
            .and_then(|()| self.stream.write_all(bytes))
            .and_then(|()| self.stream.set_nonblocking(true));
        self.is_gone |= sent.is_err();
    }
}

struct DataClient {
    client: Client,
    form: Option<data::Form>,
    /// It has the header of the acquisition under way.
    is_recording: bool,
}

struct Acquisition {
    feed: Feed,
    rows: u64,
    times: Times,
}

/// A card behind the two ports.
pub struct Server<'c, T> {
    card: &'c mut Card<T>,
    columns: Vec<Column>,
    ports: Ports,
    controls: Vec<Client>,
    datas: Vec<DataClient>,
    acquisition: Option<Acquisition>,
    /// An acquisition ends by itself after so many rows.
    limit: Option<u64>,
    latest: Option<Vec<i64>>,
    completion: &'static str,
    captured: u64,
}

impl<'c, T: Transport> Server<'c, T> {
    /// Serves a card; each acquisition ends after `limit` rows, or when it is disarmed.
    pub fn new(
        card: &'c mut Card<T>,
        columns: Vec<Column>,
        ports: Ports,
        limit: Option<u64>,
    ) -> Self {
        Self {
            card,
            columns,
            ports,
            controls: Vec::new(),
            datas: Vec::new(),
            acquisition: None,
            limit,
            latest: None,
            completion: "Ok",
            captured: 0,
        }
    }

    /// Serves until `stop` says so.
    pub fn run(&mut self, mut stop: impl FnMut() -> bool) -> Result<(), HostError> {
        while !stop() {
            let began = Instant::now();
            self.listen();
            self.answer_controls()?;
            self.answer_datas();
            match self.acquisition {
                Some(_) => self.pump()?,
                None => std::thread::sleep(SLICE.saturating_sub(began.elapsed())),
            }
        }
        self.end("Disarmed")
    }

    fn listen(&mut self) {
        self.controls.extend(Client::accept(&self.ports.control));
        let client = Client::accept(&self.ports.data);
        self.datas.extend(client.map(|client| DataClient {
            client,
            form: None,
            is_recording: false,
        }));
        self.controls.retain(|c| !c.is_gone);
        self.datas.retain(|c| !c.client.is_gone);
    }

    fn answer_controls(&mut self) -> Result<(), HostError> {
        let software = env!("CARGO_PKG_VERSION");
        let card = format!("{:08x}", self.card.identity().configuration_hash);
        for index in 0..self.controls.len() {
            for line in self.controls[index].lines() {
                let state = State {
                    software,
                    card: &card,
                    columns: &self.columns,
                    latest: self.latest.as_deref(),
                    is_armed: self.acquisition.is_some(),
                    completion: self.completion,
                    captured: self.captured,
                };
                let news = changes(&line, &state, &mut self.controls[index].seen);
                let (text, wish) = match news {
                    Some(text) => (text, None),
                    None => answer(&line, &state),
                };
                let text = match wish {
                    Some(Wish::Arm) if self.acquisition.is_some() => {
                        "ERR Readout still taking place\n".into()
                    }
                    Some(Wish::Arm) => {
                        self.arm()?;
                        text
                    }
                    Some(Wish::Disarm) => {
                        self.end("Disarmed")?;
                        text
                    }
                    None => text,
                };
                self.controls[index].send(text.as_bytes());
            }
        }
        Ok(())
    }

    fn answer_datas(&mut self) {
        for each in &mut self.datas {
            for line in each.client.lines() {
                let answer = match data::form(&line) {
                    Ok(form) => {
                        each.form = Some(form);
                        "OK\n".to_owned()
                    }
                    Err(text) => text + "\n",
                };
                each.client.send(answer.as_bytes());
            }
        }
        // A client that comes late gets what is left.
        let times = self.acquisition.as_ref().map(|a| a.times);
        if let Some(times) = times.filter(|times| times.start.is_some()) {
            self.send_headers(times);
        }
    }

    /// Begins the acquisition for those who have asked for data and do not have its header.
    fn send_headers(&mut self, times: Times) {
        for each in self.datas.iter_mut().filter(|d| !d.is_recording) {
            if let Some(form) = each.form {
                let header = data::header(form, &self.columns, times);
                each.client.send(header.as_bytes());
                each.is_recording = true;
            }
        }
    }

    fn arm(&mut self) -> Result<(), HostError> {
        let feed = Feed::begin(self.card, false)?;
        let times = Times {
            arm: SystemTime::now(),
            start: None,
        };
        self.acquisition = Some(Acquisition {
            feed,
            rows: 0,
            times,
        });
        self.captured = 0;
        // Who is connected has every row.
        self.answer_datas();
        Ok(())
    }

    fn pump(&mut self) -> Result<(), HostError> {
        let Some(acquisition) = &mut self.acquisition else {
            return Ok(());
        };
        let mut queue = VecDeque::new();
        acquisition.feed.fill(self.card, &mut queue, SLICE)?;
        // A row of PandABlocks is a trigger's.
        let mut rows: Vec<Row> = queue.into_iter().filter(|r| r.run.is_none()).collect();
        // Rows behind a gap do not belong to this acquisition.
        let gap = rows
            .iter()
            .position(|r| acquisition.feed.streams() && r.missing > 0);
        rows.truncate(gap.unwrap_or(rows.len()));
        let left = self.limit.map(|limit| limit - acquisition.rows);
        if let Some(left) = left {
            rows.truncate(left.min(rows.len() as u64) as usize);
        }
        acquisition.rows += rows.len() as u64;
        self.captured = acquisition.rows;
        let is_over = self.limit == Some(acquisition.rows);
        if let Some(last) = rows.last() {
            acquisition.times.start.get_or_insert_with(SystemTime::now);
            let times = acquisition.times;
            self.send_headers(times);
            self.latest = Some(self.columns.iter().map(|c| c.raw(last)).collect());
            for each in self.datas.iter_mut().filter(|d| d.is_recording) {
                if let Some(form) = each.form {
                    each.client.send(&data::rows(form, &self.columns, &rows));
                }
            }
        }
        match (is_over, gap) {
            (true, _) => self.end("Ok"),
            (_, Some(_)) => self.end("Data overrun"),
            _ => Ok(()),
        }
    }

    fn end(&mut self, reason: &'static str) -> Result<(), HostError> {
        let Some(acquisition) = self.acquisition.take() else {
            return Ok(());
        };
        self.completion = reason;
        // Also without a row a begin belongs to each end.
        self.send_headers(acquisition.times);
        for each in self.datas.iter_mut().filter(|d| d.is_recording) {
            each.client
                .send(data::end(acquisition.rows, reason).as_bytes());
            each.is_recording = false;
        }
        acquisition.feed.end(self.card)
    }
}
